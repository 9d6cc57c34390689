"""Questions about facts, which small talk does not answer."""

from __future__ import annotations

import re

_FRONT = re.compile(
    r"^(?:(?:so|and|but|well|ok|okay|hey|please|now|then|by the way|can you tell me|could you tell me|tell me|"
    r"do you know|do you happen to know|any idea|i wonder|und|aber|also|bitte|sag mal|kannst du mir sagen|"
    r"weißt du)\b[\s,:]*)*"
)
_ASKS = re.compile(
    r"(?:who|whom|whose|what|which|when|where|"
    r"how (?:many|much|old|tall|far|long|big|large|high|deep|fast|heavy|hot|cold)|"
    r"wer|wen|wem|wessen|was|welche[rsnm]?|wann|wo|wie (?:viele?|alt|groß|weit|lang|hoch|tief|schnell|schwer))"
    r"(?:'s|'re|s)?\b"
)
# The user and the agent.
_PERSONAL = re.compile(
    r"\b(?:i|me|my|mine|we|us|our|you|your|yours|ich|mir|mich|meine?[rnms]?|wir|uns|unsere?[rnms]?|du|dir|dich|"
    r"deine?[rnms]?|sie|ihnen|ihre?[rnms]?)\b"
)
# "And its capital?", "is Scotland a country?"; not the weather here and now.
_ASKS_OF_IT = re.compile(
    r"(?:(?:what|how) about |of |in |for )?(?:its|their) \w+(?: \w+)?\W*$|of (?:the )?\w+(?: \w+)?\?$|"
    r"(?:is|are|was|were|does|do|did|has|have|can) (?:the |an? )?(?!(?:it|there|that|this|those|these|they|he|she|anybody|anyone|"
    r"somebody|someone|anything|something|everything|everybody|everyone)\b)"
    r"[\w'-]+ (?:\w+ ){0,4}?(?:an?|the|in|of|on|from|have|has|than|eat|live|fly|swim)\b.*\?$|"
    r"(?:what(?:'s| is)? )?\d+(?:[.,]\d+)? ?(?:times|plus|minus|divided by|x|[*+/-]) ?\d"
)
_CHAT = re.compile(
    r"(?:what|was)(?:'s| is| are)? (?:up|new|going on|next|about|if|else|a|an|now|for|the matter|wrong|neues|ist los|geht)\b|"
    r"what(?:'s| is)? happening\b|who's there\b|(?:when|where|who|what|which|how|wer|was|wo|wann)\W*$|how much fun\b"
)


def asks_for_fact(text: str) -> bool:
    """Guess whether `text` asks for a fact: "Who wrote Hamlet?", not "Who are you?".

    The guess looks at a few words of English and German, and may be wrong either way. Modules that know better have
    rules that come before small talk.

    Example:
        >>> asks_for_fact("What is the capital of Peru?"), asks_for_fact("What is your name?")
        (True, False)
    """
    for sentence in re.split(r"[.!?]+\s+", text[:2000].lower().replace("’", "'")):
        question = _FRONT.sub("", sentence.strip(), count=1)
        if (
            (_ASKS.match(question) or _ASKS_OF_IT.match(question))
            and not _CHAT.match(question.rstrip("?!. "))
            and not _PERSONAL.search(question)
        ):
            return True
    return False
