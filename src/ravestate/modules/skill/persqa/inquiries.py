"""Questions of the user about themselves: *do you know my name*, *where do I live*."""

from __future__ import annotations

import re
from collections.abc import Mapping

from ravestate.modules import nlp

from .patterns import either, patterns, wanted
from .phrase import values
from .statements import gerund, likings
from .topics import NAME, RELATIVES, TOPICS, Fact, favourite
from .wording import among
from .words import word_set

EVERYTHING = "everything"
"""Stands for all topics."""

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
            my home~
        """,
        "origin": rf"""
            where ((am|was|do|did) )?i {ALSO}(am |was |come |came )?(originally )?from~
            (what|which) {PLACE} (am i|i am|do i come) from~
            ((what|where)('s| is)? )?my (home ?town|home country|origin)~
        """,
        "birthplace": rf"""
            where (was i |i was )?{ALSO}born~
            (in )?(what|which) {PLACE} (was i|i was) born( in)?~
            ((what|where)('s| is)? )?my (birthplace|place of birth)~
        """,
        "childhood": rf"""
            where (did )?i {ALSO}(grow|grew) up~
            (in )?(what|which) {PLACE} did i grow up( in)?~
        """,
        "age": """
            how old (am i|i am)~
            (what('s| is)? )?my age~
        """,
        "hobby": r"""
            (what|which)('s| is| are|s)? (one of )?my (favou?rite )?(hobby|hobbies|pastimes?)( is| are)?~
            my hobb(y|ies)~
            what (do )?i (like|love|enjoy)?( to)? ?(do|doing) (for fun|in my (free|spare) time)
            do i have (any |a )?hobb(y|ies)~
            (which|what) hobb(y|ies) (do )?i have
            what (do )?i play~
        """,
        "liking": r"""
            what (do )?i (really )?(like|love|enjoy)( to do| doing)?~
            what (am i|i am) (into|interested in|fond of|keen on)~
        """,
        "favourite": r"""
            ((what|who|which)('s| is| are|s)? )?my (?P<favourite>favou?rite (?!hobb|pastime)[\w-]+( [\w-]+)?)( is| are)?~
            (what|which) (?P<favourite>[\w-]+) (do )?i like (best|most)~
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
        **{
            relative.name: rf"""
                ((who|what)('s| is| are|s)? )?(the names? of )?my (\w+ )?({relative.nouns})('?s'? names?|s)?( is| are)?( called| named)?~
                do i have (an? |any )?(\w+ )?({relative.nouns})s?~
            """
            for relative in RELATIVES
        },
        "club": r"""
            (what|which|where)( club| clubs| group| team| organi[sz]ation)? (am i|i am) (a )?member( of| in)?~
            (what|which) (club|group|team|choir|band)s? (am i|i am|do i belong|did i join)( in| to)?~
            am i (a member of|in) (a|any) (club|team|choir|band|group|party)~
        """,
    }
)  # fmt: skip
"""Questions that leave the value open."""

GUESSES = patterns(
    {
        NAME: "(is my name|isn't my name|am i called) …",
        "home": "(do i|don't i) (still )?live in …",
        "origin": "(am i (originally )?from|do i come from) …",
        "birthplace": "was i born in …",
        "childhood": "did i grow up in …",
        "age": "am i …",
        "employer": "do i work (for|at) …",
        "university": "(do i study|am i studying) at …",
        "subject": "(do i study|am i studying) …",
        "hobby": "is (?P<wanted>.+?) (one of )?my hobb(y|ies)",
        "liking:verb": """
            do i (still )?(like|love|enjoy) …
            do i (still )?(?P<wanted>(play|go) .+)
            am i (into|keen on|interested in|fond of) …
        """,
        **{
            relative.name: rf"is (?P<wanted>.+?) (my|an?) (\w+ )?({relative.nouns})( of mine)?~"
            for relative in RELATIVES
        },
        "club": "am i a member of (?!a |any )…",
    }
)
"""Questions that name a value to confirm."""

_OPENING = re.compile(
    r"^\W*((hey|hi|hello|good (morning|day|evening)|there|ok|okay|so|and|but|well|now|please|say|oh)\b\W*)*",
    re.IGNORECASE,
)
_WRAP = re.compile(
    either(rf"""
        (do|did|can|could|would|will) you {ALSO}(know|remember|recall|tell me|guess|say)
        (please )?tell me
        have you forgotten
        i (wonder|forgot)
        (you )?remember
        any idea
        guess
    """)
    + " ?",
    re.IGNORECASE,
)  # fmt: skip
"""Words around a question: *do you know where I live*."""

_SOMEBODY = patterns(
    {
        "people": rf"""
            (who|what)('s| is) …
            what (do )?you {ALSO}know (about|of) …
            (do|did|can) you {ALSO}(know|remember) (who )?(?P<wanted>.+?)( is)?~
            (please )?tell me (something |more |anything )?(about|of) …
            what about …
        """
    }
)


def of_whom(text: str, known: Mapping[str, tuple[str, ...]]) -> str:
    """Return the topic of a person whom the user names; empty if the person is not known.

    Example:
        >>> of_whom("Who is Emma?", {"sister": ("Emma",)})
        'sister'
    """
    bare = _OPENING.sub("", text)
    for _, pattern in _SOMEBODY:
        name = wanted(pattern.match(bare)).strip(" .?!")
        for relative in RELATIVES:
            if name and among(name, known.get(relative.name, ())):
                return relative.name
    return ""


def inquiry(text: str) -> Fact | None:
    """Return the fact that the user asks for; it has values if the user wants them confirmed.

    Args:
        text: The result of `phrase.plain`.

    Example:
        >>> inquiry("Do you know where I live?"), inquiry("Do I live in Bremen?")
        (Fact(topic='home', values=(), gone=False), Fact(topic='home', values=('Bremen',), gone=False))
    """
    for sentence in re.split(r"[.!\n]+|(?<=\?)", text):
        bare = _OPENING.sub("", sentence.strip())
        wrap = _WRAP.match(bare)
        for asked in (bare, bare[wrap.end() :] if wrap else bare):
            if found := _guessed(asked) or _asked(asked):
                return found
    return None


def _guessed(text: str) -> Fact | None:
    for name, pattern in GUESSES:
        topic, _, form = name.partition(":")
        rest = wanted(pattern.match(text))
        if guessed := values(gerund(rest) if form else rest, TOPICS[topic]):
            return likings(guessed)[0] if topic == "liking" else Fact(topic, guessed)
    return None


def _asked(text: str) -> Fact | None:
    for topic, pattern in QUESTIONS:
        if found := pattern.match(text):
            return Fact(_favourite(found["favourite"]) if topic == "favourite" else topic, ())
    return None


def _favourite(words: str) -> str:
    return favourite(words if words.lower().startswith("favo") else f"favourite {words}")


_OPEN = word_set(
    """do get find buy call ask say tell talk see start make mean bother disturb win lose use know hear understand look sound need
    help stop leave become put turn write spell pronounce reach pay order cook bake fix install learn think forget join owe miss"""
)
"""Verbs of questions for advice or for an opinion."""
_WRAPS = word_set("know remember recall tell say guess wonder ask")
_ADVICE = re.compile(
    r"\b(?:can|could|may|might|should|shall|will|would|must|have to|need to|going to|if i|supposed)\b",
    re.IGNORECASE,
)
_PRIVATE = word_set("like love enjoy play have live work study speak own eat drink collect")


def about_oneself(text: str, question: nlp.QuestionWord, triples: tuple[nlp.Triple, ...]) -> bool:
    """Return whether a question is about the user's own affairs: *how old is my sister*, *what do I drink*."""
    if _ADVICE.search(text):
        return False
    for subject, predicate, thing in triples:
        whose = str(subject).lower().split()
        verb = predicate.removeprefix("not ").split()[0]
        if whose[:1] == ["my"]:
            return True
        if whose in (["you"], ["i"]) and _WRAPS & set(predicate.split()):
            continue  # do you know, I wonder
        if whose != ["i"] or question in (nlp.QuestionWord.FORM, nlp.QuestionWord.REASON):
            return False
        if question is nlp.QuestionWord.YES_NO:
            return verb in _PRIVATE and str(thing).lower() not in ("", "you", "it", "that", "this")
        return verb not in _OPEN
    return False
