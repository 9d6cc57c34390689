"""Recognise a wish for quiet, a goodbye, and the agent's questions (English, German)."""

from __future__ import annotations

import re

from ravestate.modules._courtesy import COURTESY

LONGEST = 1000
"""The characters of an utterance that the functions read."""

_SENTENCE = re.compile(r"[^.!?,;…\n]+")
_POLITE = (
    r"(?:(?:please|bitte|now|just|oh|ok|okay|hey|well|and|for god's sake|i said|i want you to|you should|"
    r"(?:will|would|could|can) you)\s+)*"
)
_AFTER = (
    r"(?:\s+(?:please|now|already|will you|right now|at once|for (?:a|one) (?:bit|while|moment|minute|second)|robot|man|"
    r"you \w+|bitte|jetzt|endlich))*"
)
_QUIET = re.compile(
    rf"{_POLITE}(?:(?:just )?shut (?:the \w+ )?up|shut (?:it|your \w+)|(?:be|keep|stay) (?:quiet|silent|still)|quiet|silence|"
    r"hush|shush|sh+|hold your tongue|stop(?: (?:it|that|this))?|stop (?:talking|speaking|chatting|asking|it)(?: to me| me)?|"
    r"(?:that(?: is|'s) )?enough|leave me (?:alone|in peace)|(?:do not|don't|dont) (?:talk|speak)(?: to me)?(?: any ?more)?|"
    rf"sei (?:still|leise|ruhig)|halt den mund|ruhe|hör auf|lass mich in ruhe){_AFTER}",
    re.IGNORECASE,
)
_LEAVE = re.compile(
    rf"{COURTESY}(?:(?:good ?)?bye+(?:[ -]bye+)?|good night|see (?:you|ya)|farewell|"
    r"cheerio|ciao|take care|so long|until (?:next time|tomorrow)|i(?:'m| am) (?:off|leaving)|"
    r"(?:i (?:have to|must|need to|gotta|should)|i've got to) (?:go|leave)(?! to)|"
    r"tschüss?|auf wiedersehen|gute nacht|bis (?:bald|morgen|später))\b(?:\W+\w+){0,4}\W*",
    re.IGNORECASE,
)
_QUESTION = re.compile(r"[^.!?…\n]+\?(?=\W*$)")


def asks_for_quiet(text: str) -> bool:
    """Return whether the user wants the agent to be quiet.

    Example:
        >>> asks_for_quiet("Please be quiet!"), asks_for_quiet("It is quiet here.")
        (True, False)
    """
    return any(_QUIET.fullmatch(sentence.strip()) for sentence in _SENTENCE.findall(text[:LONGEST]))


def takes_leave(text: str) -> bool:
    """Return whether the user says goodbye and little else.

    Example:
        >>> takes_leave("Okay, bye!"), takes_leave("Bye the way, who are you?")
        (True, False)
    """
    if "?" in text or len(text) > LONGEST:
        return False
    sentences = [sentence.strip() for sentence in _SENTENCE.findall(text) if sentence.strip()]
    return any(_LEAVE.fullmatch(sentence) for sentence in sentences[-2:])


def last_question(text: str) -> str:
    """Return the question at the end of a text; empty if there is none.

    Example:
        >>> last_question("I am fine. And you? 😊"), last_question("Who? Me.")
        ('And you?', '')
    """
    found = _QUESTION.search(text[-LONGEST:])
    return found[0].strip() if found else ""
