"""The roles of a phrase, filled from the parse of an utterance."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.phrase import Phrase
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.tree import Tree, Word

from .material import AGREEING, ROLE, Material
from .state import Being
from .turning import clause, turned, turned_text

LONGEST = 48
"""The characters of a role."""

_THEY = {"f": ("she", "her", "her"), "m": ("he", "him", "his")}
_IT, _PLURAL = ("it", "it", "its"), ("they", "them", "their")
_PRONOUNS = {"she": "f", "her": "f", "hers": "f", "he": "m", "him": "m", "his": "m"}
_POINTING = frozenset(("it", "that", "this", "there"))
_SINGULAR = {"are": "is", "were": "was", "have": "has", "do": "does"}
_ASIDES = frozenset(("think", "guess", "suppose", "believe"))
_REPEATABLE = re.compile(r"[\w' ,.’-]+")


@dataclass(frozen=True, slots=True)
class Roles:
    """The values of the roles."""

    values: Mapping[str, str] = field(default_factory=dict[str, str])
    being: Being | None = None
    statement: Statement | None = None
    """The statement that the roles stand for."""

    def having(self, **values: str) -> Roles:
        """Return the roles with more values; empty ones are left out."""
        return replace(self, values={**self.values, **{name: value for name, value in values.items() if value}})

    def fill(self, text: str) -> str:
        """Return a phrase with its roles filled; one written with a capital begins with a capital."""
        known = self.values
        parts = ROLE.split(text)  # text, role, text, role, ...
        for place in range(1, len(parts), 2):
            role = parts[place]
            low = role.lower()
            value = self._agreed(low, parts, place) if low in AGREEING else known[low]
            parts[place] = value[:1].upper() + value[1:] if role[0].isupper() else value
        filled = "".join(parts)
        return filled[:1].upper() + filled[1:]

    def _agreed(self, verb: str, parts: list[str], place: int) -> str:
        """Return a verb that agrees with the role next to it."""
        near = [parts[place - 2].lower()] if place > 2 and parts[place - 1] == " " else []
        near += [parts[place + 2].lower()] if place + 2 < len(parts) and parts[place + 1] == " " else []
        subject = next((role for role in near if role in ("who", "they")), "who")
        plural = self.being is not None and self.being.plural
        if subject == "they":
            plural = self.values.get("they") == "they"
        return verb if plural else _SINGULAR[verb]


def roles_of(seen: Analysis, sentence: str, focus: Being | None, material: Material) -> Roles:
    """Return the roles that an utterance fills.

    Args:
        seen: Its analysis.
        sentence: The sentence that matters most; the statement is taken from it if it has one.
        focus: The being that was mentioned before; a pronoun stands for it.
        material: The nouns for living beings.
    """
    statement = _statement(seen, sentence)
    roles = Roles(statement=statement)
    being = _being(seen, material)
    pronouns = {word.low for word in seen.tree.words}
    genders = {_PRONOUNS[word] for word in pronouns if word in _PRONOUNS}
    if being is None and focus is not None and (genders or pronouns & {"they", "them", "it", "its", "their"}):
        being = focus if {focus.gender} | genders != {"f", "m"} else None
    words = _THEY[next(iter(genders))] if genders else _IT if pronouns & {"it", "its"} else None
    if being is not None:
        if len(genders) == 1 and being.gender == "n" and not being.plural:
            being = replace(being, gender=next(iter(genders)))
        words = _PLURAL if being.plural else _THEY.get(being.gender, _IT if being.kind == "pet" else _PLURAL)
        roles = replace(roles, being=being).having(who=being.text)
    if statement is not None and statement.subject.text.lower() == "they":
        words = _PLURAL
    if words is not None:
        roles = roles.having(they=words[0], them=words[1], their=words[2])
        roles = roles.having(**dict.fromkeys(AGREEING, "yes")) if being is not None or genders else roles
    if statement is not None and not statement.question:
        root = _root(seen.tree, statement)
        mood = root is not None and statement.subject_person == "I" and bool(seen.tree.children(root, "acomp"))
        said = "" if root is None or mood else clause(seen.tree, root)  # "You are angry?" would be no news
        if said and len(said) <= 2 * LONGEST and _REPEATABLE.fullmatch(said):
            roles = roles.having(clause=said)
    thing = "" if statement is None else _thing(seen.tree, statement)
    return roles.having(thing=thing)


def fragment(seen: Analysis) -> str:
    """Return a short answer without a verb, from the agent's view; empty for anything else."""
    tree = seen.tree
    asides = {
        part.index for word in tree.words if _is_aside(tree, word) for part in (word, *tree.children(word, "nsubj"))
    }
    words = [
        word for word in tree.words if word.index not in asides and word.pos not in ("PUNCT", "INTJ", "SPACE", "SYM")
    ]
    while words and words[0].low in ("and", "but", "so", "or", "just", "well", "because"):
        words = words[1:]
    text = turned(seen.tree, words)
    return text if words and len(text) <= LONGEST and len(words) <= 6 and _REPEATABLE.fullmatch(text) else ""


def has_verb(seen: Analysis) -> bool:
    """Return whether there is a verb with a subject, or a request."""
    tree = seen.tree
    subjects = [word for word in tree.words if word.dep in ("nsubj", "nsubjpass", "expl", "csubj")]
    return any(not _is_aside(tree, tree.head(word)) for word in subjects)


def is_request(seen: Analysis) -> bool:
    """Return whether the user demands something: *prove it*."""
    first = next((word for word in seen.tree.words if word.pos not in ("PUNCT", "INTJ")), None)
    bare = first is not None and first.pos == "VERB" and first.dep == "ROOT" and first.tag in ("VB", "VBP")
    return bare or any(statement.request for statement in seen.statements)


def _is_aside(tree: Tree, verb: Word) -> bool:
    """Return whether a verb only comments on the rest, as in *tea, I think*."""
    return verb.lemma in _ASIDES and not tree.children(verb, "ccomp", "dobj", "prep", "neg", "xcomp", "advmod")


def _statement(seen: Analysis, sentence: str) -> Statement | None:
    told = [
        one for one in seen.statements if isinstance(one.triple.subject, str) and isinstance(one.triple.object, str)
    ]
    sentence = sentence or (seen.sentences[-1] if seen.sentences else "")
    inside = [one for one in told if one.verb and _mentions(sentence, one)] or told
    first = [one for one in inside if not one.hearsay and not one.conditional] or inside
    telling = [one for one in first if one.subject.head or one.subject.text.lower() not in _POINTING] or first
    return telling[0] if telling else None


def _mentions(sentence: str, statement: Statement) -> bool:
    low = sentence.lower()
    return all(part.lower() in low for part in (statement.subject.text, statement.object.text) if part)


def _root(tree: Tree, statement: Statement) -> Word | None:
    """Return the first verb of the statement's clause; for *I said that he left*, that of what was said."""
    subject = statement.subject.text.lower()
    for word in tree.words:
        if word.pos not in ("VERB", "AUX"):
            continue
        for child in tree.children(word, "nsubj", "nsubjpass", "expl"):
            if tree.phrase(tree.subtree(child)).lower().startswith(subject[:4]) or child.low in subject:
                chain = {
                    word.lemma,
                    *(part.lemma for part in tree.subtree(word) if part.dep in ("xcomp", "attr", "acomp")),
                }
                if statement.verb in chain or statement.verb == word.lemma:
                    said = tree.children(word, "ccomp") if word.lemma in ("say", "mean") and child.low == "i" else []
                    return said[0] if said else word
    return None


def _thing(tree: Tree, statement: Statement) -> str:
    """Return the object with its articles, from the agent's view."""
    phrase = statement.object
    if not phrase.text or phrase.person != "other" or not (phrase.head or phrase.names):
        return ""
    last = phrase.text.split()[-1].lower()
    for word in tree.words:
        if word.low == last and word.pos in ("NOUN", "PROPN", "VERB", "NUM"):
            words = [
                part
                for part in tree.subtree(word)
                if part.dep not in ("relcl", "prep", "pobj", "cc", "conj", "appos", "punct", "advcl", "acl")
            ]
            text = turned(tree, words)
            return text if text and len(text) <= LONGEST and _REPEATABLE.fullmatch(text) else ""
    return ""


def _being(seen: Analysis, material: Material) -> Being | None:
    for statement in seen.statements:
        for phrase in (statement.subject, statement.object, *statement.phrases):
            for part in _owners(phrase):
                if part.head in material.beings and (part.owner is not None or part.names or part is phrase):
                    mine = statement.subject_person == "I" and part is not statement.subject
                    return _as_being(seen.tree, part, *material.beings[part.head], mine=mine)
    for word in seen.tree.words:  # also outside of statements: "my mother she is ill"
        if word.lemma.lower() in material.beings and any(
            part.low in ("my", "our") for part in seen.tree.children(word, "poss")
        ):
            kind, gender = material.beings[word.lemma.lower()]
            return Being(f"your {word.low}", kind, gender, word.tag == "NNS")
    people = [entity.text for entity in seen.entities if entity.label == "PERSON"]
    return Being(people[0], "person") if people else None


def _owners(phrase: Phrase) -> Iterator[Phrase]:
    """Yield a phrase, and its owner: *my mother's car* is about *my mother*."""
    yield phrase
    if phrase.owner is not None and phrase.owner.person == "other":
        yield from _owners(phrase.owner)


def _as_being(tree: Tree, phrase: Phrase, kind: str, gender: str, *, mine: bool) -> Being:
    plural = any(word.tag in ("NNS", "NNPS") and word.lemma.lower() == phrase.head for word in tree.words)
    if phrase.names and kind == "pet":
        return Being(phrase.name, kind, gender)
    words = phrase.text.split()
    owned = phrase.owner is not None
    noun = next((word.low for word in tree.words if word.lemma.lower() == phrase.head), phrase.head)
    text = turned_text(words) if owned else f"your {noun}" if mine and kind == "pet" else f"the {noun}"
    return Being(text, kind, gender, plural or (phrase.amount or 1) > 1)
