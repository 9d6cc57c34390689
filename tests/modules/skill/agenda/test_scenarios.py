"""Agents with several goals, in virtual time: the order of the goals, and interruptions by the user."""

from itertools import pairwise

import pytest

import ravestate as rs
from ravestate.modules import agenda, emotion, idle, rawio, verbaliser
from ravestate.modules.skill.agenda import Goal, GoalState
from ravestate.testing import Simulation, simulate

PATIENT = {"idle": {"remarks": 100}}
"""Settings of an agent that continues to pursue goals during a long silence of the user."""
AT_ONCE = {"agenda": {"gap": 0.0}, "idle": {"bored_after": 5.0, "answer_time": 0.0, "remarks": 100}}


def agent(name: str = "guide") -> rs.Module:
    return rs.Module(name, requires=[rawio, idle, verbaliser, agenda])


def with_times(sim: Simulation, seconds: float) -> list[tuple[int, str]]:
    """Let some seconds pass, and return the second and the text of each utterance."""
    heard: list[tuple[int, str]] = []
    for _ in range(int(seconds)):
        before = len(sim.said)
        sim.advance(1.0)
        heard += [(round(sim.now), text) for text in sim.said[before:]]
    return heard


def chatter(seconds: float = 0.0) -> rs.Module:
    talk = rs.Module("chatter", requires=[rawio])

    @talk.rule(when=rawio.input.changed, writes=rawio.output)
    async def answer(ctx: rs.RuleContext) -> None:
        if seconds:
            await ctx.sleep(seconds)
        ctx[rawio.output] = "I see."

    return talk


def test_a_goal_is_pursued_after_a_silence_and_is_done_when_its_text_has_been_said() -> None:
    guide = agent()
    goal = agenda.goal(guide, "ice_cream", say="Do you know my ice cream?")
    with simulate(guide) as sim:
        assert goal.state(sim).status == "open"
        sim.advance(4.9)
        assert sim.said == []
        sim.advance(0.1)
        assert sim.said == ["Do you know my ice cream?"]
        assert goal.state(sim) == GoalState("done", 1, pytest.approx(5.0))
        assert sim.explain(goal.rule).retired
        sim.advance(1000.0)
        assert len(sim.said) == 1


def test_goals_are_pursued_by_priority_with_a_gap_between_them() -> None:
    guide = agent()
    for name, priority in (("low", 0.5), ("high", 2.0), ("middle", 1.0)):
        agenda.goal(guide, name, say=name, priority=priority)
    with simulate(guide, settings=PATIENT | {"agenda": {"gap": 20.0}}) as sim:
        heard = with_times(sim, 120)
    assert [text for _, text in heard] == ["high", "middle", "low"]
    times = [time for time, _ in heard]
    assert times[0] == 5
    assert all(later - sooner >= 20 for sooner, later in pairwise(times))


def test_while_a_goal_rests_for_its_cool_down_other_goals_are_pursued() -> None:
    guide = agent()
    never = guide.signal("never")
    agenda.goal(guide, "game", say="A game?", priority=2.0, cooldown=60, done=never, tries=3)
    agenda.goal(guide, "song", say="A song?", priority=1.0, cooldown=30, done=never, tries=3)
    with simulate(guide, settings=AT_ONCE) as sim:
        heard = with_times(sim, 300)
    game = [time for time, text in heard if text == "A game?"]
    song = [time for time, text in heard if text == "A song?"]
    assert (game[0], song[0]) == (5, 10)
    assert len(game) == len(song) == 3
    assert all(60 <= b - a <= 70 for a, b in pairwise(game))
    assert all(30 <= b - a <= 40 for a, b in pairwise(song))


def test_each_try_says_the_next_text_and_the_goal_is_dropped_after_the_last_try() -> None:
    guide = agent()
    never = guide.signal("never")
    goal = agenda.goal(guide, "game", say=["A game?", "Come on!"], cooldown=60, done=never, tries=3)
    with simulate(guide, settings=PATIENT) as sim:
        sim.advance(180.0)
        assert sim.said == ["A game?", "Come on!", "Come on!"]
        assert goal.state(sim).status == "pursued"
        sim.advance(60.0)
        assert (goal.state(sim).status, goal.state(sim).tries) == ("dropped", 3)
        assert sim.explain("guide:game").retired
        sim.advance(1000.0)
        assert len(sim.said) == 3


def test_while_a_goal_waits_for_its_precondition_other_goals_are_pursued() -> None:
    guide = agent()
    open_ = guide.flag("open", input=True)
    sold_out = guide.flag("sold_out", True, input=True)
    agenda.goal(guide, "sell", say="An ice cream?", priority=5.0, when=open_.holds(bool), unless=sold_out.holds(bool))
    agenda.goal(guide, "weather", say="Lovely weather.")
    with simulate(guide, settings=AT_ONCE) as sim:
        sim.advance(60.0)
        assert sim.said == ["Lovely weather."]
        sim.put(open_, True)
        sim.advance(60.0)
        assert sim.said == ["Lovely weather."]
        assert "not_bool): false" in str(sim.explain("guide:sell"))
        sim.put(sold_out, False)
        sim.advance(12.0)
        assert sim.said == ["Lovely weather.", "An ice cream?"]


def test_a_goal_with_a_signal_as_precondition_waits_for_the_signal() -> None:
    guide = agent()
    greeted = guide.signal("greeted")
    agenda.goal(guide, "name", say="What is your name?", when=greeted.max_age(None).detached())
    with simulate(guide) as sim:
        sim.advance(60.0)
        assert sim.said == []
        sim.emit(greeted)
        sim.advance(12.0)
        assert sim.said == ["What is your name?"]


@pytest.mark.parametrize("moment", [2.0, 6.0, 40.0])
def test_success_ends_a_goal_at_any_time(moment: float) -> None:
    guide = agent()
    told = guide.signal("told")
    goal = agenda.goal(guide, "name", say="What is your name?", done=told, tries=5, cooldown=30)
    with simulate(guide) as sim:
        sim.advance(moment)
        before = len(sim.said)
        sim.emit(told)
        assert goal.state(sim).status == "done"
        sim.advance(300.0)
        assert len(sim.said) == before
        assert sim.explain(goal.rule).retired


def test_words_of_success_count_only_after_the_goal_was_pursued() -> None:
    guide = agent()
    goal = agenda.goal(guide, "game", say="A game?", done="yes|sure", refused="no|not", cooldown=30)
    with simulate(guide, chatter()) as sim:
        sim.say("Yes.")
        assert goal.state(sim).status == "open"
        sim.advance(6.0)
        assert sim.said[-1] == "A game?"
        sim.say("What a measure!")
        assert goal.state(sim).status == "pursued"
        sim.say("Oh, SURE!")
        assert goal.state(sim).status == "done"


def test_a_refused_goal_is_dropped() -> None:
    guide = agent()
    goal = agenda.goal(guide, "game", say="A game?", done="yes|sure", refused="no|not", cooldown=30)
    with simulate(guide, chatter()) as sim:
        sim.advance(5.0)
        sim.say("I am not sure.")
        assert goal.state(sim).status == "dropped"
        sim.advance(500.0)
        assert sim.said == ["A game?", "I see."]


def test_words_that_come_too_late_do_not_count_as_an_answer() -> None:
    guide = agent()
    goal = agenda.goal(guide, "game", say="A game?", done="yes", cooldown=20, tries=9)
    with simulate(guide) as sim:
        sim.advance(5.0)
        sim.put(agenda.topics, {"quiz": "quiz"})
        sim.advance(30.0)
        sim.say("yes")
        assert goal.state(sim).status == "pursued"


def test_one_signal_can_end_two_goals() -> None:
    guide = agent()
    goals = [
        agenda.goal(guide, name, say=name, done=rawio.input.changed.where(lambda text: text == "both"))
        for name in ("one", "two")
    ]
    with simulate(guide) as sim:
        sim.say("both")
        assert [goal.state(sim).status for goal in goals] == ["done", "done"]


def test_a_rule_of_the_designer_can_react_to_the_answer_to_a_goal() -> None:
    guide = agent()
    offer = agenda.goal(guide, "offer", say="Shall we play a game?", done="yes")

    @guide.rule(when=offer.pursued.max_age(60) & rawio.input.changed.where(lambda t: t == "yes"), writes=rawio.output)
    async def play(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "I spy with my little eye."

    with simulate(guide, chatter()) as sim:
        sim.say("yes")
        sim.advance(6.0)
        sim.say("yes")
        assert sim.said == ["I see.", "Shall we play a game?", "I spy with my little eye."]
        assert offer.state(sim).status == "done"
        sim.say("yes")
        assert sim.said[-1] == "I see."


def test_a_goal_without_an_event_of_success_raises_pursued_once() -> None:
    guide = agent()
    greeting = agenda.goal(guide, "greeting", say="Hello there.")
    times: list[float] = []

    @guide.rule(when=greeting.pursued.max_age(None).detached())
    async def note(ctx: rs.RuleContext) -> None:
        times.append(ctx.now)

    with simulate(guide, settings=PATIENT) as sim:
        sim.advance(100.0)
        assert sim.said == ["Hello there."]
        assert times == [pytest.approx(5.0)]
        assert greeting.state(sim).status == "done"


def test_while_the_user_talks_no_goal_is_pursued() -> None:
    guide = agent()
    agenda.goal(guide, "game", say="A game?")
    with simulate(guide, chatter(seconds=2.0)) as sim:
        for _ in range(20):
            sim.say("And another thing.")
            sim.advance(4.0)
        assert sim.said == ["I see."] * 20
        sim.advance(3.0)
        assert sim.said[-1] == "A game?"


def test_while_the_conversation_has_a_topic_no_goal_is_pursued() -> None:
    guide = agent()
    agenda.goal(guide, "game", say="A game?")
    with simulate(guide) as sim:
        sim.put(agenda.topics, {"quiz": "a quiz"})
        sim.advance(60.0)
        assert sim.said == []
        assert "the conversation is about quiz" in str(sim.explain("agenda:take_initiative"))
        sim.put(agenda.topics, {})
        sim.advance(6.0)
        assert sim.said == ["A game?"]


def test_a_goal_that_the_user_interrupts_while_its_text_is_made_is_tried_again() -> None:
    guide = agent()

    async def tell(ctx: rs.RuleContext) -> str:
        await ctx.sleep(3.0)
        return "Once upon a time."

    goal = agenda.goal(guide, "tale", say=tell)
    with simulate(guide, chatter()) as sim:
        sim.advance(6.0)
        assert sim.said == []
        sim.say("Listen!")
        assert sim.said == ["I see."]
        assert goal.state(sim).status == "open"
        sim.advance(7.9)
        assert sim.said == ["I see."]
        sim.advance(1.0)
        assert sim.said == ["I see.", "Once upon a time."]
    assert not sim.failures


def test_a_goal_that_is_reached_while_its_text_is_made_is_not_said() -> None:
    guide = agent()
    told = guide.signal("told")

    async def ask(ctx: rs.RuleContext) -> str:
        await ctx.sleep(3.0)
        return "What is your name?"

    goal = agenda.goal(guide, "name", say=ask, done=told)
    with simulate(guide) as sim:
        sim.advance(6.0)
        sim.emit(told)
        sim.advance(100.0)
        assert sim.said == []
        assert goal.state(sim).status == "done"


def test_a_goal_that_waits_for_a_rival_is_not_said_if_the_user_speaks() -> None:
    guide = agent()
    slow = rs.Module("slow", requires=[idle, rawio])
    ready = slow.signal("ready")

    @slow.rule(when=idle.bored & ready, writes=rawio.output, weight=99.0)
    async def better(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "better"

    agenda.goal(guide, "game", say="A game?")
    with simulate(guide, slow, chatter()) as sim:
        sim.advance(5.5)  # the goal waits for `better`, which has patience until 6.0
        assert "waits for slow:better" in str(sim.explain("guide:game"))
        sim.say("Hello")
        sim.advance(3.0)
        assert sim.said == ["I see."]


def test_a_function_can_make_the_text_from_slots() -> None:
    guide = agent()
    name = guide.slot("name", "Ada")
    agenda.goal(guide, "game", say=lambda ctx: f"{ctx[name]}, shall we play?", reads=name)
    with simulate(guide) as sim:
        sim.advance(5.0)
        assert sim.said == ["Ada, shall we play?"]


def test_a_goal_whose_function_returns_no_text_counts_as_not_tried() -> None:
    guide = agent()
    goal = agenda.goal(guide, "joke", say=lambda ctx: None)  # type: ignore[arg-type, return-value]  # a mistake
    with simulate(guide) as sim:
        sim.advance(20.0)
        assert sim.said == [] and goal.state(sim) == GoalState()
        assert "takes str" in str(sim.failures[0][1])
        sim.failures.clear()


def test_the_texts_of_a_goal_may_come_from_a_generator() -> None:
    guide = agent()
    agenda.goal(guide, "game", say=(text for text in ("A game?", "Come on!")), done="yes")
    with simulate(guide, settings=PATIENT) as sim:
        sim.advance(90.0)
        assert sim.said == ["A game?", "Come on!"]


def test_a_goal_with_an_intent_is_worded_by_the_verbaliser_and_excludes_other_remarks() -> None:
    guide = agent()
    agenda.goal(guide, "wonder", intent="unknown", priority=2.0)
    agenda.goal(guide, "weather", say="Lovely weather.")
    lonely = rs.Module("lonely", requires=[idle, rawio])

    @lonely.rule(when=idle.bored, writes=rawio.output)
    async def ask(ctx: rs.RuleContext) -> None:
        ctx[rawio.output] = "Are you there?"

    with simulate(guide, lonely, settings={"idle": {"bored_after": 5.0, "answer_time": 0.0, "remarks": 100}}) as sim:
        sim.advance(5.0)
        assert len(sim.said) == 1
        assert sim.said[0] not in ("Lovely weather.", "Are you there?")
        sim.advance(5.0)
        assert sim.said[1:] == ["Are you there?"]  # the agenda keeps its gap
        sim.advance(10.0)
        assert "Lovely weather." in sim.said


def test_the_agent_drops_all_goals_if_the_user_stays_silent() -> None:
    guide = agent()
    never = guide.signal("never")
    for name in ("one", "two", "three"):
        agenda.goal(guide, name, say=name, done=never, tries=2)
    with simulate(guide, settings=PATIENT) as sim:
        sim.advance(3600.0)
        assert sorted(sim.said) == ["one", "one", "three", "three", "two", "two"]
        assert {state.status for state in sim.read(agenda.goals).values()} == {"dropped"}
        assert [a["rule"] for a in sim.snapshot()["activations"]] in ([], ["idle:notice_silence"])
        sim.advance(3600.0)
        assert len(sim.said) == 6


def test_a_goal_waits_for_the_user_after_two_remarks_without_an_answer() -> None:
    guide = agent()
    for name in ("one", "two", "three"):
        agenda.goal(guide, name, say=name)
    with simulate(guide, chatter()) as sim:
        sim.advance(3600.0)
        assert sim.said == ["one", "two"]
        sim.say("hello")
        sim.advance(60.0)
        assert sim.said[2:] == ["I see.", "three"]


def test_two_contexts_of_one_policy_share_nothing() -> None:
    guide = agent()
    told = guide.signal("told")
    goal = agenda.goal(guide, "name", say="Your name?", done=told)
    policy = rs.compile(guide)
    wish = {"agenda": {"goals": [{"name": "extra", "say": "Extra.", "priority": 9}]}}
    with simulate(policy, settings=wish) as one, simulate(policy) as other:
        one.emit(told)
        one.advance(60.0)
        other.advance(6.0)
        assert one.said == ["Extra."]
        assert other.said == ["Your name?"]
        assert goal.state(one).status == "done"
        assert goal.state(other).status == "pursued"
        assert one.explain(goal.rule).retired
        assert not other.explain(goal.rule).retired
        assert "agenda:extra" not in other.context.policy.rules


def test_explain_check_and_graph_show_a_goal() -> None:
    guide = agent()
    agenda.goal(guide, "game", say="A game?", priority=2.0, done="yes", refused="no")
    policy = rs.compile(guide)
    assert [name for name in policy.rules if name.startswith("guide")] == [
        "guide:game",
        "guide:game_given_up",
        "guide:game_done",
        "guide:game_refused",
    ]
    assert [str(f) for f in policy.findings() if f.subject not in ("idle:impatient", "idle:hushed")] == []
    assert "guide:game" in policy.diagram("dot")
    assert all(__file__ in rule.origin for rule in policy.rules.values() if rule.name.startswith("guide"))
    with simulate(policy) as sim:
        sim.advance(8.0)
        assert "finished" in str(sim.explain("guide:game"))
        sim.advance(22.0)  # first the user has time to answer the question, and then the gap between goals passes
        assert "the goal was pursued" in str(sim.explain("guide:game"))
        assert "rests for another" in str(sim.explain("guide:game"))


def test_an_emoji_does_not_delay_a_goal() -> None:
    guide = agent()
    agenda.goal(guide, "game", say="A game?")
    with simulate(guide, emotion, chatter(), settings={"agenda": {"gap": 10.0}}) as sim:
        sim.say("You are so clever!")
        sim.advance(6.0)
        assert [sim.said[0], *sim.said[2:]] == ["I see.", "A game?"]


def test_the_function_goal_returns_an_object_with_the_name_of_its_rule() -> None:
    guide = agent()
    goal = agenda.goal(guide, "game", say="A game?", done="yes")
    assert isinstance(goal, Goal)
    assert goal.name == goal.rule.name == "guide:game"
