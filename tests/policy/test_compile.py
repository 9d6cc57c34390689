"""Compiling (law L6): declaration order, numbers from settings, and all faults together, each with what to write."""

import re
import types
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from ravestate.testing import simulate

HERE = re.escape(__file__)


class Late(rs.Settings):
    after: float = 2.0
    label: str = "x"
    on: bool = True


class Other(rs.Settings):
    pause: float = 7.0


def rule(module: rs.Module, name: str, when: rs.Condition, **options: Any) -> rs.Rule[Any, Any]:
    async def function(ctx: rs.RuleContext) -> None:
        pass

    return module.rule(when=when, name=name, **options)(function)


def faults(*modules: Any) -> list[str]:
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.compile(*modules)
    return [str(fault) for fault in caught.value.exceptions]


# ---------------------------------------------------------------------------------------- policies without faults


def test_without_modules_the_policy_has_only_core() -> None:
    policy = rs.compile()
    assert [module.name for module in policy.modules] == ["core"]
    assert list(policy.signals)[:3] == ["core:startup", "core:shutdown", "core:error"]


def test_a_module_is_listed_once_and_after_the_modules_that_it_requires() -> None:
    base = rs.Module("base")
    left, right = rs.Module("left", requires=[base]), rs.Module("right", requires=[base])
    top = rs.Module("top", requires=[right, left])
    assert [m.name for m in rs.compile(top, left, top).modules] == ["core", "base", "right", "left", "top"]


def test_python_modules_are_accepted() -> None:
    holder = types.ModuleType("holder")
    vars(holder)["module"] = module = rs.Module("held")
    assert module in rs.compile(holder).modules


def test_rules_clauses_and_names_keep_the_order_of_declaration() -> None:
    m = rs.Module("m")
    b, a = m.signal("b"), m.signal("a")
    rule(m, "z", a | b)
    rule(m, "y", b)
    policy = rs.compile(m)
    assert list(policy.rules) == ["m:z", "m:y"]
    assert [name for name in policy.signals if name.startswith("m:")] == ["m:b", "m:a"]
    assert [clause.signals for clause in policy.clauses("m:z")] == [(a,), (b,)]


def test_a_signal_is_an_input_if_no_rule_raises_it_or_if_it_is_declared_as_one() -> None:
    m = rs.Module("m")
    free, raised, both = m.signal("free"), m.signal("raised"), m.signal("both", input=True)
    rule(m, "r", free, emits=(raised, both), detached=True)
    policy = rs.compile(m)
    assert [policy.signal_of[f"m:{name}"].input for name in ("free", "raised", "both")] == [True, False, True]


def test_constraints_with_a_common_cause_must_cohere() -> None:
    m = rs.Module("m")
    heard, seen = m.signal("heard"), m.signal("seen")
    question, about = m.signal("question"), m.signal("about")
    rule(m, "q", heard, emits=question)
    rule(m, "a", heard, emits=about)
    rule(m, "both", question & about & seen & heard.detached())
    (clause,) = rs.compile(m).rule_plan("m:both").clauses
    assert [need.kin for need in clause.needs] == [0b011, 0b011, 0b100, 0b1000]


# ---------------------------------------------------------------------------------------- unknown names


def test_the_message_names_a_module_that_is_not_required() -> None:
    elsewhere = rs.Module("elsewhere")
    word, note = elsewhere.signal("word", input=True), elsewhere.slot("note")
    m = rs.Module("m")
    rule(m, "r", word, reads=note, writes=note, emits=word, until=note.changed)
    found = faults(m)
    assert len(found) == 5
    for text in found:
        assert re.match(rf"rule m:r \({HERE}:\d+\): (when|until|reads|writes|emits): unknown ", text)
        assert re.search(rf"\(declared at {HERE}:\d+\)", text)
        assert "write requires=[elsewhere] in the module of the rule, or compile module elsewhere as well" in text
    assert rs.compile(m, elsewhere).rules["m:r"].when is word


def test_a_signal_of_another_module_with_the_same_name_is_refused() -> None:
    first, second = rs.Module("twin"), rs.Module("twin")
    word = first.signal("word")
    second.signal("word")
    m = rs.Module("m", requires=[second])
    rule(m, "r", word)
    (text,) = faults(m)
    assert "the policy has another signal of that name: two modules are named 'twin'" in text


def test_the_message_about_an_unknown_signal_names_the_nearest() -> None:
    m = rs.Module("m")
    word = m.signal("wrod")
    m.signals.remove(word)
    m.signal("word")
    rule(m, "r", word)
    (text,) = faults(m)
    assert text.endswith("module m has no such signal; did you mean 'm:word'?")


# ---------------------------------------------------------------------------------------- names used twice


def test_two_modules_with_one_name_are_refused() -> None:
    one, other = rs.Module("twin"), rs.Module("twin")
    for module in (one, other):
        rule(module, "r", module.signal("s"), writes=module.slot("t"))
    found = faults(one, other)
    assert any(re.match(rf"two modules are named 'twin': {HERE}:\d+ and {HERE}:\d+; rename one", f) for f in found)
    assert not any("two signals" in text or "two slots" in text or "two rules" in text for text in found)


def test_no_other_module_may_be_named_core() -> None:
    assert "two modules are named 'core'" in faults(rs.Module("core"))[0]


def test_two_signals_slots_or_rules_with_one_name_are_refused() -> None:
    m = rs.Module("m")
    go = m.signal("go")
    m.signal("go")
    m.slot("mood")
    m.flag("mood")
    rule(m, "r", go)
    rule(m, "r", go)
    text = "\n".join(faults(m))
    for what in ("signals are named 'm:go'", "slots are named 'm:mood'", "rules are named 'm:r'"):
        assert re.search(rf"two {what}: {HERE}:\d+ and {HERE}:\d+; rename one", text), text


# ---------------------------------------------------------------------------------------- requires


def test_the_message_shows_a_cycle_of_requires() -> None:
    a, b, c = rs.Module("a"), rs.Module("b"), rs.Module("c")
    a.requires, b.requires, c.requires = [b], [c], [a]
    (text,) = faults(a)
    assert text.startswith("modules require each other in a cycle: a -> b -> c -> a; remove one `requires`")
    a.requires = [a]
    assert faults(a)[0].startswith("modules require each other in a cycle: a -> a;")


@pytest.mark.parametrize("value", ["rawio", None, 3, rs.compile()])
def test_requiring_a_value_that_is_not_a_module_is_refused(value: object) -> None:
    (text,) = faults(value)
    assert text == f"expected an rs.Module (or a Python module that holds one), not {value!r}"


# ---------------------------------------------------------------------------------------- ages and numbers


def only_fault(build: Callable[[rs.Module, rs.Signal[None]], object], **options: Any) -> str:
    m = rs.Module("m", **options)
    build(m, m.signal("go"))
    (text,) = faults(m)
    assert re.match(rf"rule m:r \({HERE}:\d+\): ", text), text
    return text


def test_a_min_age_above_the_default_max_age_needs_an_explicit_max_age() -> None:
    text = only_fault(lambda m, go: rule(m, "r", go.min_age(10)))
    assert "m:go can never be at least 10 s and at most 5 s old" in text
    assert "write .min_age(10).max_age(None) (max_age is 5 s by default)" in text


def test_ages_that_exclude_each_other_are_refused() -> None:
    text = only_fault(lambda m, go: rule(m, "r", go.min_age(3).max_age(2)))
    assert text.endswith("write .min_age(3).max_age(None)")


@pytest.mark.parametrize("age", [-1, float("nan"), float("inf"), -float("inf")])
def test_an_age_that_is_negative_or_not_finite_is_refused(age: float) -> None:
    assert "m:go.min_age" in only_fault(lambda m, go: rule(m, "r", go.min_age(age).max_age(None)))
    text = only_fault(lambda m, go: rule(m, "r", go.max_age(age)))
    assert f"m:go.max_age={age!r}" in text.replace("-1.0", "-1") and text.endswith("0 s or more")


@pytest.mark.parametrize(
    ("what", "value", "wanted"),
    [
        ("weight", 0, "above 0"),
        ("weight", -1, "above 0"),
        ("weight", float("inf"), "a finite number, above 0"),
        ("cooldown", -0.5, "0 s or more"),
        ("cooldown", float("nan"), "a finite number, 0 s or more"),
        ("patience", -1, "0 s or more"),
        ("timeout", 0, "more than 0 s"),
        ("timeout", float("inf"), "a finite number, more than 0 s"),
    ],
)
def test_a_number_out_of_range_is_refused(what: str, value: float, wanted: str) -> None:
    text = only_fault(lambda m, go: rule(m, "r", go, **{what: value}))
    assert text.endswith(f"{what}={float(value)!r} must be {wanted}")


def test_the_extreme_values_of_each_range_are_allowed() -> None:
    m = rs.Module("m")
    go = m.signal("go")
    rule(m, "r", go.min_age(5).max_age(5), weight=1e-9, cooldown=0, patience=0, timeout=1e-9)
    plan = rs.compile(m).rule_plan("m:r")
    assert (plan.weight, plan.cooldown, plan.patience, plan.timeout) == (1e-9, 0.0, 0.0, 1e-9)
    (need,) = plan.clauses[0].needs
    assert (need.min_age, need.max_age) == (5.0, 5.0)


def test_a_condition_of_slot_predicates_alone_is_refused() -> None:
    m = rs.Module("m")
    mood = m.slot("mood")
    rule(m, "r", mood.holds(bool) | m.signal("go"))
    (text,) = faults(m)
    assert (
        "'m:mood.holds(bool)' has no signal, and a predicate on a slot triggers no rule: write mood.changed & ..."
        in text
    )


def test_too_many_clauses_are_refused() -> None:
    m = rs.Module("m")
    condition: rs.Condition = m.signal("a") | m.signal("b")
    for number in range(9):
        condition = condition & (m.signal(f"c{number}") | m.signal(f"d{number}"))
    rule(m, "r", condition)
    assert "when: its condition has 1024 alternatives, more than 256" in faults(m)[0]


@pytest.mark.parametrize(
    ("least", "most"),
    [(0, 0), (0, None), (0, 1e-9), (3, 3), (5, 5), (1e9, None), (4.5, 5), (rs.setting("after"), 2), (2, rs.setting("after"))],
)  # fmt: skip
def test_ages_that_a_spike_can_have_are_allowed(least: Any, most: Any) -> None:
    m = rs.Module("m", settings=Late)
    rule(m, "r", m.signal("go").min_age(least).max_age(most))
    (need,) = rs.compile(m).rule_plan("m:r").clauses[0].needs
    assert need.min_age <= need.max_age


@pytest.mark.parametrize(
    ("least", "most", "text"),
    [
        (1, 0, "at least 1 s and at most 0 s old: write .min_age(1).max_age(None)"),
        (1e-9, 0, "at least 1e-09 s and at most 0 s old"),
        (5.5, 5, "at least 5.5 s and at most 5 s old"),
        (rs.setting("after"), 0, "at least 2 s and at most 0 s old: write .min_age(2).max_age(None)"),
        (2.5, rs.setting("after"), "at least 2.5 s and at most 2 s old"),
    ],
)
def test_ages_that_no_spike_can_have_are_refused(least: Any, most: Any, text: str) -> None:
    assert text in only_fault(lambda m, go: rule(m, "r", go.min_age(least).max_age(most)), settings=Late)
    assert text in only_fault(  # the same in a second clause, and for a detached constraint
        lambda m, go: rule(m, "r", m.signal("other") | go.detached().min_age(least).max_age(most)),
        settings=Late,
    )


def test_the_ages_of_until_are_checked_too() -> None:
    text = only_fault(lambda m, go: rule(m, "r", go, until=go.min_age(1).max_age(0)))
    assert "until: m:go can never be at least 1 s and at most 0 s old" in text


def test_a_rule_with_max_age_0_takes_a_spike_at_the_moment_of_its_birth() -> None:
    m = rs.Module("m")
    go = m.signal("go")
    rule(m, "now", go.max_age(0))
    with simulate(m) as sim:
        sim.emit(go)
        assert sim.fired == ["m:now"]


# ---------------------------------------------------------------------------------------- size


def test_a_chain_of_requires_of_any_length_compiles() -> None:
    module = rs.Module("m0")
    for number in range(1, 3000):
        module = rs.Module(f"m{number}", requires=[module])
    assert [m.name for m in rs.compile(module).modules][:4] == ["core", "m0", "m1", "m2"]


# ---------------------------------------------------------------------------------------- settings


def test_a_reference_to_a_setting_means_its_default_until_settings_are_given() -> None:
    m = rs.Module("m", settings=Late)
    rule(m, "r", m.signal("go").min_age(Late.after), cooldown=rs.setting("after"))
    plan = rs.compile(m).rule_plan("m:r")
    assert (plan.clauses[0].needs[0].min_age, plan.cooldown) == (2.0, 2.0)


def test_a_setting_of_another_module_is_found_by_its_class() -> None:
    other = rs.Module("other", settings=Other)
    m = rs.Module("m", requires=[other], settings=Late)
    rule(m, "r", m.signal("go"), cooldown=Other.pause)
    assert rs.compile(m).rule_plan("m:r").cooldown == 7.0


@pytest.mark.parametrize(
    ("ref", "text"),
    [
        (rs.setting("aftre"), "settings of module m have no field 'aftre'; did you mean 'after'?"),
        (Late.label, "the setting is 'x', not a number; give it a number as its default"),
        (Late.on, "the setting is True, not a number"),
    ],
)
def test_a_setting_that_is_missing_or_not_a_number_is_refused(ref: Any, text: str) -> None:
    assert text in only_fault(lambda m, go: rule(m, "r", go, cooldown=ref), settings=Late)


def test_a_reference_to_a_setting_needs_a_module_with_settings() -> None:
    text = only_fault(lambda m, go: rule(m, "r", go, cooldown=rs.setting("after")))
    assert "module m has no settings: write rs.Module('m', settings=Settings) with a field after" in text


def test_the_error_about_a_setting_out_of_range_has_its_name_and_value() -> None:
    class Bad(rs.Settings):
        after: float = -2.0

    text = only_fault(lambda m, go: rule(m, "r", go, cooldown=Bad.after), settings=Bad)
    assert text.endswith("cooldown=Bad.after = -2.0 must be 0 s or more")


# ---------------------------------------------------------------------------------------- unreachable, all together


def test_rules_that_wait_only_for_each_other_are_unreachable() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b")
    rule(m, "first", b, emits=a)
    rule(m, "second", a, emits=b)
    found = faults(m)
    assert len(found) == 2
    assert re.match(
        rf"rule m:first \({HERE}:\d+\) is unreachable: it waits for m:b; "
        r"no input leads to the rules that may raise it \(m:second\)",
        found[0],
    )
    assert found[0].endswith("if code outside the rules raises the signal, declare it with input=True")


def test_an_input_or_a_detached_rule_makes_a_cycle_reachable() -> None:
    m = rs.Module("m")
    a, b = m.signal("a"), m.signal("b", input=True)
    rule(m, "first", b, emits=a)
    rule(m, "second", a, emits=b)
    rs.compile(m)
    n = rs.Module("n")
    a, b = n.signal("a"), n.signal("b")
    rule(n, "first", b, emits=a, detached=True)
    rule(n, "second", a, emits=b)
    rs.compile(n)


def test_all_faults_are_reported_together() -> None:
    elsewhere = rs.Module("elsewhere")
    word = elsewhere.signal("word")
    m, twin = rs.Module("m"), rs.Module("m")
    ring = rs.Module("ring")
    ring.requires = [ring]
    a, b, go = m.signal("a"), m.signal("b"), m.signal("go")
    rule(m, "unknown", word)
    rule(m, "ages", go.min_age(9))
    rule(m, "number", go, weight=0)
    rule(m, "setting", go, cooldown=rs.setting("after"))
    rule(m, "loop", a, emits=b)
    rule(m, "pool", b, emits=a)
    text = "\n".join(faults(m, twin, ring, "nonsense"))
    for part in (
        "expected an rs.Module", "two modules are named 'm'", "in a cycle: ring -> ring", "unknown signal elsewhere:word",
        "can never be at least 9 s", "weight=0.0 must be above 0", "module m has no settings",
        "rule m:loop", "rule m:pool",
    ):  # fmt: skip
        assert part in text


def test_the_faults_are_raised_as_a_group_of_declaration_errors() -> None:
    with pytest.raises(rs.RavestateError) as caught:
        rs.compile(None)
    assert isinstance(caught.value, ExceptionGroup)
    assert all(isinstance(fault, rs.DeclarationError) for fault in caught.value.exceptions)
