"""`visionio` passes body poses to `activity` only if a rule waits for activities."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.modules import activity, visionio
from ravestate.testing import simulate

VIDEO = Path(sys.prefix) / "share" / "ravestate" / "eyes" / "videos" / "walk.mp4"


@pytest.mark.parametrize("listens", [True, False])
def test_poses_from_a_real_video_reach_activity_only_if_a_rule_waits(tmp_path: Path, listens: bool) -> None:
    listener = rs.Module("listener", requires=[activity])
    if listens:

        @listener.rule(when=activity.recognised)
        async def hear(ctx: rs.RuleContext) -> None: ...

    settings = {
        "visionio": {"source": str(VIDEO)},
        "activity": {"folder": tmp_path},
        "ontology": {"path": tmp_path / "memory.lbug"},
    }
    with simulate(visionio, listener, settings=settings) as sim:
        sim.advance(1.5)
        assert sim.read(activity.in_view) is listens
        assert (len(sim.read(activity.movement).poses) >= 5) is listens
