"""Recognise questions and their kinds, from the clauses of a text and the beginnings of its sentences."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest

from ravestate.language.contractions import word_set

from .clause import Clause
from .question_word import AUXILIARIES, QUESTION_WORDS, QuestionWord, kind_at
from .repair import tag_at
from .tree import Tree, Word
from .verbs import VERBAL, lemma_of

_OPENERS = word_set(
    "well so oh ok okay hi hello hey hallo good morning evening afternoon um uh hmm ah and but or then now please sorry excuse "
    "me thanks great fine yes no yeah nice cool right alright also actually just by the way anyway sure wow haha"
)
"""Words without meaning before a question."""
_TELLING = word_set("tell say explain show remind describe ask inform clarify specify confirm mention point")
_KNOWING = word_set("know remember guess wonder see find hear understand recall")
"""Verbs of knowing before an indirect question: *do you know where*."""
_MINDING = word_set("remember recall understand see hear")
"""Verbs of requests that are no questions: *remember who you are*."""
_SETTLING = word_set("decide check figure work realise realize notice imagine discover determine")
"""Verbs before an indirect question, if they are in a question: *have you decided where*, but not *I decided where*."""
_SUBJECTIVE = word_set("he she they we i")
_THEM = word_set("him her them")
_HINTS = word_set("idea clue reason sure")
"""Words before an indirect question that need no verb: *any clue who*, *are you sure when*."""
_PERFORMED = word_set("joke story tale poem riddle secret lie fairytale anecdote goodnight that again to not")
"""Words for things to perform, such as jokes. A request for a performance is not a question."""
_ANY = word_set("any ever anyone anybody anything")
"""First words of questions that leave out their verb: *any plans for today*, *ever been to Paris*."""
_ANYBODY = word_set("anyone anybody someone somebody any")
"""The subjects of questions and requests that leave out their auxiliary: *anyone know who*, *somebody tell me how*."""
_NO_PREDICATE = word_set("too either neither again first next")
"""Words that make no question of a *you* before them: *you too*."""
_REPORTING = (
    _TELLING
    | _KNOWING
    | word_set("forget forgot care matter mean learn teach think decide mention realise realize figure notice be")
)
"""Verbs before a question word that stands for a clause: *he knows why*, *that is how*."""
_BEFORE_TAG = word_set("here there me you him her them us")
"""After one of these words, as after a noun or an adjective, *right* is a question tag even without a comma."""
_NOMINAL = ("PRON", "DET", "NOUN", "PROPN")
_TAGS = word_set("right correct huh eh yes no ok okay")


def question_of(tree: Tree, clauses: Sequence[Clause] | None = None) -> QuestionWord | None:
    """Return the kind of the first question in the text; None if the text has no question."""
    clauses = Clause.all_in(tree) if clauses is None else clauses
    kinds = (_kind(tree, words, _inside(words, clauses)) for words in _sentences(tree))
    return next((kind for kind in kinds if kind is not None), None)


def _inside(words: Sequence[Word], clauses: Sequence[Clause]) -> list[Clause]:
    return [clause for clause in clauses if words[0].index <= clause.verb.index <= words[-1].index]


def _sentences(tree: Tree) -> list[list[Word]]:
    """Return the words of each sentence, with the marks that end it."""
    found: list[list[Word]] = [[]]
    for word in tree.words:
        before = tree.before(word)
        ended = before is not None and not before.low.strip(".!?…") and word.low.strip(".!?…")
        if found[-1] and before is not None and (ended or "\n" in tree.text[before.end : word.start]):
            found.append([])
        found[-1].append(word)
    return found if tree.words else []


def _kind(tree: Tree, words: Sequence[Word], clauses: Sequence[Clause]) -> QuestionWord | None:
    """Return the kind of the first question in a sentence."""
    asked = any("?" in word.low for word in words)
    likely = "?" in tree.text[words[0].start : words[-1].end + 1]  # the normal form adds a mark to a likely question
    parts = _parts(words)
    for part in parts:
        inside = _inside(part, clauses)
        led = ("ADP", "SCONJ", "ADV") if asked else ("ADP", "SCONJ")
        beside = len(part) > 1 and part[0].pos in led and part[0].low not in ("like", *QUESTION_WORDS)
        rest = part[beside:]
        kind = kind_at(part, int(beside))
        sure = likely and part == parts[-1] and rest[0].low not in ("when", "where")
        exclaims = tree.text[part[-1].end :].startswith("!")
        called = len(part) == 1 and part != parts[-1] and not asked  # as in "why, that is lovely!"
        if (
            kind is not None
            and not called
            and _opens_question(rest, inside, sure, exclaims=exclaims, apart=_stands_apart(parts, part, tree))
        ):
            return kind
        if part[0].low in ("any", "got", "have") and _HINTS & {word.low for word in part[:4]}:
            return next((kind for place in range(len(part)) if (kind := kind_at(part, place))), None)
        for clause in inside:
            if (found := _of_clause(clause, asked)) is not None:
                return found
    words = [word for word in words if word.pos != "PUNCT"]
    low = [word.low for word in words]
    stated = low[:1] == ["you"] and not any(clause.negated for clause in clauses)
    if (kind := _in_place(words, clauses, asked, stated)) is not None:
        return kind
    if not words or asked or (stated and "any" in low):  # as in "you know any songs"
        return QuestionWord.YES_NO if low or asked else None
    after = words[2:] if low[1:2] == ["n't"] else words[1:]
    inverted = low[0] in AUXILIARIES and len(after) > 1 and after[0].pos in _NOMINAL  # as in "do dogs dream"
    inverted = inverted and not (words[0].lemma == "have" and words[0].pos == "VERB")  # "had a swarm settle on my hat"
    if (likely and inverted) or _lacks_auxiliary(words, clauses):
        return QuestionWord.YES_NO
    bare = low[-2:] in (["and", "you"], ["and", "yours"]) or low[0] in _ANY or low[1:2] == ["any"]
    return QuestionWord.YES_NO if bare or _has_tag(tree, words) else None


def _in_place(words: Sequence[Word], clauses: Sequence[Clause], asked: bool, stated: bool) -> QuestionWord | None:
    """Return the kind of a question word at the end of a statement: *you live where*, *you paid how much?*"""
    for place in range(1 if asked else max(len(words) - 3, 1), len(words)):
        kind, rest = kind_at(words, place), words[place + 1 :]
        if kind is None or any(word.pos in (VERBAL if asked else (*VERBAL, "PRON", "ADP")) for word in rest):
            continue
        verb = next((clause for clause in clauses if words[place] in clause.own), None)
        told = lemma_of(words[place - 1]) in _REPORTING if verb is None else verb.lemma in _REPORTING or verb.negated
        if asked or (not told and (stated or (verb is not None and verb.own_subjects and not rest))):
            return kind
    return None


def _lacks_auxiliary(words: Sequence[Word], clauses: Sequence[Clause]) -> bool:
    """Return whether a question leaves out its auxiliary: *you coming*, *you okay*, *want to play*, *had lunch yet*."""
    first, *rest = words
    if first.low in ("want", "fancy"):
        return bool(rest) and rest[0].low in ("to", "a", "an", "some", "any", "me")
    if first.tag in ("VBD", "VBN") and rest and rest[-1].low in ("yet", "lately"):
        return not any(clause.negated or clause.own_subjects for clause in clauses)
    if first.low == "everything" and rest and not any(word.pos in VERBAL for word in rest):
        return rest[-1].pos in ("ADJ", "ADV")
    if first.low != "you" or not rest:
        return False
    verbs = [word for word in rest if word.pos in VERBAL and word.low not in ("ok", "okay")]
    if not verbs:
        return (rest[-1].pos in ("ADJ", "ADV") or rest[-1].low in ("ok", "okay")) and not _NO_PREDICATE & {
            word.low for word in rest
        }
    return verbs[0].tag == "VBG" and all(word.pos in ("ADV", "PRON") for word in words[: words.index(verbs[0])])


def _has_tag(tree: Tree, words: Sequence[Word]) -> bool:
    """Return whether a sentence ends with a question tag: *isn't it*, *right*."""
    *rest, last = words
    if any(tag_at(tree.words, word.index) for word in words):
        return True
    if len(rest) < 2 or last.low not in _TAGS:
        return False
    stated = rest[-1].pos in ("NOUN", "PROPN", "NUM", "ADJ") or rest[-1].low in _BEFORE_TAG
    return tree.words[last.index - 1].low == "," or (last.low in ("right", "huh") and stated)


def _parts(words: Sequence[Word]) -> list[list[Word]]:
    """Return the parts between commas, without opening words."""
    parts: list[list[Word]] = [[]]
    for word in words:
        if word.pos == "PUNCT" and word.low in ",;:-–—":
            parts.append([])
        elif word.pos != "PUNCT" and (parts[-1] or word.low not in _OPENERS or word == words[-1]):
            parts[-1].append(word)
    return [part for part in parts if part]


def _stands_apart(parts: Sequence[Sequence[Word]], part: Sequence[Word], tree: Tree) -> bool:
    """Return whether a colon or a single word precedes a part. If so, it is no relative clause: *Mum, who made it*."""
    before = tree.before(part[0])
    return before is not None and (before.low == ":" or (before.low == "," and parts.index(part) == len(parts[0]) == 1))


def _opens_question(
    part: Sequence[Word], clauses: Sequence[Clause], asked: bool, *, exclaims: bool, apart: bool
) -> bool:
    """Return whether a part that begins with a question word is a question.

    Args:
        part: The words.
        clauses: The clauses of these words.
        asked: Whether a question mark follows.
        exclaims: Whether an exclamation mark follows.
        apart: Whether the words before the part belong to another clause.
    """
    first, second = part[0], part[1].low if len(part) > 1 else ""
    if first.low == "which" and second in AUXILIARIES and part[2:] and part[2].low in QUESTION_WORDS:
        return False  # as in "which is why I came"
    if (first.low, second) in (("what", "about"), ("how", "about"), ("how", "come"), ("what", "if")):
        return True
    clause = next((clause for clause in clauses if first.index in [word.index for word in clause.own]), None)
    subordinate = ("csubj", "relcl") if second in AUXILIARIES else ("advcl", "csubj", "relcl")
    turned = second in AUXILIARIES and part[2:] and part[2].low in _SUBJECTIVE  # "the man over there, who is he"
    if clause is not None and not (clause.inverted or turned or apart) and clause.verb.dep in subordinate:
        return False
    if any(clause.inverted for clause in clauses) or second in AUXILIARIES:
        return True
    low = [word.low for word in part]
    addressed = second == "you" or (
        kind_at(part, 0) is QuestionWord.AMOUNT and low[2:3] == ["you"] and "are" not in low
    )
    # As in "how much you have grown!".
    exclaimed = clause is not None and exclaims
    ends = clause is None or clause.verb.dep == "ROOT"
    if exclaims and first.low == "how":  # as in "how time flies!"
        return False
    if addressed and ends and not exclaimed and not (part[2:] and part[2].pos == "AUX" and part[2].tag != "VBN"):
        return True  # as in "where you live"
    nice = (
        len(part) > 1 and part[1].pos in ("ADJ", "ADV") and kind_at(part, 0) in (QuestionWord.FORM, QuestionWord.OBJECT)
    )
    if asked or nice or (first.low == "what" and second in ("a", "an")):
        return asked and not (nice and first.low == "what" and part[-1].pos in VERBAL)  # as in "how nice of you"
    if clause is None or clause.unknown is None:
        return len(part) < 4 or (not exclaims and kind_at(part, 0) is QuestionWord.AMOUNT)
    begins = clause.verb.dep in ("ROOT", "ccomp") and clause.unknown.top in clause.own_subjects  # as in "what happened"
    return begins or not clause.own_subjects


def _of_clause(clause: Clause, asked: bool) -> QuestionWord | None:
    """Return the kind of a question that begins with its verb, or of an indirect question."""
    tree, verb = clause.tree, clause.chain[-1]
    lemma, own = lemma_of(verb), [word.low for word in clause.own]
    if clause.unknown is not None and clause.inverted:
        return clause.unknown.kind
    wishes = bool({"i", "we"} & set(own) or own[0] == "want") and lemma_of(clause.chain[0]) in (
        "want",
        "like",
        "love",
        "need",
        "mean",
        "hope",
    )
    others = bool(_THEM & set(own)) or (
        wishes and lemma in _TELLING and lemma != "ask"
    )  # as in "I want to show you where"
    wonders = bool({"wonder", "wondering", "curious"} & set(own)) or (clause.inverted and _HINTS & set(own))
    wonders = wonders or any(word.low == "question" for word in clause.own_subjects)  # as in "my question is who pays"
    demands = (
        clause.inverted
        or (clause.requests and not clause.negated)
        or (wishes and len(clause.chain) > 1)
        or (asked and own[0] == "you")
        or (own[0] in _ANYBODY and clause.chain[0].tag in ("VB", "VBP"))
        or ({"you", "could", "me"} <= set(own))  # as in "I hoped that you could tell me when"
        or (asked and own[0] == "mind")  # as in "mind telling me who"
    )
    if clause.requests and not clause.inverted and lemma in _MINDING:
        demands = False
    settles = (clause.inverted or own[0] in _ANYBODY) and lemma in _SETTLING
    let = clause.head_clause is not None and clause.head_clause.requests and lemma in ("know", "ask")
    told = demands and not others and lemma in _TELLING | _KNOWING
    if told or (settles and (lemma != "work" or "out" in own)) or wonders or let:
        words = [word for word in tree.subtree(clause.verb) if word.index > verb.index]
        for word, after in zip_longest(words, words[1:]):
            kind = QuestionWord.YES_NO if word.low in ("if", "whether") else kind_at(tree.words, word.index)
            if kind is not None and not (verb.low == "guess" and (after is None or after.pos == "PUNCT")):
                return kind
            if word.pos in ("PROPN", "VERB", "AUX") or (
                word.pos in ("NOUN", "PRON") and lemma not in _TELLING and not wonders
            ):
                break
        objects = {word.lemma.lower() for word in clause.own if word.index > verb.index and word.pos != "PUNCT"}
        asker = "i" in own
        if objects - {"i", "we"} and not objects & _PERFORMED and lemma == ("know" if asker else "tell"):
            return QuestionWord.OBJECT if asker or "me" in own or "us" in own else None
    did = lemma == "do" and len(clause.chain) == 1 and all(word.pos != "PRON" for word in clause.own_subjects)
    did = did or own[:2] == ["do", "it"]
    return QuestionWord.YES_NO if clause.inverted and not did else None  # no question: "did my homework", "do it now"
