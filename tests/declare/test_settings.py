"""Settings named in a declaration."""

import ravestate as rs
from ravestate.declare.settings import SettingRef


class Owner:
    pass


def test_a_setting_is_named_alone_or_with_its_class() -> None:
    assert rs.setting("late") == SettingRef("late")
    assert rs.setting("late") != SettingRef("late", Owner)
    assert repr(rs.setting("late")) == "setting('late')"
    assert repr(SettingRef("late", Owner)) == "Owner.late"
    assert len({rs.setting("late"), SettingRef("late"), SettingRef("late", Owner)}) == 2
