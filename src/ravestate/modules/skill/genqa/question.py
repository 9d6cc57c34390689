"""The question in an utterance, its words, and whether documents can answer it."""

from __future__ import annotations

import re
from dataclasses import dataclass

from ravestate.modules._text import printable

LONGEST = 2000
"""The maximum length of an utterance in characters; a longer one is not a question about the world."""

_FRONT = re.compile(
    r"^(?:(?:so|and|but|well|ok|okay|oh|hey|hi|hello|hm+|um|uh|please|now|then|actually|by the way|tell me|excuse me|"
    r"quick question|just curious|(?:i'?m|i am) curious|i was wondering|i wonder|i(?:'d| would) like to know|i want to know|"
    r"(?:can|could|would|will) you (?:please )?(?:tell|explain to|remind) (?:me|us)|do you (?:happen to )?know|did you know|"
    r"have you (?:any|got any|an) idea|any idea|let me know|what do you know about|what can you tell me about|"
    r"tell me about|if|whether)\b[\s,:;!.-]*)+",
    re.IGNORECASE,
)
_SENTENCE = re.compile(r"(?<=[.!?])\s+")
_ASKS = re.compile(
    r"(?:who|whom|whose|what|which|when|where|why|how|is|are|was|were|do|does|did|has|have|can|in which|in what|on which)"
    r"(?:'s|'re|s)?\b",
    re.IGNORECASE,
)
# "You" and "I" for people in general: "how do you make ice cream", "how often must I descale the machine".
_ANYBODY = re.compile(
    r"\b(?:how|where|when|why|what) (?:do|can|could|would|should) you (?=make|cook|bake|build|say|find|get\b|see|call)|"
    r"\b(?:how(?: \w+)?|where) (?:can|could|must|should|do) i (?!live|look|feel|sound|know|work|like|come|seem|do\b|sleep|eat)|"
    r"\b(?:when|if) you (?=mix|add|heat|cool|divide|multiply|put|cut|freeze|boil)|"
    r"^(?:can|may|must|do) i (?=use|have to|need to|get|find|put|open|take|bring|park|pay)"
)
_PERSONAL = re.compile(r"\b(?:you|your|yours|yourself|u|ur|i|i'm|im|me|my|mine|myself|we both|between us)\b")
_NOW = re.compile(
    r"\b(?:today|tonight|tomorrow|yesterday|right now|at the moment|just now|this (?:morning|afternoon|evening|week|weekend|"
    r"month)|(?:last|next) (?:night|week|weekend|month)|latest|news|breaking|happening|live score)\b|"
    r"^(?:will|shall|is it going to|are we going to|is there going to)\b|"
    r"^is it (?:still )?(?:\w+ing|cold|warm|hot|sunny|late|early|nice|dark|windy|cloudy|monday|friday|sunday|weekend)\b|"
    r"^what(?:'s|s| is)? (?:the )?(?:time|date|day)(?: is it| it is)?\W*$|^(?:what|which) (?:time|day|date|month|year) is (?:it|this)|"
    r"^(?:what|how)(?:'s|s| is) the weather(?: like)?(?: here| outside)?\W*$|\bwho (?:won|is winning|will win)\b"
)
_OPINION = re.compile(
    r"\b(?:best|worst|nicest|better|worse|favou?rite|most beautiful|prettiest|coolest|ugliest|should)\b|"
    r"\bmeaning of life\b"
)
# Words of questions that mean nothing for the search.
_EMPTY_WORDS = """
    you i a an the this that these those some any and or but if of in on at by to for from with as into about than then
    is are was were be been being am do does did doing done has have had having can could will would shall should may might must
    s re ve ll d t m it its he she they them his her their there here we us our
    not no so too very really also just only ever exactly actually currently please again still yet now
    say mean kind kinds type types sort thing things something anything someone somebody one ones give get got go goes going come comes
    came make makes made like look looks
"""
# Words for the kind of answer: they help to find a passage, but the passage need not contain them.
_KIND_WORDS = """
    who whom whose what which when where why how many much old long far name names named call called tell know
    before become became gain gained live lives believe there time year day place way happen happens cause causes average
    total current national main major use used lie lies located situated
"""
_QUESTION_WORDS = frozenset(
    ("who", "whom", "whose", "what", "which", "when", "where", "why", "how", "many", "much", "tell", "know")
)
_EMPTY = frozenset(_EMPTY_WORDS.split())
_KINDS = frozenset(_KIND_WORDS.split())


@dataclass(frozen=True, slots=True)
class Question:
    """A question about the world."""

    text: str
    """The question alone."""
    words: tuple[str, ...] = ()
    """The words for its subject, in order, each once."""
    kinds: tuple[str, ...] = ()
    """The words for the kind of answer."""
    declined: str = ""
    """The reason why documents cannot answer it; empty if they may."""


def as_question(heard: str) -> Question:
    """Return the question in an utterance.

    Example:
        >>> as_question("Hello! Can you tell me what the capital of Peru is?").words
        ('capital', 'Peru')
        >>> as_question("What is your name?").declined
        'it is about the two who talk'
    """
    if len(heard) > LONGEST:
        return Question(heard[:LONGEST], declined="it is too long for a question")
    text = " ".join(printable(heard).replace("’", "'").split())
    sentences = [_FRONT.sub("", sentence) or sentence for sentence in _SENTENCE.split(text)]
    asking = [s for s in sentences if _ASKS.match(s)] or [s for s in sentences if s.endswith("?")] or sentences
    asked = asking[0]
    folded = asked.lower()
    said = dict.fromkeys(word for word in re.findall(r"[^\W_]+", asked) if word.lower() not in _EMPTY or word == "US")
    words = tuple(word for word in said if word.lower() not in _KINDS)
    kinds = tuple(word for word in said if word.lower() in _KINDS)
    if not words:  # "What is time?" has no other words
        words = tuple(word for word in kinds if word.lower() not in _QUESTION_WORDS)
    if _PERSONAL.search(_ANYBODY.sub("how ", folded)):
        return Question(asked, words, kinds, "it is about the two who talk")
    if _NOW.search(folded):
        return Question(asked, words, kinds, "it is about the moment, which documents do not know")
    if _OPINION.search(folded):
        return Question(asked, words, kinds, "it asks for an opinion")
    if not words:
        return Question(asked, words, kinds, "it has no word to look for")
    return Question(asked, words, kinds)


def is_vague(question: str) -> bool:
    """Return whether a question is about an *it* or *they*, and says little else.

    Example:
        >>> is_vague("Can they fly?"), is_vague("When did it start to rain?")
        (True, False)
    """
    return _SOMETHING.search(question) is not None and len(as_question(question).words) < 2


def asks_in_short(text: str) -> bool:
    """Return whether a text may be a question without being a sentence.

    Example:
        >>> asks_in_short("capital of France"), asks_in_short("I am fond of France")
        (True, False)
    """
    return _SHORT.fullmatch(text.strip()) is not None


_SHORT = re.compile(
    r"(?:and )?(?:the )?(?:(?!i\b|my\b|you\b)[\w-]+ ){1,3}of (?:the )?[\w-]+(?: [\w-]+){0,2}\W*|and of [\w-]+(?: [\w-]+){0,2}",
    re.IGNORECASE,
)
_SOMETHING = re.compile(r"\b(?:it|they|them|he|she|him|her|his)\b", re.IGNORECASE)
