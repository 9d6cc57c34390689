"""The rule context: its reads and acts, and error messages that say what to write."""

import contextlib
import re
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from ravestate.testing import simulate
from ravestate.testing.virtual_loop import VirtualLoop

HERE = re.escape(__file__)


class Options(rs.Settings):
    word: str = "hi"


class Scene:
    def __init__(self) -> None:
        self.module = rs.Module("m", settings=Options)
        self.go = self.module.signal("go", payload=int)
        self.other, self.out = self.module.signal("other"), self.module.signal("out", payload=str)
        self.mood, self.note = self.module.slot("mood", "calm"), self.module.slot("note", "")
        self.lit = self.module.flag("lit")
        self.people = self.module.collection("people")
        self.found: list[Any] = []

    def run(self, act: Callable[[rs.RuleContext], object], when: rs.Condition | None = None, **options: Any) -> None:
        """Declare a rule that calls `act` with its context, and keeps the result."""

        async def doer(ctx: rs.RuleContext) -> None:
            self.found.append(act(ctx))

        self.module.rule(when=self.go if when is None else when, **options)(doer)

    def outcome(self, payload: int = 0) -> Any:
        with simulate(self.module) as sim:
            sim.emit(self.go, payload)
            if sim.failures:
                return sim.failures[0][1]
        return self.found[-1]


@pytest.fixture
def scene() -> Scene:
    return Scene()


def write(slot: rs.Slot[Any], value: object) -> Callable[[rs.RuleContext], None]:
    def act(ctx: rs.RuleContext) -> None:
        ctx[slot] = value

    return act


# ---------------------------------------------------------------------------------------- reading


def test_a_rule_can_read_the_slots_that_it_declares_to_read_or_to_write(scene: Scene) -> None:
    scene.run(lambda ctx: (ctx[scene.mood], ctx[scene.note]), reads=scene.mood, writes=scene.note)
    assert scene.outcome() == ("calm", "")


def test_a_rule_sees_its_own_writes_but_not_those_of_other_rules(scene: Scene) -> None:
    seen: list[str] = []

    @scene.module.rule(when=scene.go, reads=scene.mood, writes=scene.note)
    async def slow(ctx: rs.RuleContext) -> None:
        ctx[scene.note] = "mine"
        await ctx.sleep(1)
        seen.extend((ctx[scene.mood], ctx[scene.note]))

    with simulate(scene.module) as sim:
        sim.emit(scene.go)
        sim.put(scene.mood, "changed meanwhile")
        sim.put(scene.note, "changed meanwhile")
        sim.advance(1)
    assert seen == ["calm", "mine"]


@pytest.mark.parametrize(
    ("slot", "text"),
    [
        ("mood", "read m:mood without declaring it: add reads=mood to @m.rule(...)"),
        ("people", "read m:people without declaring it: add reads=people"),
    ],
)
def test_the_error_about_an_undeclared_read_says_what_to_add(scene: Scene, slot: str, text: str) -> None:
    scene.run(lambda ctx: ctx[getattr(scene, slot)])
    failure = scene.outcome()
    assert isinstance(failure, rs.UndeclaredError) and text in str(failure)
    assert re.match(rf"rule m:doer \({HERE}:\d+\) ", str(failure))


@pytest.mark.parametrize("key", ["mood", None, 3])
def test_the_message_about_a_value_that_is_not_a_slot_names_the_value(scene: Scene, key: Any) -> None:
    scene.run(lambda ctx: ctx[key], reads=scene.mood)
    assert f"read {key!r}, which is not a slot: write ctx[slot]" in str(scene.outcome())


def test_reading_a_signal_instead_of_its_slot_is_refused(scene: Scene) -> None:
    scene.run(lambda ctx: ctx[scene.mood.changed], reads=scene.mood)
    assert "read m:mood:changed, which is not a slot" in str(scene.outcome())


# ---------------------------------------------------------------------------------------- writing


def test_a_slot_declared_to_be_read_cannot_be_written(scene: Scene) -> None:
    scene.run(write(scene.mood, "x"), reads=scene.mood, writes=scene.note)
    text = str(scene.outcome())
    assert "wrote m:mood without declaring it: declare writes=(note, mood) in @m.rule(...)" in text


@pytest.mark.parametrize("value", [42, None, b"x", ["x"] * 100])
def test_a_value_of_the_wrong_type_is_an_error_of_its_writer(scene: Scene, value: Any) -> None:
    said = scene.module.slot("said", "", type=str)
    scene.run(write(said, value), writes=said)
    text = str(scene.outcome())
    assert re.match(rf"rule m:doer \({HERE}:\d+\) wrote ", text)
    assert repr(value)[:50] in text
    assert text.endswith(f"to m:said, which takes str, not {type(value).__name__}")


@pytest.mark.parametrize("change", [lambda items: items.__setitem__("ada", 1), lambda items: items.__delitem__("ada")])
def test_assigning_or_deleting_an_item_of_a_collection_is_refused(scene: Scene, change: Callable[[Any], None]) -> None:
    scene.run(lambda ctx: change(ctx[scene.people]), writes=scene.people)
    failure = scene.outcome()
    assert isinstance(failure, rs.RuleError)
    assert re.search(r"write ctx\[people\]\.(add\(key, item\)|remove\(key\))$", str(failure))


def test_the_error_names_a_slot_of_another_module_together_with_its_module(scene: Scene) -> None:
    lamp = rs.Module("lamp").slot("light", "")
    scene.run(write(lamp, "x"), writes=scene.note)
    assert "declare writes=(note, lamp.light) in @m.rule(...)" in str(scene.outcome())


def test_the_message_about_a_misspelt_slot_names_the_nearest(scene: Scene) -> None:
    other = scene.module.slot("notes", "")
    scene.run(write(other, "x"), writes=scene.note)
    assert str(scene.outcome()).endswith("; did you mean 'm:note'?")


def test_a_write_raises_its_signals_immediately(scene: Scene) -> None:
    order: list[str] = []

    @scene.module.rule(when=scene.lit.true, reads=scene.lit)
    async def follows(ctx: rs.RuleContext) -> None:
        order.append("heard")

    @scene.module.rule(when=scene.go, writes=scene.lit)
    async def writes(ctx: rs.RuleContext) -> None:
        ctx[scene.lit] = True
        await ctx.sleep(1)
        order.append("ended")

    with simulate(scene.module) as sim:
        sim.emit(scene.go)
        assert sim.read(scene.lit) is True and order == ["heard"]
        sim.advance(1)
    assert order == ["heard", "ended"]


# ---------------------------------------------------------------------------------------- collections


def test_collections_are_mappings_with_add_and_remove(scene: Scene) -> None:
    def act(ctx: rs.RuleContext) -> object:
        people = ctx[scene.people]
        people.add("a", "Ada")
        people.add("b", "Bob")
        people.remove("b")
        people.remove("nobody")
        assert (dict(people), len(people), "a" in people, people["a"], list(people)) == (
            {"a": "Ada"}, 1, True, "Ada", ["a"],
        )  # fmt: skip
        assert repr(people) == "m:people{'a': 'Ada'}"
        assert dict(ctx[scene.people]) == {"a": "Ada"}
        ctx[scene.people] = {"c": "Cleo"}
        return dict(ctx[scene.people])

    events: list[tuple[str, str, object]] = []
    for what in ("added", "removed"):
        signal = getattr(scene.people, what)

        async def note(ctx: rs.RuleContext, what: str = what, signal: rs.Signal[rs.Entry] = signal) -> None:
            events.append((what, *ctx.payload(signal)))

        scene.module.rule(when=signal, name=f"note_{what}")(note)
    scene.run(act, writes=scene.people)
    assert scene.outcome() == {"c": "Cleo"}
    assert sorted(events) == [
        ("added", "a", "Ada"), ("added", "b", "Bob"), ("added", "c", "Cleo"),
        ("removed", "a", "Ada"), ("removed", "b", "Bob"),
    ]  # fmt: skip


def test_all_views_of_a_collection_in_a_rule_share_its_writes(scene: Scene) -> None:
    def act(ctx: rs.RuleContext) -> object:
        one, other = ctx[scene.people], ctx[scene.people]
        one.add("a", 1)
        other.add("b", 2)
        return dict(ctx[scene.people])

    scene.run(act, writes=scene.people)
    assert scene.outcome() == {"a": 1, "b": 2}


def test_a_collection_can_be_changed_during_an_iteration(scene: Scene) -> None:
    def act(ctx: rs.RuleContext) -> Any:
        people = ctx[scene.people]
        for key in "abc":
            people.add(key, key.upper())
        passed = []
        for key, item in people.items():
            passed.append(item)
            people.remove("c")
            people.add(f"{key}{key}", item)
        return passed, list(people), list(people.values()), len(people)

    scene.run(act, writes=scene.people)
    assert scene.outcome() == (["A", "B", "C"], ["a", "b", "aa", "bb", "cc"], ["A", "B", "A", "B", "C"], 5)


def test_a_rule_does_not_see_later_changes_of_a_collection_by_other_rules(scene: Scene) -> None:
    seen: list[Any] = []

    @scene.module.rule(when=scene.people.added, reads=scene.people)
    async def look(ctx: rs.RuleContext) -> None:
        before = dict(ctx[scene.people])
        await ctx.sleep(10)
        seen.append((before, dict(ctx[scene.people])))

    async def fill(ctx: rs.RuleContext) -> None:
        for key in "ab":
            ctx[scene.people].add(key, key.upper())
            await ctx.sleep(1)

    scene.module.rule(when=scene.go, writes=scene.people)(fill)

    async def run() -> None:
        async with rs.Context(scene.module) as context:  # unlike a simulation, this context keeps no trace
            context.emit(scene.go)
            await context.quiet()
            before = context.read(scene.people)
            context.put(scene.people, {})
            await context.quiet()
            seen.append(dict(before))

    with contextlib.closing(VirtualLoop()) as loop:
        loop.run_until_complete(run())
    assert seen == [({"a": "A"},) * 2, ({"a": "A", "b": "B"},) * 2, {"a": "A", "b": "B"}]


@pytest.mark.parametrize("value", [1, "yes", [], 0])
def test_the_value_of_a_flag_is_always_true_or_false(scene: Scene, value: Any) -> None:
    def act(ctx: rs.RuleContext) -> Any:
        ctx[scene.lit] = value
        return ctx[scene.lit]

    scene.run(act, writes=scene.lit)
    assert scene.outcome() is bool(value)


@pytest.mark.parametrize("act", [lambda p: p.add("a", 1), lambda p: p.remove("a")])
def test_a_collection_that_is_only_read_cannot_be_changed(scene: Scene, act: Callable[[Any], None]) -> None:
    scene.run(lambda ctx: act(ctx[scene.people]), reads=scene.people)
    assert "wrote m:people without declaring it: add writes=people" in str(scene.outcome())


@pytest.mark.parametrize("value", [5, ["Ada"], None, "Ada"])
def test_only_a_mapping_can_be_written_to_a_collection(scene: Scene, value: object) -> None:
    scene.run(write(scene.people, value), writes=scene.people)
    failure = scene.outcome()
    assert isinstance(failure, rs.RuleError)
    kind = type(value).__name__
    assert (
        f"wrote {kind} to the collection m:people: write a mapping of keys to items, or ctx[people].add(key, item)"
        in (str(failure))
    )


# ---------------------------------------------------------------------------------------- payloads, emitting


@pytest.mark.parametrize("payload", [7, 0, "", None, False])
def test_payloads_arrive_unchanged_even_if_they_are_falsy(scene: Scene, payload: Any) -> None:
    scene.run(lambda ctx: ctx.payload(scene.go))
    assert scene.outcome(payload) is payload or scene.outcome(payload) == payload


def test_the_payload_of_a_signal_of_another_clause_is_none(scene: Scene) -> None:
    scene.run(lambda ctx: (ctx.payload(scene.go), ctx.payload(scene.other)), when=scene.go | scene.other)
    assert scene.outcome(3) == (3, None)


@pytest.mark.parametrize(
    ("ask", "text"),
    [
        (
            lambda s: s.other,
            "asked for the payload of m:other, which is not in its condition: the condition has m:go, m:mood:changed",
        ),
        (lambda s: s.mood, "asked for the payload of m:mood, .*; did you mean 'm:mood:changed'"),
        (lambda s: "go", "asked for the payload of 'go', which is not in its condition"),
    ],
)
def test_payloads_of_other_signals_are_refused(scene: Scene, ask: Callable[[Scene], Any], text: str) -> None:
    scene.run(lambda ctx: ctx.payload(ask(scene)), when=scene.go | scene.mood.changed)
    failure = scene.outcome()
    assert isinstance(failure, rs.UndeclaredError)
    assert re.search(text, str(failure))


def test_an_emitted_signal_carries_its_payload(scene: Scene) -> None:
    scene.run(lambda ctx: ctx.emit(scene.out, "word"), emits=scene.out)
    heard: list[object] = []

    @scene.module.rule(when=scene.out)
    async def hear(ctx: rs.RuleContext) -> None:
        heard.append(ctx.payload(scene.out))

    scene.outcome()
    assert heard == ["word"]


@pytest.mark.parametrize(
    ("what", "text"),
    [
        (lambda s: s.other, "emitted m:other without declaring it: declare emits=(out, other) in @m.rule(...)"),
        (
            lambda s: rs.Module("m").signal("outt"),
            "declare emits=(out, outt) in @m.rule(...); did you mean 'm:out'?",
        ),
        (
            lambda s: s.mood,
            "emitted m:mood, which is a slot: write ctx[mood] = value, or emit a signal: ctx.emit(signal)",
        ),
        (lambda s: "out", "emitted 'out', which is not a signal: write ctx.emit(signal)"),
    ],
)
def test_undeclared_emissions_are_refused(scene: Scene, what: Callable[[Scene], Any], text: str) -> None:
    scene.run(lambda ctx: ctx.emit(what(scene)), emits=scene.out)
    failure = scene.outcome()
    assert isinstance(failure, rs.UndeclaredError) and text in str(failure)


@pytest.mark.parametrize(
    ("what", "text"),
    [
        (lambda s: s.mood, "m:mood; it is a slot: write mood.changed"),
        (lambda s: rs.Module("m").signal("outt"), "m:outt; did you mean 'm:out'?"),
        (lambda s: rs.Module("far").signal("x"), "far:x; add module far to the context"),
        (lambda s: "m:out", "'m:out'"),
    ],
)
def test_wiping_an_unknown_signal_is_refused(scene: Scene, what: Callable[[Scene], Any], text: str) -> None:
    scene.run(lambda ctx: ctx.wipe(what(scene)))
    failure = scene.outcome()
    assert isinstance(failure, rs.UndeclaredError)
    assert re.fullmatch(rf"rule m:doer \({HERE}:\d+\): this context has no signal {re.escape(text)}", str(failure))


def test_wiping_a_signal_withdraws_its_spikes(scene: Scene) -> None:
    both: list[str] = []

    @scene.module.rule(when=scene.other & scene.out)
    async def together(ctx: rs.RuleContext) -> None:
        both.append("met")

    scene.run(lambda ctx: ctx.wipe(scene.other))
    with simulate(scene.module) as sim:
        sim.emit(scene.other)
        sim.emit(scene.go)
        sim.emit(scene.out)
        assert both == [] and sim.failures == []


# ---------------------------------------------------------------------------------------- other methods


def test_a_rule_context_has_settings_log_time_and_random_numbers(scene: Scene) -> None:
    @scene.module.rule(when=scene.go)
    async def look(ctx: rs.RuleContext) -> None:
        scene.found.append((ctx.now, ctx.settings.word, ctx.log.name, ctx.rule.name))
        await ctx.sleep(2.5)
        scene.found.append(ctx.now)

    with simulate(scene.module) as sim:
        sim.advance(1)
        sim.emit(scene.go)
        sim.advance(5)
    assert scene.found == [(1.0, "hi", "ravestate.m.look", "m:look"), 3.5]


def test_the_settings_of_a_module_without_settings_are_none() -> None:
    m = rs.Module("m")
    found: list[object] = []

    @m.rule(when=rs.startup)
    async def look(ctx: rs.RuleContext) -> None:
        found.append(ctx.settings)

    with simulate(m):
        assert found == [None]


def test_a_rule_can_add_a_rule_and_wait_for_quiet(scene: Scene) -> None:
    late = rs.Module("late").rule(when=scene.other, writes=scene.note, name="late")(note_late(scene))

    @scene.module.rule(when=scene.go, emits=scene.other, detached=True, background=True)
    async def grow(ctx: rs.RuleContext) -> None:
        ctx.add_rule(late)
        ctx.emit(scene.other)
        await ctx.quiet()
        scene.found.append("quiet")

    with simulate(scene.module) as sim:
        sim.emit(scene.go)
        assert sim.read(scene.note) == "late" and scene.found == ["quiet"]
        assert sim.failures == []


def note_late(scene: Scene) -> Any:
    async def late(ctx: rs.RuleContext) -> None:
        await ctx.sleep(0)
        ctx[scene.note] = "late"

    return late


def test_a_rule_that_does_not_fit_cannot_be_added(scene: Scene) -> None:
    strange = rs.Module("far").rule(when=rs.Module("far").signal("x"), name="strange")(note_late(scene))
    scene.run(lambda ctx: ctx.add_rule(strange))
    failure = scene.outcome()
    assert isinstance(failure, rs.DeclarationErrors) and "unknown signal far:x" in str(failure)


def test_a_rule_can_write_while_it_cleans_up(scene: Scene) -> None:
    @scene.module.rule(when=scene.go, writes=scene.note, until=scene.other)
    async def long(ctx: rs.RuleContext) -> None:
        try:
            await ctx.sleep(60)
        finally:
            ctx[scene.note] = ctx.cancelled

    with simulate(scene.module) as sim:
        sim.emit(scene.go)
        sim.emit(scene.other)
        assert sim.read(scene.note) == "interrupted" and sim.failures == []


@pytest.mark.parametrize("act", ["write", "emit", "wipe", "add"])
def test_a_rule_context_refuses_all_acts_after_its_run(scene: Scene, act: str) -> None:
    kept: list[rs.RuleContext] = []
    scene.run(kept.append, writes=(scene.note, scene.people), emits=scene.out)
    with simulate(scene.module) as sim:
        sim.emit(scene.go)
        ctx = kept[0]
        late: dict[str, Callable[[], object]] = {
            "write": lambda: write(scene.note, "late")(ctx),
            "emit": lambda: ctx.emit(scene.out),
            "wipe": lambda: ctx.wipe(scene.out),
            "add": lambda: ctx[scene.people].add("a", 1),
        }
        with pytest.raises(
            rs.RunEnded, match=r"rule m:doer acted after its run was over \(the function has returned\)"
        ):
            late[act]()
        assert sim.read(scene.note) == "" and dict(sim.read(scene.people)) == {}
