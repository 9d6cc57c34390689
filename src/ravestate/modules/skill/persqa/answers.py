"""What is said in answer to a question, without saying it all: *hannover*, *chess and football*, *none of your business*."""

from __future__ import annotations

import re
from collections.abc import Collection

from .phrase import values
from .statements import gerund, worker
from .topics import NAME, TOPICS, Fact, Kind
from .words import REMARKS, STATES, VERBS

__all__ = ["answer", "correction", "has_none", "refuses"]

OPENING = re.compile(
    r"^\W*(?:(?:oh|well|hm+|um+|uh+|er|ah|ok|okay|alright|sure|yes|yeah|yep|yup|yea|of course|certainly|actually|honestly|so|"
    r"that's easy|that is easy|let me see|let me think|good question|i(?:'d| would) say|i guess|i think|i suppose|probably|maybe|"
    r"mostly|mainly|usually|currently|right now|just|only|i said|i mean|i meant|my answer is|it must be|"
    r"it's|its|it is|it's called|it is called|that's|that is|thats|that would be|that'd be|they're|they are|they're called|"
    r"they are called|there is|there's|there are|one is|one of them is|for example|for instance|such as|like)(?![\w'])[\s,.:;!…-]*)*",
    re.IGNORECASE,
)
"""What one says before an answer."""

LEAD: dict[Kind, str] = {
    "name": r"(?:you can |please )?(?:call me|i'm called|i am called|(?:i'm|i am|im)) ",
    "place": r"(?:(?:(?:i'm|i am|im) |i (?:live|come|came) )?(?:currently )?(?:from|in|at|out of) )?(?:the (?:city|town|village) of )?",
    "activity": r"(?:i (?:(?:really|also|mostly|usually|sometimes|often) )*(?:(?:like|love|enjoy|prefer|do|go)(?: to)? |"
    rf"(?=(?:{'|'.join(sorted(VERBS))})\b))|(?:i'm|i am|im) (?:into|interested in|fond of) )?",
    "work": r"(?:i work |i'm working |i am working )?(?:as )?",
    "organisation": r"(?:(?:(?:i'm|i am|im) )?(?:a member of|in|at|for|with|part of) )?",
    "subject": r"(?:i(?:'m| am)? )?(?:study|studying|studied|doing|in)? ?",
    "people": r"(?:(?:his|her|their) names? (?:is|are) )?(?:(?:i have|i've got) )?",
}

REFUSAL = re.compile(
    r"(?<![\w'])(?:(?:i'd|i would|id) (?:rather|prefer|like)(?: to)? (?:not|keep)\b(?! to (?:work|live|study))|rather not|prefer not to|"
    r"(?:it's |that's |it is |that is )?none of (?:your|ur) (?:\w+ )?business|not your (?:\w+ )?business|mind your own business|"
    r"(?:it's|that's|it is|that is|too|is|very|quite|rather) (?:too |very |a bit |quite |rather )?(?:private|personal|confidential)|^private\W*$|"
    r"(?:it's |that's |that is |it is )?(?:a |my |top )?secret\b(?! (?:agent|service))|(?:i )?(?:won't|will not|wont|can't|cannot|cant) (?:tell|say)\b|"
    r"i (?:don't|do not|dont) (?:want|wish|like|wanna|feel like)(?: to)? (?:tell|talk|say|answer|share|telling|talking|saying|answering|sharing|discuss)\w*|"
    r"i(?:'m| am) not (?:telling|saying|going to (?:tell|say|answer))|not telling|no comment|let's not (?:talk|speak|go)|"
    r"(?:let's |let us |can we |please )?(?:change|switch) the (?:subject|topic)|(?:let's )?talk about something else|"
    r"(?:next|another) question|(?:i )?pass\W*$|skip(?: it| this| that| the question)?\W*$|"
    r"(?:that|this|it) is not for you|you don't need to know|(?:that )?does(?:n't| not) concern you|stop asking|don't ask)",
    re.IGNORECASE,
)

NONE = re.compile(
    r"^\W*(?:(?:no|nope|well|oh|honestly|actually|i have|i've got|i do|at the moment|right now|currently|sorry)\W+)*"
    r"(?:nothing|none|nobody|no one|noone|nowhere|nothing (?:special|really|in particular|at all|much)|none (?:really|at all)|not any(?:thing|where|one|body)?)"
    r"(?: (?:really|at all|at the moment|right now|actually|special|yet|sorry|to be honest))*\W*$",
    re.IGNORECASE,
)

CORRECTION = re.compile(
    r"^\W*(?:(?:no(?! (?:problem|way|worries|worry|idea|thanks|thank|need|matter|doubt|chance|clue|one|kidding|offen[cs]e|more|longer|"
    r"other|big deal|reason|wonder|joke|really))|nope|nah|wrong|not quite|not really|that's wrong|that is wrong|that's not (?:right|correct|true)|sorry|actually|wait|oh|"
    r"i (?:meant|mean|said)|correction|rather)(?![\w'])[\s,.:;!…-]*)+",
    re.IGNORECASE,
)
_NOT_THIS = re.compile(
    r"^\W*(?:(?:no|it's|i'm|i am|it is)\W+)?not (.+?)[,;.]\s*(?:but |it's |i'm |it is |i am |rather )?(.+)$",
    re.IGNORECASE,
)
_NOT_THAT = re.compile(
    r"^(?:no\W+)?(?:it's |it is |i'm |i am )?(.+?)[,;]? not (?!in\b|at\b|from\b)(\w.*)$", re.IGNORECASE
)
_ASIDE = re.compile(r"^\W*(?:(?:hi+|hello|hey)\b\W*)?(?:bye|goodbye|let's|lets)\b", re.IGNORECASE)


def refuses(text: str) -> bool:
    """Whether somebody does not want to say.

    Example:
        >>> refuses("I'd rather not say."), refuses("hannover")
        (True, False)
    """
    return REFUSAL.search(text) is not None


def has_none(text: str) -> bool:
    """Whether somebody says that there is none.

    Example:
        >>> has_none("nothing special"), has_none("nothing compares to chess")
        (True, False)
    """
    return NONE.match(text) is not None


def answer(text: str, topic: str) -> list[Fact]:
    """The facts in words that answer a question about `topic`, and make sense as an answer alone.

    Args:
        text: As `phrase.plain` makes it.
        topic: The topic's name.

    Example:
        >>> answer("chess and football", "hobby"), answer("what?", "hobby")
        ([Fact(topic='hobby', values=('chess', 'football'), gone=False)], [])
    """
    about = TOPICS[topic]
    said = OPENING.sub("", text)
    if _ASIDE.match(said) or "?" in re.split(r"[.!,;\n]", said, maxsplit=1)[0]:
        return []
    rest = re.sub(
        rf"^{LEAD[about.kind]}" if topic != NAME else rf"^(?:{LEAD['name']})?", "", said, flags=re.IGNORECASE
    )
    if about.kind == "name":
        return _of(topic, _name(rest))
    if about.kind == "work":
        facts = worker(re.sub(r"^an? ", "", rest, flags=re.IGNORECASE))
        return facts if facts and _of(topic, facts[0].values) else []
    if about.kind == "activity":
        return _of(topic, values(gerund(rest), about))
    if topic == "subject" and (where := re.match(r"(?:[^,.;]*? )?at (.+)", rest, re.IGNORECASE)):
        return [*_of(topic, values(rest, about)), *_of("university", values(where[1], TOPICS["university"]))]
    return _of(topic, values(rest, about))


def _name(rest: str) -> tuple[str, ...]:
    """A name that nothing introduces: more is asked of it, for anything may be said without introduction."""
    first = re.split(r"[,.;:!?…\n]", rest.strip(), maxsplit=1)[0].split()
    if not first or not first[0][0].isalpha() or any(word.lower() in STATES for word in first[:3]):
        return ()
    return values(rest, TOPICS[NAME])


def _of(topic: str, said: tuple[str, ...]) -> list[Fact]:
    """The facts in words that nothing introduces: less may be a value there."""
    words = said[0].lower().split() if said else []
    if not words or (words != ["nice"] and (STATES.issuperset(words) or words[0] in REMARKS)):
        return []
    return [Fact(topic, said)]


def correction(text: str, topic: str, known: Collection[str]) -> list[Fact]:
    """The facts in words that put right what was understood about `topic`: *no, Bremen*, *Bremen, not Hannover*.

    Args:
        text: As `phrase.plain` makes it.
        topic: The topic's name.
        known: The values that were understood.

    Example:
        >>> correction("no, bremen", "home", ["Hannover"])
        [Fact(topic='home', values=('Bremen',), gone=False)]
    """
    denied = {value.casefold() for value in known}
    if both := _NOT_THIS.match(text):
        wrong, right = both[1], both[2]
    elif both := _NOT_THAT.match(text):
        wrong, right = both[2], CORRECTION.sub("", both[1])
    elif opening := CORRECTION.match(text):
        return answer(text[opening.end() :], topic) if text[opening.end() :].strip() else []
    else:
        return []
    if not denied & {value.casefold() for value in values(wrong, TOPICS[topic])}:
        return []
    return answer(right, topic)
