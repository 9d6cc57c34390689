"""L25: every rule can be explained at any moment, and a trace has every decision."""

import json
from typing import Any, get_args

import pytest

import ravestate as rs
from laws.short import emitter, hearer, output, resigner, writer
from laws.story import everything, tell
from ravestate.engine import trace
from ravestate.engine.explain import ActivationState
from ravestate.testing import simulate
from scenarios.driver import Driver


def alive(sim: Any, rule: str) -> ActivationState:
    """Return the explanation of a rule's only live activation."""
    [activation] = sim.explain(rule).activations
    return activation


def fusion(**options: Any) -> tuple[rs.Module, rs.Signal[Any], rs.Signal[Any]]:
    m = rs.Module("m")
    point, speech, out = m.signal("point"), m.signal("speech"), output(m)
    hearer(m, "other", m.signal("z"), point, [])
    writer(m, "fused", point & speech, out, **options)
    writer(m, "plain", speech, out)
    return m, point, speech


def test_an_explanation_lists_the_spikes_that_a_rule_holds_and_lacks(play: Any) -> None:
    m, _, speech = fusion()
    with play(m) as sim:
        assert sim.explain("m:fused").activations == ()
        sim.emit(speech)
        sim.advance(0.25)
        fused = alive(sim, "m:fused")
        assert (fused.state, fused.holds, fused.lacks) == ("gathering", (("m:speech", 0.25),), ("m:point",))
        plain = alive(sim, "m:plain")
        assert (plain.state, plain.holds, plain.lacks) == ("waiting", (("m:speech", 0.25),), ())


def test_an_explanation_names_the_rival_and_its_lead_in_nats(play: Any) -> None:
    m, _, speech = fusion(weight=2.0)
    with play(m) as sim:
        sim.emit(speech)
        [(rule, nats)] = alive(sim, "m:plain").waits_for
        assert rule == "m:fused"
        policy = rs.compile(m)
        assert nats == pytest.approx(2.0 * policy.utility("m:fused") - policy.utility("m:plain"))


def test_an_explanation_has_the_latest_end_of_a_wait(play: Any) -> None:
    m, _, speech = fusion(patience=3.0)
    with play(m) as sim:
        sim.advance(1.0)
        sim.emit(speech)
        sim.advance(0.5)
        assert alive(sim, "m:plain").until == 4.0
        assert alive(sim, "m:fused").until == 4.0


def test_an_explanation_has_the_time_at_which_a_spike_grows_too_old(play: Any) -> None:
    m, point, _ = fusion()
    with play(m) as sim:
        sim.advance(1.0)
        sim.emit(point)
        assert alive(sim, "m:fused").until == 6.0


def test_the_explanation_of_a_wait_for_a_running_rule_has_no_end(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    emitter(m, "classify", i, x, after=50.0)
    writer(m, "specific", x, out)
    writer(m, "general", i, out)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(1.0)
        general = alive(sim, "m:general")
        assert ([name for name, _ in general.waits_for], general.until) == (["m:specific"], None)
        assert alive(sim, "m:classify").state == "running"


def test_an_explanation_names_a_taken_slot(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)
    resigner(m, "busy", i, out, after=5.0)
    writer(m, "next_best", i, out)
    with play(m) as sim:
        sim.emit(i)
        assert alive(sim, "m:next_best").waits_for == (("m:busy", 0.0),)


def test_an_explanation_shows_a_spike_that_ripens_and_a_closed_gate(play: Any) -> None:
    m = rs.Module("m")
    i, mood, out = m.signal("i"), m.slot("mood", "calm"), output(m)
    writer(m, "later", i.min_age(2.0), out)
    writer(m, "gated", i & mood.holds(lambda value: value == "merry"), out)
    with play(m) as sim:
        sim.emit(i)
        later, gated = alive(sim, "m:later"), alive(sim, "m:gated")
        assert (later.state, later.until) == ("ripening", 2.0)
        assert (gated.state, gated.until) == ("gated", 5.0)
        assert [is_open for _, is_open in sim.explain("m:gated").clauses[0].gates] == [False]
        assert "cannot run" in str(sim.explain("m:gated")) == repr(sim.explain("m:gated"))


def test_an_explanation_lists_condition_pathways_and_utility(play: Any) -> None:
    m, _, _ = fusion()
    with play(m) as sim:
        [clause] = sim.explain("m:fused").clauses
        assert clause.signals == ("m:point", "m:speech")
        assert clause.pathways == (("m:point", "m:speech"),)
        assert clause.utility == clause.effective == rs.compile(m).utility("m:fused")
        words = str(sim.explain("m:fused"))
        assert f"{clause.utility:.6f} nats" in words
        assert "m:point & m:speech" in words


def why(sim: Any, rule: str) -> str:
    """Return the history in the explanation of a rule that has not fired."""
    assert rule not in sim.fired
    return "\n".join(sim.explain(rule).history)


def test_explain_says_that_another_rule_answered(play: Any) -> None:
    m, point, speech = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.emit(speech)
        assert "m:fused answered" in why(sim, "m:plain")


def test_explain_says_that_the_patience_ran_out(play: Any) -> None:
    m, _, speech = fusion()
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(2.0)
        reason = why(sim, "m:fused")
        assert "m:plain waited for it" in reason
        assert "lacking m:point" in reason
        assert "patience" in reason


def test_explain_says_that_a_spike_grew_too_old(play: Any) -> None:
    m, point, _ = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.advance(6.0)
        assert "too old" in why(sim, "m:fused")


def test_explain_says_that_the_rule_resigned(play: Any) -> None:
    m = rs.Module("m")
    i = m.signal("i")
    resigner(m, "shy", i, output(m))
    with play(m) as sim:
        sim.emit(i)
        assert "resigned: not this time" in why(sim, "m:shy")


def test_explain_says_that_the_rule_failed(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)

    @m.rule(when=i, writes=out)
    async def fail(ctx: Any) -> None:
        raise ValueError("broken")

    with play(m) as sim:
        sim.emit(i)
        assert "broken" in why(sim, "m:fail")


def test_explain_says_that_a_spike_was_withdrawn(play: Any) -> None:
    m, point, _ = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.wipe(point)
        assert "withdrawn" in why(sim, "m:fused")


def test_explain_says_that_the_payload_did_not_fit(play: Any) -> None:
    m = rs.Module("m")
    i = m.signal("i", payload=int)
    writer(m, "picky", i.where(lambda number: number > 10), output(m))
    with play(m) as sim:
        sim.emit(i, 3)
        assert "m:i" in why(sim, "m:picky")


def test_explain_says_that_the_cause_was_already_answered(play: Any) -> None:
    m = rs.Module("m")
    i, x, out = m.signal("i"), m.signal("x"), output(m)
    writer(m, "other", m.signal("k"), output(m, "face"))
    writer(m, "first", i, out, weight=10.0)
    emitter(m, "cause", i, x, after=2.0)
    writer(m, "late", x, out, weight=0.1)
    with play(m) as sim:
        sim.emit(i)
        sim.advance(5.0)
        assert "answered its cause" in why(sim, "m:late")


def test_explain_names_the_signal_that_has_not_occurred(play: Any) -> None:
    m, point, _ = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.advance(10.0)
        assert "m:speech" in why(sim, "m:fused")


def test_explain_says_that_the_rule_has_retired(play: Any) -> None:
    m = rs.Module("m")
    i, out = m.signal("i"), output(m)

    @m.rule(when=i, writes=out)
    async def once(ctx: Any) -> rs.Retire:
        return rs.Retire("enough")

    with play(m) as sim:
        sim.emit(i)
        explanation = sim.explain("m:once")
        assert explanation.retired
        assert "retired" in str(explanation)


def test_the_error_about_an_unknown_rule_suggests_the_nearest_name(play: Any) -> None:
    m, _, _ = fusion()
    with play(m) as sim, pytest.raises(rs.DeclarationError, match="did you mean 'm:fused'"):
        sim.explain("m:fussed")


def test_every_kind_of_decision_is_traced() -> None:
    m = everything()
    fuse, i, j, out = m.signal("fuse"), m.signals[0], m.signals[1], m.slots[0]
    emitter(m, "merge", i & j, fuse)
    writer(m, "pressed", i & m.signal("never"), out, weight=50.0)
    writer(m, "picky", i.where(lambda text: text == "nobody says this"), out)
    with Driver(m) as sim:
        tell(sim)
        sim.advance(60.0)
        assert {type(record) for record in sim.trace} == set(get_args(trace.Record))
        assert [record.time for record in sim.trace] == sorted(record.time for record in sim.trace)


def test_births_holdings_and_outcomes_are_traced_with_their_causes(play: Any) -> None:
    m, point, speech = fusion()
    with play(m) as sim:
        sim.emit(point)
        sim.emit(speech)
        [started] = [r for r in sim.trace if isinstance(r, trace.Started)]
        born = {r.spike: r for r in sim.trace if isinstance(r, trace.Born)}
        assert [born[spike].signal for spike in started.spikes] == ["m:point", "m:speech"]
        [effect] = [r for r in born.values() if r.source == started.run]
        assert (effect.signal, effect.parents) == ("m:out:changed", started.spikes)
        [settled] = [r for r in sim.trace if isinstance(r, trace.Settled)]
        assert (settled.run, settled.outcome, settled.fired) == (started.run, "done", True)


def test_the_reason_to_wait_is_traced_again_when_it_changes(play: Any) -> None:
    """The patience of `better` ends at 1 s, and that of `best` at 2 s.

    `second` and `third` wait for `first`, and for the rivals that `first` waits for.
    """
    m = rs.Module("m")
    speech, topic, x, y = (m.signal(name) for name in ("speech", "topic", "x", "y"))
    out = output(m)
    emitter(m, "classify", speech, topic, after=5.0)
    writer(m, "best", topic & x, out, patience=2.0)
    writer(m, "better", topic & y, out, patience=1.0)
    for name in ("first", "second", "third"):
        writer(m, name, speech, out)
    with play(m) as sim:
        sim.emit(speech)
        sim.advance(3.0)
        told = {
            name: [(r.time, set(r.for_)) for r in sim.trace if isinstance(r, trace.Waits) and r.rule == f"m:{name}"]
            for name in ("first", "second", "third")
        }
        assert told["first"] == [(0.0, {"m:best", "m:better"}), (1.0, {"m:best"})]
        for name in ("second", "third"):
            assert told[name][:2] == [(0.0, {"m:best", "m:better", "m:first"}), (1.0, {"m:best", "m:first"})]


def test_a_wait_with_the_same_reason_is_traced_only_once(play: Any) -> None:
    m = rs.Module("m")
    go, out = m.signal("go"), output(m)
    writer(m, "first", go, out, after=3.0, weight=2.0)
    writer(
        m, "beside", go, output(m, "face"), after=1.0
    )  # when this rule ends, the waiting activations of the group ask again
    writer(m, "second", go, out)
    with play(m) as sim:
        sim.emit(go)
        sim.advance(2.0)
        assert sim.fired == ["m:beside"]
        waits = [(r.time, r.rule, r.for_) for r in sim.trace if isinstance(r, trace.Waits)]
        assert waits == [(0.0, "m:second", ("m:first",))]


def test_a_start_has_the_number_of_the_run_and_of_its_activation() -> None:
    m = rs.Module("m")
    go, out, numbers = m.signal("go"), output(m), list[int]()
    hearer(m, "waits", go & m.signal("other"), go, [])

    @m.rule(when=go, writes=out)
    async def counts(ctx: rs.RuleContext) -> None:
        numbers.append(ctx.run)
        ctx[out] = "done"

    with simulate(m, trace=True) as sim:
        sim.emit(go)
        sim.emit(go)
        started = [record for record in sim.trace if isinstance(record, trace.Started)]
        assert [record.number for record in started] == numbers == [1, 2]
        assert [record.run for record in started] != numbers
        held = {
            record.activation for record in sim.trace if isinstance(record, trace.Held) and record.rule == "m:counts"
        }
        assert {record.run for record in started} == held


def test_without_a_listener_no_record_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*_: object) -> None:
        raise AssertionError("no tracer listens")

    for record in get_args(trace.Record):
        monkeypatch.setattr(trace, record.__name__, never)
    with Driver(everything(), trace=False) as sim:
        tell(sim)
        sim.advance(60.0)
        assert len(sim.fired) > 50


def test_tracing_does_not_change_the_effects() -> None:
    policy = rs.compile(everything())
    ends: list[tuple[list[str], dict[str, Any]]] = []
    for traced in (False, True):
        with Driver(policy, trace=traced) as sim:
            tell(sim)
            sim.advance(60.0)
            ends.append((sim.fired, sim.snapshot()["slots"]))
    assert ends[0] == ends[1]


def test_a_snapshot_is_plain_data(play: Any) -> None:
    with play(everything()) as sim:
        tell(sim)
        state = json.loads(json.dumps(sim.snapshot()))
        assert state["activations"]
        assert state == sim.snapshot()
        for activation in state["activations"]:
            assert {"rule", "state", "holds", "lacks", "waits_for", "until"} <= set(activation)


def test_a_snapshot_shows_values_without_a_repr(play: Any) -> None:
    class Odd:
        def __repr__(self) -> str:
            raise ValueError("no")

    m = rs.Module("m")
    odd = m.slot("odd", None)
    with play(m) as sim:
        sim.put(odd, {"a": Odd(), "b": {Odd()}})
        assert sim.snapshot()["slots"]["m:odd"] == {
            "a": "<Odd without a repr>",
            "b": ["<Odd without a repr>"],
        }
