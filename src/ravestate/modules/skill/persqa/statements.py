"""What somebody states of himself, whether he was asked or not: *I live in Hannover and work as a baker*."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator

from .phrase import values
from .topics import NAME, TOPICS, Fact
from .words import NO_STUDENT, OCCUPATIONS, STATES, VERBS

__all__ = ["gerund", "statements", "worker"]

ADVERBS = (
    r"(?:(?:actually|currently|now|still|just|really|also|mostly|originally|mainly|usually|only|sort of|kind of|always|"
    r"already|recently|sometimes|often) )*"
)
AM = rf"(?:i am|i'm|im) {ADVERBS}"
HAVE = rf"(?:i have|i've|ive|i) {ADVERBS}"
I = rf"i {ADVERBS}"  # noqa: E741  # it is the word
FREE = r"(?:in|during) my (?:free|spare) time|for fun|as a hobby|in my leisure time"
GROUP = (
    r"(?:[\w-]+ ){0,4}?(?:club|team|choir|band|orchestra|union|party|association|society|league|group|church|fire brigade|"
    r"fire department|circle)\b.*"
)

PATTERNS: tuple[tuple[str, str], ...] = (
    # name
    (NAME, r"my (?:full |first |real |own )?name(?:'s| is|s) (?:actually |really |just )?(.+)"),
    (NAME, r"the name(?:'s| is) (.+)"),
    (NAME, r"(?<!don't )(?<!not )(?:you (?:can|may|should|could) |please |just |everybody |everyone |people |they |my friends )calls? me (.+)"),
    (NAME, r"^(?:no,? |well,? |hi,? |hello,? )?call me (.+)"),
    (NAME, rf"{AM}(?:called|named) (.+)"),
    (NAME, r"i go by (?:the name (?:of )?)?(.+)"),
    # home
    ("home", rf"{I}(?:live|reside) in (?:the (?:city|town|village) of )?(.+)"),
    ("home", rf"{AM}living in (?:the (?:city|town|village) of )?(.+)"),
    ("home", r"my home is (?:in )?(.+)"),
    ("home", r"i call ([^,.]+?) (?:my )?home"),
    ("home", rf"{HAVE}moved (?:from \S+ )?to (.+)"),
    # origin
    ("origin", rf"{I}(?:come|came|hail|stem) {ADVERBS}from (.+)"),
    ("origin", rf"{AM}from (.+)"),
    ("origin", r"i was (?:born|raised|born and raised|brought up) in (.+)"),
    ("origin", r"i grew up in (.+)"),
    ("origin", r"my (?:home ?town|home country|native (?:town|city|country)|birthplace|place of birth) is (.+)"),
    # hobby
    ("hobby", r"my (?:only |main |biggest |favou?rite |big )?(?:hobby|hobbies|pastimes?)(?: is| are|'s|'re) (.+)"),
    ("hobby", r"one of my (?:favou?rite )?(?:hobbies|pastimes) is (.+)"),
    ("hobby", r"^([\w ,'-]{2,60}?) (?:is|are) (?:my|one of my) (?:favou?rite |main )?(?:hobby|hobbies|pastimes?)\b"),
    ("hobby:verb", rf"(?:{FREE}),? {I}(?:(?:like|love|enjoy) (?:to )?)?(.+)"),
    ("hobby:verb", rf"{I}(?:(?:like|love|enjoy) (?:to )?)?([\w ,'-]+?) (?:{FREE})"),
    # occupation
    ("occupation", rf"{HAVE}work(?:ed|ing)? (?:full[- ]time |part[- ]time )?as (.+)"),
    ("occupation", rf"{AM}(?:working|employed) (?:full[- ]time |part[- ]time )?as (.+)"),
    ("occupation", r"my (?:profession|occupation|trade) is (?:being |to be |that of )?(.+)"),
    ("occupation", r"my job is (?:being |to be |that of )?(?=an? )(.+)"),
    ("occupation", rf"{AM}(an? [\w -]+?) by (?:profession|trade|training)"),
    ("occupation", r"i (?:earn|make) (?:my|a) (?:living|money) as (.+)"),
    # employer
    ("employer", rf"{I}work (?:[\w ]{{1,40}}? )?(?:for|at) (.+)"),
    ("employer", rf"{I}work (?:as [\w ]{{1,40}}? )?in (?=(?:an?|the|our) (?!field|area|evening|morning|afternoon|city|town|night))(.+)"),
    ("employer", rf"{AM}(?:working|employed) (?:[\w ]{{1,40}}? )?(?:for|at|by) (.+)"),
    ("employer", r"my (?:employer|company|firm) is (?:called )?(.+)"),
    # studies
    ("subject", rf"{I}study (.+)"),
    ("subject", rf"{AM}studying (.+)"),
    ("subject", r"my (?:major|subject|field of study) is (.+)"),
    ("subject", r"i(?:'m| am)? major(?:ed|ing)? in (.+)"),
    ("subject", rf"{AM}(?:a |an )?student of (.+)"),
    ("subject", rf"{AM}doing (?:a |an |my )?(?:degree|phd|master'?s?|bachelor'?s?) in (.+)"),
    ("university", rf"{I}study (?:[\w ]{{1,40}}? )?at (.+)"),
    ("university", rf"{AM}(?:studying|enrolled|a student) (?:[\w ]{{1,40}}? )?at (.+)"),
    ("university", r"i go to ((?:[\w-]+ ){0,4}(?:university|college)\b.*)"),
    ("university", r"my (?:university|college|uni) is (?:called )?(.+)"),
    # friends
    ("friend", r"my (?:(?:very )?(?:best|closest|close|good|other|new) )?(?:friends?|buddy|buddies|mates?)(?:'s names?| names?)? (?:is|are)(?: called| named)? (.+)"),
    ("friend", r"(?:i have|i've got) (?:an?|one|two|three|some|a few|many) (?:(?:very )?(?:best|close|good) )?friends? (?:who is |who are )?(?:called|named) (.+)"),
    ("friend", r"^([\w ,&'-]{2,60}?) (?:is|are) my (?:best |good |close )?friends?\b"),
    # clubs
    ("club", rf"{AM}(?:an? )?(?:\w+ )?member (?:of|in) (.+)"),
    ("club", r"i belong to (.+)"),
    ("club", rf"{HAVE}joined (.+)"),
    ("club", rf"{AM}in ((?:an?|the|our) {GROUP})"),
    ("club", rf"{I}(?:play|sing|dance|train|swim) (?:\w+ )?(?:in|with|at) ((?:an?|the|our) {GROUP})"),
)  # fmt: skip
"""A topic, and words that introduce it."""

GONE: tuple[tuple[str, str], ...] = (
    ("home", rf"{I}(?:don't|do not|dont) {ADVERBS}live (?:in (.+?)|there|here)(?: any ?(?:more|longer))?(?=$|[,.;!])"),
    ("home", rf"{I}no longer live (?:in (.+?)|there|here)(?=$|[,.;!])"),
    ("home", rf"{HAVE}moved (?:away|out)(?: (?:from|of) (.+?))?(?=$|[,.;!])"),
    ("origin", rf"{AM}not (?:originally )?from (?:there|(.+?))(?=$|[,.;!])"),
    ("origin", rf"{I}(?:don't|do not|dont) come from (?:there|(.+?))(?=$|[,.;!])"),
    ("hobby", r"i (?:don't|do not|dont) (?:really )?have (?:any |a |many )?hobb(?:y|ies)()"),
    ("hobby", r"i(?:'ve| have)(?: got)? no hobb(?:y|ies)()"),
    ("occupation", r"i (?:don't|do not|dont) have a job()"),
    ("occupation", r"i(?:'ve| have)(?: got)? no job()"),
    ("occupation", r"i (?:don't|do not|dont) work(?: any ?more)?()(?=$|[,.;!])"),
    ("occupation", rf"{AM}(?:unemployed|jobless|out of work|between jobs|looking for (?:a job|work))()"),
    ("occupation", rf"{HAVE}(?:quit|lost) my job()"),
    ("occupation", rf"{AM}no longer (an? (?!(?:\w+ )?member).+?)(?=$|[,.;!])"),
    ("occupation", rf"{AM}not (an? (?!(?:\w+ )?member).+?) any ?more"),
    ("employer", rf"{I}(?:don't|do not|dont) work (?:there|(?:for|at) (.+?))(?: any ?(?:more|longer))?(?=$|[,.;!])"),
    ("employer", rf"{I}no longer work (?:there|(?:for|at) (.+?))(?=$|[,.;!])"),
    ("subject", rf"{I}(?:don't|do not|dont) study(?: any ?(?:more|thing))?()(?=$|[,.;!])"),
    ("subject", rf"{I}no longer study()"),
    ("subject", rf"{HAVE}(?:stopped|quit|finished) (?:studying|my studies)()"),
    ("friend", r"i (?:don't|do not|dont) have (?:any |many )?friends()"),
    ("friend", r"i(?:'ve| have)(?: got)? no friends()"),
    ("friend", r"^(.+?) (?:is|are) (?:not|no longer) my friends?\b"),
    ("club", rf"{AM}not (?:a |an )?(?:\w+ )?members? of (?:any ?thing|any .*)()"),
    ("club", rf"{AM}(?:no longer|not) (?:a |an )?(?:\w+ )?member of (.+?)(?: any ?more)?(?=$|[,.;!])"),
    ("club", rf"{HAVE}left (the .+? (?:club|team|choir|band|party|union))\b"),
    (NAME, r"my name(?:'s not| is not| isn't| ain't) (.+?)(?=$|[,.;!])"),
)  # fmt: skip
"""A topic, and words by which it is not, or no longer, so."""

_BEFORE = r"(?<![\w'])"
_STATED = tuple((topic, re.compile(_BEFORE + words, re.IGNORECASE)) for topic, words in PATTERNS)
_DENIED = tuple((topic, re.compile(_BEFORE + words, re.IGNORECASE)) for topic, words in GONE)

_I_AM = re.compile(rf"{_BEFORE}(?:{AM}|this is )(.+)", re.IGNORECASE)
_A = re.compile(r"(?:an? )(.+)", re.IGNORECASE)
_STUDENT = re.compile(r"(?:an? )?((?!an? )(?:[\w-]+ ){1,3}?)student\b", re.IGNORECASE)
_SPEAKER = re.compile(r"(?<![\w'])(?:i|i'm|im|i've|my (?:\w+ )?name)(?![\w'])", re.IGNORECASE)
_JOINED = re.compile(
    rf"(?<=\w )(and|but) (?={ADVERBS}(?:live|work|study|come from|moved to|grew up|was born|am|belong to|joined)\b)",
    re.IGNORECASE,
)
"""A second verb that shares its subject: *I live in Ulm and work as a baker*."""
_UNREAL = re.compile(
    r"\b(?:if|when|whenever|wish|unless|until|once|suppose|imagine|pretend|say|says|said|whether|where|before|while|after|"
    r"dreamt|dreamed|thought|think|thinks|hope|because)(?: that)? $",
    re.IGNORECASE,
)
"""Before a statement: it is none of how things are."""

"""What "I am a ..." makes an occupation, where nobody has asked for one."""


def statements(text: str, *, persons: Collection[str] = (), asked: str = "") -> list[Fact]:
    """The facts that somebody states of himself, one for each topic.

    Args:
        text: As `plain` makes it.
        persons: What in it is known to be a person's name.
        asked: The topic that he was asked about, or an empty string.

    Example:
        >>> statements("My name is Ada and I live in new york.")
        [Fact(topic='name', values=('Ada',), gone=False), Fact(topic='home', values=('New York',), gone=False)]
    """
    if speaker := _SPEAKER.search(text):
        text = text[: speaker.end()] + _JOINED.sub(r"\1 i ", text[speaker.end() :])
    found: dict[str, Fact] = {}
    for fact in (*_stated(text, persons, asked), *_denied(text), *_being(text, persons, asked)):
        if fact.topic not in found or (
            found[fact.topic].gone and not fact.gone
        ):  # "not Ulm, I live in Bremen"
            found[fact.topic] = fact
    if (
        asked == "home" and "origin" in found and "home" not in found
    ):  # who is asked for his home, and "is from" there
        origin = found.pop("origin")
        found["home"] = Fact("home", origin.values, origin.gone)
    return list(found.values())


def _stated(text: str, persons: Collection[str], asked: str) -> Iterator[Fact]:
    for name, pattern in _STATED:
        topic, _, form = name.partition(":")
        for match in pattern.finditer(text):
            if _UNREAL.search(text[: match.start()]):
                continue
            rest = match[1]
            said = values(gerund(rest) if form else rest, TOPICS[topic])
            if (
                topic == "friend"
                and "called" not in match[0]
                and "named" not in match[0]
                and "name" not in match[0]
            ):
                said = tuple(value for value in said if asked == "friend" or _is_person(value, text, persons))
            if topic == "occupation" and not form and rest.lower().startswith("student"):
                said = ("student",)
            if said:
                yield Fact(topic, said)
                break


def _denied(text: str) -> Iterator[Fact]:
    for topic, pattern in _DENIED:
        match = pattern.search(text)
        if match is not None and not _UNREAL.search(text[: match.start()]):
            yield Fact(topic, values(match[1], TOPICS[topic]) if match[1] else (), gone=True)


def _being(text: str, persons: Collection[str], asked: str) -> Iterator[Fact]:
    """*I am ...*: a name, or an occupation."""
    for match in _I_AM.finditer(text):
        if _UNREAL.search(text[: match.start()]):
            continue
        rest = match[1]
        student = _STUDENT.match(rest)
        subject = values(student[1], TOPICS["subject"]) if student else ()
        if student and subject and not NO_STUDENT & set(student[1].lower().split()):
            yield Fact("occupation", ("student",))
            yield Fact("subject", subject)
            return
        if a := _A.match(rest):
            said = values(a[1], TOPICS["occupation"])
            if said and (asked == "occupation" or _heads(said[0])):
                yield from worker(a[1])
                return
        elif asked == "occupation" or re.match(r"(?:retired|self-employed)\b", rest, re.IGNORECASE):
            if facts := worker(rest):
                yield from facts
                return
        elif (said := values(rest, TOPICS[NAME])) and (asked == NAME or _is_person(said[0], text, persons)):
            yield Fact(NAME, said)
            return


def worker(text: str) -> list[Fact]:
    """The facts in *baker at Siemens*: an occupation, and where."""
    said = values(text, TOPICS["occupation"])
    if not said:
        return []
    where = re.match(r"[^,.;!?]*? (?:at|for) (.+)", text, re.IGNORECASE)
    place = "university" if said == ("student",) else "employer"
    there = values(where[1], TOPICS[place]) if where else ()
    return [Fact("occupation", said), *([Fact(place, there)] if there else [])]


def _heads(value: str) -> bool:
    """Whether the noun that heads it is an occupation: *head of school* has *head*, *school teacher* has *teacher*."""
    return value.lower().split(" of ")[0].split()[-1] in OCCUPATIONS


def _is_person(value: str, text: str, persons: Collection[str]) -> bool:
    """Whether a value is known to be somebody's name."""
    low = value.lower()
    return low.split()[0] not in STATES and any(low == person.lower() for person in persons)


_DOUBLED = frozenset(["swim", "run", "jog", "knit", "program", "blog"])
_KEPT = frozenset(["ski", "do", "go"])


def gerund(text: str) -> str:
    """Turn what one does into a hobby.

    Example:
        >>> gerund("read books and swim")
        'reading books and swimming'
    """
    return re.sub(r"(^|\b(?:and|or) |, ?)(?:to )?(\w+)", lambda found: found[1] + _gerund(found[2]), text)


def _gerund(verb: str) -> str:
    low = verb.lower()
    if low not in VERBS:
        return verb
    if low in _DOUBLED:
        return low + low[-1] + "ing"
    return (low[:-1] if low.endswith("e") and low not in _KEPT else low) + "ing"
