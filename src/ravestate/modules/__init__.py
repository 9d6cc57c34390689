"""The built-in modules: platforms, modalities, meta modules and skills. Each is imported when it is first used.

``from ravestate.modules import rawio`` imports the package of a module. The package holds the `Module` value
(``rawio.module``) and the module's signals and slots by name (``rawio.input``). You may pass the package wherever a
function expects a `Module`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from ravestate.errors import nearest

if TYPE_CHECKING:
    from ravestate.modules.meta import idle, nlp, ontology, verbaliser
    from ravestate.modules.modality import activity, emotion, interloc, rawio, visionio
    from ravestate.modules.platform import conio, matrixio, roboyio, ros1, ros2, telegramio, voiceio, webio
    from ravestate.modules.skill import agenda, agentqa, charades, fillers, genqa, hibye, persqa, wildtalk

__all__ = [
    "BUILT_IN",
    "activity",
    "agenda",
    "agentqa",
    "charades",
    "conio",
    "emotion",
    "fillers",
    "genqa",
    "hibye",
    "idle",
    "interloc",
    "matrixio",
    "nlp",
    "ontology",
    "persqa",
    "rawio",
    "roboyio",
    "ros1",
    "ros2",
    "telegramio",
    "verbaliser",
    "visionio",
    "voiceio",
    "webio",
    "wildtalk",
]

BUILT_IN = {
    "conio": "platform",
    "voiceio": "platform",
    "webio": "platform",
    "telegramio": "platform",
    "matrixio": "platform",
    "roboyio": "platform",
    "ros1": "platform",
    "ros2": "platform",
    "rawio": "modality",
    "interloc": "modality",
    "emotion": "modality",
    "activity": "modality",
    "visionio": "modality",
    "idle": "meta",
    "nlp": "meta",
    "ontology": "meta",
    "verbaliser": "meta",
    "hibye": "skill",
    "agenda": "skill",
    "agentqa": "skill",
    "charades": "skill",
    "fillers": "skill",
    "genqa": "skill",
    "persqa": "skill",
    "wildtalk": "skill",
}
"""The folder that contains each built-in module, by the module's name."""


def __getattr__(name: str) -> Any:
    if name not in BUILT_IN:
        raise AttributeError(f"there is no built-in module {name!r}{nearest(name, BUILT_IN)}", name=name)
    return import_module(f"ravestate.modules.{BUILT_IN[name]}.{name}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
