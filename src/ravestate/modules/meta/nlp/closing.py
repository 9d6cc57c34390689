"""Find the question or request at the end of an utterance: *do dogs dream?* in *haha, funny! do dogs dream?*."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from ravestate.language.contractions import word_set

from .tree import SUBJECTS, Tree, Word
from .verbs import VERBAL

SHORTEST = 3
"""The minimum number of words of a question that can be understood alone. *And you?* cannot."""
LONGEST = 5
"""The maximum number of words of a remark: a sentence that only reacts to the agent, such as *haha, funny!*."""
MOST = 8
"""If an utterance has more sentences than this, it has no closing question, unless it ends with *and you?*."""
LONG = 10
"""The maximum number of words in a statement before *and you?*."""

_POINTING = word_set(
    "it that this they them those these one ones he him his she her so there another more again too else"
)
"""Words that may refer to the sentences before."""
_RETURNED = re.compile(
    r"(?:[,.!]|\band\b)\s*(?:(?:and|but|so) )?(?:(?:what|how) about you|(?:do|are|have|can|would|will|did) you|(?<=and )you)"
    r"(?: too)?[?.! ]*$",
    re.IGNORECASE,
)
"""Words that turn the user's statement into a question to the agent: *and you?*."""
_HELPERS = {
    "am": "Are",
    "'m": "Are",
    "was": "Were",
    "ca": "Can",
    "wo": "Will",
    "'ve": "Have",
    "'d": "Would",
    "'ll": "Will",
    **{word: word.capitalize() for word in ("can", "could", "will", "would", "do", "did")},
}
"""The auxiliary after *I* → its form before *you*."""
_TURNED = {"my": "your", "me": "you", "myself": "yourself", "mine": "yours"}
_ENDS = (".", "!", "?", ",", ";", "and", "but")
_JUDGING = word_set("think say reckon mean")
"""Last words of questions about the sentences before: *what do you think?*."""
_FIRST = word_set("i me my mine we us our")
_WILLING = word_set("can could will would")
_SHOWING = word_set("tell sing give show explain say recite recommend suggest play")
"""Verbs of requests that the agent fulfils by speaking."""


@dataclass(frozen=True, slots=True)
class Closing:
    """A question or request at the end of an utterance. It can be understood without the sentences before it."""

    text: str
    asides: tuple[str, ...]
    """The sentences before the question or request."""
    remarks: bool
    """Whether all asides only react to the agent: *haha, funny!* does, but *my cat is ill* tells something new."""

    returned: bool = False
    """Whether `text` is the full question that the user shortened to *and you?*."""

    def outweighs(self, part: str) -> bool:
        """Return whether a part of the utterance is only in the asides. Then the agent should answer the closing question, not this part."""
        return part not in self.text and any(part in aside for aside in self.asides)


def closing_of(tree: Tree, sentences: Sequence[str]) -> Closing | None:
    """Return the question or request that ends an utterance, if it can stand alone; otherwise None."""
    if (returned := _returned(tree)) is not None:
        return returned
    if not 1 < len(sentences) <= MOST:
        return None
    *asides, last = sentences
    text = tree.text.lower()  # the capitals of the sentences may differ from those in the tree
    places = [0]
    for one in sentences:
        places.append(text.find(one.lower().rstrip(".?!"), places[-1]))
    places = places[1:]
    words = [word for word in tree.words if word.start >= places[-1] and word.pos != "PUNCT"]
    if min(places) < 0 or len(words) < SHORTEST:
        return None
    pointing = any(word.low in _POINTING and word.dep != "expl" for word in words[1:])
    if pointing or words[0].low in _POINTING - {"so"} or words[-1].low in _JUDGING:
        return None
    if not (_requests(words) or (last.endswith("?") and any(word.pos in VERBAL for word in words))):
        return None
    parts = pairwise(places)
    before = [[word for word in tree.words if start <= word.start < end] for start, end in parts]
    return Closing(last, tuple(asides), all(map(_is_remark, before)))


def _returned(tree: Tree) -> Closing | None:
    """Return the question that *and you?* or *do you?* stands for: *I love jazz, do you?* asks *do you love jazz?*."""
    found = _RETURNED.search(tree.text)
    if found is None:
        return None
    words = [word for word in tree.words if word.end <= found.start()]
    ends = [at for at, word in enumerate(words) if word.low in _ENDS]
    words = words[ends[-1] + 1 :] if ends else words
    subject = next((word for word in words if word.low == "i" and word.dep in SUBJECTS), None)
    if subject is None or len(words) > LONG:
        return None
    verb = tree.head(subject)
    helper = next((word for word in (*tree.children(verb, "aux"), verb) if word.low in _HELPERS), None)
    after = words[words.index(subject) + 1 :]
    if helper is None:
        opening = "Did" if verb.tag == "VBD" else "Do"
    else:
        opening = _HELPERS[helper.low]
    said = [
        verb.lemma if word == verb and helper is None else _TURNED.get(word.low, word.text)
        for word in after
        if word != helper and word.low not in ("n't", "not", ",", "too", "also", "really", "just")
    ]
    if not said:
        return None
    return Closing(
        f"{opening} you {' '.join(said)}?", (tree.text[: found.start()].strip(),), remarks=False, returned=True
    )


def _requests(words: Sequence[Word]) -> bool:
    """Return whether a sentence asks the agent to say or do something: *tell me a joke*, *can you sing something*."""
    low = [word.low for word in words]
    return low[0] in _SHOWING or (low[0] in _WILLING and low[1] == "you") or (low[0] == "please" and low[1] in _SHOWING)


def _is_remark(words: Sequence[Word]) -> bool:
    """Return whether a sentence only reacts: it is short, does not mention the user, and states nothing with a verb."""
    words = [word for word in words if word.pos != "PUNCT"]
    if len(words) > LONGEST or not _FIRST.isdisjoint(word.low for word in words):
        return False
    told = any(word.pos in ("NOUN", "PROPN") for word in words)
    subjects = [word for word in words if word.dep in SUBJECTS]
    verb = any(word.pos in VERBAL for word in words)
    return not verb or (not told and all(word.pos in ("PRON", "DET") for word in subjects))
