"""Find the follow-up that answers what the user says after a reply of the bank.

An entry of the bank (bank.py) has example utterances of the user, and replies to them. A *follow-up* is an entry for
what the user may say directly after such a reply. So after a reply, the user's next utterance is compared with the
follow-ups of the reply's entry.

The entry narrows what the utterance can mean, so a lower similarity suffices than in a search of the whole bank. Any form
of *yes* or *no* matches the follow-up that lists this answer among its utterances.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from ravestate.language.contractions import word_set
from ravestate.language.normal import plain
from ravestate.modules.meta.nlp.analysis import Analysis

from .asking import SHORT
from .bank import REST, Bank, Found
from .moment import Moment
from .state import State
from .tones import DARK

LEAST, CLEAR, SURE, EQUAL = 0.68, 0.75, 0.8, 0.93
"""The minimum scores of a follow-up: to answer at all, to beat a similar entry of the bank, to beat a farewell, and to
answer a sad utterance lightly. The limits come from 168 written answers to 34 entries: 110 scored `LEAST` or more, and 5 of
these did not suit."""
SECOND = 0.15
"""The weight of a follow-up's second most similar utterance. A single utterance may be similar by chance."""
EARLIER = 0.1
"""The share of its similarity that a follow-up loses if it belongs to an earlier reply than the last."""
NEARER = 0.1
"""An entry of the bank beats a doubtful follow-up only if its similarity is greater by this much."""
DENIED = 0.12
"""The share of its similarity that a follow-up loses if only one of the two sentences denies something."""
OTHER_UNIT = 0.08
"""The share that it loses if the utterance names another unit of time: *ten weeks* is not *ten years*."""
ANSWERED = (0.9, 0.76, 0.7)
"""The scores of *yes*, *no* and *I don't know*, by the length of the utterance: up to `BRIEF` words; up to `LONGER` words;
more words, or a weak answer such as *nothing really*."""
BRIEF, LONGER = 3, 8
RELATED, ANSWERING = 0.64, 0.59
"""The minimum similarity of a statement that keeps the subject; the same for a statement after a question of the agent.
46 % and 75 % of written follow-ups with five words or more reach these limits; 12 % and 35 % of other utterances do."""
KINDS = {"yes": "yes", "no": "no", "i do not know": "unsure", "do not know": "unsure", "maybe": "unsure"}
"""An utterance of a follow-up, in its plain form → the kind of answer for which it stands."""
_DENYING = word_set("not no never nobody nothing none neither nowhere without nope nah")
_UNITS = re.compile(r"\b(second|minute|hour|day|week|month|year)s?\b")
_NAMING = re.compile(r"\b(?:call me|my name|forget)\b", re.IGNORECASE)
"""Phrases to which other modules reply."""
_LEAD = re.compile(
    r"^\W*(?:(?:yes|yeah|yep|no|nope|nah|well|oh|ah|hm+|um+|so|and|but|because|cause|cos|maybe|probably|i think|i guess)\b\W*)+",
    re.IGNORECASE,
)
"""Words before an answer that add nothing to it: *well, because...*."""


def follow_up_in(
    bank: Bank, state: State, seen: Analysis, asking: str, rival: Found | None = None, *, dark: bool = False
) -> Moment | None:
    """Return the follow-up that answers an utterance; None if none does.

    Args:
        bank: The bank.
        state: The state of the conversation.
        seen: The analysis of the utterance.
        asking: The sentence of the utterance that asks something; empty if none does. If there is one, only this sentence
            counts.
        rival: The most suitable entry of the bank. It beats a follow-up that is doubtful and less similar. If the
            utterance is short, its meaning depends on the agent's question, so only an entry with exactly these words beats a
            follow-up.
        dark: Whether the utterance is sad or grave. If so, a follow-up counts only if its tone is dark, or if one of its
            examples nearly equals the utterance (`EQUAL`).
    """
    best, score = _nearest(bank, state, seen, asking)
    if best is None or score < LEAST or (score < SURE and "farewell" in seen.acts):
        return None
    if dark and best.tone not in DARK and score < EQUAL:
        return None
    short = len(seen.text.split()) <= SHORT and not (rival is not None and rival.fit == 1)
    return None if score < CLEAR and rival is not None and not short and rival.score >= score + NEARER else best


def is_answer(bank: Bank, state: State, seen: Analysis, *, dark: bool) -> bool:
    """Return whether an utterance clearly is a follow-up that no other module answers.

    Other modules answer questions, orders to stop, and names.
    """
    if seen.question is not None or "stop" in seen.acts or _NAMING.search(seen.text):
        return False
    if any(entity.label == "PERSON" for entity in seen.entities):
        return False
    clear = _nearest(bank, state, seen, "")[1] >= CLEAR
    return clear and follow_up_in(bank, state, seen, "", dark=dark) is not None


def _nearest(bank: Bank, state: State, seen: Analysis, asking: str) -> tuple[Moment | None, float]:
    """Return the follow-up that an utterance resembles most, and its score."""
    texts = [asking] if asking else _parts(seen)
    last = bank.follow_ups(state.moment)
    names = [name for name in bank.thread(state.thread) if name != state.moment and not state.tone]
    earlier = [one for name in names for one in bank.follow_ups(name)]
    scores = [(one, _score(bank, one, texts, "" if asking else _kind(seen), seen)) for one in last]
    scores += [(one, (1 - EARLIER) * _score(bank, one, texts, None, seen)) for one in earlier]
    return max(scores, key=lambda one: one[1], default=(None, 0.0))


def rest_of(bank: Bank, state: State, seen: Analysis) -> Moment | None:
    """Return the last entry's follow-up for statements that fit no other follow-up.

    Return None if there is none, or if the user has changed the subject.

    A short utterance keeps the subject. A longer one must resemble the entry or one of its follow-ups.
    """
    follows = bank.follow_ups(state.moment)
    rest = next((one for one in follows if REST in one.examples), None)
    if rest is None or len(seen.text.split()) <= SHORT:
        return rest
    near = (score for one in (bank.named[state.moment], *follows) for _, score in bank.likeness([seen.text], one))
    asked = bool(state.said) and state.said[-1].endswith("?")
    return rest if max(near, default=0.0) >= (ANSWERING if asked else RELATED) else None


def _score(bank: Bank, follow_up: Moment, texts: Sequence[str], kind: str | None, seen: Analysis) -> float:
    """Return the score of a follow-up. `kind`: the utterance's kind of answer; None if it cannot be an answer."""
    whole = plain(" ".join(texts))
    denies, units = _denies(whole), set(_UNITS.findall(whole))
    found = [
        score * (1 - DENIED * (_denies(text) != denies)) * (1 - OTHER_UNIT * (not units <= {*_UNITS.findall(text)}))
        for text, score in bank.likeness(texts, follow_up)
        if kind is not None or plain(text) not in KINDS
    ]
    near = sorted(found, reverse=True)[:2]
    score = near[0] - SECOND * (near[0] - near[-1]) if near else 0.0
    if kind and kind in {KINDS.get(plain(text)) for text in follow_up.examples}:
        size = sum(word.pos != "PUNCT" for word in seen.tree.words)
        weak = max(seen.yesno.yes or 0, seen.yesno.no or 0) == 1  # "nothing really"
        return max(score, ANSWERED[2 if weak or size > LONGER else 1 if size > BRIEF else 0])
    return score


def _kind(seen: Analysis) -> str:
    """Return the utterance's kind of answer (``yes``, ``no``, ``unsure``); empty if it is no answer."""
    answer = seen.yesno
    return "yes" if answer.yes else "no" if answer.no else "unsure" if answer.unsure else ""


def _parts(seen: Analysis) -> list[str]:
    """Return the first four sentences of an utterance, the whole utterance, and each of these without its lead."""
    texts = [*seen.sentences[:4], seen.text]
    return list(dict.fromkeys([*texts, *filter(None, (_LEAD.sub("", text) for text in texts))]))


def _denies(text: str) -> bool:
    return not _DENYING.isdisjoint(plain(text).split())
