"""Assertions in the shared stories tell what they compared."""

import pytest

pytest.register_assert_rewrite("scenarios.behaviours")
