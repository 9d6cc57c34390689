"""``ravestate voice``: check what speech needs, transcribe, speak, and hold a conversation with a recording."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.cli import complete
from ravestate.cli.agent import check_values, load_agent
from ravestate.errors import PlatformError, UsageError
from ravestate.loading.spec import AgentSpec
from ravestate.modules import BUILT_IN

if TYPE_CHECKING:
    from ravestate.modules.platform.voiceio import Settings
    from ravestate.testing import Said


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    checking = actions.add_parser("check", help="show the devices, models and programs, and how to get missing ones")
    getting = actions.add_parser("get", help="download a model for speech recognition, e.g. base or small.en")
    getting.add_argument("name", metavar="MODEL", help="a name of faster-whisper, or a repository on the hub")
    transcribing = actions.add_parser(
        "transcribe",
        help="print the words of recordings, one line for each file",
        description="Print the words of recordings, one line for each file. Exit code 1: a file could not be read.",
    )
    transcribing.add_argument("files", nargs="+", type=Path, metavar="FILE", help="a recording: WAV, OGG, MP3, ...")
    saying = actions.add_parser("say", help="speak a text into a WAV file")
    saying.add_argument("text", metavar="TEXT")
    saying.add_argument("-o", "--output", type=Path, required=True, metavar="OUT.wav", help="the file to write")
    talking = actions.add_parser(
        "talk",
        help="hold a conversation between a recording and an agent, faster than real time",
        description="Hold a conversation between a recording, which is the user's microphone, and an agent. Time is "
        "virtual, so computing takes no time. The transcript of both sides goes to standard output.",
    )
    talking.add_argument("recording", type=Path, metavar="IN.wav", help="the sound of the user's microphone")
    talking.add_argument(
        "-o", "--output", type=Path, required=True, metavar="OUT.wav",
        help="the file for the sound of the loudspeaker, on the time line of the recording",
    )  # fmt: skip
    talking.add_argument(
        "modules", nargs="*", metavar="MODULE",
        help="the agent: modules or an agent file, by default the modules of `ravestate chat`",
    )  # fmt: skip
    talking.add_argument("-f", "--file", metavar="FILE", help="an agent file")
    talking.add_argument("--seed", type=int, default=0, help="the seed of all random choices")
    for action in (checking, transcribing, saying, talking):
        action.add_argument(
            "--set", dest="sets", action="append", default=[], metavar="MODULE.KEY=VALUE",
            help="a setting, e.g. voiceio.model=base (may be repeated)",
        )  # fmt: skip


def run(options: argparse.Namespace) -> int:
    match options.action:
        case "check":
            return _check(options)
        case "get":
            return _get(options)
        case "transcribe":
            return _transcribe(options)
        case "say":
            return _say(options)
        case _:
            return _talk(options)


def settings_of(options: argparse.Namespace) -> Settings:
    """Return the settings of voiceio. Values of ``--set`` outrank those of the environment."""
    from ravestate.modules import voiceio
    from ravestate.settings import load_settings

    agent = AgentSpec()
    agent.load([("voiceio", Path())])
    for text in options.sets:
        agent.set(text)
    agent.check()
    check_values(agent)
    return load_settings([voiceio.module], {"voiceio": agent.settings.get("voiceio", {})})["voiceio"]


def _check(options: argparse.Namespace) -> int:
    from ravestate.modules.platform.voiceio.checking import check

    lines = check(settings_of(options))
    width = max(len(line.part) for line in lines)
    for line in lines:
        print(
            f"{'ok     ' if line.present else 'MISSING' if line.needed else 'none   '}  {line.part:<{width}}  {line.text}"
        )
    return int(any(line.needed and not line.present for line in lines))


def _get(options: argparse.Namespace) -> int:
    from ravestate.modules.platform.voiceio.models import fetch_whisper

    print(fetch_whisper(options.name, lambda text: print(f"ravestate voice: {text}", file=sys.stderr)))
    return 0


def _transcribe(options: argparse.Namespace) -> int:
    from ravestate.modules import voiceio

    settings = settings_of(options)
    failed = 0
    for file in options.files:
        try:
            _check_source(file)
            found = voiceio.transcribe(file, settings)
        except (PlatformError, UsageError) as error:
            if len(options.files) == 1 and isinstance(error, PlatformError):
                raise
            print(f"ravestate voice: {error}", file=sys.stderr)
            failed = 1
            continue
        print(found.text, flush=True)
    return failed


def _say(options: argparse.Namespace) -> int:
    from ravestate.modules import rawio, voiceio
    from ravestate.modules.platform.voiceio.sound import write_wav

    _check_target(options.output)
    write_wav(options.output, voiceio.speak(options.text, settings_of(options)), rawio.OUT_RATE)
    return 0


def _talk(options: argparse.Namespace) -> int:
    from ravestate.modules.platform.voiceio.opening import is_file
    from ravestate.testing import talk

    _check_source(options.recording)
    if not is_file(str(options.recording)):
        raise UsageError(f"{options.recording}: name a recording that ends in .wav, .ogg, .mp3, .flac, .m4a or .opus")
    _check_target(options.output)
    if options.output.exists() and options.output.samefile(options.recording):
        raise UsageError(f"-o {options.output} is the recording itself, which would be overwritten: name another file")
    complete_agent = not options.modules and not options.file
    if complete_agent:
        options.without = []
    agent = load_agent(options, ["voiceio", *(complete.names(options) if complete_agent else [])])
    if complete_agent:
        complete.leave_out_absent(agent, "voice")
        complete.choose_small_talk(agent, "voice")
    _leave_out_platforms(agent)
    talk(options.recording, options.output, *agent.modules, settings=agent.settings, seed=agent.seed, show=show)
    return 0


def show(one: Said) -> None:
    """Print a line of a transcript: begin, end, speaker, words."""
    mark = " …" if one.cut else ""
    print(f"{one.start:8.2f} {one.end:8.2f}  {one.speaker + ':':<6} {one.text}{mark}", flush=True)


def _leave_out_platforms(agent: AgentSpec) -> None:
    """Remove the other platforms: the recording is the user, and a console without a terminal would end the agent."""
    out = [one.name for one in agent.modules if BUILT_IN.get(one.name) == "platform" and one.name != "voiceio"]
    if out:
        agent.modules = [one for one in agent.modules if one.name not in out]
        for name in out:
            agent.settings.pop(name, None)
        print(
            f"ravestate voice: the user is the recording, so the agent runs without {', '.join(out)}", file=sys.stderr
        )


def _check_source(path: Path) -> None:
    if path.is_dir():
        raise UsageError(f"{path} is a folder: name a recording")
    if not path.is_file():
        raise UsageError(f"there is no file {path}")


def _check_target(path: Path) -> None:
    if path.suffix.lower() != ".wav":
        raise UsageError(f"cannot write {path}: the sound is written as WAV, so name a file that ends in .wav")
    if not path.parent.is_dir():
        raise UsageError(f"cannot write {path}: there is no folder {path.parent}")
