"""Intents that a designer declares by examples."""

from pathlib import Path

import pytest
import yaml

import ravestate as rs
from ravestate.modules import nlp, rawio
from ravestate.modules.meta.nlp.intent import intents_of
from ravestate.testing import simulate


def cafe() -> rs.Module:
    """A café with small talk and two intents, each with two examples."""
    module = rs.Module("cafe", requires=[rawio, nlp])
    hours = nlp.intent(module, "opening_hours", examples=["when do you open", "how late are you open"])
    table = nlp.intent(module, "book_table", examples=["I would like to book a table", "a table for two please"])

    @module.rule(when=hours, writes=rawio.output)
    async def tell_hours(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "From ten to six."

    @module.rule(when=table, writes=rawio.output)
    async def book(ctx: rs.RuleContext) -> None:
        match = ctx.payload(table)
        day = ", ".join(entity.text for entity in match.entities)
        ctx[rawio.output] = f"A table: {day} ({match.example})"

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def chat(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I see."

    return module


def test_an_utterance_that_resembles_the_examples_of_an_intent_raises_it() -> None:
    with simulate(cafe()) as sim:
        for text in (
            "hi, when r u open tomorow",
            "can i reserve a table for friday",
            "my sister plays the violin",
            "hello",
        ):
            sim.say(text)
        assert sim.said == ["From ten to six.", "A table: friday (i would like to book a table)", "I see.", "I see."]
        assert sim.now == 0.0
        assert not sim.failures


def test_an_example_without_words_raises_its_intent_only_if_the_utterance_equals_it() -> None:
    module = rs.Module("signs", requires=[nlp])
    found = {
        name: nlp.intent(module, name, examples=examples)
        for name, examples in {"smile": ["🙂"], "surprise": ["?!", "what a surprise"]}.items()
    }

    @module.rule(when=found["smile"] | found["surprise"], writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = " ".join(name for name, signal in found.items() if ctx.payload(signal))

    with simulate(module) as sim:
        for text in ("🙂", " ?! ", "🙃", "??", "what a surprise"):
            sim.say(text)
        assert sim.said == ["smile", "surprise", "surprise"]
        assert not sim.failures


def test_a_match_has_its_score_its_margin_and_the_nearest_example() -> None:
    with simulate(cafe()) as sim:
        sim.say("At what time do you open?")
        seen = sim.read(nlp.analysis)
        assert seen is not None
        match = seen.intents["cafe:opening_hours"]
        assert 0.5 < match.score <= 1.0 and match.margin > 0
        assert (match.example, match.text) == ("when do you open", "At what time do you open?")


def test_small_talk_has_less_utility_than_an_intent() -> None:
    policy = rs.compile(cafe())
    assert policy.utility("cafe:tell_hours") > policy.utility("cafe:chat") + 1.0


def test_two_sentences_of_one_utterance_can_have_two_intents() -> None:
    with simulate(cafe()) as sim:
        sim.say("When do you open? I want to book a table.")
        seen = sim.read(nlp.analysis)
        assert seen is not None and set(seen.intents) == {"cafe:opening_hours", "cafe:book_table"}


def test_intents_of_several_modules_compete_and_a_context_knows_only_its_own_intents() -> None:
    bar = rs.Module("bar", requires=[nlp])
    nlp.intent(bar, "drink", examples=["a beer please", "I would like a glass of wine"])
    with simulate(cafe(), bar) as sim, simulate(bar) as other:
        for context in (sim, other):
            context.say("can I have a beer")
        for context in (sim, other):
            seen = context.read(nlp.analysis)
            assert seen is not None and list(seen.intents) == ["bar:drink"]
        sim.say("can I book a table")
        other.say("can I book a table")
        seen, unseen = sim.read(nlp.analysis), other.read(nlp.analysis)
        assert seen is not None and list(seen.intents) == ["cafe:book_table"]
        assert unseen is not None and not unseen.intents


def test_a_greeting_that_is_an_example_of_an_intent_raises_the_intent() -> None:
    module = rs.Module("door", requires=[rawio, nlp])
    came = nlp.intent(module, "came", examples=["hello", "good day"])

    @module.rule(when=came, writes=rawio.output)
    async def welcome(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Come in!"

    with simulate(module) as sim:
        sim.say("hello")
        assert sim.said == ["Come in!"]


def test_a_rule_that_is_added_later_hears_an_intent() -> None:
    module = rs.Module("shop", requires=[rawio, nlp])
    price = nlp.intent(module, "price", examples=["how much is it", "what does it cost"])
    later = rs.Module("later", requires=[module])

    @later.rule(when=price, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Ten euros."

    with simulate(module) as sim:
        sim.add_rule(answer)
        sim.say("hw much does this cost?")
        assert sim.said == ["Ten euros."]


def test_examples_can_come_from_a_file_beside_the_code(tmp_path: Path) -> None:
    (tmp_path / "hours.yaml").write_text("- when do you open\n- how late are you open\n")
    (tmp_path / "all.yaml").write_text("price: [how much is it, what does it cost]\nhours: [when do you open]\n")
    code = (
        "import ravestate as rs\nfrom ravestate.modules import nlp\nmodule = rs.Module('shop', requires=[nlp])\n"
        "nlp.intent(module, 'hours', examples='hours.yaml')\nnlp.intent(module, 'price', examples='all.yaml')\n"
    )
    found: dict[str, rs.Module] = {}
    exec(compile(code, str(tmp_path / "shop.py"), "exec"), found)
    assert intents_of(rs.compile(found["module"])) == {
        "shop:hours": ("when do you open", "how late are you open"),
        "shop:price": ("how much is it", "what does it cost"),
    }


def test_the_errors_about_a_designers_mistakes_say_what_to_change(tmp_path: Path) -> None:
    module = rs.Module("shop", requires=[nlp])
    with pytest.raises(rs.DeclarationError, match=r"there are no examples: write two or more sentences"):
        nlp.intent(module, "price", examples=[])
    with pytest.raises(
        rs.DeclarationError, match=r"'none' stands for sentences without an intent: choose another name"
    ):
        nlp.intent(module, "none", examples=["how much is it", "what does it cost"])
    with pytest.raises(rs.DeclarationError, match=r"none.yaml' cannot be read .* relative to the Python file"):
        nlp.intent(module, "price", examples="no/none.yaml")
    with pytest.raises(rs.DeclarationError, match=r"'price' needs a list of sentences"):
        nlp.intent(module, "price", examples=["how much", 7])  # type: ignore[list-item]
    (tmp_path / "all.yaml").write_text("prices: [how much is it]\n")
    with pytest.raises(rs.DeclarationError, match=r"no examples of 'price'.*prices"):
        nlp.intent(module, "price", examples=tmp_path / "all.yaml")
    nlp.intent(module, "price", examples=["how much is it"])
    with pytest.raises(rs.DeclarationError, match=r"has a signal 'price' already: choose another name"):
        nlp.intent(module, "price", examples=["what does it cost"])
    with pytest.raises(
        rs.DeclarationError, match=r"test_intent.py:\d+\): the module needs nlp: .*requires=\[..., nlp\]"
    ):
        nlp.intent(rs.Module("bare"), "price", examples=["how much is it"])


def test_without_the_sentence_model_only_the_exact_words_of_an_example_raise_its_intent(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    from ravestate.language.bundled import ModelMissing
    from ravestate.language.matcher import Matcher

    def missing(self: Matcher) -> None:
        raise ModelMissing("it is not installed")

    monkeypatch.setattr(Matcher, "load", missing)
    module = rs.Module("kiosk", requires=[rawio, nlp])
    paper = nlp.intent(module, "paper", examples=["do you sell newspapers", "a paper please"])

    @module.rule(when=paper, writes=rawio.output)
    async def sell(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Here it is."

    with simulate(module) as sim:
        sim.say("do u sell newspapers?")
        sim.say("have you got any newspapers?")
        assert sim.said == ["Here it is."]


def test_most_typed_utterances_raise_the_right_intent() -> None:
    """With three examples for each intent, at least 90 % of utterances are right, and at most 4 % of other texts get one."""
    demo = yaml.safe_load((Path(__file__).parents[3] / "quality" / "demo_rows.yaml").read_text(encoding="utf-8"))
    module = rs.Module("demo", requires=[nlp])
    for name, lists in demo["intents"].items():
        nlp.intent(module, name, examples=lists["examples"])
    right = wrong = 0
    with simulate(module, trace=False) as sim:

        def found(text: str) -> list[str]:
            sim.say(text)
            seen = sim.read(nlp.analysis)
            assert seen is not None
            return [name.partition(":")[2] for name in seen.intents]

        cases = [(text, name) for name, lists in demo["intents"].items() for text in lists["typed"]]
        right = sum(found(text) == [name] for text, name in cases)
        wrong = sum(found(text) != [] for text in demo["none"])
    assert right >= 0.9 * len(cases)
    assert wrong <= 0.04 * len(demo["none"])
