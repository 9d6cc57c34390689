"""A clause: a verb, or a chain of verbs, with its subject, its object and its negation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from .asking import AUXILIARIES, QUESTION_WORDS, kind_at
from .conjuncts import conjuncts, denies_conjunct, is_contrasted
from .noun_phrase import adjective_phrase, gerund_phrase, noun_phrase, phrase_of
from .phrase import Phrase
from .question_word import QuestionWord
from .tree import Tree, Word
from .triple import Triple
from .verbs import (
    NEGATIONS,
    PLACES,
    SUBJECTS,
    VERBAL,
    following_verb,
    heads_clause,
    is_denied,
    is_infinitive,
    lemma_of,
    makes_future,
    particles,
)
from .word_set import word_set

_DIRECT = (
    "dobj",
    "attr",
    "acomp",
    "oprd",
    "pobj",
)  # the tagger sometimes mistakes a verb for a preposition
_FEELINGS = word_set(
    "interested tired bored married divorced scared excited worried surprised pleased disappointed confused retired ",
    "annoyed satisfied",
)
_PURSUITS = word_set("hobby job passion dream goal plan interest pastime task habit")
"""Subjects before a gerund that names them: *my hobby is reading*."""
_SENSES = word_set("be feel look seem sound taste smell")
_STATES = word_set("better worse well fine good bad great ok okay awful hard")
"""Adjectives that the tagger mistakes for adverbs."""

Part = Phrase | QuestionWord
NOTHING = Phrase("")
YOU = Phrase("you", person="you")


def _text(part: Part) -> str | QuestionWord:
    return part.text if isinstance(part, Phrase) else part


@dataclass(frozen=True, slots=True)
class _Unknown:
    """The unknown of a question: its word, the top of its phrase, and its kind."""

    word: Word
    top: Word
    kind: QuestionWord


class Clause:
    """One clause of a tree; `all_in` makes them."""

    def __init__(self, tree: Tree, verb: Word, others: dict[int, Clause], owners: dict[int, Clause]) -> None:
        self.tree = tree
        self.verb = verb
        self._others = others
        """All clauses of the tree by the index of the verb."""
        self._owners = owners
        """The clause of each verb: its own, or that of its chain."""

    @classmethod
    def all_in(cls, tree: Tree) -> list[Clause]:
        """Return the clauses that make triples, in order of their verbs."""
        clauses: dict[int, Clause] = {}
        owners: dict[int, Clause] = {}
        for word in tree.words:
            if heads_clause(tree, word):
                clauses[word.index] = cls(tree, word, clauses, owners)
        for clause in clauses.values():
            for verb in clause._verbs:
                owners.setdefault(verb.index, clause)
        within = {verb.index for clause in clauses.values() for verb in clause.chain[1:]}
        return [
            clause
            for index, clause in clauses.items()
            if index not in within and not clause._is_tag and not clause._is_lets
        ]

    def readings(self) -> Iterator[tuple[Triple, Part, Part]]:
        """Yield a triple for each pair of subject and object, with its phrases."""
        subjects, objects = self._parts()
        for subject in subjects:
            for object, contrasted in objects:
                negated = self.negated != contrasted
                predicate = ("not " if negated else "") + self.predicate
                yield Triple(_text(subject), predicate, _text(object)), subject, object

    @property
    def requests(self) -> bool:
        """Whether it demands something: *give me the book*, *let's play*."""
        if any(clause._is_lets for clause in self._others.values()):
            return True
        return not self.own_subjects and self.verb.dep in ("ROOT", "conj") and self._unsaid() == [YOU]

    # --------------------------------------------------------------------------------------- the verb

    @cached_property
    def chain(self) -> list[Word]:
        """The verb with the verbs that it governs: *want to become*."""
        chain = [self.verb]
        while (following := following_verb(self.tree, chain[-1])) is not None:
            chain.append(following)
        if len(chain) > 1 and makes_future(self.tree, chain[0]):
            del chain[0]
        return chain

    @cached_property
    def predicate(self) -> str:
        """The lemma; in a chain the first verb's lemma, then the others as written."""
        first, *others = self._prefix + self.chain
        if self._names_pursuit:
            return "be"
        if self.passive is not None and self._feels:
            return lemma_of(self.passive)
        if self.passive is not None and not self._agents:
            lemma = f"{lemma_of(self.passive)} {first.low}" if first == self.verb else lemma_of(first)
        else:
            lemma = lemma_of(first)
        words = [lemma, *particles(self.tree, first)]
        for verb in others:
            if verb in self.chain[1:] and is_denied(self.tree, verb):
                words.append("not")
            if is_infinitive(self.tree, verb) or (verb == self.verb and is_infinitive(self.tree, self._head)):
                words.append("to")
            words += [verb.low, *particles(self.tree, verb)]
        return " ".join(words)

    @cached_property
    def negated(self) -> bool:
        """Whether the clause is negated."""
        later = self.chain[1:]  # "decide not to go" denies the going alone
        own = [word for word in self.own if word.dep != "ROOT" and self.tree.head(word) not in later]
        if any(word.low in NEGATIONS and not denies_conjunct(self.tree, word, self._others) for word in own):
            return True
        if any(word.low == "longer" and (before := self.tree.before(word)) and before.low == "no" for word in own):
            return True
        if any(word.low == "no" and word.dep == "det" and not _is_no_one(self.tree, word) for word in own):
            return True
        if any(word.low == "neither" and word.dep in ("cc", "preconj", "det") for word in own):
            return True
        head = self.head_clause
        if self.verb.dep == "conj" and head is not None and head.negated and not self.own_subjects:
            return any(word.low in ("or", "nor") for word in self.tree.children(head.verb, "cc"))
        return False

    @cached_property
    def _verbs(self) -> list[Word]:
        """All of its verbs, with the *going* of a future."""
        return self.chain if self.verb in self.chain else [self.verb, *self.chain]

    @cached_property
    def _prefix(self) -> list[Word]:
        """The verbs that a joined clause inherits: *like*, for *run* in *like to swim and run*."""
        head = self.head_clause
        if self.verb.dep == "conj" and head is not None and self._head in head.chain[1:]:
            return head._prefix + head.chain[: head.chain.index(self._head)]
        return []

    @cached_property
    def passive(self) -> Word | None:
        for child in self.tree.children(self.chain[0], "auxpass"):
            return child
        head = self.head_clause
        if self.verb.dep == "conj" and self.verb.tag == "VBN" and head is not None and not self.own_subjects:
            return None if self.tree.children(self.verb, "aux") else head.passive
        return None

    @cached_property
    def _agents(self) -> list[Word]:
        """The agent of a passive, after *by*."""
        if self.passive is None or self._feels:
            return []
        for by in self.tree.children(self.chain[0], "agent"):
            if pobj := self.tree.children(by, "pobj"):
                return pobj
        return []

    @cached_property
    def _names_pursuit(self) -> bool:
        """Whether the gerund names the subject: *my hobby is reading books*."""
        subjects = self.own_subjects
        return (
            self.verb.tag == "VBG"
            and any(lemma_of(aux) == "be" for aux in self.tree.children(self.verb, "aux"))
            and bool(subjects)
            and subjects[0].lemma.lower() in _PURSUITS
        )

    def _gerund(self, verb: Word) -> list[Word]:
        """Return the gerund with its own words, without the rest of the clause."""
        kept = [verb]
        for child in self.tree.children(verb, "dobj", "prep", "prt"):
            kept += gerund_phrase(self.tree, child)
        return kept

    @property
    def _feels(self) -> bool:
        """Whether the participle is an adjective: *interested in music*."""
        return self.chain[0].low in _FEELINGS

    # ---------------------------------------------------------------------------------- its neighbours

    @property
    def _head(self) -> Word:
        return self.tree.head(self.verb)

    @cached_property
    def head_clause(self) -> Clause | None:
        """The clause that this one depends on."""
        if self.verb.dep == "ROOT":
            return None
        for word in (self._head, *self.tree.ancestors(self._head)):
            owner = self._owners.get(word.index)
            if owner is not None and owner is not self:
                return owner
        return None

    @cached_property
    def own(self) -> list[Word]:
        """The words of this clause, without those of clauses inside it."""
        found: list[Word] = list(self._verbs)
        for word in found:
            for child in self.tree.children(word):
                if child not in found and child.index not in self._others:
                    found.append(child)
        return sorted(found, key=lambda word: word.index)

    @cached_property
    def _is_tag(self) -> bool:
        """Whether it is a question tag: *don't you?*."""
        tree, verb = self.tree, self.verb
        if verb.low not in AUXILIARIES or verb.dep == "relcl" or verb.index == 0:
            return False
        rest = [word for word in tree.words[verb.index + 1 :] if word.low not in NEGATIONS]
        if not rest or rest[0].pos != "PRON" or (len(rest) > 1 and rest[1].pos != "PUNCT"):
            return False
        if any(child.low in QUESTION_WORDS for child in tree.children(verb)):
            return False
        before = tree.words[verb.index - 1]
        return before.pos not in ("PRON", "CCONJ", "SCONJ", "INTJ") and any(
            word.index < verb.index for clause in self._others.values() for word in [clause.verb]
        )

    @cached_property
    def _is_lets(self) -> bool:
        """Whether it is the *let* of *let's play*, whose subject is *we*."""
        return self.verb.low == "let" and any(
            word.head != word.index and word.low in ("'s", "us", "s")
            for word in self.tree.words[self.verb.index + 1 : self.verb.index + 2]
        )

    # ------------------------------------------------------------------------------ subjects, objects

    def _parts(self) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """Return the subjects and the objects, and for each object whether *not* precedes it alone."""
        unknown = self.unknown
        if self._expletive:
            return self._existential(unknown)
        if unknown is not None and self._is_copula:
            return self._copular_question(unknown)
        subjects = self.subjects
        objects = self._objects()
        if self._names_pursuit:
            verbs = [self.verb, *(v for v in self.tree.children(self.verb, "conj"))]
            return subjects, [(phrase_of(self.tree, verb, self._gerund(verb)), False) for verb in verbs]
        if self._agents:
            objects = [(subject, False) for subject in subjects]
            subjects = [part for part, _ in self._written(self._agents)]
        if unknown is None:
            return subjects, objects or [(NOTHING, False)]
        asked = unknown.top.dep in SUBJECTS and not any(word for word in self.own_subjects if word != unknown.top)
        if self._agents and unknown.top.dep == "agent":  # who was it written by
            return [unknown.kind], objects
        if self._agents and asked:  # what was written by him
            return subjects, [(unknown.kind, False)]
        if asked:
            return [unknown.kind], objects or [(NOTHING, False)]
        adverbial = unknown.kind in (
            QuestionWord.PLACE,
            QuestionWord.TIME,
            QuestionWord.REASON,
            QuestionWord.FORM,
        )
        if (adverbial or unknown.top.dep in ("advmod", "npadvmod")) and objects:
            return subjects, objects
        return subjects, [(unknown.kind, False)]

    def _existential(self, unknown: _Unknown | None) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """Return the parts of an existential clause: *there is a cat on the table*."""
        there = [
            word
            for verb in self.chain
            for word in self.tree.children(verb, "attr", "dobj", "nsubj", "nsubjpass")
            if word.low != "there"
        ]
        place = self._in_phrases(self.chain[-1])
        for word in there:
            place = place or self._in_phrases(word, of=False)
        place = place or self._at_places()
        if unknown is not None:
            return [unknown.kind], place or [(NOTHING, False)]
        return [part for part, _ in self._written(there)], place or [(NOTHING, False)]

    def _copular_question(self, unknown: _Unknown) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """Return the parts of a question with *be*: *who are you?*, *why are you sad?*"""
        verb = self.chain[-1]
        others = [
            word
            for word in self.tree.children(verb, *SUBJECTS, "attr", "dobj")
            if word != unknown.top and word.pos not in ("ADJ", "ADV")
        ]
        rest = self._adjectives(verb, unknown) or self._in_phrases(verb) or self._at_places()
        if not others:
            others = [w for w in self.own_subjects if w != unknown.top]
        if not others:
            return [unknown.kind], rest or [(NOTHING, False)]
        subjects = [part for part, _ in self._written(others[:1])]
        if unknown.top.dep == "advmod" and unknown.top == unknown.word:  # where, when, why, how
            left = self._written(others[1:]) or rest
            if left:
                return subjects, left
        return subjects, [(unknown.kind, False)]

    @cached_property
    def own_subjects(self) -> list[Word]:
        tree = self.tree
        found = [word for verb in self._verbs for word in tree.children(verb, *SUBJECTS)]
        if not found:  # the parser sometimes attaches the subject to an auxiliary
            for aux in tree.children(self.verb, "aux", "auxpass"):
                found += tree.children(aux, *SUBJECTS)
        if not found and lemma_of(self.chain[-1]) == "be":  # or to the adjective: why is the sky blue
            for word in tree.children(self.chain[-1], "acomp", "attr"):
                found += tree.children(word, *SUBJECTS)
        return found

    @cached_property
    def subjects(self) -> list[Part]:
        """The subjects; those of the head clause if the clause has none."""
        own = self.own_subjects
        if own:
            if len(own) == 1 and own[0].low in ("who", "that", "which") and self.verb.dep == "relcl":
                return self._antecedents
            lets = own[0].low in ("'s", "us", "s") and any(clause._is_lets for clause in self._others.values())
            if lets:
                return [Phrase("we", person="I")]
            return [part for part, _ in self._written(own)]
        if self.verb.dep == "ROOT" or (self.verb.dep in ("ccomp", "parataxis", "dep") and self.head_clause is None):
            return self._unsaid()
        if self.verb.dep == "acl":
            return []
        head = self.head_clause
        if head is None:
            return []
        if self.verb.dep in ("xcomp", "ccomp") and not self._prefix:  # I asked him to come
            him = self.tree.children(self._head, "dobj", "dative")
            if him and him[0].index < self.verb.index:
                return [part for part, _ in self._written(him)]
        if head._agents:
            return [part for part, _ in self._written(head._agents)]
        if head.unknown is not None and head.unknown.top.dep in SUBJECTS:
            return head._parts()[0]
        return head.subjects

    def _unsaid(self) -> list[Part]:
        """Return the implied subject of a request or of thanks."""
        if self.verb.lemma.lower() == "thank":
            return [Phrase("I", person="I")]
        request = self.verb.tag in ("VB", "VBP") or any(aux.low == "do" for aux in self.tree.children(self.verb, "aux"))
        return [YOU] if request else [NOTHING]

    @property
    def _antecedents(self) -> list[Part]:
        """The noun before a relative clause."""
        return [phrase_of(self.tree, self._head, noun_phrase(self.tree, self._head))]

    def _objects(self) -> list[tuple[Part, bool]]:
        tree, unknown = self.tree, self.unknown
        if self.passive is not None and self._feels:
            return [(phrase_of(tree, self.chain[0], adjective_phrase(tree, self.chain[0], self.chain[0])), False)]
        relative = self.verb.dep == "relcl" and self._asked_of_antecedent
        for verb in reversed(self.chain):
            direct = [word for word in tree.children(verb, *_DIRECT) if word not in self.chain]
            direct = [word for word in direct if unknown is None or word != unknown.top]
            if not direct:  # it makes me happy
                small = [word for word in tree.children(verb, "ccomp") if word.index not in self._others]
                direct = [subject for word in small for subject in tree.children(word, *SUBJECTS)]
            if direct and relative and direct[0].low in ("that", "which", "who", "whom"):
                return [(part, False) for part in self._antecedents]
            if direct:
                return self._written([direct[0], *self._strays(verb, direct[0])], verb)
        if relative:
            return [(part, False) for part in self._antecedents]
        for verb in reversed(self.chain):
            if better := [w for w in tree.children(verb, "advmod") if w.low in _STATES and lemma_of(verb) in _SENSES]:
                return self._written(better, verb)
        for verb in reversed(self.chain):
            if indirect := [word for word in tree.children(verb, "dative") if word.pos != "ADP"]:
                return self._written(indirect)
        for verb in reversed(self.chain):
            if found := self._in_phrases(verb):
                return found
        return self._at_places() or self._shared() or self._named()

    def _named(self) -> list[tuple[Part, bool]]:
        """Return the object of *is your father a doctor*, which the parser attaches elsewhere."""
        subjects = self.own_subjects
        if not (self._is_copula and len(subjects) == 1 and subjects[0].index > self.chain[-1].index):
            return []
        names = [word for word in self.tree.children(self.chain[-1], "npadvmod") if self.tree.children(word, "det")]
        if not names:  # is your mother at home
            return self._in_phrases(subjects[0], of=False)
        return self._written(names[:1])

    @cached_property
    def _asked_of_antecedent(self) -> bool:
        """Whether the noun before a relative clause is its object: *the book (that) I read*."""
        subjects = self.own_subjects
        return bool(subjects) and subjects[0].low not in ("who", "that", "which")

    def _strays(self, verb: Word, object: Word) -> list[Word]:
        """Return conjuncts of the object that the parser attaches to the verb."""
        return [
            word
            for word in self.tree.children(verb, "conj")
            if word.index > object.index and word.index not in self._others and word.pos not in VERBAL
        ]

    def _in_phrases(self, head: Word, *, of: bool = True) -> list[tuple[Part, bool]]:
        """Return the noun of the first prepositional phrase after the head, or else before it."""
        phrases = [
            word
            for word in self.tree.children(head, "prep", "dative")
            if word.pos in ("ADP", "SCONJ", "ADV", "VERB") and (of or word.low != "of")
        ]
        phrases.sort(key=lambda word: (word.index < head.index, word.index))
        for phrase in phrases:
            preposition = phrase
            for deeper in self.tree.children(phrase, "prep"):  # out of, from behind
                if not self.tree.children(phrase, "pobj", "pcomp"):
                    preposition = deeper
            nouns = self.tree.children(preposition, "pobj", "pcomp")
            if self.unknown is not None and any(self.unknown.word in self.tree.subtree(n) for n in nouns):
                continue
            if nouns:
                joined = self.tree.children(phrase, "conj")  # in Berlin and in Paris
                nouns += [n for other in joined for n in self.tree.children(other, "pobj", "pcomp")]
                return self._written(nouns)
        return []

    def _at_places(self) -> list[tuple[Part, bool]]:
        for verb in reversed(self.chain):
            for word in self.tree.children(verb, "advmod", "npadvmod", "dep"):
                if word.low in PLACES:
                    return [(phrase_of(self.tree, word, [word]), False)]
        return []

    def _shared(self) -> list[tuple[Part, bool]]:
        """Return the object that two joined verbs share: *bought and read the book*."""
        for word in self.tree.children(self.verb, "conj"):
            other = self._others.get(word.index)
            between = self.tree.words[self.verb.index + 1 : word.index]
            if other is not None and between and all(w.dep in ("cc", "prt") for w in between):
                return other._objects()
        return []

    def _adjectives(self, verb: Word, unknown: _Unknown) -> list[tuple[Part, bool]]:
        words = [word for word in self.tree.children(verb, "acomp", "attr", "nsubj") if word.pos in ("ADJ", "ADV")]
        return self._written([word for word in words if word != unknown.top], verb)

    # ------------------------------------------------------------------------------------- questions

    @cached_property
    def unknown(self) -> _Unknown | None:
        if self.verb.dep == "relcl":
            return None
        for word in self.own:
            kind = kind_at(self.tree.words, word.index) if word.low in QUESTION_WORDS else None
            if kind is None or (self.verb.dep == "advcl" and word.low in ("when", "where", "how", "why")):
                continue
            top = word
            for above in self.tree.ancestors(word):
                if above in self._verbs:
                    break
                top = above
            if top not in self._verbs:
                return _Unknown(word, top, kind)
        return None

    @cached_property
    def _is_copula(self) -> bool:
        return self.passive is None and lemma_of(self.chain[-1]) == "be"

    @cached_property
    def _expletive(self) -> bool:
        return bool([w for verb in self.chain for w in self.tree.children(verb, "expl") if w.low == "there"])

    # --------------------------------------------------------------------------------------- writing

    def _written(self, heads: Iterable[Word], verb: Word | None = None) -> list[tuple[Part, bool]]:
        """Return the phrases of `heads` and their conjuncts, and whether *not* precedes each alone."""
        found: list[tuple[Part, bool]] = []
        for head in heads:
            for word in conjuncts(self.tree, head, self._others):
                if verb is not None and self._is_predicative(word, verb):
                    words = adjective_phrase(self.tree, word, verb)
                elif word.pos in VERBAL and word.dep not in ("ROOT",):
                    words = gerund_phrase(self.tree, word)
                else:
                    words = noun_phrase(self.tree, word)
                found.append(
                    (self._whose(phrase_of(self.tree, word, words)), is_contrasted(self.tree, word, self._others))
                )
        return found

    def _whose(self, phrase: Phrase) -> Phrase:
        """Replace *whose* in a relative clause: *whose father* becomes *the boy's father*."""
        first, _, rest = phrase.text.partition(" ")
        if self.verb.dep == "relcl" and first.lower() == "whose":
            owner = phrase_of(self.tree, self._head, noun_phrase(self.tree, self._head))
            return replace(phrase, text=f"{owner.text}'s {rest}", owner=owner)
        return phrase

    def _is_predicative(self, word: Word, verb: Word) -> bool:
        """Return whether an adjective is a predicate: *she is nice*, but not *I speak a little German*."""
        return (
            word.pos in ("ADJ", "VERB", "ADV")
            and word.tag != "VBG"
            and (lemma_of(verb) == "be" or word.dep != "dobj")
            and not self.tree.children(word, "det", "amod", "poss")
        )


def _is_no_one(tree: Tree, no: Word) -> bool:
    """Return whether *no* belongs to the pronoun *no one*."""
    after = tree.after(no)
    return after is not None and after.low == "one"
