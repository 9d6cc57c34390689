"""A clause: a verb, or a chain of verbs, with its subject, its object and its negation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

from .asking import AUXILIARIES, QUESTION_WORDS, kind_at
from .noun_phrase import adjective_phrase, gerund_phrase, noun_phrase
from .question_word import QuestionWord
from .tree import Tree, Word
from .triple import Triple
from .word_set import word_set

__all__ = ["Clause"]

_SUBJECTS = ("nsubj", "nsubjpass", "csubj", "csubjpass")
_DIRECT = (
    "dobj",
    "attr",
    "acomp",
    "oprd",
    "pobj",
)  # a pobj of a verb is what the tagger took for a preposition's
_HEADS = ("ROOT", "conj", "ccomp", "xcomp", "advcl", "relcl", "parataxis", "pcomp", "csubj", "dep", "acl")
_VERBAL = ("VERB", "AUX")

_PLACES = word_set(
    "here there home abroad outside inside upstairs downstairs away everywhere nowhere somewhere"
)
_FEELINGS = word_set(
    "interested tired bored married divorced scared excited worried surprised pleased disappointed confused retired ",
    "annoyed satisfied",
)
_PURSUITS = word_set("hobby job passion dream goal plan interest pastime task habit")
"""*My hobby is reading* says what the hobby is, not what it does."""
_MOTION = word_set("come go travel fly drive run move stay")
"""Verbs after which an infinitive tells the purpose, so that it is an action of its own."""
_GERUND_TAKERS = word_set(
    "like love hate enjoy prefer dislike start stop begin continue keep practise practice try"
)
_NEGATIONS = frozenset(["not", "n't", "nt", "never"])
_BE = frozenset(["be", "am", "is", "are", "was", "were", "m", "s", "re", "'s", "'m", "'re"])
_SENSES = word_set("be feel look seem sound taste smell")
_STATES = word_set("better worse well fine good bad great ok okay awful hard")
"""Words that the tagger takes for adverbs, but that tell how somebody is."""
_MISTAKEN = word_set("like love play work live study dance swim paint cook")
"""Verbs that the tagger often takes for something else."""
_SHORT = {"wan": "want", "gon": "go", "got": "get", "ca": "can", "wo": "will"}

Part = str | QuestionWord


@dataclass(frozen=True, slots=True)
class _Unknown:
    """What a question asks for: where its phrase hangs on the verb, and its kind."""

    word: Word
    top: Word
    kind: QuestionWord


class Clause:
    """One clause of a tree. Made by `all_in`."""

    def __init__(self, tree: Tree, verb: Word, others: dict[int, Clause], owners: dict[int, Clause]) -> None:
        self.tree = tree
        self.verb = verb
        self._others = others
        """All clauses of the tree, by their verbs."""
        self._owners = owners
        """The clause to which each verb belongs: its own, or the one whose chain it goes on."""

    @classmethod
    def all_in(cls, tree: Tree) -> list[Clause]:
        """Every clause that makes triples, in order of their verbs."""
        clauses: dict[int, Clause] = {}
        owners: dict[int, Clause] = {}
        for word in tree.words:
            if _heads_clause(tree, word):
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

    def triples(self) -> Iterator[Triple]:
        """What the clause says, one triple for each pair of subject and object."""
        subjects, objects = self._parts()
        for subject in subjects:
            for object, contrasted in objects:
                negated = self.negated != contrasted
                yield Triple(subject, ("not " if negated else "") + self.predicate, object)

    # --------------------------------------------------------------------------------------- the verb

    @cached_property
    def chain(self) -> list[Word]:
        """The verb, and the verbs that go on from it: *want to become*."""
        chain = [self.verb]
        while (following := self._following(chain[-1])) is not None:
            chain.append(following)
        if len(chain) > 1 and self._is_future(chain[0]):
            del chain[0]
        return chain

    @cached_property
    def predicate(self) -> str:
        """The lemma; in a chain the first as lemma, the others as written."""
        first, *others = self._prefix + self.chain
        if self._names_pursuit:
            return "be"
        if self._passive is not None and self._feels:
            return _lemma(self._passive)
        if self._passive is not None and not self._agents:
            lemma = f"{_lemma(self._passive)} {first.low}" if first == self.verb else _lemma(first)
        else:
            lemma = _lemma(first)
        words = [lemma, *self._particles(first)]
        for verb in others:
            if self._infinitive(verb) or (verb == self.verb and self._infinitive(self._head)):
                words += ["not", "to"] if verb != first and self._denied(verb) else ["to"]
            words += [verb.low, *self._particles(verb)]
        return " ".join(words)

    @cached_property
    def negated(self) -> bool:
        """Whether it is denied."""
        later = self.chain[1:]  # "decide not to go" denies the going alone
        own = [word for word in self._own if word.dep != "ROOT" and self.tree.head(word) not in later]
        if any(word.low in _NEGATIONS and not self._contrasts(word) for word in own):
            return True
        if any(
            word.low == "longer" and (before := self.tree.before(word)) and before.low == "no" for word in own
        ):
            return True
        if any(word.low == "no" and word.dep == "det" and not _is_no_one(self.tree, word) for word in own):
            return True
        if any(word.low == "neither" and word.dep in ("cc", "preconj", "det") for word in own):
            return True
        head = self._head_clause
        if self.verb.dep == "conj" and head is not None and head.negated and not self._own_subjects:
            return any(word.low in ("or", "nor") for word in self.tree.children(head.verb, "cc"))
        return False

    @cached_property
    def _verbs(self) -> list[Word]:
        """All its verbs, also one that only makes the future."""
        return self.chain if self.verb in self.chain else [self.verb, *self.chain]

    @cached_property
    def _prefix(self) -> list[Word]:
        """Of *like to swim and run*: *like*, for the clause of *run*."""
        head = self._head_clause
        if self.verb.dep == "conj" and head is not None and self._head in head.chain[1:]:
            return head._prefix + head.chain[: head.chain.index(self._head)]
        return []

    def _following(self, verb: Word) -> Word | None:
        tree = self.tree
        if _lemma(verb) == "be":
            return None
        for child in tree.children(verb, "xcomp"):
            if child.pos not in _VERBAL or child.index < verb.index or tree.children(child, *_SUBJECTS):
                continue
            infinitive = self._infinitive(child)
            if infinitive and _lemma(verb) in _MOTION and not self._is_future(verb):
                continue
            if child.tag not in ("VBG", "VB") and not infinitive:
                continue
            if any(
                w.low in QUESTION_WORDS and w.index > verb.index for w in tree.children(child)
            ):  # learn how to cook
                continue
            between = [
                w for w in tree.words[verb.index + 1 : child.index] if w.head in (verb.index, child.index)
            ]
            if not any(w.dep in ("dobj", "dative", "prep") or w.low in _PLACES for w in between):
                return child
        if _lemma(verb) in _GERUND_TAKERS:
            for child in tree.children(verb, "dobj", "pobj"):
                if child.low.endswith("ing") and child.index == verb.index + 1 and child.tag in ("NN", "VBG"):
                    return child
        return None

    def _is_future(self, verb: Word) -> bool:
        """*am going to*, which is dropped like any auxiliary."""
        return verb.low in ("going", "gon") and any(
            _lemma(aux) == "be" or verb.low == "gon" for aux in self.tree.children(verb, "aux") or [verb]
        )

    def _denied(self, verb: Word) -> bool:
        return any(child.low in _NEGATIONS for child in self.tree.children(verb, "neg"))

    def _infinitive(self, verb: Word) -> bool:
        return any(child.low in ("to", "na") for child in self.tree.children(verb, "aux"))

    def _particles(self, verb: Word) -> list[str]:
        return [
            child.low
            for child in self.tree.children(verb, "prt", "advmod")
            if child.dep == "prt" or (child.low == "back" and child.index == verb.index + 1)
        ]

    @cached_property
    def _passive(self) -> Word | None:
        for child in self.tree.children(self.chain[0], "auxpass"):
            return child
        head = self._head_clause
        if self.verb.dep == "conj" and self.verb.tag == "VBN" and head is not None and not self._own_subjects:
            return None if self.tree.children(self.verb, "aux") else head._passive
        return None

    @cached_property
    def _agents(self) -> list[Word]:
        """Who does it, in a passive with *by*."""
        if self._passive is None or self._feels:
            return []
        for by in self.tree.children(self.chain[0], "agent"):
            if pobj := self.tree.children(by, "pobj"):
                return pobj
        return []

    @cached_property
    def _names_pursuit(self) -> bool:
        """*My hobby is reading books*: the gerund says what it is."""
        subjects = self._own_subjects
        return (
            self.verb.tag == "VBG"
            and any(_lemma(aux) == "be" for aux in self.tree.children(self.verb, "aux"))
            and bool(subjects)
            and subjects[0].lemma.lower() in _PURSUITS
        )

    def _gerund(self, verb: Word) -> list[Word]:
        """The gerund and what belongs to it, but not the rest of the clause."""
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
    def _head_clause(self) -> Clause | None:
        """The clause that this one depends on."""
        if self.verb.dep == "ROOT":
            return None
        for word in (self._head, *self.tree.ancestors(self._head)):
            owner = self._owners.get(word.index)
            if owner is not None and owner is not self:
                return owner
        return None

    @cached_property
    def _own(self) -> list[Word]:
        """The words that belong to this clause and to none within it."""
        found: list[Word] = list(self._verbs)
        for word in found:
            for child in self.tree.children(word):
                if child not in found and child.index not in self._others:
                    found.append(child)
        return sorted(found, key=lambda word: word.index)

    @cached_property
    def _is_tag(self) -> bool:
        """*..., don't you?*"""
        tree, verb = self.tree, self.verb
        if verb.low not in AUXILIARIES or verb.dep == "relcl" or verb.index == 0:
            return False
        rest = [word for word in tree.words[verb.index + 1 :] if word.low not in _NEGATIONS]
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
        """*Let's play* is what *we* do."""
        return self.verb.low == "let" and any(
            word.head != word.index and word.low in ("'s", "us", "s")
            for word in self.tree.words[self.verb.index + 1 : self.verb.index + 2]
        )

    # ------------------------------------------------------------------------------ subjects, objects

    def _parts(self) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """The subjects, and the objects, each with whether *not* stands before it alone."""
        unknown = self._unknown
        if self._expletive:
            return self._existential(unknown)
        if unknown is not None and self._is_copula:
            return self._copular_question(unknown)
        subjects = self.subjects
        objects = self._objects()
        if self._names_pursuit:
            verbs = [self.verb, *(v for v in self.tree.children(self.verb, "conj"))]
            return subjects, [(self.tree.phrase(self._gerund(verb)), False) for verb in verbs]
        if self._agents:
            objects = [(subject, False) for subject in subjects]
            subjects = [part for part, _ in self._written(self._agents)]
        if unknown is None:
            return subjects, objects or [("", False)]
        asked = unknown.top.dep in _SUBJECTS and not any(
            word for word in self._own_subjects if word != unknown.top
        )
        if self._agents and unknown.top.dep == "agent":  # who was it written by
            return [unknown.kind], objects
        if self._agents and asked:  # what was written by him
            return subjects, [(unknown.kind, False)]
        if asked:
            return [unknown.kind], objects or [("", False)]
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
        """*There is a cat on the table.*"""
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
            return [unknown.kind], place or [("", False)]
        return [part for part, _ in self._written(there)], place or [("", False)]

    def _copular_question(self, unknown: _Unknown) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """*Who are you?*, *Who is here?*, *Why are you sad?*"""
        verb = self.chain[-1]
        others = [
            word
            for word in self.tree.children(verb, *_SUBJECTS, "attr", "dobj")
            if word != unknown.top and word.pos not in ("ADJ", "ADV")
        ]
        rest = self._adjectives(verb, unknown) or self._in_phrases(verb) or self._at_places()
        if not others:
            others = [w for w in self._own_subjects if w != unknown.top]
        if not others:
            return [unknown.kind], rest or [("", False)]
        subjects = [part for part, _ in self._written(others[:1])]
        if unknown.top.dep == "advmod" and unknown.top == unknown.word:  # where, when, why, how
            left = self._written(others[1:]) or rest
            if left:
                return subjects, left
        return subjects, [(unknown.kind, False)]

    @cached_property
    def _own_subjects(self) -> list[Word]:
        tree = self.tree
        found = [word for verb in self._verbs for word in tree.children(verb, *_SUBJECTS)]
        if not found:  # now and then the parser gives the subject to an auxiliary
            for aux in tree.children(self.verb, "aux", "auxpass"):
                found += tree.children(aux, *_SUBJECTS)
        if not found and _lemma(self.chain[-1]) == "be":  # or to the adjective: why is the sky blue
            for word in tree.children(self.chain[-1], "acomp", "attr"):
                found += tree.children(word, *_SUBJECTS)
        return found

    @cached_property
    def subjects(self) -> list[Part]:
        """Who does it, or is it; of the head clause if there is none here."""
        own = self._own_subjects
        if own:
            if len(own) == 1 and own[0].low in ("who", "that", "which") and self.verb.dep == "relcl":
                return self._antecedents
            lets = own[0].low in ("'s", "us", "s") and any(
                clause._is_lets for clause in self._others.values()
            )
            if lets:
                return ["we"]
            return [part for part, _ in self._written(own)]
        if self.verb.dep == "ROOT" or (
            self.verb.dep in ("ccomp", "parataxis", "dep") and self._head_clause is None
        ):
            return self._unsaid()
        if self.verb.dep == "acl":
            return []
        head = self._head_clause
        if head is None:
            return []
        if self.verb.dep in ("xcomp", "ccomp") and not self._prefix:  # I asked him to come
            him = self.tree.children(self._head, "dobj", "dative")
            if him and him[0].index < self.verb.index:
                return [part for part, _ in self._written(him)]
        if head._agents:
            return [part for part, _ in self._written(head._agents)]
        if head._unknown is not None and head._unknown.top.dep in _SUBJECTS:
            return head._parts()[0]
        return head.subjects

    def _unsaid(self) -> list[Part]:
        """The subject of a request, or of a verb that thanks."""
        if self.verb.lemma.lower() == "thank":
            return ["I"]
        request = self.verb.tag in ("VB", "VBP") or any(
            aux.low == "do" for aux in self.tree.children(self.verb, "aux")
        )
        return ["you"] if request else [""]

    @property
    def _antecedents(self) -> list[Part]:
        """What a relative clause tells about."""
        return [self.tree.phrase(noun_phrase(self.tree, self._head))]

    def _objects(self) -> list[tuple[Part, bool]]:
        tree, unknown = self.tree, self._unknown
        if self._passive is not None and self._feels:
            return [(tree.phrase(adjective_phrase(tree, self.chain[0], self.chain[0])), False)]
        relative = self.verb.dep == "relcl" and self._asked_of_antecedent
        for verb in reversed(self.chain):
            direct = [word for word in tree.children(verb, *_DIRECT) if word not in self.chain]
            direct = [word for word in direct if unknown is None or word != unknown.top]
            if not direct:  # it makes me happy
                small = [word for word in tree.children(verb, "ccomp") if word.index not in self._others]
                direct = [subject for word in small for subject in tree.children(word, *_SUBJECTS)]
            if direct and relative and direct[0].low in ("that", "which", "who", "whom"):
                return [(part, False) for part in self._antecedents]
            if direct:
                return self._written([direct[0], *self._strays(verb, direct[0])], verb)
        if relative:
            return [(part, False) for part in self._antecedents]
        for verb in reversed(self.chain):
            if better := [
                w for w in tree.children(verb, "advmod") if w.low in _STATES and _lemma(verb) in _SENSES
            ]:
                return self._written(better, verb)
        for verb in reversed(self.chain):
            if indirect := [word for word in tree.children(verb, "dative") if word.pos != "ADP"]:
                return self._written(indirect)
        for verb in reversed(self.chain):
            if found := self._in_phrases(verb):
                return found
        return self._at_places() or self._shared() or self._named()

    def _named(self) -> list[tuple[Part, bool]]:
        """*Is your father a doctor*: what it asks may hang elsewhere in the tree."""
        subjects = self._own_subjects
        if not (self._is_copula and len(subjects) == 1 and subjects[0].index > self.chain[-1].index):
            return []
        names = [
            word for word in self.tree.children(self.chain[-1], "npadvmod") if self.tree.children(word, "det")
        ]
        if not names:  # is your mother at home
            return self._in_phrases(subjects[0], of=False)
        return self._written(names[:1])

    @cached_property
    def _asked_of_antecedent(self) -> bool:
        """Whether the noun that a relative clause tells about is its object: *the book (that) I read*."""
        subjects = self._own_subjects
        return bool(subjects) and subjects[0].low not in ("who", "that", "which")

    def _strays(self, verb: Word, object: Word) -> list[Word]:
        """Conjuncts of the object that the parser gives to the verb."""
        return [
            word
            for word in self.tree.children(verb, "conj")
            if word.index > object.index and word.index not in self._others and word.pos not in _VERBAL
        ]

    def _in_phrases(self, head: Word, *, of: bool = True) -> list[tuple[Part, bool]]:
        """The noun of the first prepositional phrase, those behind the head first."""
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
            if self._unknown is not None and any(self._unknown.word in self.tree.subtree(n) for n in nouns):
                continue
            if nouns:
                joined = self.tree.children(phrase, "conj")  # in Berlin and in Paris
                nouns += [n for other in joined for n in self.tree.children(other, "pobj", "pcomp")]
                return self._written(nouns)
        return []

    def _at_places(self) -> list[tuple[Part, bool]]:
        for verb in reversed(self.chain):
            for word in self.tree.children(verb, "advmod", "npadvmod", "dep"):
                if word.low in _PLACES:
                    return [(word.text, False)]
        return []

    def _shared(self) -> list[tuple[Part, bool]]:
        """The object of the next verb, where only a conjunction stands between: *bought and read the book*."""
        for word in self.tree.children(self.verb, "conj"):
            other = self._others.get(word.index)
            between = self.tree.words[self.verb.index + 1 : word.index]
            if other is not None and between and all(w.dep in ("cc", "prt") for w in between):
                return other._objects()
        return []

    def _adjectives(self, verb: Word, unknown: _Unknown) -> list[tuple[Part, bool]]:
        words = [
            word for word in self.tree.children(verb, "acomp", "attr", "nsubj") if word.pos in ("ADJ", "ADV")
        ]
        return self._written([word for word in words if word != unknown.top], verb)

    # ------------------------------------------------------------------------------------- questions

    @cached_property
    def _unknown(self) -> _Unknown | None:
        if self.verb.dep == "relcl":
            return None
        for word in self._own:
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
        return self._passive is None and _lemma(self.chain[-1]) == "be"

    @cached_property
    def _expletive(self) -> bool:
        return bool([w for verb in self.chain for w in self.tree.children(verb, "expl") if w.low == "there"])

    # --------------------------------------------------------------------------------------- writing

    def _written(self, heads: Iterable[Word], verb: Word | None = None) -> list[tuple[Part, bool]]:
        """The phrases around `heads` and their conjuncts as written, each with whether *not* stands before it alone."""
        found: list[tuple[Part, bool]] = []
        for head in heads:
            for word in self._conjuncts(head):
                if verb is not None and self._is_predicative(word, verb):
                    words = adjective_phrase(self.tree, word, verb)
                elif word.pos in _VERBAL and word.dep not in ("ROOT",):
                    words = gerund_phrase(self.tree, word)
                else:
                    words = noun_phrase(self.tree, word)
                found.append((self._whose(self.tree.phrase(words)), self._contrasted(word)))
        return found

    def _whose(self, phrase: str) -> str:
        """In a relative clause *whose father* is *the boy's*."""
        first, _, rest = phrase.partition(" ")
        if self.verb.dep == "relcl" and first.lower() == "whose":
            return f"{self._antecedents[0]}'s {rest}"
        return phrase

    def _is_predicative(self, word: Word, verb: Word) -> bool:
        """Whether an adjective stands for itself, and not for a noun: *she is nice*, but *I speak a little German*."""
        return (
            word.pos in ("ADJ", "VERB", "ADV")
            and word.tag != "VBG"
            and (_lemma(verb) == "be" or word.dep != "dobj")
            and not self.tree.children(word, "det", "amod", "poss")
        )

    def _conjuncts(self, head: Word) -> list[Word]:
        found = [head]
        for word in found:  # grows while it is walked
            found += [child for child in self.tree.children(word, "conj") if child.index not in self._others]
        return found

    def _contrasted(self, word: Word) -> bool:
        return word.dep == "conj" and any(self._contrasts(child) for child in self._negations_at(word))

    def _negations_at(self, word: Word) -> list[Word]:
        first = self.tree.subtree(word)[0]
        before = self.tree.before(first)
        return [w for w in (first, before) if w is not None and w.low == "not"]

    def _contrasts(self, negation: Word) -> bool:
        """Whether *not* denies one conjunct alone: *tea, but not coffee*."""
        after = self.tree.after(negation)
        if after is None:
            return False
        for word in (after, *self.tree.ancestors(after)):
            if word.dep == "conj" and word.index not in self._others:
                return self.tree.subtree(word)[0].index in (after.index, negation.index)
        return False


def _heads_clause(tree: Tree, word: Word) -> bool:
    if word.dep not in _HEADS:
        return False
    children = tree.children(word)
    has_subject = any(child.dep in _SUBJECTS for child in children)
    if word.pos in _VERBAL:
        if word.dep in ("acl", "pcomp", "csubj"):
            return has_subject
        if word.dep == "conj" and not has_subject and tree.head(word).pos not in (*_VERBAL, "ADP", "SCONJ"):
            return False
        return bool(children) or word.dep in ("ROOT", "conj", "relcl", "xcomp")
    return has_subject and (any(child.dep == "aux" for child in children) or word.low in _MISTAKEN)


def _lemma(verb: Word) -> str:
    if verb.low in _BE:
        return "be"
    return _SHORT.get(verb.low, verb.lemma.lower())


def _is_no_one(tree: Tree, no: Word) -> bool:
    """*No one* is a pronoun in two words."""
    after = tree.after(no)
    return after is not None and after.low == "one"
