"""Split an utterance into normalised sentences and clauses, and find negations."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

LONGEST = 1000
"""The characters of an utterance that count."""

SPELLINGS = (
    (r"[’‘`´]", "'"),
    (r"([a-z])\1{2,}", r"\1\1"),  # sooo: soo
    (r"\bsoo\b", "so"),
    (r"\bcan't|\bcannot|\bcant\b", "can not"),
    (r"\bwon't|\bwont\b", "will not"),
    (r"\bain't", "is not"),
    (r"n't\b", " not"),
    (r"\b(do|did|does|is|was|are)nt\b", r"\1 not"),
    (r"\bi'?m\b", "i am"),
    (r"\b(yo)?u'?re\b", "you are"),
    (r"'re\b", " are"),
    (r"'ve\b", " have"),
    (r"'ll\b", " will"),
    (r"'d\b", " would"),
    (r"\b(it|that|this|there|what|who|here|how|he|she|today|everything)'s\b", r"\1 is"),
    (r"\bthats\b", "that is"),
    (r"\blet'?s\b", "let us"),
    (r"\bu\b|\bya\b", "you"),
    (r"\bur\b", "your"),
    (r"\bluv\b", "love"),
    (r"\bnot (?:only|just|merely) ", ""),
    (r"\bi (?:must|have to) (?:say|admit|confess)(?: that)? ", ""),
    (r"\bgonna\b", "going to"),
    (r"\bwanna\b", "want to"),
    (r"\bomg\b", "oh my god"),
)
_SPELLINGS = [(re.compile(pattern), instead) for pattern, instead in SPELLINGS]

_SENTENCE = re.compile(r"[^.!?\n…]+[.!?…]*|[.!?…]+")
_CLAUSE_END = re.compile(r"[,;:()\"“”—–]|\s-\s|\b(?:but|although|though|however|because|while|yet)\b")
_QUESTION = re.compile(
    r"^(?:(?:and|so|well|but|then|hey|ok|okay|oh) )*(?:"
    r"(?:do|does|did|are|is|am|was|were|will|would|should|shall|may|can|could|have|has) "
    r"(?:i|you|he|she|it|we|they|the|my|your|this|that|there|any\w+|some\w+)\b|"
    r"(?:what|who|where|when|why|which|whose|how)(?: \w+)? (?:is|are|was|were|do|does|did|can|could|will|would|should|has)\b|"
    r"(?:who|where|when|why|which|whose)\b)"
)

_DENIALS = re.compile(
    r"\b(?:not|never|no|nobody|none|nothing|nowhere|neither|nor|without|hardly|barely|scarcely|rarely|seldom|"
    r"no one|anything but|far from|used to|as if|stopped|pretend\w*|doubt\w*)\b"
)
_NO_DENIALS = re.compile(
    r"\bno doubt\b|\bwithout (?:a )?doubt\b|\bdo not doubt\b|\bcan not (?:believe|help|get over)\b|"
    r"\bno wonder\b|\bnever knew\b|\bdid not (?:know|realise|realize)\b|\bi am not (?:joking|kidding|lying)\b"
)


@dataclass(frozen=True, slots=True)
class Sentence:
    """A sentence in lower case: ``can't`` is ``can not``, and the agent is ``you``.

    Attributes:
        text: Its words, without the mark at the end.
        end: The mark at the end: ``!``, ``?!``, or nothing.
        clauses: The parts between commas and conjunctions.
    """

    text: str
    end: str
    clauses: tuple[str, ...]

    @property
    def asks(self) -> bool:
        """Whether it is a question."""
        return "?" in self.end or _QUESTION.match(self.text) is not None

    @property
    def exclaims(self) -> bool:
        """Whether it ends with an exclamation mark."""
        return "!" in self.end


def sentences(text: str, names: Iterable[str] = ()) -> Iterator[Sentence]:
    """Yield the sentences of `text`. Each of the agent's `names`, and "this robot", becomes "you"."""
    text = text[:LONGEST].casefold()
    for pattern, instead in _SPELLINGS:
        text = pattern.sub(instead, text)
    agent = "|".join([r"th(?:is|at) (?:little |cute )?robot", *(re.escape(n.casefold()) for n in names if n)])
    text = re.sub(rf"\b(?:{agent})'s (?=(?:so|very|really|such|quite|a|an|the|not)\b)", "you are ", text)
    text = re.sub(rf"\b(?:{agent})'s\b", "your", text)
    text = re.sub(rf"\b(?:{agent})\b", "you", text)
    text = re.sub(r"\byou (?:is|was)\b", "you are", text)
    text = re.sub(r"\byou has\b", "you have", text)
    for found in _SENTENCE.findall(text):
        words = found.rstrip(".!?…")
        clauses = tuple(filter(None, (" ".join(part.split()) for part in _CLAUSE_END.split(words))))
        if clauses or "?" in found or "!" in found:
            yield Sentence(" ".join(words.split()), found[len(words) :], clauses)


def is_denied(clause: str, end: int) -> bool:
    """Return whether `clause` has a negation before the position `end`."""
    return _DENIALS.search(_NO_DENIALS.sub(" ", clause[:end])) is not None
