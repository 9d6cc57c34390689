"""Choose the answer to an utterance, by the table in order.yaml.

The listener takes the first group with a usable phrase: all its placeholders (*roles*) can be filled, and it was not
said lately. Games and performances (jokes, songs, stories) come first. `hearing` explains moments, moves and tones.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravestate.language.normal import plain
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline

from .following import is_answer
from .games import Played, Turn
from .grave import is_crisis
from .hearing import Heard, Hearing, hear, is_living
from .lookup import ALIKE, KNOWN, is_dark, near_in
from .material import Material, material
from .meaning import ASKED, feeling_of
from .moment import Line, Moment
from .repair import may_repair, repair_in
from .responses import is_general, network
from .roles import Roles, has_verb, roles_of
from .state import LASTING, Being, Overheard, Pending, State
from .taking_up import replies
from .tones import load_tones
from .turns import is_cry, is_leaving, is_news
from .wishes import Wish, kinds_in, wish_in

SHOWS = ("joke", "song", "story", "play")
"""The acts that request a performance."""
BRIEF, BRIEFLY = 12, 12
"""The maximum length of a sign of listening such as *mhm*, in characters; the number of answers until it may return."""
STANCES = ("like", "curious", "cool")
PERHAPS = 0.42
"""The minimum rough estimate of that probability at which the listener computes it exactly. 95 % of the entries that
reach `KNOWN` also reach this estimate."""
THIRD = 0.4
"""The rank that a reply loses if it is the third question in a row."""
AWAY = 3
"""The number of answers without an entry of the bank after which its thread is forgotten."""

Groups = Sequence[Sequence[Line]]


@dataclass(frozen=True, slots=True)
class Answer:
    """The agent's answer, with the state of the conversation after it."""

    text: str
    state: State
    weak: bool = False
    """Whether the answer fits nearly every utterance."""

    def opened(self, words: str, before: str) -> Answer:
        """Return the answer with words before it. `before`: the user's whole utterance."""
        text = f"{words} {self.text}".strip()
        return Answer(text, replace(self.state, said=(*self.state.said[:-1], text), before=before))


@dataclass(frozen=True, slots=True)
class _Source:
    """Groups of phrases, in the order in which they are tried, and the effects of saying one of the phrases."""

    groups: Groups
    moment: Moment | None = None
    weak: bool = False
    """Whether the phrases fit nearly every utterance. After two questions, such a source asks no third question."""
    stance: str = ""
    """The opinion that the phrases express."""
    asked: tuple[str, str] | None = None
    """The kind and the area of the question that the phrases answer."""


class Listener:
    """The listening skill. It has no state of its own, so all contexts share it."""

    def __init__(self, phrases: Material | None = None) -> None:
        """`phrases`: by default the built-in phrases."""
        self._phrases = phrases or material()

    def load(self) -> None:
        """Learn the examples now. Until that is done, only words that equal an example are recognised.

        Raises:
            PlatformError: The sentence model is missing or broken.
        """
        for matcher in self._phrases.matchers:
            matcher.load()
        self._phrases.bank.load()
        load_tones()
        network().load()

    def claims(self, heard: Heard, state: State | None = None) -> bool:
        """Return whether other modules would mistake an utterance for a question or a fact, so that small talk must answer.

        Such an utterance asks for a performance, corrects the agent, or is news or a complaint in the form of a
        question. Without `state`, this is only a guess.
        """
        seen = heard.seen
        if seen is None or not seen.sentences or is_crisis(seen.normal.text):
            return False
        if self.wish(heard, state or State()) is not None or is_news(seen.sentences[-1]) or is_cry(seen.text):
            return True
        if seen.closing is not None:  # "that's not what I asked. how old are you?" asks again
            return False
        return may_repair(seen) if state is None else repair_in(seen, state) is not None

    def performs(self, heard: Heard, state: State) -> bool:
        """Return whether the utterance asks for a performance or belongs to it. No language model should answer it."""
        return state.game is not None or self.wish(heard, state) is not None

    def expects(self, state: State) -> bool:
        """Return whether the last answer has follow-ups."""
        bank = self._phrases.bank
        return any(bank.follow_ups(name) for name in (state.moment, *bank.thread(state.thread)))

    def continues(self, heard: Heard, state: State) -> bool:
        """Return whether the utterance belongs to a game, or answers what the skill said last.

        Other modules would misunderstand such words: in word chain, *tomato* is no question about vegetables.
        """
        seen, pending = heard.seen, state.pending
        if seen is None or not heard.text.strip() or is_crisis(seen.normal.text):
            return False
        if state.game is not None:
            turn = Turn(self._phrases.shows, heard.text, seen, state, random.Random(0))
            return "stop" in seen.acts or (("farewell" not in seen.acts or turn.solves()) and turn.move() is not None)
        feeling, _ = feeling_of(self._phrases, seen, "", state.tone)
        dark = is_dark(seen, ()) or (feeling is not None and feeling.tone == "sad")
        if is_answer(self._phrases.bank, state, seen, dark=dark):
            return True
        if pending is None or not (pending.then or pending.start) or seen.question is not None:
            return False
        size = len(heard.text.split())
        short = size < 4 and not has_verb(seen) and not (seen.acts.keys() - {"contradiction"})
        return short or bool((seen.yesno.yes or seen.yesno.no) and size <= 4 and pending.closed)

    def knows(self, seen: Analysis, *, roughly: bool = False) -> bool:
        """Return whether the bank has a reply that probably suits; with `roughly`, by a fast estimate."""
        said = f" {plain(seen.text)} "
        if is_crisis(seen.normal.text) or " forget" in said or " my name " in said:  # other modules answer
            return False
        near = near_in(self._phrases, seen, "", State(), None, roughly=roughly)
        light = bool(near) and near[0].moment.tone != "sad" and is_dark(seen, near)
        return bool(near) and near[0].fit >= (PERHAPS if roughly else KNOWN) and not light

    def answer(self, heard: Heard, state: State, chance: random.Random) -> Answer:
        """Return the answer. This takes 10 to 50 ms, mostly for the bank."""
        hearing = hear(self._phrases, heard, state)
        own = hearing.asked is not None and "wording" in hearing.tags  # "say that again" starts no other performance
        played = None if own else self._play(heard, state, chance)
        if played is not None:
            text, after = played
            after = after.toned("").having_said(text, text)
            return Answer(text, replace(after, before=heard.text, pending=None, moment=""))
        said = self._mended(heard, state, chance) or self._say(hearing, state, chance)
        game = None if state.game is None or is_leaving(heard.text) else state.game.beside(said.text)
        ground = (hearing.taken.told.echo if hearing.taken else "") or state.ground
        now = replace(said.state, before=heard.text, ground=ground, game=game, options=hearing.options)
        return replace(said, state=now)

    def overhear(self, seen: Analysis, focus: Being | None) -> Overheard:
        """Return the tone of an utterance, and the being that it mentions. A pronoun means the being `focus`."""
        feeling, sentence = feeling_of(self._phrases, seen, "", "")
        tone, lasts = (feeling.tone, feeling.lasts) if feeling is not None else ("", LASTING)
        return Overheard(seen.text, roles_of(seen, sentence, focus, self._phrases).being, tone, lasts)

    # ---------------------------------------------------------------------------------- performances

    def wish(self, heard: Heard, state: State) -> Wish | None:
        """Return the performance that the user asks for; None if they ask for none."""
        if heard.seen is None or is_leaving(heard.text):  # "I'll sing her a song. Goodbye!"
            return None
        closing = heard.seen.closing
        acts = [act for act in heard.seen.acts.values() if act.name in SHOWS and act.score >= ASKED]
        acts = [act for act in acts if closing is None or not closing.outweighs(act.text)]
        names = [act.name for act in sorted(acts, key=lambda act: -act.score)]
        return wish_in(self._phrases.shows, heard.seen, state, names)

    def _play(self, heard: Heard, state: State, chance: random.Random) -> Played | None:
        seen, wish = heard.seen, self.wish(heard, state)
        turn = Turn(self._phrases.shows, heard.text, seen, state, chance)
        acts = frozenset[str]() if seen is None else seen.acts.keys()
        if state.game is not None and ("farewell" not in acts or turn.solves()) and (wish is None or turn.chains()):
            played = turn.stop() if "stop" in acts and not turn.gives_up() else turn.move()
            if played is not None:
                return played
        if seen is not None and state.pending is not None and state.pending.start and seen.yesno.yes:
            return turn.start(wish or Wish(state.pending.start))
        return turn.start(wish) if wish else None

    # ---------------------------------------------------------------------------------- phrases

    def _mended(self, heard: Heard, state: State, chance: random.Random) -> Answer | None:
        """Return the answer to a correction: an admission, then an answer to what the user meant. None if there is none."""
        repair = None if heard.seen is None else repair_in(heard.seen, state)
        if repair is None:
            return None
        hearing = Hearing(set())
        shown = bool(state.shown) and state.said[-1].endswith(state.shown[-1])
        named = kinds_in(self._phrases.shows, repair.thing)[:1] if shown else []
        if named:  # "I meant the riddle"
            text, after = Turn(self._phrases.shows, heard.text, heard.seen, state, chance).start(Wish(named[0]))
            return Answer(text, after.having_said(text, text))
        if repair.again:
            meant = Heard(repair.again, analyse(repair.again, pipeline("")), heard.user)
            wish = self.wish(meant, state)
            hearing = hear(self._phrases, meant, replace(state, pending=None, moment="", thread=""))
            hearing.leave_out(state.moment, "" if state.asked is None else state.asked[1])
            said = self._first(hearing, state, chance, firm=True)
            if wish is not None:
                text, after = Turn(self._phrases.shows, meant.text, meant.seen, state, chance).start(wish)
                said = Answer(text, after.having_said(text, text))
            if said is not None:
                front = self._choose(_Source(self._phrases.plain["repair"].lines(repair.kind)), Roles(), state, chance)
                return said if front is None else replace(said, text=f"{front.text} {said.text}")
        roles = hearing.roles.having(thing=repair.thing)
        kind = "meant" if repair.kind == "why" else repair.kind
        groups = ["thing"] * bool(repair.thing) + ["told"] * (kind == "meant") + ["say"]
        line = self._choose(_Source(self._phrases.plain[f"repair_{kind}"].lines(*groups)), roles, state, chance)
        return None if line is None else _said(line, roles, replace(state, moment="", asked=None))

    def _say(self, hearing: Hearing, state: State, chance: random.Random) -> Answer:
        found = self._first(hearing, state, chance)
        return found or Answer("Mhm.", state.toned(""))  # all phrases were said lately

    def _first(self, hearing: Hearing, state: State, chance: random.Random, *, firm: bool = False) -> Answer | None:
        """Return the first usable answer; with `firm`, the first that is specific to the utterance."""
        for source in _with_fewer_questions(self._sources(hearing, state, chance), state):
            roles = hearing.roles
            line = None if firm and source.weak else self._choose(source, roles, state, chance)
            if line is None:
                continue
            moment = source.moment
            tone = hearing.tone if moment is None else moment.tone or "sad" * (hearing.tone == "sad")
            tone = "" if tone == "funny" else tone  # a funny story leaves no tone behind
            after = state.toned(tone, LASTING if moment is None else moment.lasts)
            after = replace(
                after,
                being=roles.being or state.being,
                moment=(source.asked or ("",))[0] if moment is None else moment.name,
            )
            after = self._threaded(after)
            after = replace(after, asks=after.asks and after.moment != "no_questions")
            after = replace(after, asked=source.asked or after.asked)
            if source.stance:
                after = replace(after, stances={**state.stances, roles.values["thing"].lower(): source.stance})
            return replace(_said(line, roles, after), weak=source.weak)
        return None

    def _threaded(self, state: State) -> State:
        """Return the state with the thread of its last answer. After `AWAY` answers from elsewhere, the thread ends."""
        if state.moment in self._phrases.bank.named:
            return replace(state, thread=state.moment, away=0)
        away = state.away + 1
        return replace(state, thread=state.thread if away < AWAY else "", away=away)

    def _choose(self, source: _Source, roles: Roles, state: State, chance: random.Random) -> Line | None:
        """Return a line from the first group with a usable line: all roles are known, and it was not said lately."""
        for lines in source.groups:
            known = [line for line in lines if line.roles <= roles.values.keys()]
            fit = [line for line in known if not _said_lately(line.text, roles.fill(line.text), state)]
            if fit:
                return chance.choice([line for line in fit if line.roles] or fit)
        return None

    def _sources(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the sources of the rows of order.yaml whose tags fit."""
        tags, plain = hearing.tags, self._phrases.plain
        for row in self._phrases.order:
            if not (row.needs <= tags and not (row.without & tags)):
                continue
            special = getattr(self, f"_{row.group[1:]}", None) if row.group.startswith("@") else None
            if special is not None:
                found = special(hearing, state, chance)
                yield from (replace(source, weak=row.weak or source.weak) for source in found)
            elif row.group.startswith("@"):  # the reactions that belong to the agent's question
                then = state.pending.then.get(row.group[1:], ()) if state.pending is not None else ()
                yield _Source([[Line(text, frozenset()) for text in then if "{" not in text]])
            else:
                lists = row.lists or (hearing.tongue, state.tone, "say")
                yield _Source(plain[row.group].lines(*lists), weak=row.weak)

    def _meaning(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield each feeling, act and moment with its fitting groups of phrases, the most specific group first."""
        roles, statement = hearing.roles, hearing.roles.statement
        for moment in hearing.meanings:
            groups = ["again"] if state.moment == moment.name else []
            groups += [state.tone] if state.tone else []
            if statement is not None and is_living(self._phrases, statement):
                groups.append("theirs")
            if roles.being is not None:
                groups.append(roles.being.kind)
            if statement is not None:
                mine = roles.being is None and statement.subject_person == "I"
                past = {"past"} & hearing.tags
                groups += [*(["self"] if mine else []), "future" if statement.plan else "past" if past else "present"]
            found = moment.lines(*groups, "say", "again")
            if (
                "long" in hearing.tags and moment.name in self._phrases.feelings
            ):  # the user has already said why, so ask nothing
                yield _Source([[line for line in lines if not line.asks] for lines in found], moment)
            yield _Source(found, moment)

    def _bank(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the entries of the bank that suit the utterance, the most suitable first."""
        for one in hearing.near:
            if one.fit >= ALIKE:
                yield _Source(one.moment.lines("say"), one.moment)

    def _follow(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the follow-up that the utterance resembles."""
        if hearing.follow_up is not None:
            yield _Source(hearing.follow_up.lines("say"), hearing.follow_up)

    def _other(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the follow-up for any other statement."""
        if hearing.rest is not None:
            yield _Source(hearing.rest.lines("say"), hearing.rest)

    def _asked(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the answers to a question or request, by its kind and its area of life."""
        asked = hearing.asked
        if asked is not None:
            about = asked.kind, "" if asked.area is None else asked.area.name
            yield _Source(
                asked.lines(self._phrases, state.tone, "" if "again" in hearing.tags else hearing.asking), asked=about
            )

    def _echo(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield replies that take up the user's statement, with its highlight."""
        if hearing.taken is not None:
            for groups in replies(hearing.taken, self._phrases.taking_up, hearing.mood, state, chance):
                yield _Source(groups)

    def _move(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the replies of the likely move. If two moves are likely, yield replies that suit both."""
        tags, moves = hearing.tags, self._phrases.replies
        unsure = "ask" if "question" in tags else "tell"
        doubted = hearing.moves[:1] in (("console",), ("mourn",)) and not tags & {"tone", "sorry"}
        sure = len(hearing.moves) == 1 and not doubted  # console only after a sign of sorrow
        groups = ["asked"] if {"question", "request"} & tags else []
        if hearing.roles.being is not None and "question" not in tags:
            groups.append(hearing.roles.being.kind)
        groups += [state.tone, "say"]
        if sure:
            yield _Source(moves[hearing.moves[0]].lines(*groups), moves[hearing.moves[0]])
        yield _Source(moves[unsure].lines(*groups))

    def _response(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the replies that suit the utterance, the best first. After two questions, a third one counts less."""
        asked = len(state.said) > 1 and all(text.endswith("?") for text in state.said[-2:])
        for one in sorted(hearing.responses, key=lambda one: (THIRD if asked and one.line.asks else 0.0) - one.rank):
            yield _Source([[one.line]], one.kind, weak=is_general(one.kind))

    def _opinion(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the agent's opinion, which is chosen once per conversation. The agent does not judge people."""
        roles, stances = hearing.roles, self._phrases.plain["stances"]
        hearing.roles = roles.having(thing=hearing.thing)
        before = state.stances.get(hearing.thing.lower())
        if before is not None:
            yield _Source([[stances.groups["as_before"][STANCES.index(before)]]])
        stance = "curious" if roles.being is not None else chance.choices(STANCES, (5, 3, 2))[0]
        yield _Source(stances.lines(before or stance), stance=before or stance)


def _said_lately(template: str, text: str, state: State) -> bool:
    """Return whether a phrase was said lately. A sign of listening may return sooner than other phrases."""
    lately = BRIEFLY if len(text) <= BRIEF else len(state.said)
    return text in state.said[-lately:] or (len(text) > BRIEF and template in state.recent)


def _with_fewer_questions(sources: Iterator[_Source], state: State) -> Iterator[_Source]:
    """Yield the sources with fewer questions: after two questions in a row, during a game, or if the user wants none."""
    asked = len(state.said) > 1 and all(text.endswith("?") for text in state.said[-2:])
    later: list[_Source] = []
    for source in sources:
        quiet = [[line for line in lines if not line.asks] for lines in source.groups]
        if not state.asks or state.game is not None or (asked and source.weak):
            later.append(source)
            source = replace(source, groups=quiet)
        elif asked:
            groups = [lines for pair in zip(quiet, source.groups, strict=True) for lines in pair]
            source = replace(source, groups=groups)
        yield source
    yield from later


def _said(line: Line, roles: Roles, state: State) -> Answer:
    text = roles.fill(line.text)
    then: Mapping[str, tuple[str, ...]] = {name: tuple(map(roles.fill, texts)) for name, texts in line.then.items()}
    pending = Pending(text, then, line.start) if text.endswith("?") else None
    return Answer(text, replace(state.having_said(line.text, text), pending=pending))
