"""A policy is immutable and can be shared. Its parts have names."""

import re
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from ravestate.testing import simulate


class Late(rs.Settings):
    after: float = 2.0


demo = rs.Module("demo", settings=Late)
go, stop = demo.signal("go"), demo.signal("stop")
count, seen = demo.slot("count", 0), demo.slot("seen", [])


@demo.rule(when=go, writes=count)
async def add(ctx: rs.RuleContext) -> None:
    ctx[count] = ctx[count] + 1


@demo.rule(when=go.min_age(Late.after) & stop, writes=seen)
async def late(ctx: rs.RuleContext) -> None:
    ctx[seen] = [*ctx[seen], "late"]


policy = rs.compile(demo)


def test_the_parts_of_a_policy_have_names_and_cannot_change() -> None:
    assert policy.rules["demo:add"] is add and list(policy.rules) == ["demo:add", "demo:late"]
    assert policy.signals["demo:go"] is go and policy.signals["demo:count:changed"] is count.changed
    assert policy.slots["demo:count"] is count
    for mapping in (policy.rules, policy.signals, policy.slots):
        with pytest.raises(TypeError):
            mapping["x"] = None
    assert repr(policy) == "<policy of 2 rules in 2 modules>"


def test_a_rule_can_be_given_by_its_name() -> None:
    assert policy.utility(add) == policy.utility("demo:add")
    assert policy.clauses(late) == policy.clauses("demo:late")


@pytest.mark.parametrize("ask", ["utility", "clauses", "rule_plan"])
def test_the_message_about_an_unknown_rule_names_the_nearest(ask: str) -> None:
    with pytest.raises(rs.DeclarationError, match="no rule 'demo:ad'; did you mean 'demo:add'"):
        getattr(policy, ask)("demo:ad")


def test_later_declarations_are_only_in_the_next_policy() -> None:
    m = rs.Module("m")
    s = m.signal("s")
    before = rs.compile(m)

    @m.rule(when=s)
    async def new(ctx: rs.RuleContext) -> None:
        pass

    assert list(before.rules) == [] and list(rs.compile(m).rules) == ["m:new"]


def test_one_policy_serves_many_contexts() -> None:
    with simulate(policy) as one, simulate(policy) as other:
        assert one.context.policy.causes is not None
        one.emit(go)
        one.emit(go)
        other.emit(go)
        assert (one.read(count), other.read(count)) == (2, 1)
        assert one.read(seen) is not other.read(seen)
        assert one.read(seen) is not seen.default


# ---------------------------------------------------------------------------------------- with_settings


def test_given_settings_replace_the_defaults_of_the_settings_class() -> None:
    changed = policy.with_settings({"demo": Late(after=4.0)})
    assert changed.rule_plan(late).clauses[0].needs[0].min_age == 4.0
    assert policy.rule_plan(late).clauses[0].needs[0].min_age == 2.0
    assert list(changed.rules) == list(policy.rules)
    assert changed.settings == {"demo": Late(after=4.0)}


def test_with_settings_returns_the_same_policy_if_it_has_no_references_to_settings() -> None:
    plain = rs.compile(rs.Module("plain"))
    assert plain.with_settings({}) is plain


def faults(make: Callable[[], object]) -> str:
    with pytest.raises(rs.DeclarationErrors) as caught:
        make()
    return str(caught.value)


def test_settings_that_make_a_declaration_impossible_are_refused() -> None:
    late = faults(lambda: policy.with_settings({"demo": Late(after=6.0)}))
    assert "demo:go can never be at least 6 s and at most 5 s old" in late
    early = faults(lambda: policy.with_settings({"demo": Late(after=-1.0)}))
    assert "demo:go.min_age=Late.after = -1.0 must be 0 s or more" in early


# ---------------------------------------------------------------------------------------- with_rule


def extra(name: str = "extra", when: rs.Condition = go, **options: Any) -> rs.Rule[Any, Any]:
    async def function(ctx: rs.RuleContext) -> None:
        pass

    return rs.Module("added").rule(when=when, name=name, **options)(function)


def test_adding_a_rule_makes_a_new_policy() -> None:
    more = policy.with_rule(extra(writes=count))
    assert list(more.rules) == ["demo:add", "demo:late", "added:extra"]
    assert list(policy.rules) == ["demo:add", "demo:late"]
    assert [p.index for p in more.rule_plans] == [0, 1, 2]
    assert more.utility("demo:late") > policy.utility(
        "demo:late"
    )  # `stop` is now on the pathways of one rule in three, and before of one in two


def test_an_added_rule_can_refer_to_a_setting() -> None:
    plain = rs.Module("plain", settings=Late)
    plain.signal("x")
    base = rs.compile(plain)
    rule = plain.rule(when=plain.signals[0], name="slow", cooldown=Late.after)(add.function)
    assert base.with_rule(rule).rule_plan("plain:slow").cooldown == 2.0
    assert base.with_rule(rule, {"plain": Late(after=9.0)}).rule_plan("plain:slow").cooldown == 9.0
    kept = policy.with_settings({"demo": Late(after=3.0)})
    rule = rs.Module("demo").rule(when=go, name="kept", cooldown=rs.setting("after"))(add.function)
    assert kept.with_rule(rule).rule_plan("demo:kept").cooldown == 3.0


@pytest.mark.parametrize(
    ("rule", "text"),
    [
        (extra(when=rs.Module("far").signal("x")), "unknown signal far:x"),
        (extra(weight=0), "weight=0.0 must be above 0"),
        (add, "is in the policy already; give the new rule another name=..."),
        (lambda ctx: None, "is not a rule: write @module.rule"),
    ],
)
def test_a_rule_that_does_not_fit_is_refused(rule: Any, text: str) -> None:
    assert text in faults(lambda: policy.with_rule(rule))


@pytest.mark.parametrize("wrong", [None, 3, len])
def test_a_question_about_something_that_is_no_rule_names_the_value(wrong: Any) -> None:
    with pytest.raises(rs.DeclarationError, match=re.escape(f"the policy has no rule {str(wrong)!r}")):
        rs.compile().utility(wrong)
