"""Intents that are plain from the words: to greet, to take leave, to play."""

from __future__ import annotations

import re

__all__ = ["says_bye", "says_hi", "wants_to_play"]

_BEFORE = r"^\W*(?:(?:oh|ok|okay|well|so|ah|and|yes|no|yeah|alright|all right|great|thanks|thank you|thank you very much|sorry|anyway|then|now|why)\b\W*)*"

_HI = re.compile(
    _BEFORE + r"(?:hi+|hello+|hey+|hiya|howdy|hallo+|greetings|welcome|what's up|whats up|sup|yo|"
    r"good (?:morning|afternoon|evening|day)|morning|(?:it's |it is )?(?:nice|good|great|pleased|glad|lovely) to (?:meet|see) you)"
    r"(?![\w'’-])",
    re.IGNORECASE,
)
_BYE = re.compile(
    r"(?:^|[.,;!?…]\s*|\b(?:ok|okay|well|thanks|thank you|so|and|then|alright|all right|now|you|hello|oh|yes|no)\s+)"
    r"(?:bye+|bye[ -]?bye|good ?bye|good ?night|farewell|cheerio|ciao|so long|adieu|cya|take care(?! of)|"
    r"see (?:you|ya|u)(?: (?:all|again|later|soon|tomorrow|around|then|next (?:time|week)|on \w+|in \w+ \w+))?|"
    r"until (?:tomorrow|next time|then|we meet again)|have a (?:nice|good|great|lovely) (?:day|evening|night|weekend|one|time)|"
    r"(?:i'll |i will )?(?:talk|speak|catch|write) (?:to you |with you |you )?(?:later|soon|tomorrow)|"
    r"(?:i|we) (?:really )?(?:have to|must|need to|should|gotta|got to|better) (?:go|leave|run|be going|be off|get going)"
    r"(?: now| home| soon| to bed| then)*|(?:i'm|i am|im) (?:leaving|off|going)(?: now| home| to bed)*|it was (?:nice|great|good|lovely) (?:talking|meeting|chatting)\b[^.!?]*)"
    r"(?:\s+(?:now|then|for now|my friend|my dear|robot|again|everyone|everybody|all|then|too|\w+))?\s*(?:$|[.,;!?…])",
    re.IGNORECASE,
)
_NOT_PLAYED = (
    r"(?! (?:the |a |an |some |my |your |any )?(?:\w+ )?(?:music|songs?|tunes?|album|video|film|movie|piano|guitar|violin|drums?|flute|"
    r"instruments?|cello|trumpet|radio|role|part|tricks?|dead|it|that|this)\b)"
)
_GAMES = r"(?:a|another|some|any|the|this|that|our|my|your|one more)\s+(?:\w+\s+)?(?:game|round|match|quiz|riddle)s?\b"
_PLAY = re.compile(
    r"\b(?:let's|lets|let us|shall we|should we|can we|could we|may we|can i|may i|could you|can you|will you|would you|how about we|"
    r"why don't we|why dont we|(?:do you |would you |if you |who )?(?:want|wanna|like|love) (?:to )?(?:me to )?|wanna|"
    r"(?:i|we) (?:want|wanna|would like|'d like|would love|'d love)(?: you)? (?:to )?|i'd (?:like|love) (?:you )?to|i feel like|feel like|"
    r"in the mood (?:for|to)|time to|ready to|how about|what about|come and|come on|please|go on)\s*(?:please |now |again |just )*"
    r"(?:to )?play(?:ing)?\b" + _NOT_PLAYED + r"|"
    r"^\W*(?:(?:ok|okay|hey|hi|hello|please|now|then|yes|so|come on|robot)\b\W*)*play\b(?= (?:with (?:me|us)|"
    + _GAMES
    + r"|chess|something|again))|"
    r"\b(?:want|wanna|like|how about|what about|let's have|lets have|start|offer me|begin|feel like|up for|mood for|need|have)\s+(?:to have |to start )?"
    + _GAMES
    + r"(?! you)|"
    r"^\W*(?:a )?game\W*$",
    re.IGNORECASE,
)
_QUESTION_OF_TASTE = re.compile(
    r"\b(?:do|does|did|what|which|who|i|he|she|they|we)\b(?: \w+){0,3} (?:like|love|likes|loves) (?:to play|playing)\b(?! (?:with me|with us|a game|now))",
    re.I,
)
_WOULD = re.compile(r"\b(?:would|'d)\b", re.IGNORECASE)
_DENIED = re.compile(
    r"\b(?:not|never|\w+n['’]t|dont|cant|wont|no more)\b(?:\s+\w+){0,4}\s+(?:play|playing|game|games)\b",
    re.IGNORECASE,
)
_INVITES = re.compile(
    r"\bwhy (?:don['’]t|dont|not|do not)\b|\b(?:don['’]t|dont) you (?:want|wanna)\b", re.IGNORECASE
)


def says_hi(text: str) -> bool:
    """Whether the text begins with a greeting.

    Example:
        >>> says_hi("Hello, how are you?"), says_hi("I said hello")
        (True, False)
    """
    return _HI.match(text) is not None


def says_bye(text: str) -> bool:
    """Whether the text takes leave.

    Example:
        >>> says_bye("thanks, see you tomorrow"), says_bye("I have to go to work on Mondays")
        (True, False)
    """
    return _BYE.search(text) is not None


def wants_to_play(text: str) -> bool:
    """Whether the text proposes a game.

    Example:
        >>> wants_to_play("do you want to play with me"), wants_to_play("I play the piano")
        (True, False)
    """
    text = text.replace("’", "'")
    if _PLAY.search(text) is None or (_DENIED.search(text) and not _INVITES.search(text)):
        return False
    return _WOULD.search(text) is not None or _QUESTION_OF_TASTE.search(text) is None
