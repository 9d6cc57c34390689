"""Intents are values."""

from ravestate.modules.meta.verbaliser.intents import Intent


def test_intents_with_equal_fields_are_equal() -> None:
    assert Intent("greet") == Intent("greet", {}, None, None)
    assert Intent("greet", {"name": "Ada"}) != Intent("greet")
