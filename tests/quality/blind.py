"""Measure the blind sets. Their authors did not see code or examples, and no module is tuned on them.

`make quality` prints the shares of right results. It never prints a sentence, because engineers must not see the sets.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from quality import language, measure, modules, skills
from quality.measure import NONE, Result, Triples, measure_labels, measure_triples
from ravestate.language.matcher import bundled_matcher

HERE = Path(__file__).parent / "blind"
REMARKS = ("distress", "insult", "grief", "thanks", "acknowledgement", "contradiction")
"""Labels of ``about_agent`` that do not mean a topic of the agent's life, but an act or a feeling of the user."""
_PRONOUNS = ("she", "he", "they", "her", "him", "them", "it", "that")
_SAD = ("grief", "illness", "sadness", "loneliness", "worry", "failure")


def rows(name: str) -> list[list[str]]:
    """Return the rows of a set, each as the list of its cells."""
    lines = (HERE / f"{name}.tsv").read_text(encoding="utf-8").splitlines()
    return [line.split("\t") for line in lines if line.strip() and not line.startswith("#")]


def labelled(name: str, style: str = "") -> list[tuple[str, str]]:
    """Return the sentences of a set, each with its label. If `style` is given, return only rows of this style."""
    return [(row[0], row[1]) for row in rows(name) if not style or row[2] == style]


def triple_cases(name: str) -> list[tuple[str, Triples]]:
    """Return the sentences of a set with their triples, in lower case."""
    cases = measure.read_yaml(HERE / f"{name}.yaml")
    return [(case["text"], _low(case["triples"])) for case in cases]


def _low(found: Iterable[Sequence[str]]) -> Triples:
    return frozenset((s.lower(), predicate.lower(), o.lower()) for s, predicate, o in found)


def _measured_triples(name: str) -> Result:
    cases = triple_cases(name)
    modules.prepare(text for text, _ in cases)
    result = measure_triples(lambda text: _low(modules.triples(text)), cases)
    return Result(f"triples, {name}", result.cases, result.shares, result.misses)


def about_agent(text: str) -> str:
    """Return the topic that a text asks for, or the user's act to which the agent replies."""
    for matcher in ("acts", "feelings"):
        bundled_matcher(matcher).load()
    topic = skills.agentqa_asks(text)
    if topic != NONE:
        return topic
    remark = skills.agentqa_remarks(text)
    if remark != NONE:
        return remark
    seen = modules.analysed(text)
    for act in ("thanks", "acknowledgement", "contradiction"):
        if act in seen.acts:
            return act
    return "grief" if any(feeling in seen.feelings for feeling in _SAD) else NONE


def _labels(name: str, see: Callable[[str], str], cases: list[tuple[str, str]]) -> Result:
    modules.prepare(text for text, _ in cases)
    return measure_labels(name, see, cases)


def facts(kinds: Sequence[str] = (), name: str = "facts") -> list[tuple[str, str]]:
    """Return the sentences of a set with the facts to store. If `kinds` are given, return only rows of these kinds."""
    return [(row[0], row[1]) for row in rows(name) if not kinds or row[2] in kinds]


TRICKY = ("denied", "past", "hearsay", "conditional", "nothing", "question")
"""Kinds of sentences from which a module easily stores a wrong fact."""
SINGLE = (
    "name", "home", "origin", "birthplace", "childhood", "age", "occupation", "employer", "subject", "university",
)  # fmt: skip
"""Topics with only one value: a new value replaces the old value. ``favourite ...`` topics do the same."""
_KNOWN = re.compile(r"\[knows ([^]=]+)=([^]]*)\] ")


def stored(text: str) -> frozenset[str]:
    """Return the facts that are stored for a text, in lower case. The text can begin with its situation in brackets."""
    meaning = skills.meaning_of(text)
    if meaning.kind not in ("told", "corrected"):
        return frozenset()
    told = [skills.fact_label(fact) for fact in meaning.facts]
    told += [
        f"{'user' if one.subject.lower() == 'i' else one.subject} / {one.verb} / {one.object}" for one in meaning.free
    ]
    if known := _KNOWN.match(text):  # a denial without a value removes the known value of its topic
        told = [f"{fact}={known[2]}" if fact == f"not {known[1]}" else fact for fact in told]
    return _facts(";".join(told))


def _facts(label: str) -> frozenset[str]:
    found = (" ".join(fact.split()).lower() for fact in label.split(";"))
    return frozenset(fact for fact in found if fact and fact != NONE)


def _wanted(label: str) -> tuple[frozenset[str], frozenset[str]]:
    """Return the facts that must be stored, and the facts that may be stored.

    A fact that may be stored has a ``+``, or denies an old value that a new value replaces anyway.
    """
    named = _facts(label)
    told = {fact.partition("=")[0] for fact in named}
    may = {fact for fact in named if fact.startswith("+") or _replaced(fact, told)}
    return named - may, frozenset(fact.removeprefix("+") for fact in may)


def _replaced(fact: str, told: set[str]) -> bool:
    topic = fact.removeprefix("not ").partition("=")[0]
    return fact.startswith("not ") and topic in told and (topic in SINGLE or topic.startswith("favourite "))


def fits(label: str, seen: frozenset[str]) -> bool:
    """Return whether `seen` has all facts that must be stored, and no fact that must not be stored."""
    must, _ = _wanted(label)
    return _harmless(label, seen) and all(any(_fits(one, other) for other in seen) for one in must)


def _harmless(label: str, seen: frozenset[str]) -> bool:
    """Return whether `seen` has no fact that must not be stored."""
    must, may = _wanted(label)
    return all(any(_fits(one, other) for one in must | may) for other in seen)


def _fits(expected: str, seen: str) -> bool:
    """Return whether a fact is the expected fact.

    ``a~b`` allows two wordings of a value, ``a|b`` are two values, and ``fact or fact`` are two ways to store a fact.
    """
    return any(_says(way, seen) for way in expected.split(" or "))


def _says(expected: str, seen: str) -> bool:
    topic, equals, values = expected.partition("=")
    other, _, found = seen.partition("=")
    if not equals and "/" in expected:
        parts, others = expected.split("/"), seen.split("/")
        return len(parts) == len(others) and all(
            _plain(o) in _ways(part) for part, o in zip(parts, others, strict=True)
        )
    if topic.strip() != other.strip():
        return False
    if not equals:
        return True
    wanted, given = values.split("|"), {_plain(value) for value in found.split("|")}
    return len(wanted) == len(given) and all(given & _ways(value) for value in wanted)


def _ways(wordings: str) -> set[str]:
    return {_plain(way) for way in wordings.split("~")}


def _plain(words: str) -> str:
    """Return a phrase without its determiner."""
    return re.sub(r"^(?:an?|the|my|our|this) (?=\S)", "", words.strip())


def measured_facts(name: str = "facts", *, show: bool = False) -> list[Result]:
    """Measure how often all facts are stored rightly, and how often tricky sentences cause no wrong fact.

    Args:
        name: The name of the set. It can also be a development set.
        show: Whether the results list the misses. The sentences of a blind set stay hidden.
    """
    cases, tricky = facts((), name), facts(TRICKY, name)
    skills.prepare(text for text, _ in cases)
    seen = {text: stored(text) for text, _ in cases}
    told = [case for case in cases if case not in tricky]
    wrong = [case for case in cases if not fits(case[1], seen[case[0]])]
    harmed = [case for case in tricky if not _harmless(case[1], seen[case[0]])]

    def result(of: str, what: str, among: list[tuple[str, str]], misses: list[tuple[str, str]]) -> Result:
        lines = [f"{text!r}: {'; '.join(sorted(seen[text])) or NONE} instead of {label}" for text, label in misses]
        return Result(of, len(among), {what: 1 - len(misses) / len(among)}, lines if show else [])

    return [
        result("facts", "right", cases, wrong),
        result("facts, told", "right", told, [case for case in told if case in wrong]),
        result("facts, tricky", "nothing wrong", tricky, harmed),
    ]


def measured_feelings() -> list[Result]:
    """Measure the agent's feelings, and the false alarms."""
    cases = labelled("feelings")
    quiet = [(text, label) for text, label in cases if label == NONE]
    result = measure_labels("feelings", language.feelings, cases)
    alarms = sum(language.feelings(text) != NONE for text, _ in quiet)
    return [Result("feelings", len(cases), {**result.shares, "false alarms": alarms / len(cases)})]


def results() -> Iterable[Result]:
    """Measure all blind sets."""
    from quality.followups import measure_followups

    yield _measured_triples("clean")
    yield _measured_triples("typed")
    yield _labels("yes and no", modules.yesno, labelled("answers"))
    poles = [(text, label.split()[0]) for text, label in labelled("answers")]
    yield _labels("... without strength", lambda text: modules.yesno(text).split()[0], poles)
    for style in ("clean", "typed"):
        yield _labels(f"questions, {style}", modules.questions, labelled("kinds", style))
    cases = labelled("about_agent")
    yield _labels("about the agent", about_agent, [case for case in cases if case[1] not in REMARKS])
    yield _labels("out of scope", skills.agentqa_asks, [case for case in cases if case[1] == NONE])
    yield _labels("remarks", about_agent, [case for case in cases if case[1] in REMARKS])
    yield from measured_facts()
    yield from measured_feelings()
    yield measure_followups(HERE / "followups.yaml")
