"""Free statements: statements about the user and others that no topic covers."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from datetime import datetime

from ravestate.errors import PlatformError
from ravestate.language.encoder import Encoder
from ravestate.language.lexicon import loaded_lexicon
from ravestate.language.normal import plain
from ravestate.modules import nlp
from ravestate.modules.meta.nlp.tree import SUBJECTS, Tree, Word

from .advice import asks_for_advice
from .answers import spelled_out
from .changes import is_brief
from .kinds import likeness
from .reading import Reader, is_former
from .topics import NAME, NOUNS, NOW, TOPICS, WORDS
from .wording import Facts

_SAID_BACK = {
    "i": "you", "me": "you", "my": "your", "mine": "yours", "myself": "yourself", "am": "are", "'m": "are",
    "we": "you", "our": "your", "us": "you", "ours": "yours",
}  # fmt: skip
LEAST = 0.73
"""The similarity that a question and the statement that answers it must exceed."""
_FIT = {
    nlp.QuestionWord.PERSON: re.compile(r"(?<!^)\b[A-Z]\w|\byour \w"),
    nlp.QuestionWord.TIME: re.compile(
        r"\d|\b(?:on|in|at|since) \w|day\b|\b(?:tomorrow|tonight|morning|evening|noon|week|month|year)\b", re.IGNORECASE
    ),
    nlp.QuestionWord.PLACE: re.compile(r"\b(?:in|at|to|from|near|on) \w"),
}
"""The kind of a question → a pattern for the statements that can answer such a question."""
_FIT[nlp.QuestionWord.AMOUNT] = re.compile(
    r"\d|\b(?:half|(?:one|two|three|four|five|six|seven|eight|nine)(?:teen|ty)?|ten|eleven|twelve|(?:thir|fif|eigh)teen|"
    r"(?:twen|thir|for|fif|eigh)ty|hundred|thousand|many|few|no)\b",
    re.IGNORECASE,
)
_CONTENT = frozenset(["NOUN", "PROPN", "ADJ", "VERB", "NUM"])
_MINE = frozenset(["i", "my", "me", "we", "our", "remember", "again", "he", "she", "him", "her", "his"])
_REMINDING = frozenset(["tell", "say", "mention", "know", "learn", "remember"])
_EMPTY = re.compile(r"\b(?:am|is|are|was|were)\W*$", re.IGNORECASE)
"""The end of a statement that lacks its last word: in *my hobby is rowing*, the parser takes *rowing* for the verb."""
_THEIRS = re.compile(r"^(?:his|her|their)\b", re.IGNORECASE)
_LABEL = re.compile(r"^be (?:called|named)$")
_DEICTIC = re.compile(r"(?:(?:this|that|these|those|it|here|there)\b|(?:him|her|them)$)", re.IGNORECASE)
_ASIDE = frozenset(["punct", "cc", "conj", "advcl", "parataxis", "intj", "mark", "meta", "dep"])


@dataclass(frozen=True, slots=True)
class Told:
    """Something that the user told: *Jonas plays the violin*."""

    subject: str
    """The subject, as the user names it: ``Jonas``, ``my mother``, ``I``."""
    verb: str
    """The predicate as a lemma: ``play``."""
    object: str
    """The object without its article: ``violin``; empty if there is none."""
    text: str
    """The statement as the agent would say it to the user: *you painted a dragon*."""
    by: str = ""
    """The name of the person who told it; empty while their name is not known."""
    at: datetime | None = None
    who: str = field(default="", compare=False)
    """The person whom a later *he* or *she* means."""

    @property
    def key(self) -> str:
        """The statement's key in `persqa.told`."""
        return f"{self.subject} / {self.verb} / {self.object}".lower()


def told_in(reader: Reader, before: Sequence[Told] = ()) -> tuple[list[Told], list[Told]]:
    """Return the free statements of an utterance, and all statements that the user makes about themselves or others.

    In both lists, a name replaces the subject where possible. *He* becomes the name of the person named last, and *my
    sister* becomes the name of the known sister.
    """
    free: list[Told] = []
    heard: list[Told] = []
    last = next((one.who for one in reversed(before) if one.who), "")
    named = {topic: values[0] for topic, values in reader.names().items()}
    for said in reader.seen.statements:
        he = said.subject.text.lower() in ("he", "she", "they") and not _LABEL.search(said.triple.predicate)
        subject = last if he else _about(reader, said)
        owner = f"{last}'s" if last and _THEIRS.match(said.subject.text) else ""
        words = _THEIRS.sub(owner, said.subject.text) if owner else said.subject.text
        if said.subject.names or reader.noun(said.subject) or WORDS["kin"] & {said.subject.head}:
            named_one = (
                said.subject.owner if said.subject.head == "name" else None
            )  # "my wife's name is..., and she..."
            about = named_one or said.subject
            last = about.name or named.get(reader.noun(said.subject)) or about.text
            last = last.removeprefix("ex ")
        elif owner and reader.relative(said.subject.head):
            last = words
        elif said.subject.person == "I" and said.object.names and not said.object.preposition:
            last = said.object.names[0]
        elif said.subject.person == "I" and reader.relative(said.object.head) in named:
            last = named[reader.relative(said.object.head)]
        if said.question or said.request or said.subject.person == "you":
            continue
        top = reader.verb(said)
        if top is not None and top.dep == "relcl" and not subject and said.subject.text.islower():
            continue  # the main clause already says it: "there is a girl who waves at me"
        if top is not None and top.dep == "relcl" and said.subject.names:
            subject = said.subject.name  # "a sister called Eva who lives in Ghent"
        text = _retold(reader, said)
        if _EMPTY.search(text):
            continue
        if he and last:
            text = re.sub(r"^(?:s?he|they)\b", _returned(last), text, flags=re.IGNORECASE)
        text = _THEIRS.sub(_returned(owner), text) if owner else text
        thing = said.object.text  # "a parrot called Coco"
        if said.object.head and said.object.names and not reader.noun(said.object):
            thing = re.sub(rf"[\s,]+{re.escape(said.object.name)}$", "", thing)
        topic = reader.noun(said.subject)
        relatives = (reader.known.get(topic) or tuple(filter(None, [named.get(topic)]))) if subject else ()
        if len(relatives) == 1 and not said.subject.names:
            subject = last = relatives[0]
        same = (
            one for one in reader.seen.statements if one.subject.person == "I" and one.triple[1:] == said.triple[1:]
        )
        subject = "" if said.subject.person != "I" and any(same) else subject  # "my wife and I live in Rome"
        one = Told(subject or words, said.triple.predicate, thing, text, who=last)
        heard.append(one)
        if subject and (not he or last in [one.who for one in heard[:-1]]) and _is_worth_keeping(reader, said):
            free.append(one)
    return free, heard


def retold_with(one: Told, right: str) -> Told:
    """Return a statement with another object: *your sister Rosa lives in Ghent*, if the user had said Antwerp."""
    right = right[:1].upper() + right[1:] if one.object[:1].isupper() else right
    text = re.sub(rf"(?<!\w){re.escape(one.object)}(?!\w)", lambda _: right, one.text, count=1)
    return replace(one, object=right, text=text)


def is_about(one: Told, phrase: str) -> bool:
    """Return whether a statement begins with the user's words for somebody: *your boss Ann sings*, for *my boss*."""
    return re.match(rf"{re.escape(_returned(phrase))}(?![\w-])", one.text, re.IGNORECASE) is not None


def recalled(reader: Reader, told: Iterable[Told], known: Facts) -> list[Told]:
    """Return the statements that answer the user's question: *what does Jonas play*, *who is getting married?*."""
    told, kind = _latest(told), reader.seen.question
    for said in reader.seen.statements:
        about = next((phrase for phrase in reversed(said.phrases) if phrase.preposition == "about"), None)
        informing = said.subject.person == "you" and said.verb == "tell" and not (about and about.names)
        if said.question and said.verb in _REMINDING and about and about.person == "other" and not informing:
            words = [word for word in re.findall(r"\w+", about.text) if word.lower() not in _MINE]
            return [one for one in told if _covers(one, words, known)][-3:]
    asked = next((said for said in reader.seen.statements if said.question and said.subject.person != "you"), None)
    mine = bool(reader.words & _MINE)
    if asked is not None and (asked.subject.of("you") or (_is_general(reader, asked.subject.text) and not mine)):
        return []
    if asks_for_advice(reader.tree.text) and "remember" not in reader.words:
        return []
    if asked is None or kind is None:
        return []
    light = WORDS["light"] | WORDS["knowing"]
    words = [word.low if word.pos == "PROPN" else word.lemma for word in reader.tree.words if word.pos in _CONTENT]
    words = [word for word in words if word not in light]
    if kind == nlp.QuestionWord.YES_NO and not reader.words & {"remember", "know"}:
        fit = [one for one in told if _is_about(one, asked, known) and _decides(one, asked, words, known)]
        return fit[-1:]
    being_called = asked.triple.predicate in ("be called", "be named") or asked.subject.head == "name"
    if being_called or (kind == nlp.QuestionWord.PERSON and asked.verb == "be"):
        words = [word for word in words if word != "name"]
        named = _naming([one for one in told if words and _covers(one, words, known)])
        if named or being_called:
            return named
    subjects = [] if asked.subject.person == "I" else [asked.subject.name or asked.subject.head]
    names = {part.lower() for one in told for part in f"{one.subject} {one.who}".split()} - {"i"}
    sure = mine or not names.isdisjoint(map(str.lower, words))
    being = asked.verb == "be" and kind == nlp.QuestionWord.OBJECT
    person = kind == nlp.QuestionWord.PERSON
    fit = [one for one in told if kind not in _FIT or (person and one.who) or _FIT[kind].search(one.text)]
    exact = [
        one
        for one in fit
        if len(words) > reader.seen.advised  # "what do I wear?" asks for advice
        and _covers(one, words, known)
        and (asked.subject.person != "I" or one.subject == "I" or one.subject.startswith("my "))
        and (not being or (sure and one.verb.endswith("be")))
        and (
            sure
            or (one.who and person and asked.verb != "be")
            or (_does(one, asked) and len(words) > 1 and _covers(one, filter(None, subjects), known))
        )
    ]
    if exact and (sure or reader.words & _REMINDING or kind != nlp.QuestionWord.OBJECT):
        return [max(exact, key=lambda one: (_is_about(one, asked, known), _does(one, asked), told.index(one)))]
    if reader.seen.advised:
        return []
    parts = [part for part in (reader.tree.text, *reader.tree.text.split(",")) if len(part.split()) > 3]
    if not mine or not fit or not parts:
        return []
    try:
        rows = Encoder().encode([plain(_returned(text)) for text in (*parts, *(one.text for one in fit))])
    except PlatformError:  # without the model, only statements with the same words are found
        return []
    likeness = (rows[len(parts) :] @ rows[: len(parts)].T).max(axis=1)
    best = max(range(len(likeness)), key=likeness.__getitem__)
    return [fit[best]] if likeness[best] > LEAST else []


def _latest(told: Iterable[Told]) -> list[Told]:
    """Return the statements in order, without statements that have no text. If several statements have the same text, keep the last one."""
    found: dict[str, Told] = {}
    for one in filter(lambda one: one.text, told):
        found.pop(one.text, None)
        found[one.text] = one
    return list(found.values())


def _is_about(one: Told, asked: nlp.Statement, known: Facts) -> bool:
    """Return whether a statement has the subject that the user asks about: *Rosa* counts as *my sister* if she is the user's sister."""
    subject = asked.subject
    if subject.person == "I":
        return one.subject.lower() == "i"
    names = (subject.name or subject.text, *known.get(NOUNS.get(subject.head, ""), ()))
    return any(name.lower() in (one.subject.lower(), one.who.lower()) for name in names)


def _does(one: Told, asked: nlp.Statement) -> bool:
    """Return whether a statement has the verb that the user asks about."""
    return one.verb in _alike(asked.triple.predicate)


def _decides(one: Told, asked: nlp.Statement, words: Sequence[str], known: Facts) -> bool:
    """Return whether a statement answers a question for yes or no. *I hate fish* answers *do I like fish?*."""
    judged = WORDS["likes"] | WORDS["dislikes"]
    if asked.verb in judged and one.verb.removeprefix("not ") in judged:
        words = [word for word in words if word not in judged]
    return bool(words) and _covers(one, words, known)


def _naming(told: Sequence[Told]) -> list[Told]:
    """Return the statements that name the people they are about, the last one for each subject.

    Statements that only give a name take precedence: *my neighbour is Karl* over *my neighbour Karl plays the drums*.
    """
    only = [one for one in told if one.verb in ("be", "be called", "be named") and _has_name(one.object)]
    beside = [one for one in told if _has_name(one.who)]
    return list({one.subject.lower(): one for one in only or beside}.values())


def _has_name(words: str) -> bool:
    """Return whether any of the words is a name, even in lower case."""
    lexicon = loaded_lexicon()
    return any(word[:1].isupper() or (lexicon and lexicon.name(word) != word) for word in words.split())


def _covers(one: Told, words: Iterable[str], known: Facts) -> bool:
    """Return whether a statement has all these words. *Rosa* counts as *sister* if the user's sister is Rosa."""
    had = _stems(f"{one.text} {one.verb} {one.subject}")
    return all(_stems(" ".join((word, *_alike(word), *known.get(NOUNS.get(word, ""), ())))) & had for word in words)


def _alike(verb: str) -> frozenset[str]:
    """Return the verbs that answer a question with this verb: *Ines moved to Ghent* answers *where does Ines live?*."""
    return WORDS["dwelling"] if verb in WORDS["dwelling"] else frozenset([verb])


def _stems(text: str) -> set[str]:
    return {re.sub(r"(?<=..)(?:ies|ing|ed|es|s|e|y)$", "", word) for word in re.findall(r"\w+", text.lower())}


def _is_worth_keeping(reader: Reader, said: nlp.Statement) -> bool:
    called = said.triple.predicate in ("be called", "be named")
    if _DEICTIC.match(said.object.text) or is_former(said.subject.text) or (said.verb == "be" and not said.object.text):
        return False
    verb = reader.verb(said)
    timed = said.verb != "be" and said.object.text and said.object.text in said.when  # "since 2010"
    if timed or reader.is_denied(said) or (verb is not None and verb.dep == "pcomp"):  # "..., to be honest"
        return False
    if _is_momentary(reader, said):
        return False
    there = (
        said.subject.person == "other" and said.verb in ("come", "go") and said.object.names
    )  # "Inga comes from Peru"
    kept = called or there or _gained(reader, said) or _noted(reader, said)
    if (said.verb in WORDS["passing"] and not kept) or " to " in said.triple.predicate or said.object.person != "other":
        return False
    return isinstance(said.triple.object, str) and (said.holds or _happened(reader, said))


def _is_momentary(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether the user is doing something at the moment: *I'm visiting my aunt*, but not *I'm learning Greek*."""
    verb = reader.verb(said)
    if said.subject.person != "I" or verb is None or said.verb == "be":
        return False
    aux = any(word.lemma == "be" or word.low == "'m" for word in reader.tree.children(verb, "aux"))
    if verb.dep == "advcl" and said.verb not in WORDS["states"] and {"since", "when", "until", "while"} & reader.words:
        return True
    now = is_brief(said) or (NOW & set(said.when.lower().split()) and verb.tag != "VBD")
    return bool(now or (verb.tag == "VBG" and aux and likeness(reader.span(said), "activity") < 0.1))


def _gained(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether a statement says that its subject owns a thing: *a red bicycle*, but not *a headache*."""
    verb = reader.verb(said)
    gets = said.verb == "get" and verb is not None and verb.low == "got"
    thing = reader.written(said.object)
    kept = max(likeness(thing, "possession"), likeness(thing, "trait")) > 0.1
    animal = gets and TOPICS[NOUNS.get(said.object.head, NAME)].type == "Animal"
    return animal or said.verb == "own" or ((gets or said.verb == "have") and kept)


def _noted(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether a statement reports a past event, and its object has a name: *I went to Prague*, but not *I went to the shop*."""
    return bool(said.object.names) and said.verb in WORDS["events"] and _happened(reader, said)


def _happened(reader: Reader, said: nlp.Statement) -> bool:
    """Return whether a statement reports a past event: *I painted a dragon*, but not *I lived in Rome*."""
    verb = reader.verb(said)
    flags = said.negated or said.hearsay or said.conditional or said.plan or said.question or said.request
    event = said.verb == "have" and said.object.head in WORDS["happenings"]  # "she had a baby"
    if flags or verb is None or (said.verb in WORDS["states"] | WORDS["pastimes"] and not event):
        return False
    return verb.tag == "VBD" or (
        verb.tag == "VBN" and any(aux.lemma == "have" for aux in reader.tree.children(verb, "aux"))
    )


def _about(reader: Reader, said: nlp.Statement) -> str:
    """Return the subject of a statement about the user or somebody they know; empty for other statements."""
    subject, object = said.subject, said.object
    if subject.person == "I" and subject.text.lower() not in ("mine", "ours"):
        mine = {"my", "our"} & set(object.text.lower().split()) and not _happened(reader, said)
        mine = mine or said.verb in ("name", "call")
        verb = reader.verb(said)
        deictic = _DEICTIC.match(reader.written(object)) or (verb is not None and verb.dep == "relcl")
        spoken = not reader.words.isdisjoint({"i", "we", "i'm"}) or (verb is not None and verb.tag == "VBD")
        # "I wait for the bus", but not "I drive for Transkorn"
        there = object.preposition and not object.text[:1].isupper() and likeness(object.text, "trait") < 0.1
        fits = object.text and not there and not mine and not deictic
        if said.verb == "be":
            fits = fits and likeness(object.text, "trait") > 0.1
        elif said.verb in ("have", "get", "own"):
            fits = fits and _gained(reader, said)
        fits = fits and not (object.names and reader.relative(object.head))  # "a cat called Luna"
        return "I" if spoken and fits and not reader.covers(said) else ""
    words = subject.text.split() if subject.of("I") else []
    if reader.relative(subject.head) and words:
        naming = said.verb == "be" and ((object.names and not object.preposition) or not object.text)
        return "" if naming or said.triple.predicate in ("be called", "be named") else subject.name or subject.text
    if WORDS["kin"] & {subject.head, *map(str.lower, words[1:2])} and words:
        return subject.name or subject.text
    number = {"CARDINAL", "QUANTITY"} & {entity.label for entity in reader.seen.entities if object.text in entity.text}
    dated = said.verb == "be" and (said.when or (object.text and number))  # "my birthday is in May"
    thing = said.verb == "be" and object.text and likeness(f"a {subject.head}", "possession") > 0.1  # "my car is new"
    if words and reader.covers(said):
        return ""
    if words and (dated or thing or (said.verb == "be" and object.names)) and not reader.noun(subject):
        return subject.text
    person = subject.names and not subject.head and likeness(subject.text, NAME) > 0
    return subject.text if person and not (reader.noun(object) or reader.noun(subject)) else ""


def _retold(reader: Reader, said: nlp.Statement) -> str:
    """Return the clause of a statement as the agent says it to the user: *your sister lives in Rome*."""
    tree, top = reader.tree, _verb(reader, said)
    if top is None:
        return ""
    while top.dep == "xcomp":
        top = tree.head(top)
    relative = top.dep == "relcl"  # "the girl who lives next door"
    parts = [child for child in tree.children(top) if child.dep not in _ASIDE and not _is_before(tree, child, top)]
    parts = [
        child for child in parts if not (relative and child.dep.startswith("nsubj") and child.tag in ("WP", "WDT"))
    ]
    words = [top, *(word for child in parts for word in tree.subtree(child))]
    text = spelled_out(tree.phrase(words))
    last = said.subject.text.lower().split()[-1:]
    if last and not {*last} & {*re.findall(r"\w+", text.lower()), *text.lower().split()}:
        text = f"{said.subject.text} {text}"
    return _returned(text)


def _verb(reader: Reader, said: nlp.Statement) -> Word | None:
    """Return the verb of a statement. If several verbs have its lemma, take the verb with the statement's subject."""
    tree, words = reader.tree, said.subject.text.lower().split()
    for word in tree.words if words else ():
        if word.lemma == said.verb and words[-1] in {part.low for part in tree.children(word, *SUBJECTS)}:
            return word
    return reader.verb(said)


def _is_before(tree: Tree, clause: Word, top: Word) -> bool:
    """Return whether a clause is really an earlier sentence: *her name is Ida*, in *her name is Ida, she sings*."""
    return clause.dep == "ccomp" and clause.index < top.index and bool(tree.children(clause, *SUBJECTS))


def _is_general(reader: Reader, subject: str) -> bool:
    """Return whether a subject stands for a whole kind: *why do babies cry*."""
    low = [word.low for word in reader.tree.words if word.tag == "NNS" and word.dep in SUBJECTS]
    return subject.lower() in low


def _returned(text: str) -> str:
    """Return the user's words as the agent says them: *your* for *my*."""
    text = re.sub(r"\b(i|we) was\b", r"\1 were", text, flags=re.IGNORECASE)
    text = re.sub(
        r"^(?:An?|The|This|That|It|There|He|She|They|His|Her|Its|Their)\b", lambda found: found[0].lower(), text
    )
    return " ".join(_SAID_BACK.get(word.lower(), word) for word in text.split())
