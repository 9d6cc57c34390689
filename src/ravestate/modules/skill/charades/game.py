"""The state of a game, and its transitions.

`MOVES` lists the moves that the user may make in each step, and `ANYWHERE` the moves in every step of a game. `play`
maps a state and a move to the next state, and to the agent's words, feelings and actions. This file knows no rules,
slots or clock.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal

from ravestate.modules.modality.emotion.feeling import Feeling

from .riddles import RIDDLES
from .understanding import Move

Step = Literal[
    "off", "offered", "choosing", "counting", "watching", "guessed", "asked", "unseen", "blind", "between", "riddle"
]
WAITING = frozenset({"offered", "choosing", "guessed", "asked", "unseen", "blind", "between", "riddle"})
"""The steps in which the agent waits for the user."""
GUESSES = 2
"""The maximum number of guesses of each player. If the agent has seen nothing this many times in a row, it offers a
riddle."""


@dataclass(frozen=True, slots=True)
class Game:
    """The state of a game."""

    step: Step = "off"
    turn: int = 0
    """The number of transitions so far."""
    reminded: bool = False
    """Whether the agent has repeated its question."""
    agent: int = 0
    """The agent's points."""
    user: int = 0
    """The user's points."""
    ranked: tuple[str, ...] = ()
    """The agent's guesses in this round, best first."""
    guess: int = 0
    """The number of guesses before the present guess in this round, by the player who guesses. A hint counts as a guess."""
    doubts: int = 0
    """The number of unclear answers to this guess."""
    blank: int = 0
    """The number of times in a row that the agent has seen nothing."""
    start: float = 0.0
    """The time when the agent began to watch, in seconds since the context began."""
    end: float = 0.0
    riddle: str = ""
    """The activity that the user must guess."""
    shown: bool = False
    """Whether the agent's body performed this activity."""
    posed: frozenset[str] = frozenset()
    """The riddles of this game so far."""

    @property
    def is_on(self) -> bool:
        """Whether a game is on, or the agent has offered a game."""
        return self.step != "off"

    @property
    def is_waiting(self) -> bool:
        """Whether the agent waits for the user's move."""
        return self.step in WAITING

    @property
    def name(self) -> str:
        """The agent's present guess, or the solution of its riddle."""
        if self.step == "riddle":
            return self.riddle
        return self.ranked[self.guess] if self.guess < len(self.ranked) else ""

    @property
    def words(self) -> Mapping[str, object]:
        """The parameters of all phrases."""
        riddle = RIDDLES.get(self.riddle)
        clues = {"riddle": riddle.text, "hint": riddle.hint} if riddle else {}
        return {"name": self.name, "agent": self.agent, "user": self.user, **clues}

    @property
    def question(self) -> str:
        """The name of the phrase that repeats the agent's question."""
        return "back_gesture" if self.step == "riddle" and self.shown else f"back_{self.step}"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The result of a move."""

    game: Game
    say: str = ""
    """The name of a phrase; empty for none."""
    words: Mapping[str, object] = field(default_factory=dict[str, object])
    feeling: Feeling | None = None
    counts: bool = False
    """Whether the countdown begins."""
    lesson: str = ""
    """The name of the movement that the recogniser must learn."""
    performs: str = ""
    """The activity that the agent's body must perform."""


@dataclass(frozen=True, slots=True)
class World:
    """The surroundings of the game: all inputs of a transition except the state and the move."""

    chance: random.Random
    gestures: frozenset[str] = frozenset()
    """The activities that the agent's body can perform."""
    in_view: bool = False
    """Whether a camera sees the user's body."""


def play(game: Game, move: Move, world: World) -> Outcome:
    """Return the result of a move.

    If the move is impossible in this step, the state stays as it is, and the agent repeats its question.
    """
    found = MOVES.get((game.step, move.kind)) or ANYWHERE.get(move.kind) or _repeat
    out = found(game, move, world)
    return replace(out, game=replace(out.game, turn=game.turn + 1))


def guessed(game: Game, ranked: tuple[str, ...], world: World) -> Outcome:
    """Return the agent's first guess, after it has watched.

    Args:
        game: The state.
        ranked: The names of the activities that the agent has seen, best first.
        world: The surroundings.
    """
    game = replace(game, ranked=ranked[:GUESSES], guess=0, doubts=0, reminded=False, turn=game.turn + 1)
    if ranked:
        return _said(replace(game, step="guessed", blank=0), "guess")
    if world.in_view:
        return _said(replace(game, step="asked", blank=0), "never_seen", "surprised")
    blank = game.blank + 1
    return _said(replace(game, step="unseen" if blank < GUESSES else "blind", blank=blank), *_UNSEEN[blank < GUESSES])


_UNSEEN: Mapping[bool, tuple[str, Feeling]] = {True: ("unseen", "shy"), False: ("blind", "sad")}


def _said(game: Game, say: str, feeling: Feeling | None = None, **more: Any) -> Outcome:
    return Outcome(replace(game, reminded=False), say, {**game.words, **more.pop("words", {})}, feeling, **more)


def _over(game: Game, say: str, feeling: Feeling | None = None) -> Outcome:
    return Outcome(Game(turn=game.turn), say, game.words, feeling)


def _offer(game: Game, move: Move, world: World) -> Outcome:
    return _said(Game("offered", turn=game.turn), "offer")


def _begin(game: Game, move: Move, world: World) -> Outcome:
    return _said(Game("choosing", turn=game.turn), "begin", "happy")


def _choose(game: Game, move: Move, world: World) -> Outcome:
    return _said(replace(game, step="choosing"), "begin" if game.step == "offered" else "again")


def _decline(game: Game, move: Move, world: World) -> Outcome:
    return _over(game, "declined")


def _count(game: Game, move: Move, world: World) -> Outcome:
    return Outcome(replace(game, step="counting", reminded=False), counts=True)


def _explain(game: Game, move: Move, world: World) -> Outcome:
    return _said(game, "rules")


def _wait(game: Game, move: Move, world: World) -> Outcome:
    return _said(replace(game, step="choosing"), "wait")


def _tell_score(game: Game, move: Move, world: World) -> Outcome:
    return _said(game, "score")


def _right(game: Game, move: Move, world: World) -> Outcome:
    return _said(replace(game, step="between", agent=game.agent + 1), "right", "happy", words={"name": game.name})


def _wrong(game: Game, move: Move, world: World) -> Outcome:
    if move.name:
        return _told(game, move, world)
    following = replace(game, guess=game.guess + 1, doubts=0)
    if following.name:
        return _said(following, "guess_again", "surprised")
    return _said(replace(following, step="asked"), "what_was_it", "sad")


def _doubt(game: Game, move: Move, world: World) -> Outcome:
    if game.doubts:
        return _wrong(game, Move("no"), world)
    return _said(replace(game, doubts=1), "unclear")


def _told(game: Game, move: Move, world: World) -> Outcome:
    after = replace(game, step="between", user=game.user + 1)
    say, lesson = ("learnt", move.name) if world.in_view else ("conceded", "")
    return _said(after, say, "surprised", words={"name": move.name}, lesson=lesson)


def _keep_secret(game: Game, move: Move, world: World) -> Outcome:
    return _said(replace(game, step="between", user=game.user + 1), "secret", "shy")


def _ask_again(game: Game, move: Move, world: World) -> Outcome:
    return _keep_secret(game, move, world) if game.doubts else _said(replace(game, doubts=1), "what_now")


def _pose(game: Game, move: Move, world: World) -> Outcome:
    """Set a riddle that the user has not had yet, with a gesture if the agent has a body."""
    names = world.gestures & RIDDLES.keys() or RIDDLES.keys()
    fresh = sorted(names - game.posed) or sorted(names)
    name = world.chance.choice(fresh)
    shown = name in world.gestures
    game = replace(game, step="riddle", riddle=name, shown=shown, guess=0, posed=game.posed | {name})
    return _said(game, "gesture" if shown else "riddle", "happy", performs=name if shown else "")


def _user_guesses(game: Game, move: Move, world: World) -> Outcome:
    if move.name == game.riddle:
        after = replace(game, step="between", user=game.user + 1)
        return _said(after, "solved", "happy", words={"name": game.riddle})
    return _give_hint(game, move, world, "hint")


def _give_hint(game: Game, move: Move, world: World, say: str = "help") -> Outcome:
    if game.guess + 1 >= GUESSES:
        return _reveal(game, move, world)
    return _said(replace(game, guess=game.guess + 1), say)


def _reveal(game: Game, move: Move, world: World) -> Outcome:
    after = replace(game, step="between", agent=game.agent + 1)
    return _said(after, "told", "shy", words={"name": game.riddle})


def _finish(game: Game, move: Move, world: World) -> Outcome:
    return _over(game, "thanks", "affectionate")


def _stop(game: Game, move: Move, world: World) -> Outcome:
    return _over(game, "declined" if game.step == "offered" else "thanks_anyway", "affectionate")


def _leave(game: Game, move: Move, world: World) -> Outcome:
    return _over(game, "")


def _repeat(game: Game, move: Move, world: World) -> Outcome:
    return _said(game, game.question) if game.is_waiting else Outcome(game)


def _lapse(game: Game, move: Move, world: World) -> Outcome:
    """Handle silence: ask once more, then end the game."""
    if not game.reminded:
        return replace(_repeat(game, move, world), game=replace(game, reminded=True))
    return _over(game, "lapsed")


Transition = Callable[[Game, Move, World], Outcome]

MOVES: Mapping[tuple[Step, str], Transition] = {
    ("off", "wanted"): _begin,
    ("off", "play"): _offer,
    ("offered", "yes"): _begin,
    ("offered", "ready"): _begin,
    ("offered", "wanted"): _begin,
    ("offered", "swap"): _pose,
    ("offered", "no"): _decline,
    ("offered", "silence"): _leave,
    ("choosing", "yes"): _count,
    ("choosing", "ready"): _count,
    ("choosing", "silence"): _count,
    ("choosing", "no"): _wait,
    ("choosing", "wait"): _wait,
    ("choosing", "swap"): _pose,
    ("counting", "wait"): _wait,
    ("counting", "no"): _wait,
    ("watching", "wait"): _wait,
    ("guessed", "yes"): _right,
    ("guessed", "no"): _wrong,
    ("guessed", "unclear"): _doubt,
    ("guessed", "named"): _wrong,
    ("asked", "named"): _told,
    ("asked", "secret"): _keep_secret,
    ("asked", "no"): _keep_secret,
    ("asked", "unclear"): _ask_again,
    ("unseen", "yes"): _count,
    ("unseen", "ready"): _count,
    ("unseen", "no"): _finish,
    ("unseen", "swap"): _pose,
    ("unseen", "wait"): _wait,
    ("blind", "yes"): _pose,
    ("blind", "swap"): _pose,
    ("blind", "ready"): _pose,
    ("blind", "no"): _finish,
    ("between", "yes"): _choose,
    ("between", "ready"): _choose,
    ("between", "wanted"): _choose,
    ("between", "swap"): _pose,
    ("between", "no"): _finish,
    ("riddle", "named"): _user_guesses,
    ("riddle", "unclear"): _give_hint,
    ("riddle", "hint"): _give_hint,
    ("riddle", "gives_up"): _reveal,
    ("riddle", "swap"): _repeat,
}
"""Step and move → the transition. If a move is neither here nor in `ANYWHERE`, the agent repeats its question."""

ANYWHERE: Mapping[str, Transition] = {
    "rules": _explain,
    "score": _tell_score,
    "stop": _stop,
    "farewell": _leave,
    "silence": _lapse,
    "repeat": _repeat,
}
"""A move that is possible in every step of a game → the transition."""


def moves_of(step: Step) -> frozenset[str]:
    """Return the moves of a step."""
    own = frozenset(kind for of, kind in MOVES if of == step)
    return own if step == "off" else own | ANYWHERE.keys()
