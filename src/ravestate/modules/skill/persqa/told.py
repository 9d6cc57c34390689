"""Free statements: what the user tells about themselves and others, and no topic covers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from datetime import datetime

from ravestate.errors import PlatformError
from ravestate.language.encoder import Encoder
from ravestate.language.normal import plain
from ravestate.modules import nlp

from .answers import spelled_out
from .reading import Reader
from .topics import NAME, TOPICS, WORDS
from .values import value_of
from .wording import Facts, among

_SAID_BACK = {
    "i": "you", "me": "you", "my": "your", "mine": "yours", "myself": "yourself", "am": "are", "'m": "are",
    "we": "you", "our": "your", "us": "you", "ours": "yours",
}  # fmt: skip
LEAST = 0.73
"""The least similarity of a question to what it asks for."""
_FIT = {
    nlp.QuestionWord.PERSON: re.compile(r"(?<!^)\b[A-Z]\w|\byour \w"),
    nlp.QuestionWord.TIME: re.compile(
        r"\d|\b(?:on|in|at|since) \w|day\b|\b(?:tomorrow|tonight|morning|evening|noon|week|month|year)\b", re.IGNORECASE
    ),
    nlp.QuestionWord.PLACE: re.compile(r"\b(?:in|at|to|from|near|on) \w"),
}
"""The form of what answers a question for a person, a time or a place."""
_ASIDE = frozenset(["punct", "cc", "conj", "advcl", "parataxis", "intj", "mark", "meta", "dep"])


@dataclass(frozen=True, slots=True)
class Told:
    """Something that the user told: *Jonas plays the violin*."""

    subject: str
    """As the user names it: ``Jonas``, ``my mother``, ``I``."""
    verb: str
    """The predicate as a lemma: ``play``."""
    object: str
    """Without its article: ``violin``; empty if there is none."""
    text: str
    """A clause that says it to the user: *you painted a dragon*."""
    by: str = ""
    """The name of the person who told it; empty while it is not known."""
    at: datetime | None = None
    """The moment when they told it."""

    @property
    def key(self) -> str:
        """The key in `persqa.told`."""
        return f"{self.subject} / {self.verb} / {self.object}".lower()


def told_in(reader: Reader) -> list[Told]:
    """Return the free statements of an utterance."""
    found: list[Told] = []
    last = ""
    for said in reader.seen.statements:
        subject = last if said.subject.text.lower() in ("he", "she", "they") else _about(reader, said)
        if said.subject.names or reader.noun(said.subject):
            owner = said.subject.owner if said.subject.head == "name" else None  # my wife's name is..., and she...
            last = (owner or said.subject).name or (owner or said.subject).text
        if subject and _is_worth_keeping(reader, said):
            found.append(Told(subject, said.triple.predicate, said.object.text, _retold(reader, said)))
    return found


def answers_in(reader: Reader, told: Iterable[Told], known: Facts) -> list[Told]:
    """Return what answers the user's question: *what does Jonas play*, *where does my sister live*."""
    told = list(told)
    for said in filter(lambda one: one.question, reader.seen.statements):
        subject, object = said.subject, said.object.text if isinstance(said.triple.object, str) else ""
        # The user may have told about Rosa, or about their sister.
        names = (
            ("I",) if subject.person == "I" else (subject.text, *subject.names, *known.get(reader.noun(subject), ()))
        )
        names = names if isinstance(said.triple.subject, str) else ()
        same = (one for one in told if one.verb == said.triple.predicate and (names or object))
        same = (one for one in same if not names or among(one.subject, names))
        if found := [one for one in same if not object or among(one.object, (object,))]:
            return found
    return []


def recalled(reader: Reader, told: Iterable[Told]) -> list[Told]:
    """Return what the user told that their question means, though in other words: *who is getting married, do you
    remember?*."""
    told, kind = list(told), reader.seen.question
    mine = reader.words & {"i", "my", "me", "we", "our", "remember"}
    fit = [one for one in told if kind not in _FIT or _FIT[kind].search(one.text)]
    if not fit or not mine or (kind == nlp.QuestionWord.YES_NO and not reader.words & {"remember", "know"}):
        return []
    asked = [part for part in (reader.tree.text, *reader.tree.text.split(",")) if len(part.split()) > 3]
    try:
        rows = Encoder().encode([plain(_returned(text)) for text in (*asked, *(one.text for one in fit))])
    except PlatformError:  # without the model, only the words themselves are found
        return []
    likeness = (rows[len(asked) :] @ rows[: len(asked)].T).max(axis=1) if asked else [0.0]
    best = max(range(len(likeness)), key=likeness.__getitem__)
    return [fit[best]] if likeness[best] > LEAST else []


def _is_worth_keeping(reader: Reader, said: nlp.Statement) -> bool:
    called = said.triple.predicate in ("be called", "be named")
    if (
        (said.verb in WORDS["passing"] and not called)
        or " to " in said.triple.predicate
        or said.object.person != "other"
    ):
        return False
    return isinstance(said.triple.object, str) and not reader.ended(said) and (said.holds or _happened(reader, said))


def _happened(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether it is an event of the past: *I painted a dragon*, but not *I lived in Rome*."""
    verb = reader.verb(said)
    flags = said.negated or said.hearsay or said.conditional or said.plan or said.question or said.request
    return not flags and verb is not None and verb.tag == "VBD" and said.verb not in WORDS["states"] | WORDS["pastimes"]


def _about(reader: Reader, said: nlp.Statement) -> str:
    """Return the subject of a statement about the user or somebody they know; empty for others."""
    subject, object = said.subject, said.object
    if subject.person == "I":
        mine = "my" in object.text.lower().split() and not _happened(reader, said)
        deictic = re.match(r"(?:this|that|these|those|it|here|there)\b", reader.written(object), re.IGNORECASE)
        spoken = not reader.words.isdisjoint({"i", "we", "i'm"})
        there = (
            object.preposition and not object.text[:1].isupper()
        )  # I drive for Transkorn, but not I wait for the bus
        fits = object.text and not there and said.verb not in ("be", "have") and not mine and not deictic
        return "I" if spoken and fits and not list(reader.links(said)) else ""
    words = subject.text.split() if subject.of("I") else []
    if reader.relative(subject.head) and words:
        naming = said.verb == "be" and ((object.names and not object.preposition) or not object.text)
        return "" if naming or said.triple.predicate in ("be called", "be named") else subject.name or subject.text
    if WORDS["kin"] & {subject.head, *map(str.lower, words[1:2])} and words:
        return " ".join(words[2:]) if len(words) == 3 else subject.text
    dated = said.verb == "be" and said.when  # my birthday is in May
    if words and dated and not reader.noun(subject):
        return subject.text
    person = subject.names and not subject.head and value_of(subject.text, TOPICS[NAME], reader.seen, sure=False)
    return subject.text if person and not reader.noun(object) else ""


def _retold(reader: Reader, said: nlp.Statement) -> str:
    """Return the clause of a statement as the agent says it to the user: *your sister lives in Rome*."""
    tree, top = reader.tree, reader.verb(said)
    if top is None:
        return ""
    while top.dep == "xcomp":
        top = tree.head(top)
    words = [top, *(word for child in tree.children(top) if child.dep not in _ASIDE for word in tree.subtree(child))]
    text = spelled_out(tree.phrase(words))
    if said.subject.text.lower().split()[-1:] and said.subject.text.lower().split()[-1] not in re.findall(
        r"\w+", text.lower()
    ):
        text = f"{said.subject.text} {text}"
    return _returned(text)


def _returned(text: str) -> str:
    """Return the user's words as the agent says them: *your* for *my*."""
    return " ".join(_SAID_BACK.get(word.lower(), word) for word in text.split())
