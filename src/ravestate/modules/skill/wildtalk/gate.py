"""Check generated sentences before the agent says them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from functools import cache
from importlib.resources import files

from ravestate.errors import PlatformError
from ravestate.language import Encoder, Matcher, Reranker, plain, read_examples, sentences
from ravestate.language.nonsense import is_nonsense
from ravestate.modules.meta.nlp.pipeline import Pipeline
from ravestate.modules.meta.nlp.statement import Statement
from ravestate.modules.meta.nlp.statements import statements_of

from .listening.material import material
from .listening.tongue import tongue_of

FAR, NEAR, UNRELATED = 0.45, 0.56, -10.9
"""The gate refuses answers whose similarity to the conversation is below FAR. From FAR to NEAR, it refuses answers that
the cross-encoder (a network that compares two texts) scores below UNRELATED.

The three limits are calibrated on small talk: all 25 fitting answers pass, and 9 of 10 misplaced answers are refused.
"""
SURE = 0.85
"""The minimum confidence at which a sentence counts as out of character."""
TELLING = 3
"""Sentences with fewer words than this are too short to compare."""

_FORMS = {
    "a link": re.compile(r"https?:|\bwww\.|\w\.(?:com|org|net|io|edu|gov)\b|\S@\S"),
    "the mark of a speaker": re.compile(
        r"^\W*(?:user|human|assistant|system|bot|ai|robot|question|answer|[qa])\s*:", re.IGNORECASE
    ),
    "markup or code": re.compile(r"[<>{}\[\]|\\`*#_~^]|\w\(\)|=|;\s*$|^\s*(?:[-•]|\d+[.)])\s"),
    "junk": re.compile(r"\ufffd|\S{31,}|(\w)\1{3}|([^\w\s])\2{3}"),
}


class Gate:
    """Checks one generated answer, sentence by sentence.

    Example:
        >>> gate = Gate("Rosie", "Tell me something.")
        >>> gate.refuse("Look at https://example.org!"), gate.refuse("I like the rain.")
        ('a link', '')
    """

    def __init__(
        self,
        name: str,
        heard: str,
        *,
        said: Collection[str] = (),
        before: Sequence[str] = (),
        known: Mapping[str, Sequence[str]] | None = None,
        pipeline: Pipeline | None = None,
    ) -> None:
        """Prepare the check.

        Args:
            name: The agent's name.
            heard: The utterance to be answered.
            said: The agent's last answers, which it must not repeat.
            before: The last utterances of the user and the agent. An answer may refer to them as well.
            known: Facts about the user, by topic.
            pipeline: The parser that finds claims about the user. Without a parser, claims are not checked.
        """
        self._name = name
        self._heard = heard
        self._said = {plain(sentence) for text in said for sentence in sentences(text)}
        self._before = before
        self._known = known or {}
        self._pipeline = pipeline
        self._passed: list[str] = []
        self._admitted = ""
        self.reason = ""
        """The reason for the refusal; empty until a sentence is refused."""

    def admit(self, text: str, *, last: bool) -> tuple[str, bool]:
        """Return the sentences of a growing answer that the agent may say, and whether the rest is refused.

        Args:
            text: The answer so far; it begins with the text of the previous call.
            last: Whether the answer is complete. If not, its last sentence may still grow.
        """
        whole = sentences(text[len(self._admitted) :])
        for sentence in whole if last else whole[:-1]:
            if self.reason:
                break
            self.reason = self.refuse(sentence)
            if not self.reason:
                self._admitted = text[: text.index(sentence, len(self._admitted)) + len(sentence)]
        if last and not self.reason and whole:
            self._admitted = text  # also the characters after the last sentence, such as a closing quotation mark
        return self._admitted, bool(self.reason)

    def refuse(self, sentence: str) -> str:
        """Return the reason to refuse a sentence. If there is none, note the sentence as said, and return ""."""
        reason = self._form(sentence) or self._repetition(sentence) or self._claims(sentence) or self._meaning(sentence)
        if not reason:
            self._passed.append(plain(sentence))
        return reason

    # ---------------------------------------------------------------------------------- the checks

    def _form(self, sentence: str) -> str:
        found = next((reason for reason, pattern in _FORMS.items() if pattern.search(sentence)), "")
        junk = "junk" if is_nonsense(sentence) else ""
        return found or junk or ("another language" if tongue_of(sentence, material().tongues) else "")

    def _repetition(self, sentence: str) -> str:
        text = plain(sentence)
        words = text.split()
        if len(words) >= TELLING and (text in self._said or text in self._passed or text == plain(self._heard)):
            return "a repetition"
        runs = Counter(tuple(words[place : place + 3]) for place in range(len(words) - 2))
        if any(count > 1 for count in runs.values()) or any(
            a == b == c for a, b, c in zip(words, words[1:], words[2:], strict=False)
        ):
            return "a repetition within itself"
        return ""

    def _claims(self, sentence: str) -> str:
        if self._pipeline is None or not self._pipeline.loaded:
            return ""
        for statement in statements_of(*self._pipeline.read(sentence)):
            if statement.question or statement.conditional or statement.negated:
                continue
            if self._misnames(statement):
                return "a wrong name"
            if self._contradicts(statement):
                return "a claim that memory contradicts"
        return ""

    def _misnames(self, statement: Statement) -> bool:
        """Return whether the agent gives itself a wrong name."""
        subject, names = statement.subject, statement.object.names
        own = subject.person == "I" or (subject.head == "name" and subject.of("I"))
        if not own or statement.verb not in ("be", "call") or not names or statement.object.head:
            return False
        return not any(name.lower() in self._name.lower() for name in names)

    def _contradicts(self, statement: Statement) -> bool:
        """Return whether a statement about the user contradicts a known fact."""
        subject, told = statement.subject, statement.object
        value = plain(told.text)
        if statement.verb == "live" and subject.person == "you":
            return self._differs("home", value)
        if statement.verb == "be" and subject.person == "you":
            age = "" if told.amount is None else f"{told.amount:g}"
            return self._differs("age", age) or (bool(told.names) and not told.head and self._differs("name", value))
        if subject.of("you") and statement.verb == "be" and told.names:
            return self._differs(subject.head, value)
        names = [phrase for phrase in (subject, told, *statement.phrases) if phrase.of("you") and phrase.names]
        return any(self._differs(phrase.head, plain(phrase.name)) for phrase in names)

    def _differs(self, topic: str, value: str) -> bool:
        known = [plain(one) for one in self._known.get(topic, ())]
        return bool(known and value) and not any(one in value or value in one for one in known)

    def _meaning(self, sentence: str) -> str:
        try:
            matcher = persona_matcher()
            matcher.load()
            match = matcher.match(sentence)
            if match is not None and match.score >= SURE:
                return f"out of character ({match.name})"
            if not self._passed and not self._fits(sentence):
                return "no answer to what was said"
        except PlatformError:
            return ""  # without the models, check only the form of the sentence
        return ""

    def _fits(self, sentence: str) -> bool:
        """Return whether the first sentence of an answer relates to the conversation."""
        if len(plain(self._heard).split()) < TELLING or len(plain(sentence).split()) < TELLING:
            return True
        vectors = Encoder().encode([plain(sentence), plain(self._heard), *map(plain, self._before)])
        likeness = float((vectors[1:] @ vectors[0]).max())
        if likeness >= NEAR:
            return True
        return likeness >= FAR and float(Reranker().score(self._heard, [sentence])[0]) >= UNRELATED


@cache
def persona_matcher() -> Matcher:
    """Return the matcher of sentences that are out of character."""
    examples = read_examples(files(__package__ or "") / "gate.yaml")
    return Matcher(examples.classes, examples.none)
