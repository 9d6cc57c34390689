"""Choose the answer to an utterance, by the table in order.yaml.

The listener takes the first group with a usable phrase: all its placeholders (*roles*) can be filled, and it was not
said lately. Games and performances (jokes, songs, stories) come first, then corrections of the last answer. `hearing`
explains moves and tones.
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from ravestate.language.matcher import bundled_matcher
from ravestate.language.normal import plain
from ravestate.language.replies import replies
from ravestate.modules.meta.nlp.analysis import Analysis, analyse
from ravestate.modules.meta.nlp.pipeline import pipeline

from .asked import load_judge
from .games import Played, Turn
from .grave import is_crisis, is_grave
from .hearing import Heard, Hearing, hear
from .material import Material, material
from .phrases import Line, filled
from .repair import may_repair, repair_in
from .roles import has_verb
from .state import LASTING, Overheard, Pending, State
from .tones import heard_tone, load_tones
from .turns import is_cry, is_leaving, is_news
from .wishes import Wish, kinds_in, wish_in

SHOWS = ("joke", "song", "story", "play")
"""The acts that request a performance."""
PLAINLY = 6
"""The maximum number of words of a request that names a performance, before the classifier is loaded."""
BRIEF, BRIEFLY = 12, 12
"""`BRIEF`: the maximum number of characters in a sign of listening such as *mhm*. `BRIEFLY`: the number of answers after
which such a sign may return."""
STANCES = ("like", "curious", "cool")
THIRD = 0.4
"""The rank that a reply loses if it is the third question in a row."""

Groups = Sequence[Sequence[Line]]


@dataclass(frozen=True, slots=True)
class Answer:
    """The agent's answer, with the state of the conversation after it."""

    text: str
    state: State
    weak: bool = False
    """Whether the answer may fit only a little."""

    def opened(self, words: str, before: str) -> Answer:
        """Return the answer with words before it. `before`: the user's whole utterance."""
        text = f"{words} {self.text}".strip()
        return Answer(text, replace(self.state, said=(*self.state.said[:-1], text), before=before))


@dataclass(frozen=True, slots=True)
class _Source:
    """Groups of phrases, in the order in which they are tried, and the effects of saying one of the phrases."""

    groups: Groups
    weak: bool = False
    """Whether the phrases may fit only a little."""
    tone: str = ""
    """The tone of the utterances that the phrases suit."""
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
        """Load the models now. Before that, no reply has a grade.

        Raises:
            PlatformError: The sentence model is missing or broken.
        """
        replies().load()
        load_tones()
        load_judge()

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
        """Return whether the utterance asks for a performance, or a game is in progress. Then no language model should answer."""
        return not is_crisis(heard.text) and (state.game is not None or self.wish(heard, state) is not None)

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
        if pending is None or not (pending.then or pending.start) or seen.question is not None:
            return False
        size = len(heard.text.split())
        short = size < 4 and not has_verb(seen) and not (seen.acts.keys() - {"contradiction"})
        return short or bool((seen.yesno.yes or seen.yesno.no) and size <= 4 and pending.closed)

    def knows(self, seen: Analysis, state: State) -> bool:
        """Return whether a reply surely suits. False for words of danger, *my name* and *forget*: other modules answer these."""
        said = f" {plain(seen.text)} "
        if is_crisis(seen.normal.text) or " forget" in said or " my name " in said:
            return False
        found = hear(self._phrases, Heard(seen.text, seen), state).responses
        return bool(found) and found[0].sure

    def answer(self, heard: Heard, state: State, chance: random.Random) -> Answer:
        """Return the answer. This takes 10 to 40 ms."""
        hearing = hear(self._phrases, heard, state)
        own = hearing.asked is not None and "wording" in hearing.tags  # "say that again" starts no other performance
        grave = not hearing.tags.isdisjoint(("crisis", "endangered")) or (
            state.game is not None and is_grave(heard.text)
        )
        if grave:  # end the game, and tell no joke
            state = replace(state, game=None)
        played = None if own or grave else self._play(heard, state, chance)
        if played is not None:
            text, after = played
            after = after.toned("").having_said(text, text)
            return Answer(text, replace(after, before=heard.text, pending=None))
        said = (None if grave else self._mended(heard, state, chance)) or self._say(hearing, state, chance)
        game = None if state.game is None or is_leaving(heard.text) else state.game.beside(said.text)
        now = replace(said.state.warned(heard.text), before=heard.text, game=game, options=hearing.options)
        return replace(said, state=now)

    def overhear(self, seen: Analysis) -> Overheard:
        """Return the tone of an utterance."""
        tone, lasts = heard_tone(seen)
        return Overheard(seen.text, tone, lasts)

    # ---------------------------------------------------------------------------------- performances

    def wish(self, heard: Heard, state: State) -> Wish | None:
        """Return the performance that the user asks for; None if they ask for none."""
        if heard.seen is None or is_leaving(heard.text):  # "I'll sing her a song. Goodbye!"
            return None
        closing = heard.seen.closing
        acts = [act for act in heard.seen.acts.values() if act.name in SHOWS]
        acts = [act for act in acts if closing is None or not closing.outweighs(act.text)]
        found = wish_in(self._phrases.shows, heard.seen, state, sorted(acts, key=lambda act: -act.score))
        if found is None and not bundled_matcher("acts").loaded:  # the classifier knows only exact examples
            named = kinds_in(self._phrases.shows, heard.text)
            return Wish(named[0]) if named and len(heard.text.split()) <= PLAINLY else None
        return found

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
        """Return the answer to a correction: an admission, then an answer to what the user meant.

        Return None if there is no such answer.
        """
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
            hearing = hear(self._phrases, meant, replace(state, pending=None))
            hearing.leave_out(state.said[-1], "" if state.asked is None else state.asked[1])
            said = self._first(hearing, state, chance, firm=True)
            if wish is not None:
                text, after = Turn(self._phrases.shows, meant.text, meant.seen, state, chance).start(wish)
                said = Answer(text, after.having_said(text, text))
            if said is not None:
                front = self._choose(_Source(self._phrases.plain["repair"].lines(repair.kind)), {}, state, chance)
                return said if front is None else replace(said, text=f"{front.text} {said.text}")
        roles = {**hearing.values, **({"thing": repair.thing} if repair.thing else {})}
        kind = "meant" if repair.kind == "why" else repair.kind
        groups = ["thing"] * bool(repair.thing) + ["say"]
        line = self._choose(_Source(self._phrases.plain[f"repair_{kind}"].lines(*groups)), roles, state, chance)
        return None if line is None else _said(line, roles, replace(state, asked=None))

    def _say(self, hearing: Hearing, state: State, chance: random.Random) -> Answer:
        found = self._first(hearing, state, chance)
        return found or Answer("Mhm.", state.toned(hearing.tone, hearing.lasts))  # all phrases were said lately

    def _first(self, hearing: Hearing, state: State, chance: random.Random, *, firm: bool = False) -> Answer | None:
        """Return the first usable answer; with `firm`, the first that is specific to the utterance."""
        for source in _with_fewer_questions(self._sources(hearing, state, chance), state):
            roles = hearing.values
            line = None if firm and source.weak else self._choose(source, roles, state, chance)
            if line is None:
                continue
            after = state.toned(*((hearing.tone, hearing.lasts) if hearing.tone else (source.tone, LASTING)))
            after = replace(after, asked=source.asked or state.asked)
            after = replace(after, asks=after.asks and "silencing" not in hearing.tags)
            if source.stance:
                after = replace(after, stances={**state.stances, roles["thing"].lower(): source.stance})
            return replace(_said(line, roles, after), weak=source.weak)
        return None

    def _choose(self, source: _Source, roles: Mapping[str, str], state: State, chance: random.Random) -> Line | None:
        """Return a line from the first group with a usable line: all roles are known, and it was not said lately."""
        for lines in source.groups:
            known = [line for line in lines if line.roles <= roles.keys()]
            fit = [line for line in known if not _said_lately(line.text, filled(line.text, roles), state)]
            if not state.asks:
                fit = [line for line in fit if not line.asks] or fit
            if fit:
                return chance.choice([line for line in fit if line.roles] or fit)
        return None

    def _sources(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the groups of phrases from each row of order.yaml whose tags fit the utterance."""
        for row in self._phrases.order:
            if not (row.needs <= hearing.tags and not (row.without & hearing.tags)):
                continue
            special = getattr(self, f"_{row.group[1:]}", None) if row.group.startswith("@") else None
            if special is not None:
                yield from special(hearing, state, chance)
            elif row.group.startswith("@"):  # the reactions that belong to the agent's question
                then = state.pending.then.get(row.group[1:], ()) if state.pending is not None else ()
                yield _Source([[Line(text, frozenset()) for text in then]])
            else:
                lists = (hearing.tongue, hearing.tone or state.tone, "say")
                yield _Source(self._phrases.plain[row.group].lines(*lists))

    def _asked(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the answers to a question or request, by its kind and its area of life."""
        asked = hearing.asked
        if asked is not None:
            about = asked.kind, "" if asked.area is None else asked.area.name
            question = "" if "again" in hearing.tags else hearing.asking
            yield _Source(asked.lines(self._phrases, hearing.tone or state.tone, question), asked=about)

    def _response(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the replies that suit the utterance, the best first. After two questions, a reply with a third question
        ranks lower."""
        asked = len(state.said) > 1 and all(text.endswith("?") for text in state.said[-2:])
        for one in sorted(hearing.responses, key=lambda one: (THIRD if asked and one.line.asks else 0.0) - one.rank):
            yield _Source([[one.line]], one.weak, "" if one.weak or one.kind.tone == "funny" else one.kind.tone)

    def _opinion(self, hearing: Hearing, state: State, chance: random.Random) -> Iterator[_Source]:
        """Yield the agent's opinion, which is chosen once per conversation. The agent does not judge people."""
        stances = self._phrases.plain["stances"]
        hearing.values["thing"] = hearing.thing
        before = state.stances.get(hearing.thing.lower())
        if before is not None:
            yield _Source([[stances.groups["as_before"][STANCES.index(before)]]])
        stance = chance.choices(STANCES, (5, 3, 2))[0]
        yield _Source(stances.lines(before or stance), stance=before or stance)


def _said_lately(template: str, text: str, state: State) -> bool:
    """Return whether a phrase was said lately. A sign of listening may return sooner than other phrases."""
    lately = BRIEFLY if len(text) <= BRIEF else len(state.said)
    return text in state.said[-lately:] or (len(text) > BRIEF and template in state.recent)


def _with_fewer_questions(sources: Iterator[_Source], state: State) -> Iterator[_Source]:
    """Yield the sources. During a game, or if the user wants no questions, move the questions in these sources to the
    end."""
    later: list[_Source] = []
    for source in sources:
        if not state.asks or state.game is not None:
            later.append(source)
            source = replace(source, groups=[[line for line in lines if not line.asks] for lines in source.groups])
        yield source
    yield from later


def _said(line: Line, roles: Mapping[str, str], state: State) -> Answer:
    text = filled(line.text, roles)
    then: Mapping[str, tuple[str, ...]] = {
        name: tuple(filled(one, roles) for one in texts) for name, texts in line.then.items()
    }
    pending = Pending(text, then, line.start) if text.endswith("?") else None
    return Answer(text, replace(state.having_said(line.text, text), pending=pending))
