"""Jokes, songs and stories, and small games: riddles, word chain, guessing an animal, knock knock."""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ravestate.modules.meta.nlp.analysis import Analysis

from .state import Game, State

TOLD = {"joke": "jokes", "song": "songs", "story": "stories"}
"""The lists of performances without a game, by the user's request."""
LONGEST = 6
"""The words of an utterance that may belong to a game."""

Played = tuple[str, State]


class Games:
    """The performances of the listener."""

    def __init__(self, shows: Mapping[str, Any]) -> None:
        """`shows`: the jokes, songs, stories, riddles and words of the games."""
        self._shows = shows
        self._riddles = {one["ask"]: one for one in shows["riddles"]}

    def start(self, kind: str, state: State, chance: random.Random) -> Played:
        """Begin a joke, a song, a story or a game; ``play`` offers a choice."""
        if kind in TOLD:
            return self._new(kind, self._shows[TOLD[kind]], state, chance)
        if kind == "riddle":
            text, state = self._new(kind, tuple(self._riddles), state, chance)
            return text, replace(state, game=Game("riddle", text))
        if kind == "chain":
            word = chance.choice(self._shows["chain"])
            text = chance.choice(self._shows["chain_words"]["start"]).format(word=word)
            return text, replace(state, game=Game("chain", word, (word,)), show=kind)
        if kind == "animal":
            question = next(iter(self._shows["animals"]["questions"]))
            text = chance.choice(self._shows["animal_words"]["start"]).format(question=self._question(question))
            return text, replace(state, game=Game("animal", question), show=kind)
        return chance.choice(self._shows["offer"]), replace(state, game=Game("choice"))

    def named(self, text: str, *, most: int = 3) -> str:
        """Return the performance that a text of at most so many words names: *word chain*, *a riddle please*."""
        words = re.findall(r"[a-z]+", text.lower()) or [""]
        said = f" {' '.join(words)} "
        names = self._shows["names"].items()
        return next(
            (
                kind
                for kind, listed in names
                if len(words) <= most and words[0] != "no" and any(f" {one} " in said for one in listed)
            ),
            "",
        )

    def knocks(self, text: str) -> bool:
        """Return whether the user begins a knock-knock joke."""
        return " ".join(re.findall(r"[a-z]+", text.lower())) in self._shows["knock"]["call"]

    def knock(self, state: State) -> Played:
        """Ask who is there."""
        return self._shows["knock"]["there"], replace(state, game=Game("knock"))

    def stop(self, state: State, chance: random.Random) -> Played:
        """End the game."""
        return chance.choice(self._shows["over"]), replace(state, game=None)

    def play(self, text: str, seen: Analysis | None, state: State, chance: random.Random) -> Played | None:
        """Return the next move; None if the utterance does not belong to the game."""
        game = state.game
        words = re.findall(r"[^\W\d_]+", text.lower())
        if game is None or not words or (len(words) > LONGEST and game.kind != "knock"):
            return None
        return getattr(self, f"_play_{game.kind}")(game, words, seen, state, chance)

    def _play_choice(
        self, game: Game, words: Sequence[str], seen: Analysis | None, state: State, chance: random.Random
    ) -> Played | None:
        wanted = {"riddle": "riddle", "riddles": "riddle", "chain": "chain", "word": "chain", "words": "chain"}
        wanted |= {"animal": "animal", "animals": "animal", "guess": "animal", "guessing": "animal"}
        wanted |= {"first": "riddle", "second": "chain", "third": "animal", "last": "animal"}
        for word in words:
            if word in wanted:
                return self.start(wanted[word], state, chance)
        if _yes(seen) or "any" in words or "choose" in words:
            return self.start(chance.choice(("riddle", "chain", "animal")), state, chance)
        return self.stop(state, chance) if _no(seen) else None

    def _play_riddle(
        self, game: Game, words: Sequence[str], seen: Analysis | None, state: State, chance: random.Random
    ) -> Played | None:
        if not game.word:  # "Another one?"
            if _yes(seen):
                return self.start("riddle", state, chance)
            return self.stop(state, chance) if _no(seen) else None
        riddle, say = self._riddles[game.word], self._shows["riddle_words"]
        answer = riddle["answers"][0]
        lemmas = {word.lemma.lower() for word in seen.tree.words} if seen else set[str]()
        after = replace(state, game=Game("riddle"))
        if lemmas.union(words).intersection(riddle["answers"]):
            return chance.choice(say["right"]).format(answer=answer), after
        if seen is not None and (seen.yesno.unsure or _no(seen) or "give" in lemmas or "tell" in lemmas):
            return chance.choice(say["tell"]).format(answer=answer, Answer=answer.capitalize()), after
        if seen is not None and seen.question is not None and len(words) > 4:
            return None
        if game.turn:
            return chance.choice(say["again"]).format(answer=answer), after
        text = chance.choice(say["wrong"]).format(hint=riddle["hint"])
        return text, replace(state, game=replace(game, turn=1))

    def _play_chain(
        self, game: Game, words: Sequence[str], seen: Analysis | None, state: State, chance: random.Random
    ) -> Played | None:
        say, letter = self._shows["chain_words"], game.word[-1]
        if len(words) > 2 or (_no(seen) and words[0][0] != letter):
            return self.stop(state, chance) if _no(seen) else None
        word = words[-1]
        if word[0] != letter:
            if game.turn:
                return None
            text = chance.choice(say["wrong"]).format(letter=letter.upper())
            return text, replace(state, game=replace(game, turn=1))
        if word in game.used:
            return chance.choice(say["used"]).format(letter=letter.upper()), state
        used = (*game.used, word)
        mine = [one for one in self._shows["chain"] if one[0] == word[-1] and one not in used]
        if not mine:
            return chance.choice(say["lost"]).format(letter=word[-1].upper()), replace(state, game=None)
        own = chance.choice(mine)
        text = chance.choice(say["next"]).format(word=own.capitalize())
        return text, replace(state, game=Game("chain", own, (*used, own)))

    def _play_animal(
        self, game: Game, words: Sequence[str], seen: Analysis | None, state: State, chance: random.Random
    ) -> Played | None:
        say, known = self._shows["animal_words"], self._shows["animals"]["known"]
        yes, no = _yes(seen), _no(seen)
        if not game.word:  # it was guessed, or given up
            if game.turn == 2 or not (yes or no):
                return chance.choice(say["learnt"]), replace(state, game=None)
            return self.start("animal", state, chance) if yes else self.stop(state, chance)
        unsure = seen is not None and bool(seen.yesno.unsure)
        if not (yes or no or unsure):
            return None
        if game.word in known:  # "Is it a cat?"
            if yes:
                return chance.choice(say["right"]), replace(state, game=Game("animal", turn=1))
            return chance.choice(say["lost"]), replace(state, game=Game("animal", turn=2))
        used = (*game.used, f"{'+' if yes else '-' if no else '?'}{game.word}")
        left = [
            animal
            for animal, traits in known.items()
            if all(one[0] == "?" or (one[1:] in traits) == (one[0] == "+") for one in used)
        ]
        asked = {one[1:] for one in used}
        best = [name for name in self._shows["animals"]["questions"] if name not in asked]
        best.sort(key=lambda name: abs(2 * sum(name in known[one] for one in left) - len(left)))
        if len(left) > 1 and best:
            text = chance.choice(say["next"]).format(question=self._question(best[0]))
            return text, replace(state, game=Game("animal", best[0], used))
        if left:
            text = chance.choice(say["guess"]).format(animal=left[0])
            return text, replace(state, game=Game("animal", left[0], used))
        return chance.choice(say["lost"]), replace(state, game=Game("animal", turn=2))

    def _play_knock(
        self, game: Game, words: Sequence[str], seen: Analysis | None, state: State, chance: random.Random
    ) -> Played | None:
        say = self._shows["knock"]
        if game.word:
            return chance.choice(say["laugh"]), replace(state, game=None)
        name = " ".join(words[:4])
        return say["who"].format(name=name.capitalize()), replace(state, game=Game("knock", name))

    def _question(self, name: str) -> str:
        return self._shows["animals"]["questions"][name]

    def _new(self, kind: str, listed: Sequence[str], state: State, chance: random.Random) -> Played:
        """Return one that was not shown yet, as long as there is one."""
        left = [one for one in listed if one not in state.shown]
        text = chance.choice(left or listed)
        shown = state.shown if left else tuple(one for one in state.shown if one not in listed)
        return text, replace(state, shown=(*shown, text), show=kind, game=None)


def _yes(seen: Analysis | None) -> bool:
    return seen is not None and bool(seen.yesno.yes)


def _no(seen: Analysis | None) -> bool:
    return seen is not None and bool(seen.yesno.no)
