"""Read triples and statements from a dependency tree, by the conventions of the README."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import takewhile

from ravestate.language.contractions import word_set
from ravestate.language.entity import Entity

from .clause import NOTHING, Clause
from .contrast import contrasted_with, is_denied
from .phrase import Phrase, person_of, phrase_of
from .repair import is_tag
from .statement import Statement, Triple
from .tree import SUBJECTS, Tree
from .verbs import lemma_of, makes_future

MOST = 64
"""The maximum number of triples from one text. A limit is needed, because enumerations multiply the triples."""

_HABITS = word_set("go play train run attend sing dance paint cook swim ride eat teach stay drink")
"""Verbs of habits. With a time, they describe a single event: *I painted a dragon yesterday*."""
_LASTING = _HABITS | word_set(
    "be live work study have own like love hate enjoy prefer want need know believe speak belong smoke keep collect date share "
    "feel hope think"
)
"""Verbs of states and habits. In the past tense, statements with these verbs no longer hold: *I lived in Rome*."""
_KNOWN_AS_TRUE = word_set(
    "know remember see notice forget realise realize find learn discover understand mean show prove"
)
_IMAGINED = word_set("wish imagine dream pretend suppose hope doubt fantasise fantasize")
_WANTED = word_set("want wan hope plan intend wish dream decide aim like love need prepare promise expect")
_IMMINENT = word_set("move leave retire")
_PONDERED = word_set("think consider dream talk plan")
_DOUBTS = word_set("maybe perhaps possibly probably")
_MISSED = word_set("almost nearly")
"""Adverbs of an event that did not happen: *I almost moved to Rome*, but not *I am almost ready*."""
_REPORTS = word_set("apparently supposedly allegedly reportedly according")
_REPORTING = word_set(
    "say tell think claim believe write insist reckon report swear announce suspect guess assume mention"
)
_UNREAL = word_set("would 'd could might may should")
_CONDITIONS = word_set("if unless whether")
_SOON = word_set("tomorrow next soon tonight later")
_TIMES = word_set(
    "yesterday today now once ago recently currently nowadays formerly previously soon lately tomorrow tonight"
)
_TEMPORAL = word_set("when while until after before since")


def triples_of(tree: Tree) -> tuple[Triple, ...]:
    """Return the statements and questions of the text as triples: at most `MOST`, each once."""
    return tuple(statement.triple for statement in statements_of(tree))


def statements_of(
    tree: Tree, entities: Sequence[Entity] = (), clauses: Sequence[Clause] | None = None
) -> tuple[Statement, ...]:
    """Return the triples of the text, at most `MOST`, each once, with the flags of their clauses.

    Example:
        *My sister used to live in Rome* has one statement. It is past, and the head of its subject is ``sister``.
    """
    found: dict[Triple, Statement] = {}
    for clause in Clause.all_in(tree) if clauses is None else clauses:
        assertion = _Assertion(clause, entities)
        for triple, subject, object in clause.readings():
            if triple not in found and len(found) < MOST:
                subject, object = (part if isinstance(part, Phrase) else NOTHING for part in (subject, object))
                found[triple] = assertion.statement(triple, subject, object)
    return tuple(found.values())


class _Assertion:
    """The flags that all triples of a clause share: whether it is past, imagined, wanted, reported, or asked."""

    def __init__(self, clause: Clause, entities: Sequence[Entity]) -> None:
        self._tree = clause.tree
        self._clause = clause
        self._low = {word.low for word in clause.own}
        self._times = [entity.text.lower().split() for entity in entities if entity.label in ("DATE", "TIME")]
        self._above = None if clause.head_clause is None else _Assertion(clause.head_clause, entities)
        dep = clause.verb.dep
        shares = dep in ("ccomp", "xcomp", "acl") or (dep == "conj" and not clause.own_subjects)
        self._sharing = self._above if shares else None
        """The clause on which this clause depends, if both have the same flags; else None."""

    def statement(self, triple: Triple, subject: Phrase, object: Phrase) -> Statement:
        """Return the statement of a triple of this clause."""
        return Statement(
            triple,
            subject,
            object,
            verb=self._clause.lemma,
            phrases=tuple(self._phrases(object, denied=triple.predicate.startswith("not ") != self._clause.negated)),
            when=self._when,
            negated=triple.predicate.startswith("not ") != self._denied_above,
            past=self._past and not self._conditional,
            hearsay=self._hearsay,
            conditional=self._conditional,
            plan=self._plan,
            question=self._question,
            request=self._clause.requests,
        )

    # ------------------------------------------------------------------------------------------ flags

    @cached_property
    def _question(self) -> bool:
        if self._clause.unknown is not None or self._clause.inverted:
            return True
        if self._above is not None:
            return self._sharing is not None and self._above._question and not self._given
        words = self._tree.subtree(self._clause.verb)
        commas = [place for place, word in enumerate(words) if word.low == ","]
        rest = words[commas[-1] + 1 :] if commas else []
        elsewhere = bool(rest) and rest[0].low in ("and", "what", "how")  # as in "I live in Rome, and you?"
        after = takewhile(lambda word: word.pos == "PUNCT", self._tree.words[words[-1].index + 1 :])
        return ("?" in words[-1].low and not elsewhere) or any(map(is_tag, (*words, *after)))

    @cached_property
    def _hearsay(self) -> bool:
        """Whether the statement reports somebody else's words: *Ada says that...*, *I heard that...*, *apparently...*.

        The flag is also true if the speaker denies having said the statement: *I didn't say that I am shy*.
        """
        if self._above is None or self._low & _REPORTS:
            return bool(self._low & _REPORTS)
        said = self._above._clause
        if self._clause.verb.dep in ("ccomp", "parataxis") and not self._given:
            speakers = [word for word in said.own_subjects if word.low not in ("it", "that", "this", "what")]
            before = self._tree.before(self._tree.subtree(self._clause.verb)[0])
            apart = before is not None and before.low == "," and said.lemma not in _REPORTING
            if any(person_of(word) != "I" for word in speakers):
                return said.lemma not in ("be", "call", "name") and not apart
            if said.lemma in ("hear", "read") or (said.lemma in ("say", "tell") and (said.negated or said.passive)):
                return True
        return self._sharing is not None and self._sharing._hearsay

    @cached_property
    def _conditional(self) -> bool:
        """Whether the statement is imagined, in doubt, under a condition, or almost came true."""
        own = self._clause.own
        if self._low & _DOUBTS or any(word.low in _CONDITIONS and word.dep in ("mark", "advmod") for word in own):
            return True
        if any(word.low in _UNREAL and word.dep == "aux" for word in own) and not self._wished:
            return True
        events = [verb for verb in self._clause.verbs if verb.tag in ("VBD", "VBN") and lemma_of(verb) != "be"]
        if any(word.low in _MISSED for word in self._tree.children_of(events, "advmod")):
            return True
        conditions = self._tree.children(self._clause.verb, "advcl")
        if any(word.low in ("if", "unless") for word in self._tree.children_of(conditions, "mark")):
            return True
        if lemma_of(self._tree.head(self._clause.verb)) in _IMAGINED and self._clause.verb.dep in (
            "ccomp",
            "xcomp",
            "advcl",
        ):
            return True
        return self._sharing is not None and self._sharing._conditional

    @cached_property
    def _plan(self) -> bool:
        """Whether the action is wanted, or in the future."""
        chain = self._clause.chain
        if any(word.low in ("will", "'ll", "shall", "wo") and word.dep == "aux" for word in self._clause.own):
            return True
        if self._wished or (makes_future(self._tree, self._clause.verb) and chain[0] != self._clause.verb):
            return True
        if len(chain) > 1 and chain[1].tag == "VB" and lemma_of(chain[0]) in _WANTED:
            return True
        if lemma_of(chain[-1]) in _PONDERED and any(word.dep == "pcomp" for word in self._clause.own):
            return True  # as in "I'm thinking of moving"
        verbs = [chain[0], *self._tree.children(chain[0], "auxpass")]
        soon = set(self._when.lower().split()) & _SOON or self._clause.lemma in _IMMINENT
        if soon and self._tense == "present" and any(verb.tag == "VBG" for verb in verbs):
            return True
        wanted = self._clause.verb.dep in ("xcomp", "ccomp") and self._clause.verb.tag == "VB"
        above = self._sharing
        return above is not None and (above._plan or (wanted and above._clause.lemma in _WANTED))

    @cached_property
    def _past(self) -> bool:
        """Whether the statement was true, and is not true any more."""
        lemma, first = lemma_of(self._clause.chain[-1]), self._clause.chain[0]
        if first.low == "used" and len(self._clause.chain) > 1:
            return True
        begins = len(self._clause.chain) > 1 and lemma_of(first) in ("start", "begin")
        if self._clause.passive is not None or lemma not in _LASTING or begins:
            return False
        if self._tense == "past":
            return not (lemma in _HABITS and self._when)
        clauses = self._tree.children(self._clause.verb, "advcl")
        low = self._low | {word.low for word in self._tree.children_of(clauses, "mark")}
        goes_on = low & {"since", "for", "always", "been", "all"}  # as in "I have lived here since 2010"
        return self._tense == "perfect" and lemma in ("live", "work", "study") and not goes_on

    # ---------------------------------------------------------------------------------------- reading

    @cached_property
    def _tense(self) -> str:
        first = self._clause.chain[0]
        before = {word.low for word in self._clause.own if word.dep in ("aux", "auxpass") and word.index < first.index}
        if before & {"have", "has", "'ve", "'s"} and first.tag == "VBN":
            return "perfect"
        if self._sharing is not None and self._clause.verb.dep == "conj" and first.tag == "VB" and not before:
            return self._sharing._tense
        past = before & {"was", "were", "did", "had"} if before else first.tag == "VBD" or first.low in ("was", "were")
        return "past" if past else "present"

    @cached_property
    def _wished(self) -> bool:
        """Whether the clause says *would like*, *would love* or *would prefer*."""
        first = self._clause.chain[0]
        would = any(word.low in ("would", "'d") for word in self._tree.children(first, "aux"))
        return would and lemma_of(first) in ("like", "love", "prefer")

    @cached_property
    def _denied_above(self) -> bool:
        """Whether the clause on which this clause depends denies it: *I don't think that I am shy*, *it isn't true
        that...*."""
        if self._above is None or self._clause.verb.dep not in ("ccomp", "csubj"):
            return False
        said = self._above._clause
        return said.negated and said.lemma in ("think", "believe", "be", "feel", "guess")

    @cached_property
    def _given(self) -> bool:
        """Whether the clause on which this clause depends takes it as true: *you know that I live here*."""
        assert self._above is not None
        return not self._low & {"if", "whether"} and self._above._clause.lemma in _KNOWN_AS_TRUE

    def _phrases(self, object: Phrase, *, denied: bool) -> Iterator[Phrase]:
        """Yield the phrases of a statement's clause, apart from its subject. One of them may also be the statement's object.

        They are the nouns after prepositions, and the complements of objects: *Rex*, in *we called the dog Rex*. A proper
        noun that is the object of *name*, *call* or *christen* counts, too. Phrases after *of* are left out.

        A contrast, as in *not in Bonn, but in Bern*, has an asserted and a denied phrase. If `denied` is true, the
        statement is about the denied phrase: leave out the asserted phrase, and all denied phrases except `object`. If
        `denied` is false, leave out all denied phrases.
        """
        for word in self._clause.own:
            if contrasted_with(self._tree, word) if denied else is_denied(self._tree, word):
                continue
            if denied and is_denied(self._tree, word) and phrase_of(self._tree, word) != object:
                continue
            above = list(self._tree.ancestors(word))
            inside = above[: next((n for n, verb in enumerate(above) if verb in self._clause.verbs), len(above))]
            given = word.dep == "dobj" and word.pos == "PROPN" and self._clause.lemma in ("name", "call", "christen")
            if (word.dep in ("pobj", "oprd") or given) and not any(
                other.dep in SUBJECTS or other.low == "of" for other in inside
            ):
                yield phrase_of(self._tree, word)

    @cached_property
    def _when(self) -> str:
        tree, own = self._tree, [word for word in self._clause.own if word.pos != "PUNCT"]
        low = [word.low for word in own]
        found = [word for word in own if word.low in _TIMES and word.dep in ("advmod", "npadvmod")]
        for time in self._times:
            for place in range(len(low) - len(time) + 1):
                if low[place : place + len(time)] == time and time[-1] != "old":
                    before = tree.words[max(own[place].index - 1, 0)]
                    found += [before] * (before.pos in ("ADP", "SCONJ")) + own[place : place + len(time)]
        if not found:
            for child in tree.children(self._clause.verb, "advcl"):
                if any(word.low in _TEMPORAL for word in tree.children(child, "advmod", "mark")):
                    found = [word for word in tree.subtree(child) if word.pos != "PUNCT"]
        return tree.phrase(dict.fromkeys(found))
