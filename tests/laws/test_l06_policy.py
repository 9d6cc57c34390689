"""L6: modules compile into an immutable policy, which serves any number of contexts. All faults come together."""

from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from laws.short import emitter, hearer, output, writer

Fault = Callable[[], tuple[list[rs.Module], list[str]]]


def unknown_signal() -> tuple[list[rs.Module], list[str]]:
    m, stranger = rs.Module("uses"), rs.Module("stranger")
    hearer(m, "hear", stranger.signal("ping"), stranger.signal("ping2"), [])
    return [m], ["uses:hear", "stranger:ping", "requires"]


def unknown_slot() -> tuple[list[rs.Module], list[str]]:
    m, stranger = rs.Module("writes"), rs.Module("odd")
    writer(m, "write", m.signal("go"), stranger.slot("value", 0))
    return [m], ["writes:write", "odd:value", "requires"]


def two_modules_with_one_name() -> tuple[list[rs.Module], list[str]]:
    return [rs.Module("twin"), rs.Module("twin")], ["two modules", "'twin'"]


def two_signals_with_one_name() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("signals")
    m.signal("same")
    m.signal("same")
    return [m], ["two signals", "signals:same"]


def two_rules_with_one_name() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("rules")
    go = m.signal("go")

    @m.rule(when=go, name="same")
    async def one(ctx: Any) -> None: ...

    @m.rule(when=go, name="same")
    async def other(ctx: Any) -> None: ...

    return [m], ["two rules", "rules:same"]


def two_rules_with_one_name_from_one_line() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("made")
    go = m.signal("go")
    for _ in range(2):
        hearer(m, "same", go, go, [])
    return [m], ["two rules", "made:same"]


def unreachable_rule() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("loop")
    a, b = m.signal("a"), m.signal("b")
    emitter(m, "hen", a, b)
    emitter(m, "egg", b, a)
    return [m], ["loop:hen", "unreachable", "loop:a"]


def impossible_ages() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("ages")
    go = m.signal("go")
    hearer(m, "hear", go.min_age(7.0), go, [])
    return [m], ["ages:hear", "7", "5", "max_age(None)"]


def negative_age() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("negative")
    go = m.signal("go")
    hearer(m, "hear", go.min_age(-1.0), go, [])
    return [m], ["negative:hear", "-1"]


def cycle_of_requires() -> tuple[list[rs.Module], list[str]]:
    ring = rs.Module("ring")
    wheel = rs.Module("wheel", requires=[ring])
    ring.requires.append(wheel)
    return [ring], ["cycle", "ring -> wheel -> ring"]


def no_signal() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("gate")
    mood = m.slot("mood", 0)
    hearer(m, "hear", mood.holds(bool), mood.changed, [])
    return [m], ["gate:hear", "mood.changed"]


def option_out_of_range(option: str, value: float) -> Fault:
    def fault() -> tuple[list[rs.Module], list[str]]:
        m = rs.Module(f"bad_{option}")
        go = m.signal("go")
        hearer(m, "hear", go, go, [], **{option: value})
        return [m], [f"bad_{option}:hear", option, str(value)]

    fault.__name__ = f"{option}_out_of_range"
    return fault


def unknown_setting() -> tuple[list[rs.Module], list[str]]:
    m = rs.Module("unset")
    go = m.signal("go")
    hearer(m, "hear", go.min_age(rs.setting("nowhere")), go, [])
    return [m], ["unset:hear", "nowhere"]


FAULTS: list[Fault] = [
    unknown_signal, unknown_slot, two_modules_with_one_name, two_signals_with_one_name, two_rules_with_one_name,
    two_rules_with_one_name_from_one_line, unreachable_rule, impossible_ages, negative_age, cycle_of_requires, no_signal, unknown_setting,
    option_out_of_range("weight", 0.0), option_out_of_range("cooldown", -1.0),
    option_out_of_range("patience", -1.0), option_out_of_range("timeout", 0.0),
]  # fmt: skip


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_a_fault_is_reported_at_compile_time(fault: Fault) -> None:
    modules, words = fault()
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.compile(*modules)
    assert all(isinstance(one, rs.DeclarationError) for one in caught.value.exceptions)
    assert any(all(word in str(one) for word in words) for one in caught.value.exceptions), str(caught.value)


def test_all_faults_are_reported_together() -> None:
    cases = [fault() for fault in FAULTS]
    with pytest.raises(rs.DeclarationErrors) as caught:
        rs.compile(*(module for modules, _ in cases for module in modules))
    messages = [str(one) for one in caught.value.exceptions]
    missing = [words for _, words in cases if not any(all(word in text for word in words) for text in messages)]
    assert missing == []
    assert all(text in str(caught.value) for text in messages)


def test_a_rule_that_an_input_can_reach_is_not_a_fault() -> None:
    m = rs.Module("m")
    a, b = m.signal("a", input=True), m.signal("b")
    emitter(m, "hen", a, b)
    emitter(m, "egg", b, a)
    assert list(rs.compile(m).rules) == ["m:hen", "m:egg"]


def test_a_required_module_is_part_of_the_policy() -> None:
    base = rs.Module("base")
    top = rs.Module("top", requires=[base])
    assert [m.name for m in rs.compile(top).modules] == ["core", "base", "top"]
    assert [m.name for m in rs.compile(top, base, top).modules] == ["core", "base", "top"]


def test_a_policy_is_immutable() -> None:
    m = rs.Module("m")
    go = m.signal("go")
    rule = hearer(m, "first", go, go, [])
    policy = rs.compile(m)
    hearer(m, "later", go, go, [])
    m.signal("later")
    assert list(policy.rules) == ["m:first"]
    assert "m:later" not in policy.signals
    for names in (policy.rules, policy.signals, policy.slots):
        with pytest.raises(TypeError):
            names["m:other"] = rule  # type: ignore[index]


def test_one_policy_serves_any_number_of_contexts(play: Any) -> None:
    m = rs.Module("m")
    go, out = m.signal("go"), m.slot("out", 0)

    @m.rule(when=go, writes=out)
    async def count(ctx: Any) -> rs.Retire | None:
        ctx[out] = ctx[out] + 1
        return rs.Retire() if ctx[out] == 2 else None

    policy = rs.compile(m)
    with play(policy) as one:
        for _ in range(5):
            one.emit(go)
        assert one.read(out) == 2
    with play(policy) as other:
        assert other.read(out) == 0
        other.emit(go)
        assert other.read(out) == 1


def test_a_rule_added_to_one_context_is_not_in_another(play: Any) -> None:
    m, extra = rs.Module("m"), rs.Module("extra")
    go, out = m.signal("go"), output(m)
    policy = rs.compile(m)
    with play(policy) as one:
        one.add_rule(writer(extra, "late", go, out))
        one.emit(go)
        assert one.fired == ["extra:late"]
    with play(policy) as other:
        other.emit(go)
        assert other.fired == []
    assert list(policy.rules) == []
