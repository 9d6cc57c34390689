"""Vertical lines between two layers get tracks so that different lines do not touch."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from ravestate.draw.tracks import Segment, tracks


@st.composite
def gaps(draw: st.DrawFn) -> list[Segment]:
    left = {p: 9.0 * y for p, y in enumerate(draw(st.permutations(range(8))))}
    right = {q: 9.0 * y for q, y in enumerate(draw(st.permutations(range(8))), 100)}
    ends = st.tuples(st.sampled_from(sorted(left)), st.sampled_from(sorted(right)))
    return [(p, q, left[p], right[q]) for p, q in draw(st.lists(ends, unique=True, max_size=16))]


@given(gaps())
def test_vertical_lines_of_different_nets_do_not_touch(segments: list[Segment]) -> None:
    found = tracks(segments)
    for (p, q, y, z), (r, s, a, b), (one, two) in (
        zip(*zip(*combinations(segments, 2), strict=True), combinations(found.of, 2), strict=True)
        if len(segments) > 1
        else ()
    ):
        if one is not None and one == two and p != r and q != s:
            assert max(y, z) < min(a, b) or max(a, b) < min(y, z)


@given(gaps())
def test_stubs_of_different_nets_do_not_overlap(segments: list[Segment]) -> None:
    found = tracks(segments)
    joined = {(p, q) for p, q, _, _ in segments}
    for (p, _, y, _), one in zip(segments, found.of, strict=True):
        for (_, q, _, z), two in zip(segments, found.of, strict=True):
            if one is not None and two is not None and y == z and (p, q) not in joined:
                assert one < two


@given(gaps())
def test_straight_lines_need_no_track(segments: list[Segment]) -> None:
    for (p, q, y, z), track in zip(segments, tracks(segments).of, strict=True):
        alone = sum(p == r for r, *_ in segments) == 1 == sum(q == s for _, s, *_ in segments)
        if alone and y == z:
            assert track is None


def test_all_lines_of_a_hub_share_one_track() -> None:
    assert tracks([(0, i, 50.0, 10.0 * i) for i in range(1, 9)]).count == 1
    assert tracks([(i, 0, 10.0 * i, 50.0) for i in range(1, 9)]).count == 1
