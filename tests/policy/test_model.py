"""The records of a policy: signals, slots, rules and clauses, numbered in declaration order."""

import functools

import ravestate as rs
from ravestate.policy.model import RulePlan

demo = rs.Module("demo")
go, seen = demo.signal("go"), demo.signal("seen", keep="latest", limit=4)
lit, mood = demo.flag("lit"), demo.slot("mood")


@demo.rule(when=go & seen.detached() | lit.true.min_age(1), reads=mood, writes=lit, emits=seen, until=go)
async def work(ctx: rs.RuleContext) -> None:
    pass


@demo.rule(when=go)
def thread(ctx: rs.RuleContext) -> None:
    pass


policy = rs.compile(demo)


def test_signals_and_slots_are_numbered_in_declaration_order() -> None:
    assert [plan.index for plan in policy.signal_plans] == list(range(len(policy.signal_plans)))
    assert [plan.name for plan in policy.signal_plans if plan.name.startswith("demo:")] == [
        "demo:go", "demo:seen", "demo:lit:changed", "demo:lit:true", "demo:lit:false", "demo:mood:changed",
    ]  # fmt: skip
    assert [str(plan) for plan in policy.slot_plans[-2:]] == ["demo:lit", "demo:mood"]
    assert policy.slot_of["demo:lit"].signals == tuple(
        policy.signal_of[f"demo:lit:{s}"] for s in ("changed", "true", "false")
    )


def test_a_signal_has_its_slot_and_overflow_policy() -> None:
    plan = policy.signal_of["demo:seen"]
    assert (plan.keep_latest, plan.limit, plan.slot) == (True, 4, None)
    assert policy.signal_of["demo:lit:true"].slot == policy.slot_of["demo:lit"].index


def test_each_constraint_has_a_bit_and_is_a_listener_of_its_signal() -> None:
    first, second = policy.rule_plan("demo:work").clauses
    assert [need.bit for need in first.needs] == [1, 2]
    assert (first.all_bits, first.firm_bits, first.asks_detached, first.simple) == (3, 1, True, False)
    assert (second.all_bits, second.firm_bits, second.asks_detached, second.simple) == (1, 1, False, False)
    assert policy.signal_of["demo:go"].listeners == (
        first.needs[0],
        policy.rule_plan("demo:thread").clauses[0].needs[0],
    )
    assert [str(need.clause) for need in policy.signal_of["demo:go"].watchers] == ["demo:work[0]"]
    assert policy.signal_of["demo:seen"].retain == 5.0
    assert [str(clause) for clause in (first, second)] == ["demo:work[0]", "demo:work[1]"]
    assert policy.rule_plan("demo:thread").clauses[0].simple


def test_a_rule_has_its_slots_and_signals() -> None:
    plan = policy.rule_plan("demo:work")
    names = {name: s.index for name, s in policy.signal_of.items()}
    assert plan.raises == tuple(names[f"demo:{s}"] for s in ("seen", "lit:changed", "lit:true", "lit:false"))
    assert plan.readable == {policy.slot_of["demo:lit"].index, policy.slot_of["demo:mood"].index}
    assert plan.slots == (policy.slot_of["demo:lit"].index,)
    assert str(plan) == "demo:work"


def test_only_a_coroutine_can_be_interrupted() -> None:
    assert RulePlan(0, work).interruptible
    assert not RulePlan(0, thread).interruptible
    for function in (work.function, thread.function):
        partial = rs.Module("m").rule(when=go, name="partial")(functools.partial(function))
        assert RulePlan(0, partial).interruptible == (function is work.function)
