"""The user's own words from the agent's view: *my dog bit me* becomes *your dog bit you*.

The listener repeats a phrase of a statement, and now and then the whole statement.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from ravestate.language.contractions import word_set
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QUESTION_WORDS
from ravestate.modules.meta.nlp.tree import SUBJECTS, Tree, Word

LONGEST, SHORTEST = 15, 2
"""The maximum and the minimum number of words of a statement that can be taken up."""

ASKING = word_set("who what when where why which how whose do does did is are was can could will would should may have")
"""Function words that begin a question."""
_ASKED = word_set(
    "who what when where why which how whose whether if or you your right correct yes no ok okay huh eh innit"
)
"""Last words of questions that are worded like a statement: *you are not mad, are you?*, *is correct, yes?*"""
_TURNED = {
    **dict.fromkeys(("i", "we", "me", "us"), "you"),
    **dict.fromkeys(("my", "our"), "your"),
    **dict.fromkeys(("mine", "ours"), "yours"),
    "myself": "yourself",
    "ourselves": "yourselves",
    "your": "my",
    "yours": "mine",
    "yourself": "myself",
}
_YOU = word_set("you u ya")
_ADDRESSING = _YOU | word_set("your yours yourself")
_BE = {"i": {"am": "are", "'m": "'re", "was": "were"}, "you": {"are": "am", "'re": "'m", "were": "was"}}
"""Subject → its form of *be* → the form that the agent says. *I am* becomes *you are*."""
_LEADING = word_set(
    "and but so or well ok okay anyway also then now yes no yeah nope oh ooh ah um uh hm wow haha lol please"
    " actually honestly"
)
"""Words at the beginning of a sentence that have no meaning of their own."""
_TRAILING = word_set("please sorry haha lol look btw too though then honestly")
_ASIDE = ("intj", "parataxis", "preconj")
_ENDS = (".", "!", "?", ",", ";", ":", "-", "…", "...")
_OPINING = word_set("think guess suppose believe")
"""Verbs that only introduce a statement: *I think I will try*."""
DENYING = word_set("not n't never nobody none nothing no cannot hardly barely")
IMAGINING = word_set("could should would might may maybe perhaps")
"""Words of a statement about something that may never happen."""
_BARE = word_set("be have do can will would want know like mean")
"""Verbs that say nothing without the words after them."""
_WISHING = word_set("want plan hope intend wish like")
"""Verbs that turn the verb after them into a plan: *I want to try*."""
_MOVING = word_set("go come move fly travel drive leave arrive visit meet start")
"""Verbs whose progressive form tells a plan: *we are flying to Rome*."""
_LASTING = word_set("be have know like love hate want need live belong mean seem look feel")
_USUALLY = word_set("always usually often every sometimes never")
"""Words that show a habit."""
_POLITE = word_set("think know believe say tell guess suppose reckon")
"""Verbs that only introduce a question: *how old do you think he is*."""


@dataclass(frozen=True, slots=True)
class Told:
    """A statement of the user."""

    echo: str
    """The statement from the agent's view, without a capital or a full stop: *your dog bit you*."""
    subject: str = "thing"
    """``mine``, ``theirs`` (somebody else), ``thing``, ``yours`` (the agent), or ``piece`` for a statement without a verb."""
    tense: str = "now"
    """``past``, ``now``, ``plan``, ``might`` (imagined), ``once`` (a habit of the past) or ``not`` (denied). A past state, such
    as *it was red*, counts as ``now``, because *what happened next?* would not suit it."""
    start: int = 0
    """The index of the statement's first word in the utterance."""


def told_in(seen: Analysis, living: frozenset[str]) -> list[Told]:
    """Return the statements of an utterance that can be taken up, the last sentence first.

    Args:
        seen: The analysis of the utterance.
        living: The lemmas of nouns for living beings.
    """
    told = [
        words_of(seen.tree, one)
        for one in reversed(seen.sentences)
        if not one.rstrip().endswith("?") or is_astonished(seen, one)
    ]
    clauses = [clause for words in told for clause in _clauses(seen.tree, words, living)]
    return clauses or list(filter(None, (_fragment(seen.tree, words) for words in told)))


def is_astonished(seen: Analysis, sentence: str) -> bool:
    """Return whether a sentence is a statement about others with a question mark: *he says it relaxes them??*"""
    words = [word for word in words_of(seen.tree, sentence) if word.pos not in ("PUNCT", "INTJ", "CCONJ")]
    low = [word.low for word in words]
    if low[-2:] == ["you", "know"] and len(low) > 4:  # "it's been a bad week, you know?"
        return True
    if len(low) < 4 or low[0] in ASKING or not _ASKED.isdisjoint(low):
        return False
    subject = next((word for word in words if word.dep in SUBJECTS), None)
    verb = None if subject is None else seen.tree.head(subject)
    helpers = [] if verb is None else [verb, *seen.tree.children(verb, "aux", "auxpass")]
    return subject is not None and all(word.index > subject.index for word in helpers)


def words_of(tree: Tree, sentence: str) -> list[Word]:
    """Return the words of a sentence; if the text does not contain this sentence, all words of the text."""
    start = tree.text.lower().find(sentence.lower().rstrip(".!?")) if sentence else 0
    end = start + len(sentence) if sentence and start >= 0 else len(tree.text)
    return [word for word in tree.words if max(start, 0) <= word.start < end]


def echo(tree: Tree, words: Sequence[Word]) -> str:
    """Return words from the agent's view. The first word has no capital, unless it is a name."""
    text = ""
    for place, word in enumerate(words):
        last = words[place - 1] if place else None
        gap = last is not None and (word.start > last.end or word.index != last.index + 1)
        part = _turned(tree, word)
        if last is None and word.pos != "PROPN" and part != "I":
            part = part[:1].lower() + part[1:]
        beside = last is not None and word.index == last.index + 1
        text += " " * (gap and (beside or word.pos != "PUNCT")) + part
    return text


def _addresses(word: Word, before: Word | None) -> bool:
    """Return whether a word addresses the agent; in *thank you*, it does not."""
    return word.low in _ADDRESSING and (before is None or before.low != "thank")


def wraps(words: Sequence[Word]) -> bool:
    """Return whether the first three words only introduce a question: *do you think he*, *can you tell me*."""
    first, second, third, after = words
    wraps = first.tag in ("MD", "VBP", "VBD") and second.low in _YOU and third.lemma.lower() in _POLITE
    if third.lemma.lower() in ("say", "tell"):
        return wraps and after.low in ("me", "us")  # not "would you tell him?"
    if third.lemma.lower() == "know":
        return wraps and after.low in {*QUESTION_WORDS, "if", "whether"}  # not "do you know any songs?"
    return wraps and after.low not in ("about", "of") and after.pos != "PROPN"


def _turned(tree: Tree, word: Word) -> str:
    low = word.low
    if low in _YOU and not _addresses(word, tree.before(word)):
        return word.text
    if low in _YOU:
        return "I" if word.dep in SUBJECTS else "me"
    if low in _TURNED and word.pos != "NOUN":
        return _TURNED[low]
    if word.pos in ("AUX", "VERB"):
        verb = word if tree.children(word, *SUBJECTS) else tree.head(word)
        for subject in tree.children(verb, *SUBJECTS):
            person = "you" if subject.low in _YOU else subject.low
            return _BE.get(person, {}).get(low, word.text)
    return word.text


def _trimmed(words: Sequence[Word]) -> list[Word]:
    """Return words without punctuation at either end, and without introductory words."""
    found = list(words)
    while found and (found[0].pos == "PUNCT" or found[0].dep == "intj" or found[0].low in _LEADING):
        found.pop(0)
    if len(found) > 2 and found[0].low in _YOU and found[1].text == ",":  # "and you, what do you like?"
        found = found[2:]
    while found and (found[-1].text in _ENDS or found[-1].low in _TRAILING or found[-1].dep in ("intj", "cc")):
        found.pop()
    return found


def _clauses(tree: Tree, words: Sequence[Word], living: frozenset[str]) -> list[Told]:
    inside = {word.index for word in words}
    return [one for verb in words if (one := _told(tree, verb, living, inside)) is not None]


def _told(tree: Tree, verb: Word, living: frozenset[str], inside: set[int]) -> Told | None:
    """Return the clause of a verb; None if it is no main clause. If the clause cannot be repeated, its text is empty."""
    subjects = [word for word in tree.children(verb, *SUBJECTS, "expl") if word.index < verb.index]
    main = verb.dep == "ROOT" or (verb.dep == "conj" and tree.head(verb).dep == "ROOT")
    inner = [word for word in tree.children(verb, "ccomp") if tree.children(word, *SUBJECTS)]
    if main and subjects and subjects[0].low == "i" and verb.lemma in _OPINING and inner and verb.low in _OPINING:
        verb, subjects = inner[0], tree.children(inner[0], *SUBJECTS)
    if not main or verb.pos not in ("VERB", "AUX") or not subjects or subjects[0].low in QUESTION_WORDS:
        return None
    subject = next((word for word in subjects if word.dep != "expl"), subjects[0])
    words = _repeatable(tree, verb, subject, inside)
    return Told(
        echo(tree, words),
        _person(tree, subject, living),
        _tense(tree, verb, subjects),
        start=subjects[0].index,
    )


def _repeatable(tree: Tree, verb: Word, subject: Word, inside: set[int]) -> list[Word]:
    """Return a clause's words to repeat, without asides; none if it is too long, odd or about people in general."""
    for dropped in ((), (",",), ("advcl",), ("advcl", "npadvmod", "advmod", "prep")):
        words = _trimmed([word for word in _within(tree, verb, dropped) if word.index in inside])
        comma = next(
            (at for at, word in enumerate(words) if word.text in dropped and word.index > verb.index), len(words)
        )
        words = words[:comma]
        if SHORTEST <= len(words) <= LONGEST and words[0].low not in QUESTION_WORDS:
            break
    else:
        return []
    if words[0].tag in ("MD", "VB") or _is_slip(tree, subject, verb) or _is_cut(tree, verb):
        return []
    if subject.low in _YOU and any(word.tag == "MD" for word in tree.children(verb)):
        return []  # "you can talk there": "you" means people in general
    if subject.low not in _YOU and any(_addresses(word, tree.before(word)) for word in words):
        return []
    return words


def _tense(tree: Tree, verb: Word, subjects: Sequence[Word]) -> str:
    chain = list(_chain(tree, verb))
    helpers = {word.low for word in tree.children(verb, "aux", "auxpass")}
    beside = {word.low for word in tree.children(verb)}
    if any(word.low in DENYING for word in (*tree.children(verb), *subjects)):
        return "not"
    if verb.lemma == "use" and len(chain) > 1 and chain[1].tag == "VB":
        return "once"
    if verb.tag == "VBD" and _USUALLY & beside:
        return "once"
    if IMAGINING & beside:
        return "might"
    moving = verb.lemma in _MOVING or (verb.lemma == "go" and len(chain) > 1)
    wishing = verb.lemma in _WISHING and verb.tag != "VBD" and len(chain) > 1
    if (moving and verb.tag == "VBG" and not helpers & {"was", "were", "been"}) or wishing:
        return "plan"
    if helpers & {"will", "'ll", "shall"}:
        return "plan"
    past = verb.tag in ("VBD", "VBN") or not helpers.isdisjoint(("did", "had", "was", "were"))
    return "past" if past and verb.lemma not in _LASTING else "now"  # a state is no event


def _is_cut(tree: Tree, verb: Word) -> bool:
    """Return whether a clause lacks the words that its verb needs, as in *every sock he had*."""
    after = [word for word in tree.children(verb) if word.index > verb.index and word.pos != "PUNCT"]
    return verb.lemma in _BARE and not after


def _is_slip(tree: Tree, subject: Word, verb: Word) -> bool:
    """Return whether verb and subject disagree, as in *she live here*. The agent does not repeat slips."""
    single = subject.low in ("he", "she", "it") or subject.tag == "NN"
    both = tree.children(subject, "conj")
    return single and not both and verb.tag in ("VB", "VBP") and not tree.children(verb, "aux", "auxpass")


def _within(tree: Tree, verb: Word, dropped: Sequence[str]) -> list[Word]:
    """Return the words of a clause without asides, without further clauses, and without some kinds of phrases."""
    found = [verb]
    for child in tree.children(verb):
        beside = child.dep == "conj" or (child.dep == "ccomp" and child.index < verb.index)
        other = beside and bool(tree.children(child, *SUBJECTS))
        if not other and child.dep not in (*_ASIDE, *dropped):
            found += tree.subtree(child)
    kept = {word.index for word in found}
    inside = [word for word in found if word.pos != "PUNCT" or kept >= {word.index - 1, word.index + 1}]
    return sorted(inside, key=lambda word: word.index)


def _chain(tree: Tree, verb: Word) -> Iterator[Word]:
    """Yield a verb and the verbs that it governs: *want to bake*."""
    yield verb
    for child in tree.children(verb, "xcomp"):
        if child.pos == "VERB":
            yield from _chain(tree, child)


def _person(tree: Tree, subject: Word, living: frozenset[str]) -> str:
    if subject.low in ("i", "we", *_YOU):
        return "yours" if subject.low in _YOU else "mine"
    alive = subject.low in ("he", "she", "they", "who", "somebody", "someone", "everybody", "everyone", "nobody")
    named = subject.pos == "PROPN" and not tree.children(subject, "det")
    return "theirs" if alive or named or subject.lemma.lower() in living else "thing"


def _fragment(tree: Tree, words: Sequence[Word]) -> Told | None:
    """Return a noun phrase that stands for a sentence: *forty wooden puppets*."""
    kept = _trimmed(words)
    nominal = any(word.dep == "ROOT" and word.pos in ("NOUN", "PROPN") for word in kept)
    if any(word.low in ("i", "he", "she", "we", "they") for word in kept):
        return None
    if not nominal or not SHORTEST <= len(kept) <= LONGEST or any(word.pos in ("VERB", "AUX") for word in kept):
        return None
    text = echo(tree, kept)
    return Told(text, "piece", start=kept[0].index)
