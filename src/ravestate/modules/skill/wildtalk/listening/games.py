"""Jokes, songs and stories, and small games: riddles, word chain, guessing an animal, knock knock."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ravestate.modules.meta.nlp.analysis import Analysis

from .state import Game, State

LONGEST = 6
"""The maximum number of words in an utterance that may belong to a game."""
CHAINED = 2
"""The maximum number of words in the user's turn of word chain: *a tiger*."""

HOLDER = re.compile(r"\b(?:think of|pick|choose) (?:an|some|any) animal\b")
"""The user asks the agent to think of an animal, which the user will guess."""
GUESSER = re.compile(r"\b(?:i|i'll|i will) (?:think of|pick|choose|have) (?:an|some|any) animal\b")
"""The user says that they think of an animal, which the agent will guess."""

Played = tuple[str, State]


def named(shows: Mapping[str, Any], text: str, *, most: int = 3) -> str:
    """Return the performance that a text names: *word chain*, *a riddle please*; empty beyond `most` words."""
    low = text.lower()
    if GUESSER.search(low) or HOLDER.search(low):
        return "animal" if GUESSER.search(low) else "holder"
    words = re.findall(r"[a-z]+", low)
    said = f" {' '.join(words)} "
    if not words or len(words) > most or words[0] == "no":
        return ""
    return next((kind for kind, names in shows["names"].items() if any(f" {one} " in said for one in names)), "")


class Turn:
    """One turn of a performance (a joke, song, story or game): the user's words, and the methods that answer."""

    def __init__(
        self, shows: Mapping[str, Any], text: str, seen: Analysis | None, state: State, chance: random.Random
    ) -> None:
        """`shows`: the jokes, songs, stories, riddles and words of the games."""
        self._shows, self._seen, self._state, self._chance = shows, seen, state, chance
        self._words = re.findall(r"[^\W\d_]+", text.lower())
        answer = None if seen is None else seen.yesno
        self._yes, self._no = answer is not None and bool(answer.yes), answer is not None and bool(answer.no)
        self._unsure = answer is not None and bool(answer.unsure)

    def start(self, kind: str) -> Played:
        """Begin a joke, a song, a story or a game; ``play`` offers a choice."""
        if kind in self._shows["told"]:
            return self._tell(kind, self._shows["told"][kind])
        if kind == "riddle":
            text, state = self._new(kind, [one["ask"] for one in self._shows["riddles"]])
            return text, replace(state, game=Game("riddle", text))
        if kind == "chain":
            word = self._chance.choice(self._shows["chain"]["words"])
            return self._say("chain", "start", Game("chain", word, (word,)), word=word)
        if kind == "animal":
            question, text = next(iter(self._shows["animal"]["questions"].items()))
            return self._say("animal", "start", Game("animal", question), question=text)
        if kind == "holder":
            return self._say(kind, "start", Game(kind, self._chance.choice(list(self._shows["animal"]["known"]))))
        return self._say(kind, "start", Game(kind))

    def stop(self) -> Played:
        """End the game."""
        return self._say("play", "over", None)

    def gives_up(self) -> bool:
        """Return whether the user wants the solution: *I give up*."""
        game = self._state.game
        return game is not None and game.word != "" and game.kind in ("riddle", "holder") and "give" in self._words

    def move(self) -> Played | None:
        """Return the agent's next turn; None if the utterance does not belong to the game."""
        game = self._state.game
        if game is None or not self._words:
            return None
        if len(self._words) > LONGEST and game.kind not in ("knock", "holder") and not self.solves():
            return None
        if not game.word and game.kind != "play" and not (game.kind == "knock" or game.turn == 2):  # "Another one?"
            return self.start(game.kind) if self._yes else self.stop() if self._no else self._learnt(game)
        moves = {"play": self._choice, "riddle": self._riddle, "chain": self._chain, "animal": self._animal}
        moves["holder"] = self._holder
        return moves.get(game.kind, self._knock)(game)

    def _learnt(self, game: Game) -> Played | None:
        return self._say("animal", "learnt", None) if game.kind == "animal" else None

    def _choice(self, game: Game) -> Played | None:
        kinds: Mapping[str, Sequence[str]] = self._shows["play"]["kinds"]
        wanted = next((kind for kind, names in kinds.items() if set(names).intersection(self._words)), "")
        if wanted or self._yes or {"any", "choose"}.intersection(self._words):
            return self.start(wanted or self._chance.choice(list(kinds)))
        return self.stop() if self._no else None

    def _lemmas(self) -> set[str]:
        return {*self._words, *(word.lemma.lower() for word in (self._seen.tree.words if self._seen else ()))}

    def solves(self) -> bool:
        """Return whether the utterance, however long, contains the solution of the riddle."""
        game = self._state.game
        if game is None or game.kind != "riddle":
            return False
        answers = [one["answers"] for one in self._shows["riddles"] if one["ask"] == game.word]
        return bool(answers and self._lemmas().intersection(answers[0]))

    def _holder(self, game: Game) -> Played | None:
        """Answer a question about the animal that the agent thinks of."""
        known, lemmas = self._shows["animal"]["known"], self._lemmas()
        guess = next((one for one in known if one.split()[-1] in lemmas), "")
        if guess == game.word:
            return self._say("holder", "right", Game("holder"), animal=game.word)
        if not guess and (self._unsure or lemmas & {"give", "tell"}):
            return self._say("holder", "tell", Game("holder"), animal=game.word)
        trait = next((name for name, words in self._shows["holder"]["traits"].items() if lemmas & set(words)), "")
        if guess or trait:
            return self._say("holder", "yes" if trait in known[game.word] and not guess else "no", game)
        return self._say("holder", "unsure", game) if self._seen is not None and self._seen.question else None

    def _riddle(self, game: Game) -> Played | None:
        riddle = next(one for one in self._shows["riddles"] if one["ask"] == game.word)
        answer, over, seen, lemmas = riddle["answers"][0], Game("riddle"), self._seen, self._lemmas()
        if lemmas.intersection(riddle["answers"]):
            return self._say("riddle", "right", over, answer=answer)
        if self._unsure or self._no or lemmas & {"give", "tell", "know"}:
            return self._say("riddle", "tell", over, answer=answer, Answer=answer.capitalize())
        if seen is not None and seen.question is not None and len(self._words) > 4:
            return None
        if game.turn:
            return self._say("riddle", "again", over, answer=answer)
        return self._say("riddle", "wrong", replace(game, turn=1), hint=riddle["hint"])

    def _chain(self, game: Game) -> Played | None:
        word, letter = self._words[-1], game.word[-1]
        if len(self._words) > CHAINED or word[0] != letter:
            if self._no:
                return self.stop()
            if game.turn or len(self._words) > CHAINED:
                return None
            return self._say("chain", "wrong", replace(game, turn=1), letter=letter.upper())
        if word in game.used:
            return self._say("chain", "used", game, letter=letter.upper())
        used = (*game.used, word)
        mine = [one for one in self._shows["chain"]["words"] if one[0] == word[-1] and one not in used]
        if not mine:
            return self._say("chain", "lost", None, letter=word[-1].upper())
        own = self._chance.choice(mine)
        return self._say("chain", "next", Game("chain", own, (*used, own)), word=own.capitalize())

    def _animal(self, game: Game) -> Played | None:
        known, questions = self._shows["animal"]["known"], self._shows["animal"]["questions"]
        if not game.word:  # the user has named the animal
            return self._learnt(game)
        if not (self._yes or self._no or self._unsure):
            return None
        if game.word in known:  # "Is it a cat?"
            return self._say("animal", *(("right", Game("animal")) if self._yes else ("lost", Game("animal", turn=2))))
        used = (*game.used, f"{'+' if self._yes else '-' if self._no else '?'}{game.word}")
        left = [
            animal
            for animal, traits in known.items()
            if all(one[0] == "?" or (one[1:] in traits) == (one[0] == "+") for one in used)
        ]
        best = [name for name in questions if name not in {one[1:] for one in used}]
        best.sort(key=lambda name: abs(2 * sum(name in known[one] for one in left) - len(left)))
        if len(left) > 1 and best:
            return self._say("animal", "next", Game("animal", best[0], used), question=questions[best[0]])
        if left:
            return self._say("animal", "guess", Game("animal", left[0], used), animal=left[0])
        return self._say("animal", "lost", Game("animal", turn=2))

    def _knock(self, game: Game) -> Played:
        if game.word:
            return self._say("knock", "laugh", None)
        name = " ".join(self._words[:4])
        return self._say("knock", "who", Game("knock", name), name=name.capitalize())

    def _say(self, kind: str, group: str, game: Game | None, **roles: str) -> Played:
        """Return a phrase of the performance `kind`, and the state with the game after it."""
        show = self._state.show if kind in ("play", "knock") else kind
        return self._chance.choice(self._shows[kind][group]).format(**roles), replace(self._state, game=game, show=show)

    def _tell(self, kind: str, listed: Sequence[str]) -> Played:
        """Tell a joke or story about the subject that the user wants: *a story with a snail*."""
        tree = None if self._seen is None else self._seen.tree
        about = [word for word in tree.words if word.low in ("about", "with", "of")] if tree else []
        wanted = tree.children_of(about, "pobj")[:1] if tree else []
        fit = [one for one in listed if any(word.lemma.lower() in one.lower() for word in wanted)]
        text, state = self._new(kind, fit or listed)
        if tree and wanted and not fit:
            thing = tree.phrase(tree.subtree(wanted[0]))
            text = f"{self._chance.choice(self._shows['without']).format(thing=thing)} {text}"
        return text, state

    def _new(self, kind: str, listed: Sequence[str]) -> Played:
        """Return a performance that was not shown yet. When all have been shown, start again."""
        left = [one for one in listed if one not in self._state.shown]
        text = self._chance.choice(left or listed)
        shown = self._state.shown if left else tuple(one for one in self._state.shown if one not in listed)
        return text, replace(self._state, shown=(*shown, text), show=kind, game=None)
