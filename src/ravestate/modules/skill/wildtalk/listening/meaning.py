"""The meaning of an utterance for the listener: the moment, the feeling, the persons."""

from __future__ import annotations

from ravestate.language.matcher import Match
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.statement import Statement

from .material import Material, Moment
from .roles import Roles
from .turning import turned

FEW_WORDS = 3
"""The words of a sentence that resembles many others."""
TURNED = 0.95
"""The confidence from which a glad feeling or a light moment ends a sad tone."""
FEW = 0.75
"""The confidence in a feeling or an act for an utterance of one to three words."""
SURE_OF_FEW = 0.7
"""The same for an utterance of one or two words."""
SUBJECT = 0.45
"""The confidence in a subject from which it decides."""
FELT, GLAD = 0.55, 0.7
"""The confidence in a sad feeling from which it decides, and in another one."""
AMAZED = 0.8
"""The confidence from which news count as astonishing."""
_THIRD = frozenset(("he", "she", "they"))
_SAD = frozenset(("grief", "illness", "sadness", "loneliness", "worry", "failure", "anger", "tiredness"))


def about_in(seen: Analysis) -> str:
    """Return the noun of *what do you think of jazz*."""
    for word in seen.tree.words:
        if word.dep in ("pobj", "pcomp") and seen.tree.head(word).low in ("of", "about", "on"):
            return turned(seen.tree, [part for part in seen.tree.subtree(word) if part.dep != "punct"])
    return ""


def moment_of(phrases: Material, seen: Analysis | None) -> tuple[Moment | None, str, float]:
    """Return the moment or topic that a sentence resembles most, with the sentence and the confidence."""
    best, sentence, score = None, "", 0.0
    if seen is not None:
        for match in phrases.matcher.match_all(seen.sentences[:4]):
            if match is not None:
                found = phrases.moments.get(match.name)
                if found is None and match.score < SUBJECT:
                    continue
                if found is not None and len(match.text.split()) <= 2 and match.score < SURE_OF_FEW:
                    continue
                weight = match.score if found is not None else match.score / 2  # a topic is less telling
                if weight > score:
                    best, sentence, score = found or phrases.topics[match.name], match.text, weight
    return best, sentence, score


def feeling_of(phrases: Material, seen: Analysis | None, sentence: str, tone: str) -> tuple[Moment | None, str]:
    """Return the strongest feeling, sad ones first, with its sentence."""
    known = [] if seen is None else [match for match in seen.feelings.values() if match.name in phrases.feelings]
    matches = [match for match in known if match.score >= _least(match, tone)]
    if not matches:
        return None, sentence
    best = max(matches, key=lambda match: (match.name in _SAD, match.score))
    return phrases.feelings[best.name], best.text


def is_living(phrases: Material, statement: Statement) -> bool:
    """Return whether a statement is about somebody other than the user and the agent."""
    subject = statement.subject
    if subject.of("you") or subject.person != "other":
        return False
    return subject.head in phrases.beings or bool(subject.names) or subject.text.lower() in _THIRD


def is_of_others(seen: Analysis) -> bool:
    """Return whether it tells something about somebody or something else: no answer to a question about the user."""
    others = any(word.low in (*_THIRD, "we") for word in seen.tree.words)
    return others or any(one.subject.head for one in seen.statements)


def called_in(roles: Roles) -> str:
    """Return the name in *his name is Rex*."""
    statement = roles.statement
    if statement is None or statement.question or statement.subject.head != "name" or statement.subject.of("I"):
        return ""
    return statement.object.text


def _least(match: Match, tone: str) -> float:
    """Return the confidence from which a feeling decides."""
    least = FELT if match.name in _SAD else TURNED if tone == "sad" else AMAZED if match.name == "astonishing" else GLAD
    return max(least, FEW) if len(match.text.split()) <= FEW_WORDS else least


def words_of(seen: Analysis) -> set[str]:
    """Return the words of an utterance in lower case."""
    return {word.low for word in seen.tree.words}


def is_past(verb: str, seen: Analysis) -> bool:
    """Return whether the clause of a verb is in the past tense."""
    for word in seen.tree.words:
        if word.lemma == verb and (
            word.tag == "VBD" or any(part.tag == "VBD" for part in seen.tree.children(word, "aux"))
        ):
            return True
    return False


def choice_in(seen: Analysis) -> tuple[str, str] | None:
    """Return the alternatives of *cats or dogs?*."""
    tree = seen.tree
    for word in tree.words:
        if word.low == "or" and word.dep == "cc":
            first = tree.head(word)
            seconds = tree.children(first, "conj")
            if seconds and first.pos in ("NOUN", "PROPN", "ADJ", "NUM"):
                left = {"cc", "conj", "punct"}
                kept = [part for part in tree.subtree(first) if part.dep not in left and tree.head(part).dep != "conj"]
                return turned(tree, kept), turned(tree, tree.subtree(seconds[0]))
    return None
