"""Repair: the user corrects or questions the agent's last answer, as in *no, I meant the bread*.

The skill briefly admits its mistake, and then answers what the user meant.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from ravestate.language.normal import plain
from ravestate.modules.meta.nlp.analysis import Analysis

from .roles import TURNED
from .state import State

LONGEST = 9
"""The maximum number of words of a sentence such as *I meant the bread*, if nothing else shows a repair. A sentence that
rejects or questions the answer may have three more words."""
_LEAD = re.compile(r"^(?:(?:no|nope|wait|oh|but|well|huh|um|uh|eh|hey|sorry|hm+|and|ok|okay|again) )+")
_MEANT = re.compile(
    r"^i (?:(?P<firm>meant|was (?:asking|talking|speaking)(?: you)?|am (?:asking|talking)|asked(?: you)? (?=about|for|if|whether))"
    r"|mean|said|asked(?: you)?|talked|spoke|wanted to know)(?: (?:about|for|of|that|whether|if))* (?P<what>(?!to\b|it\b|so\b|that\b|this\b|not\b"
    r"|something\b|yes\b|no\b|nothing\b).+)$"
)
"""A sentence in plain form (lower case, no punctuation; see `plain`) that says what the user meant."""
_TOLD_TO = re.compile(r"\b(?:with|to) (?:my|a|the|him|her|them|somebody|some)\b|\b(?:yesterday|last|ago|today)\b")
"""Words of a report: *I was talking about it with my mother*."""
_REJECTS = re.compile(
    r"^(?:that|this|it) (?:is|was) (?:not (?:what|about|an answer|my|the)|(?:for |about )?(?:\w+ ){0,2}(?:advice|tip|answer|question"
    r"|line|reply|recipe)\b|(?:about|for) (?P<of>\w+)(?: \w+)?$)"
    r"|^i (?:did not|was not|never|do not) (?:\w+ )?(?:ask|asking|mean|talk|talking|speak|speaking|(?:say|said)(?! (?:anything|nothing|a word|much|(?:\w+ )?to (?:any|no)(?:one|body))))\b"
    r"|^you (?:misunderst|got (?:me|it|that) wrong|are not listening|did not answer|ignored)"
    r"|^(?:that|this|it) (?:makes|made) no sense|^(?:you are|that is) (?:off|beside) "
)
_PUZZLED = re.compile(
    r"^(?:what|huh|pardon|eh|come again|what what|say what)$|^what(?: on earth)? (?:has|does|do|have|is|did)\b.*\b(?:to )?do with\b"
    r"|^(?:what|who)(?: on earth)? are you (?:talking|on|going on)(?: about)?$|^what (?:do|did|are) you (?:mean|meaning|trying to say)\b"
    r"|^what is that supposed to mean$|^(?:do|did|does|made|make|go|going|know|knows|have|has|are|is|was|tell|told|say|said|for|with|about"
    r"|get|take|see|another) (?:\w+ ){0,3}(?:what|who|whom|where|which)$|^(?:which|what) (?P<noun>\w+)$"
    r"|^(?P<echoed>\w+)(?: \w+){0,2} (?:what|who|whom|where|which)$"
)
_REPEATED = re.compile(
    r"^you (?:have |just )*already (?:said|told|asked)\b|^(?:you|that is what you) (?:just |have |already )*(?:said|told me|asked|asked me|say)(?: me)? (?:that|this|so|it)?(?: \w+)?"
    r"(?:already|before|twice|again|just now)$|^you (?:just |only |always |keep |are (?:just )?)*(?:repeat|repeated|repeating)\b"
    r"|^(?:the )?same (?:sentence|answer|thing|line)(?: as before| again)?$"
)
_CLAUSES = re.compile(r"[,;] (?=(?:i|that|what) )", re.IGNORECASE)
_ALARMS = ("what", "huh", "no", "wait", "sorry", "um")
_WHY = re.compile(r"^(?:but )?(?:why|how come|what for|why so)$")
_CLAUSE = re.compile(
    r"^(?:what|who|where|when|why|how|which|can|should|do|does|is|are|will|would)\b|^(?:i|we|he|she|they|you|it) \w+ \w+"
)


@dataclass(frozen=True, slots=True)
class Repair:
    """A correction of the agent's last answer, or a question about it."""

    kind: str
    """``meant``: the user rejects the answer, or says what they meant; ``puzzled``: they don't understand the answer;
    ``repeated``: they say that the agent repeats itself; ``why``: they ask why, and say something else."""
    again: str = ""
    """The words to answer now; empty if the user only complains."""
    thing: str = ""
    """The thing that the user meant: *the night bus*."""


def repair_in(seen: Analysis, state: State) -> Repair | None:
    """Return how an utterance corrects or questions the agent's last answer; None if it does neither."""
    if not state.said:
        return None
    parts = [part for one in seen.sentences[:5] for part in _CLAUSES.split(one)]
    for place in range(len(parts) - 1):
        if plain(parts[place]).endswith(("i meant", "i mean")):  # "No, I meant. What can I plant?"
            parts[place : place + 2] = [f"{parts[place].rstrip('.,')} {parts[place + 1]}"]
            break
    texts = [_LEAD.sub("", f"{plain(one)} ").strip() or plain(one) for one in parts]
    leads = [
        plain(one) != text or (place > 0 and plain(parts[place - 1]) in _ALARMS)
        for place, (one, text) in enumerate(zip(parts, texts, strict=True))
    ]
    marks = [_mark(one, state) for one in texts]
    if not any(marks) and not any(_MEANT.search(one) for one in texts):
        return None
    rejected = any(marks)
    rest = [one for one, text, mark in zip(parts, texts, marks, strict=True) if not mark and len(text.split()) > 2]
    for place, text in enumerate(texts):
        found = _MEANT.search(text)
        report = found and _TOLD_TO.search(found["what"]) and not rejected
        if found and not report and (rejected or leads[place] or (found["firm"] and len(text.split()) <= LONGEST)):
            return _meant(found["what"], rest, parts[place], state)
    first = next((mark for mark in marks if mark), "")
    if not first:
        return None
    again = " ".join(rest)
    return Repair(first, again) if again or first != "why" else None


def may_repair(seen: Analysis) -> bool:
    """Return whether an utterance may be a repair. Whether it is one depends on the agent's last answer."""
    return repair_in(seen, State(said=(seen.text,))) is not None


def _meant(what: str, rest: Sequence[str], own: str, state: State) -> Repair:
    others = [one for one in rest if one != own]
    if what in ("me", "us", "myself"):
        return Repair("meant", " ".join(others))
    if _CLAUSE.search(what):
        return Repair("meant", " ".join((what, *others)))
    before = state.before
    last = what.split()[-1].removesuffix("s")
    parts = [one for one in re.split(r"(?<=[.!?;])\s+|,? (?:and|but) (?=i\b)", before) if last in one.lower()]
    again = parts[-1] if parts and not before.rstrip().endswith("?") else before
    return Repair(
        "meant",
        " ".join((again, *others)) if parts or _asks(before) else " ".join(others),
        " ".join(TURNED.get(word, word) for word in what.split()),
    )


def _asks(text: str) -> bool:
    return text.rstrip().endswith("?") or bool(
        _CLAUSE.search(plain(text)) and not re.match(r"(?:i|we|he|she|they|you|it)\b", plain(text))
    )


def _mark(text: str, state: State) -> str:
    """Take a sentence in plain form, and return which kind of repair it is; empty if it is none."""
    if _REPEATED.search(text):
        return "repeated"
    if _WHY.search(text):
        return "" if state.said[-1].endswith("?") else "why"
    if len(text.split()) > LONGEST + 3:
        return ""
    if (rejects := _REJECTS.search(text)) and (not rejects["of"] or rejects["of"] in plain(state.said[-1]).split()):
        return "meant"  # "that was for dogs", after an answer about dogs
    puzzled = _PUZZLED.search(text)
    if puzzled is None:
        return ""
    if puzzled["echoed"] and puzzled["echoed"] not in plain(state.said[-1]).split():
        return ""
    noun = puzzled["noun"]
    return (
        "" if noun and (noun not in plain(state.said[-1]).split() or noun in plain(state.before).split()) else "puzzled"
    )
