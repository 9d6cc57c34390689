"""Slots and their signals (law L2), and the messages about a slot that is used as a signal."""

import copy
import re
from typing import Any

import pytest

import ravestate as rs
from ravestate.declare.slot import NOTHING

demo = rs.Module("demo")
mood = demo.slot("mood", "calm", always=True, input=True, keep="latest", limit=7)
lit = demo.flag("lit")
people = demo.collection("people")


def test_each_kind_of_slot_has_its_own_signals() -> None:
    assert [s.name for s in mood.signals] == ["demo:mood:changed"]
    assert [s.name for s in lit.signals] == ["demo:lit:changed", "demo:lit:true", "demo:lit:false"]
    assert [s.name for s in people.signals] == [
        "demo:people:changed", "demo:people:added", "demo:people:removed",
    ]  # fmt: skip
    assert (lit.true.name, lit.false.name) == ("demo:lit:true", "demo:lit:false")
    assert (people.added.name, people.removed.name) == ("demo:people:added", "demo:people:removed")
    assert [slot.kind for slot in (mood, lit, people)] == ["value", "flag", "collection"]


def test_the_signals_have_the_options_of_the_slot() -> None:
    changed = mood.changed
    assert (mood.always, changed.input, changed.keep, changed.limit) == (True, True, "latest", 7)
    assert changed.origin == mood.origin and mood.origin.rsplit(":", 1)[0] == __file__


def test_the_value_of_a_slot_before_the_first_write_is_its_default() -> None:
    assert (mood.default, lit.default, people.default) == ("calm", False, NOTHING)
    assert demo.slot("nothing").default is None
    assert demo.slot("typed", type=int).default is None


class Text(str):
    """A subclass of `str`."""


@pytest.mark.parametrize(
    ("default", "kind", "good", "bad"),
    [
        ("", str, Text("x"), 42),
        ("", str, "", None),
        (None, str, None, 42),
        (0.0, float, 1, "1"),
        (None, str | int, 1, 1.5),
    ],
)
def test_a_slot_with_a_type_refuses_values_of_other_types(default: Any, kind: Any, good: Any, bad: Any) -> None:
    slot = demo.slot("s", default, type=kind)
    slot.check(good, "the writer")
    with pytest.raises(
        rs.RuleError,
        match=f"the writer wrote {re.escape(repr(bad))} to demo:s, which takes .*, not {type(bad).__name__}",
    ):
        slot.check(bad, "the writer")


@pytest.mark.parametrize("kind", [None, Any, list[int], "str"])
def test_a_slot_whose_type_isinstance_cannot_check_accepts_every_value(kind: Any) -> None:
    demo.slot("s", type=kind).check(object(), "the writer")
    with pytest.raises(TypeError):
        NOTHING["key"] = 1


@pytest.mark.parametrize(
    ("slot", "attribute", "text"),
    [
        (
            mood,
            "change",
            "value slot demo:mood has no 'change': its signals are changed; did you mean 'changed'?",
        ),
        (
            lit,
            "tru",
            "flag slot demo:lit has no 'tru': its signals are changed, true, false; did you mean 'true'?",
        ),
        (people, "add", "collection slot demo:people has no 'add': .* did you mean 'added'?"),
        (mood, "true", "value slot demo:mood has no 'true': its signals are changed"),
        (mood, "hold", "did you mean 'holds'?"),
    ],
)
def test_the_message_about_a_misspelt_signal_of_a_slot_names_the_nearest(
    slot: rs.Slot[object], attribute: str, text: str
) -> None:
    with pytest.raises(AttributeError, match=text.replace("?", r"\?")):
        getattr(slot, attribute)


def test_a_slot_cannot_be_used_as_a_condition() -> None:
    signal = demo.signal("go")
    for combine in (lambda: mood & signal, lambda: mood | signal, lambda: mood & lit, lambda: True & mood):
        with pytest.raises(rs.DeclarationError, match=r"write \.changed \(its signal\) or \.holds\(predicate\)"):
            combine()


def test_a_slot_can_be_copied_and_printed() -> None:
    assert copy.copy(lit).true is lit.true
    assert repr(mood) == "demo:mood"


def test_an_entry_is_a_key_and_an_item() -> None:
    key, item = rs.Entry("k", 1)
    assert (key, item) == ("k", 1)
