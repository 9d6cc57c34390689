"""Repair common mistakes of the small pipelines in dependency trees, such as nouns that must be verbs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ravestate.language.contractions import word_set

from .contrast import join_contrasts
from .question_word import AUXILIARIES, QUESTION_WORDS
from .tree import Tree, Word, is_tree

_NEGATIONS = ("n't", "not", "nt")
_BE = ("is", "are", "was", "were")
_CLOSING = ("NOUN", "PROPN", "ADJ", "ADV", "VERB", "NUM", "PRON")
_ACTIONS = (("do", "it"), ("have", "it"), ("do", "that"), ("have", "that"), ("do", "this"), ("have", "this"))
"""Pairs of an auxiliary and a pronoun that are no question tag: *I can't let you do it*. A question tag is an ending
such as *don't you*."""
_THINGS = word_set("it that this me him her them us one")
"""Pronouns before a question tag without a comma: *you like it don't you*."""
_OBJECTIVE = word_set("me him us them")
_RELATIVE = word_set("that which who whom")
_MOVING = word_set("go come drive walk run ride cycle travel get bike commute hurry")
_POSSESSIVE = word_set("my our his her their your")
_OWN_ACTIONS = word_set(
    "study work play love like run teach paint drive cook bake dance sing coach train design fish hate need want help"
)
"""Verbs that the parser takes for nouns if *and* joins them to a clause with *I*: *I am 23 and study law*."""
_INVERTING = word_set("do does did can could will would should")


def repaired(tree: Tree) -> Tree:
    """Return a tree of the same words, with tags and relations corrected where they cannot be right."""
    words = list(tree.words)
    for word in tree.words:
        if word.low in AUXILIARIES:
            _mark_tag(tree, words, word)
            _make_verb(tree, words, word)
            _make_passive(tree, words, word)
            _make_copula(tree, words, word)
        _name_relative(tree, words, word)
        _make_present(tree, words, word)
        _make_joined(tree, words, word)
        _make_way(tree, words, word)
        _make_predicate(tree, words, word)
        if word.dep == "compound" and word.tag == "NNS" and tree.children(word, "poss"):  # as in "my brothers wife"
            words[word.index] = replace(word, dep="poss")
        if word.dep == "advmod" and word.pos == "PROPN" and word.head == word.index - 1:  # as in "you speak Greek"
            words[word.index] = replace(word, dep="dobj")
    if not is_tree(words):
        return tree
    for mend in (_split_relatives, join_contrasts):
        mended = mend(Tree(tree.text, words))
        words = mended if is_tree(mended) else words
    return tree if words == list(tree.words) else Tree(tree.text, words)


def is_tag(word: Word) -> bool:
    """Return whether a word of a repaired tree is the auxiliary of a question tag."""
    return word.dep == "punct" and word.low in AUXILIARIES


def tag_at(words: Sequence[Word], index: int) -> int:
    """Return the number of words of the question tag at `index`: 3 for *don't you* (*do*, *n't*, *you*); 0 if there is none."""
    negated = index + 1 < len(words) and words[index + 1].low in _NEGATIONS
    end = index + 2 + negated
    ended = end <= len(words) and words[end - 1].pos == "PRON" and (end == len(words) or words[end].pos == "PUNCT")
    before = words[index - 1] if index else None
    if not ended or before is None or words[index].low not in AUXILIARIES or words[end - 1].low in QUESTION_WORDS:
        return 0
    denied = not negated and any(word.low in (*_NEGATIONS, "never") for word in words[: index - 1])
    denied = denied and before.pos in _CLOSING and (words[index].low, words[end - 1].low) not in _ACTIONS
    joined = before.pos in ("CCONJ", "SCONJ") or (before.pos == "PRON" and before.low not in _THINGS)
    apart = before.low == "," or ((negated or denied) and not joined and index > 1)
    return end - index if apart and words[index - 1 - (before.low == ",")].low not in QUESTION_WORDS else 0


def _mark_tag(tree: Tree, words: list[Word], word: Word) -> None:
    """Turn the words of a question tag into punctuation."""
    tag = range(word.index, word.index + tag_at(tree.words, word.index))
    for other in tree.words if tag else ():
        if other.index in tag:
            words[other.index] = replace(other, pos="PUNCT", dep="punct", head=other.index)
        elif other.head in tag:
            words[other.index] = replace(other, dep="ROOT", head=other.index)


def _make_verb(tree: Tree, words: list[Word], auxiliary: Word) -> None:
    """If a noun follows an auxiliary and a subject, make the noun a verb: *end*, in *did the war end*."""
    before = tree.before(auxiliary)
    if auxiliary.low not in _INVERTING or (
        before and before in tree.children(auxiliary, "nsubj") and before.pos in ("PRON", "NOUN", "PROPN")
    ):
        return
    after = tree.words[auxiliary.index + 1 :]
    nominal = ("DET", "PRON", "ADJ", "NOUN", "PROPN")
    place = next((number for number, word in enumerate(after) if word.pos not in nominal), len(after))
    place += after[place : place + 1] != () and after[place].pos == "VERB"
    if place < 2:
        return
    *_, subject, verb = after[:place]
    if subject.dep != "compound" or subject.head != verb.index or verb.pos not in ("NOUN", "VERB"):
        return
    if auxiliary.low == "do" and (place > 2 or subject.tag != "NNS"):
        return  # as in "do your math homework"
    words[verb.index] = replace(verb, pos="VERB", tag="VB")
    _reroot(tree, words, auxiliary, verb, subject, "aux")


def _make_passive(tree: Tree, words: list[Word], be: Word) -> None:
    """Turn a participle after its noun into the main verb: *eaten* in *was it eaten by ants*, *crying* in *is he crying*."""
    nouns = [word for word in tree.children(be, "nsubj", "attr") if word.index > be.index]
    for participle in tree.children_of(nouns, "acl"):
        if be.low in _BE and be.dep == "ROOT" and tree.children(participle, "agent"):
            _reroot(tree, words, be, participle, tree.head(participle), "auxpass")
        elif be.low in _BE and be.dep == "ROOT" and participle.tag == "VBG" and tree.head(participle).dep == "nsubj":
            _reroot(tree, words, be, participle, tree.head(participle), "aux")


def _make_copula(tree: Tree, words: list[Word], short: Word) -> None:
    """Turn *'s* into a verb if the sentence has no verb: *my name's Ada*, but not *my sister's car*."""
    owner = tree.head(short)
    named = tree.head(owner)
    after = tree.after(short)
    article = after is not None and after.low in ("a", "an", "the")
    if short.dep != "case" or owner.dep != "poss" or named.dep != "ROOT" or owner.pos != "NOUN":
        return
    if named.pos != "PROPN" and not article:
        return
    for word, dep, head in ((short, "ROOT", short), (owner, "nsubj", short), (named, "attr", short)):
        words[word.index] = replace(word, dep=dep, head=head.index, pos="AUX" if word == short else word.pos)


def _make_present(tree: Tree, words: list[Word], noun: Word) -> None:
    """Turn a plural noun at the end of a clause without a verb into a verb: *snores*, in *my husband snores*."""
    before = tree.before(noun)
    clausal = noun.dep == "ROOT" or (noun.dep in ("ccomp", "advcl") and tree.children(noun, "mark"))
    clausal = clausal or (noun.dep == "conj" and tree.head(noun).pos == "VERB")
    if noun.tag != "NNS" or not clausal or before is None or before.tag not in ("NN", "NNP"):
        return
    if (
        before.head != noun.index
        or before.dep not in ("nsubj", "compound")
        or tree.children(noun, "aux", "cop", "case")
    ):
        return
    relative = tree.before(before) if before.tag == "NNP" else None  # as in "my flatmate Ola snores"
    owner = tree.before(relative) if relative is not None and relative.pos == "NOUN" else None
    named = relative is not None and owner is not None and owner.low in _POSSESSIVE
    if before.dep == "compound" and noun.dep in ("ROOT", "conj") and not named:  # as in "my football boots"
        return
    if named and relative is not None:
        words[relative.index] = replace(relative, dep="compound", head=before.index)
    words[noun.index] = replace(words[noun.index], pos="VERB", tag="VBZ")
    words[before.index] = replace(words[before.index], dep="nsubj")
    for word in tree.children(noun, "det", "poss", "amod") if before.dep == "compound" else ():
        words[word.index] = replace(words[word.index], head=before.index)


def _make_joined(tree: Tree, words: list[Word], noun: Word) -> None:
    """Turn a noun after *and* into a verb: *study*, in *I am 23 and study law*."""
    before, thing = tree.before(noun), tree.head(noun)
    verb = tree.head(thing)
    joined = noun.dep == "compound" and noun.low in _OWN_ACTIONS and before is not None and before.low in ("and", "but")
    if not joined or thing.dep != "conj" or thing.index < noun.index:
        return
    while verb.dep in ("attr", "dobj", "acomp", "pobj", "prep", "conj") and verb.pos not in ("VERB", "AUX"):
        verb = tree.head(verb)
    if any(word.low in ("i", "we") for word in tree.children(verb, "nsubj", "nsubjpass")):
        words[noun.index] = replace(noun, pos="VERB", tag="VBP", dep="conj", head=verb.index)
        words[thing.index] = replace(thing, dep="dobj", head=noun.index)


def _make_predicate(tree: Tree, words: list[Word], adjective: Word) -> None:
    """Join an adjective to the *be* before it: *I hope you're ok*."""
    be = tree.before(adjective)
    if be is None or adjective.pos != "ADJ" or adjective.dep != "ccomp" or tree.children(adjective):
        return
    if be.lemma.lower() == "be" and be.head == adjective.head and not tree.children(be, "acomp", "attr"):
        words[adjective.index] = replace(adjective, dep="acomp", head=be.index)


def _make_way(tree: Tree, words: list[Word], work: Word) -> None:
    """Turn *work* after a verb of motion into a noun: *I drive to work*."""
    verb, to = tree.head(work), tree.before(work)
    if work.low != "work" or work.dep not in ("xcomp", "advcl") or verb.lemma.lower() not in _MOVING or to is None:
        return
    if [word.low for word in tree.children(work)] == ["to"] and to.low == "to" and verb.index < to.index:
        words[to.index] = replace(to, pos="ADP", tag="IN", dep="prep", head=verb.index)
        words[work.index] = replace(work, pos="NOUN", tag="NN", dep="pobj", head=to.index)


def _split_relatives(tree: Tree) -> list[Word]:
    """Return the words, with the relative clauses separated from the main clause.

    The parser takes some relative clauses for objects (*the hat that you gave me*). In other sentences, it takes the
    relative clause's object for the main verb's subject (*me*, in *the dog that bit me belongs to Ann*).
    """
    words = list(tree.words)
    for verb in tree.words:
        noun = tree.head(verb)
        opening = tree.subtree(verb)[0]
        before = tree.before(opening)
        if verb.dep == "ccomp" and opening.tag in ("WDT", "WP") and opening.low in _RELATIVE and before is not None:
            objects = tree.children(noun, "dobj", "pobj", "attr")
            if before in objects and before.pos in ("NOUN", "PROPN"):
                words[verb.index] = replace(verb, dep="relcl", head=before.index)
        if verb.dep != "ccomp" or noun.dep != "relcl" or tree.children(verb, "mark", "aux"):
            continue
        subjects = tree.children(verb, "nsubj")
        above = tree.head(noun)
        if (
            subjects
            and subjects[0].low in _OBJECTIVE
            and subjects[0].index == noun.index + 1
            and above.index < noun.index
        ):
            words[subjects[0].index] = replace(subjects[0], dep="dobj", head=noun.index)
            dep, head = (above.dep, above.head) if above.dep != "ROOT" else ("ROOT", verb.index)
            words[verb.index] = replace(verb, dep=dep, head=head)
            words[above.index] = replace(above, dep="nsubj", head=verb.index)
    return words


def _name_relative(tree: Tree, words: list[Word], noun: Word) -> None:
    """Join a noun to the name after it: *my mum*, in *my mum Ann sings*."""
    name = tree.after(noun)
    own = noun.pos == "NOUN" and any(word.low in _POSSESSIVE for word in tree.children(noun, "poss"))
    if own and name and name.text.istitle() and name.dep in ("nsubj", "advmod", "npadvmod") and noun.dep == "nsubj":
        if name.head == noun.head and name.head > name.index:  # as in "my mate Olly plays chess"
            words[name.index] = replace(name, pos="PROPN", tag="NNP", dep="appos", head=noun.index)
        return
    if noun.pos != "NOUN" or name is None or name.pos != "PROPN" or name.dep != "nsubj" or noun.head == name.index:
        return
    if tree.children(noun, "poss") and noun.dep != "nsubj" and name not in tree.children(noun):
        verb = tree.head(name)
        if verb.dep == "relcl" and verb.head == noun.index:  # "my late husband Walter swore by cabbage leaves"
            head = verb.index if noun.head == noun.index else noun.head
            words[verb.index] = replace(verb, dep=noun.dep, head=head)
        elif noun in tree.ancestors(name):
            return
        words[noun.index] = replace(noun, dep="compound", head=name.index)


def _reroot(tree: Tree, words: list[Word], auxiliary: Word, verb: Word, subject: Word, dep: str) -> None:
    """Make `verb` the root of its sentence. `auxiliary` (with the relation `dep`) and `subject` then depend on it."""
    for word in tree.words:
        if word == verb:
            words[word.index] = replace(words[word.index], dep="ROOT", head=word.index)
        elif word == auxiliary:
            words[word.index] = replace(word, pos="AUX", dep=dep, head=verb.index)
        elif word == subject:
            words[word.index] = replace(word, dep="nsubj" if dep == "aux" else "nsubjpass", head=verb.index)
        elif word.head == verb.index and auxiliary.index < word.index < subject.index:
            words[word.index] = replace(word, head=subject.index)
        elif word.head == auxiliary.index:
            words[word.index] = replace(word, head=verb.index)
