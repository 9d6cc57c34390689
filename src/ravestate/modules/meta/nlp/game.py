"""Recognise the wish to play."""

from __future__ import annotations

import re

_FLAGS = re.IGNORECASE | re.VERBOSE

_GAME = r"""(?: (?:a | another | some | any | the | this | that | our | my | your | one[ ]more )\s+ (?:\w+\s+)?
               (?:game | round | match | quiz | riddle)s?\b )"""
_NO_GAME = r"""(?:[ ](?:the[ ]|a[ ]|an[ ]|some[ ]|my[ ]|your[ ]|any[ ])?(?:\w+[ ])?
                  (?:music | songs? | tunes? | album | video | film | movie | piano | guitar | violin | drums? | flute | instruments? |
                     cello | trumpet | radio | role | part | tricks? | dead | it | that | this)\b )"""
"""Things to play that are not games."""

_INVITATION = re.compile(
    rf"""
    \b(?: let's | lets | let[ ]us | (?:shall | should | can | could | may)[ ]we | (?:can | may)[ ]i | (?:can | could | will | would)[ ]you |
          (?:how | what)[ ]about(?:[ ]we)? | why[ ](?:don't | dont | not | do[ ]not)(?:[ ]we)? | time[ ]to | ready[ ]to | in[ ]the[ ]mood[ ](?:for | to) |
          feel[ ]like | come[ ](?:and | on) | please | go[ ]on |
          (?:want | wanna | like | love)(?:[ ]you | [ ]me)?(?:[ ]to)? )
       (?:[ ](?:please | now | again | just | to))*
       [ ]play(?:ing)?\b (?!{_NO_GAME})
  | ^\W*(?:(?:ok | okay | hey | hi | hello | please | now | then | yes | so | come[ ]on | robot)\b\W*)*
       play[ ](?:with[ ](?:me | us) | {_GAME} | chess | something | again)
  | \b(?: want | wanna | like | how[ ]about | what[ ]about | let's[ ]have | lets[ ]have | start | offer[ ]me | begin | feel[ ]like | up[ ]for |
          mood[ ]for | need | have )\s+ (?:to[ ]have[ ] | to[ ]start[ ])? {_GAME} (?![ ]you)
  | ^\W*(?:a[ ])?game\W*$
    """,
    _FLAGS,
)
_TASTE = re.compile(
    r"""
    \b(?:do | does | did | what | which | who | i | he | she | they | we)\b (?:[ ]\w+){0,3} [ ](?:like | love | likes | loves)
       [ ](?:to[ ]play | playing)\b (?![ ](?:with[ ]me | with[ ]us | a[ ]game | now))
    """,
    _FLAGS,
)
"""Statements of general likes: *I like to play tennis*, but not *I would like to play*."""
_WOULD = re.compile(r"\b(?:would|i'd|we'd)\b", re.IGNORECASE)
_DENIED = re.compile(
    r"\b(?:not | never | \w+n't | dont | cant | wont | no[ ]more)\b (?:\s+\w+){0,4} \s+ (?:play | playing | games?)\b",
    _FLAGS,
)
_INVITED = re.compile(r"\bwhy (?:don't|dont|not|do not)\b|\b(?:don't|dont) you (?:want|wanna)\b", re.IGNORECASE)
"""Negations that invite: *why don't we play*."""


def wants_to_play(text: str) -> bool:
    """Return whether the text proposes a game.

    Example:
        >>> wants_to_play("do you want to play with me"), wants_to_play("I play the piano")
        (True, False)
    """
    text = text.replace("’", "'")
    if _INVITATION.search(text) is None or (_DENIED.search(text) and not _INVITED.search(text)):
        return False
    return _WOULD.search(text) is not None or _TASTE.search(text) is None
