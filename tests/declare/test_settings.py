"""References to settings in a declaration."""

import ravestate as rs
from ravestate.declare.settings import SettingRef


class Owner:
    pass


def test_a_reference_to_a_setting_has_a_name_and_optionally_a_class() -> None:
    assert rs.setting("late") == SettingRef("late")
    assert rs.setting("late") != SettingRef("late", Owner)
    assert repr(rs.setting("late")) == "setting('late')"
    assert repr(SettingRef("late", Owner)) == "Owner.late"
    assert len({rs.setting("late"), SettingRef("late"), SettingRef("late", Owner)}) == 2
