"""The *roles* of a phrase, its placeholders such as ``{who}``, filled from the parse of an utterance."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.tree import Tree, Word

from .material import AGREEING, Material
from .moment import ROLE
from .state import Being

LONGEST = 32
"""The maximum number of characters in the value of a role."""

_THEY = {"f": ("she", "her", "her"), "m": ("he", "him", "his")}
_IT, _PLURAL = ("it", "it", "its"), ("they", "them", "their")
_PRONOUNS = {"she": "f", "her": "f", "hers": "f", "he": "m", "him": "m", "his": "m"}
_POINTING = frozenset(("it", "that", "this", "there"))
_SINGULAR = {"are": "is", "were": "was", "have": "has", "do": "does"}
_ASIDES = frozenset(("think", "guess", "suppose", "believe"))
_BESIDE = frozenset(("relcl", "prep", "pobj", "cc", "conj", "appos", "punct", "advcl", "acl"))
_VAGUE = frozenset(("any", "some", "no", "what", "which", "its", "such", "every", "each", "all"))
_NOMINAL = frozenset(("NOUN", "PROPN", "ADJ", "NUM", "DET", "PRON", "PART"))
TURNED = dict(
    zip(
        ["my", "our", "mine", "ours", "me", "us", "i", "am", "your", "you"],
        ["your", "your", "yours", "yours", "you", "you", "you", "are", "my", "me"],
        strict=True,
    )
)
"""Word of the user → the agent's word for it."""
_OWNED = ("her ", "his ", "their ", "its ")
_REPEATABLE = re.compile(r"[\w' ,.’-]+")


@dataclass(frozen=True, slots=True)
class Roles:
    """The values of the roles."""

    values: Mapping[str, str] = field(default_factory=dict[str, str])
    being: Being | None = None
    statement: Statement | None = None
    """The statement from which the values come."""

    def having(self, **values: str) -> Roles:
        """Return the roles with more values; empty values are left out."""
        return replace(self, values={**self.values, **{name: value for name, value in values.items() if value}})

    def fill(self, text: str) -> str:
        """Return a phrase with its roles filled. If a role begins with a capital (``{Who}``), so does its value."""
        parts = ROLE.split(text)  # text, role, text, role, ...
        for place in range(1, len(parts), 2):
            role = parts[place]
            low = role.lower()
            value = self._agreed(low, parts, place) if low in AGREEING else self.values[low]
            parts[place] = value[:1].upper() + value[1:] if role[0].isupper() else value
        filled = "".join(parts)
        return filled[:1].upper() + filled[1:]

    def _agreed(self, verb: str, parts: list[str], place: int) -> str:
        """Return a verb that agrees with the role next to it."""
        near = [parts[place - 2].lower()] if place > 2 and parts[place - 1] == " " else []
        near += [parts[place + 2].lower()] if place + 2 < len(parts) and parts[place + 1] == " " else []
        plural = self.values.get("they") == "they" if "they" in near else self.being is not None and self.being.plural
        return verb if plural else _SINGULAR[verb]


def roles_of(seen: Analysis, sentence: str, focus: Being | None, material: Material) -> Roles:
    """Return the roles that an utterance fills.

    Args:
        seen: The analysis of the utterance.
        sentence: The sentence that matters most. If it has a statement, the roles come from that statement.
        focus: The being that was mentioned before. A pronoun means this being.
        material: The nouns for living beings.
    """
    statement = _statement(seen, sentence)
    being = _being(seen, material)
    pronouns = {word.low for word in seen.tree.words}
    genders = {_PRONOUNS[word] for word in pronouns if word in _PRONOUNS}
    others = {"they", "them", "their", *(("it", "its") if focus is not None and focus.kind == "pet" else ())}
    if being is None and focus is not None and (genders or pronouns & others):
        being = focus if {focus.gender} | genders != {"f", "m"} else None
    words = _THEY[next(iter(genders))] if genders else _IT if pronouns & {"it", "its"} else None
    if being is not None:
        if len(genders) == 1 and being.gender == "n" and not being.plural:
            being = replace(being, gender=next(iter(genders)))
        words = _PLURAL if being.plural else _THEY.get(being.gender, _IT if being.kind == "pet" else _PLURAL)
    if statement is not None and statement.subject.text.lower() == "they":
        words = _PLURAL
    roles = Roles(being=being, statement=statement).having(who="" if being is None else being.text)
    if words is not None:
        roles = roles.having(they=words[0], them=words[1], their=words[2])
        roles = roles.having(**dict.fromkeys(AGREEING, "yes")) if being is not None or genders else roles
    return roles.having(thing="" if statement is None else _thing(seen.tree, statement))


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


def _statement(seen: Analysis, sentence: str) -> Statement | None:
    """Return the most important statement of `sentence`; if it has none, of the whole utterance."""
    told = [one for one in seen.statements if all(isinstance(part, str) for part in (one.triple[0], one.triple[2]))]
    low = (sentence or (seen.sentences[-1] if seen.sentences else "")).lower()

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


def _being(seen: Analysis, material: Material) -> Being | None:
    for statement in seen.statements:
        for phrase in (statement.subject, statement.object, *statement.phrases):
            for part in _owners(phrase):
                if part.head in material.beings and (part.owner is not None or part.names or part is phrase):
                    mine = statement.subject_person == "I" and part is not statement.subject
                    return _as_being(seen.tree, part, *material.beings[part.head], mine=mine)
    for word in seen.tree.words:  # also outside of statements: "my mother she is ill"
        mine = any(part.low in ("my", "our") for part in seen.tree.children(word, "poss"))
        if mine and word.lemma.lower() in material.beings:
            kind, gender = material.beings[word.lemma.lower()]
            return Being(f"your {word.low}", kind, gender, word.tag == "NNS")
    people = [entity.text for entity in seen.entities if entity.label == "PERSON" and entity.text[:1].isupper()]
    return Being(people[0], "person") if people else None


def _owners(phrase: Phrase) -> Iterator[Phrase]:
    """Yield a phrase and its possessor, because *my mother's car* is also about *my mother*."""
    yield phrase
    if phrase.owner is not None and phrase.owner.person == "other":
        yield from _owners(phrase.owner)


def _as_being(tree: Tree, phrase: Phrase, kind: str, gender: str, *, mine: bool) -> Being:
    plural = any(word.tag in ("NNS", "NNPS") and word.lemma.lower() == phrase.head for word in tree.words)
    if phrase.names and (kind == "pet" or phrase.owner is None):
        return Being(phrase.name, kind, gender)
    words = [TURNED.get(word.lower(), word) for word in phrase.text.removesuffix("'s").split()]
    noun = next((word.low for word in tree.words if word.lemma.lower() == phrase.head), phrase.head)
    text = f"your {noun}" if phrase.owner is not None or (mine and kind == "pet") else f"the {noun}"
    text = " ".join(words) if phrase.owner is not None and len(words) <= 3 else text
    text = text[:1].lower() + text[1:] if text.lower().startswith(_OWNED) else text  # "Her mother thinks..."
    return Being(text, kind, gender, plural or (phrase.amount or 1) > 1)
