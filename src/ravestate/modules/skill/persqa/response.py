"""The response to an utterance: the facts after it, and the reply."""

from __future__ import annotations

import contextlib
import random
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, replace
from typing import TypeVar

from ravestate.errors import PlatformError, RavestateError
from ravestate.modules import ontology
from ravestate.modules.meta.verbaliser.intents import Intent

from .acquaintance import Acquaintance
from .profile import News, learn, told_apart
from .replies import asking, clauses, learned, memorable, say, stating, summary
from .talk import CONFIRM, FORGET, TRIES, Talk
from .topics import NAME, TOPICS, Fact, in_order
from .understanding import EVERYTHING, Meaning
from .wording import among, joined, same

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Response:
    """The response to an utterance.

    Attributes:
        answer: The reply; None if there is none.
        user: The user after the utterance.
        errand: A task with memory (None where there is none) that comes before the reply. It returns the final response.
            It raises nothing: ``talk.trouble`` has a failure of memory.
        forgotten: Whether the user has been forgotten.
    """

    answer: Intent | None
    user: Acquaintance
    errand: Callable[[ontology.Memory | None], Awaitable[Response]] | None = None
    forgotten: bool = False


def respond_to(
    meaning: Meaning, user: Acquaintance, now: float, chance: random.Random, *, confirm: bool = False
) -> Response:
    """Return the response to an utterance.

    Args:
        meaning: The meaning of the utterance.
        user: The user before it.
        now: Seconds from the beginning of the context.
        chance: The source of random choices.
        confirm: Whether a known name has to be confirmed before memory's facts are used.
    """
    listening = replace(user, talk=user.talk.listening(now, leave=meaning.leave))
    if user.talk.doubt and meaning.kind not in ("vouched", "told") and _lapsed(listening.talk):
        listening = listening.stranger()
    match meaning.kind:
        case "nothing":
            return Response(None, listening)
        case "told" | "corrected":
            return _told(meaning, listening, now, chance, confirm=confirm)
        case "identified":
            return _identified(meaning, listening, now, chance, confirm=confirm)
        case "vouched":
            return Response(None, listening, lambda memory: _settled(meaning, listening, memory, now, chance))
        case "mistaken":
            return _mistaken(listening, now)
        case "asked_told":
            return Response(say("recall", user.known, fact=joined([one.text for one in meaning.free])), listening)
        case "declined" | "unsure":
            return _closed(meaning.kind, meaning.topic, listening)
        case "none":
            closed = _closed("none", meaning.topic, listening).user
            none = Meaning("none", (Fact(meaning.topic, (), gone=True),), meaning.topic)
            return _told(none, closed, now, chance, confirm=confirm)
        case "which":
            talk = replace(user.talk, ignored=0, spoke=now)  # the question stays open
            return Response(say("which", user.known), replace(user, talk=talk))
        case "mentioned":
            asking_on = replace(listening, talk=listening.talk.asking(meaning.topic, now))
            return Response(say("ask_relative", user.known), asking_on)
        case "asked":
            return _asked(meaning.facts[0], listening, now)
        case "strike":
            return _struck(meaning, listening)
        case "forget":
            return _wants_out(listening, now)
        case "forget_no":
            talk = listening.talk.closing()
            return Response(say("forget_not", user.known), replace(listening, talk=talk))
        case "forget_yes":
            return Response(None, listening, lambda memory: _forget(listening, memory))


def _closed(intent: str, topic: str, user: Acquaintance) -> Response:
    return Response(say(intent, user.known), replace(user, talk=user.talk.closing(topic)))


async def _at_once(memory: ontology.Memory | None, operations: Callable[[ontology.Graph], T]) -> T:
    if memory is None:
        raise PlatformError("there is no memory")
    return await memory.together(operations)


def _lapsed(talk: Talk) -> bool:
    """Return whether the question that should confirm the name waits no longer."""
    return talk.question is None or talk.question.topic != CONFIRM or talk.question.turns > 1


# ------------------------------------------------------------------------------------ identity


def _identified(meaning: Meaning, user: Acquaintance, now: float, chance: random.Random, *, confirm: bool) -> Response:
    """Return the response to *it's me*, with a name or without."""
    name = meaning.facts[0].values[0] if meaning.facts else None
    if user.name is not None and (name is None or same(name, user.name)):
        return Response(say("back", user.known), user)
    if name is None:
        return Response(say("identify", {}), replace(user, talk=user.talk.asking(NAME, now)))
    return _told(replace(meaning, kind="told"), user, now, chance, confirm=confirm)


async def _settled(
    meaning: Meaning, user: Acquaintance, memory: ontology.Memory | None, now: float, chance: random.Random
) -> Response:
    """Return the response to the answer that should confirm the name."""
    answer = meaning.facts[0].values if meaning.facts else ()
    user = replace(user, talk=user.talk.closing())

    def settle(graph: ontology.Graph) -> Acquaintance:
        return user.settled(graph, answer).noted(graph)

    try:
        after = await _at_once(memory, settle)
    except RavestateError as error:
        after = replace(user.stranger(), talk=replace(user.stranger().talk, trouble=str(error)))
    if after.talk.wants_out:
        return _wants_out(after, now)
    if after.talk.newcomer:
        return Response(say("namesake", after.known), after)
    assert after.name is not None
    return _of_name(after.name, user, after, chance, now)


def _mistaken(user: Acquaintance, now: float) -> Response:
    """Take back that the user is the person of their name, and ask who they are."""
    asking_on = Talk().asking(NAME, now)

    async def take_back(memory: ontology.Memory | None) -> Response:
        facts = told_apart(user.facts, user.talk.remembered, user.talk.told) if user.talk.met else user.facts
        after = Acquaintance(None, facts, replace(asking_on, told=frozenset(facts), spoke=now))
        with contextlib.suppress(RavestateError):
            if user.talk.met and not user.talk.newcomer:
                await _at_once(memory, user.restored)
        return Response(say("mistaken", {}), after)

    return Response(None, user, take_back)


# ------------------------------------------------------------------------------------ told


def _told(meaning: Meaning, user: Acquaintance, now: float, chance: random.Random, *, confirm: bool) -> Response:
    names = [fact for fact in meaning.facts if fact.topic == NAME]
    name = next((fact.values[0] for fact in names if not fact.gone), None)
    if names and name is None:  # my name is not Ada
        return Response(asking(NAME, {}), replace(user, talk=user.talk.asking(NAME, now)))
    before = user
    news = learn(user.facts, meaning.facts, user.talk.latest if meaning.kind == "corrected" else ())
    told = {**user.told, **{one.key: one for one in meaning.free}}
    user = replace(user, facts=news.facts, talk=_learning(user.talk, meaning, news, name), told=told)
    if name is not None and user.who is None:
        user = replace(user, who=ontology.Node("Person", {NAME: name}))

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, name, memory, confirm=confirm)
        if after.talk.doubt and not user.talk.doubt:
            talk = after.talk.asking(CONFIRM, now)
            return Response(_confirming(after), replace(after, talk=talk))
        if after.talk.wants_out and name is not None:
            return _wants_out(after, now)
        if not meaning.facts:
            return Response(None, after)
        if after.talk.trouble and not user.talk.warned:
            warned = replace(after, talk=replace(after.talk, warned=True))
            return Response(say("unsaved_name" if name is not None else "unsaved", after.known), warned)
        if meaning.kind == "none":
            return Response(say("none", after.known), after)
        if name is not None:
            return _of_name(name, before, after, chance, now)
        return Response(_of_facts(meaning, news, before, after), after)

    return Response(None, user, write)


async def _written(
    user: Acquaintance, name: str | None, memory: ontology.Memory | None, *, confirm: bool = False
) -> Acquaintance:
    """Save the facts about the user, under their new name if they told one."""
    again = name is not None and not (user.name and same(user.name, name))

    def write(graph: ontology.Graph) -> Acquaintance:
        now = user.renamed(graph, name) if again and name else user
        return (now.doubted(graph) if confirm and name else now).noted(graph)

    try:
        if user.who is not None:  # otherwise only this conversation has the facts
            user = await _at_once(memory, write)
        return replace(user, talk=replace(user.talk, trouble=""))
    except RavestateError as error:
        user = replace(user, talk=replace(user.talk, trouble=str(error)))
    if again:
        return replace(user, who=ontology.Node("Person", {NAME: name}))  # for as long as the conversation lasts
    with contextlib.suppress(RavestateError):  # reading may work where writing fails
        return await _at_once(memory, user.recall)
    return user


def _learning(talk: Talk, meaning: Meaning, news: News, name: str | None) -> Talk:
    topics = [*([NAME] if name is not None else []), *news.topics]
    if not topics:
        return replace(talk, formal=False)  # a free statement
    main = NAME if name is not None else _main(meaning, news)
    latest = (name,) if name is not None else next((f.values for f in meaning.facts if f.topic == main), ())
    unasked = talk.question is None or talk.question.topic not in topics
    talk = replace(talk.learning(topics, main, latest), formal=talk.formal and not unasked)
    if talk.question is not None and (asked := TOPICS.get(talk.question.topic)) and set(asked.besides) & set(topics):
        talk = replace(talk, question=None)
    once = {topic: (*talk.once.get(topic, ()), *news.facts.get(topic, ())) for topic in news.topics}
    once = {topic: tuple(dict.fromkeys(values)) for topic, values in once.items()}
    return replace(talk, told=talk.told - {NAME}, once={**talk.once, **once})


def _confirming(user: Acquaintance) -> Intent:
    """Return the greeting of somebody who may be an acquaintance, with a question that tells."""
    topic = user.talk.doubt
    if TOPICS[topic].asked:
        return say(f"vouch_{topic}", {}, name=user.name)
    noun = f"{topic}'s name" if TOPICS[topic].kind == "people" else topic
    return say("vouch", {}, name=user.name, topic=noun)


def _of_name(name: str, before: Acquaintance, user: Acquaintance, chance: random.Random, now: float) -> Response:
    known = user.known
    if not before.talk.doubt and before.name is not None and same(before.name, name):
        return Response(stating("known_already", NAME, (name,), known), user)
    remembered = {topic: values for topic, values in user.talk.remembered.items() if values}
    if remembered:
        topic = memorable(remembered, chance)
        return Response(
            stating("welcome_back", topic, remembered[topic], known),
            replace(user, talk=replace(user.talk, reminded=True)),
        )
    return Response(say("learned_name" if before.name is None else "renamed", known), user)


def _main(meaning: Meaning, news: News) -> str:
    """Return the topic to reply to: the one that the agent asked about, otherwise the first new one."""
    if meaning.topic in news.topics:
        return meaning.topic
    return next((topic for topic in news.topics if topic in news.new), news.topics[0])


def _of_facts(meaning: Meaning, news: News, before: Acquaintance, user: Acquaintance) -> Intent:
    topic = _main(meaning, news)
    fact = next(fact for fact in meaning.facts if fact.topic == topic)
    known = user.known
    if fact.gone:
        return say("struck" if topic in news.changed else "none", known)
    if topic in news.changed and (meaning.kind == "corrected" or not TOPICS[topic].many):
        return stating("corrected", topic, user.facts[topic], known)
    if topic not in news.new and before.facts.get(topic):
        return stating("known_already", topic, fact.values, known)
    return learned(topic, fact.values, known)


# ------------------------------------------------------------------------------------ asked


def _asked(fact: Fact, user: Acquaintance, now: float) -> Response:
    known: Mapping[str, tuple[str, ...]] = user.known
    topic = fact.topic
    if topic == EVERYTHING:
        if any(known.values()):
            return Response(summary(known), replace(user, talk=replace(user.talk, reminded=True)))
        return Response(say("recall_nothing", known), user)
    if not topic:  # no topic covers it
        return Response(say("recall_not", known), user)
    answers = {name: known[name] for name in (topic, *TOPICS[topic].besides) if known.get(name)}
    if answers:
        if fact.values:
            right = all(any(among(asked, values) for values in answers.values()) for asked in fact.values)
            intent = "confirm" if right else "deny"
        else:
            intent = "recall_name" if topic == NAME else "recall"
        last = next(iter(answers))
        mentioned = replace(user, talk=user.talk.mentioning(last, answers[last]))
        return Response(say(intent, known, fact=clauses(answers)), mentioned)
    if topic in known:
        return Response(say("recall_none", known), user)
    if topic in user.talk.closed:
        return Response(say("recall_declined", known), user)
    unknown = "recall_stranger" if topic == NAME else "recall_unknown"
    return Response(say(unknown, known), replace(user, talk=user.talk.asking(topic, now)))


def _struck(meaning: Meaning, user: Acquaintance) -> Response:
    """Forget some of the facts that the user told."""
    facts = meaning.facts
    told = {key: one for key, one in user.told.items() if key not in {gone.key for gone in meaning.free}}
    gone: dict[str, tuple[str, ...]] = {}
    left = dict(user.facts)
    for fact in facts:
        for topic in (fact.topic, *TOPICS[fact.topic].besides):
            known = left.get(topic, ())
            gone[topic] = tuple(value for value in known if not fact.values or among(value, fact.values))
            left[topic] = tuple(value for value in known if value not in gone[topic])
    topics = [topic for topic in gone if gone[topic]]
    if not topics and len(told) == len(user.told):
        return Response(say("strike_unknown", user.known), user)
    left = {topic: values for topic, values in left.items() if values or topic not in gone}
    user = replace(user, facts=left, talk=user.talk.striking({topic: gone[topic] for topic in topics}), told=told)

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, None, memory)
        return Response(say("forget_failed" if after.talk.trouble else "strike", after.known), after)

    return Response(None, user, write)


# ------------------------------------------------------------------------------------ forgotten


def _wants_out(user: Acquaintance, now: float) -> Response:
    """Ask back before forgetting everything, or ask who the user is."""
    if user.who is None and not user.known and not user.told:
        talk = replace(user.talk.asking(NAME, now), wants_out=True)
        return Response(say("forget_who", {}), replace(user, talk=talk))
    talk = replace(user.talk, wants_out=False)
    if user.talk.wants_out and user.talk.newcomer and not user.facts and not user.told:
        return Response(say("forget_nobody", user.known), replace(user, talk=talk))
    return Response(say("forget_ask", user.known, what=_removed(user)), replace(user, talk=talk.asking(FORGET, now)))


def _removed(user: Acquaintance) -> str:
    """Return what forgetting the user removes, in words."""
    topics = [f"your {topic}" for topic in in_order(user.known) if user.known[topic]]
    amount = len(user.told)
    things = [f"{amount} other thing{'s' if amount > 1 else ''} that you told me"] if amount else []
    return joined([*topics, *things] or ["what you said"])


async def _forget(user: Acquaintance, memory: ontology.Memory | None) -> Response:
    """Forget the user, and ask them nothing more."""

    def forget(graph: ontology.Graph) -> Acquaintance:
        found = user.recall(graph)  # memory may have failed when the user came
        if found.who is not None:
            graph.forget(found.who)
        return found

    found = user
    try:
        if user.who is not None:
            found = await _at_once(memory, forget)
    except RavestateError as error:
        talk = replace(user.talk.closing(), trouble=str(error))
        return Response(say("forget_failed", user.known), replace(user, talk=talk))
    gone = Acquaintance(None, {}, Talk(tries=dict.fromkeys(TOPICS, TRIES)))
    return Response(say("forgotten", {}, what=_removed(found)), gone, forgotten=True)
