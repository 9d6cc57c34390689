"""Bare answers to a question: *hannover*, *chess and football*, *none of your business*."""

from __future__ import annotations

import re
from collections.abc import Collection

from .patterns import either
from .phrase import values
from .statements import gerund, worker
from .topics import NAME, TOPICS, Fact, Kind
from .words import REMARKS, STATES, VERBS

OPENING = re.compile(
    r"^\W*("
    + either(r"""
        oh|well|hm+|um+|uh+|er|ah|ok|okay|alright|sure|yes|yeah|yep|yup|yea|of course|certainly|actually|honestly|so
        that('s| is) easy|let me (see|think)|good question
        i('d| would) say|i guess|i think|i suppose|i said|i mean|i meant|my answer is
        probably|maybe|mostly|mainly|usually|currently|right now|just|only
        it's|its|it is|it must be|it's called|it is called|that's|that is|thats|that would be|that'd be
        they're|they are|they're called|they are called|there is|there's|there are
        one is|one of them is|for example|for instance|such as|like
    """)
    + r"(?![\w'])[\s,.:;!…-]*)*",
    re.IGNORECASE,
)  # fmt: skip
"""Words before an answer."""

_BE = r"(i'm|i am|im)"
_LEADS: dict[Kind, str] = {
    "name": rf"((you can |please )?(call me|i'm called|i am called|{_BE}) )?",
    "place": rf"(({_BE} |i (live|come|came) )?(currently )?(from|in|at|out of) )?(the (city|town|village) of )?",
    "activity": rf"(i ((really|also|mostly|usually|sometimes|often) )*((like|love|enjoy|prefer|do|go)( to)? |(?=({'|'.join(sorted(VERBS))})\b))|"
    rf"{_BE} (into|interested in|fond of) )?",
    "work": r"(i work |i'm working |i am working )?(as )?",
    "organisation": rf"(({_BE} )?(a member of|in|at|for|with|part of) )?",
    "subject": r"(i('m| am)? )?(study|studying|studied|doing|in)? ?",
    "people": r"((his|her|their|its) names? (is|are) )?(((s?he|it)('s| is)|they('re| are)) (called|named) )?((i have|i've got) )?",
    "thing": r"(i ((really|also) )*(like|love|enjoy|prefer) )?",
    "number": rf"({_BE} )?",
}  # fmt: skip
LEADS = {kind: re.compile("^" + words, re.IGNORECASE) for kind, words in _LEADS.items()}
"""Words that introduce an answer of each kind."""

REFUSAL = re.compile(
    r"(?<![\w'])"
    + either(r"""
        (i'd|i would|id) (rather|prefer|like)( to)? (not|keep)\b(?! to (work|live|study))|rather not|prefer not to
        ((it's|that's|it is|that is) )?(none of (your|ur)|not your) (\w+ )?business|mind your own business
        (it's|that's|it is|that is|too|is|very|quite|rather) ((too|very|a bit|quite|rather) )?(private|personal|confidential)|^private\W*$
        (a |my |top )?secret\b(?! (agent|service))
        (i )?(won't|will not|wont|can't|cannot|cant) (tell|say)\b
        i (don't|do not|dont) (want|wish|like|wanna|feel like)( to)? (tell|talk|say|answer|share|discuss)(ing)?\b
        i('m| am) not (telling|saying|going to (tell|say|answer))|not telling|no comment|let's not (talk|speak|go)
        ((let's|let us|can we|please) )?(change|switch) the (subject|topic)|(let's )?talk about something else
        (next|another) question|(i )?pass\W*$|skip( it| this| that| the question)?\W*$
        (that|this|it) is not for you|you don't need to know|(that )?does(n't| not) concern you|stop asking|don't ask
    """),
    re.IGNORECASE,
)  # fmt: skip

NONE = re.compile(
    r"^\W*((no|nope|well|oh|honestly|actually|i have|i've got|i do|at the moment|right now|currently|sorry)\W+)*"
    r"(nothing|none|nobody|no one|noone|nowhere|not any(thing|where|one|body)?)"
    r"( (special|in particular|much|really|at all|at the moment|right now|actually|yet|sorry|to be honest))*\W*$",
    re.IGNORECASE,
)

CORRECTION = re.compile(
    r"^\W*("
    + either(r"""
        no(?! (problem|way|worr(ies|y)|idea|thanks?|need|matter|doubt|chance|clue|one|kidding|offen[cs]e|more|longer|other|big deal|reason|wonder|joke|really))
        nope|nah|wrong|not quite|not really|that('s| is) wrong|that('s| is) not (right|correct|true)
        sorry|actually|wait|oh|i (meant|mean|said)|correction|rather
    """)
    + r"(?![\w'])[\s,.:;!…-]*)+",
    re.IGNORECASE,
)  # fmt: skip
"""Words before a correction."""
_NOT_THIS = re.compile(
    r"^\W*((no|it's|i'm|i am|it is)\W+)?not (?P<wrong>.+?)[,;.]\s*((but|it's|i'm|it is|i am|rather) )?(?P<right>.+)$", re.IGNORECASE
)  # fmt: skip
_NOT_THAT = re.compile(
    r"^(no\W+)?((it's|it is|i'm|i am) )?(?P<right>.+?)[,;]? not (?!in\b|at\b|from\b)(?P<wrong>\w.*)$",
    re.IGNORECASE,
)
_ASIDE = re.compile(r"^\W*((hi+|hello|hey)\b\W*)?(bye|goodbye|let's|lets)\b", re.IGNORECASE)


def refuses(text: str) -> bool:
    """Return whether the user refuses to answer.

    Example:
        >>> refuses("I'd rather not say."), refuses("hannover")
        (True, False)
    """
    return REFUSAL.search(text) is not None


def has_none(text: str) -> bool:
    """Return whether the user says that there are none, such as no hobbies.

    Example:
        >>> has_none("nothing special"), has_none("nothing compares to chess")
        (True, False)
    """
    return NONE.match(text) is not None


def answer(text: str, topic: str) -> list[Fact]:
    """Return the facts in a bare answer to a question about `topic`.

    Args:
        text: The result of `phrase.plain`.
        topic: The topic's name.

    Example:
        >>> answer("chess and football", "hobby"), answer("what?", "hobby")
        ([Fact(topic='hobby', values=('chess', 'football'), gone=False)], [])
    """
    about = TOPICS[topic]
    said = OPENING.sub("", text)
    if _ASIDE.match(said) or "?" in re.split(r"[.!,;\n]", said, maxsplit=1)[0]:
        return []
    rest = LEADS[about.kind].sub("", said)
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
    """Return a bare name. The checks are strict, because anything may be said without an introduction."""
    first = re.split(r"[,.;:!?…\n]", rest.strip(), maxsplit=1)[0].split()
    if not first or not first[0][0].isalpha() or any(word.lower() in STATES for word in first[:3]):
        return ()
    return values(rest, TOPICS[NAME])


def _of(topic: str, said: tuple[str, ...]) -> list[Fact]:
    """Return the facts in bare values. Fewer words may be a value here than after an introduction."""
    words = said[0].lower().split() if said else []
    if not words or (words != ["nice"] and (STATES.issuperset(words) or words[0] in REMARKS)):
        return []
    return [Fact(topic, said)]


def correction(text: str, topic: str, known: Collection[str], *, explicit: bool = False) -> list[Fact]:
    """Return the facts in a correction: *no, Bremen*, *Bremen, not Hannover*.

    Args:
        text: The result of `phrase.plain`.
        topic: The topic to correct.
        known: The values that were understood.
        explicit: Whether only *Bremen, not Hannover* counts, and a mere *no, Bremen* does not.

    Example:
        >>> correction("no, bremen", "home", ["Hannover"])
        [Fact(topic='home', values=('Bremen',), gone=False)]
    """
    denied = {value.casefold() for value in known}
    if both := _NOT_THIS.match(text) or _NOT_THAT.match(text):
        wrong, right = both["wrong"], CORRECTION.sub("", both["right"])
    elif not explicit and (opening := CORRECTION.match(text)):
        return answer(text[opening.end() :], topic) if text[opening.end() :].strip() else []
    else:
        return []
    if not denied & {value.casefold() for value in values(wrong, TOPICS[topic])}:
        return []
    return answer(right, topic)
