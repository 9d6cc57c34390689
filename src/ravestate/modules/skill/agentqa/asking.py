"""Sentences of an utterance that ask something about the agent, found by pronouns, word order and polite phrases.

Each gets a plain form: lower case, no punctuation, short forms written out, no polite frame (*hi, could you tell me*).
Statements, and questions about the user, are left out whatever their topic.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass

LONGEST = 2000
"""Characters of an utterance that are read."""
WORDS = 20
"""The greatest number of words in a question about the agent."""
SENTENCES = 4
"""The greatest number of sentences that are considered."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A question that may be about the agent."""

    text: str
    """The plain form."""
    addressed: bool
    """Whether it has *you* or *your*. *How is it going* has neither, and still asks after the agent's mood."""


def about_agent(
    utterance: str,
    names: Collection[str] = (),
    known: Collection[str] = frozenset(),
    *,
    question: bool = False,
) -> tuple[list[Asked], str]:
    """Return the questions that may be about the agent, and why the last other sentence is none.

    Args:
        utterance: The user's words.
        names: Names of the agent; they stand for *you*.
        known: Plain forms that always count as questions about the agent.
        question: Whether the utterance is known to ask something.

    Example:
        >>> about_agent("Hi! Could you tell me what's ur name?")
        ([Asked(text='what is your name', addressed=True)], 'it is no question')
        >>> about_agent("what is my name")
        ([], 'it is about the user')
    """
    found: list[Asked] = []
    why = "nothing is said"
    sentences = [s for s in _SENTENCE.findall(utterance[:LONGEST]) if any(c.isalpha() for c in s)]
    for sentence in sentences[: 2 * SENTENCES]:
        words, told = _unwrapped(_words(sentence, names))
        text = " ".join(words)
        asks = told or sentence.endswith("?") or (question and len(sentences) == 1)
        reason = "" if text in known else _unfit(words, asks, known)
        if reason:
            why = reason
        else:
            found.append(Asked(text, not _YOU.isdisjoint(words)))
    return found[:SENTENCES], why


def plain(question: str) -> str:
    """Return an example question in the plain form."""
    return " ".join(_unwrapped(_words(question, ()))[0])


def returns(utterance: str) -> bool:
    """Return whether the user returns a question.

    Example:
        >>> returns("I'm fine thanks, and you?"), returns("What's yours?"), returns("I like you.")
        (True, True, False)
    """
    sentences = _SENTENCE.findall(utterance[:LONGEST])
    return bool(sentences) and _RETURNS.fullmatch(" ".join(_words(sentences[-1], ()))) is not None


def statements(utterance: str, names: Collection[str] = ()) -> list[str]:
    """Return all sentences of an utterance in the plain form.

    Example:
        >>> statements("I'm fine. Robin's friends don't sleep.", ["Robin"])
        ['i am fine', 'your friends do not sleep']
    """
    found = [s for s in _SENTENCE.findall(utterance[:LONGEST]) if any(c.isalpha() for c in s)]
    return [" ".join(_unwrapped(_words(sentence, names))[0]) for sentence in found]


def _unfit(words: list[str], asks: bool, known: Collection[str]) -> str:
    """Return why a sentence is no question about the agent; an empty string if it may be one."""
    if not words:
        return "nothing is said"
    if len(words) > WORDS:
        return f"it is longer than {WORDS} words"
    if not asks and words[0] not in _FIRST and not (words[0] in ("your", "and") and len(words) <= 3):
        return "it is no question"
    if not _USER.isdisjoint(_ABOUT_BOTH.sub(" ", " ".join(words)).split()):
        return "it is about the user"
    if not _SOMEBODY.isdisjoint(words):
        return "it is about somebody else"
    if words[0] == "why" and not any(one.startswith("why ") for one in known):
        return "it asks for a reason"
    return ""


def _words(sentence: str, names: Iterable[str]) -> list[str]:
    text = sentence.lower().replace("’", "'")
    for name in names:
        text = re.sub(rf"(?<!\w){re.escape(name.lower())}(?!\w)", _NAME, text)
    words: list[str] = []
    for word in re.findall(_WORD, text):
        written: str = _WRITTEN_OUT.get(word) or word
        words += written.split()
    if _YOU.isdisjoint(words):  # a name beside "you" only calls the agent
        text = " ".join(words).replace(f"{_NAME}'s", "your").replace(_NAME, "you")
        words = re.sub(r"\b(is|does|has) (?=you\b)", lambda found: _AGREEING[found[1]], text).split()
    return [word for word in words if not word.startswith(_NAME)]


def _unwrapped(words: list[str]) -> tuple[list[str], bool]:
    """Return the words without their polite frame, and whether the frame was a request to tell something."""
    told = False
    begin = 0
    while True:
        for wrapper in _WRAPPERS:
            size = len(wrapper)
            if tuple(words[begin : begin + size]) == wrapper and len(words) > begin + size:
                if wrapper == _KNOW and not _asks_for_knowledge(words[begin + size :]):
                    continue
                told = told or wrapper in _TELL
                begin += size
                break
        else:
            break
    end = len(words)
    while end > begin + 1 and words[end - 1] in _AT_THE_END:
        end -= 1
    if end > begin + 2 and words[end - 2 : end] == ["my", "friend"] and words[end - 3] != "is":
        end -= 2
    words = words[begin:end]
    if told and "about" in words[1:3] and words[0] in ("something", "more", "everything", "a"):
        words = words[words.index("about") :]  # tell me a bit about yourself
    if words[:1] == ["any"]:
        words = ["do", "you", "have", *words]
    elif words[:1] == ["got"]:
        words = ["do", "you", "have", *words[1:]]
    elif words[:3] == ["have", "you", "got"] or (words[:2] == ["have", "you"] and not _SOME.isdisjoint(words[2:3])):
        words = ["do", "you", "have", *words[3 if words[2:3] == ["got"] else 2 :]]
    return words, told


def _asks_for_knowledge(words: list[str]) -> bool:
    """Return whether *do you know* is only a frame: in *do you know who you are*, not in *do you know how to swim*."""
    return words[0] in _QUESTION_WORDS and words[:2] != ["how", "to"]


def _set(words: str) -> frozenset[str]:
    return frozenset(words.split())


def _phrases(text: str) -> list[tuple[str, ...]]:
    return [tuple(phrase.split()) for phrase in text.replace("\n", " ").split(";")]


_SENTENCE = re.compile(r"[^.!?…\n]+[?]?")
_WORD = re.compile(r"[^\W_]+(?:['-][^\W_]+)*")
_NAME = "thename"
_AGREEING = {"is": "are ", "does": "do ", "has": "have "}
_YOU = _set("you your yours yourself")
_USER = _set("i me my mine myself am we us our ours ourselves")
_SOME = _set("a an any some many brothers sisters siblings friends hobbies parents")
_SOMEBODY = _set("he she him his her hers them their")
_ABOUT_BOTH = re.compile(
    r"\b(?:(?:should|shall|can|may|do|must|could|might) i (?:call|address|reach|find) (?=you)|"
    r"(?:am i|i am) (?:\w+ )?(?:talking|speaking|chatting) (?:to|with)|(?:for|help|tell|about) me\b|"
    r"(?:what|whatever|everything|things) i (?:tell|told|say|said)\b|ask(?:ing)? me\b|my (?:data|privacy|information|secrets))"
)
"""Questions about the agent that mention the user."""
_RETURNS = re.compile(
    r"(?:.* )?(?:and|what about|how about) (?:you|yours|yourself|your own)(?: (?:robot|then|my friend))?|"
    r"(?:and )?what (?:is|are) (?:yours|your own)|you|yours|yourself"
)
_QUESTION_WORDS = _set("who whom whose what which where when why how")
_FIRST = _QUESTION_WORDS | _set(
    "do does did are is was were have has had can could will would may should since in from by of to with at on until under am "
    "introduce describe say talk list name"
)
"""First words of a question or a request."""
_AT_THE_END = _set("please exactly actually anyway though by-the-way then")
_KNOW = ("do", "you", "know")
_TELL = _phrases(
    "tell me; tell us; can you tell me; could you tell me; would you tell me; will you tell me; can you please tell me; "
    "could you please tell me; please tell me; would you mind telling me; i would like to know; i would love to know; "
    "i want to know; i wonder; i was wondering; i am wondering; i am curious; i am curious to know; may i ask; may i ask you; "
    "may i know; can i ask; can i ask you; could i ask; could i ask you; can i know; let me know; let me ask you; "
    "i am interested to know; i would be interested to know"
)
_WRAPPERS = sorted(
    [
        *_TELL,
        _KNOW,
        *_phrases(
            "hi; hello; hey; hi there; hello there; hey there; hallo; good morning; good evening; good afternoon; so; and; but; "
            "well; oh; ok; okay; yes; no; please; now; then; by the way; actually; just; um; uh; hm; hmm; my friend; "
            "dear robot; great; cool; nice; fine; thanks; thank you; sorry; excuse me; one question; tell me please; also"
        ),
    ],
    key=len,
    reverse=True,
)
_WRITTEN_OUT: dict[str, str] = {
    short: written
    for shorts, written in {
        "u ya yu yuo yoi": "you",
        "ur yuor yor yoru ure": "your",
        "r ar aer": "are",
        "waht wat wht whta hwat wath": "what",
        "hw hwo hou": "how",
        "wher whre wehre": "where",
        "woh hoo": "who",
        "whne wen": "when",
        "hav ahve hve": "have",
        "teh": "the",
        "doyou": "do you",
        "areyou": "are you",
        "whats what's wats": "what is",
        "whos who's": "who is",
        "hows how's": "how is",
        "wheres where's": "where is",
        "whens when's": "when is",
        "which's": "which is",
        "it's": "it is",
        "what're": "what are",
        "how're": "how are",
        "who're": "who are",
        "where're": "where are",
        "you're youre": "you are",
        "you've": "you have",
        "you'd": "you would",
        "i'd": "i would",
        "i'm im": "i am",
        "don't dont": "do not",
        "didn't didnt": "did not",
        "aren't arent": "are not",
        "haven't havent": "have not",
        "can't cant": "can not",
        "wanna": "want to",
        "gonna": "going to",
        "fav favorite favorit favourit fave": "favourite",
        "color colors": "colour",
        "learnt": "learned",
        "organization": "organisation",
        "mum mom mommy mummy": "mother",
        "bot": "robot",
        "pls plz": "please",
    }.items()
    for short in shorts.split()
}
"""Short forms and common slips in typing, written out."""
