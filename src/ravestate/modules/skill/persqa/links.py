"""Links from statements to topics, and the pursuits in a statement: hobbies and trades."""

from __future__ import annotations

import re
from dataclasses import replace

from ravestate.modules import nlp
from ravestate.modules.meta.nlp.phrase import Phrase, gerund_phrase

from .kinds import likeness
from .link import Link
from .topics import WORDS
from .utterance import Utterance
from .values import gerund

_LEISURE = re.compile(r"\b(?:free|spare|leisure) time\b|\bfor fun\b|\bas a hobby\b", re.IGNORECASE)
NOW = frozenset(["tonight", "today", "tomorrow", "now", "this"])
"""Words for a time that makes a statement momentary."""


def predicate_of(said: nlp.Statement) -> str:
    """Return the predicate without *not*, and without verbs of beginning or continuing: *work* of *start to work*."""
    words = said.triple.predicate.removeprefix("not ").split()
    while len(words) > 1 and (words[0] in WORDS["beginning"] or words[:2] == ["end", "up"]):
        first = 2 if words[0] == "end" or words[1] == "to" else 1
        if len(words) == first:
            break  # "where did I end up"
        del words[:first]
        words[0] = said.verb if len(words) == 1 or words[0].endswith("ing") else words[0]
    return " ".join(words)


def pursuit_in(reader: Utterance, said: nlp.Statement) -> Link | None:
    """Return the hobby in *I like to read books*, *I play chess*, *I go swimming*, *I paint in my free time*."""
    if said.verb == "spend" and said.object.head in WORDS["leisure"] and (verb := reader.verb(said)):
        gerunds = [word for word in reader.tree.children(verb, "xcomp", "advcl", "ccomp") if word.tag == "VBG"]
        written = [reader.tree.phrase(gerund_phrase(reader.tree, word)) for word in gerunds]
        return Link("hobby", said.object, value=written[0]) if written else None
    verbs, object = said.triple.predicate.removeprefix("not ").split(), said.object
    verb = reader.verb(said)
    if said.subject.text.lower() not in ("i", "we") or not isinstance(said.triple.object, str):
        return None
    if verb is None and (object.preposition or not object.text):
        return None
    if verb is None:  # the parser has taken the verb for a noun: "I crochet"
        written = gerund(f"to {object.text}", reader.seen)
        return Link("hobby", object, value=written) if said.holds and likeness(written, "activity") > 0.4 else None
    often = object.preposition in ("in", "on", "at", "after", "every") and object.head in WORDS["leisure"]
    object = Phrase("") if often else replace(object, text=re.sub(r"^lots? of ", "", object.text))
    often = often or bool(reader.words & {"usually", "often", "mostly", "regularly", "weekends", "sometimes"})
    phrases = [phrase for phrase in said.phrases if phrase.head not in WORDS["leisure"]]
    chained, direct = len(verbs) > 1, object.text and not object.preposition
    free = object.head in ("time", "weekend", "fun")
    written = reader.span_of(verb.low, Phrase("") if free else object)
    if verb.tag in ("VBN", "VBZ"):
        written = re.sub(r"^\w+", verb.lemma, written)
    if verbs[0] in WORDS["likes"]:
        wanted = chained
    elif verbs[0] in ("start", "begin") or verbs == ["take", "up"]:
        written = gerund(verbs[-1] if chained and verbs[0] != "take" else object.text, reader.seen)
        wanted = likeness(written, "activity") > 0.3 - 0.3 * written.endswith("ing")
    elif verbs == ["do"] and direct and said.holds and likeness(object.text, "activity") > 0.2:
        wanted, written = True, object.text  # "I do judo"
    elif verbs[0] in WORDS["pastimes"]:
        wanted = verb.tag != "VBD" and (chained or object.text.endswith("ing") if verbs[0] == "go" else direct)
    elif verb.tag == "VBG" and verb.dep == "conj":  # "I love climbing and baking bread"
        wanted = any(other.verb in WORDS["likes"] and other.holds for other in reader.seen.statements)
    elif verbs[0] != "be" and _LEISURE.search(reader.tree.text):
        wanted = direct or free
    else:
        habit = verbs[0] != "be" and said.holds and verb.tag in ("VBP", "VB") and not chained and not free
        habit = habit and "to" not in {word.low for word in reader.tree.children(verb, "aux")}  # "to make tea"
        habit = (
            habit
            and not (NOW | WORDS["moments"]) & set(said.when.lower().split())
            and (direct or not (object.text or phrases))
        )
        fleeting = said.verb in WORDS["states"] | WORDS["passing"]
        asked = reader.asked == "hobby" and "i" in reader.words and said.holds and direct and not fleeting
        wanted = asked or (
            habit and likeness(gerund(written, reader.seen), "activity") > (0.2 if direct or often else 0.4)
        )
    return Link("hobby", object if object.text else said.subject, value=written) if wanted and written else None


def trade_in(reader: Utterance, said: nlp.Statement) -> Link | None:
    """Return the occupation in *I drive trams for a living*; if the agent asked for it, also in *I drive trams*."""
    asked = reader.asked == "occupation" and said.verb not in WORDS["states"] | WORDS["passing"] | WORDS["pastimes"]
    living = any(phrase.preposition == "for" and phrase.head == "living" for phrase in said.phrases)
    direct = bool(said.object.text) and not said.object.preposition
    if not said.holds or not direct or said.object.owner or not (asked or living) or " " in said.triple.predicate:
        return None
    return Link("occupation", said.object, value=gerund(reader.span(said), reader.seen))
