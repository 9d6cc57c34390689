"""The entries of the bank that suit an utterance: its words, its mood, its kind of question, and its persons."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from ravestate.language.normal import plain
from ravestate.language.shape import shape
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.tree import SUBJECTS

from .asked import about
from .asking import kind_of
from .bank import CLOSE, Found
from .echo import words_of
from .grave import is_grave
from .material import Material
from .moment import Moment
from .state import Being, State
from .tones import DARK, tone_of

BRIEFLY = 5
"""The maximum number of words of a question that names nothing."""
ALIKE = 0.47
"""The minimum probability of suiting at which an entry of the bank is used. If no entry reaches it, a reply that takes up
the user's words is better."""
KNOWN = 0.57
"""The minimum probability of suiting at which an entry of the bank takes precedence over other modules. It also
takes precedence over the kinds of reply that surely suit."""
WHOLE = 30
"""The maximum number of words of an utterance that is compared with the bank as a whole."""
LONG, LONGER = 10, 0.75
"""For utterances of at least `LONG` words, the probability is multiplied by `LONGER`, because they often say more than an
entry answers. In 170 judgements of such utterances, half of the replies that were called probable were bad."""
CROSSED = 0.5
"""The share of its probability that an entry loses if its mood, its kind of question or its persons do not suit."""
CHEERFUL = 0.4
"""The share of its probability that a glad entry keeps in a sad, angry or tired conversation."""
DARKLY = 0.5
"""The minimum probability of suiting at which a sad entry of the bank marks an utterance as dark (sad or grave)."""
LEADING = 0.1
"""The bonus of an entry with follow-ups: after its reply, the agent understands the user's next words better."""
_NODS = frozenset(("acknowledgement", "greeting"))
"""Acts that say little beside another sentence."""
_THEY = frozenset(("he", "she", "they", "it"))
BESIDE = 4
"""If an utterance has longer sentences, those with fewer words than this, such as *ok* or *well*, are not compared."""


def near_in(
    phrases: Material,
    seen: Analysis,
    asking: str,
    state: State,
    feeling: Moment | None,
    *,
    being: Being | None = None,
    roughly: bool = False,
) -> list[Found]:
    """Return the entries of the bank that resemble an utterance or one of its sentences, the most suitable first.

    If the user asks something, only the question counts. An entry of the opposite mood is less probable. A pronoun may
    also stand for `being`, which was mentioned before. With `roughly`, the probabilities are estimated without the
    cross-encoder.
    """
    sentences = seen.sentences[:6]
    longer = [sentence for sentence in sentences if len(sentence.split()) >= BESIDE]
    nods = {act.text for act in seen.acts.values() if act.name in _NODS}  # "fine. sorry for shouting"
    rest = [sentence for sentence in sentences if sentence not in nods]
    texts = [asking] if asking else list(longer or rest or sentences)
    if len(seen.tree.words) <= WHOLE and not (asking and len(seen.sentences) > 1):  # "haha! do dogs dream" asks
        texts.append(seen.text)
    own = tone_of(seen.text)
    if state.tone == "sad" and own in ("glad", "funny") and (feeling is None or feeling.tone != "glad"):
        own = ""  # a widow's memory: "we were married for forty years"
    mood = own if own else state.tone if state.tone in DARK or feeling is None else feeling.tone
    bare = asking and not about(phrases, seen.tree, words_of(seen.tree, asking))  # "how do I start?"
    kind, persons = kind_of(asking) if asking else "", persons_in(seen.normal.text)
    grave = is_grave(seen.normal.text)
    ranked: list[Found] = []
    found = phrases.bank.similar(texts, seen.text, roughly=roughly)
    if being is not None and (meant := spelled_out(seen, being)):  # "he is in hospital" after "my dad"
        before = {*phrases.bank.thread(state.moment or state.thread), *(one.moment.name for one in found)}
        found += [one for one in phrases.bank.similar([meant], meant, roughly=roughly) if one.moment.name not in before]
    for one in found:
        tone = one.moment.tone
        cheerful = tone == "glad" and mood in DARK
        crossed = tone in DARK and mood == "glad"
        crossed = crossed or (grave and tone not in DARK and one.score < CLOSE)
        examples = one.moment.examples
        crossed = crossed or (one.fit < 1 and kind != "" and kind not in map(kind_of, examples))
        crossed = crossed or bool(bare and one.score < CLOSE and len(asking.split()) <= BRIEFLY)
        crossed = crossed or (persons == (False, True) and all(persons_in(text) == (True, False) for text in examples))
        share = LONGER if len(seen.tree.words) >= LONG and one.score < CLOSE else 1.0
        share *= CHEERFUL if cheerful else 1.0
        ranked.append(replace(one, fit=one.fit * share * (1 - CROSSED * crossed)))
    return sorted(ranked, key=lambda one: -one.fit - LEADING * bool(one.moment.follows))


def spelled_out(seen: Analysis, being: Being) -> str:
    """Return an utterance with a being in place of its first pronoun: *my dad is in hospital* for *he is in hospital*.

    Empty if no pronoun is the subject.
    """
    own = re.sub(r"\byour\b", "my", being.text)
    for word in seen.tree.words:
        if word.low in _THEY and word.dep in SUBJECTS:
            text = seen.tree.text
            return f"{text[: word.start]}{own}{text[word.end :]}"
    return ""


def is_dark(seen: Analysis, near: Sequence[Found]) -> bool:
    """Return whether an utterance is grave or sad, by its words, its tone, or a sad entry of the bank that it resembles."""
    return (
        is_grave(seen.normal.text)
        or tone_of(seen.text) == "sad"
        or any(one.moment.tone == "sad" and one.fit >= DARKLY for one in near)
    )


def persons_in(text: str) -> tuple[bool, bool]:
    """Return whether a text mentions the user, and whether it mentions others."""
    return shape(plain(text))[1:3]
