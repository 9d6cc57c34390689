"""The check of the software and devices for speech on this machine, with remedies for missing parts."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from ravestate.errors import PlatformError

from .models import folders, piper_python, piper_voice, smart_turn, whisper_model, whisper_models
from .settings import Settings


@dataclass(frozen=True, slots=True)
class Line:
    """A line of the report about one part: whether it is there, whether speech needs it, and details or the remedy."""

    part: str
    present: bool
    needed: bool
    text: str


def check(settings: Settings) -> list[Line]:
    """Return the state of each part that speech needs with these settings."""
    return [
        _packages(settings),
        _recogniser(settings),
        *_voices(settings),
        _activity(),
        _turn(),
        _echo(settings),
        *_devices(settings),
    ]


def require(settings: Settings) -> None:
    """Check the packages, the recogniser, the microphone and the loudspeaker before a conversation begins.

    Raises:
        PlatformError: A part is missing; the message says how to get it.
    """
    for line in (_packages(settings), _recogniser(settings), *_devices(settings)):
        if not line.present:
            raise PlatformError(f"no {line.part}: {line.text}")


def _packages(settings: Settings) -> Line:
    wanted = ["numpy", "onnxruntime", "av", "faster_whisper"]
    wanted += ["pocketsphinx"] if settings.recogniser == "grammar" else []
    missing = [name for name in wanted if find_spec(name) is None]
    if missing:
        return Line("packages", False, True, f"{', '.join(missing)}: pip install 'ravestate[voice]'")
    return Line("packages", True, True, f"{', '.join(wanted)}, Python {sys.version.split()[0]}")


def _recogniser(settings: Settings) -> Line:
    if settings.recogniser == "grammar":
        there = Path(settings.model).expanduser().is_file()
        text = settings.model if there else f"there is no file {settings.model!r}: --set voiceio.model=commands.gram"
        return Line("grammar", there, True, text)
    try:
        chosen = whisper_model(settings.model)
    except PlatformError as error:
        return Line("recogniser", False, True, str(error))
    others = [name for name, folder in whisper_models() if folder != chosen]
    return Line("recogniser", True, True, f"{chosen}{f' (also: {chr(44).join(others)})' if others else ''}")


def _voices(settings: Settings) -> list[Line]:
    from .synthesiser import Synthesiser

    lines: list[Line] = []
    try:
        voice = Synthesiser(settings)
        try:
            voice.load()
            lines.append(Line("voice", True, True, voice.name))
        finally:
            voice.close()
    except PlatformError as error:
        lines.append(Line("voice", False, True, str(error)))
    if piper_python(settings.piper) is None or piper_voice("") is None:
        lines.append(Line("piper", False, False, f"a better voice: `make voice`, or a voice file in {folders()[0]}"))
    return lines


def _activity() -> Line:
    from .activity import Activity

    try:
        Activity()
    except (PlatformError, ImportError) as error:
        return Line("speech detector", False, True, str(error))
    return Line("speech detector", True, True, "Silero, from faster-whisper")


def _turn() -> Line:
    if (file := smart_turn()) is None:
        return Line(
            "end of turn",
            False,
            False,
            f"pauses are longer without smart-turn: `make voice`, or copy it to {folders()[0]}",
        )
    return Line("end of turn", True, False, str(file))


def _echo(settings: Settings) -> Line:
    if settings.half_duplex:
        return Line("echo", True, False, "half duplex: the agent is deaf while it speaks")
    from .echo import library

    try:
        library()
    except OSError:
        return Line("echo", False, False, "no echo cancellation: apt-get install libspeexdsp1, or use headphones")
    return Line("echo", True, False, "libspeexdsp")


def _devices(settings: Settings) -> list[Line]:
    from .opening import is_file

    lines: list[Line] = []
    try:
        from .device_line import portaudio

        found = [
            (each["name"], each["max_input_channels"], each["max_output_channels"])
            for each in portaudio().query_devices()
        ]
    except PlatformError as error:
        found, why = [], str(error)
    else:
        why = "no device: plug one in, speak through the web page (`make demo`), or name WAV files"
    for part, name, channel in (("microphone", settings.source, 1), ("loudspeaker", settings.sink, 2)):
        if not name:
            dropped = part == "loudspeaker"  # an empty sink is a choice; an empty source leaves the agent deaf
            text = "none: the sound is dropped" if dropped else "voiceio.source is empty: name a device or a file"
            lines.append(Line(part, dropped, False, text))
            continue
        if is_file(name):
            lines.append(Line(part, True, False, f"the file {name}"))
            continue
        names = [each[0] for each in found if each[channel] > 0]
        there = bool(names) if name == "default" else any(name in each for each in names)
        text = ", ".join(names) if names else why
        lines.append(Line(part, there, False, text if there or not names else f"no {name!r}; there are: {text}"))
    return lines
