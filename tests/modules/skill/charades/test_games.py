"""Whole games in virtual time. The scripts list events, and the phrases that the agent must say after them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from ravestate.modules import activity, agenda, charades, emotion, hibye, idle, interloc, nlp, rawio, wildtalk
from ravestate.modules.meta.verbaliser.phrases import PhraseBook
from ravestate.modules.skill.charades.game import moves_of
from ravestate.testing import Simulation, simulate
from ravestate.yaml_text import load_yaml

pytestmark = pytest.mark.usefixtures("reader")

PHRASES = Path(charades.__file__).with_name("phrases.yaml")
TEMPLATES = [
    (name, re.compile(re.sub(r"\\{\w+\\}", ".+", re.escape(text))))
    for name, texts in load_yaml(PHRASES.read_text(), "phrases").items()
    for text in sorted(texts["en"], key=len, reverse=True)
]
# Longer phrases come first, because "{riddle}" would also match "Watch me!".
TEMPLATES.sort(key=lambda template: -len(template[1].pattern))
COUNTDOWN = "count count count go"


def phrase(text: str) -> str:
    """Return the name of the charades phrase with this text; if there is none, return the text."""
    return next((name for name, pattern in TEMPLATES if pattern.fullmatch(text)), text)


def knower() -> rs.Module:
    """Return a module that answers questions, and talks about everything else."""
    module = rs.Module("knower", requires=[rawio, nlp])

    @module.rule(when=nlp.is_question, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I know it."

    @module.rule(when=rawio.input.changed, writes=rawio.output)
    async def chat(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I see."

    return module


def agent(*others: Any, **settings: Any) -> Simulation:
    return simulate(charades, knower(), *others, settings={"emotion": {"emoji": False}, **settings})


def run(sim: Simulation, script: str) -> None:
    """Run a script.

    ``> text``: the user says this text. ``wait N``: N seconds pass. ``see NAME``: this activity is recognised. ``typing``:
    the user types. ``body on``: a body comes into view. ``= names`` checks the names of the phrases that the agent has
    said since the last check, and ``~ feeling`` checks the agent's latest feeling.
    """
    said = len(sim.said)
    for number, raw in enumerate(script.strip().splitlines()):
        line = raw.strip()
        kind, _, rest = line.partition(" ")
        if kind == ">":
            sim.say(rest)
        elif kind == "wait":
            sim.advance(float(rest))
        elif kind == "see":
            sim.emit(activity.recognised, activity.Activity(rest, 0.8, sim.now - 1, sim.now))
        elif kind == "typing":
            sim.emit(rawio.typing)
        elif kind == "body":
            sim.put(activity.in_view, rest == "on")
        elif kind == "=":
            heard = [phrase(text) for text in sim.said[said:]]
            wanted = rest.replace("COUNTDOWN", COUNTDOWN).split()
            assert heard == wanted, f"line {number}: {line}: {sim.said[said:]}"
            said = len(sim.said)
        elif kind == "~":
            assert sim.read(emotion.felt) == rest, f"line {number}"
        else:
            raise AssertionError(f"no such line: {line}")
    assert [phrase(text) for text in sim.said[said:]] == []


def test_the_first_guess_is_right() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > I want to play a game
            = offer
            > yes please
            = begin
            ~ happy
            > what are the rules?
            = rules
            > I'm ready
            = count
            wait 4
            = count count go
            see swimming
            wait 2
            = guess
            > yes
            = right
            ~ happy
            > no thanks
            = thanks
            ~ affectionate
            """,
        )
        assert "swimming" in sim.said[-3] and "I have 1" in sim.said[-1]
        assert not sim.read(charades.game).is_on
        assert not sim.read(agenda.topics)


def test_the_second_guess_is_right_and_another_round_follows() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            = begin
            > ready
            wait 3
            = COUNTDOWN
            see rowing
            see swimming
            see swimming
            wait 3
            = guess
            > no
            = guess_again
            ~ surprised
            > yes, that's it
            = right
            > what's the score?
            = score
            > yes, another one
            = again
            > okay
            wait 3.5
            = COUNTDOWN
            see waving
            wait 3
            = guess
            """,
        )
        assert any("swimming" in text for text in sim.said)
        assert sim.read(charades.game).ranked == ("waving",)


def test_the_user_names_an_unknown_movement_and_the_agent_learns_it() -> None:
    lessons: list[activity.Lesson] = []
    listener = rs.Module("listener", requires=[activity])

    @listener.rule(when=activity.taught.max_age(None).detached())
    async def take(ctx: rs.RuleContext) -> None:
        lessons.append(ctx.payload(activity.taught))

    with agent(listener) as sim:
        run(
            sim,
            """
            body on
            > let's play charades
            = begin
            > I'm ready
            wait 7
            = COUNTDOWN never_seen
            ~ surprised
            > it was juggling
            = learnt
            """,
        )
        game = sim.read(charades.game)
        assert lessons == [activity.Lesson("juggling", game.start, game.end)]
        assert game.end - game.start == pytest.approx(3.0)
        assert (game.user, game.agent) == (1, 0)


def test_after_two_wrong_guesses_the_user_can_immediately_name_the_activity() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            > ready
            wait 4
            = begin COUNTDOWN
            see boxing
            see clapping
            wait 3
            = guess
            > wrong
            = guess_again
            > no, I was hammering
            = conceded
            > now it's your turn
            = riddle
            """,
        )
        assert sim.read(charades.game).user == 1


def test_other_questions_are_answered_and_the_game_continues() -> None:
    with agent() as sim:

        def said(event: str = "", seconds: float = 0.0) -> list[str]:
            before = len(sim.said)
            if event:
                sim.say(event)
            sim.advance(seconds)
            return [phrase(text) for text in sim.said[before:]]

        assert said("let's play charades") == ["begin"]
        assert said("what is the capital of Peru?") == ["I know it."]
        assert said(seconds=4.5) == ["back_choosing"]
        assert said("ready", 3.5) == COUNTDOWN.split()
        assert said("how tall is the tower?") == ["I know it."]
        sim.emit(activity.recognised, activity.Activity("driving", 0.7, 0.0, 1.0))
        assert said(seconds=3) == ["guess"]
        assert said("my brother arrives in an hour with the train") == ["I see."]
        assert said(seconds=5) == ["back_guessed"]
        assert said("who wrote Faust?", 1) == ["I know it."]
        assert said("and who wrote Hamlet?", 6) == ["I know it.", "back_guessed"]
        assert said("yes") == ["right"]


def test_silence_starts_the_countdown_then_repeats_the_question_then_ends_the_game() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            = begin
            wait 11
            =
            wait 1
            = count
            wait 3.5
            = count count go
            see flying
            wait 3
            = guess
            wait 12
            = back_guessed
            wait 11
            =
            wait 1
            = lapsed
            """,
        )
        assert not sim.read(charades.game).is_on


def test_the_agent_asks_again_after_an_unclear_answer_and_takes_a_second_one_as_no() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            > ready
            wait 4
            see phoning
            wait 3
            = begin COUNTDOWN guess
            > hmm
            = unclear
            > sort of
            = what_was_it
            ~ sad
            > hm
            = what_now
            > never mind
            = secret
            """,
        )


def test_the_agent_offers_a_riddle_if_it_twice_sees_nothing() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            > ready
            wait 7
            = begin COUNTDOWN unseen
            ~ shy
            > yes
            wait 7
            = COUNTDOWN blind
            > okay
            = riddle
            """,
        )
        name = sim.read(charades.game).riddle
        other = "swimming" if name != "swimming" else "rowing"
        run(
            sim,
            f"""
            > is it {other}?
            = hint
            > are you {name}?
            = solved
            > a riddle please
            = riddle
            """,
        )
        second = sim.read(charades.game).riddle
        assert second != name
        sim.say("can I have a hint?")
        assert phrase(sim.said[-1]) == "help"
        sim.say("I have no idea")
        assert phrase(sim.said[-1]) == "told"
        game = sim.read(charades.game)
        assert (game.user, game.agent) == (1, 1)


def test_the_bored_agent_offers_the_game_once() -> None:
    with agent() as sim:
        run(
            sim,
            """
            wait 20
            = offer
            > no, not now
            = declined
            wait 300
            =
            """,
        )
        assert charades.offer.state(sim).status == "dropped"
    with agent() as sim:
        run(
            sim,
            """
            wait 20
            = offer
            > yes
            = begin
            """,
        )
        assert charades.offer.state(sim).status == "done"


def test_an_offer_that_lapses_is_no_refusal_and_comes_once_more() -> None:
    refusals: list[float] = []
    listener = rs.Module("listener", requires=[charades])

    @listener.rule(when=charades.declined.detached())
    async def note(ctx: rs.RuleContext) -> None:
        refusals.append(ctx.now)

    with agent(listener) as sim:
        run(
            sim,
            """
            wait 20
            = offer
            wait 30
            =
            """,
        )
        assert charades.offer.state(sim).status == "pursued"
        assert not sim.read(charades.game).is_on and not sim.read(agenda.topics)
        run(
            sim,
            """
            wait 110
            = offer
            wait 300
            =
            """,
        )
        assert charades.offer.state(sim) == agenda.GoalState("dropped", 2, pytest.approx(147, abs=15))
        assert refusals == []
    with agent(listener) as sim:
        run(sim, "wait 20\n= offer\n> no\n= declined")
        assert len(refusals) == 1


def test_the_offer_that_the_user_prompts_counts_as_one_of_the_two_offers() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > I am so bored
            = offer
            wait 110
            =
            wait 50
            = offer
            wait 300
            =
            """,
        )
        assert charades.offer.state(sim).status == "dropped"


def test_the_agent_offers_the_game_to_a_user_who_is_bored() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > I am so bored
            = offer
            wait 30
            =
            """,
        )
        assert not sim.read(charades.game).is_on


def test_the_game_and_not_small_talk_answers_a_user_who_is_bored() -> None:
    with simulate(charades, wildtalk, settings={"emotion": {"emoji": False}, "wildtalk": {"backend": "listen"}}) as sim:
        run(sim, "> I'm bored\n= offer\n> yes\n= begin")


def test_the_word_wait_cancels_the_countdown_and_typing_delays_the_reminder() -> None:
    with agent() as sim:
        run(
            sim,
            """
            > let's play charades
            > ready
            wait 1.5
            = begin count count
            > wait a moment
            = wait
            wait 10
            typing
            wait 10
            typing
            wait 11
            =
            > ready
            wait 3.5
            = COUNTDOWN
            """,
        )


def voice(seconds: float) -> rs.Module:
    """Return a module that speaks one utterance after another, each for some seconds, as a loudspeaker does."""
    module = rs.Module("voice", requires=[rawio])
    ends = module.slot("ends", 0.0)

    @module.rule(
        when=rawio.output.changed.max_age(None).detached(), writes=(ends, rawio.heard), detached=True, background=True
    )
    async def speak(ctx: rs.RuleContext) -> None:
        ctx[ends] = end = max(ctx[ends], ctx.now) + seconds
        await ctx.sleep(end - ctx.now)
        ctx[rawio.heard] = ctx.payload(rawio.output.changed)

    return module


def test_a_speaking_agent_watches_after_its_last_word_has_been_heard() -> None:
    with agent(voice(1.6)) as sim:
        run(
            sim,
            """
            > let's play charades
            wait 3
            > ready
            wait 3.5
            = begin COUNTDOWN
            """,
        )
        assert sim.read(charades.game).step == "counting"  # the voice takes longer than the countdown
        sim.advance(1.0)
        assert sim.read(charades.game).step == "counting"
        while sim.read(charades.game).step == "counting":
            sim.advance(0.1)
        assert sim.read(charades.game).start == pytest.approx(3.0 + 4 * 1.6, abs=0.2)
        sim.emit(activity.recognised, activity.Activity("swimming", 0.8, sim.now - 1, sim.now))
        sim.advance(3.1)
        assert "swimming" in sim.said[-1]


def test_the_game_continues_after_the_user_interrupts_the_voice() -> None:
    with agent(voice(100.0)) as sim:
        run(sim, "> let's play charades\n= begin")
        sim.put(rawio.heard, sim.said[-1][:10])  # the user interrupts
        run(sim, "> ready\nwait 3.5\n= COUNTDOWN\nwait 5\nsee swimming\nwait 4\n= guess")


@pytest.mark.parametrize(
    "step", ["offered", "choosing", "counting", "watching", "guessed", "asked", "between", "riddle"]
)
@pytest.mark.parametrize("word", ["stop", "stop the game please", "I don't want to play any more"])
def test_the_word_stop_ends_the_game_at_every_step(step: str, word: str) -> None:
    way = {
        "offered": ["> let's play something"],
        "choosing": ["> let's play charades"],
        "counting": ["> let's play charades", "> ready", "wait 1.2"],
        "watching": ["> let's play charades", "> ready", "wait 4"],
        "guessed": ["> let's play charades", "> ready", "wait 4", "see boxing", "wait 3"],
        "asked": ["body on", "> let's play charades", "> ready", "wait 7"],
        "between": ["> let's play charades", "> ready", "wait 4", "see boxing", "wait 3", "> yes"],
        "riddle": ["> let's play charades", "> your turn"],
    }[step]
    with agent() as sim:
        for line in way:
            kind, _, rest = line.partition(" ")
            if kind == ">":
                sim.say(rest)
            elif kind == "wait":
                sim.advance(float(rest))
            elif kind == "body":
                sim.put(activity.in_view, True)
            else:
                sim.emit(activity.recognised, activity.Activity(rest, 0.9, 0.0, 1.0))
        assert sim.read(charades.game).step == step
        before = len(sim.said)
        sim.say(word)
        assert [phrase(text) for text in sim.said[before:]] == ["declined" if step == "offered" else "thanks_anyway"]
        sim.advance(60.0)
        assert not sim.read(charades.game).is_on
        assert len(sim.said) == before + 1 or not any(
            phrase(text).startswith("back") for text in sim.said[before + 1 :]
        )


def test_the_word_goodbye_ends_the_game_and_another_module_answers() -> None:
    with agent(hibye) as sim:
        sim.say("let's play charades")
        sim.say("goodbye")
        sim.advance(1.0)
        assert not sim.read(charades.game).is_on
        assert any(word in sim.said[-1].lower() for word in ("bye", "later", "care", "so long"))


def test_the_game_ends_when_the_last_user_leaves() -> None:
    with agent() as sim:
        sim.put(interloc.users, {"door": None})
        sim.say("let's play charades")
        before = len(sim.said)
        sim.put(interloc.users, {})
        sim.advance(40.0)
        assert not sim.read(charades.game).is_on
        assert not [text for text in sim.said[before:] if phrase(text) in ("lapsed", "back_choosing", "count")]


def test_an_agent_with_a_body_performs_its_riddle() -> None:
    shown: list[str] = []
    body = rs.Module("body", requires=[charades])

    @body.rule(when=rs.startup, writes=charades.gestures)
    async def offer(ctx: rs.RuleContext) -> None:
        ctx[charades.gestures] = frozenset({"waving"})

    @body.rule(when=charades.perform.max_age(None).detached())
    async def move(ctx: rs.RuleContext) -> None:
        shown.append(ctx.payload(charades.perform))

    with agent(body) as sim:
        sim.advance(0.1)
        run(
            sim,
            """
            > let's play charades
            = begin
            > you go first
            = gesture
            > is it boxing?
            = hint
            > you are waving
            = solved
            """,
        )
    assert shown == ["waving"]


def test_every_question_can_be_repeated() -> None:
    with agent() as sim:
        for step in ("offered", "choosing", "guessed", "asked", "unseen", "blind", "between"):
            assert "repeat" in moves_of(step)  # type: ignore[arg-type]
            assert f"back_{step}" in PhraseBook.load([PHRASES]).intents
        assert sim.said == []


def test_the_word_stop_ends_the_game_even_if_another_module_answers_it() -> None:
    """The first "stop" ends the game, and only the second makes the agent promise to be quiet."""
    loud = rs.Module("loud", requires=[rawio, idle])

    @loud.rule(when=idle.hushed, writes=rawio.output, weight=20.0)
    async def keep_quiet(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I'll be quiet."

    with agent(loud) as sim:
        sim.say("let's play charades")
        sim.say("stop")
        assert phrase(sim.said[-1]) == "thanks_anyway"
        assert not sim.read(charades.game).is_on
        sim.say("stop")
        assert sim.said[-1] == "I'll be quiet."
