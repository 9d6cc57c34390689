"""What somebody asks about himself: *do you know my name*, *where do I live*; and whether he wants to be forgotten."""

from __future__ import annotations

import re

from .patterns import either, patterns, wanted
from .phrase import values
from .topics import NAME, TOPICS, Fact

__all__ = ["EVERYTHING", "inquiry", "wants_to_be_forgotten"]

EVERYTHING = "everything"
"""In place of a topic: all that is known."""

ALSO = "(still |actually |really |again |exactly |currently |now |then |even |already |happen to )*"
KNOW = "(know|remember|recall|learn|learnt|learned|find out|found out|say|tell me|told you|heard|noted|memori[sz]ed?)"
PLACE = "(city|town|place|country|village)"

QUESTIONS = patterns(
    {
        EVERYTHING: rf"""
            (what|how much|anything|everything|something|all)( (else|all|exactly))? (do |did |have |can )?(you |i )?{ALSO}{KNOW}?( anything| something)? (about|of|regarding) (me|myself)\b
            (do|did|can) you {ALSO}{KNOW} (anything|something|things|a lot|much|stuff)( \w+)? (about|of) me\b
            what (have|did) i (told|tell) you( (about (me|myself)|so far|before|last time|already|yesterday))*~
            (tell me|say) (something|anything|everything|more|all)( (that )?you (know|remember))? about (me|myself)\b
        """,
        NAME: rf"""
            who (am i|i am)~
            what('s| is| was|s)? {ALSO}my (first |full |last )?name( is| was)?~
            my name~
            what (am i|i am|i'm|do they call me)( called| named)?~
            how am i called~
            what do you call me~
            (do|did|can|don't) you {ALSO}(know|remember|recogni[sz]e|recall) (me|my (\w+ )?name|who i am)\b
            (you )?(still )?remember me\b
            have you forgotten (me|my name|who i am)
            have we met\b
            do we know each other
        """,
        "home": rf"""
            where (do )?i {ALSO}(live|reside)~
            where('s| is| was)? my (home|house|flat|apartment)~
            (in )?(what|which) {PLACE} (do )?i {ALSO}live( in)?~
            where (my home is|i live)\b
        """,
        "origin": rf"""
            where ((am|was|do|did) )?i {ALSO}(am |was |come |came )?(originally )?(from|born|grow up|grew up)~
            (what|which) {PLACE} (am i|i am|do i come) from~
            (what|where)('s| is)? my (home ?town|home country|birthplace|origin)~
        """,
        "hobby": r"""
            (what|which)('s| is| are|s)? (one of )?my (favou?rite )?(hobby|hobbies|pastimes?)( is| are)?~
            my hobb(y|ies)~
            what (do )?i (like|love|enjoy)?( to)? ?(do|doing) (for fun|in my (free|spare) time)
            do i have (any |a )?hobb(y|ies)~
            (which|what) hobb(y|ies) (do )?i have
        """,
        "occupation": r"""
            what('s| is| was|s)? my (job|occupation|profession|work|trade)( is)?~
            what (do )?i (do (for a living|for work|professionally)|work as)~
            do i (work|have a job)~
            my (job|occupation|profession)~
        """,
        "employer": r"""
            (where|who|whom|which company|what company|for whom|for which company) (do |am )?i (work|working|employed)( for| at)?~
            (who|what)('s| is)? my (employer|company)( is)?~
        """,
        "subject": r"""
            what (subject )?(do |did |am )?i (study|studying|studied|major in)~
            what('s| is)? my (major|subject)( is)?~
        """,
        "university": r"""
            (where|(at )?(which|what) (university|college)) (do |did |am )?i (study|studying|studied|go to|attend|enrolled)( at)?~
            (what|which)('s| is)? my (university|college|school)( is)?~
        """,
        "friend": r"""
            (who|what)('s| is| are|s)? (the names? of )?my (best |good )?friends?( is| are)?~
            what (is|are) my (best )?friend'?s'? names?
            do i have (any )?friends~
            my friends~
        """,
        "club": r"""
            (what|which|where)( club| clubs| group| team| organi[sz]ation)? (am i|i am) (a )?member( of| in)?~
            (what|which) (club|group|team|choir|band)s? (am i|i am|do i belong|did i join)( in| to)?~
            am i (a member of|in) (a|any) (club|team|choir|band|group|party)~
        """,
    }
)  # fmt: skip
"""Questions for something that is not known to who asks."""

GUESSES = patterns(
    {
        NAME: "(is my name|isn't my name|am i called) …",
        "home": "(do i|don't i) (still )?live in …",
        "origin": "(am i (originally )?from|do i come from|was i born in) …",
        "employer": "do i work (for|at) …",
        "university": "(do i study|am i studying) at …",
        "subject": "(do i study|am i studying) …",
        "hobby": "is (?P<wanted>.+?) (one of )?my hobb(y|ies)",
        "friend": "is (?P<wanted>.+?) (my|a) (best )?friend( of mine)?",
        "club": "am i a member of (?!a |any )…",
    }
)
"""Questions whether something is so."""

_LEAD = re.compile(
    r"^\W*((hey|hi|hello|ok|okay|so|and|but|well|now|please|say)\W+)*"
    + either(rf"""
        (do|did|can|could|would|will) you {ALSO}(know|remember|recall|tell me|guess|say)
        (please )?tell me
        have you forgotten
        i (wonder|forgot)
        (you )?remember
        any idea
        guess
    """)
    + "? ?",
    re.IGNORECASE,
)  # fmt: skip
"""What only wraps a question: *do you know where I live*."""

_MINE = r"(about me|of me|me|myself|my (personal )?(data|name|information|info|details|profile|memory)|(the )?(data|information) (about|on|of) me)"
_FORGET = re.compile(
    r"(?<![\w'])"
    + either(rf"""
        (forget|erase|delete|remove|wipe|clear) (all |everything |anything |whatever )?((that )?(you (know|have|remember|stored|saved)|i told you) )?{_MINE}(?= *($|[.,;!?]|please|now|and|again|completely|entirely|for ?ever|from your))
        (forget|delete|erase) (all|everything) (that )?(i (have )?(told|said)|i've told)( to)?( you)?
        (please )?(don't|do not) remember me\b
    """),
    re.IGNORECASE,
)  # fmt: skip
_ASKED_TO = re.compile(
    r"((can|could|would|will) you |(want|like) (you )?to )(please |just )*$", re.IGNORECASE
)
_OTHERWISE = re.compile(
    r"((don't|do not|never|won't|didn't|not|will|did|have|would|could) (\w+ )?(you )?(ever )?|"
    r"\b(i|we|you|they|he|she|people|everybody|everyone|who|to) (will |would |always |might |may |could )*)$",
    re.IGNORECASE,
)
"""Before *forget me*: it is no request."""


def inquiry(text: str) -> Fact | None:
    """What somebody asks about himself: a fact without values, or with those that he wants to have confirmed.

    Args:
        text: As `phrase.plain` makes it.

    Example:
        >>> inquiry("Do you know where I live?"), inquiry("Do I live in Bremen?")
        (Fact(topic='home', values=(), gone=False), Fact(topic='home', values=('Bremen',), gone=False))
    """
    for sentence in re.split(r"[.!\n]+|(?<=\?)", text):
        for asked in (sentence.strip(), _LEAD.sub("", sentence.strip())):
            for topic, pattern in GUESSES:
                if guessed := values(wanted(pattern.match(asked)), TOPICS[topic]):
                    return Fact(topic, guessed)
            for topic, pattern in QUESTIONS:
                if pattern.match(asked):
                    return Fact(topic, ())
    return None


def wants_to_be_forgotten(text: str) -> bool:
    """Whether somebody asks for all that is known of him to be forgotten.

    Example:
        >>> wants_to_be_forgotten("please forget me"), wants_to_be_forgotten("don't forget me")
        (True, False)
    """
    for match in _FORGET.finditer(text):
        before = text[: match.start()]
        if _ASKED_TO.search(before) or not _OTHERWISE.search(before):
            return True
    return False
