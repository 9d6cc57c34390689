"""The module `nlp` in an agent: its slots, signals and errors."""

import subprocess
import sys
import threading
from collections.abc import Iterator
from typing import Any

import pytest

import ravestate as rs
from ravestate.engine.trace import Set
from ravestate.errors import PlatformError
from ravestate.modules import nlp, rawio
from ravestate.modules.meta.nlp import rules
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.testing import simulate

SLOTS = (
    nlp.text,
    nlp.tokens,
    nlp.lemmas,
    nlp.pos,
    nlp.tags,
    nlp.entities,
    nlp.triples,
    nlp.normal,
    nlp.question,
    nlp.analysis,
    nlp.yesno,
)


@pytest.fixture(autouse=True)
def loaded(reader: Pipeline) -> Iterator[None]:
    yield


def test_all_slots_are_written() -> None:
    with simulate(nlp) as sim:
        sim.say("Where do you live?")
        assert sim.read(nlp.text) == "Where do you live?"
        assert sim.read(nlp.tokens) == ("Where", "do", "you", "live", "?")
        assert sim.read(nlp.lemmas) == ("where", "do", "you", "live", "?")
        assert sim.read(nlp.pos)[2:4] == ("PRON", "VERB")
        assert sim.read(nlp.tags)[2:4] == ("PRP", "VB")
        assert sim.read(nlp.triples) == (nlp.Triple("you", "live", nlp.QuestionWord.PLACE),)
        assert sim.read(nlp.question) is nlp.QuestionWord.PLACE
        assert not sim.read(nlp.yesno)
        sim.say("No, I live in Berlin.")
        assert sim.read(nlp.question) is None
        assert sim.read(nlp.yesno).no == 2
        assert [entity.text for entity in sim.read(nlp.entities)] == ["Berlin"]


def test_the_analysis_is_one_record_with_acts_feelings_and_statements() -> None:
    with simulate(nlp) as sim:
        sim.say("Thank you! My mother is ill.")
        seen = sim.read(nlp.analysis)
        assert seen is not None
        assert sim.read(nlp.normal) == seen.normal.text
        assert (seen.text, seen.sentences) == ("Thank you! My mother is ill.", ("Thank you!", "My mother is ill."))
        thanks = seen.act("thanks")
        assert thanks is not None and thanks.text == "Thank you!" and thanks.score > 0.5
        assert seen.feelings["illness"].text == "My mother is ill."
        assert [statement.triple for statement in seen.statements] == list(sim.read(nlp.triples))
        assert seen.act("farewell") is None


def texts_written(first: str, second: str) -> list[Any]:
    """Return the values that are written to `nlp.text` for two utterances at the same time."""
    with simulate(nlp) as sim:
        sim.context.put(rawio.input, first)
        sim.context.put(rawio.input, second)
        sim.settle()
        return [record.value for record in sim.trace if isinstance(record, Set) and record.slot == nlp.text.name]


def test_utterances_keep_their_order_before_the_analysis_begins(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[int] = []
    later = threading.Event()

    def prepare(*rest: Any) -> None:
        calls.append(len(calls))
        if calls == [0]:
            later.wait(0.2)  # long enough to analyse the second utterance, if it did not wait for the first

    def read(text: str, *rest: Any) -> Any:
        later.set()
        return analyse(text, *rest)

    monkeypatch.setattr(rules, "intent_matcher", prepare)
    monkeypatch.setattr(rules, "analyse", read)
    assert texts_written("I live in Ulm.", "No, in Bremen.") == ["I live in Ulm.", "No, in Bremen."]


def test_simultaneous_utterances_are_analysed_in_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    later = threading.Event()

    def read(text: str, *rest: Any) -> Any:
        if text == "I live in Ulm.":
            later.wait(0.2)  # long enough to analyse the second utterance, if it did not wait for the first
        else:
            later.set()
        return analyse(text, *rest)

    monkeypatch.setattr(rules, "analyse", read)
    assert texts_written("I live in Ulm.", "No, in Bremen.") == ["I live in Ulm.", "No, in Bremen."]


def test_every_utterance_raises_the_changed_signal_of_every_slot() -> None:
    module = rs.Module("counter", requires=[nlp])
    counted: list[str] = []
    for slot in SLOTS:

        @module.rule(when=slot.changed, name=f"count_{slot.name.rpartition(':')[2]}")
        async def count(ctx: rs.RuleContext, name: str = slot.name) -> None:
            counted.append(name)

    with simulate(module) as sim:
        sim.say("yes")
        sim.say("yes")
    assert sorted(counted) == sorted(2 * [slot.name for slot in SLOTS])


@pytest.mark.parametrize(
    ("text", "signals"),
    [
        ("hello", {"intent_hi"}),
        ("bye", {"intent_bye"}),
        ("how are you", {"is_question", "about_agent"}),
        ("what time is it", {"is_question"}),
        ("I like your hat", {"about_agent"}),
        ("ravestate is nice", {"about_agent"}),
        ("let's play a game", {"intent_play"}),
        ("I live in Hannover", set[str]()),
        ("", set[str]()),
    ],
)
def test_each_utterance_raises_the_right_signals(text: str, signals: set[str]) -> None:
    module = rs.Module("listener", requires=[nlp])
    raised: set[str] = set()
    for signal in (nlp.is_question, nlp.about_agent, nlp.intent_play, nlp.intent_hi, nlp.intent_bye):

        @module.rule(when=signal, name=signal.name.partition(":")[2])
        async def note(ctx: rs.RuleContext, name: str = signal.name.partition(":")[2]) -> None:
            raised.add(name)

    with simulate(module) as sim:
        sim.say(text)
    assert raised == signals


def test_a_setting_gives_the_names_of_the_agent() -> None:
    module = rs.Module("listener", requires=[nlp])
    heard = module.flag("heard")

    @module.rule(when=nlp.about_agent, writes=heard)
    async def note(ctx: rs.RuleContext) -> None:
        ctx[heard] = True

    for text, expected in (
        ("where is robo lina", True),
        ("where is Ravestate", False),
        ("Robolina left", False),
    ):
        with simulate(module, settings={"nlp": {"agent_names": ["Robo Lina"]}}) as sim:
            sim.say(text)
            assert sim.read(heard) is expected, text


def test_a_rule_on_one_signal_of_nlp_can_read_all_slots_of_nlp() -> None:
    module = rs.Module("reader", requires=[nlp])
    seen: list[Any] = []

    @module.rule(when=nlp.tokens.changed, reads=SLOTS)
    async def first(ctx: rs.RuleContext) -> None:
        seen.append([ctx[slot] for slot in SLOTS])

    @module.rule(when=nlp.is_question, reads=SLOTS)
    async def second(ctx: rs.RuleContext) -> None:
        seen.append([ctx[slot] for slot in SLOTS])
        seen.append(ctx.payload(nlp.is_question))

    with simulate(module) as sim:
        sim.say("No, where do you live?")
        values = [sim.read(slot) for slot in SLOTS]
    assert seen == [values, values, nlp.QuestionWord.PLACE]
    assert values[-1].no == 2


def agent() -> rs.Module:
    """A module that answers questions about the agent, and makes small talk."""
    module = rs.Module("agent", requires=[rawio, nlp])

    @module.rule(when=nlp.is_question & nlp.about_agent, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> rs.Resign | None:
        if ctx.payload(nlp.is_question) is nlp.QuestionWord.REASON:
            return rs.Resign("it knows no reasons")
        ctx[rawio.output] = "about me"
        return None

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def chat(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "small talk"

    return module


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("how are you", "about me"),
        ("what time is it", "small talk"),
        ("you are nice", "small talk"),
        ("I like this room.", "small talk"),
        ("why are you here", "small talk"),
    ],
)
def test_the_more_specific_rule_answers_and_small_talk_does_not_wait(text: str, said: str) -> None:
    with simulate(agent()) as sim:
        sim.say(text)
        assert sim.said == [said]
        assert sim.now == 0.0


def test_two_utterances_are_not_mixed() -> None:
    with simulate(agent()) as sim:
        sim.context.put(rawio.input, "what time is it")
        sim.context.put(rawio.input, "you are nice")
        sim.settle()
        assert sim.said == ["small talk", "small talk"]


def test_after_an_error_other_rules_answer() -> None:
    with simulate(agent(), settings={"nlp": {"pipeline": "nonsense"}}) as sim:
        sim.say("how are you")
        assert sim.said == ["small talk"]
        ((rule, error),) = sim.failures
        assert rule == "nlp:understand" and isinstance(error, rs.PlatformError)


def test_loading_begins_at_startup_and_counts_as_no_activity(monkeypatch: pytest.MonkeyPatch) -> None:
    loaded: list[str] = []

    class Recorder:
        def __init__(self, name: str) -> None:
            self.name = name

        def load(self) -> None:
            loaded.append(self.name)

    monkeypatch.setattr(rules, "pipeline", Recorder)
    with simulate(nlp, settings={"nlp": {"pipeline": "mine"}}) as sim:
        assert loaded == ["mine"]
        assert sim.read(rs.activity) is False


def test_importing_the_module_imports_no_heavy_library() -> None:
    code = "import sys; from ravestate.modules import nlp; print('spacy' in sys.modules, 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False False\n"


def test_the_first_text_waits_for_the_models(monkeypatch: pytest.MonkeyPatch) -> None:
    done: list[str] = []

    def analysis(*given: Any) -> Any:
        done.append("analysed")
        return analyse(*given)

    monkeypatch.setattr(rules, "load_models", lambda: done.append("loaded"))
    monkeypatch.setattr(rules, "analyse", analysis)
    rules.analysed("hi, I'm Nora", Pipeline(""), (), (), None)
    assert done == ["loaded", "analysed"]


def test_without_the_models_texts_are_still_analysed(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing() -> None:
        raise PlatformError("the sentence models are not installed")

    monkeypatch.setattr(rules, "load_models", missing)
    assert rules.analysed("hello", Pipeline(""), (), (), None).acted == ("intent_hi",)
