"""How loaded the machine is that runs the tests is no rule's fault."""

import pytest

from ravestate.runtime import blocking


@pytest.fixture(autouse=True)
def nobody_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Warn of no rule that blocks the loop; the test of these warnings says otherwise."""
    monkeypatch.setattr(blocking, "BLOCKING", float("inf"))
