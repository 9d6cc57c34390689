"""The *tags* and *roles* that the listener notices in an utterance.

The listener is the part that chooses the agent's reply. The tags select rows of the table of answers (order.yaml), and the
roles fill its phrases. responses.py finds the replies that suit.

A *move* is the next step of a good listener, such as to console. A *role* is a placeholder in a phrase. An *act* is what an
utterance does, such as thanking. The *tone* of a conversation is sad, angry, glad or tired.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from ravestate.language.contractions import word_set
from ravestate.language.nonsense import is_nonsense
from ravestate.language.normal import normalise, plain
from ravestate.language.replies import replies
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QUESTION_WORDS, QuestionWord

from .asked import WORDING, Asked, asked_in, options_between
from .asking import SHORT, asking_sentence, words_of
from .grave import is_crisis, is_emergency, is_grave, is_medical
from .material import Material
from .responses import LIGHT, Response, responses_to
from .roles import is_request, thing_in, turned
from .state import DANGER, State
from .tones import DARK, heard_tone
from .tongue import is_number, tongue_of
from .turns import is_cry, is_leaving, is_news

BARE = 3
"""The maximum number of words of a question that only repeats words in surprise: *that late?*"""
SETTLED = 0.5
"""From this confidence in the likeliest move on, the second likeliest move does not count."""
PARTING = 0.5
"""If a farewell suits as the reply with at least this probability, the utterance counts as a farewell itself."""
GRIEVING = ("console", "mourn")
"""Moves in reply to a sorrow."""
MEANT = 0.7
"""The minimum confidence in a farewell that ends an utterance."""
_QUESTIONS = word_set("question questions ask asking asks")
"""Words with which users stop the agent's questions."""
_OFFER = re.compile(r"(?:do you want|would you like|shall i|can i).{0,9} (?:know|hear|see|tell|show)\b", re.IGNORECASE)
"""The user offers to tell the agent something."""
_MACHINES = word_set("robot bot machine computer program ai chatbot")
_UNENDING = word_set("and but or because if the a an my your is 's are 're 'm to")
"""Function words that cannot end an utterance."""
_ADVISED = re.compile(
    r"\b(?:should|shall|can|could|must|do) (?:i|we)\b|\bnormal\b|\bdangerous\b|\bis it (?:ok|okay|safe|bad)\b|\bhow (?:many|much)\b|\bdo you think\b|\bwhat helps\b"
)
"""Words that ask for advice."""
_HELPERS = word_set("doctor hospital ambulance nurse medicine help emergency clinic")
_REFERRING = word_set("he him his she her it they them this")
"""Words that may mean the patient or the illness of the sentence before."""
_JUDGING = frozenset(("think", "feel", "know"))
"""Verbs of questions such as *what do you think about jazz*."""


@dataclass(frozen=True, slots=True)
class Heard:
    """An utterance of the user."""

    text: str
    seen: Analysis | None = None
    user: str = ""
    """The user's name, if it is known."""


@dataclass(slots=True)
class Hearing:
    """An utterance as the table of answers sees it. The head of order.yaml explains the tags."""

    tags: set[str]
    values: dict[str, str] = field(default_factory=dict[str, str])
    """The values of the roles."""
    tongue: str = ""
    thing: str = ""
    """The thing about which the user asks the agent's opinion."""
    asking: str = ""
    """The sentence that asks something."""
    asked: Asked | None = None
    options: tuple[str, str] | None = None
    """The options that the user names."""
    tone: str = ""
    """The tone of the utterance; empty if it is unknown."""
    lasts: int = 0
    """The number of turns for which the tone lasts."""
    responses: list[Response] = field(default_factory=list[Response])
    """The replies that suit the utterance, the best first."""

    def leave_out(self, said: str, area: str) -> None:
        """Remove the replies of the same kind as the agent's answer `said`, and the answers for the area of life `area`."""
        kind = next((one.kind.name for one in self.responses if said.endswith(one.line.text)), "")
        self.responses = [one for one in self.responses if one.kind.name != kind]
        if self.asked is not None and self.asked.area is not None and self.asked.area.name == area:
            self.asked = replace(self.asked, area=None)


def hear(phrases: Material, heard: Heard, state: State) -> Hearing:
    """Return the tags, roles and replies of an utterance."""
    seen, text = heard.seen, heard.text
    tongue = tongue_of(text, phrases.tongues)
    signs = {"number": is_number(text), "foreign": tongue != "", "nonsense": is_nonsense(text)}
    signs |= {"signs": not any(map(str.isalnum, text)), "asking": text.rstrip().endswith("?")}
    signs |= {"unparsed": seen is None, "emergency": is_emergency(text)}
    signs |= {"crisis": is_crisis(text) or state.danger == DANGER, "endangered": state.danger > 0}
    found = Hearing({tag for tag, holds in signs.items() if holds}, tongue=tongue)
    if seen is not None:
        _understand(found, phrases, heard, seen, state)
    return found


def _understand(found: Hearing, phrases: Material, heard: Heard, seen: Analysis, state: State) -> None:
    asking = found.asking = asking_sentence(seen)
    request = is_request(seen) and seen.question is None
    found.options = options_between(seen.tree)
    found.asked = asked_in(phrases, seen, asking, state, likely(seen), request=request)
    last = state.said[-1] if state.said else ""
    found.values = dict(found.asked.values) if found.asked else {}
    found.tone, found.lasts = heard_tone(seen)
    joy = seen.move is not None and seen.move.name == "rejoice" and seen.move.score >= SETTLED
    if found.tone == "funny" or (state.tone == "sad" and found.tone == "glad" and not joy):
        found.tone = ""  # a funny story leaves no tone behind
    before = normalise(state.before).unguessed
    without = unsuited(seen, found.tone, state.tone, joy=joy)
    found.responses = responses_to(phrases, seen.normal.unguessed, before, last, without=without)
    leaves = replies().kinds(seen.normal.unguessed, before, last).get("leaves", 0.0)
    size = sum(word.pos != "PUNCT" for word in seen.tree.words)
    answer = seen.yesno
    kind = "yes" if answer.yes else "no" if answer.no else "unsure" if answer.unsure and size <= SHORT else ""
    low = {word.low for word in seen.tree.words}
    tags = {
        kind: True,
        "answering": state.pending is not None and seen.question is None and size <= SHORT and not request,
        "shown": bool(state.said and state.shown) and last.endswith(state.shown[-1]),
        "more": "tell_more" in seen.acts or ("then" in low and size <= SHORT),
        "leaving": (not asking or _echoes(asking)) and (is_leaving(seen.text) or _leaves(seen) or leaves >= PARTING),
        "silencing": "stop" in seen.acts and not _QUESTIONS.isdisjoint(low),
        "news": bool(seen.sentences) and is_news(seen.sentences[-1]) and "sad" not in (found.tone, state.tone),
        "cry": is_cry(seen.text),
        "request": request and len(seen.sentences) == 1,
        "asked": found.asked is not None,
        "medical": _is_medical(phrases, seen, state, asking),
        "again": found.asked is not None and bool({"another", "meant"} & seen.asks.keys()) and state.asked is not None,
        "wording": found.asked is not None and found.asked.kind in WORDING,
        found.asked.kind if found.asked else "": True,
        "broken": _is_broken(seen, size),
        "weak": not found.responses or found.responses[0].weak,
        **dict.fromkeys(() if replies().loaded else seen.acts, True),
    }
    if asking:
        tags |= _question_tags(found, phrases, seen, asking)
    found.tags |= {tag for tag, holds in tags.items() if holds}


def unsuited(seen: Analysis, tone: str, lately: str, *, joy: bool = False) -> frozenset[str]:
    """Return the tones of replies that do not suit an utterance.

    Args:
        seen: The analysis of the utterance.
        tone: The tone of the utterance.
        lately: The tone of the conversation. If it is sad, only joy gets a cheerful reply, and nothing gets a funny one.
        joy: Whether a good listener would surely rejoice.
    """
    text, move = seen.normal.text, seen.move
    grave = is_grave(text) or is_medical(text) or is_crisis(text)
    grave = grave or (move is not None and move.name in GRIEVING and move.score >= SETTLED)
    if grave or tone in DARK or (lately == "sad" and not joy):
        return frozenset(LIGHT)
    return frozenset(("sad",) * (tone == "glad") + ("funny",) * (lately == "sad"))


def _is_medical(phrases: Material, seen: Analysis, state: State, asking: str) -> bool:
    """Return whether the user wants advice about an illness or injury, perhaps one that they mentioned just before."""
    if not asking or not (seen.advised or _ADVISED.search(plain(asking))):
        return False
    words = words_of(seen.tree, asking)
    nouns = {word.lemma.lower() for word in words if word.pos in ("NOUN", "PROPN")} - _HELPERS
    if nouns and {word.low for word in words}.isdisjoint(_REFERRING):
        return is_medical(seen.normal.text)  # "what should I cook tonight?" after a fever
    last = state.said[-1] if state.said else ""
    lately = any(last.endswith(line.text) for lines in phrases.plain["medical"].groups.values() for line in lines)
    return lately or is_medical(f"{state.before} {seen.normal.text}")


def _leaves(seen: Analysis) -> bool:
    """Return whether an utterance ends with a farewell: *that helped a bit. she's waking up, gotta run*."""
    match = seen.acts.get("farewell")
    return match is not None and match.score >= MEANT and plain(seen.text).endswith(f" {plain(match.text)}")


def _echoes(asking: str) -> bool:
    """Return whether a question only repeats words in surprise: *that late?*"""
    words = plain(asking).split()
    return len(words) <= BARE and QUESTION_WORDS.keys().isdisjoint(words)


def likely(seen: Analysis) -> tuple[str, ...]:
    """Return the agent's likeliest next move, and also the second likeliest if the first is not likely enough."""
    move = seen.move
    if move is None:
        return ()
    return (move.name,) if move.score >= SETTLED else (move.name, move.second)


def _question_tags(found: Hearing, phrases: Material, seen: Analysis, asking: str) -> dict[str, bool]:
    asked = next((one for one in seen.statements if one.question), None)
    subject = "" if asked is None else asked.subject_person
    judged = _about_in(seen)
    judged = judged if judged.split()[-1:] and judged.split()[-1].lower() in asking.lower() else ""
    found.thing = judged or thing_in(seen)
    polar, modal = seen.question is QuestionWord.YES_NO, any(word.tag == "MD" for word in seen.tree.words)
    opining = asked is not None and subject == "you" and asked.verb in phrases.plain["opining"].words
    return {
        "question": True,
        "offer": _OFFER.match(asking) is not None,
        "machine": any(not _MACHINES.isdisjoint(one.lower().split()) for one in found.options or ()),
        "are_you": polar and not modal and subject == "you" and asked is not None and asked.verb == "be",
        "taste": found.thing != ""
        and not found.thing.startswith("your ")
        and not any(one.label == "PERSON" and one.text.lower() in found.thing.lower() for one in seen.entities)
        and (opining or (judged != "" and asked is not None and asked.verb in _JUDGING)),
    }


def _is_broken(seen: Analysis, size: int) -> bool:
    """Return whether an utterance breaks off: *wait, she is*."""
    words = [word for word in seen.tree.words if word.pos != "PUNCT"]
    return (
        1 < size <= SHORT
        and seen.question is None
        and words[-1].low in _UNENDING
        and not seen.text.rstrip().endswith((".", "!", "?"))
    )


def _about_in(seen: Analysis) -> str:
    """Return the noun of *what do you think of jazz*."""
    for word in seen.tree.words:
        if word.dep in ("pobj", "pcomp") and seen.tree.head(word).low in ("of", "about", "on"):
            return turned(seen.tree, [part for part in seen.tree.subtree(word) if part.dep != "punct"])
    return ""
