"""A clause: a verb, or a chain of verbs, with its subject, its object and its negation."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

from ravestate.language.contractions import word_set

from .contrast import is_denied
from .phrase import Phrase, adjective_phrase, conjuncts, gerund_phrase, noun_phrase, phrase_of
from .question_word import AUXILIARIES, QUESTION_WORDS, QuestionWord, kind_at
from .repair import repaired
from .statement import Triple
from .tree import SUBJECTS, Tree, Word
from .verbs import (
    CONTACT,
    FEELINGS,
    NEGATIONS,
    OWN_STATES,
    PLACES,
    PURSUITS,
    SETTLING,
    STATES,
    VERBAL,
    chain_of,
    heads_clause,
    is_infinitive,
    lacks_copula,
    lemma_of,
    with_particles,
)

_DIRECT = ("dobj", "attr", "acomp", "oprd", "pobj", "punct")  # the parser gives some objects one of the last two labels
_ADVERBIAL = (QuestionWord.PLACE, QuestionWord.TIME, QuestionWord.REASON, QuestionWord.FORM)
_RELATIVE = ("who", "that", "which", "whom")
_SENSES = word_set("be feel look seem sound taste smell")
_GIVING = word_set("give tell show send lend buy bring teach")
_NOMINAL = ("NOUN", "PROPN", "ADJ", "NUM")

Part = Phrase | QuestionWord
NOTHING = Phrase("")
YOU = Phrase("you", person="you")
_BE = Word(0, "be", "be", "AUX", "VB", "auxpass", 0, 0)
_I = Phrase("I", person="I")
_WE = Phrase("we", person="I")


@dataclass(frozen=True, slots=True)
class _Unknown:
    """The *unknown*: the part that a question asks for. `top` is the word of its phrase that depends directly on the
    verb."""

    word: Word
    top: Word
    kind: QuestionWord


class Clause:
    """One clause of a tree. Use `all_in` to make the clauses of a tree."""

    def __init__(self, tree: Tree, verb: Word, clauses: dict[int, Clause]) -> None:
        self.tree = tree
        self.verb = verb
        self.chain = chain_of(tree, verb)
        """The verb with the verbs that it governs: *want to become*."""
        self.verbs = list(dict.fromkeys([*self.chain[::-1], verb]))
        """All verbs of the clause; the last verb comes first."""
        self._clauses = clauses
        """Index of a verb → its clause, for all clauses of the tree."""

    @classmethod
    def all_in(cls, tree: Tree) -> list[Clause]:
        """Return the clauses that make triples, in order of their verbs."""
        tree = repaired(tree)
        clauses: dict[int, Clause] = {}
        for word in tree.words:
            if heads_clause(tree, word):
                clauses[word.index] = cls(tree, word, clauses)
        for clause in list(clauses.values()):
            clauses |= {verb.index: clause for verb in clause.chain if verb != clause.verb}
        return list(dict.fromkeys(clauses.values()))

    def readings(self) -> Iterator[tuple[Triple, Part, Part]]:
        """Yield a triple for each pair of subject and object, with the phrases of both."""
        subjects, objects = self._parts() if not self._is_lets else ([], [])
        for subject in subjects:
            for object, contrasted in objects or [(NOTHING, False)]:
                predicate = ("not " if self.negated != contrasted else "") + self.predicate
                yield Triple(_text(subject), predicate, _text(object)), subject, object
        denied = [part for part, contrasted in self._written(self.own_subjects) if contrasted] if subjects else []
        for subject in denied if subjects == self.subjects else ():  # as in "Pia, not Mia, is my sister"
            for object, contrasted in objects or [(NOTHING, False)]:
                predicate = ("not " if self.negated == contrasted else "") + self.predicate
                yield Triple(_text(subject), predicate, _text(object)), subject, object

    # --------------------------------------------------------------------------------------- the verb

    @cached_property
    def predicate(self) -> str:
        """The lemma of the verb. For a chain of verbs, the lemma of the first verb and the other verbs as written."""
        first, *others = self._inherited + self.chain
        if self._is_state:
            return self.lemma
        lemma = lemma_of(first)
        if self.passive is not None and not self._by:
            lemma = f"{lemma_of(self.passive)} {first.low}"
        words = [with_particles(self.tree, first, lemma)]
        for verb in others:
            words += ["not"] * any(child.low in NEGATIONS for child in self.tree.children(verb, "neg"))
            joined = verb == self.verb and is_infinitive(self.tree, self.tree.head(verb))
            words += ["to"] * (joined or is_infinitive(self.tree, verb))
            words += [word.low for word in self.tree.children(verb, "auxpass")]
            words += [with_particles(self.tree, verb, verb.low)] * (verb.low not in FEELINGS)
        return " ".join(words)

    @cached_property
    def lemma(self) -> str:
        """The lemma of the last verb of the predicate."""
        if self._is_state:
            return "be" if self.passive is None else lemma_of(self.passive)
        return lemma_of(self.chain[-1])

    @cached_property
    def _is_state(self) -> bool:
        """Whether the predicate describes the subject: *she very nice*, *I am interested*, *my hobby is reading*."""
        feels = self.passive is not None and self.chain[0].low in FEELINGS
        return feels or self._names_pursuit or lacks_copula(self.tree, self.verb)

    @cached_property
    def negated(self) -> bool:
        """Whether the clause is negated."""
        for word in self.own:
            before, after = self.tree.before(word), self.tree.after(word)
            alone = is_denied(self.tree, self.tree.head(word))
            if word.low in NEGATIONS and not alone and self.tree.head(word) not in self.chain[1:]:
                return True  # unlike "decide not to go", which denies only "go"
            if before is not None and (before.low, word.low) == ("no", "longer") and not alone:
                return True
            if word.low == "neither" and word.dep in ("cc", "preconj", "det"):
                return True
            # An aside negates nothing: "it's the best, no doubt", "I'm Bob, no wait, I'm Bert".
            aside = (before is not None and before.low == ",") or self.tree.head(word).dep == "advmod"
            if word.low == "no" and word.dep == "det" and after and after.low != "one" and not aside:
                return True
        head = self.head_clause  # as in "I don't smoke or drink"
        if self.verb.dep != "conj" or head is None or self.own_subjects:
            return False
        return head.negated and any(word.low in ("or", "nor") for word in self.tree.children(head.verb, "cc"))

    @cached_property
    def passive(self) -> Word | None:
        """The auxiliary of a passive, or of a participle used as an adjective, such as *are* in *are they married*; else
        None."""
        first, head = self.chain[0], self.head_clause
        auxiliaries = self.tree.children(first, "auxpass") if lemma_of(first) != "be" else []
        if first.low in FEELINGS:
            auxiliaries += [word for word in self.tree.children(first, "aux") if lemma_of(word) == "be"]
        if auxiliaries:
            return auxiliaries[0]
        if self.own_subjects or self.tree.children(self.verb, "aux", "dobj"):
            return None
        if head is not None and self.verb.dep == "conj" and first.low.endswith(("ed", "en")):  # as in "born and raised"
            return head.passive
        return _BE if first.low in ("born", "raised") and (head is None or self.verb.dep == "advcl") else None

    @property
    def requests(self) -> bool:
        """Whether the clause demands something: *give me the book*, *let's play*."""
        if self.own_subjects and not any(clause._is_lets for clause in self._clauses.values()):
            return False
        return self.verb.dep in ("ROOT", "conj", "ccomp") and self.subjects in ([YOU], [_WE])

    @cached_property
    def _inherited(self) -> list[Word]:
        """The verbs that a joined clause inherits: in *like to swim and run*, the clause of *run* inherits *like*."""
        head, verb = self.head_clause, self.tree.head(self.verb)
        if self.verb.dep != "conj" or head is None or verb not in head.chain[1:]:
            return []
        return head._inherited + head.chain[: head.chain.index(verb)]

    @cached_property
    def _agents(self) -> list[Word]:
        """The nouns after *by* in a passive: *my brother*, in *eaten by my brother*."""
        return [word for word in self.tree.children_of(self._by, "pobj") if not self._asks_at(word)]

    @cached_property
    def _by(self) -> list[Word]:
        return [] if self.passive is None or self._is_state else self.tree.children(self.chain[0], "agent")

    @cached_property
    def _names_pursuit(self) -> bool:
        """Whether the gerund names the subject: *my hobby is reading books*."""
        if self.verb.tag != "VBG":
            return False
        if self.verb.dep == "conj" and self.head_clause is not None and not self.own_subjects:
            return self.head_clause._names_pursuit
        return any(word.lemma.lower() in PURSUITS for word in self.own_subjects)

    # ---------------------------------------------------------------------------------- its neighbours

    @cached_property
    def head_clause(self) -> Clause | None:
        """The clause on which this clause depends."""
        above = (self._clauses.get(word.index) for word in self.tree.ancestors(self.verb))
        return next((clause for clause in above if clause is not None and clause is not self), None)

    @cached_property
    def own(self) -> list[Word]:
        """The words of this clause, without the words of clauses inside it."""
        found = list(self.verbs)
        for word in found:  # the list grows in the loop
            found += [child for child in self.tree.children(word) if child.index not in self._clauses]
        return sorted(found, key=lambda word: word.index)

    @cached_property
    def _is_relative(self) -> bool:
        """Whether this is a relative clause. In *Tom, where do you live*, *where do you live* is a question instead."""
        deps = [word.dep for word in self.tree.children(self.verb, "aux", *SUBJECTS)]
        return self.verb.dep == "relcl" and not (deps[:1] == ["aux"] and set(deps) & set(SUBJECTS))

    @cached_property
    def inverted(self) -> bool:
        """Whether the verb or its auxiliary precedes the subject: *do you live here*."""
        heads = [word for word in self.own if word.dep in ("aux", "auxpass") or word in self.verbs]
        subjects = self.tree.children_of(self.chain, "expl") or self.own_subjects
        before = self.tree.before(heads[0])
        if not subjects or (before is not None and before.low in ("so", "neither", "nor", "here")):
            return False
        first = self.tree.subtree(subjects[0])[0]
        if self._is_copula and first.pos != "PRON" and self.unknown is None and not self._objects():
            return False  # as in "was a nice day"
        return heads[0].index < first.index and heads[0].low in AUXILIARIES

    @cached_property
    def _is_lets(self) -> bool:
        """Whether the verb is the *let* of *let's play*, whose subject is *we*."""
        after = self.tree.after(self.verb)
        return self.verb.low == "let" and after is not None and after.low in ("'s", "us", "s")

    # ------------------------------------------------------------------------------ subjects, objects

    def _parts(self) -> tuple[list[Part], list[tuple[Part, bool]]]:
        """Return the subjects and the objects. Each object has a flag: whether a *not* denies only this object."""
        unknown, objects = self.unknown, self._objects()
        if self._names_pursuit:
            gerunds = conjuncts(self.tree, self.verb, self._clauses.keys() - {self.verb.index})
            return self.subjects, [(phrase_of(self.tree, verb, self._gerund(verb)), False) for verb in gerunds]
        if self._by:
            given = self._written(self.tree.children(self.chain[0], "dobj"))  # as in "I was given a watch by my aunt"
            asked = given or [(part, False) for part in self.subjects]
            if unknown is not None and not self._agents:  # as in "who was it written by"
                return [unknown.kind], asked
            return [part for part, _ in self._written(self._agents)], asked
        if unknown is None or unknown.top in self.own_subjects:
            return self.subjects, objects
        adverbial = unknown.kind in _ADVERBIAL or unknown.top.dep in ("advmod", "npadvmod")
        if self._is_copula:
            adverbial = unknown.top == unknown.word and unknown.top.dep == "advmod"
        if adverbial and objects:
            return self.subjects, objects
        return self.subjects, [(unknown.kind, False)]

    @cached_property
    def own_subjects(self) -> list[Word]:
        """The subjects of the clause itself. The parser attaches some subjects to an auxiliary or an adjective."""
        tree, last = self.tree, self.chain[-1]
        there = tree.children_of(self.verbs, "attr", "dobj") if tree.children_of(self.verbs, "expl") else []
        found = there or tree.children_of(self.verbs[::-1], *SUBJECTS)
        beside = [*tree.children(self.verb, "aux", "auxpass"), *tree.children(last, "acomp", "attr")]
        found = found or tree.children_of(beside, *SUBJECTS)
        if not found and (before := tree.before(self.verb)) is not None and before.dep == "appos":
            return [before]  # as in "I have a sister her name is Lisa"
        if self._is_copula and self.unknown is not None and (not found or self.unknown.top in found):
            others = found + [word for word in tree.children(last, "attr", "dobj") if word.pos not in ("ADJ", "ADV")]
            # As in "who is your friend".
            return [word for word in others if word != self.unknown.top][:1] or [self.unknown.top]
        return found

    @cached_property
    def subjects(self) -> list[Part]:
        """The clause's own subjects. If there are none, the subjects of `head_clause`, or the unsaid subject."""
        own, head, verb = self.own_subjects, self.head_clause, self.verb
        above = self.tree.head(verb)
        if own and own[0].low in _RELATIVE and self._is_relative and len(own) == 1:
            return self._antecedent
        if own and own[0].low in ("'s", "us", "s"):
            return [_WE]
        if own:
            return [part for part, contrasted in self._written(own) if not contrasted]
        if verb.dep == "ROOT" or (verb.dep in ("ccomp", "parataxis", "dep") and head is None):
            return self._unsaid()
        if verb.dep == "acl" or head is None:
            return []
        own_aim = lemma_of(above) in CONTACT and is_infinitive(self.tree, verb)  # unlike "I asked him to come"
        him = [] if own_aim else self.tree.children(above, "dobj", "dative")
        if verb.dep in ("xcomp", "ccomp") and not self._inherited and him and him[0].index < verb.index:
            return [_WE] if head._is_lets else [part for part, _ in self._written(him)]
        return head.subjects

    def _unsaid(self) -> list[Part]:
        """Return the unsaid subject: *you* in a request, *I* in a note such as *am tired*."""
        auxiliaries = [word.low for word in self.tree.children(self.verb, "aux", "auxpass")]
        if any("?" in word.low for word in self.own):  # as in "like it?"
            return [YOU]
        if self.verb.lemma.lower() == "thank" or self.verb.low == "am" or set(auxiliaries) & {"am", "have"}:
            return [_I]
        if set(auxiliaries) & {"ca", "can", "could"}:  # as in "can't find it"
            return [_I]
        has = lemma_of(self.verb) in ("have", "get") and (self.negated or len(self.chain) > 1)
        states = lemma_of(self.verb) in OWN_STATES or has
        request = (self.verb.tag in ("VB", "VBP") or "do" in auxiliaries) and not states
        return [YOU] if request else [_I] if states or self.verb.tag in ("VBD", "VBG", "VBN") else [NOTHING]

    @property
    def _antecedent(self) -> list[Part]:
        """The noun before a relative clause."""
        noun = self.tree.head(self.verb)
        return [phrase_of(self.tree, noun)]

    def _objects(self) -> list[tuple[Part, bool]]:
        """Return the objects of the first kind (in the README's order) that the clause has. For the flags, see `_parts`."""
        tree, verbs = self.tree, self.verbs
        if lacks_copula(tree, self.verb):
            return self._written([self.verb], self.verb)
        if self._is_state and not self._names_pursuit:
            return [(phrase_of(tree, verbs[0], adjective_phrase(tree, verbs[0], verbs[0])), False)]
        relative = self._is_relative and bool(self.own_subjects) and self.own_subjects[0].low not in _RELATIVE
        relative = relative and not any(word.low == "whose" or word.dep == "mark" for word in self.own)
        for verb in verbs:
            direct = [word for word in tree.children(verb, *_DIRECT) if self._is_free(word)]
            if not direct:  # as in "it makes me happy"
                small = [word for word in tree.children(verb, "ccomp") if word.index not in self._clauses]
                direct = tree.children_of(small, *SUBJECTS)
            gives = lemma_of(verb) in _GIVING
            # As in "she told her friends the truth".
            if gives and [word.dep for word in direct[:2]] == ["dobj", "dobj"]:
                del direct[0]
            given = gives and direct and direct[0].pos == "PRON"  # as in "the book you gave me"
            if direct and not (relative and (given or direct[0].low in _RELATIVE)):
                strays = [w for w in tree.children(verb, "conj") if w.index not in self._clauses and w.pos in _NOMINAL]
                return self._written([direct[0], *(word for word in strays if word.index > direct[0].index)], verb)
        if relative and not self._runs_on:
            return [(part, False) for part in self._antecedent]
        for verb in verbs:
            states = [w for w in tree.children(verb, "advmod") if w.low in STATES and lemma_of(verb) in _SENSES]
            indirect = [word for word in tree.children(verb, "dative") if word.pos != "ADP"]
            if states or indirect or (verb == self.verb and self._beside):
                return self._written(states or indirect or self._beside, verb)
        subjects = self.own_subjects if self._is_copula and self.unknown is None else []
        after = tree.after(verbs[0]) if subjects else None  # as in "my name is Tom I live in Berlin"
        if after is not None and after.dep in ("npadvmod", "compound") and tree.head(after).pos in VERBAL:
            return [(phrase_of(tree, after, [after]), False)] if tree.head(after).index > after.index else []
        beside = [word for subject in subjects for word in conjuncts(tree, subject, self._clauses)]
        for head in (*verbs, *beside):
            if found := self._in_phrases(head, of=head in verbs):
                return found
        for word in tree.children_of(verbs, "advmod", "npadvmod", "dep"):
            if word.low in PLACES:
                return [(phrase_of(tree, word, [word]), False)]
        for word in tree.children(self.verb, "conj"):  # as in "bought and read the book"
            between = tree.words[self.verb.index + 1 : word.index]
            joined = between and all(w.dep in ("cc", "prt") for w in between)
            if (other := self._clauses.get(word.index)) and joined and lemma_of(self.verb) not in SETTLING:
                return other._objects()
        return []

    @cached_property
    def _beside(self) -> list[Word]:
        """The predicate, if the parser attaches it to the subject by mistake: *is Rome a city*, *are cats nice*."""
        subjects = self.own_subjects if self._is_copula and self.unknown is None else []
        beside = self.tree.children_of(subjects, "appos", "amod", "npadvmod")
        asked = bool(subjects) and subjects[0].index > self.verb.index
        return [word for word in beside if asked and word.index > subjects[0].index]

    def _is_free(self, word: Word) -> bool:
        """Return whether a word is neither a verb of the chain, nor the unknown, nor the subject."""
        taken = word in self.chain or word in self.own_subjects or self._asks_at(word)
        return not taken and word.pos not in ("PUNCT", "SYM", "INTJ")

    def _asks_at(self, word: Word) -> bool:
        return self.unknown is not None and word in (self.unknown.top, self.unknown.word)

    @property
    def _runs_on(self) -> bool:
        """Whether this clause, after a name, is a sentence of its own: *my name is Tom I live in Berlin*."""
        noun = self.tree.head(self.verb)
        bare = noun.tag in ("NN", "NNP", "PRP") and not noun.low.endswith(("thing", "body", "one"))
        bare = bare and not self.tree.children(noun, "det", "poss", "amod", "nummod")
        return bare and not self.tree.children(self.verb, "mark", "dobj")

    def _in_phrases(self, head: Word, *, of: bool = True) -> list[tuple[Part, bool]]:
        """Return the nouns of the first prepositional phrase after the head. If there is none, look before the head.

        If `of` is false, leave out phrases with the preposition *of*.
        """
        heads = [head, *self.tree.children(head, "advmod")]  # as in "next to the station"
        phrases = [word for word in self.tree.children_of(heads, "prep", "dative") if of or word.low != "of"]
        for phrase in sorted(phrases, key=lambda word: (word.index < head.index, word.index)):
            # "out of" and "in Rome and in Bern" count both prepositions, "from May to July" only the first.
            more = ("conj",) if self.tree.children(phrase, "pobj") else ("prep", "conj")
            prepositions = [phrase, *self.tree.children(phrase, *more)]
            nouns = [noun for noun in self.tree.children_of(prepositions, "pobj", "pcomp") if noun.low != "of"]
            asked = self.unknown is not None and any(self.unknown.word in self.tree.subtree(noun) for noun in nouns)
            if nouns and not asked:
                return self._written(nouns)
        return []

    # ------------------------------------------------------------------------------------- questions

    @cached_property
    def unknown(self) -> _Unknown | None:
        """The part that the clause asks for; None if it has no question word that asks."""
        if self._is_relative:
            return None
        for word in self.own:
            kind = kind_at(self.tree.words, word.index) if word.low in QUESTION_WORDS else None
            adverbial = self.verb.dep == "advcl" and word.low in ("when", "where", "how", "why")
            if kind is not None and not adverbial and word not in self.chain:
                above = [word, *self.tree.ancestors(word)]
                verb = next(place for place, other in enumerate(above) if other in self.chain or other == self.verb)
                return _Unknown(word, above[verb - 1], kind)
        return None

    @cached_property
    def _is_copula(self) -> bool:
        return lemma_of(self.chain[-1]) == "be"

    # --------------------------------------------------------------------------------------- writing

    def _written(self, heads: Iterable[Word], verb: Word | None = None) -> list[tuple[Part, bool]]:
        """Return the phrases of `heads` and their conjuncts, each with a flag: whether a *not* denies only this phrase."""
        found: list[tuple[Part, bool]] = []
        for head in heads:
            for word in conjuncts(self.tree, head, self._clauses):
                if self.unknown is not None and self._asks_at(word):
                    found.append((self.unknown.kind, False))
                    continue
                if verb is not None and self._is_predicative(word, verb):
                    words = adjective_phrase(self.tree, word, verb)
                else:
                    gerund = word.pos in VERBAL and word.dep != "ROOT"
                    words = gerund_phrase(self.tree, word) if gerund else noun_phrase(self.tree, word)
                words = [other for other in words if other == word or other not in self._beside]
                found.append((self._whose(phrase_of(self.tree, word, words)), is_denied(self.tree, word)))
        return found

    def _whose(self, phrase: Phrase) -> Phrase:
        """Replace *whose* in a relative clause: *whose father* becomes *the boy's father*."""
        if not self._is_relative or not phrase.text.lower().startswith("whose "):
            return phrase
        owner = self._antecedent[0]
        assert isinstance(owner, Phrase)
        return replace(phrase, text=f"{owner.text}'s {phrase.text[6:]}", owner=owner)

    def _gerund(self, verb: Word) -> list[Word]:
        """Return the gerund with its own words, without the rest of the clause."""
        inner = [gerund_phrase(self.tree, child) for child in self.tree.children(verb, "dobj", "prep", "prt")]
        return [verb, *(word for words in inner for word in words)]

    def _is_predicative(self, word: Word, verb: Word) -> bool:
        """Return whether an adjective is a predicate: *she is nice*, but not *I speak a little German*."""
        adjective = word.pos in ("ADJ", "VERB", "ADV") and word.tag != "VBG"
        beside = self.tree.children(word, "det", "amod", "poss")
        return adjective and not beside and (lemma_of(verb) == "be" or word.dep != "dobj")


def _text(part: Part) -> str | QuestionWord:
    return part.text if isinstance(part, Phrase) else part
