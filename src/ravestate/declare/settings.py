"""A setting named in a declaration, to be looked up when a context starts.

The `Settings` model itself stands in ``ravestate/settings.py``: it is a pydantic model, and the pure
rooms know no third party.
"""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Number", "SettingRef", "setting"]


@dataclass(frozen=True, slots=True)
class SettingRef:
    """The name of a numeric setting; `owner` is the settings class it was taken from, if known."""

    name: str
    owner: type | None = None

    def __repr__(self) -> str:
        return f"{self.owner.__name__}.{self.name}" if self.owner else f"setting({self.name!r})"


type_of_number = (int, float, SettingRef)
Number = float | SettingRef
"""A number in a declaration: given at once, or by the name of a setting."""


def setting(name: str) -> SettingRef:
    """Name a setting of the rule's own module, e.g. ``idle.bored.min_age(rs.setting("bored_after"))``."""
    return SettingRef(name)
