"""The complete text agent: all modules of a chat except the platform (the console or the web page)."""

from __future__ import annotations

import argparse
import os
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import Literal

from ravestate.errors import PlatformError, UsageError, nearest
from ravestate.language.bundled import absence, is_news
from ravestate.loading.spec import AgentSpec, with_required
from ravestate.settings import variable_of

COMPLETE = (
    "idle", "verbaliser", "interloc", "nlp", "ontology", "emotion", "hibye", "fillers", "agenda", "persqa", "agentqa",
    "genqa", "wildtalk",
)  # fmt: skip
"""The names of the modules of the complete text agent, without a platform."""

ON_PAGE = ("voiceio", "visionio", "charades")
"""The names of the modules that the complete agent also has on a web page, if speech and the camera are set up."""

PACKAGES = {
    "nlp": ("spacy",),
    "ontology": ("ladybug",),
    "emotion": ("numpy", "onnxruntime", "tokenizers"),
    "agentqa": ("numpy", "onnxruntime", "tokenizers"),
    "genqa": ("numpy", "onnxruntime", "tokenizers"),
    "conio": ("prompt_toolkit",),
}
"""Name of a module → the packages that the module needs with its default settings."""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the option ``--without`` to a command's parser."""
    parser.add_argument(
        "--without",
        action="append",
        default=[],
        metavar="MODULE",
        help="leave a module out of the complete agent (may be repeated)",
    )


def explain_memory(parser: argparse.ArgumentParser) -> None:
    """Extend a command's help text: say where the agent keeps its memory."""
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.epilog = (
        "The complete agent keeps its memory of you on this machine:\n"
        f"  {shown('data', 'default', 'memory.lbug')} (for another file: --set ontology.path=FILE)\n"
        "To look at the memory: ravestate memory list, ravestate memory show NAME. To remove a person: say\n"
        '"forget me", or ravestate memory forget NAME. To remove the whole memory: ravestate memory reset.\n'
    )


def names(options: argparse.Namespace, *, page: bool = False) -> list[str]:
    """Return the names of the complete agent's modules, except those that the options leave out.

    On a `page`, the agent also hears, speaks and sees if speech and the camera are set up on this machine.
    """
    known = (*COMPLETE, *ON_PAGE) if page else COMPLETE
    for name in options.without:
        if name not in known:
            raise UsageError(f"--without {name}: the agent has no such module{nearest(name, known)}")
    absent = {"voiceio"} if page and not _can_hear() else set[str]()
    if page and ("visionio" in options.without or not _can_see()):
        absent |= {"visionio", "charades"}
    return [name for name in known if name not in (*options.without, *absent)]


def _can_hear() -> bool:
    """Return whether this machine has the packages and a model for speech recognition."""
    if not all(map(find_spec, ("faster_whisper", "onnxruntime"))):
        return False
    from ravestate.modules.platform.voiceio.models import whisper_models

    return any(whisper_models())


def _can_see() -> bool:
    """Return whether this machine has the packages for recognising faces."""
    from ravestate.modules.modality.visionio.places import eyes_python

    try:
        eyes_python()
    except PlatformError:
        return False
    return True


def leave_out_absent(agent: AgentSpec, command: str) -> None:
    """Remove modules whose packages are not installed, and print how to install these packages and the sentence models.

    Also remove the modules of the complete agent that require a removed one. A module stays if the user has set one of
    its settings, or if another module needs it. The console stays, too, in its plain form.
    """
    _leave_out_absent(agent, command)
    needed = any("onnxruntime" in PACKAGES.get(module.name, ()) for module in with_required(agent.modules))
    if needed and (line := absence()) and is_news(line):  # print it, because on a terminal the log goes to a file
        print(f"ravestate {command}: {line}", file=sys.stderr)


def _leave_out_absent(agent: AgentSpec, command: str) -> None:
    present = [module.name for module in with_required(agent.modules)]
    needs = {name: PACKAGES[name] for name in present if name in PACKAGES}
    absent = {name for name, packages in needs.items() if not all(map(find_spec, packages))}
    if not absent:
        return
    if "conio" in absent:
        agent.settings.setdefault("conio", {})["plain"] = True
    in_environment = (name for name in absent if any(v.startswith(variable_of(name, "")) for v in os.environ))
    out = absent - {*agent.settings, *in_environment}
    for module in agent.modules:  # each module comes after those that it requires
        if module.name in (*COMPLETE, *ON_PAGE) and any(required.name in out for required in module.requires):
            out.add(module.name)
    agent.modules = [module for module in agent.modules if module.name not in out]
    out -= {module.name for module in with_required(agent.modules)}  # keep modules that other modules still need
    for name in out:
        agent.settings.pop(name, None)
    left = (
        f"the agent talks without {', '.join(name for name in (*COMPLETE, *ON_PAGE) if name in out)}; to add them: "
        if out
        else ""
    )
    print(f"ravestate {command}: {left}pip install 'ravestate[chat]'", file=sys.stderr)


def choose_small_talk(agent: AgentSpec, command: str) -> str:
    """Choose the language model for small talk (`wildtalk`), print its name in one line, and set it in the settings.

    Do nothing if the settings name a backend, or forbid the search. If the search finds no language model, return a
    sentence that says how to get one; otherwise, return an empty text.
    """
    if all(module.name != "wildtalk" for module in agent.modules):
        return ""
    from ravestate.modules import wildtalk
    from ravestate.modules.skill.wildtalk.choosing import choose
    from ravestate.settings import load_settings

    given = agent.settings.get("wildtalk", {})
    settings: wildtalk.Settings = load_settings([wildtalk.module], {"wildtalk": given})["wildtalk"]
    if settings.backend != "auto" or not settings.search:
        return ""
    try:
        choice = choose(settings)
    except PlatformError as error:
        print(f"ravestate {command}: {error}", file=sys.stderr)
        return ""
    found = {name: getattr(choice.settings, name) for name in ("backend", "base_url", "api_key", "model", "model_path")}
    agent.settings["wildtalk"] = {**given, **found}
    print(f"ravestate {command}: {choice.text}", file=sys.stderr)
    return f"{choice.text[0].upper()}{choice.text[1:]}." if choice.settings.backend == "listen" else ""


def shown(kind: Literal["data", "state"], *parts: str) -> str:
    """Return the path of a file in the user's folder of this kind, with ``~`` for their home."""
    from ravestate.folders import user_folder

    try:
        path, home = user_folder(kind).joinpath(*parts), Path.home()
    except RuntimeError:  # the user has no home folder
        return "/".join(parts)
    return f"~/{path.relative_to(home).as_posix()}" if path.is_relative_to(home) else str(path)
