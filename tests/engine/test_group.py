"""Causal groups, and the empty table of slots that all new groups share."""

from __future__ import annotations

import pytest

from ravestate.engine.group import NOTHING, Group
from ravestate.errors import EngineError


def test_the_table_that_all_groups_share_refuses_entries() -> None:
    with pytest.raises(EngineError, match="shared"):
        NOTHING["slot"] = None
    with pytest.raises(EngineError, match="shared"):
        NOTHING.setdefault("slot", {})
    with pytest.raises(EngineError, match="shared"):
        NOTHING.update(slot=None)
    table = NOTHING
    with pytest.raises(EngineError, match="shared"):
        table |= {"slot": None}
    assert NOTHING == {}


def test_a_slot_that_one_group_takes_is_free_in_another() -> None:
    one, other = Group(1), Group(2)
    one.take(7, None)
    assert one.finished((7,))
    assert not other.finished((7,))
