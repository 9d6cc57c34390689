"""Let pytest rewrite the assertions of the shared behaviours, so that a failure shows the compared values."""

import pytest

pytest.register_assert_rewrite("scenarios.behaviours")
