"""The router: find the topic of a question about the agent, by comparison with example questions."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice

from ravestate import language
from ravestate.language import Encoder, Matcher, plain
from ravestate.language.acts import heard
from ravestate.language.addressing import addressed
from ravestate.language.bundled import ModelMissing

from .life import Life

LEAST = 0.5
"""The least confidence that a question needs to belong to a topic."""
WORDS = 20
"""The maximum number of words in a question about the agent."""
BRIEF = 5
"""The maximum number of words of an indirect question after *you*, if it does not mention the agent: *what time it is* in
*do you know what time it is*."""
SENTENCES = 4
"""The maximum number of sentences that are considered; longer sentences than `WORDS` do not count."""
_QUESTION_WORD = re.compile(r"(?<=\s)(?:who|whom|whose|what|which|where|when|why|how|if|whether)\b", re.IGNORECASE)

_POLITE = re.compile(
    r"^(?:(?:so|and|well|please|hey|now) )?(?:(?:can|could|would|will) you (?:please |kindly )?(?:tell|show) me|"
    r"(?:may|might|can|could) i (?:please )?(?:ask|know|have|hear)|would you mind telling me|do you mind telling me|"
    r"i (?:would|want|wanted) (?:(?:like|love) )?to (?:know|hear|ask)|i wonder)\b"
)
"""The beginning of a polite question, in the plain form: *could you tell me*, *may I ask*."""
_TAG = re.compile(
    r" (?:right|correct|huh|eh|yes|no|(?:are|do|did|can|have|will|would) (?:not )?you|(?:are|do|can|have|will) you not)$"
)
_OPENERS = re.compile(r"^(?:(?:so|and|well|but|hey|ok|okay|oh|wow|then) )+(?=\S+ \S)")
_SHORTENED = {"any": "do you have any", "got": "have you got", "have": "do you have", "ever": "have you ever"}
"""The first word of a question that leaves out its verb or its subject → the words that it stands for."""
_YOU = frozenset(["you", "your", "yours", "yourself"])
_INVERTED = frozenset(["are", "can", "were", "will", "would", "could", "did", "must", "should"])


@dataclass(frozen=True, slots=True)
class Match:
    """A question that belongs to a topic."""

    topic: str
    question: str
    """The question in the plain form: lower case, no punctuation, short forms written out."""
    score: float
    """The confidence, 0 to 1."""
    example: str
    """The example that resembles the question most."""
    margin: float
    """The topic's score in the classifier, minus the score of the next best topic."""
    returned: bool = False
    """Whether the user returned the agent's own question: *fine, and you?*"""


@dataclass(frozen=True, slots=True)
class Miss:
    """The reason why an utterance belongs to no topic."""

    reason: str


class Router:
    """A classifier that finds the topic of a question about the agent. Thread-safe.

    It compares a question with the example questions of the agent's life story, by means of a `Matcher`.
    """

    def __init__(self, life: Life, encoder: Encoder | None = None) -> None:
        """Make a router for the topics of `life`; it loads nothing yet."""
        self.life = life
        examples = {topic.name: topic.questions for topic in life.topics.values() if topic.questions}
        self._matcher = Matcher(examples, life.others, least=LEAST, encoder=encoder)

    def load(self) -> None:
        """Load the model and learn the examples, once. This raises the same errors as `Matcher.load`."""
        self._matcher.load()

    def route(self, utterance: str, names: Collection[str] = (), *, question: bool = False) -> Match | Miss:
        """Return the topic that an utterance asks about. If several sentences have a topic, take the first.

        If the package of sentence models is missing, only questions that match an example word for word are understood.

        Args:
            utterance: The user's words, as typed or in their normal form.
            names: Further names of the agent.
            question: Whether the utterance is known to ask something. If so, indirect questions count as well: *I wonder who
                made you*.

        Raises:
            PlatformError: The sentence model is broken.
        """
        with contextlib.suppress(ModelMissing):
            self.load()
        reason = "nothing is said"
        called = (self.life.name, *names)
        short = (sentence for sentence in heard(utterance, called) if len(sentence.split()) <= WORDS)
        for sentence in islice(short, SENTENCES):
            asks = question and ("?" not in utterance or sentence.rstrip().endswith("?"))
            for text in _readings(addressed(sentence, called), question=asks):
                match self._matcher.ranked_all([text], most=2)[0]:
                    case [best, *_] if best.name and best.score >= LEAST:
                        return Match(best.name, plain(text), best.score, best.example, best.margin)
                    case [best, *others]:
                        reason = _reason(text, best, others)
                    case _:
                        reason = "it is not one of my examples, and the sentence models are not installed"
        return Miss(reason)


@lru_cache(maxsize=8)
def router_of(life: Life) -> Router:
    """Return the router of a life; all contexts share it."""
    return Router(life)


def _readings(sentence: str, *, question: bool) -> Iterator[str]:
    """Yield the forms of a sentence that may be a question: the sentence, and the part after its last comma.

    If `question` is true, yield also the bare question in the sentence. The sentence may be indirect, polite, or without
    a verb: *I wonder how old you are*, *may I ask your name*, *any hobbies*. For *you like tea*, yield only *do you like
    tea*.
    """
    whole = _in_full(_POLITE.sub("tell me", _OPENERS.sub("", plain(sentence))))
    turned = question and whole != plain(sentence)
    if turned and plain(sentence).startswith("you "):  # unchanged, "you like tea" would resemble "what do you like"
        yield whole
        return
    yield sentence
    _, comma, rest = sentence.rpartition(", ")
    if comma and len(rest.split()) > 1:
        yield rest
    if not question:
        return
    if (found := _QUESTION_WORD.search(sentence)) is not None:
        asked, before = plain(sentence[found.start() :]).split(), plain(sentence[: found.start()]).split()
        if len(asked) <= BRIEF or "you" not in before or not _YOU.isdisjoint(asked):
            yield sentence[found.start() :]  # not for "do you have any idea what teenagers like to do these days"
    if turned:
        yield whole


def _in_full(question: str) -> str:
    """Return a question in the plain form with its verb before its subject, and without a tag.

    Example:
        >>> _in_full("any hobbies"), _in_full("you are a robot right"), _in_full("you like tea")
        ('do you have any hobbies', 'are you a robot', 'do you like tea')
    """
    words = _TAG.sub("", question).split()
    if len(words) < 2:
        return question
    first, second, *rest = words
    if first in _SHORTENED:
        return " ".join([_SHORTENED[first], second, *rest])
    if first != "you" or not rest:
        return " ".join(words)
    if second in _INVERTED or (second == "have" and rest[0] == "got"):
        return " ".join([second, "you", *rest])
    return " ".join(["have" if second == "got" else "do", "you", second, *rest])


def _reason(text: str, best: language.Match, others: Sequence[language.Match]) -> str:
    nearest = best if best.name or not others else others[0]
    said = f"the topic nearest to {plain(text)!r} is {nearest.name} ({nearest.score:.2f}, {nearest.example!r})"
    if nearest is best:
        return f"{said}, but it is not near enough"
    return f"{said}, but an example that is not about me is nearer ({best.score:.2f}, {best.example!r})"
