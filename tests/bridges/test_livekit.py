"""`ravestate.bridges.livekit`: report the results of `cases/livekit_cases.py`, which runs in LiveKit's environment."""

import pytest

from bridges.apart import Failures, names_in, run_apart


@pytest.fixture(scope="module")
def failures(tmp_path_factory: pytest.TempPathFactory) -> Failures:
    return run_apart("livekit", tmp_path_factory.mktemp("livekit"))


@pytest.mark.parametrize("name", names_in("livekit"))
def test_each_case_of_livekit_passes_in_its_own_environment(name: str, failures: Failures) -> None:
    runs = failures.get(name, ["it did not run"])
    if any(runs):
        pytest.fail("\n".join(filter(None, runs)), pytrace=False)
