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
from .inquiries import EVERYTHING
from .profile import News, learn
from .replies import asking, clauses, learned, memorable, say, stating, summary
from .talk import FORGET, TRIES, Talk
from .topics import NAME, TOPICS, Fact
from .understanding import Meaning
from .wording import among, same

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Response:
    """The response to an utterance.

    Attributes:
        answer: The reply; None if there is none.
        user: The user after the utterance.
        errand: A task with memory (None where there is none) that comes before the reply. It returns the final response.
            It raises nothing: ``talk.trouble`` has a failure of memory.
    """

    answer: Intent | None
    user: Acquaintance
    errand: Callable[[ontology.Memory | None], Awaitable[Response]] | None = None


def respond_to(meaning: Meaning, user: Acquaintance, now: float, chance: random.Random) -> Response:
    """Return the response to an utterance."""
    listening = replace(user, talk=user.talk.listening(leave=meaning.leave))
    match meaning.kind:
        case "nothing":
            return Response(None, listening)
        case "told" | "corrected":
            return _told(meaning, listening, now, chance)
        case "declined" | "unsure":
            return _closed(meaning.kind, meaning.topic, listening)
        case "none":
            closed = _closed("none", meaning.topic, listening).user
            none = Meaning("none", (Fact(meaning.topic, (), gone=True),), meaning.topic)
            return _told(none, closed, now, chance)
        case "which":
            talk = replace(user.talk, ignored=0)  # the question stays open
            return Response(say("which", user.known), replace(user, talk=talk))
        case "mentioned":
            asking_on = replace(listening, talk=listening.talk.asking(meaning.topic, now))
            return Response(say("ask_relative", user.known), asking_on)
        case "asked":
            return _asked(meaning.facts[0], listening, now)
        case "strike":
            return _struck(meaning.facts, listening)
        case "forget":
            if not user.known:
                return Response(say("forget_nobody", {}), listening)
            asking_back = replace(listening, talk=listening.talk.asking(FORGET, now))
            return Response(say("forget_ask", user.known), asking_back)
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


# ------------------------------------------------------------------------------------ told


def _told(meaning: Meaning, user: Acquaintance, now: float, chance: random.Random) -> Response:
    names = [fact for fact in meaning.facts if fact.topic == NAME]
    name = next((fact.values[0] for fact in names if not fact.gone), None)
    if names and name is None:  # my name is not Ada
        return Response(asking(NAME, {}), replace(user, talk=user.talk.asking(NAME, now)))
    before = user
    news = learn(user.facts, meaning.facts, user.talk.latest if meaning.kind == "corrected" else ())
    user = replace(user, facts=news.facts, talk=_learning(user.talk, meaning, news, name))
    if name is not None and user.who is None:
        user = replace(user, who=ontology.Node("Person", {NAME: name}))

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, name, memory)
        if after.talk.trouble and not user.talk.warned:
            warned = replace(after, talk=replace(after.talk, warned=True))
            return Response(say("unsaved_name" if name is not None else "unsaved", after.known), warned)
        if meaning.kind == "none":
            return Response(say("none", after.known), after)
        if name is not None:
            return _of_name(name, before, after, chance)
        return Response(_of_facts(meaning, news, before, after), after)

    return Response(None, user, write)


async def _written(user: Acquaintance, name: str | None, memory: ontology.Memory | None) -> Acquaintance:
    """Save the facts about the user, under their new name if they told one."""
    again = name is not None and not (user.name and same(user.name, name))
    try:
        if user.who is not None:  # otherwise only this conversation has the facts
            user = await _at_once(
                memory, lambda graph: (user.renamed(graph, name) if again and name else user).noted(graph)
            )
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
    main = NAME if name is not None else _main(meaning, news)
    latest = (name,) if name is not None else next((f.values for f in meaning.facts if f.topic == main), ())
    talk = talk.learning(topics, main, latest)
    if talk.question is not None and (asked := TOPICS.get(talk.question.topic)) and set(asked.besides) & set(topics):
        talk = replace(talk, question=None)
    once = {topic: (*talk.once.get(topic, ()), *news.facts.get(topic, ())) for topic in news.topics}
    once = {topic: tuple(dict.fromkeys(values)) for topic, values in once.items()}
    return replace(talk, told=talk.told - {NAME}, once={**talk.once, **once})


def _of_name(name: str, before: Acquaintance, user: Acquaintance, chance: random.Random) -> Response:
    known = user.known
    if before.name is not None and same(before.name, name):
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


def _struck(facts: tuple[Fact, ...], user: Acquaintance) -> Response:
    """Forget some of the facts that the user told."""
    gone: dict[str, tuple[str, ...]] = {}
    left = dict(user.facts)
    for fact in facts:
        for topic in (fact.topic, *TOPICS[fact.topic].besides):
            known = left.get(topic, ())
            gone[topic] = tuple(value for value in known if not fact.values or among(value, fact.values))
            left[topic] = tuple(value for value in known if value not in gone[topic])
    topics = [topic for topic in gone if gone[topic]]
    if not topics:
        return Response(say("strike_unknown", user.known), user)
    left = {topic: values for topic, values in left.items() if values or topic not in gone}
    user = replace(user, facts=left, talk=user.talk.striking({topic: gone[topic] for topic in topics}))

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, None, memory)
        return Response(say("forget_failed" if after.talk.trouble else "strike", after.known), after)

    return Response(None, user, write)


async def _forget(user: Acquaintance, memory: ontology.Memory | None) -> Response:
    """Forget the user, and ask them nothing more."""

    def forget(graph: ontology.Graph) -> None:
        found = user.recall(graph)  # memory may have failed when the user came
        if found.who is not None:
            graph.forget(found.who)

    try:
        if user.who is not None:
            await _at_once(memory, forget)
    except RavestateError as error:
        talk = replace(user.talk.closing(), trouble=str(error))
        return Response(say("forget_failed", user.known), replace(user, talk=talk))
    return Response(say("forgotten", {}), Acquaintance(None, {}, Talk(tries=dict.fromkeys(TOPICS, TRIES))))
