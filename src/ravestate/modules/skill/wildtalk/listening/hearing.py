"""The *tags* and *roles* that the listener notices in an utterance.

The listener is the part that chooses the agent's reply. The tags select rows of the table of answers (order.yaml), and the
roles fill its phrases. meaning.py finds the feelings, acts and moments; responses.py finds the replies that suit. The
*bank* (bank.py) has thousands of utterances with replies.

A *moment* is a situation in a conversation that has its own phrases, such as good news. A *move* is the next step of a
good listener, such as to console. A *role* is a placeholder in a phrase. An *act* is what an utterance does, such as
thanking. The *tone* of a conversation is sad, angry, glad or tired.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from ravestate.language.acts import is_playful
from ravestate.language.contractions import word_set
from ravestate.language.nonsense import is_nonsense
from ravestate.language.normal import normalise, plain
from ravestate.modules.meta.nlp.analysis import ADVICE, Analysis
from ravestate.modules.meta.nlp.question_word import QUESTION_WORDS, QuestionWord
from ravestate.modules.meta.nlp.statement import Statement

from .asked import WORDING, Asked, asked_in, options_between
from .asking import FEW_WORDS, SHORT, asking_sentence, kind_of
from .bank import CLOSE, Found
from .echo import words_of
from .following import follow_up_in, rest_of
from .grave import is_grave, is_medical
from .lookup import ALIKE, KNOWN, is_dark, near_in
from .material import Material
from .meaning import BRIEFLY, EXACT, MEANT, SAD, SURE, TURNED, feeling_of, fits_move, meanings_of, moment_of
from .moment import Moment
from .responses import LEAST, Response, responses_to, surely_suits
from .responses import SURE as SUITED
from .roles import Roles, has_verb, is_request, roles_of, turned
from .state import State
from .taking_up import Taken, taken_from
from .tones import may_be_dark, tone_of
from .tongue import is_number, tongue_of
from .turns import is_leaving, turns_in

CHANGING = "no_questions"
"""The moment in which the user wants no more questions. It takes precedence over all entries of the bank."""
BARE = 3
"""If an answer only says yes, no or unsure, and has at most this many words, the bank's entries do not count."""
PARTING = 0.66
"""If the classifier is at least this confident that the next move is a farewell, a short utterance itself counts as
one."""
SHORTLY = 7
"""If a statement has at most this many words, the agent may repeat it as a whole."""
LONG = 12
"""If an utterance has at least this many words, it probably gives the reason for the user's feeling."""
UNKNOWN = ("heard_of", "about_you")
"""Kinds of questions (asks.yaml) to which this skill has an answer only if their area of life (areas.yaml) has one.
Otherwise only another module can answer."""
_OFFER = re.compile(r"(?:do you want|would you like|shall i|can i).{0,9} (?:know|hear|see|tell|show)\b", re.IGNORECASE)
"""The user offers to tell the agent something."""
_MACHINES = word_set("robot bot machine computer program ai chatbot")
_UNENDING = word_set("and but or because if the a an my your is 's are 're 'm to")
"""Function words that cannot end an utterance."""
_ADVISED = re.compile(
    r"\b(?:should|shall|can|could|must|do) (?:i|we)\b|\bnormal\b|\bdangerous\b|\bdo you think\b|\bwhat helps\b"
)
"""Words that ask for advice."""
_HELPERS = word_set("doctor hospital ambulance nurse medicine help emergency clinic")
_REFERRING = word_set("he him his she her it they them this")
"""Words that may mean the patient or the illness of the sentence before."""
_JUDGING = frozenset(("think", "feel", "know"))
"""Verbs of questions such as *what do you think about jazz*."""
_THIRD = frozenset(("he", "she", "they"))


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
    roles: Roles = field(default_factory=Roles)
    tongue: str = ""
    meanings: list[Moment] = field(default_factory=list[Moment])
    """The feelings, acts and moments that may decide the answer, best first."""
    moment: str = ""
    """The name of the moment that the utterance resembles most, even if only a little."""
    moves: tuple[str, ...] = ()
    """The agent's next moves, the likeliest first: one, or two if both are likely; none if no move is known."""
    thing: str = ""
    """The thing about which the user asks the agent's opinion."""
    asking: str = ""
    """The sentence that asks something."""
    asked: Asked | None = None
    options: tuple[str, str] | None = None
    """The options that the user names."""
    taken: Taken | None = None
    """The statement that the agent can take up."""
    tone: str = ""
    """The tone of the utterance; empty if it is unknown."""
    mood: str = ""
    """The tone of the utterance; but ``quiet`` if the conversation is sad, and the utterance is glad, funny or neutral."""
    near: list[Found] = field(default_factory=list[Found])
    """The entries of the bank that resemble the utterance, the most suitable first."""
    responses: list[Response] = field(default_factory=list[Response])
    """The replies that suit the utterance, the best first."""
    follow_up: Moment | None = None
    """The follow-up that the utterance resembles. It belongs to the entry whose reply the agent gave last, or to an earlier
one."""
    rest: Moment | None = None
    """The last entry's follow-up for statements that resemble none of its follow-ups."""
    sad: bool = False
    """Whether the utterance has a sad feeling."""

    def leave_out(self, moment: str, area: str) -> None:
        """Remove the answers of a moment or an entry of the bank, and those of an area of life."""
        self.near = [one for one in self.near if one.moment.name != moment]
        self.meanings = [one for one in self.meanings if one.name != moment]
        self.responses = [one for one in self.responses if one.kind.name != moment]
        if not surely_suits(self.responses):
            self.tags -= {"responsive"}
        if not self.near or self.near[0].fit < ALIKE:
            self.tags -= {"alike"}
        if self.asked is not None and self.asked.area is not None and self.asked.area.name == area:
            self.asked = replace(self.asked, area=None)


def hear(phrases: Material, heard: Heard, state: State) -> Hearing:
    """Return the tags, roles and meanings of an utterance."""
    seen, text = heard.seen, heard.text
    tongue = tongue_of(text, phrases.tongues)
    signs = {"number": is_number(text), "foreign": tongue != "", "nonsense": is_nonsense(text)}
    signs |= {"signs": not any(map(str.isalnum, text)), "asking": text.rstrip().endswith("?")}
    signs |= {"unparsed": seen is None, state.tone: True, "tone": state.tone != ""}
    found = Hearing({tag for tag, holds in signs.items() if holds}, tongue=tongue)
    if seen is not None:
        _understand(found, phrases, heard, seen, state)
    return found


def _understand(found: Hearing, phrases: Material, heard: Heard, seen: Analysis, state: State) -> None:
    asking = found.asking = asking_sentence(seen)
    found.moves = likely(phrases, seen)
    if state.said and state.shown and state.said[-1].endswith(state.shown[-1]):
        found.tags.add("shown")
    request = is_request(seen) and seen.question is None
    found.taken = None if asking or request else taken_from(seen, phrases.living, state.before)
    found.options = options_between(seen.tree)
    found.asked = asked_in(phrases, seen, asking, state, found.moves, request=request)
    moment, sentence, score = moment_of(phrases, seen, found.tags, found.moves, found.asked, asking)
    feeling, sentence = feeling_of(phrases, seen, sentence, state.tone)
    if feeling is not None and asking and feeling.tone != "sad":
        match = seen.feelings[feeling.name]
        feeling = feeling if match.score >= TURNED and match.text not in asking else None
    if feeling is not None and not fits_move(feeling, found.moves):
        feeling = None
    roles = roles_of(seen, asking or sentence, state.being, phrases)
    last = state.said[-1] if state.said else ""
    entry = phrases.bank.named.get(state.moment)
    advised = state.moment in ADVICE or (entry is not None and kind_of(entry.examples[0]) in ADVICE)
    roles = roles.having(
        user=heard.user, last="" if last.endswith("?") else last, ground=state.ground if advised else ""
    )
    statement = roles.statement
    found.moment = "" if moment is None else moment.name
    found.meanings = meanings_of(phrases, seen, state.tone, found.moves, moment, score, feeling, asking)
    found.sad = feeling is not None and feeling.tone == "sad"
    found.near = near_in(phrases, seen, asking, state, feeling, being=roles.being)
    dark = is_dark(seen, found.near) or found.sad
    before = normalise(state.before).unguessed
    sad = state.tone == "sad" and "rejoice" not in found.moves  # soon after a loss, only clear joy gets a glad reply
    found.responses = responses_to(phrases, seen.normal.unguessed, before, dark=dark or sad)
    found.tone = "sad" if dark else _tone(seen, found.moves, feeling)
    found.mood = "quiet" if state.tone == "sad" and found.tone in ("", "glad", "funny") else found.tone
    nearest = found.near[0] if found.near else Found(0.0, 0.0, Moment("", {}), "")
    found.follow_up = follow_up_in(
        phrases.bank, state, seen, asking, nearest if nearest.fit >= ALIKE else None, dark=dark
    )
    found.rest = None if dark else rest_of(phrases.bank, state, seen)
    size = sum(word.pos != "PUNCT" for word in seen.tree.words)
    pending, answer, verb = state.pending, seen.yesno, has_verb(seen)
    low = {word.low for word in seen.tree.words}
    others = bool(low & {*_THIRD, "we"}) or any(one.subject.head for one in seen.statements)
    answering = pending is not None and seen.question is None and size <= 2 * SHORT and not is_request(seen)
    kind = "yes" if answer.yes else "no" if answer.no else "unsure" if answer.unsure and size <= SHORT else ""
    called = _called_in(seen, statement)
    grounded = found.moment == "just_why" and "ground" in roles.values
    bound = score >= SURE and (found.moment == CHANGING or grounded)
    kin = feeling is not None and roles.being is not None and size <= BRIEFLY  # "my mother is ill"
    specific = not (bound or (kind and size <= BARE))
    alike = (
        nearest.fit >= ALIKE
        and specific
        and (bool(nearest.moment.follows) or nearest.score >= EXACT or not (score >= EXACT or kin))
    )
    tags = {
        kind: True,
        "followed": found.follow_up is not None,
        "other": found.rest is not None
        and not (asking or is_request(seen) or feeling or found.meanings or answer.unsure)
        and not (alike and (size > SHORT or nearest.score >= CLOSE)),
        "dark": dark,
        "grave": is_grave(seen.normal.text) and (size <= SHORT * 2 or found.tone == "sad"),
        "pending": pending is not None,
        "closed": pending is not None and pending.closed,
        "answering": answering,
        "more": "tell_more" in seen.acts or ("then" in low and size <= SHORT),
        "few": size <= FEW_WORDS,
        "long": size >= LONG,
        "short": size <= SHORT,
        "teased": "insult" in seen.acts and is_playful(seen.text),
        "leaving": (not asking or _echoes(asking)) and (is_leaving(seen.text) or _leaves(seen) or _parts(seen, size)),
        "verb": verb and seen.question is None,
        "acting": bool(seen.acts.keys() - {"contradiction"}),
        "felt": feeling is not None,
        "sorry": not SAD.isdisjoint(seen.feelings),
        "sure": score >= SURE,
        "alike": alike,
        "others": others,
        "asserting": verb and others,
        "called": called != "",
        "request": request and len(seen.sentences) == 1,
        "asked": found.asked is not None,
        "advised": seen.advised,
        "medical": _is_medical(phrases, seen, state, asking)
        and not (alike and any(map(is_medical, nearest.moment.examples))),
        "again": found.asked is not None and bool({"another", "meant"} & seen.asks.keys()) and state.asked is not None,
        "wording": found.asked is not None and found.asked.kind in WORDING,
        "guessed": state.moment == "guess" and not asking and "contradiction" not in seen.acts,
        found.asked.kind if found.asked else "": True,
        "echoed": found.taken is not None,
        "addressed": found.taken is not None and found.taken.told.subject == "yours",
        "settled": len(found.moves) == 1,
        "responsive": surely_suits(found.responses, LEAST if _knows_nothing(found.asked) else SUITED)
        and specific
        and not kin
        and nearest.fit < KNOWN,
        "broken": _is_broken(seen, size),
        **dict.fromkeys((*found.moves, *turns_in(seen.text, seen.sentences)), True),
    }  # fmt: skip
    if asking:
        tags |= _question_tags(found, phrases, seen, asking, low)
    elif statement is not None:
        tags |= _statement_tags(phrases, seen, statement, roles)
    found.tags |= {tag for tag, holds in tags.items() if holds}
    found.roles = roles.having(
        called=called,
        told=found.taken.told.echo if found.taken and len(found.taken.told.echo.split()) <= SHORTLY else "",
        highlight=found.taken.highlight if found.taken else "",
        **(found.asked.values if found.asked else {}),
    )


def _knows_nothing(asked: Asked | None) -> bool:
    """Return whether the only answer to a question is that the agent does not know: *did you hear that racket?*"""
    return asked is not None and asked.kind in UNKNOWN and not asked.own


def _tone(seen: Analysis, moves: Sequence[str], feeling: Moment | None) -> str:
    """Return the tone of an utterance that is not grave."""
    if feeling is not None and feeling.tone:
        return feeling.tone
    tone = tone_of(seen.text)
    if tone == "glad" and moves and "rejoice" not in moves:
        return ""  # "we tried everything": the classifier of tones alone is too often wrong
    return tone or ("glad" if moves == ("rejoice",) and not may_be_dark(seen.text) else "")


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


def _parts(seen: Analysis, size: int) -> bool:
    """Return whether the next move after a short utterance is very likely a farewell: *cheers, gotta get the bus*."""
    return seen.move is not None and seen.move.name == "farewell" and seen.move.score >= PARTING and size <= LONG


def _echoes(asking: str) -> bool:
    """Return whether a question only repeats words in surprise: *that late?*"""
    words = plain(asking).split()
    return len(words) <= BARE and QUESTION_WORDS.keys().isdisjoint(words)


def likely(phrases: Material, seen: Analysis) -> tuple[str, ...]:
    """Return the agent's likeliest next move, and also the second likeliest if the first is not likely enough."""
    move = seen.move
    if move is None:
        return ()
    return (move.name,) if move.score >= phrases.replies[move.name].least else (move.name, move.second)


def _question_tags(found: Hearing, phrases: Material, seen: Analysis, asking: str, low: set[str]) -> dict[str, bool]:
    asked = next((one for one in seen.statements if one.question), None)
    subject = "" if asked is None else asked.subject_person
    judged = _about_in(seen)
    judged = judged if judged.split()[-1:] and judged.split()[-1].lower() in asking.lower() else ""
    found.thing = judged or roles_of(seen, "", None, phrases).values.get("thing", "")
    polar, modal = seen.question is QuestionWord.YES_NO, any(word.tag == "MD" for word in seen.tree.words)
    mine = asked is not None and (asked.subject.of("I") or asked.object.of("I"))
    opining = asked is not None and subject == "you" and asked.verb in phrases.plain["opining"].words
    return {
        "question": True,
        "offer": _OFFER.match(asking) is not None,
        "machine": any(not _MACHINES.isdisjoint(one.lower().split()) for one in found.options or ()),
        "are_you": polar and not modal and subject == "you" and asked is not None and asked.verb == "be",
        "told": found.moves == ("recall",)
        and (
            (not polar and (mine or subject == "I") and subject != "you" and not modal)
            or bool({"remember", "recall"} & low and "you" in low)
            or ("know" in low and subject == "you" and "my" in low)
        ),
        "taste": found.thing != ""
        and not found.thing.startswith("your ")
        and (opining or (judged != "" and asked is not None and asked.verb in _JUDGING)),
    }


def _statement_tags(phrases: Material, seen: Analysis, statement: Statement, roles: Roles) -> dict[str, bool]:
    return {
        "living": is_living(phrases, statement) and "they" in roles.values,
        "past": is_past(statement.verb, seen),
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


def is_living(phrases: Material, statement: Statement) -> bool:
    """Return whether a statement is about somebody other than the user and the agent."""
    subject = statement.subject
    if subject.of("you") or subject.person != "other":
        return False
    return subject.head in phrases.beings or bool(subject.names) or subject.text.lower() in _THIRD


def is_past(verb: str, seen: Analysis) -> bool:
    """Return whether the clause of a verb is in the past tense."""
    return any(
        "VBD" in (word.tag, *(part.tag for part in seen.tree.children(word, "aux", "auxpass")))
        for word in seen.tree.words
        if word.lemma == verb
    )


def _called_in(seen: Analysis, statement: Statement | None) -> str:
    """Return the name in *his name is Rex* and *the boat was called Rex*."""
    if statement is None or statement.question or (statement.subject.of("I") and statement.subject.head == "name"):
        return ""
    if statement.subject.head == "name":
        return statement.object.text
    named = [word for word in seen.tree.words if word.low in ("called", "named") and word.dep == "ROOT"]
    passive = [word for word in named if seen.tree.children(word, "auxpass")]
    return seen.tree.phrase(seen.tree.children_of(passive, "oprd")) if statement.subject_person == "other" else ""


def _about_in(seen: Analysis) -> str:
    """Return the noun of *what do you think of jazz*."""
    for word in seen.tree.words:
        if word.dep in ("pobj", "pcomp") and seen.tree.head(word).low in ("of", "about", "on"):
            return turned(seen.tree, [part for part in seen.tree.subtree(word) if part.dep != "punct"])
    return ""
