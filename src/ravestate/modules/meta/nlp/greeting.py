"""Recognise greetings and farewells."""

from __future__ import annotations

import re

from .pattern import phrases
from .word_set import word_set

Phrase = tuple[str, ...]

_OPENERS = frozenset(
    phrases("""
    oh; ok; okay; well; so; ah; and; yes; no; yeah; alright; all right; great; thanks; thank you (|very much|so much); sorry; anyway; then;
    now; why; fine; good; cool; (|i am|i'm) sorry but; but
""")
)
"""Words that may precede a greeting or farewell."""

_GREETINGS = frozenset(
    phrases("""
    hi; hello; hey; hiya; howdy; hallo; greetings; welcome; sup; yo; (what's|whats|what is) up; good (morning|afternoon|evening|day);
    morning; (|it's|it is|i'm|i am) (nice|good|great|pleased|glad|lovely) to (meet|see) you
""")
)
_FAREWELLS = frozenset(
    phrases("""
    bye; byebye; bye bye; bye-bye; goodbye; good bye; good-bye; goodnight; good night; farewell; cheerio; ciao; so long; adieu; cya; take care;
    see (you|ya|u) (|all) (|again|later|soon|tomorrow|around|then|next time|next week|tonight|on monday|on tuesday|on wednesday|on thursday|on
    friday|on saturday|on sunday); until (tomorrow|next time|then|we meet again); have a (nice|good|great|lovely|wonderful)
    (day|evening|night|weekend|one|time|trip); (|i'll|i will) (talk|speak|write) to you (later|soon|tomorrow); (|i'll|i will) catch you later;
    (|let's|let us) talk (later|soon|tomorrow); (i|we) (|really) (have to|must|need to|should|gotta|got to|better) (go|leave|run|be going|be off|get going)
    (|now) (|home|soon|to bed|then); (i'm|i am|im) (leaving|off|going) (|now) (|home|to bed|then)
""")
)
_LAST_WORDS = frozenset(
    phrases(
        "it was (|so|very|really) (nice|great|good|lovely|a pleasure) (talking|meeting|chatting|to talk|to meet|to chat)"
    )
)
"""Farewells that any words may follow."""
_LONGEST = max(len(phrase) for phrase in (*_OPENERS, *_GREETINGS, *_FAREWELLS, *_LAST_WORDS))

_ADDRESS = word_set(
    "my dear friend robot everyone everybody all guys again too then now for thanks thank you and until next time the moment"
)
"""Words that may follow a farewell, besides one other, such as a name."""

_TOKEN = re.compile(r"[\w'-]+|[.,;:!?…\n]+")
_STRETCHED = re.compile(r"(.)\1{2,}")


def says_hi(text: str) -> bool:
    """Return whether the text begins with a greeting.

    Example:
        >>> says_hi("Hello, how are you?"), says_hi("I said hello")
        (True, False)
    """
    for words in _parts(text):
        if rest := _without_openers(words, _GREETINGS):
            return _beginning(rest, _GREETINGS) > 0
    return False


def says_bye(text: str) -> bool:
    """Return whether the text says goodbye.

    Example:
        >>> says_bye("thanks, see you tomorrow"), says_bye("I have to go to work on Mondays")
        (True, False)
    """
    for words in _parts(text):
        rest = _without_openers(words, _FAREWELLS)
        if _beginning(rest, _LAST_WORDS):
            return True
        length = 0
        while more := _beginning(rest[length:], _FAREWELLS):  # bye bye see you tomorrow
            length += more
        others = [word for word in rest[length:] if word not in _ADDRESS]
        if length and (not others or (len(others) == 1 and len(rest) == length + 1)):
            return True
    return False


def _parts(text: str) -> list[list[str]]:
    """Return the words between punctuation marks, in lower case and normal spelling (*hiii* is *hi*)."""
    parts: list[list[str]] = [[]]
    for token in _TOKEN.findall(text.lower().replace("’", "'")):
        if token[0].isalnum():
            parts[-1].append(_STRETCHED.sub(r"\1", token))
        else:
            parts.append([])
    return parts


def _without_openers(words: list[str], known: frozenset[Phrase]) -> list[str]:
    while not _beginning(words, known) and (
        length := _beginning(words, _OPENERS)
    ):  # "good" begins a greeting, "good night" does not
        words = words[length:]
    return words


def _beginning(words: list[str], known: frozenset[Phrase]) -> int:
    """Return the length in words of the longest known phrase at the beginning of `words`; 0 for none."""
    for length in range(min(_LONGEST, len(words)), 0, -1):
        if tuple(words[:length]) in known:
            return length
    return 0
