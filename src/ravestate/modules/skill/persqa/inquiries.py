"""What somebody asks about himself: *do you know my name*, *where do I live*; and whether he wants to be forgotten."""

from __future__ import annotations

import re

from .phrase import plain, values
from .topics import NAME, TOPICS, Fact

__all__ = ["EVERYTHING", "asks_about_himself", "inquiry", "is_about_himself", "wants_to_be_forgotten"]

EVERYTHING = "everything"
"""In place of a topic: all that is known."""

_HIMSELF = re.compile(r"(?<![\w'])(?:i|i'm|i've|im|me|my|mine|myself)(?![\w])", re.IGNORECASE)

_KNOW = r"(?:(?:do|did|can|could|would|will) you (?:still |even |really |happen to |already )*(?:know|remember|recall|tell me|guess|say)|(?:please )?tell me|have you (?:forgotten|forgot)|i (?:wonder|forgot)|what was|(?:you )?remember|any idea|guess)"
_ALSO = r"(?:still |actually |really |again |exactly |currently |now |then )*"
_IT = r"(?: (?:again|now|then|actually|exactly|at the moment|currently|for a living|in my (?:free|spare) time|called|please|from|anyway))*\W*$"

_QUESTIONS: tuple[tuple[str, str], ...] = (
    (EVERYTHING, r"(?:what|how much|which things|anything|everything|something|all)(?: (?:else|all|exactly))? (?:do |did |have |can |could )?(?:you |i )?(?:still |already |really |actually )*(?:know|knows|remember|learn|learnt|learned|find out|found out|recall|tell me|say|told you|tell you|memori[sz]ed?|heard|noted)?(?: anything| something| already)? (?:about|of|regarding) (?:me|myself)\b"),
    (EVERYTHING, r"(?:do|did|can) you (?:still |already |really |actually )*(?:know|remember|recall) (?:anything|something|things|a lot|much|stuff)(?: \w+)? (?:about|of) me\b"),
    (EVERYTHING, r"what (?:have|did) i (?:told|tell) you(?: (?:about (?:me|myself)|so far|before|last time|already|yesterday))*\W*$"),
    (EVERYTHING, r"(?:tell me|say) (?:something|anything|everything|more|all)(?: (?:that )?you (?:know|remember))? about (?:me|myself)\b"),
    (NAME, rf"(?:who (?:am i|i am)|what(?:'s| is| was|s)? {_ALSO}my (?:first |full |last )?name(?: is| was)?|my name|what (?:am i|i am|do they call me|is it you call me)(?: called| named)?|how am i called|what (?:i'm|i am) called|what do you call me)" + _IT),
    (NAME, r"(?:do|did|can|don't) you (?:still |even |really |already |actually )*(?:know|remember|recogni[sz]e|recall) (?:me|my (?:\w+ )?name|who i am)\b"),
    (NAME, r"^\W*(?:you )?(?:still )?remember me\b|have you forgotten (?:me|my name|who i am)|have we met\b|do we know each other"),
    ("home", rf"where (?:do )?i {_ALSO}(?:live|reside|come home to)" + _IT + r"|where(?:'s| is| was)? my (?:home|house|flat|apartment)" + _IT + rf"|(?:what|which) (?:city|town|place|country|village) (?:do )?i {_ALSO}live in" + _IT + r"|(?:in )?(?:what|which) (?:city|town|place|country|village) (?:do )?i live" + _IT + r"|where (?:my home is|i live)\b"),
    ("origin", rf"where (?:(?:am|was|do|did) )?i {_ALSO}(?:am |was |come |came )?(?:originally )?(?:from|born|grow up|grew up|come from)" + _IT + r"|(?:what|which) (?:city|town|place|country|village) (?:am i|i am|do i come) from" + _IT + r"|(?:what|where)(?:'s| is)? my (?:home ?town|home country|birthplace|origin)" + _IT),
    ("hobby", r"(?:what|which)(?:'s| is| are|s)? (?:one of )?my (?:favou?rite )?(?:hobby|hobbies|pastimes?)(?: is| are)?" + _IT + r"|my hobb(?:y|ies)\W*$|what (?:do )?i (?:like|love|enjoy)?(?: to)? ?(?:do|doing) (?:for fun|in my (?:free|spare) time)|do i have (?:any |a )?hobb(?:y|ies)" + _IT + r"|(?:which|what) hobb(?:y|ies) (?:do )?i have"),
    ("occupation", r"what(?:'s| is| was|s)? my (?:job|occupation|profession|work|trade)(?: is)?" + _IT + r"|what (?:do )?i (?:do (?:for a living|for work|professionally)|work as)" + _IT + r"|do i (?:work|have a job)" + _IT + r"|my (?:job|occupation|profession)\W*$"),
    ("employer", r"(?:where|who|whom|which company|what company|for whom|for which company) (?:do |am )?i {0,1}(?:work|working|employed)(?: for| at)?".replace("{0,1}", "?") + _IT + r"|(?:who|what)(?:'s| is)? my (?:employer|company)(?: is)?" + _IT),
    ("subject", r"what (?:do |did |am )?i (?:study|studying|studied|major in)" + _IT + r"|what(?:'s| is)? my (?:major|subject)(?: is)?" + _IT + r"|(?:what|which) subject (?:do |am )?i (?:study|studying)" + _IT),
    ("university", r"(?:where|at which university|which university|what university|which college) (?:do |did |am )?i (?:study|studying|studied|go to|attend|enrolled)(?: at)?" + _IT + r"|(?:what|which)(?:'s| is)? my (?:university|college|school)(?: is)?" + _IT),
    ("friend", r"(?:who|what)(?:'s| is| are|s)? (?:the name of |the names of )?my (?:best |good )?friends?(?: is| are)?" + _IT + r"|what are my friends called|what (?:is|are) my (?:best )?friend'?s'? names?|do i have (?:any )?friends" + _IT + r"|my friends\W*$"),
    ("club", r"(?:what|which|where)(?: club| clubs| group| team| organi[sz]ation)? (?:am i|i am) (?:a )?member(?: of| in)?" + _IT + r"|(?:what|which) (?:club|clubs|group|team|choir|band)s? (?:am i|i am|do i belong|did i join)(?: in| to)?" + _IT + r"|am i (?:a member of|in) (?:a|any) (?:club|team|choir|band|group|party)" + _IT),
)  # fmt: skip

_CONFIRM: tuple[tuple[str, str], ...] = (
    (NAME, r"(?:is my name|isn't my name|am i called) (.+)"),
    ("home", r"(?:do i|don't i) (?:still )?live in (.+)"),
    ("origin", r"(?:am i (?:originally )?from|do i come from|was i born in) (.+)"),
    ("employer", r"do i work (?:for|at) (.+)"),
    ("subject", r"(?:do i study|am i studying) (.+)"),
    ("university", r"(?:do i study|am i studying) at (.+)"),
    ("hobby", r"is (.+?) (?:my|one of my) hobb(?:y|ies)"),
    ("friend", r"is (.+?) (?:my|a) (?:best )?friend(?: of mine)?"),
    ("club", r"am i a member of (?!a |any )(.+)"),
)

_ASKED = tuple((topic, re.compile(rf"(?<![\w'])(?:{words})", re.IGNORECASE)) for topic, words in _QUESTIONS)
_CONFIRMED = tuple((topic, re.compile(rf"(?<![\w'])(?:{words})", re.IGNORECASE)) for topic, words in _CONFIRM)
_LEAD = re.compile(
    rf"^\W*(?:(?:hey|hi|hello|ok|okay|so|and|but|well|now|please|say)\W+)*(?:{_KNOW} )?", re.IGNORECASE
)

_FORGET = re.compile(
    r"(?<![\w'])(?:(?:forget|erase|delete|remove|wipe|clear) (?:all |everything |anything |whatever )?(?:(?:that )?(?:you (?:know|have|remember|stored|saved)|i (?:told|said to) you|i've told you) ?)?"
    r"(?:about me|of me|me|my (?:data|name|information|info|details|profile|personal data|memory)|(?:the )?(?:data|information) (?:about|on|of) me|myself)(?= *(?:$|[.,;!?]|please|now|and|again|completely|entirely|forever|for ever|from your))|"
    r"(?:forget|delete|erase) (?:all|everything) (?:that )?(?:i (?:have )?(?:told|said)|i've told)(?: to)?(?: you)?|"
    r"(?:please )?(?:don't|do not) remember me\b|(?:delete|erase) my (?:\w+ )?(?:data|memory|profile|information))",
    re.IGNORECASE,
)
_NOT_FORGET = re.compile(
    r"(?:(?:don't|do not|never|won't|didn't|not|will|did|have|would|could) (?:\w+ )?(?:you )?(?:ever )?$|(?:i|we|you|they|he|she|people|everybody|everyone|who|to) (?:will |would |always |might |may |could )*$)",
    re.IGNORECASE,
)


def is_about_himself(text: str) -> bool:
    """Whether a text has *I*, *me*, *my*: whether it may be about who speaks. Reads the beginning alone."""
    return _HIMSELF.search(text[:500].replace("’", "'")) is not None or "we met" in text[:500].lower()


def asks_about_himself(text: str) -> bool:
    """Whether a text asks what is known of who speaks."""
    return is_about_himself(text) and inquiry(plain(text)) is not None


def inquiry(text: str) -> Fact | None:
    """What somebody asks about himself: a fact without values, or with those that he wants to have confirmed.

    Example:
        >>> inquiry("Do you know where I live?"), inquiry("Do I live in Bremen?")
        (Fact(topic='home', values=(), gone=False), Fact(topic='home', values=('Bremen',), gone=False))
    """
    for sentence in re.split(r"[.!\n]+|(?<=\?)", text):
        sentence = sentence.strip()
        for asked in (sentence, _LEAD.sub("", sentence)):
            for topic, pattern in _CONFIRMED:
                match = pattern.match(asked)
                if match and (named := values(match[1], TOPICS[topic])):
                    return Fact(topic, named)
            for topic, pattern in _ASKED:
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
        if (
            "remember" in match[0].lower()
            or not _NOT_FORGET.search(before)
            or re.search(
                r"(?:(?:can|could|would|will) you |(?:want|like) (?:you )?to )(?:please |just )*$",
                before,
                re.IGNORECASE,
            )
        ):
            return True
    return False
