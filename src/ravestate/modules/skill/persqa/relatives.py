"""The names that an utterance gives: of relatives, friends and pets, and of the user."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

from ravestate.modules.meta.nlp.tree import Tree, Word

from .introduced import introduced_in
from .topics import NAME, WORDS
from .utterance import Utterance, is_former, owner_before

_NOMINAL = frozenset(["PROPN", "NOUN", "X", "ADJ"])
_OWN = frozenset(["my", "our"])


def named_in(reader: Utterance) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the relatives that the user names, with their names: *my sister Rosa*, *my mother's name is Anna*,
    *a son named Ben*, *call me Tom*.

    The parser often misses the second of two relatives, so this function reads the words one by one."""
    unsaid: set[str] = set()
    whole: list[tuple[str, tuple[str, ...]]] = []
    for said in reader.seen.statements:
        phrases = (said.subject, said.object, *said.phrases)
        everyone = said.subject.text.lower() in ("everyone", "everybody", "people", "they", "friends")
        allowed = said.verb == "call" and (said.subject.person == "you" or everyone)  # "you may call me Fitz"
        open = (said.question or said.conditional or said.hearsay or said.plan) and not allowed
        open = open or (said.past and not said.subject.names)
        if open or (said.negated and said.verb == "call"):
            unsaid |= {said.verb, *said.object.text.split(), *(phrase.head for phrase in phrases)}
        for phrase in phrases if not open else ():
            mine = (phrase.owner and phrase.owner.person == "I") or (reader.has(said) and not said.negated)
            if phrase.names and mine and not is_former(phrase.text) and (topic := reader.relative(phrase.head)):
                whole.append((topic, reader.fitting(topic, phrase.names)))
    words = reader.tree.words
    if name := introduced_in(reader):
        yield NAME, (name,)
    beside: dict[str, str] = {}
    for before, word in itertools.pairwise(words):
        own = (before.low, word.low) == ("my", "name")  # "my name's Tom"
        me = before.lemma == "call" and before.tag != "VBD" and word.low == "me"
        callers = reader.tree.children(before, "nsubj") if me else []
        me = me and not any(one.low in ("he", "she") or one.pos == "PROPN" for one in callers)  # "he calls me Nana"
        topic = NAME if own or me else reader.relative(word.lemma)
        if not topic or (topic != NAME and _is_anothers(reader, before, word)):
            continue
        passed = [
            one.low for one in itertools.takewhile(lambda one: one.low in WORDS["naming"], words[word.index + 1 :])
        ]
        first = words[word.index + 1 + len(passed) :][:1]
        if me and (reader.mistaken or (first and first[0].pos in ("ADJ", "ADV") and first[0].text.islower())):
            continue  # "call me crazy"
        if not first or unsaid & {word.lemma, before.lemma} or reader.denies_all:
            continue
        named = me or {"'s"} & set(passed[:own]) or {"name", "names", "called", "named"} & set(passed)
        if {one.pos for one in first} == {"PROPN"}:  # "my sister Rosa; a dog, Rex, and a cat, Misty"
            named = named or (not passed and before.low in _OWN)
            capital = first[0].text[:1].isupper() or reader.tree.text.islower()  # "the food of my mother, feijoada"
            named = named or (
                passed in ([","], [":"]) and capital and (word.tag == "NNS" or before.low in ("a", "an", *_OWN))
            )
        if named and not is_former(f"{words[max(0, before.index - 1)].low} {before.low} {passed[:1]}"):
            listed = _listed(words[first[0].index :]) if word.tag == "NNS" else _joined(reader.tree, first[0])
            runs = (_run(reader, one) for one in dict.fromkeys((*first, *listed)))
            values = reader.fitting(topic, runs)
            beside |= dict.fromkeys(values, topic)
            yield topic, values
    for topic, values in whole:
        yield topic, tuple(value for value in values if beside.get(value, topic) == topic)


def _is_anothers(reader: Utterance, before: Word, word: Word) -> bool:
    """Return whether a relative is somebody else's: *he's got a new girlfriend called Tamara*, *my brother's wife*."""
    if owner_before(word, reader.tree) or before.low in ("'s", "'", "his", "her", "their", "your"):
        return True
    if any(child.low in _OWN for child in reader.tree.children(word, "poss")):
        return False
    having = [said for said in reader.seen.statements if said.object.head == word.lemma]
    return any(said.subject.person == "other" and said.subject.text.lower() != "it" for said in having)


def _listed(words: Sequence[Word]) -> Iterator[Word]:
    """Yield the first words of the names in a list: *Ana, Lidia and Paz*."""
    for before, word in itertools.pairwise(words):
        if word.low in (",", "and", "&"):
            continue
        if not (word.pos in _NOMINAL or word.text.istitle()) or (
            before.low not in (",", "and", "&") and before.pos != "PROPN"
        ):
            return
        if before.low in (",", "and", "&"):
            yield word


def _joined(tree: Tree, word: Word) -> Iterator[Word]:
    """Yield the names that *and* joins to a name."""
    for other in tree.children(word, "conj"):
        if other.pos in _NOMINAL and not tree.children(other, "det", "poss", "nsubj"):
            yield other
            yield from _joined(tree, other)


def _run(reader: Utterance, word: Word) -> str:
    """Return the name of one or more words that begins with `word`; empty if no name begins there."""
    if word.pos not in (*_NOMINAL, "VERB"):
        return ""
    first = (child for child in reader.tree.children(word, "compound") if child.index < word.index)
    run = [*(child for child in first if not reader.relative(child.lemma)), word]
    while (after := reader.tree.after(word)) and after.pos == "PROPN" and after.start == word.end + 1:
        run.append(after)
        word = after
    return " ".join(one.text for one in run)
