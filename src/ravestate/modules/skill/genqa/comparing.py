"""Comparisons of two things by the numbers and dates of their documents: *which is longer, the Nile or the Rhine?*."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from ravestate.modules.meta.nlp import QuestionWord
from ravestate.modules.meta.nlp.tree import Word

from .answering import Answer
from .lexicon import variants_of
from .question import Parse
from .reckoning import dates_in, difference, measured, together, vocabulary
from .thread import Turn, phrase_of, referents, refers

_BOTH = ("difference", "together", "total", "altogether")
"""Words that ask for both numbers of the thread."""


@dataclass(frozen=True, slots=True)
class _Side:
    """One of the two things, with the answer that measures it."""

    name: str
    answer: Answer
    value: float


def compared(heard: Parse, thread: Sequence[Turn], ask: Callable[[str], Answer]) -> Answer | None:
    """Return the result of a comparison; None if the utterance is none, or if the documents lack a number.

    Args:
        heard: The utterance.
        thread: The latest questions, oldest first: *which one is bigger?*.
        ask: A function that asks the documents a question.
    """
    table: dict[str, tuple[str, int]] = vocabulary()["comparatives"]
    word = next((word for word in heard.asked if word.low in (*table, *_BOTH)), None)
    if (
        word is None
        or heard.kind is None
        or (word.low in _BOTH and any(w.pos in ("PROPN", "NUM") for w in heard.asked))
    ):
        return None
    base, direction = table.get(word.low, ("many", 1))
    names, turns = _sides(heard, thread)
    if len(names) != 2:
        return None
    noun = next((other.text for other in heard.asked if other.index == word.index + 1 and other.pos == "NOUN"), "")
    answers = [_told(turn, base) for turn in turns]
    if not turns or None in answers:
        answers = [_asked(name, base, noun, ask) for name in names]
    first, other = answers
    if first is None or other is None:
        return None
    values = _values(first.text, other.text, base)
    if values is None:
        return None
    sides = [_Side(n, a, v) for n, a, v in zip(names, (first, other), values, strict=True)]
    more, less = sorted(sides, key=lambda side: -direction * side.value)
    verdict = f"{more.name[:1].upper()}{more.name[1:]}."
    if more.value == less.value:
        verdict = "Neither."
    elif word.low in _BOTH:
        verdict = together(first.text, other.text) if word.low != "difference" else difference(first.text, other.text)
    elif any(w.low == "much" or w.low == "many" for w in heard.asked) and not noun:
        verdict = difference(first.text, other.text, dates=base in ("old", "early", "late"))
    elif heard.kind is QuestionWord.YES_NO and not any(w.low == "or" for w in heard.asked):
        verdict = "Yes." if more is sides[0] else "No."
    sources = " and ".join(dict.fromkeys(side.answer.source for side in sides if side.answer.source))
    text = " ".join(dict.fromkeys((verdict, *(side.answer.text for side in sides))))
    confidence = min(side.answer.confidence for side in sides)
    return Answer(heard.text, text, sources, more.answer.title, confidence)


def aged(heard: Parse, thread: Sequence[Turn], ask: Callable[[str], Answer]) -> Answer | None:
    """Return how old somebody was when they died, or at another event; None if the utterance does not ask for it."""
    words = [word for word in heard.asked if word.pos != "PUNCT"]
    low = [word.low for word in words]
    when = low.index("when", 1) if "when" in low[1:] else len(words)
    lived = "long" in low and any(word.lemma == "live" for word in words)
    become = any(word.lemma in ("get", "become", "live") for word in words)
    if low[:1] not in (["how"], ["so"]) or not (lived or ("old" in low and (when < len(words) or become))):
        return None
    name = next((n for word in words[:when] if (n := _name(heard, word, thread))), "")
    event = [name if word.low in ("he", "she", "they", "it") else word.text for word in words[when:]] or [
        "did",
        name,
        "die",
    ]
    born, then = ask(f"when was {name} born?"), ask(f"when {' '.join(event).removeprefix('when ')}?")
    if not name or not dates_in(born.text) or not dates_in(then.text):
        return None
    verdict = difference(born.text, then.text, dates=True)
    sources = " and ".join(dict.fromkeys((born.source, then.source)))
    text = " ".join(dict.fromkeys((verdict, born.text, then.text)))
    return Answer(heard.text, text, sources, born.title, min(born.confidence, then.confidence))


def _sides(heard: Parse, thread: Sequence[Turn]) -> tuple[list[str], list[Turn]]:
    """Return the two things to compare, and their turns if they come from the thread."""
    between = next((word for word in heard.asked if word.low in ("or", "than")), None)
    if between is not None:
        right = next((n for w in _after(heard, between) if (n := _name(heard, w, thread))), "")
        left = next((n for w in reversed(_before(heard, between)) if (n := _name(heard, w, thread)) and n != right), "")
        if between.low == "than" and not left and thread:
            left = thread[-1].subject
        return [name for name in (left, right) if name], []
    own = [name for name in (_name(heard, word, thread) for word in heard.asked if word.low not in _BOTH) if name]
    if own and heard.kind is QuestionWord.YES_NO and thread:  # "is the Queen's Bridge longer?"
        return [own[0], thread[-1].subject], []
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


def _after(heard: Parse, word: Word) -> list[Word]:
    return [other for other in heard.asked if other.index > word.index]


def _before(heard: Parse, word: Word) -> list[Word]:
    return [other for other in heard.asked if other.index < word.index]


def _name(heard: Parse, word: Word, thread: Sequence[Turn]) -> str:
    if refers(word, heard.asked):
        return next((thing.text for thing in referents(word, thread)), "")
    if (
        word.pos not in ("NOUN", "PROPN", "X")
        or word.dep in ("compound", "nmod", "amod")
        or word.low in ("one", "ones")
    ):
        return ""
    own = phrase_of(heard.tree, word)
    return "" if any(w.tag in ("WDT", "WP") or w.low == "how" for w in own) else heard.tree.phrase(own)


def _told(turn: Turn, base: str) -> Answer | None:
    """Return the answer of a turn if it measures what is compared."""
    words = set(turn.question.lower().split())
    if (
        base not in ("big", "large", "many", "much")
        and words.isdisjoint(variants_of(base))
        and not (base == "old" and "when" in words)
    ):
        return None
    return Answer(turn.question, turn.answer, turn.source, turn.title, turn.confidence)


def _asked(name: str, base: str, noun: str, ask: Callable[[str], Answer]) -> Answer | None:
    questions = [f"how {base} is {name}?"]
    if base == "many" or noun:
        questions = [f"how many {noun or 'people'} does {name} have?"]
    elif base in ("old", "early", "late"):
        questions += [f"when was {name} {done}?" for done in ("born", "founded", "built")]
    answers = [ask(question) for question in questions]
    right = [
        a for a in answers if a.text and (dates_in(a.text) if base in ("old", "early", "late") else measured(a.text))
    ]
    return max(right, key=lambda answer: answer.confidence, default=None)


def _values(one: str, other: str, base: str) -> tuple[float, float] | None:
    """Return both values in the same unit; None if they cannot be compared."""
    if base in ("old", "early", "late"):
        first, second = dates_in(one), dates_in(other)
        if not first or not second:
            return None
        if base == "old":  # the earlier, the older
            return -float(first[0].day.toordinal()), -float(second[0].day.toordinal())
        return float(first[0].day.toordinal()), float(second[0].day.toordinal())
    for left in measured(one):
        for right in measured(other):
            if (values := left.beside(right)) is not None:
                return values
    return None
