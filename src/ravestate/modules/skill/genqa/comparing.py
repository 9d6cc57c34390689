"""Comparisons of two things by numbers and dates from the documents, and the age of a person at an event."""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.tree import Word

from .answering import Answer
from .lexicon import lexicon, variants_of
from .question import Parse
from .reckoning import apart, both, dates_in, focused, measured, of_both
from .thread import Turn, is_noun, phrase_of, referents, refers

_BOTH = ("difference", "together", "total", "altogether")
"""Words that ask for a result from two earlier numbers: *what is the difference?*."""
_TIMED = ("old", "early", "late")
"""Adjectives whose measure is a date."""


def compared(heard: Parse, thread: Sequence[Turn], ask: Callable[[str], Answer]) -> Answer | None:
    """Return the result of a comparison; None if the utterance compares nothing, or if the documents lack comparable values.

    Args:
        heard: The utterance.
        thread: The latest questions, oldest first; *which one is bigger?* refers to them.
        ask: A function that asks the documents a question.
    """
    table: dict[str, tuple[str, int]] = lexicon("reckoning.yaml")["comparatives"]
    word = next((word for word in heard.asked if word.low in (*table, *_BOTH)), None)
    if word is None or heard.kind is None:
        return None
    if word.low in _BOTH and any(other.pos in ("PROPN", "NUM") for other in heard.asked):
        return None
    base, direction = table.get(word.low, ("many", 1))
    names, turns = _sides(heard, thread)
    if len(names) != 2:
        return None
    noun = next((other.text for other in heard.asked if other.index == word.index + 1 and other.pos == "NOUN"), "")
    found = [_told(turn, base) for turn in turns]
    if not turns or None in found:
        found = [_asked(name, base, noun, ask) for name in names]
    if found[0] is None or found[1] is None:
        return None
    one, other = found[0], found[1]
    left, right = (focused(f"how {base}", answer.text) for answer in (one, other))
    values = _values(left, right, base)
    if values is None:
        return None
    wins = direction * values[0] > direction * values[1]
    low = {each.low for each in heard.asked}
    verdict = "Neither." if values[0] == values[1] else f"{names[0] if wins else names[1]}."
    if word.low in _BOTH:
        verdict = of_both(left, right, _distance if word.low == "difference" else operator.add)
    elif low & {"much", "many"} and not noun:
        verdict = _years(one, other) if base in _TIMED else of_both(left, right, _distance)
    elif heard.kind is QuestionWord.YES_NO and "or" not in low:
        verdict = "Yes." if wins else "No."
    return _both(heard, verdict[:1].upper() + verdict[1:], one, other)


def aged(heard: Parse, thread: Sequence[Turn], ask: Callable[[str], Answer]) -> Answer | None:
    """Return a person's age at their death or at another event; None if no age is asked for, or a date is missing."""
    words = [word for word in heard.asked if word.pos != "PUNCT"]
    low = [word.low for word in words]
    when = low.index("when", 1) if "when" in low[1:] else len(words)
    lived = any(word.lemma == "live" for word in words) and "long" in low
    died = "old" in low and ("was" in low or any(word.lemma in ("get", "become", "live") for word in words))
    if heard.kind is None or "how" not in low[:2] or not (lived or died or ("old" in low and when < len(words))):
        return None
    name = next((found for word in words[:when] if (found := _name(heard, word, thread))), "")
    if not name:
        return None
    event = [name if word.low in ("he", "she", "they", "it") else word.text for word in words[when + 1 :]]
    born, then = ask(f"when was {name} born?"), ask(f"when {' '.join(event) or f'did {name} die'}?")
    if not dates_in(born.text) or not dates_in(then.text):
        return None
    return _both(heard, _years(born, then), born, then)


def _both(heard: Parse, verdict: str, one: Answer, other: Answer) -> Answer:
    """Return a verdict with the two answers that support it."""
    text = " ".join(dict.fromkeys((verdict, one.text, other.text)))
    sources = " and ".join(dict.fromkeys(filter(None, (one.source, other.source))))
    return Answer(heard.text, text, sources, one.title, min(one.confidence, other.confidence))


def _years(one: Answer, other: Answer) -> str:
    return apart(dates_in(one.text)[0], dates_in(other.text)[-1])


def _distance(one: float, other: float) -> float:
    return round(abs(one - other), 6)


def _sides(heard: Parse, thread: Sequence[Turn]) -> tuple[list[str], list[Turn]]:
    """Return the two things to compare, and their turns (earlier questions with answers) if they come from the thread."""
    named = [(word, name) for word in heard.asked if word.low not in _BOTH and (name := _name(heard, word, thread))]
    between = next((word.index for word in heard.asked if word.low in ("or", "than")), None)
    if between is not None:
        right = next((name for word, name in named if word.index > between), "")
        left = next((name for word, name in reversed(named) if word.index < between and name != right), "")
        left = left or (thread[-1].subject if thread else "")
        return [name for name in (left, right) if name], []
    if named and heard.kind is QuestionWord.YES_NO and thread:  # "is the Queen's Bridge longer?"
        return [named[0][1], thread[-1].subject], []
    if any(word.pos == "PROPN" for word in heard.asked):
        return [], []
    if thread and len(thread[-1].items) == 2:
        return list(thread[-1].items), []
    latest: dict[str, Turn] = {}
    for turn in reversed(thread):
        if turn.subject:
            latest.setdefault(turn.subject.lower(), turn)
    turns = list(latest.values())[:2][::-1]
    return [turn.subject for turn in turns], turns


def _name(heard: Parse, word: Word, thread: Sequence[Turn]) -> str:
    """Return the name of the thing that a noun or a pronoun stands for. For any other word, return an empty text."""
    if refers(word, heard.asked):
        return next((thing.text for thing in referents(word, thread)), "")
    if not is_noun(word) or word.low in ("one", "ones"):
        return ""
    own = phrase_of(heard.tree, word)
    return "" if any(other.tag in ("WDT", "WP", "WRB") for other in own) else heard.tree.phrase(own)


def _told(turn: Turn, base: str) -> Answer | None:
    """Return a turn's answer if its question may ask for the measure of the comparison; None if not."""
    words = set(turn.question.lower().split())
    fits = base in ("big", "large", "many", "much") or (base == "old" and "when" in words)
    if not fits and words.isdisjoint(variants_of(base)):
        return None
    return Answer(turn.question, turn.answer, turn.source, turn.title, turn.confidence)


def _asked(name: str, base: str, noun: str, ask: Callable[[str], Answer]) -> Answer | None:
    """Ask the documents, and return the best answer with a measure of `name`; None if there is none."""
    counts = base == "many" or noun
    if base in _TIMED and not counts and (found := begun(name, ask)) is not None:
        return found
    answer = ask(f"how many {noun or 'people'} does {name} have?" if counts else f"how {base} is {name}?")
    return answer if (dates_in if base in _TIMED else measured)(answer.text) else None


def begun(name: str, ask: Callable[[str], Answer]) -> Answer | None:
    """Return the answer with the date when `name` was born, founded or built; None if no passage has it."""
    answers = [ask(f"when was {name} {done}?") for done in ("born", "founded", "built")]
    bare = name.lower().removeprefix("the ")
    starts = (bare, "she ", "he ", "it ")
    own = [a for a in answers if dates_in(a.text) and a.text.lower().removeprefix("the ").startswith(starts)]
    return max(own, key=lambda answer: answer.confidence, default=None)


def _values(one: str, other: str, base: str) -> tuple[float, float] | None:
    """Return both values in the same unit; None if they cannot be compared."""
    if base in _TIMED:
        sign = -1.0 if base == "old" else 1.0  # the thing with the earlier date is older
        days = [sign * dates[0].day.toordinal() for dates in (dates_in(one), dates_in(other)) if dates]
        return (days[0], days[1]) if len(days) == 2 else None
    found = both(one, other)
    return None if found is None else found[:2]
