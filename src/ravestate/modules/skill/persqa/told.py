"""Free statements: what the user tells about themselves and others, and no topic covers."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.tree import Tree, Word

from .wording import among

_SAID_BACK = {
    "i": "you",
    "me": "you",
    "my": "your",
    "mine": "yours",
    "myself": "yourself",
    "am": "are",
    "we": "you",
    "our": "your",
    "us": "you",
    "ours": "yours",
}
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

    def answers(self, subject: str | None, verb: str, object: str | None = None) -> bool:
        """Return whether it answers a question about `subject` or `object` with this verb; None stands for the unknown."""
        if subject is not None and not among(subject, (self.subject,)):
            return False
        if object is not None and not among(object, (self.object,)):
            return False
        return verb == self.verb


def retold(tree: Tree, said: nlp.Statement) -> str:
    """Return the clause of a statement as the agent says it to the user.

    Example:
        *my sister lives in Rome and I like it* gives *your sister lives in Rome*.
    """
    last = said.triple.predicate.split()[-1]
    verb = next((word for word in tree.words if said.verb in (word.lemma, word.low) or word.low == last), None)
    if verb is None:
        return ""
    top = verb
    while top.dep in ("xcomp",):
        top = tree.head(top)
    words = [word for child in [top, *tree.children(top)] for word in ([child] if child is top else _of(tree, child))]
    text = tree.phrase(words)
    if said.subject.text and said.subject.text.split()[-1].lower() not in text.lower():
        text = f"{said.subject.text} {text}"
    return " ".join(_SAID_BACK.get(word.lower(), word) for word in text.split())


def _of(tree: Tree, child: Word) -> list[Word]:
    return [] if child.dep in _ASIDE else list(tree.subtree(child))
