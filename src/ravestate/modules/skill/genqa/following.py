"""The answer to an utterance in a conversation.

An utterance may have several readings (complete questions for which it may stand). Then the best answer counts.
"""

from __future__ import annotations

import logging
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import datetime
from functools import cache

from ravestate.modules.meta.nlp.tree import Word

from .answering import NOT_STATED, Answer, Answerer
from .comparing import aged, begun, compared
from .lexicon import variants_of
from .names import Settings
from .question import Parse, Question, as_question, is_vague, parse
from .reckoning import Unanswerable, dates_in, focused, reckon, scaled
from .thread import Reading, Turn, readings, turn_of

_log = logging.getLogger("ravestate.genqa")
AGAIN = 5
"""The maximum number of words in an utterance that repeats a sum with another number: *and how about 300?*."""
MOST = 8
"""The maximum number of readings that are tried."""


def answer_in(
    answerer: Answerer, heard: Parse, thread: Sequence[Turn], settings: Settings, now: float
) -> tuple[Answer, Turn | None]:
    """Return the best supported answer to an utterance, and the turn (a question with its answer) to add to the thread.

    The turn is None if the agent may not say the answer.

    Args:
        answerer: The documents.
        heard: The utterance.
        thread: The latest questions, oldest first.
        settings: The settings of the module, with the confidence that an answer needs.
        now: Seconds since the context began.
    """
    if (reckoned := _reckoned(heard, thread, settings)) is not None:
        return reckoned, Turn(reckoned.question, reckoned.text.rpartition(" is ")[2], "", now)

    def ask(question: str) -> Answer:
        return answerer.answer(as_question(question))

    if (result := compared(heard, thread, ask) or aged(heard, thread, ask)) is not None:
        return result, turn_of(heard, result, now) if result.confidence >= settings.unsure else None
    tried = readings(heard, thread, answerer.titled)
    if not tried:
        return Answer(heard.text, reason="it refers to a question that nobody has asked"), None
    best: tuple[Answer, Parse] | None = None
    reason = ""
    for reading in tried[:MOST]:
        new = tuple(map(variants_of, as_question(reading.new).words)) if reading.new else ()
        if not answerer.states(new):  # the full search would find nothing either, but take longer
            reason = reason or NOT_STATED
            continue
        seen = heard if reading.text == heard.text else parse(reading.text)
        seen = seen if seen.is_finite else replace(seen, kind=heard.kind)  # "capital of Spain?" has no kind of its own
        question = as_question(seen)
        follows = seen is not heard or bool(reading.about)
        question = replace(question, doubtful=question.doubtful or heard.kind is None, follows=follows)
        question = replace(question, needs=question.needs + new)
        titles: tuple[str, ...] = ()
        if reading.about:
            question, titles = _about(answerer, question, reading, thread[-1].title)
        answer = _decided(answerer, question, settings, titles)
        reason = reason or answer.reason
        said = {turn.answer for turn in thread} if any(word.low == "else" for word in heard.asked) else ()
        if not answer.text or answer.text in said:
            continue
        answer = replace(answer, confidence=_shifted(answer.confidence, reading.prior))
        if best is None or answer.confidence > best[0].confidence:
            best = answer, seen
        if best[0].confidence >= settings.sure:  # stop here, because an older question may fit as well: *and in Mali?*
            break
    if best is None:
        return Answer(heard.text, reason=reason), None
    answer, seen = best
    return answer, turn_of(seen, answer, now) if answer.confidence >= settings.unsure else None


def _about(answerer: Answerer, question: Question, reading: Reading, latest: str) -> tuple[Question, tuple[str, ...]]:
    """Return a question about something in the thread, and the titles of the documents that may have the answer."""
    about = as_question(reading.about)
    title = answerer.titled(reading.about)
    given = question.given | {word.lower() for word in about.words}
    text = question.text if reading.about.lower() in question.text.lower() else f"{reading.about}: {question.text}"
    needs = question.needs
    if title or reading.about != reading.about.lower():
        needs += tuple(variants_of(word) for word in about.words)
    words = (*question.words, *(word for word in about.words if word not in question.words))
    declined = "" if question.declined == "it has no word to look for" else question.declined
    titles = tuple(dict.fromkeys(filter(None, (title, latest))))
    return replace(question, text=text, words=words, given=given, needs=needs, declined=declined), titles


def _reckoned(heard: Parse, thread: Sequence[Turn], settings: Settings) -> Answer | None:
    """Return the result of a calculation, or the reason why it is impossible.

    Return None if the utterance asks for no calculation, or if a library is missing.
    """
    told, now = [focused(turn.question, turn.answer) for turn in thread], datetime.now().astimezone()
    text = heard.text
    try:
        result = reckon(text, told, now.date(), settings.rates, now.time()) or scaled(heard.tree.text)
        if not result and thread and not thread[-1].title and not heard.is_finite:
            text = _again(text, thread[-1].question)
            result = reckon(text, told[:-1], now.date(), settings.rates) if text else ""
    except Unanswerable as error:
        result = str(error)
    except ImportError as error:
        _warn(str(error))
        return None
    return Answer(text, result, confidence=1.0) if result else None


@cache
def _warn(error: str) -> None:
    """Log once that a library is missing."""
    _log.warning("sums, units and dates are not worked out (%s): pip install 'ravestate[genqa]'", error)


def _again(text: str, before: str) -> str:
    """Return the sum `before` with the number or date of `text` (*and of 200?*); empty if `text` has none."""
    dates, old = dates_in(text), dates_in(before)
    if dates and old:
        return before.lower().replace(old[-1].shown, dates[-1].shown)
    numbers = re.findall(r"\d[\d.,]*", text) if len(text.split()) <= AGAIN else []
    return re.sub(r"\d[\d.,]*(?!.*\d)", numbers[0], before) if len(numbers) == 1 else ""


def _decided(answerer: Answerer, question: Question, settings: Settings, titles: Sequence[str]) -> Answer:
    """Return the documents' answer to `other_wording` of the question, if that answer is sure.

    Otherwise, return the answer to the question itself. Its confidence is 0 if the question is doubtful and the answer is
    not sure. A vague question gets no sure answer.
    """
    if not question.declined and (other := other_wording(question.text)):
        decided = answerer.answer(other, titles)
        if decided.confidence >= settings.sure:
            return decided
    answer = answerer.answer(question, titles)
    thing = re.match(r"how old (?:is|are|was) (.+)\?", question.text, re.IGNORECASE)
    if thing and answer.confidence < settings.unsure and not question.declined:
        answer = begun(thing[1], lambda text: answerer.answer(text, titles)) or answer
    if question.doubtful and answer.confidence < settings.sure:
        return replace(answer, confidence=0.0)
    if is_vague(question) and answer.confidence >= settings.sure:
        return replace(answer, confidence=(settings.sure + settings.unsure) / 2)
    return answer


def other_wording(question: str) -> str:
    """Return a question that documents answer better, and whose answer also answers `question`; empty if there is none.

    Example:
        >>> other_wording("How far is the moon?")
        'How far away is the moon?'
        >>> other_wording("Is Paris the capital of Germany?")
        'what is the capital of Germany?'
    """
    if far := re.match(r"(?P<asks>how far) (?P<rest>(?:is|are) [^?]+)", question, re.IGNORECASE):
        return f"{far['asks']} away {far['rest']}?"
    tree = parse(question).tree
    words = [word for word in tree.words if word.pos != "PUNCT"]
    if not words or words[0].lemma != "be":
        return ""

    def text(some: Sequence[Word]) -> str:
        return tree.phrase(some)

    place = next((word for word in words if word.low == "in"), None)
    for word in words[2:]:  # the words before *the ... of* are the subject
        if word.low == "the" and any(other.low == "of" for other in words[word.index :]):
            return f"what is {text(words[word.index :])}?"
    if place is not None and 1 < place.index < len(words) - 1:
        subject = [word for word in words[1 : place.index] if word.low not in ("situated", "located")]
        return f"where is {text(subject)}?"
    return ""


def _shifted(confidence: float, prior: float) -> float:
    """Return a probability, after its log odds have grown by `prior`."""
    if not 0.0 < confidence < 1.0:
        return confidence
    return 1 / (1 + math.exp(-(math.log(confidence / (1 - confidence)) + prior)))
