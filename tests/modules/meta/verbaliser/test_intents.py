"""Intents as values."""

from ravestate.modules.meta.verbaliser.intents import Intent


def test_an_intent_is_a_value() -> None:
    assert Intent("greet") == Intent("greet", {}, None, None)
    assert Intent("greet", {"name": "Ada"}) != Intent("greet")
