"""The number of cores that a model uses."""

import os

import pytest

from ravestate.language.cores import cores


@pytest.mark.parametrize(
    ("wanted", "found"), [("1", 1), ("1,4", 1), ("1000000", None), ("0", None), ("many", None), ("", None)]
)
def test_the_variable_omp_num_threads_can_lower_the_number_of_cores(
    monkeypatch: pytest.MonkeyPatch, wanted: str, found: int | None
) -> None:
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    all_cores = cores()
    assert 1 <= all_cores <= (os.cpu_count() or 1)
    monkeypatch.setenv("OMP_NUM_THREADS", wanted)
    assert cores() == (found or all_cores)
