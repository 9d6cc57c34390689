"""The kind of a question or request (language/examples/asks.yaml), its area of life, and the words that it names.

The listener (the part that chooses the agent's reply) looks up an answer by kind and area, or else by kind alone
(asked.yaml). The answers by kind and area (areas.yaml) are mostly recommendations and the agent's own tastes. The words
come from the parse: the options of a choice, the thing that the question is about, and question words such as *how many
eggs*.
"""

from __future__ import annotations

import re
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ravestate.language.contractions import word_set
from ravestate.language.feelings import SORROWS
from ravestate.language.moves import LISTENING
from ravestate.language.reranker import Reranker
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import AUXILIARIES, QUESTION_WORDS, QuestionWord
from ravestate.modules.meta.nlp.tree import SUBJECTS, Tree, Word

from .asking import words_of
from .material import Material
from .phrases import Line, Phrases
from .roles import turned
from .state import State

ANSWER, EXACTLY = -10.3, -8.6
"""`ANSWER`: the minimum score of advice, which suits many questions. `EXACTLY`: the minimum score of an answer that must be
exact. The scores are logits of the cross-encoder (a network that compares two texts). An answer to a different question
from the same area of life scores -10 to -11."""
SURE, ORDERED, UNASKED = 0.4, 0.6, 0.8
"""The minimum confidence in the kind of an utterance. `SURE`: of a question. `ORDERED`: of an order. `UNASKED`: of any
other utterance."""
ALIKE: Mapping[str, tuple[str, ...]] = {
    "choose": ("recommend",),
    "would_you": ("would_you", "favourite"),
}
"""Kind → the classes of an area whose answers suit it, the best first. For other kinds, only the class of the same name."""
WORDING = word_set("repeat shorter say_word")
"""Kinds that ask the agent to say or repeat words. *Again* is not of these kinds if the utterance has other sentences."""
OPEN = word_set("recommend should worth favourite would_you fact choose predict permit explain")
"""Kinds that become a choice if the user names options."""
EXACT = word_set("fact why choose measure would_you about_you")
"""Kinds whose answers suit few other questions of the same area."""
OWN = word_set("about_you would_you favourite")
"""Kinds that ask about the agent."""
_WRAPPING = word_set("know tell explain say think believe guess suppose recommend help show give")
_YOU = word_set("you your yours yourself u ur")
_POLITE = word_set("think know believe say tell guess suppose reckon")
"""Verbs that only introduce a question: *how old do you think he is*."""
BY_MOVE = {"advice": "how_to", "opinion": "you_think"}
"""Move (the next step of a good listener) → the kind of a question, if the classifier finds no kind."""
LEAST_WRAPPED = 4
"""If a question has more words and punctuation marks than this, its opening *do you think* is left out."""
_STATING = word_set("is are was were does did do has have")
_PERSONAL = word_set("i we you it")
_TIPS = word_set("tip tips advice suggestion suggestions")
_OFFERED = _TIPS | word_set("idea ideas clue")
"""Nouns in questions such as *do you have any idea*. Such a question is not about the agent."""
_FUTURE = word_set("will wo 'll going gonna would might ever still soon tomorrow")
"""Words of a question about the future."""
BRIEF = 4
"""The maximum number of words of a choice without a verb: *tea or coffee*."""
CALM = ("fact", "why", "about_you")
"""Kinds that do not count if the user needs consolation, as in *but who takes me at 52*, *are you even listening*."""
MANY = {"two": 2, "three": 3, "four": 4, "five": 5}
_SAY = re.compile(r"\b(?:say|repeat(?: after me)?)\b[,:]? *(?:the words? |it |something |with me )?[\"']?([\w' ]{1,30}?)[\"']?"
                  r"(?: please| to .*| for .*| just .*|[.!?,].*)?$", re.IGNORECASE)  # fmt: skip
_TIMES_SAID = re.compile(r" (?:(?:an? )?(\w+) times|twice)\b", re.IGNORECASE)
"""The number of times that the agent is to say words; at most five times."""
_CUT = ("VERB", "AUX", "ADP", "SCONJ", "PRON", "PUNCT", "INTJ")
_LIKED = word_set("better nicer worse more rather prettier")
"""Comparatives of opinions."""
_BARE = word_set("not what something anything so else whatever")
"""Words after *or* that do not name an option."""
_TIMES = word_set("night evening afternoon day weekend hour time")
_EMPTY = word_set("do have get go make")
_NAMING = ("dobj", "nsubj", "nsubjpass", "pobj", "attr", "ROOT")
"""The grammatical relations in which to look for the noun that a question is about, the likeliest first."""
_PART = ("det", "amod", "compound", "poss", "case", "nummod", "nmod")
_WHICH = re.compile(
    r"\b(?:which|what) (?:one|of (?:them|the two|both))\b|\bwhich (?:would|should|do|is)\b", re.IGNORECASE
)
"""A question that asks the agent to choose between the options that the user named before."""
WEIGHTS = {
    "dobj": 1.3,
    "attr": 1.3,
    "ROOT": 1.2,
    "xcomp": 1.2,
    "ccomp": 1.2,
    "nsubj": 1.05,
    "npadvmod": 0.5,
    "acomp": 1.4,
}
"""Grammatical relation of a word → its weight in the choice of the area. Other words have the weight 1."""


@dataclass(frozen=True, slots=True)
class Asked:
    """A question or request."""

    kind: str
    """The question's class in asks.yaml."""
    area: Phrases | None
    values: Mapping[str, str]
    """The values of the *roles*, the placeholders in phrases: ``first`` and ``second``, ``about``, ``word``, ``short``,
    ``picked``."""
    groups: tuple[str, ...]
    """The groups of asked.yaml to try, the most specific first."""

    @property
    def own(self) -> list[Sequence[Line]]:
        """The answers of the area."""
        if self.area is None or (self.kind == "choose" and "first" in self.values):
            return []
        return [self.area.groups[kind] for kind in ALIKE.get(self.kind, (self.kind,)) if kind in self.area.groups]

    def lines(self, phrases: Material, tone: str, question: str) -> list[Sequence[Line]]:
        """Return the groups of answers, the most specific first. Answers of the area must suit the question's words."""
        general = phrases.asked[self.kind]
        named = [self.area.name] if self.area else []
        first = general.lines("picked") if "picked" in self.groups else []
        least = EXACTLY if self.kind in EXACT else ANSWER
        own = [[line] for lines in self.own for line in answering(question, lines, least)]
        return [*first, *own, *general.lines(*named, tone, *self.groups, "say")]


def answering(question: str, lines: Sequence[Line], least: float = ANSWER) -> list[Line]:
    """Return the lines that may answer a question, the likeliest first; before `load_judge`, all lines in their order."""
    if not _ready.is_set() or not lines or not question:
        return list(lines)
    scores = _judge.score_pairs([(question, line.text) for line in lines]).tolist()
    ranked = sorted(zip(scores, lines, strict=True), key=lambda one: -one[0])
    return [line for score, line in ranked if score >= least]


def load_judge() -> None:
    """Load the cross-encoder, which scores the answers.

    Raises:
        PlatformError: The model is missing or broken.
    """
    _judge.load()
    _ready.set()


_judge, _ready = Reranker(), threading.Event()


def asked_in(
    phrases: Material, seen: Analysis, asking: str, state: State, moves: Sequence[str], *, request: bool
) -> Asked | None:
    """Return the question or request of an utterance; None if it has none.

    Args:
        phrases: The authored answers.
        seen: The analysis of the utterance.
        asking: The sentence that asks something, or an empty text.
        state: The state of the conversation, for *say that again*.
        moves: The likely next moves of a good listener, such as to console.
        request: Whether the utterance is an order.
    """
    words = words_of(seen.tree, asking)
    wrapped = len(words) > LEAST_WRAPPED and wraps(words[:4])
    knowing = wrapped and words[2].lemma.lower() in ("know", "tell")  # "do you know when it opens?"
    words = words[3:] if wrapped else words
    options = options_in(seen.tree, words)
    least = SURE if asking else ORDERED if request else UNASKED
    found = [one for one in seen.asks.values() if one.score >= least and (not asking or one.text == asking)]
    best = max(found, key=lambda one: one.score, default=None)
    kind = "" if best is None else best.name
    if options and (not kind or kind in OPEN):
        kind = "choose" if asking or kind == "choose" or len(words) <= BRIEF else ""
    if asking and not options and state.options and (kind == "choose" or _WHICH.search(asking)):
        kind, options = "choose", (*state.options, False)  # "... tea and milk. Which would you take?"
    compared = any(word.tag in ("JJR", "RBR") and word.low not in _LIKED for word in words)
    if kind == "choose" and not options and [word.low for word in words if word.pos != "PUNCT"][-2:] == ["or", "not"]:
        kind = "should"  # "can I do that or not?"
    if kind in WORDING and len(seen.sentences) > 1 and not asking:
        return None  # "short night. two hours. again"
    if kind == "choose" and compared and words and words[0].low in QUESTION_WORDS:
        kind = "fact"  # "which is heavier, gold or lead?"
    plainly = asking and words and (asking.endswith("?") or words[0].low in {*QUESTION_WORDS, *AUXILIARIES})
    if asking and wrapped and kind in ("", "about_you", "predict"):  # "do you think that they will be angry?"
        kind = "fact" if knowing else "predict" if any(word.low in _FUTURE for word in words) else "you_think"
    low = [word.low for word in words]
    stated = bool(_STATING.intersection(low[:1])) and _PERSONAL.isdisjoint(low[1:2]) and _LIKED.isdisjoint(low)
    if kind == "choose" and options and stated:
        kind = "fact"  # "is my data on a disk or in the cloud?"
    offered = not _OFFERED.isdisjoint(low) and not {*AUXILIARIES, "any"}.isdisjoint(low[:1])
    if asking and kind in ("", "fact", "about_you") and offered:
        kind = "fact" if "how" not in low and not _TIPS & set(low) else "how_to"  # "do you have a tip for my nerves?"
    if plainly and kind in ("", "fact") and _asks_agent(words) and _OFFERED.isdisjoint(low):
        kind = "would_you" if words[0].low in ("would", "could") else "about_you"
    if plainly and not kind:
        kind = BY_MOVE.get(moves[0] if moves else "", "")
    if plainly and (not kind or (kind in OWN and _YOU.isdisjoint(word.low for word in words))):
        kind = "fact"
    area = area_of(phrases, seen.tree, words, kind)
    if kind in ("another", "meant") and state.asked:
        last = phrases.areas.get(state.asked[1])
        area = last or area if kind == "another" else area or last
        kind = state.asked[0]
    heard = len(moves) == 1 and moves[0] in LISTENING
    if not kind or (kind in CALM and heard) or (best is None and moves[:1] == ("apologise",)):
        return None  # "but who takes me at 52?" asks for nothing
    last = state.said[-1] if state.said else ""
    values = {
        "first": options[0] if options else "",
        "second": options[1] if options else "",
        "about": about(phrases, seen.tree, words),
        "word": _word(seen) if kind in WORDING else "",
        "last": last,
        "short": re.split(r"(?<=[.!?]) |, (?=and|but|or|so)", last)[0].rstrip(",") if last else "",
        "picked": _picked(phrases, words, 0 if kind == "favourite" else len(state.said)),
    }
    values = {name: value for name, value in values.items() if value}
    verbal = options is not None and options[2]
    able = any(word.low in ("can", "could") for word in words[:1])
    groups = (["act"] if verbal else ["two"]) if options else []
    groups += ["picked"] * (kind in ("pick", "recommend", "favourite") and "picked" in values)
    groups += ["can"] * able + ["polar"] * (seen.question is QuestionWord.YES_NO)
    groups += ["question", "about", "last", "short", "word"]
    return Asked(kind, area, values, tuple(groups))


def _asks_agent(words: Sequence[Word]) -> bool:
    """Return whether a yes-no question is about the agent: *do you get tired of it*, but not *do you know who*."""
    first, second, third = [word.low for word in words[:3]] if len(words) > 2 else ("", "", "")
    return first in AUXILIARIES and second in _YOU and third not in _WRAPPING


def area_of(phrases: Material, tree: Tree, words: Sequence[Word], kind: str) -> Phrases | None:
    """Return the area of life of a question, by its main verb and nouns, or else by the rest of the utterance.

    Args:
        phrases: The areas.
        tree: The parse of the utterance.
        words: The words of the question.
        kind: The kind of the question. In requests such as *a poem about rain*, the words after *about* count more.
    """
    weights = {**WEIGHTS, "pobj": 1.5} if kind in ("write", "tell_me", "ask_me") else WEIGHTS
    inside = {word.index for word in words}
    telling = any(word.pos == "VERB" and word.lemma.lower() not in _EMPTY for word in words)
    scores: dict[str, float] = {}
    for word in tree.words:
        if telling and word.dep in ("pobj", "npadvmod") and word.lemma.lower() in _TIMES:
            continue  # "how can I learn it in one night" is not about sleep
        area = phrases.area_by_word.get(word.lemma.lower()) or phrases.area_by_word.get(word.low)
        if area and word.pos not in ("PRON", "AUX", "ADP", "DET"):
            near = 1.0 if word.index in inside else 0.45
            near *= weights.get(word.dep, 1.0)
            scores[area] = max(scores.get(area, 0.0), near - 0.001 * word.index)
    ranked = [phrases.areas[name] for name in sorted(scores, key=lambda name: -scores[name])]
    return next((one for one in ranked if one.groups.keys() & ALIKE.get(kind, {kind})), next(iter(ranked), None))


def about(phrases: Material, tree: Tree, words: Sequence[Word]) -> str:
    """Return the noun phrase that a question is about, from the agent's view (*your dog* for *my dog*); empty if there is none."""
    for relation in _NAMING:
        for word in words:
            if word.dep != relation or word.pos not in ("NOUN", "PROPN") or word.lemma.lower() in phrases.vague:
                continue
            parts = [part for part in tree.subtree(word) if part is word or _left(tree, part, word)]
            asks = any(part.low in QUESTION_WORDS for part in parts)
            text = "" if asks else turned(tree, parts)
            if text:
                return text
    return ""


def wraps(words: Sequence[Word]) -> bool:
    """Return whether the first three words only introduce a question: *do you think he*, *can you tell me*."""
    first, second, third, after = words
    wraps = first.tag in ("MD", "VBP", "VBD") and second.low in _YOU and third.lemma.lower() in _POLITE
    if third.lemma.lower() in ("say", "tell"):
        return wraps and after.low in ("me", "us")  # not "would you tell him?"
    if third.lemma.lower() == "know":
        return wraps and after.low in {*QUESTION_WORDS, "if", "whether"}  # not "do you know any songs?"
    return wraps and after.low not in ("about", "of") and after.pos != "PROPN"


def _left(tree: Tree, part: Word, noun: Word) -> bool:
    return part.index < noun.index and part.dep in _PART and noun.index in (part.head, tree.head(part).head)


def options_between(tree: Tree) -> tuple[str, str] | None:
    """Return the options of a statement: *between soup and salad*, *soup or salad*."""
    for word in tree.words:
        for one in tree.children(word, "pobj") if word.low == "between" else ():
            for other in tree.children(one, "conj"):
                inside = {part.index for part in tree.subtree(other)}
                own = [part for part in tree.subtree(one) if part.index not in inside]
                first = [part for part in own if part.dep not in ("cc", "punct")]
                return turned(tree, first), turned(tree, tree.subtree(other))
    found = options_in(tree, tree.words)
    return found[:2] if found else None


def options_in(tree: Tree, words: Sequence[Word]) -> tuple[str, str, bool] | None:
    """Return the options of *soup or salad* and *text her or wait*, and whether they are actions."""
    at = next((place for place, word in enumerate(words) if word.low == "or"), 0)
    after = words[at + 1 :]
    if not at or not after or after[0].low in _BARE or after[0].low in AUXILIARIES | {"i", "is", "did"}:
        return None
    verbal = after[0].tag in ("VB", "VBP") and after[0].pos == "VERB"
    if verbal:
        subject = next((place for place, word in enumerate(words[:at]) if word.dep in SUBJECTS), -1)
        start = next((place for place in range(subject + 1, at) if words[place].pos == "VERB"), at)
        second = _until(after, ("PUNCT",))
    elif after[0].pos == "ADP":  # "in the morning or in the evening"
        start = next((place for place in range(at - 1, -1, -1) if words[place].pos == "ADP"), at)
        second = _until(after, ("PUNCT",))
    else:
        start = at
        while start and not _cuts(words[start - 1]):
            start -= 1
        second = _until(after, ("PUNCT", "ADP", "SCONJ", "PRON", "AUX"))
    first = [word for word in words[start:at] if word.pos != "PUNCT"]
    one, two = turned(tree, first), turned(tree, second)
    return (one, two, verbal) if one and two and len(first) <= 6 and len(second) <= 6 else None


def _cuts(word: Word) -> bool:
    """Return whether an option begins after this word."""
    return word.pos in _CUT or word.tag in ("JJR", "RBR", "WDT", "WP") or word.low in ("better", "either")


def _until(words: Sequence[Word], ends: Sequence[str]) -> list[Word]:
    place = next((place for place, word in enumerate(words) if word.pos in ends), len(words))
    return list(words[:place])


def _word(seen: Analysis) -> str:
    """Return the words that the agent is asked to say, as often as the user wants: *say "boo" three times*."""
    text = seen.normal.text
    match = _SAY.search(_TIMES_SAID.sub("", text))
    said = match[1].strip() if match else ""
    own = {word.lower() for word in said.split()} & {"my", "me", "your", "that", "it", "this"}
    rude = "insult" in seen.acts or SORROWS & set(seen.feelings)
    times = _TIMES_SAID.search(text)
    number = times[1].lower() if times and times[1] else "two"
    many = MANY.get(number, MANY["five"]) if times else 1
    return "" if own or rude or not said or len(said.split()) > 4 else ", ".join([said] * many)


def _picked(phrases: Material, words: Sequence[Word], turn: int) -> str:
    """Return things of the kind that the request names, as many as it asks for: three animals for *three animals*."""
    for word in reversed(words):
        things = phrases.picks.get(word.lemma.lower(), ()) if word.dep != "npadvmod" else ()  # not "the day after"
        if things and word.pos in ("NOUN", "PROPN", "NUM", "ADJ", "VERB"):
            many = max((MANY.get(one.low, 1) for one in words), default=1)
            chosen = [things[(turn + place) % len(things)] for place in range(min(many, len(things)))]
            return ", ".join(chosen[:-1]) + " and " * (many > 1) + chosen[-1]
    return ""
