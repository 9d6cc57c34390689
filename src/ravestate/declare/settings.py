"""References to settings in declarations; when a context is made, it looks up the value of each setting.

The `Settings` model is in ``ravestate/settings.py``: it needs pydantic, and the pure packages use no third-party code.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class SettingRef:
    """The name of a numeric setting, and its `owner`: a settings class, or None for the class of the rule's module."""

    name: str
    owner: type | None = None

    def __repr__(self) -> str:
        return f"{self.owner.__name__}.{self.name}" if self.owner else f"setting({self.name!r})"


type_of_number = (int, float, SettingRef)
Number = float | SettingRef
"""A number in a declaration, or a reference to a setting."""


def setting(name: str) -> SettingRef:
    """Return a reference to a setting of the rule's own module, as in
    ``idle.bored.min_age(rs.setting("bored_after"))``."""
    return SettingRef(name)
