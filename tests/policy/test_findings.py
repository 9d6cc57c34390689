"""Findings report declarations that compile, but are probably mistakes."""

import inspect
import queue
import types
from typing import Any

import pytest

import ravestate as rs
from ravestate import modules
from ravestate.modules import BUILT_IN


async def nothing(ctx: rs.RuleContext) -> None:
    pass


class Scene:
    """A module with an input and an output, and methods that make declarations short."""

    def __init__(self) -> None:
        self.module = rs.Module("m")
        self.heard = self.module.signal("heard", input=True)
        self.out = self.module.slot("out", "")

    def rule(self, name: str, when: rs.Condition, **options: Any) -> None:
        self.module.rule(when=when, name=name, **options)(nothing)

    def findings(self, source: Any = None) -> dict[tuple[str, str], str]:
        return {(f.kind, f.subject): str(f) for f in rs.compile(self.module).findings(source)}


@pytest.fixture
def scene() -> Scene:
    return Scene()


def test_a_policy_without_mistakes_has_no_findings(scene: Scene) -> None:
    question = scene.module.signal("question")
    scene.rule("classify", scene.heard, emits=question)
    scene.rule("chat", scene.heard, writes=scene.out)
    scene.rule("answer", question, writes=scene.out)
    assert scene.findings() == {}


def test_a_rule_that_only_a_write_from_outside_can_start_is_reported(scene: Scene) -> None:
    mood = scene.module.slot("mood")
    scene.rule("loop", mood.changed, writes=mood, detached=True)
    scene.rule("fine", scene.heard, writes=scene.out)
    found = scene.findings()
    assert list(found) == [("unreachable", "m:loop"), ("loop", "m:loop")]
    text = found["unreachable", "m:loop"]
    assert text.startswith("unreachable: rule m:loop runs only if code outside the rules raises m:mood:changed")
    assert text.endswith("if such code exists, declare the signal or its slot with input=True")
    scene.module.slots.remove(mood)


def test_a_rule_that_waits_for_an_earlier_writer_of_its_slot_is_unreachable(scene: Scene) -> None:
    said = scene.module.signal("said")
    scene.rule("say", scene.heard, writes=scene.out, emits=said)
    scene.rule("again", said, writes=scene.out)
    text = scene.findings()["unreachable", "m:again"]
    assert "waits for a signal that only other writers of m:out raise" in text
    assert "add .detached() to this signal, or detached=True to the rule that raises it" in text


@pytest.mark.parametrize("way", ["constraint", "rule"])
def test_a_detached_constraint_or_cause_makes_a_rule_after_another_writer_reachable(scene: Scene, way: str) -> None:
    said = scene.module.signal("said")
    scene.rule("say", scene.heard, writes=scene.out, emits=said, detached=way == "rule")
    scene.rule("again", said.detached() if way == "constraint" else said, writes=scene.out)
    assert not [kind for kind, _ in scene.findings() if kind == "unreachable"]


def test_a_rule_that_can_never_win_is_reported(scene: Scene) -> None:
    scene.rule("first", scene.heard, writes=scene.out, weight=2)
    scene.rule("second", scene.heard, writes=scene.out)
    text = scene.findings()["never-wins", "m:second"]
    assert "rule m:second runs only when m:first resigns" in text
    assert "give it one more signal or a greater weight, or give the other rule a cooldown" in text


@pytest.mark.parametrize(
    "first",
    [
        {"cooldown": 5.0},
        {"when": "where"},
        {"when": "holds"},
        {"when": "min_age"},
        {"when": "detached"},
        {"weight": 0.5},
    ],
)
def test_a_rule_that_can_win_is_not_reported(scene: Scene, first: dict[str, Any]) -> None:
    ways = {
        "where": scene.heard.where(bool),
        "holds": scene.heard & scene.out.holds(bool),
        "min_age": scene.heard.min_age(1),
        "detached": scene.heard.detached() & scene.module.signal("other"),
    }
    options = dict(first)
    when = ways[options.pop("when")] if "when" in options else scene.heard
    scene.rule("first", when, writes=scene.out, **options)
    scene.rule("second", scene.heard, writes=scene.out)
    assert ("never-wins", "m:second") not in scene.findings()


def test_a_rule_with_two_clauses_is_not_reported_if_one_of_them_can_win(scene: Scene) -> None:
    scene.rule("first", scene.heard, writes=scene.out, weight=2)
    scene.rule("second", scene.heard | scene.module.signal("other"), writes=scene.out)
    assert ("never-wins", "m:second") not in scene.findings()


def test_a_tie_names_the_rule_that_goes_first(scene: Scene) -> None:
    a, b = scene.module.signal("a", input=True), scene.module.signal("b", input=True)
    scene.rule("left", scene.heard & a, writes=scene.out)
    scene.rule("right", scene.heard & b, writes=scene.out)
    found = scene.findings()
    assert list(found) == [("tie", "m:right")]
    assert found["tie", "m:right"].endswith(
        "have the same utility for m:out. m:left goes first because it is declared first; to choose "
        "yourself, give one of the rules a weight"
    )


def test_a_weight_decides_between_rules_with_a_utility_of_0(scene: Scene) -> None:
    scene.rule("left", scene.heard, writes=scene.out, cooldown=1.0)
    scene.rule("right", scene.heard, writes=scene.out, weight=1.2, cooldown=1.0)
    assert scene.findings() == {}


def test_a_cooldown_without_a_rival_is_reported(scene: Scene) -> None:
    bored = scene.module.signal("bored", input=True)
    scene.rule("chat", scene.heard, writes=scene.out)
    scene.rule("nag", bored, writes=scene.out, cooldown=300.0)
    scene.rule("blink", bored, cooldown=1.0)
    found = scene.findings()
    assert list(found) == [("cooldown", "m:nag"), ("cooldown", "m:blink")]
    assert (
        "rule m:nag has a cooldown of 300 s, but no rival: a cooldown only lets other rules go first"
        in found["cooldown", "m:nag"]
    )
    scene.rule("sing", bored, writes=scene.out, weight=1.2, cooldown=300.0)
    assert list(scene.findings()) == [("cooldown", "m:blink")]


def test_signals_that_no_rule_hears_are_reported(scene: Scene) -> None:
    lost, watched, free = (scene.module.signal(name) for name in ("lost", "watched", "free"))
    scene.rule("emit", scene.heard, emits=(lost, watched))
    scene.rule("watch", scene.heard, writes=scene.out, until=watched)
    found = scene.findings()
    assert list(found) == [
        ("unheard", "m:lost")
    ]  # not reported: `free`, which no rule raises, and slots, which can be read
    assert (
        found["unheard", "m:lost"]
        == "unheard: no rule hears signal m:lost, which m:emit may raise; remove it, or write a rule that hears it"
    )
    assert free.name == "m:free"


def test_findings_come_in_the_order_of_their_kinds(scene: Scene) -> None:
    lost, mood = scene.module.signal("lost"), scene.module.slot("mood")
    scene.rule("emit", scene.heard, writes=scene.out, emits=lost)
    scene.rule("same", scene.heard, writes=scene.out)
    scene.rule("loop", mood.changed, writes=mood, detached=True)
    kinds = [kind for kind, _ in scene.findings()]
    assert kinds == ["unreachable", "loop", "never-wins", "tie", "unheard"]


def test_the_advice_for_two_rules_at_startup_is_a_detached_constraint(scene: Scene) -> None:
    """Because startup comes only once, neither another signal nor a cooldown would help the second rule."""
    scene.rule("listen", rs.startup, writes=scene.out, cooldown=5.0)
    scene.rule("serve", rs.startup, writes=scene.out)
    text = scene.findings()["never-wins", "m:serve"]
    assert text.startswith("never-wins: rule m:serve runs only when m:listen resigns")
    assert text.endswith("core:startup comes only once: if both should run, write rs.startup.detached()")


def test_rules_on_detached_startup_do_not_compete(scene: Scene) -> None:
    scene.rule("listen", rs.startup.detached(), writes=scene.out)
    scene.rule("serve", rs.startup.detached(), writes=scene.out)
    assert scene.findings() == {}


def test_only_the_tie_with_the_first_declared_rule_is_reported(scene: Scene) -> None:
    for number in range(300):
        scene.rule(f"r{number}", scene.heard, writes=scene.out)
    ties = [text for (kind, _), text in scene.findings().items() if kind == "tie"]
    assert len(ties) == 299
    assert all("rules m:r0 and" in text for text in ties)


def test_rules_with_the_same_payload_predicate_tie(scene: Scene) -> None:
    def one(payload: object) -> bool:
        return payload == 1

    def two(payload: object) -> bool:
        return payload == 2

    scene.rule("one", scene.heard.where(one), writes=scene.out)
    scene.rule("two", scene.heard.where(two), writes=scene.out)
    scene.rule("again", scene.heard.where(two), writes=scene.out)
    ((kind, subject), text), *others = scene.findings().items()
    assert (kind, subject, others) == ("tie", "m:again", [])
    assert "rules m:two and m:again have" in text


def test_long_lists_of_names_are_cut(scene: Scene) -> None:
    lost = scene.module.signal("lost")
    for number in range(50):
        scene.rule(f"r{number}", scene.heard, emits=lost)
    text = scene.findings()["unheard", "m:lost"]
    assert "which m:r0, m:r1, m:r2, m:r3, m:r4, m:r5, m:r6, m:r7 and 42 more may raise" in text


def test_the_message_names_the_best_of_several_winners(scene: Scene) -> None:
    scene.rule("first", scene.heard, writes=scene.out, weight=2)
    scene.rule("best", scene.heard, writes=scene.out, weight=3)
    scene.rule("last", scene.heard, writes=scene.out)
    assert "runs only when m:best resigns" in scene.findings()["never-wins", "m:last"]


def test_signals_that_no_rule_raises_are_reported(scene: Scene) -> None:
    """A signal from outside needs input=True. The signals of a slot are not reported, because any code may write it."""
    question, stop = scene.module.signal("question"), scene.module.signal("stop")
    scene.rule("answer", question | scene.out.changed, until=stop)
    found = scene.findings()
    assert list(found) == [("unraised", "m:question"), ("unraised", "m:stop")]
    assert found["unraised", "m:question"] == (
        "unraised: signal m:question has listeners (m:answer), and no rule raises it; if it comes from outside, "
        "declare it with input=True"
    )


# ---------------------------------------------------------------------------------------- loops (L23)


def test_detached_rules_that_trigger_each_other_are_reported_as_a_loop(scene: Scene) -> None:
    one, other = scene.module.signal("one"), scene.module.signal("other")
    scene.rule("start", scene.heard, emits=one)
    scene.rule("ping", one, emits=other, detached=True)
    scene.rule("pong", other, emits=one, detached=True)
    found = scene.findings()
    assert list(found) == [("loop", "m:ping")]
    assert found["loop", "m:ping"] == (
        "loop: rules m:ping, m:pong trigger each other through m:other, m:one without time passing, and may never end "
        "(law L23): add .min_age(seconds) to one of these signals"
    )


def test_a_loop_through_a_detached_constraint_is_reported(scene: Scene) -> None:
    tick = scene.module.signal("tick")
    scene.rule("again", tick.detached() | scene.heard, emits=tick)
    text = scene.findings()["loop", "m:again"]
    assert text.startswith("loop: rule m:again triggers itself through m:tick without time passing, and may never end")


@pytest.mark.parametrize("end", ["group", "min_age", "input", "where", "holds"])
def test_loops_that_end_or_take_time_are_not_reported(scene: Scene, end: str) -> None:
    one, other = scene.module.signal("one"), scene.module.signal("other")
    wanted: dict[str, rs.Condition] = {
        "group": one,
        "min_age": one.min_age(1),
        "input": one & scene.heard,
        "where": one.where(bool),
        "holds": one & scene.out.holds(bool),
    }
    scene.rule("start", scene.heard, emits=one)
    scene.rule("ping", wanted[end], emits=other, detached=end != "group")
    scene.rule("pong", other, emits=one)
    assert scene.findings() == {}


@pytest.mark.parametrize("kind", ["async", "plain"])
def test_a_loop_with_a_rule_that_sleeps_is_not_reported(scene: Scene, kind: str) -> None:
    tick = scene.module.signal("tick")

    async def wait(ctx: rs.RuleContext) -> None:
        await ctx.sleep(1)
        ctx.emit(tick)

    def work(ctx: Any) -> None:
        ctx.sleep(1)
        ctx.emit(tick)

    function: Any = wait if kind == "async" else work
    scene.module.rule(when=scene.heard | tick, emits=tick, detached=True)(function)
    assert scene.findings() == {}


def test_a_loop_with_a_plain_function_that_can_wait_is_not_reported(scene: Scene) -> None:
    tick, frames = scene.module.signal("tick"), queue.Queue[str]()

    def watch(ctx: Any) -> None:
        ctx[scene.out] = frames.get()
        ctx.emit(tick)

    scene.module.rule(when=rs.startup | tick, writes=scene.out, emits=tick, detached=True)(watch)
    assert not [key for key in scene.findings() if key[0] == "loop"]


def test_a_loop_with_a_plain_function_that_only_uses_its_context_is_reported(scene: Scene) -> None:
    tick = scene.module.signal("tick")

    def work(ctx: Any) -> None:
        ctx.emit(tick)

    scene.module.rule(when=scene.heard | tick, emits=tick, detached=True)(work)
    assert ("loop", "m:work") in scene.findings()


# ---------------------------------------------------------------------------------------- source


def test_the_source_of_rules_is_examined_only_on_demand(scene: Scene) -> None:
    @scene.module.rule(when=scene.heard)
    async def say(ctx: rs.RuleContext) -> None:
        ctx[scene_out] = "hello"

    scene_out = scene.out
    assert scene.findings() == {}
    ((kind, subject), text), *others = scene.findings(inspect.getsource).items()
    assert (kind, subject, others) == ("undeclared", "m:say", [])
    line = say.function.__code__.co_firstlineno + 2
    assert text == (
        f"undeclared: rule m:say ({say.origin}) writes m:out (line {line}) without declaring it: declare writes=out"
    )


def test_a_forgotten_await_is_reported(scene: Scene) -> None:
    @scene.module.rule(when=scene.heard, name="later")
    async def later(ctx: rs.RuleContext) -> None:
        ctx.sleep(1)  # type: ignore[unused-coroutine]

    @scene.module.rule(when=scene.heard, name="plain")
    def plain(ctx: rs.RuleContext) -> None:
        ctx.sleep(1)  # type: ignore[unused-coroutine]

    found = scene.findings(inspect.getsource)
    assert found["await", "m:later"].endswith("without effect: write await ctx.sleep(...)")
    assert found["await", "m:plain"].endswith("without effect: write await ctx.sleep(...) in an async def")


def test_a_rule_that_replaces_a_slot_instead_of_writing_it_is_reported(scene: Scene) -> None:
    place = types.ModuleType("place")
    place.out = scene.out  # type: ignore[attr-defined]

    @scene.module.rule(when=scene.heard, writes=scene.out)
    async def say(ctx: rs.RuleContext) -> None:
        place.other = 1  # type: ignore[attr-defined]
        place.out = "hello"  # type: ignore[attr-defined]

    ((kind, subject), text), *others = scene.findings(inspect.getsource).items()
    assert (kind, subject, others) == ("assignment", "m:say", [])
    line = say.function.__code__.co_firstlineno + 3
    assert text.endswith(f"replaces the slot place.out in line {line}, for all agents: write ctx[place.out] = ...")


def test_the_built_in_modules_together_have_no_false_finding() -> None:
    policy = rs.compile(*(getattr(modules, name) for name in BUILT_IN))
    assert {finding.kind for finding in policy.findings(inspect.getsource)} <= {"unheard"}
