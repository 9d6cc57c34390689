"""The static graph of causes (law L7): which rules can cause a signal, directly or through other rules."""

import ravestate as rs
from ravestate.policy.causes import Causes
from ravestate.policy.policy import Policy

Ctx = rs.RuleContext


def rule(module: rs.Module, name: str, when: rs.Condition, **options: object) -> None:
    async def function(ctx: Ctx) -> None:
        pass

    module.rule(when=when, name=name, **options)(function)


def names(policy: Policy, rules: frozenset[int]) -> list[str]:
    return [policy.rule_plans[index].name.split(":")[1] for index in sorted(rules)]


def signals(policy: Policy, *which: str) -> list[int]:
    return [policy.signal_of[f"m:{name}"].index for name in which]


def chain() -> tuple[Policy, Causes]:
    """Return a policy: entry -> first -> x -> second (detached) -> y -> third -> out.

    The rule `aside` has a detached constraint on x: x (detached) -> aside -> z -> fourth -> out.
    """
    m = rs.Module("m")
    entry, x, y, z = (m.signal(name) for name in ("entry", "x", "y", "z"))
    out = m.slot("out")
    rule(m, "first", entry, emits=x)
    rule(m, "second", x, emits=y, detached=True)
    rule(m, "third", y, writes=out)
    rule(m, "aside", x.detached(), emits=z)
    rule(m, "fourth", z, writes=out)
    policy = rs.compile(m)
    return policy, policy.causes


def test_direct_causes_with_and_without_detached_rules() -> None:
    policy, causes = chain()
    (y,) = signals(policy, "y")
    assert causes.causes[y] == []
    assert [r.name for r in causes.all_causes[y]] == ["m:second"]


def test_ancestors_stop_at_detached_rules_and_detached_constraints() -> None:
    policy, causes = chain()
    x, y, z, out = signals(policy, "x", "y", "z", "out:changed")
    assert names(policy, causes.ancestors(x)) == ["first"]
    assert names(policy, causes.ancestors(y)) == []
    assert names(policy, causes.ancestors(z)) == ["aside"]
    assert names(policy, causes.ancestors(out)) == ["third", "aside", "fourth"]
    assert causes.ancestors(out) is causes.ancestors(out)  # the set is computed only once


def test_the_wide_set_of_ancestors_includes_causes_through_detached_effects() -> None:
    policy, causes = chain()
    y, z = signals(policy, "y", "z")
    assert names(policy, causes.wide_ancestors(y)) == ["first", "second"]
    assert names(policy, causes.wide_ancestors(z)) == ["first", "aside"]


def test_the_wide_set_of_ancestors_stops_at_inputs() -> None:
    m = rs.Module("m")
    entry, x, y = m.signal("entry"), m.signal("x", input=True), m.signal("y")
    rule(m, "first", entry, emits=x)
    rule(m, "second", x, emits=y)
    policy = rs.compile(m)
    assert names(policy, policy.causes.wide_ancestors(policy.signal_of["m:y"].index)) == ["second"]


def test_downstream_clauses_are_those_that_a_rule_can_help_to_write_in_order_of_utility() -> None:
    m = rs.Module("m")
    entry, x, y = (m.signal(name) for name in ("entry", "x", "y"))
    out = m.slot("out")
    rule(m, "first", entry, emits=x)
    rule(m, "plain", x, writes=out)
    rule(m, "rich", x & y, writes=out)
    rule(m, "silent", x)
    rule(m, "looks", x.detached() & y, writes=out)
    rule(m, "lonely", entry, emits=x, detached=True)
    policy = rs.compile(m)
    downstream = policy.causes.downstream
    assert [str(clause) for clause in downstream(policy.rule_plan("m:first"))] == ["m:rich", "m:plain"]
    assert downstream(policy.rule_plan("m:lonely")) == ()
    assert downstream(policy.rule_plan("m:plain")) == ()


def test_a_signal_is_grounded_if_it_can_follow_from_the_given_signals() -> None:
    policy, causes = chain()
    entry, x, y, z, out = signals(policy, "entry", "x", "y", "z", "out:changed")
    assert causes.grounded([entry]) >= {entry, x, y, z, out}
    assert causes.grounded([z]) == {z, out}
    assert causes.grounded([]) == frozenset()


def test_an_effect_is_grounded_only_if_all_signals_of_a_clause_are() -> None:
    m = rs.Module("m")
    a, b, c = (m.signal(name) for name in "abc")
    rule(m, "both", a & b, emits=c)
    policy = rs.compile(m)
    ia, ib, ic = signals(policy, "a", "b", "c")
    assert ic not in policy.causes.grounded([ia])
    assert ic in policy.causes.grounded([ia, ib])


def test_ancestors_in_a_cycle_are_found_once() -> None:
    m = rs.Module("m")
    entry, a, b = (m.signal(name) for name in ("entry", "a", "b"))
    rule(m, "enter", entry, emits=a)
    rule(m, "there", a, emits=b)
    rule(m, "back", b, emits=a)
    policy = rs.compile(m)
    (index,) = signals(policy, "a")
    assert names(policy, policy.causes.ancestors(index)) == ["enter", "there", "back"]
    assert names(policy, policy.causes.wide_ancestors(index)) == ["enter", "there", "back"]
