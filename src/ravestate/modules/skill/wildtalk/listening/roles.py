"""The parts of an utterance that the agent's phrases repeat: the thing that it is about, and other noun phrases.

Both are *from the agent's view*: *your brother's dog* for *my brother's dog*. A *role* is a placeholder in a phrase.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.tree import Tree, Word

LONGEST = 32
"""The maximum number of characters in the value of a role."""
TURNED = dict(
    zip(
        ["my", "our", "mine", "ours", "me", "us", "i", "am", "your", "you"],
        ["your", "your", "yours", "yours", "you", "you", "you", "are", "my", "me"],
        strict=True,
    )
)
"""Word of the user → the agent's word for it."""
_POINTING = frozenset(("it", "that", "this", "there"))
_ASIDES = frozenset(("think", "guess", "suppose", "believe"))
_BESIDE = frozenset(("relcl", "prep", "pobj", "cc", "conj", "appos", "punct", "advcl", "acl"))
_VAGUE = frozenset(("any", "some", "no", "what", "which", "its", "such", "every", "each", "all"))
_NOMINAL = frozenset(("NOUN", "PROPN", "ADJ", "NUM", "DET", "PRON", "PART"))
_REPEATABLE = re.compile(r"[\w' ,.’-]+")


def thing_in(seen: Analysis) -> str:
    """Return the object of an utterance's main statement with its articles, from the agent's view; empty if there is none."""
    statement = _statement(seen)
    return "" if statement is None else _thing(seen.tree, statement)


def turned(tree: Tree, words: Sequence[Word]) -> str:
    """Return a noun phrase from the agent's view: *my brother's dog* becomes *your brother's dog*.

    A phrase that is too long, or has unusual characters, becomes empty.
    """
    found = ""
    for word in words:
        noun = word.low == "am" and word.pos not in ("AUX", "VERB")  # "3 am"
        text = word.text if noun else TURNED.get(word.low, word.text)
        found += text if not found or text.startswith(("'", "’")) or text == "," else f" {text}"
    return found if len(found) <= LONGEST and _REPEATABLE.fullmatch(found) else ""


def has_verb(seen: Analysis) -> bool:
    """Return whether a verb has a subject, apart from asides such as *I think*."""
    tree = seen.tree
    subjects = [word for word in tree.words if word.dep in ("nsubj", "nsubjpass", "expl", "csubj")]
    return any(not _is_aside(tree, tree.head(word)) for word in subjects)


def is_request(seen: Analysis) -> bool:
    """Return whether the utterance is an order: *prove it*."""
    words = [word for word in seen.tree.words if word.pos not in ("PUNCT", "INTJ")]
    first = words[0] if len(words) > 1 or (words and (seen.acts or seen.asks)) else None  # "pumpkin" is no verb
    return first is not None and first.pos == "VERB" and first.dep == "ROOT" and first.tag in ("VB", "VBP")


def _is_aside(tree: Tree, verb: Word) -> bool:
    """Return whether a verb only comments on the rest of its sentence, as in *tea, I think*."""
    return verb.lemma in _ASIDES and not tree.children(verb, "ccomp", "dobj", "prep", "neg", "xcomp", "advmod")


def _statement(seen: Analysis) -> Statement | None:
    """Return the most important statement of the last sentence; if it has none, of the whole utterance."""
    told = [one for one in seen.statements if all(isinstance(part, str) for part in (one.triple[0], one.triple[2]))]
    low = (seen.sentences[-1] if seen.sentences else "").lower()

    def worth(one: Statement) -> tuple[bool, bool, bool]:
        inside = bool(one.verb) and one.subject.text.lower() in low and one.object.text.lower() in low
        pointing = not one.subject.head and one.subject.text.lower() in _POINTING
        return inside, not (one.hearsay or one.conditional), not pointing

    return max(told, key=worth, default=None)


def _thing(tree: Tree, statement: Statement) -> str:
    """Return the object of a statement with its articles, from the agent's view."""
    phrase = statement.object
    if phrase.text and phrase.person == "other" and (phrase.head or phrase.names):
        last = phrase.text.split()[-1].lower()
        for word in tree.words:
            if word.low == last and word.pos in ("NOUN", "PROPN"):
                words = [part for part in tree.subtree(word) if part.dep not in _BESIDE]
                odd = words[-1:] != [word] or any(part.pos not in _NOMINAL or part.low in _VAGUE for part in words)
                return "" if odd else turned(tree, words)
    return ""
