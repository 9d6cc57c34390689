"""The flags of a clause: whether it is so, was so once, is imagined, wanted, asked, or only reported."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property

from ravestate.language.contractions import word_set
from ravestate.language.entity import Entity

from .clause import NOTHING, Clause, Part
from .phrase import Phrase, person_of, phrase_of
from .repair import is_tag
from .statement import Statement
from .tree import SUBJECTS, Tree, Word
from .triple import Triple
from .verbs import lemma_of, makes_future

_LASTING = word_set(
    "be live work study have own like love hate enjoy prefer want need know believe play speak belong stay go teach smoke drink "
    "train run attend keep collect date share feel hope think sing dance paint cook swim ride eat",
)
"""Verbs of states and habits. In the past they say what is so no more; with others, something happened and still holds."""
_HABITS = word_set("go play train run attend sing dance paint cook swim ride eat teach stay drink")
"""Verbs that are habits without a time, and single events with one: *I painted a dragon yesterday*."""
_KNOWN_AS_TRUE = word_set(
    "know remember see notice forget realise realize find learn discover understand mean show prove"
)
_IMAGINED = word_set("wish imagine dream pretend suppose hope doubt fantasise fantasize")
_WANTED = word_set("want wan hope plan intend wish dream decide aim like love need prepare promise expect")
_DOUBTS = word_set("maybe perhaps possibly probably")
_REPORTS = word_set("apparently supposedly allegedly reportedly")
_UNREAL = word_set("would 'd could might may should")
_CONDITIONS = ("if", "unless", "whether")
_SOON = word_set("tomorrow next soon tonight later")
_TIMES = word_set(
    "yesterday today now once ago recently currently nowadays formerly previously soon lately tomorrow tonight"
)


class Assertion:
    """The flags that all triples of one clause share."""

    def __init__(self, tree: Tree, clause: Clause, entities: Sequence[Entity] = ()) -> None:
        self._tree = tree
        self._clause = clause
        self._low = {word.low for word in clause.own}
        self._times = [
            [part.lower() for part in entity.text.split()] for entity in entities if entity.label in ("DATE", "TIME")
        ]
        self._above = None if clause.head_clause is None else Assertion(tree, clause.head_clause, entities)

    def statement(self, triple: Triple, subject: Part, object: Part) -> Statement:
        """Return the statement of a triple of this clause."""
        negated = triple.predicate.startswith("not ")
        return Statement(
            triple,
            subject if isinstance(subject, Phrase) else NOTHING,
            object if isinstance(object, Phrase) else NOTHING,
            verb=self._clause.lemma,
            phrases=tuple(self._phrases()),
            when=self._when,
            negated=negated != self._denied_above,
            past=self.past and not self.conditional,
            hearsay=self.hearsay,
            conditional=self.conditional,
            plan=self.plan,
            question=self.question,
            request=self._clause.requests,
        )

    # ------------------------------------------------------------------------------------------ flags

    @cached_property
    def question(self) -> bool:
        """Whether the clause is asked."""
        if self._clause.unknown is not None or self._clause.inverted:
            return True
        if self._above is not None:
            return self._dependent and self._above.question and not self._given
        words = self._tree.subtree(self._clause.verb)
        after = self._tree.words[words[-1].index + 1 :][:1]
        return ("?" in words[-1].low and not self._ends_otherwise) or any(is_tag(word) for word in [*words, *after])

    @cached_property
    def hearsay(self) -> bool:
        """Whether somebody else says it."""
        if self._low & (_REPORTS | {"according"}):
            return True
        if self._above is None:
            return False
        said = self._above._clause
        if self._clause.verb.dep in ("ccomp", "parataxis") and not self._given:
            speakers = [word for word in said.own_subjects if word.low not in ("it", "that", "this", "what")]
            if any(person_of(word) != "I" for word in speakers):
                return said.lemma != "be"
            if said.lemma in ("hear", "read") or (said.lemma == "tell" and said.passive is not None):
                return True
            if said.negated and said.lemma in ("say", "tell", "claim"):
                return True
        return self._dependent and self._above.hearsay

    @cached_property
    def conditional(self) -> bool:
        """Whether it is imagined."""
        if self._low & _DOUBTS or any(
            word.low in _CONDITIONS and word.dep in ("mark", "advmod") for word in self._clause.own
        ):
            return True
        if any(word.low in _UNREAL and word.dep == "aux" for word in self._clause.own) and not self._wished:
            return True
        conditions = self._tree.children(self._clause.verb, "advcl")
        if any(word.low in ("if", "unless") for word in self._tree.children_of(conditions, "mark")):
            return True
        head = self._tree.head(self._clause.verb)
        imagined = lemma_of(head) in _IMAGINED or head.low in _IMAGINED
        if imagined and self._clause.verb.dep in ("ccomp", "xcomp", "advcl"):
            return True
        return self._above is not None and self._dependent and self._above.conditional

    @cached_property
    def plan(self) -> bool:
        """Whether it is wanted, or lies ahead."""
        chain = self._clause.chain
        if any(word.low in ("will", "'ll", "shall", "wo") and word.dep == "aux" for word in self._clause.own):
            return True
        if makes_future(self._tree, self._clause.verb) and chain[0] != self._clause.verb:
            return True
        if self._wished or (len(chain) > 1 and chain[1].tag == "VB" and lemma_of(chain[0]) in _WANTED):
            return True
        verbs = [chain[0], *self._tree.children(chain[0], "auxpass")]
        soon = set(self._when.lower().split()) & _SOON
        if soon and self._tense == "present" and any(verb.tag == "VBG" for verb in verbs):
            return True
        if self._above is None or not self._dependent:
            return False
        wanted = self._clause.verb.dep in ("xcomp", "ccomp") and self._clause.verb.tag == "VB"
        return self._above.plan or (wanted and self._above._clause.lemma in _WANTED)

    @cached_property
    def past(self) -> bool:
        """Whether it was so, and is so no more."""
        verb, first = self._clause.chain[-1], self._clause.chain[0]
        if first.low == "used" and len(self._clause.chain) > 1:
            return True
        if self._clause.passive is not None or lemma_of(verb) not in _LASTING:
            return False
        if self._tense == "past":
            return not (lemma_of(verb) in _HABITS and self._when)
        return self._tense == "perfect" and lemma_of(verb) in ("live", "work", "study") and not self._goes_on

    # ---------------------------------------------------------------------------------------- reading

    @cached_property
    def _tense(self) -> str:
        first = self._clause.chain[0]
        auxiliaries = [word for word in self._clause.own if word.dep in ("aux", "auxpass") and word.index < first.index]
        if any(word.low in ("have", "has", "'ve", "'s") and first.tag == "VBN" for word in auxiliaries):
            return "perfect"
        if any(word.low in ("was", "were", "did", "had") for word in auxiliaries):
            return "past"
        if auxiliaries:
            return "present"
        above = self._above
        if (
            self._clause.verb.dep == "conj"
            and above is not None
            and not self._clause.own_subjects
            and first.tag == "VB"
        ):
            return above._tense
        return "past" if first.tag == "VBD" or first.low in ("was", "were") else "present"

    @cached_property
    def _goes_on(self) -> bool:
        """Whether a perfect says that it is still so: *I have lived here since 2010*."""
        return bool(self._low & {"since", "for", "always", "been", "all"})

    @cached_property
    def _wished(self) -> bool:
        """Whether it is a *would like*."""
        first = self._clause.chain[0]
        return lemma_of(first) in ("like", "love", "prefer") and any(
            word.low in ("would", "'d") for word in self._tree.children(first, "aux")
        )

    @cached_property
    def _denied_above(self) -> bool:
        """Whether the clause above denies it: *I don't think that I am shy*, *it is not true that I am shy*."""
        if self._above is None or self._clause.verb.dep not in ("ccomp", "csubj"):
            return False
        said = self._above._clause
        return said.negated and said.lemma in ("think", "believe", "be", "feel", "guess")

    @cached_property
    def _given(self) -> bool:
        """Whether the clause above takes it as true: *you know that I live here*."""
        assert self._above is not None
        return not self._low & {"if", "whether"} and self._above._clause.lemma in _KNOWN_AS_TRUE

    @cached_property
    def _dependent(self) -> bool:
        """Whether it shares the flags of the clause above."""
        dep = self._clause.verb.dep
        return dep in ("ccomp", "xcomp", "acl") or (dep == "conj" and not self._clause.own_subjects)

    @property
    def _ends_otherwise(self) -> bool:
        """Whether the question mark belongs to other words: *I live in Rome, and you?*."""
        words = self._tree.subtree(self._clause.verb)
        commas = [place for place, word in enumerate(words) if word.low == ","]
        rest = words[commas[-1] + 1 :] if commas else []
        return bool(rest) and rest[0].low in ("and", "what", "how")

    def _phrases(self) -> Iterator[Phrase]:
        tree = self._tree
        for word in self._clause.own:
            beside = word.dep in ("pobj", "oprd") and not any(
                above.dep in SUBJECTS or above.low == "of" for above in self._above_in_clause(word)
            )
            if beside:
                yield phrase_of(tree, word)

    def _above_in_clause(self, word: Word) -> Iterator[Word]:
        for above in self._tree.ancestors(word):
            if above in self._clause.chain or above == self._clause.verb:
                return
            yield above

    @cached_property
    def _when(self) -> str:
        own = [word for word in self._clause.own if word.pos != "PUNCT"]
        low = [word.low for word in own]
        found: set[int] = {word.index for word in own if word.low in _TIMES and word.dep in ("advmod", "npadvmod")}
        for time in self._times:
            for place in range(len(low) - len(time) + 1):
                if low[place : place + len(time)] == time and own[place + len(time) - 1].low != "old":
                    found |= {word.index for word in own[place : place + len(time)]}
                    before = self._tree.before(own[place])
                    if before is not None and before.pos in ("ADP", "SCONJ"):
                        found.add(before.index)
        if not found:
            for child in self._tree.children(self._clause.verb, "advcl"):
                marks = [word.low for word in self._tree.children(child, "advmod", "mark")]
                if any(mark in ("when", "while", "until", "after", "before", "since") for mark in marks):
                    found = {word.index for word in self._tree.subtree(child) if word.pos != "PUNCT"}
        return self._tree.phrase(word for word in self._tree.words if word.index in found)
