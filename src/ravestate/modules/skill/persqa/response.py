"""What becomes of the user's words: what is known after them, and what to say to them."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace

from ravestate.errors import RavestateError
from ravestate.modules import ontology
from ravestate.modules.meta.verbaliser.intents import Intent

from .acquaintance import Acquaintance
from .inquiries import EVERYTHING
from .profile import News, learn
from .replies import asking, learned, memorable, say, stating, summary
from .talk import FORGET, Talk
from .topics import NAME, TOPICS, Fact
from .understanding import Meaning
from .wording import same

__all__ = ["respond_to"]

Response = tuple[Intent | None, Acquaintance]


async def respond_to(
    meaning: Meaning,
    user: Acquaintance,
    memory: ontology.Memory | None,
    now: float,
    chance: random.Random,
) -> Response:
    """Return what to say to an utterance, None if nothing, and the user as he is known after it.

    Memory that fails is told in ``talk.trouble``; nothing is raised for it.

    Args:
        meaning: What was said.
        user: As he was known before.
        memory: None if there is none.
        now: Seconds since the context began.
        chance: Decides what is mentioned.
    """
    listening = replace(user, talk=user.talk.listening(leave=meaning.leave))
    match meaning.kind:
        case "nothing":
            return None, listening
        case "told" | "corrected":
            return await _told(meaning, listening, memory, now, chance)
        case "declined" | "unsure":
            return _closed(meaning.kind, meaning.topic, listening)
        case "none":
            _, closed = _closed("none", meaning.topic, listening)
            none = Meaning("told", (Fact(meaning.topic, (), gone=True),), meaning.topic)
            _, after = await _told(none, closed, memory, now, chance)
            return say("none", after.known), after
        case "which":
            talk = replace(user.talk, ignored=0)  # the question stands
            return say("which", user.known), replace(user, talk=talk)
        case "asked":
            return _asked(meaning.facts[0], listening, now)
        case "forget":
            if not user.known:
                return say("forget_nobody", {}), listening
            return say("forget_ask", user.known), replace(listening, talk=listening.talk.asking(FORGET, now))
        case "forget_no":
            return say("forget_not", user.known), replace(listening, talk=listening.talk.closing())
        case "forget_yes":
            return await _forget(listening, memory)


def _closed(intent: str, topic: str, user: Acquaintance) -> Response:
    return say(intent, user.known), replace(user, talk=user.talk.closing(topic))


# ------------------------------------------------------------------------------------ told


async def _told(
    meaning: Meaning,
    user: Acquaintance,
    memory: ontology.Memory | None,
    now: float,
    chance: random.Random,
) -> Response:
    names = [fact for fact in meaning.facts if fact.topic == NAME]
    name = next((fact.values[0] for fact in names if not fact.gone), None)
    if names and name is None:  # my name is not Ada
        return asking(NAME, {}), replace(user, talk=user.talk.asking(NAME, now))
    before = user
    instead_of = user.talk.latest if meaning.kind == "corrected" else ()
    news = learn(user.facts, meaning.facts, instead_of)
    user = replace(user, facts=news.facts, talk=_learning(user.talk, meaning, news, name))
    again = name is not None and before.name is not None
    try:
        if name is not None:
            user = await _named(user, name, memory)
        user = await user.noted(memory)
        user = replace(user, talk=replace(user.talk, trouble=""))
    except RavestateError as error:
        user = replace(user, talk=replace(user.talk, trouble=str(error)))
        if name is not None and not (user.name and same(user.name, name)):
            user = replace(user, who=ontology.Node("Person", {NAME: name}))  # for as long as the talk lasts
        if not user.talk.warned:
            user = replace(user, talk=replace(user.talk, warned=True))
            return say("unsaved_name" if name is not None else "unsaved", user.known), user
    if name is None:
        return _of_facts(meaning, news, before, user), user
    return _of_name(name, again, before, user, chance)


def _learning(talk: Talk, meaning: Meaning, news: News, name: str | None) -> Talk:
    topics = [*([NAME] if name is not None else []), *news.topics]
    main = NAME if name is not None else _main(meaning, news)
    latest = (name,) if name is not None else next((f.values for f in meaning.facts if f.topic == main), ())
    talk = talk.learning(topics, main, latest)
    return replace(talk, told=talk.told - {NAME})


async def _named(user: Acquaintance, name: str, memory: ontology.Memory | None) -> Acquaintance:
    """The user has this name."""
    if user.who is None:
        return replace(user, who=ontology.Node("Person", {NAME: name}))
    if user.name is not None and same(user.name, name):
        return user
    return await user.renamed(memory, name)


def _of_name(
    name: str, again: bool, before: Acquaintance, user: Acquaintance, chance: random.Random
) -> Response:
    known = user.known
    if again and before.name is not None and same(before.name, name):
        return stating("known_already", NAME, (name,), known), user
    remembered = {topic: values for topic, values in user.talk.remembered.items() if values}
    if remembered:
        topic = memorable(remembered, chance)
        return (
            stating("welcome_back", topic, remembered[topic], known),
            replace(user, talk=replace(user.talk, reminded=True)),
        )
    return say("renamed" if again else "learned_name", known), user


def _main(meaning: Meaning, news: News) -> str:
    """What is worth an answer: what was asked, else the first that is new."""
    if meaning.topic in news.topics:
        return meaning.topic
    return next((topic for topic in news.topics if topic in news.new), news.topics[0])


def _of_facts(meaning: Meaning, news: News, before: Acquaintance, user: Acquaintance) -> Intent:
    topic = _main(meaning, news)
    fact = next(fact for fact in meaning.facts if fact.topic == topic)
    known = user.known
    if fact.gone:
        return say("struck", known)
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
            return summary(known), replace(user, talk=replace(user.talk, reminded=True))
        return say("recall_nothing", known), user
    mentioned = replace(user, talk=user.talk.mentioning(topic, known.get(topic, ())))
    if fact.values and known.get(topic):
        right = all(any(same(asked, value) for value in known[topic]) for asked in fact.values)
        return stating("confirm" if right else "deny", topic, known[topic], known), mentioned
    if known.get(topic):
        return stating("recall_name" if topic == NAME else "recall", topic, known[topic], known), mentioned
    if topic in known:
        return say("recall_none", known), user
    if topic in user.talk.closed:
        return say("recall_declined", known), user
    unknown = "recall_stranger" if topic == NAME else "recall_unknown"
    return say(unknown, known), replace(user, talk=user.talk.asking(topic, now))


async def _forget(user: Acquaintance, memory: ontology.Memory | None) -> Response:
    """Forget the user, and do not ask him again."""
    if user.who is not None and memory is not None:
        try:
            found = await user.recall(memory)  # he may be remembered although memory failed when he came
            if found.who is not None:
                await memory.forget(found.who)
        except RavestateError as error:
            talk = replace(user.talk.closing(), trouble=str(error))
            return say("forget_failed", user.known), replace(user, talk=talk)
    return say("forgotten", {}), Acquaintance(None, {}, Talk(closed=frozenset(TOPICS), met=False))
