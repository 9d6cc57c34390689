"""Choose an answer that fits what was said: from the feeling, the act and the subject of an utterance.

The listener asks its sources in order, and takes the first phrase that was not said lately and whose roles are known:

1. a game in progress, a request for a joke, a song, a story or a game;
2. another language, nonsense, a number;
3. a short answer to the agent's last question;
4. the moment, the feeling, the act that the utterance resembles most;
5. a question that nobody else has answered;
6. a statement: its verb and its subject, then anything told in this tone;
7. a sign that the agent listens.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QuestionWord
from ravestate.modules.skill.wildtalk.facts import facts_matcher

from .games import Games
from .material import Line, Material, Moment, material, roles_in
from .meaning import (
    FELT,
    FEW,
    FEW_WORDS,
    TURNED,
    about_in,
    called_in,
    choice_in,
    feeling_of,
    is_living,
    is_of_others,
    is_past,
    moment_of,
    words_of,
)
from .roles import Roles, fragment, has_verb, is_request, roles_of
from .state import LASTING, Being, Matter, Overheard, Pending, State
from .tongue import is_nonsense, is_number, tongue_of

SURE = 0.6
"""The confidence in a moment from which it decides."""
FINER = 0.1
"""The advantage of a moment over a feeling or an act, which are broader."""
MEANT = 0.6
"""The confidence in an act from which it decides."""
ASKED = 0.8
"""The confidence in a request for a performance from which it is met."""
SHORT = 4
"""The words of a short answer."""
ENDINGS = ("stop", "quiet")
"""Acts that are only taken for sure ones."""
SILENCE = "silence"
"""The moment of a remark that ends a silence."""
SHOWS = {"joke": "joke", "song": "song", "story": "story", "play": "play"}
"""Performances by the act that requests them."""
_YESNO = frozenset(("contradiction",))
"""The act that a mere *no* resembles."""


@dataclass(frozen=True, slots=True)
class Heard:
    """An utterance of the user."""

    text: str
    seen: Analysis | None = None
    user: str = ""
    """The user's name, if it is known."""
    now: float = 0.0
    """Seconds on the context's clock."""


@dataclass(frozen=True, slots=True)
class Answer:
    """The agent's answer, with the state of the talk after it."""

    text: str
    state: State


@dataclass(frozen=True, slots=True)
class _Source:
    """Groups of phrases in the order in which they are tried, and what saying one of them means."""

    groups: Sequence[Sequence[Line]]
    name: str = ""
    tone: str = ""
    lasts: int = LASTING
    matter: str = ""
    roles: Mapping[str, str] | None = None
    weak: bool = False
    """Whether it fits nearly everything: then something else is said rather than a third question in a row."""
    stance: Mapping[str, str] | None = None
    """The opinion that it expresses, by its subject."""


class Listener:
    """The listening skill. It has no state of its own, so all contexts share it."""

    def __init__(self, phrases: Material | None = None) -> None:
        """`phrases`: by default the built-in ones."""
        self._phrases = phrases or material()
        self._games = Games(self._phrases.shows)

    def load(self) -> None:
        """Learn the examples now; before that only the examples themselves are recognised.

        Raises:
            PlatformError: The sentence model is missing or broken.
        """
        self._phrases.matcher.load()

    def performs(self, heard: Heard, state: State) -> bool:
        """Return whether the utterance asks for a performance, or belongs to one: no language model should answer it."""
        return state.game is not None or self._request(heard) != "" or self._games.knocks(heard.text)

    def continues(self, heard: Heard, state: State) -> bool:
        """Return whether the utterance belongs to a game, or is a short answer to the skill's own question.

        Such words mean something else to other modules: *tomato* is a move in word chain, and no question about vegetables.
        """
        seen = heard.seen
        if seen is None or not heard.text.strip():
            return False
        if state.game is not None:
            leaves = "stop" in seen.acts or "farewell" in seen.acts
            return leaves or self._games.play(heard.text, seen, state, random.Random(0)) is not None
        if state.pending is None or not (state.pending.then or state.pending.start) or seen.question is not None:
            return False
        known = seen.yesno.yes or seen.yesno.no
        short = len(heard.text.split()) < SHORT and not has_verb(seen) and not (seen.acts.keys() - _YESNO)
        return short or bool(known and len(heard.text.split()) <= SHORT and state.pending.closed)

    def answer(self, heard: Heard, state: State, chance: random.Random) -> Answer:
        """Return the answer. Takes about a millisecond if the utterance has been encoded before."""
        moment = moment_of(self._phrases, heard.seen)
        played = self._play(heard, state, chance, moment[0])
        if played is not None:
            text, after = played
            after = after.toned("").having_said(text, text)
            return Answer(text, replace(after, before=heard.text, pending=None, moment=""))
        state = replace(state, game=None)
        said = self._say(heard, state, chance, *moment)
        return replace(said, state=replace(said.state, before=heard.text))

    def overhear(self, seen: Analysis, focus: Being | None) -> Overheard:
        """Return what an utterance leaves behind: the tone, and the being that it mentions after `focus`."""
        feeling, sentence = feeling_of(self._phrases, seen, "", "")
        tone, lasts = (feeling.tone, feeling.lasts) if feeling is not None else ("", LASTING)
        return Overheard(seen.text, roles_of(seen, sentence, focus, self._phrases).being, tone, lasts)

    def pick_up(self, state: State, chance: random.Random) -> Answer | None:
        """Return a remark about what was said last, to end a silence; None if there is nothing to come back to."""
        if state.moment == SILENCE or not (state.clause or state.tone == "sad"):
            return None
        roles = Roles().having(clause=state.clause)
        moment = self._phrases.plain["silence"]
        groups = moment.lines("sad") if state.tone == "sad" else moment.lines("say")
        line = self._choose(groups, roles, state, chance)
        if line is None:
            return None
        return self._finish(line, roles, replace(state, clause="", moment=SILENCE))

    # ---------------------------------------------------------------------------------- performances

    def _request(self, heard: Heard) -> str:
        """Return the performance that the user asks for."""
        if heard.seen is None or heard.seen.yesno.no:
            return ""
        named = self._games.named(heard.text, most=6 if heard.seen.question is not None else 3)
        if named:
            return named
        acts = heard.seen.acts
        found = [act for act in SHOWS if act in acts and acts[act].score >= ASKED]
        return SHOWS[max(found, key=lambda act: acts[act].score)] if found else ""

    def _play(
        self, heard: Heard, state: State, chance: random.Random, moment: Moment | None
    ) -> tuple[str, State] | None:
        seen = heard.seen
        games = self._games
        if games.knocks(heard.text):
            return games.knock(state)
        if state.game is not None:
            if seen is not None and ("stop" in seen.acts or "farewell" in seen.acts):
                return games.stop(state, chance)
            played = games.play(heard.text, seen, state, chance)
            if played is not None:
                return played
        if seen is not None and state.pending is not None and state.pending.start and seen.yesno.yes:
            return games.start(state.pending.start, state, chance)
        request = self._request(heard)
        if request:
            return games.start(request, state, chance)
        if moment is not None and moment.name == "another":
            return games.start(state.show or "story", state, chance)
        return None

    # ---------------------------------------------------------------------------------- phrases

    def _say(
        self, heard: Heard, state: State, chance: random.Random, moment: Moment | None, sentence: str, score: float
    ) -> Answer:
        seen = heard.seen
        feeling, sentence = feeling_of(self._phrases, seen, sentence, state.tone)
        roles = Roles() if seen is None else roles_of(seen, sentence, state.being, self._phrases)
        roles = roles.having(user=heard.user, before=state.before.strip().rstrip(".!?")[:80])
        if seen is not None:
            roles = roles.having(answer=fragment(seen))
        told = roles.values.get("clause", "")
        sources = self._sources(heard, state, roles, chance, moment, score, feeling)
        for source in self._without_third_questions(sources, state):
            filled = replace(roles, values={**roles.values, **(source.roles or {})})
            line = self._choose(source.groups, filled, state, chance)
            if line is None:
                continue
            after = replace(
                state.toned(source.tone, source.lasts), being=roles.being or state.being, moment=source.name
            )
            if told and roles.statement is not None and not roles.statement.negated:
                after = replace(after, clause=told)
            if source.stance:
                after = replace(after, stances={**state.stances, **source.stance})
            if source.matter and roles_in(source.matter) <= filled.values.keys():
                after = after.noting(Matter(filled.fill(source.matter), heard.now))
            return self._finish(line, filled, after)
        return Answer("Mhm.", state.toned(""))  # all phrases were said lately

    @staticmethod
    def _without_third_questions(sources: Iterator[_Source], state: State) -> Iterator[_Source]:
        """Yield the sources; after two questions the weak ones come without theirs first."""
        asked = len(state.said) > 1 and all(text.endswith("?") for text in state.said[-2:])
        later: list[_Source] = []
        for source in sources:
            if asked and source.weak:
                later.append(source)
                told = [[line for line in lines if not line.asks] for lines in source.groups]
                source = replace(source, groups=told)
            yield source
        yield from later

    def _finish(self, line: Line, roles: Roles, state: State) -> Answer:
        text = roles.fill(line.text)
        then = {name: tuple(map(roles.fill, texts)) for name, texts in line.then.items()}
        pending = Pending(text, then, line.start) if text.endswith("?") else None
        return Answer(text, replace(state.having_said(line.text, text), pending=pending))

    def _choose(
        self, groups: Sequence[Sequence[Line]], roles: Roles, state: State, chance: random.Random
    ) -> Line | None:
        """Return a line of the first group that has one: with known roles, and not said lately."""
        for lines in groups:
            fit = [line for line in lines if line.roles <= roles.values.keys() and line.text not in state.recent]
            fit = [line for line in fit if roles.fill(line.text) not in state.said]
            if not fit:
                continue
            most = max(min(len(line.roles), 1) for line in fit)
            return chance.choice([line for line in fit if min(len(line.roles), 1) == most])
        return None

    def _sources(
        self,
        heard: Heard,
        state: State,
        roles: Roles,
        chance: random.Random,
        moment: Moment | None,
        score: float,
        feeling: Moment | None,
    ) -> Iterator[_Source]:
        """Yield the sources in order; the comment of the file explains them."""
        phrases, seen = self._phrases, heard.seen
        plain = phrases.plain
        tone = state.tone
        yield from self._strange(heard, seen)
        if seen is None:
            yield _Source(plain["fact" if heard.text.rstrip().endswith("?") else "generic"].lines(tone, "say"))
            return
        words = [word for word in seen.tree.words if word.pos != "PUNCT"]
        verb = has_verb(seen)
        called = called_in(roles)
        if called:
            yield _Source(plain["named"].lines(tone, "say"), roles={"called": called})
        if state.pending is not None:
            yield from self._answered(
                state,
                seen,
                len(words),
                verb,
                felt=feeling is not None,
                strong=score >= SURE,
                subject=moment is not None,
            )
        elif (
            len(words) <= 3
            and not verb
            and score < SURE
            and (seen.yesno.yes or seen.yesno.no)
            and not seen.acts.keys() - _YESNO
        ):
            yield _Source(plain["yes" if seen.yesno.yes else "no"].lines(tone, "say"))
        ranked: list[tuple[float, Moment]] = []
        if moment is not None and tone == "sad" and moment.tone != "sad" and "sad" not in moment.groups:
            score = score if score >= TURNED else 0.0  # no light talk in grief
        if moment is not None and moment.name in phrases.moments and score >= SURE:
            ranked.append((score + FINER, moment))
        if feeling is not None:
            ranked.append((seen.feelings[feeling.name].score, feeling))
        ranked += [
            (act.score, phrases.acts[act.name])
            for act in seen.acts.values()
            if act.name in phrases.acts and act.score >= (FEW if len(act.text.split()) <= FEW_WORDS else MEANT)
        ]
        if seen.question is not None:
            ranked = [pair for pair in ranked if pair[1].name != "greeting"]
        ranked = [pair for pair in ranked if pair[1].name not in ENDINGS or pair[0] >= ASKED]
        ranked = [pair for pair in ranked if pair[0] >= FELT]
        for _, best in sorted(ranked, key=lambda pair: -pair[0]):
            yield self._of(best, state, roles, seen)
        told = roles.statement
        if tone == "sad" and told is not None and told.verb == "be" and told.object.head.isdigit():
            yield _Source(plain["aged"].lines(tone))
        if seen.question is not None:
            yield from self._question(seen, state, roles, chance)
        if verb and seen.question is None:
            for source in self._statement(seen, state, roles, chance, moment):
                yield replace(source, weak=True)
        if (
            not verb
            and seen.question is None
            and moment is not None
            and moment.name in phrases.topics
            and tone != "sad"
        ):
            yield _Source(moment.lines("say"), moment.name)
        if not verb and roles.values.get("answer") and len(words) <= SHORT + 2:
            yield _Source(plain["fragment"].lines(tone, "say"), weak=True)
        if not verb and len(words) <= 1:
            yield _Source(plain["hm"].lines(tone, "say"), weak=True)
        yield _Source(plain["generic"].lines(tone, "say"), weak=True)

    def _strange(self, heard: Heard, seen: Analysis | None) -> Iterator[_Source]:
        plain = self._phrases.plain
        if is_number(heard.text):
            yield _Source(plain["number"].lines("say"))
        tongue = tongue_of(heard.text, self._phrases.tongues)
        if tongue:
            yield _Source(plain["tongue"].lines(tongue, "say"))
        if is_nonsense(heard.text):
            yield _Source(plain["nonsense"].lines("say"))
        if not any(map(str.isalnum, heard.text)):
            yield _Source(plain["hm"].lines("say"))

    def _answered(
        self, state: State, seen: Analysis, size: int, verb: bool, *, felt: bool, strong: bool, subject: bool
    ) -> Iterator[_Source]:
        """Yield the answers to a short answer to the agent's question."""
        pending, plain, tone = state.pending, self._phrases.plain, state.tone
        assert pending is not None
        yesno = seen.yesno
        kind = "yes" if yesno.yes else "no" if yesno.no else "unsure" if yesno.unsure and size <= SHORT else ""
        if seen.question is not None or size > 2 * SHORT or is_request(seen):
            return
        if kind in pending.then and not felt:
            yield _Source([_bare(pending.then[kind])])
        if felt or strong:
            return
        if kind and (pending.closed or kind == "unsure"):
            if kind != "unsure" and "any" in pending.then:
                yield _Source([_bare(pending.then["any"])])
            yield _Source(plain[kind].lines(tone, "say"))
        elif not kind and size <= SHORT and not seen.acts and not (subject and size > 2) and not is_of_others(seen):
            if "any" in pending.then:
                yield _Source([_bare(pending.then["any"])])
            if not verb:
                yield _Source(plain["answer"].lines(tone, "say"))

    def _of(self, moment: Moment, state: State, roles: Roles, seen: Analysis) -> _Source:
        """Return the source of a moment or feeling: the groups that fit, the most specific first."""
        groups: list[str] = []
        if state.moment == moment.name:
            groups.append("again")
        if state.tone:
            groups.append(state.tone)
        statement = roles.statement
        if statement is not None and is_living(self._phrases, statement):
            groups.append("theirs")
        if roles.being is not None:
            groups.append(roles.being.kind)
        if statement is not None:
            if roles.being is None and statement.subject_person == "I":
                groups.append("self")
            groups.append("future" if statement.plan else "past" if is_past(statement.verb, seen) else "present")
        matter = moment.matter
        return _Source(moment.lines(*groups, "say", "again"), moment.name, moment.tone, moment.lasts, matter)

    def _question(self, seen: Analysis, state: State, roles: Roles, chance: random.Random) -> Iterator[_Source]:
        """Yield the answers to a question that no other module has answered."""
        plain = self._phrases.plain
        choice = choice_in(seen)
        if choice:
            yield _Source(plain["choice"].lines("say"), roles={"first": choice[0], "second": choice[1]})
        asked = next((one for one in seen.statements if one.question), None)
        subject = asked.subject_person if asked is not None else ""
        opinion = asked is not None and subject == "you" and asked.verb in plain["opinion"].words
        if opinion or (asked is not None and asked.subject.of("you") and about_in(seen)):
            thing = about_in(seen) or roles_of(seen, "", None, self._phrases).values.get("thing", "")
            if thing:
                yield self._opinion(thing, state, chance, known=roles.being is not None or bool(seen.entities))
        if facts_matcher().loaded and any(facts_matcher().match_all(seen.sentences)):
            yield _Source(plain["fact"].lines("say"))
        if any(word.low in ("would", "could", "if", "imagine") for word in seen.tree.words) and seen.about_agent:
            yield _Source(plain["hypothetical"].lines("say"))
        if seen.about_agent and subject in ("you", ""):
            yield _Source(plain["you"].lines("closed" if seen.question is QuestionWord.YES_NO else "open", "say"))
        if subject == "I":
            yield _Source(plain["me"].lines("say"))
        if seen.question is QuestionWord.REASON:
            yield _Source(plain["why"].lines("say"))
        yield _Source(plain["you" if seen.about_agent else "fact"].lines("say"))

    def _opinion(self, thing: str, state: State, chance: random.Random, *, known: bool) -> _Source:
        stances = self._phrases.plain["stances"]
        key = thing.lower()
        if key in state.stances:
            number = ("like", "curious", "cool").index(state.stances[key])
            return _Source([[stances.groups["as_before"][number]]], roles={"thing": thing})
        stance = "curious" if known else chance.choices(("like", "curious", "cool"), (5, 3, 2))[0]
        return _Source(stances.lines(stance), roles={"thing": thing}, stance={key: stance})

    def _statement(
        self, seen: Analysis, state: State, roles: Roles, chance: random.Random, moment: Moment | None
    ) -> Iterator[_Source]:
        """Yield the answers to a statement: about its verb, its subject, or anything told."""
        phrases, tone, statement = self._phrases, state.tone, roles.statement
        plain = phrases.plain["statement"]
        living = statement is not None and is_living(self._phrases, statement)
        if statement is not None and tone == "sad" and living and is_past(statement.verb, seen):
            yield _Source(plain.lines("memory"))
        if tone == "sad" or (tone in ("angry", "tired") and (living or chance.random() < 0.5)):
            yield _Source(plain.lines(tone))
        if statement is None:
            return
        if statement.subject_person == "you":
            yield _Source(plain.lines("about_me"))
        if statement.plan and statement.subject_person == "I":
            yield _Source(plain.lines("plan"))
        if statement.conditional:
            yield _Source(plain.lines("imagined"))
        if statement.past and statement.subject_person == "I" and "used" in words_of(seen):
            yield _Source(plain.lines("used"))
        if living and "they" in roles.values:
            described = ["described"] if statement.verb in ("be", "have") else []
            groups = ["being", "other"] if statement.subject.head else ["other", "being"]
            yield _Source(plain.lines(*described, *groups))
        sources: list[_Source] = []
        name = f"not {statement.verb}" if statement.negated else statement.verb
        verb = next((one for one in phrases.verbs.values() if name in one.words), None)
        if verb is not None and statement.subject_person == "I" and statement.object.person != "you":
            tense = "past" if is_past(statement.verb, seen) else "say"
            sources.append(_Source(verb.lines(tense, "say")))
        topic = moment if moment is not None and moment.name in phrases.topics else None
        heads = {statement.object.head, statement.subject.head, *(phrase.head for phrase in statement.phrases)}
        named = next((one for one in phrases.topics.values() if heads & one.words), None)
        about = named or topic
        if about is not None and not statement.negated:
            lines = about.lines("say")
            if living:  # the others are about the user
                lines = [[line for line in group if line.roles & {"who", "they", "them"}] for group in lines]
            sources.append(_Source(lines, about.name))
        if len(sources) == 2 and chance.random() < 0.4:
            sources.reverse()
        yield from sources
        if state.pending is not None and "any" in state.pending.then and not statement.subject.head:
            yield _Source([_bare(state.pending.then["any"])])
        yield _Source(plain.lines(tone, "say"))


def _bare(texts: Sequence[str]) -> list[Line]:
    """Return finished texts as lines; any braces left in them belong to the user's words."""
    return [Line(text, frozenset()) for text in texts if "{" not in text]
