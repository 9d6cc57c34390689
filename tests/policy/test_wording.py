"""Messages list names without repetitions, and only a few of them."""

import pytest

from ravestate.declare.wording import SHOWN, few


@pytest.mark.parametrize(
    ("names", "text"),
    [
        ([], ""),
        (["m:a"], "m:a"),
        (["m:b", "m:a", "m:b"], "m:b, m:a"),
        ([str(n) for n in range(SHOWN + 1)], "0, 1, 2, 3, 4, 5, 6, 7, 8"),
        ([str(n) for n in range(SHOWN + 2)], "0, 1, 2, 3, 4, 5, 6, 7 and 2 more"),
    ],
)
def test_a_list_has_each_name_once_and_at_most_eight_names(names: list[str], text: str) -> None:
    assert few(names) == text
