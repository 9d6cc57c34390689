"""Rewrite the assertions of the shared stories, so that they show the compared values."""

import pytest

pytest.register_assert_rewrite("scenarios.behaviours")
