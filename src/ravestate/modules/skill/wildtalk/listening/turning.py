"""The user's words from the agent's view: *I painted my dog* becomes *you painted your dog*."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from ravestate.modules.meta.nlp.tree import Tree, Word

LONGEST = 9
"""The words of a clause that is worth repeating."""

_TURNED = {
    "i": "you", "me": "you", "my": "your", "mine": "yours", "myself": "yourself", "we": "you", "us": "you",
    "our": "your", "ours": "yours", "ourselves": "yourselves", "your": "my", "yours": "mine", "yourself": "myself",
    "am": "are", "'m": "are", "im": "you are",
}  # fmt: skip
_SUBJECTS = ("nsubj", "nsubjpass")
_LEFT_OUT = frozenset(("advcl", "conj", "cc", "punct", "intj", "parataxis", "preconj", "mark", "dep", "meta"))
_ASIDE = frozenset(("relcl", "appos", "punct", "advcl"))
_PHRASES = ("prep", "npadvmod", "advmod")
_SHORT = re.compile(r"\b(do|does|did|is|are|was|were|have|has|had|would|could|should) not\b")
_PARTICLES = frozenset(
    ("so", "well", "then", "also", "just", "really", "actually", "anyway", "too", "now", "and", "but")
)


def turned_text(words: Iterable[str]) -> str:
    """Return words without a parse, from the agent's view."""
    return _shortened(" ".join(_TURNED.get(word.lower(), "me" if word.lower() == "you" else word) for word in words))


def clause(tree: Tree, root: Word) -> str:
    """Return the clause of a verb from the agent's view; empty if it has no subject, is long, or has a slip."""
    subjects = tree.children(root, *_SUBJECTS, "expl")
    if not subjects or _slips(tree, root, subjects[-1]):
        return ""
    words = _kept(tree, root)
    while len(words) > LONGEST:  # a shorter form: without the last phrase
        last = next((word for word in reversed(words) if word.dep in _PHRASES and word.index > root.index), None)
        if last is None:
            return ""
        words = [word for word in words if word not in tree.subtree(last)]
    return turned(tree, words) if 2 <= len(words) <= LONGEST else ""


def turned(tree: Tree, words: Sequence[Word]) -> str:
    """Return words of a tree from the agent's view."""
    found = ""
    for word in words:
        text = _turned(tree, word)
        joined = text.startswith(("'", "n't", "’")) or (text in (",", ".") and word.pos == "PUNCT")
        found += text if joined or not found else f" {text}"
    return _shortened(found)


def _slips(tree: Tree, root: Word, subject: Word) -> bool:
    """Return whether the verb does not agree with its subject, as in *my brother stay*: this is not worth repeating."""
    singular = subject.low in ("he", "she", "it") or (subject.tag in ("NN", "NNP") and not tree.children(subject, "conj"))
    verbs = [root, *tree.children(root, "aux", "auxpass")]
    bare = all(word.tag in ("VB", "VBP") for word in verbs) and len(verbs) == 1
    return (singular and bare) or (root.tag in ("VBG", "NN") and len(verbs) == 1)


def _kept(tree: Tree, root: Word) -> list[Word]:
    left_out: set[Word] = set()
    for child in tree.children(root):
        long = child.dep == "ccomp" and len(tree.subtree(child)) > 5
        if child.dep in _LEFT_OUT or long or (child.dep == "advmod" and child.low in _PARTICLES):
            left_out.update(tree.subtree(child))
    subjects = tree.children(root, *_SUBJECTS)
    if subjects and subjects[-1].low in ("he", "she", "it", "they"):  # "my mother she is ill"
        before = tree.before(subjects[-1])
        if before is not None and (before.tag == "NNP" or tree.children(before, "poss")) and before.head == root.index:
            return [word for word in tree.subtree(root) if word not in left_out and word is not subjects[-1]]
    for word in tree.subtree(root):  # relative clauses, and what is in brackets
        if word.dep in _ASIDE and word is not root:
            left_out.update(tree.subtree(word))
    kept = [word for word in tree.subtree(root) if word not in left_out]
    return kept[1:] if kept and kept[0].low in ("yes", "no", "yeah") else kept


def _turned(tree: Tree, word: Word) -> str:
    low = word.low
    if low == "you":
        return "I" if word.dep in _SUBJECTS else "me"
    if low in ("was", "were", "are", "'re"):
        owner = word if word.dep not in ("aux", "auxpass") else tree.head(word)
        subjects = {child.low for child in tree.children(owner, *_SUBJECTS)}
        if low == "was" and "i" in subjects:
            return "were"
        if "you" in subjects:
            return "was" if low == "were" else "am"
        return "are" if low == "'re" else low
    first = word.index == 0 or (tree.words[word.index - 1].pos == "PUNCT" and word.text.istitle())
    return _TURNED.get(low, low if first and word.pos != "PROPN" else word.text)


def _shortened(text: str) -> str:
    text = re.sub(r"\bcan ?not\b", "can't", text).replace("will not", "won't")
    return re.sub(r"\b([Yy])ou are\b", r"\1ou're", _SHORT.sub(r"\1n't", text))
