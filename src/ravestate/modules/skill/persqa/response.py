"""The response to an utterance: the facts after it, and the reply.

A fact has a *topic*, such as *home*, and *values*, such as *Ulm*.
"""

from __future__ import annotations

import contextlib
import random
import re
from collections.abc import Awaitable, Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, TypeVar

from ravestate.errors import PlatformError, RavestateError
from ravestate.modules import nlp, ontology
from ravestate.modules.meta.verbaliser.intents import Intent

from .acquaintance import Acquaintance
from .profile import News, learn, told_apart
from .talk import CONFIRM, FORGET, LONGEST, TRIES, Talk
from .told import Told
from .topics import NAME, TOPICS, WORDS, Fact, in_order, is_topic
from .understanding import EVERYTHING, Meaning, is_idle
from .wording import alike, among, clauses, joined, learned, memorable, same, say, stating, without

T = TypeVar("T")
BRIEF = 9
"""The maximum number of words of an utterance for which a stock reply to its fact is enough."""


@dataclass(frozen=True, slots=True)
class Response:
    """The response to an utterance."""

    answer: Intent | None
    """The reply; None if the agent does not reply."""
    user: Acquaintance
    errand: Callable[[ontology.Memory | None], Awaitable[Response]] | None = None
    """A task that needs memory and runs before the reply. It takes the memory, or None, and returns the final response.
    If memory fails, the task raises no error, and usually sets ``talk.trouble``."""
    forgotten: bool = False


def respond_to(
    meaning: Meaning, user: Acquaintance, now: float, chance: random.Random, *, confirm: bool = False
) -> Response:
    """Return the response to an utterance.

    Args:
        meaning: The meaning of the utterance.
        user: The user before the utterance.
        now: Seconds from the beginning of the context.
        chance: The source of random choices.
        confirm: Whether a user who gives a name that memory knows must answer a question, to prove that they are this
            person.
    """
    if meaning.kind == "which":  # the question stays open
        return Response(say("which", user.known), _with(user, ignored=0, spoke=now))
    talk = user.talk
    noted = {
        "touched": talk.touched | meaning.touched,
        "said": (*talk.said, *meaning.said)[-LONGEST:],
        "words": talk.words if meaning.kind == "asked_words" else (*talk.words, *meaning.words)[-LONGEST:],
        "moved": meaning.moved,
        "busy": meaning.busy,
    }
    heard = replace(user, talk=talk.listening(now, leave=meaning.leave, person=meaning.person, **noted))
    question = heard.talk.question
    lapsed = question is None or question.topic != CONFIRM or question.turns > 1
    if user.talk.doubt and lapsed and meaning.kind not in ("vouched", "told"):
        heard = heard.stranger()
    match meaning.kind:
        case "nothing":
            return Response(None, heard)
        case "identified" if not meaning.facts or among(heard.name or "", meaning.facts[0].values):
            return (
                _ask(NAME, "identify", heard, now) if heard.name is None else Response(say("back", heard.known), heard)
            )
        case "told" | "corrected" | "identified":
            return _told(meaning, heard, now, chance, confirm=confirm)
        case "none":
            facts = (Fact(meaning.topic, gone=True),)
            return _told(replace(meaning, facts=facts), _closing(heard, meaning.topic), now, chance, confirm=confirm)
        case "vouched":
            return Response(None, heard, lambda memory: _settled(meaning, heard, memory, now, chance))
        case "mistaken":
            return Response(None, heard, lambda memory: _mistaken(heard, memory, now))
        case "asked_told":
            return Response(say("recall", user.known, fact=joined([one.text for one in meaning.free])), heard)
        case "asked_words" if meaning.words:
            return Response(say("recall_words", user.known, words=meaning.words[0]), heard)
        case "asked_words":
            return _asked(meaning.facts[0], heard, now) if meaning.facts else Response(None, heard)
        case "declined" | "unsure":
            return Response(say(meaning.kind, user.known), _closing(heard, meaning.topic))
        case "mentioned":
            return _ask(meaning.topic, "ask_relative", heard, now)
        case "asked" if len(meaning.facts) + len(meaning.free) > 1:
            return _asked_several(meaning, heard, now)
        case "asked":
            return _asked(meaning.facts[0], heard, now)
        case "strike":
            return _struck(meaning, heard)
        case "forget":
            return _wants_out(heard, now)
        case "forget_no":
            return Response(say("forget_not", heard.known), _closing(heard))
        case "forget_yes":
            return Response(None, heard, lambda memory: _forget(heard, memory))


def tells_more(answer: Intent, meaning: Meaning, seen: nlp.Analysis) -> bool:
    """Return whether a stock reply to a fact would leave out the rest of the utterance: *my son Jim has run away*.

    Small talk answers such an utterance as a whole.
    """
    if answer.name == f"learned_{NAME}":
        return seen.introduction is not None and (len(meaning.facts) == 1 or len(seen.sentences) > 1)
    told = [fact.topic for fact in meaning.facts]
    if not answer.name.startswith("learned") or meaning.topic in told:
        return False
    if sum(word.pos != "PUNCT" for word in seen.tree.words) > BRIEF:
        return True
    people = any(TOPICS[topic].kind == "people" for topic in told)
    rest = [one for one in seen.statements if one.verb not in WORDS["stating"]]
    return (people and bool(rest)) or (answer.name == "learned" and len(seen.statements) > 1)


def _with(user: Acquaintance, **changes: Any) -> Acquaintance:
    return replace(user, talk=replace(user.talk, **changes))


def _closing(user: Acquaintance, *topics: str) -> Acquaintance:
    return replace(user, talk=user.talk.closing(*topics))


def _ask(topic: str, intent: str, user: Acquaintance, now: float, /, **parameters: str | None) -> Response:
    """Return a response that asks about a topic."""
    return Response(say(intent, user.known, **parameters), replace(user, talk=user.talk.asking(topic, now)))


async def _at_once(memory: ontology.Memory | None, operations: Callable[[ontology.Graph], T]) -> T:
    if memory is None:
        raise PlatformError("there is no memory")
    return await memory.together(operations)


# ------------------------------------------------------------------------------------ identity


async def _settled(
    meaning: Meaning, user: Acquaintance, memory: ontology.Memory | None, now: float, chance: random.Random
) -> Response:
    """Return the response once the user has answered the question that tests who they are."""
    answer = meaning.facts[0].values if meaning.facts else ()
    user = _closing(user)
    try:
        after = await _at_once(memory, lambda graph: user.settled(graph, answer).noted(graph))
    except RavestateError as error:
        after = _with(user.stranger(), trouble=str(error))
    if after.talk.wants_out:
        return _wants_out(after, now)
    if after.talk.newcomer:
        return Response(say("namesake", after.known), after)
    assert after.name is not None
    return _of_name(after.name, user, after, chance)


async def _mistaken(user: Acquaintance, memory: ontology.Memory | None, now: float) -> Response:
    """Stop treating the user as the person whom the agent took them for, and ask who they are.

    If this conversation created the person, remove them from memory. Otherwise, restore their old facts.
    """
    facts = told_apart(user.facts, user.talk.remembered, user.talk.told) if user.talk.met else user.facts
    if user.talk.met:
        with contextlib.suppress(RavestateError):
            await _at_once(memory, user.disowned if user.talk.newcomer else user.restored)
    return _ask(NAME, "mistaken", Acquaintance(None, facts, Talk(told=frozenset(facts), spoke=now)), now)


# ------------------------------------------------------------------------------------ told


def _told(meaning: Meaning, user: Acquaintance, now: float, chance: random.Random, *, confirm: bool) -> Response:
    meaning = _without_idle(meaning, user)
    if not meaning.facts and not meaning.free and not meaning.gone:
        return Response(None, user)
    name = next((fact.values[0] for fact in meaning.facts if fact.topic == NAME and not fact.gone), None)
    if meaning.another:  # the previous user has left
        user = Acquaintance(None, {}, Talk(spoke=now, turns=1))
    before = user
    news = learn(user.facts, meaning.facts)
    gone = {one.key for one in meaning.gone}
    told = {key: one for key, one in user.told.items() if key not in gone} | {one.key: one for one in meaning.free}
    lost = [
        value for topic in news.changed for value in without(before.facts.get(topic, ()), news.facts.get(topic, ()))
    ]
    older = tuple(one for one in user.talk.said if one not in meaning.said and one.key not in gone)
    fixed = meaning.free if meaning.gone else ()
    said = (*_unrelated(older, lost), *fixed, *meaning.said)[-LONGEST:]  # "I live in Leeds" no longer holds
    talk = replace(_learning(user.talk, meaning, news, name), said=said)
    user = replace(user, facts=news.facts, talk=talk, told=told)
    if name is not None and user.who is None:
        user = replace(user, who=ontology.Node("Person", {NAME: name}))

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, name, memory, confirm=confirm)
        known, doubt = after.known, after.talk.doubt
        if doubt and not user.talk.doubt:
            intent = f"vouch_{doubt}" if TOPICS[doubt].asked else "vouch"
            noun = f"{doubt}'s name" if TOPICS[doubt].kind == "people" else doubt
            return _ask(CONFIRM, intent, after, now, topic=noun)
        if after.talk.wants_out and name is not None:
            return _wants_out(after, now)
        if not meaning.facts:
            fixed = meaning.kind == "corrected" and meaning.free
            return Response(say("corrected", known, fact=meaning.free[0].text) if fixed else None, after)
        if after.talk.trouble and not user.talk.warned:
            return Response(say("unsaved" if name is None else "unsaved_name", known), _with(after, warned=True))
        if name is not None:
            return _of_name(name, before, after, chance)
        return Response(_of_facts(meaning, news, before, after), after)

    return Response(None, user, write)


def _without_idle(meaning: Meaning, user: Acquaintance) -> Meaning:
    """Turn denials that change no fact into free statements, which belong to no topic: *you are not from Spain*."""
    idle = [fact for fact in meaning.facts if is_idle(fact, user.known)]
    values = [value.lower() for fact in idle for value in fact.values]
    denials = [
        one for one in meaning.said if one.verb.startswith("not ") and any(v in one.text.lower() for v in values)
    ]
    facts = tuple(fact for fact in meaning.facts if fact not in idle)
    return replace(meaning, facts=facts, free=(*meaning.free, *denials)) if idle else meaning


async def _written(
    user: Acquaintance, name: str | None, memory: ontology.Memory | None, *, confirm: bool = False
) -> Acquaintance:
    """Save the facts about the user, under their new name if they told one."""
    again = name is not None and not (user.name and same(user.name, name))

    def write(graph: ontology.Graph) -> Acquaintance:
        now = user.renamed(graph, name) if again and name else user
        return (now.doubted(graph) if confirm and name else now).noted(graph)

    try:
        if user.who is not None:  # without a name, only this conversation keeps the facts
            user = await _at_once(memory, write)
        return _with(user, trouble="")
    except RavestateError as error:
        user = _with(user, trouble=str(error))
    if again:
        # Memory failed, so the name is for this conversation only.
        return replace(user, who=ontology.Node("Person", {NAME: name}))
    with contextlib.suppress(RavestateError):  # reading may work where writing fails
        return await _at_once(memory, user.recall)
    return user


def _learning(talk: Talk, meaning: Meaning, news: News, name: str | None) -> Talk:
    topics = [*([NAME] if name is not None else []), *news.topics]
    if not topics:
        return talk  # a free statement
    main = NAME if name is not None else _main(meaning, news)
    latest = next((fact.values for fact in meaning.facts if fact.topic == main), ())
    question = talk.question.topic if talk.question else ""
    talk = talk.learning(topics, main, latest).keeping({topic: news.facts.get(topic, ()) for topic in news.topics})
    if question in TOPICS and set(TOPICS[question].besides) & set(topics):
        talk = replace(talk, question=None)
    return replace(talk, told=talk.told - {NAME})


def _of_name(name: str, before: Acquaintance, user: Acquaintance, chance: random.Random) -> Response:
    known = user.known
    if not before.talk.doubt and before.name is not None and same(before.name, name):
        return Response(stating("known_already", NAME, (name,), known), user)
    if any(user.talk.remembered.values()):
        topic = memorable(user.talk.remembered, chance)
        welcome = stating("welcome_back", topic, user.talk.remembered[topic], known)
        return Response(welcome, _with(user, reminded=True))
    if user.talk.returns and not user.talk.newcomer:  # memory knows the name, but no facts
        return Response(say("back", known), user)
    return Response(say("learned_name" if before.name is None else "renamed", known), user)


def _main(meaning: Meaning, news: News) -> str:
    """Return the topic to reply to: the topic that the agent asked about, or else the first new topic."""
    first = next((topic for topic in news.topics if topic in news.new), news.topics[0])
    return meaning.topic if meaning.topic in news.topics else first


def _of_facts(meaning: Meaning, news: News, before: Acquaintance, user: Acquaintance) -> Intent:
    topic = _main(meaning, news)
    fact = next(fact for fact in meaning.facts if fact.topic == topic)
    if fact.gone:
        struck = topic in news.changed and meaning.kind != "none"
        return say("struck" if struck else "none", user.known)
    if topic in news.changed and (meaning.kind == "corrected" or not TOPICS[topic].many):
        return stating("corrected", topic, user.facts[topic], user.known)
    if topic not in news.new and before.facts.get(topic):
        return stating("known_already", topic, fact.values, user.known)
    return learned(topic, fact.values, user.known)


# ------------------------------------------------------------------------------------ asked


def _asked(fact: Fact, user: Acquaintance, now: float) -> Response:
    known, topic = user.known, fact.topic
    if topic == EVERYTHING:
        if any(known.values()):
            return Response(say("recall_everything", known, facts=clauses(known)), _with(user, reminded=True))
        return Response(say("recall_nothing", known), user)
    if not topic:  # the question is about no topic
        return Response(say("recall_not", known), user)
    answers = {name: known[name] for name in (topic, *TOPICS[topic].besides) if known.get(name)}
    if topic == "home" and not answers and known.get("origin"):  # the nearest fact that the agent knows
        answers = {"origin": known["origin"]}
    if answers:
        right = all(any(_fits(asked, name, had) for name, had in answers.items()) for asked in fact.values)
        intent = "recall_name" if topic == NAME else "recall"
        if fact.values:
            intent = "confirm" if right else "deny"
        last = next(iter(answers))
        mentioned = replace(user, talk=user.talk.mentioning(last, answers[last]))
        return Response(say(intent, known, fact=clauses(answers)), mentioned)
    if topic in known and TOPICS[topic].kind not in ("place", "number"):  # everybody has a home, even if it has changed
        return Response(say("recall_none", known, noun=next(iter(TOPICS[topic].nouns), topic)), user)
    if topic in user.talk.closed and topic not in known:
        return Response(say("recall_declined", known), user)
    return _ask(topic, "recall_stranger" if topic == NAME else "recall_unknown", user, now)


def _asked_several(meaning: Meaning, user: Acquaintance, now: float) -> Response:
    """Answer the questions of an utterance together. If nothing is known, answer the first one alone."""
    topics = [fact.topic for fact in meaning.facts if is_topic(fact.topic)]
    topics += [other for topic in topics for other in TOPICS[topic].besides]
    known = {topic: user.known[topic] for topic in topics if user.known.get(topic)}
    told = [*([clauses(known)] if known else []), *(one.text for one in meaning.free)]
    if not told:
        return _asked(meaning.facts[0], user, now)
    return Response(say("recall", user.known, fact=joined(told)), user)


def _fits(asked: str, topic: str, values: tuple[str, ...]) -> bool:
    """Return whether a value is among the values of a topic. *Chess* stands for *playing chess*."""
    return alike(asked, values) if TOPICS[topic].kind == "activity" else among(asked, values)


# ------------------------------------------------------------------------------------ forgotten


def _struck(meaning: Meaning, user: Acquaintance) -> Response:
    """Forget some of the facts that the user told."""
    free = {one.key for one in meaning.free}
    told = {key: one for key, one in user.told.items() if key not in free}
    left, gone = dict(user.facts), dict[str, tuple[str, ...]]()
    for fact in meaning.facts:
        for topic in (fact.topic, *TOPICS[fact.topic].besides):
            before = left.pop(topic, ())
            kept = without(before, fact.values) if fact.values else ()
            if kept:
                left[topic] = kept
            if before != kept:
                gone[topic] = without(before, kept)
    values = [value.lower() for values in gone.values() for value in values]
    said = _unrelated((one for one in user.talk.said if one.key not in free), values)
    if not gone and not meaning.free:
        return Response(say("strike_unknown", user.known), user)
    words = (one for one in user.talk.words if not any(_has_words(one, v) for v in values))
    talk = replace(user.talk.striking(gone), said=said, words=tuple(words))
    user = replace(user, facts=left, talk=talk, told=told)

    async def write(memory: ontology.Memory | None) -> Response:
        after = await _written(user, None, memory)
        if memory is not None and not after.talk.trouble:
            await memory.purge()  # the user has asked for this, so the confirmation waits
        return Response(say("forget_failed" if after.talk.trouble else "strike", after.known), after)

    return Response(None, user, write)


def _unrelated(said: Iterable[Told], values: Sequence[str]) -> tuple[Told, ...]:
    """Leave out the statements about some values, and return the rest.

    A statement is about a value if it contains the value. If no statement contains the whole value, the value's last
    word counts: *chess* in *playing chess*.
    """
    said = tuple(said)
    for value in values:
        whole = [one for one in said if _has_words(one.text, value)]
        last = value.split()[-1] if value.strip() else ""
        about = whole or [one for one in said if _has_words(one.text, last)]
        said = tuple(one for one in said if one not in about)
    return said


def _has_words(text: str, words: str) -> bool:
    """Return whether a text contains some words, not merely parts of words: *modern art* has *art*, but *party* does not."""
    return (
        bool(words.strip()) and re.search(rf"(?<!\w){re.escape(words.strip())}(?!\w)", text, re.IGNORECASE) is not None
    )


def _wants_out(user: Acquaintance, now: float) -> Response:
    """Ask for a confirmation before forgetting everything. If the user is not known, ask who they are."""
    if user.who is None and not user.known and not user.told:
        return _ask(NAME, "forget_who", _with(user, wants_out=True), now)
    unknown = user.talk.wants_out and user.talk.newcomer and not user.facts and not user.told
    user = _with(user, wants_out=False)
    if unknown:
        return Response(say("forget_nobody", user.known), user)
    return _ask(FORGET, "forget_ask", user, now, what=_removed(user))


def _removed(user: Acquaintance) -> str:
    """Return a description, for the user, of the data that is removed when the agent forgets them."""
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

    try:
        found = user if user.who is None else await _at_once(memory, forget)
    except RavestateError as error:
        return Response(say("forget_failed", user.known), _with(_closing(user), trouble=str(error)))
    gone = Acquaintance(None, {}, Talk(tries=dict.fromkeys(TOPICS, TRIES)))
    return Response(say("forgotten", {}, what=_removed(found)), gone, forgotten=True)
