"""The record of the whole analysis of a text, and the function that makes it."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from ravestate.errors import PlatformError
from ravestate.language.acts import acts
from ravestate.language.contractions import word_set
from ravestate.language.entity import Entity
from ravestate.language.feelings import clauses, feelings
from ravestate.language.matcher import Match, Matcher, bundled_matcher
from ravestate.language.moves import Move, move_of
from ravestate.language.network import network
from ravestate.language.normal import Normal
from ravestate.language.sentences import sentences as sentences_of

from .answer import YesNo, yesno_of
from .clause import Clause
from .closing import Closing, closing_of
from .contrast import Contrast, contrasts_of
from .inquiry import question_of
from .introduction import Introduction, introductions_in
from .pipeline import Pipeline
from .question_word import QuestionWord
from .questions import questions_in
from .reading import Reading
from .repair import repaired
from .statement import Statement, Triple
from .statements import statements_of
from .tree import Tree

_SECOND_PERSON = word_set("you your yours yourself u ur")

INTENTS = {"play": "intent_play", "greeting": "intent_hi", "farewell": "intent_bye"}
"""Act of the user → the name of nlp's signal for this act. Other acts have no signal."""

MATCHERS = ("acts", "feelings", "asks")
"""The names of the files of examples with which an analysis compares the user's sentences."""


ADVICE = frozenset(
    (
        "recommend",
        "how_to",
        "should",
        "guess",
        "say_what",
        "predict",
        "what_if",
        "okay",
        "normal",
        "judge_me",
        "write",
        "pick",
        "permit",
    )
)
"""Classes of ``asks.yaml`` for questions that want advice or an opinion, not a fact."""
ADVISED = 0.6
"""The least confidence at which a class of ``asks.yaml`` shows that the user wants advice."""


@dataclass(frozen=True, slots=True)
class Analysis:
    """The analysis of a text; the README explains each part."""

    text: str
    """The text as typed."""
    normal: Normal
    """The normal form of the text: written English."""
    tree: Tree
    entities: tuple[Entity, ...]
    triples: tuple[Triple, ...]
    yesno: YesNo
    question: QuestionWord | None
    about_agent: bool
    sentences: tuple[str, ...] = ()
    """The sentences of the normal form."""
    statements: tuple[Statement, ...] = ()
    """The triples, with flags that say whether they are denied, past, hearsay and so on."""
    contrasts: tuple[Contrast, ...] = ()
    """The contrasts, also in texts without a verb: *Leipzig, not Leeds*."""
    closing: Closing | None = None
    """The question or request at the end of the utterance, if it can stand alone. See `Closing`."""
    acts: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """Class in ``acts.yaml``, such as ``greeting`` → the best match of a sentence for this act."""
    feelings: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """Class in ``feelings.yaml`` → the best match of a sentence for this feeling."""

    asks: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """Class in ``asks.yaml`` (a kind of question or request) → the best match of a sentence for this kind."""

    move: Move | None = None
    """The move that a good listener makes next, such as to rejoice, console or advise."""

    questions: tuple[Analysis, ...] = ()
    """The analyses of the single questions, if the utterance asks several; otherwise empty. Requests for facts
    count as questions."""

    intents: Mapping[str, Match] = field(default_factory=dict[str, Match])
    """Name of the signal of a designer's intent (`nlp.intent`) → the best match of a sentence for this intent."""

    @property
    def advised(self) -> bool:
        """Whether the user asks for advice, an opinion or a choice, and not for a fact."""
        sure = {name for name, match in self.asks.items() if match.score >= ADVISED}
        ours = any(said.subject_person in ("I", "you") or said.request for said in self.statements)
        return bool(sure & ADVICE) or ("choose" in sure and ours)

    @property
    def introduction(self) -> Introduction | None:
        """The user's name and the other words, if the user says both: *I'm Ada, and I have had a long day*."""
        persons = [one.text for one in self.entities if one.label == "PERSON"]
        return next(filter(None, (one.named(persons) for one in introductions_in(self.tree))), None)

    @property
    def acted(self) -> tuple[str, ...]:
        """The names of the signals that the acts raise: ``intent_hi``..."""
        return tuple(signal for act, signal in INTENTS.items() if act in self.acts)

    def act(self, name: str) -> Match | None:
        """Return the best match of a sentence for the act `name`; None if no sentence matches it."""
        return self.acts.get(name)


def load_models() -> None:
    """Load the models with which `analyse` reads a text.

    Before this call, the matchers recognise only sentences that equal an example.

    Raises:
        ModelMissing: The sentence model, or the package that runs it, is not installed.
        PlatformError: A model is broken.
    """
    for name in MATCHERS:
        bundled_matcher(name).load()
    network().load()


def analyse(
    text: str,
    pipeline: Pipeline,
    agent_names: Iterable[str] = (),
    users: Iterable[str] = (),
    designed: Matcher | None = None,
    reading: Reading | None = None,
) -> Analysis:
    """Analyse `text`. This blocks for a few milliseconds.

    Args:
        text: Any text; the analysis covers only the beginning of a long text.
        pipeline: The pipeline; the first call loads it in about a second.
        agent_names: The agent's names. A text with one of these names is about the agent. Case is ignored.
        users: The names of the users present. In the normal form, these names and the agent's names have capitals.
        designed: The matcher of the designer's intents. The first call waits until the matcher has learnt its examples.
        reading: A language model's reading of the text. If it keeps to the user's words, it gives the normal form, the
            kind of question, and the text's meaning as a yes or no.

    Raises:
        PlatformError: spaCy or the pipeline is missing, or the pipeline cannot be loaded.
    """
    if designed is not None:
        with contextlib.suppress(PlatformError):  # without the model, the matcher recognises only exact examples
            designed.load()
    names = tuple(agent_names)
    written = None if reading is None else reading.normal(text)
    normal = pipeline.normalise(text, (*names, *users)) if written is None else written
    tree, entities = pipeline.read(normal)
    sentences = sentences_of(normal.text)
    parsed = Clause.all_in(tree)
    statements = statements_of(tree, entities, parsed)
    # One run of the encoder serves all matchers.
    bundled_matcher("acts").prepare([*sentences, *clauses(sentences, names)])
    if reading is not None and written is not None:
        question, yesno = reading.question_word, reading.yesno
    else:
        # Until the network is loaded, a question mark that `normal` has added is the best evidence of a question.
        question = question_of(normal.unguessed if network().loaded else normal.text)
        yesno = yesno_of(normal.unguessed)
    closing = closing_of(tree, sentences)
    meant = closing.text if closing is not None and closing.remarks else normal.unguessed
    return Analysis(
        text=text,
        normal=normal,
        tree=tree,
        entities=entities,
        triples=tuple(statement.triple for statement in statements),
        yesno=yesno,
        question=question,
        about_agent=_is_about_agent(tree, names),
        sentences=sentences,
        statements=statements,
        contrasts=contrasts_of(repaired(tree)),
        closing=closing,
        acts=acts(sentences),
        feelings=feelings(sentences, names),
        asks=_by_name(bundled_matcher("asks").match_all(sentences)),
        move=move_of(meant, asks=question is not None or "?" in text),
        questions=tuple(analyse(one, pipeline, names, users) for one in questions_in(tree)),
        intents=_by_name(designed.match_all(sentences or (text,)), ":") if designed else {},
    )


def _by_name(matches: Iterable[Match | None], part: str = "") -> dict[str, Match]:
    """Return the best match of each class whose name contains `part`."""
    found = [match for match in matches if match is not None and part in match.name]
    return {match.name: match for match in sorted(found, key=lambda match: match.score)}


def _is_about_agent(tree: Tree, names: Iterable[str]) -> bool:
    if any(word.low in _SECOND_PERSON for word in tree.words):
        return True
    return any(
        re.search(rf"(?<!\w){re.escape(name.strip())}(?!\w)", tree.text, re.IGNORECASE)
        for name in names
        if name.strip()
    )
