"""Free statements: what the user tells about themselves and others, and no topic covers."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from datetime import datetime

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase

from .reading import Reader
from .relations import relations
from .topics import NAME, TOPICS
from .values import value_of
from .wording import among

_SAID_BACK = {
    "i": "you", "me": "you", "my": "your", "mine": "yours", "myself": "yourself", "am": "are", "'m": "are",
    "we": "you", "our": "your", "us": "you", "ours": "yours",
}  # fmt: skip
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
        pronoun = said.subject.text.lower() in ("he", "she", "they")
        subject = last if pronoun else _about(reader, said)
        if said.subject.names or reader.noun(said.subject):
            last = said.subject.name or said.subject.text
        if subject and _is_worth_keeping(reader, said):
            predicate = said.triple.predicate
            found.append(Told(subject, predicate, said.object.text, _retold(reader, said)))
    return found


def answers_in(reader: Reader, told: Iterable[Told], known: Mapping[str, tuple[str, ...]]) -> list[Told]:
    """Return what answers the user's question: *what does Jonas play*, *where does my sister live*."""
    told = list(told)
    for said in reader.seen.statements:
        subject = _names_of(reader, said.subject, known) if isinstance(said.triple.subject, str) else ()
        object = said.object.text if isinstance(said.triple.object, str) else ""
        if said.question and (subject or object):
            found = [
                one
                for one in told
                if one.verb == said.triple.predicate
                and (not subject or among(one.subject, subject))
                and (not object or among(one.object, (object,)))
            ]
            if found:
                return found
    return []


def _names_of(reader: Reader, phrase: Phrase, known: Mapping[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Return the subjects under which the user may have told about somebody: *my sister*, *Rosa*."""
    return ("I",) if phrase.person == "I" else (phrase.text, *phrase.names, *known.get(reader.noun(phrase), ()))


def _is_worth_keeping(reader: Reader, said: nlp.Statement) -> bool:
    words, object = relations().words, said.object
    if said.verb in words["passing"] or " to " in said.triple.predicate or object.person != "other":
        return False
    return isinstance(said.triple.object, str) and not reader.ended(said) and (said.holds or _happened(reader, said))


def _happened(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether it is an event of the past: *I painted a dragon*, but not *I lived in Rome*."""
    verb = reader.verb(said)
    flags = said.negated or said.hearsay or said.conditional or said.plan or said.question or said.request
    return not flags and verb is not None and verb.tag == "VBD" and said.verb not in relations().words["states"]


def _about(reader: Reader, said: nlp.Statement) -> str:
    """Return the subject of a statement about the user or somebody they know; empty for others."""
    subject, object = said.subject, said.object
    if subject.person == "I":
        mine = "my" in object.text.lower().split() and not _happened(reader, said)
        deictic = reader.written(object).lower().startswith(("this ", "that ", "these ", "those "))
        fits = object.text and not object.preposition and said.verb not in ("be", "have") and not mine and not deictic
        return "I" if fits and not list(reader.links(said)) else ""
    words = subject.text.split() if subject.of("I") else []
    if reader.relative(subject.head) and words:
        naming = said.verb == "be" and ((object.names and not object.preposition) or not object.text)
        return "" if naming or said.triple.predicate in ("be called", "be named") else subject.name or subject.text
    if relations().words["kin"] & {subject.head, *map(str.lower, words[1:2])} and words:
        return " ".join(words[2:]) if len(words) == 3 else subject.text
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
    text = tree.phrase(words)
    if said.subject.text.split()[-1:] and said.subject.text.split()[-1].lower() not in text.lower().split():
        text = f"{said.subject.text} {text}"
    return " ".join(_SAID_BACK.get(word.lower(), word) for word in text.split())
