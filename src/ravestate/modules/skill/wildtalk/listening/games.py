"""Jokes, songs and stories, and small games: riddles, word chain, guessing an animal, knock knock.

In word chain, each word begins with the last letter of the word before.
"""

from __future__ import annotations

import random
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ravestate.modules.meta.nlp.analysis import Analysis

from .state import Game, State
from .wishes import Wish, fitting

LONGEST = 6
"""The maximum number of words in a turn of most games. The solution of a riddle may have more words."""
CHAINED = 2
"""The maximum number of words in the user's turn of word chain: *a tiger*."""
CHAINING = 6
"""The maximum number of words in a turn of word chain that has a verb such as *say*: *then I say tiger*."""

RULES = re.compile(
    r"\brules?\b|\bhow (?:do|does|did|is|to|can|should|am) (?:it|that|this|i|we|one|the game|play)\b.*(?:work|go|play|do|win|\bit\b)"
    r"|\bhow to play\b|\bwhat (?:do|must|should|shall|am|can) i (?:have to |need to |supposed to |now )*(?:do|say|ask)\b|\bexplain\b"
    r"|\bdon't (?:get|understand) (?:it|this|that|the game)\b|\bhow does\b.*\bgame\b|^\W*how\W*$",
    re.IGNORECASE,
)
"""A question about the rules of the game."""
THINKING = re.compile(
    r"\b(?:hold on|wait|let me think|thinking|(?:one|a) (?:moment|second|sec|minute)|give me (?:a|some|one)|tough|hard|tricky"
    r"|difficult|not easy)\b|^\W*h?m+\W*$",
    re.IGNORECASE,
)
"""The user needs more time for their turn."""
_IT = frozenset(("it", "its", "it's", "was"))
HINT = re.compile(r"\b(?:hint|clue|tip|help me)\b", re.IGNORECASE)
_MOVING = frozenset(("be", "say", "take", "go", "have", "then", "choose", "pick"))
"""Verbs around a word of word chain: *then I say tiger*."""

Played = tuple[str, State]


class Turn:
    """One turn of a performance (a joke, song, story or game): the user's words, and the methods that answer."""

    def __init__(
        self, shows: Mapping[str, Any], text: str, seen: Analysis | None, state: State, chance: random.Random
    ) -> None:
        """`shows`: the jokes, songs, stories, riddles and words of the games."""
        self._shows, self._seen, self._state, self._chance = shows, seen, state, chance
        self._text, self._words = text, re.findall(r"[^\W\d_]+", text.lower())
        answer = None if seen is None else seen.yesno
        self._yes, self._no = answer is not None and bool(answer.yes), answer is not None and bool(answer.no)
        self._unsure = answer is not None and bool(answer.unsure)

    def start(self, wish: Wish) -> Played:
        """Begin a joke, a song, a story or a game; ``play`` offers a choice."""
        kind = wish.kind
        if kind in self._shows["told"]:
            return self._tell(wish, self._shows["told"][kind])
        if kind == "riddle":
            about = {one["ask"]: " ".join((one["ask"], *one["answers"], one["hint"])) for one in self._shows["riddles"]}
            fit = fitting(self._shows, wish, about.values())
            text, state = self._new(kind, [ask for ask, whole in about.items() if whole in fit or not fit])
            front = self._without(wish) if wish.thing and not fit else ""
            return f"{front}{text}", replace(state, game=Game("riddle", text))
        if kind == "chain":
            word = self._chance.choice(self._shows["chain"]["words"])
            return self._say("chain", "start", Game("chain", word, (word,)), word=word)
        if kind == "animal":
            question, text = next(iter(self._shows["animal"]["questions"].items()))
            return self._say("animal", "start", Game("animal", question), question=text)
        if kind == "holder":
            return self._say(kind, "start", Game(kind, self._chance.choice(list(self._shows["animal"]["known"]))))
        if wish.thing:
            thing = wish.thing[:1].upper() + wish.thing[1:]
            return self._say(kind, "without", Game(kind), thing=wish.thing, Thing=thing)
        return self._say(kind, "start", Game(kind))

    def stop(self) -> Played:
        """End the game."""
        return self._say("play", "over", None)

    def gives_up(self) -> bool:
        """Return whether the user wants the solution: *I give up*."""
        game = self._state.game
        return game is not None and game.word != "" and game.kind in ("riddle", "holder") and "give" in self._words

    def chains(self) -> bool:
        """Return whether the utterance may be a turn of word chain: *a song* may be a word, and no request to sing."""
        return self._state.game is not None and self._state.game.kind == "chain" and len(self._words) <= CHAINED

    def move(self) -> Played | None:
        """Return the agent's next turn; None if the utterance does not belong to the game."""
        game = self._state.game
        if game is None or not self._words:
            return None
        aside = self._aside(game)
        if aside is not None:
            return aside
        if game.asides and game.kind in ("riddle", "knock", "play") and not (self.solves() or self._unsure):
            return None  # the user has left the game
        if len(self._words) > LONGEST and game.kind not in ("knock", "holder", "chain") and not self.solves():
            return None
        if not game.word and game.kind != "play" and not (game.kind == "knock" or game.turn == 2):  # "Another one?"
            return self.start(Wish(game.kind)) if self._yes else self.stop() if self._no else self._learnt(game)
        moves = {"play": self._choice, "riddle": self._riddle, "chain": self._chain, "animal": self._animal}
        moves["holder"] = self._holder
        return moves.get(game.kind, self._knock)(game)

    def _aside(self, game: Game) -> Played | None:
        """Explain the rules of the game, give a hint, or wait for the user; None for other utterances."""
        kind, shows = game.kind, self._shows[game.kind]
        if "rules" in shows and RULES.search(self._text):
            return self._say(kind, "rules", game, word=game.word, letter=game.word[-1:].upper())
        if kind == "riddle" and game.word and HINT.search(self._text) and not self.solves():
            return self._say(kind, "hint", replace(game, turn=1), hint=self._riddle_of(game)["hint"])
        thinks = kind in ("riddle", "chain", "animal", "holder") and game.word and THINKING.search(self._text)
        return self._say("play", "wait", game) if thinks and not self.solves() else None

    def _learnt(self, game: Game) -> Played | None:
        return self._say("animal", "learnt", None) if game.kind == "animal" else None

    def _choice(self, game: Game) -> Played | None:
        kinds: Mapping[str, Sequence[str]] = self._shows["play"]["kinds"]
        wanted = next((kind for kind, names in kinds.items() if set(names).intersection(self._words)), "")
        if wanted or self._yes or {"any", "choose"}.intersection(self._words):
            return self.start(Wish(wanted or self._chance.choice(list(kinds))))
        return self.stop() if self._no else None

    def _lemmas(self) -> set[str]:
        return {*self._words, *(word.lemma.lower() for word in (self._seen.tree.words if self._seen else ()))}

    def solves(self) -> bool:
        """Return whether the utterance, however long, contains the solution of the riddle."""
        game = self._state.game
        if game is None or game.kind != "riddle" or not game.word:
            return False
        return not self._lemmas().isdisjoint(self._riddle_of(game)["answers"])

    def _riddle_of(self, game: Game) -> Mapping[str, Any]:
        return next(one for one in self._shows["riddles"] if one["ask"] == game.word)

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
        riddle = self._riddle_of(game)
        answer, over, seen, lemmas = riddle["answers"][0], Game("riddle"), self._seen, self._lemmas()
        if right := [one for one in riddle["answers"] if one in lemmas]:  # a riddle may have several answers
            return self._say("riddle", "right", over, answer=right[0])
        if self._unsure or self._no or lemmas & {"give", "tell", "know"}:
            return self._say("riddle", "tell", over, answer=answer, Answer=answer.capitalize())
        if seen is not None and seen.question is not None and len(self._words) > 4:
            return None
        if game.turn:
            return self._say("riddle", "again", over, answer=answer)
        return self._say("riddle", "wrong", replace(game, turn=1), hint=riddle["hint"])

    def _chain(self, game: Game) -> Played | None:
        word, letter = self._words[-1], game.word[-1]
        words = self._seen.tree.words if self._seen else ()
        verbs = {one.lemma.lower() for one in words if one.pos in ("VERB", "AUX")}
        brief = len(self._words) <= CHAINED or (len(self._words) <= CHAINING and verbs - {word} <= _MOVING)
        brief = brief or (":" in self._text and len(self._text.rpartition(":")[2].split()) <= CHAINED)
        if not brief or word[0] != letter:
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
        if not game.word:  # the agent has given up, and the user names the animal
            return self._learnt(game)
        lemmas = self._lemmas()
        named = any(one.split()[-1] in lemmas for one in known if one != game.word)
        if named and not self._yes and not _IT.isdisjoint(self._words):  # "no, it's a snake"
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
        """Return a phrase of the performance `kind`, and the state after it, with the game `game`; None ends the game."""
        show = self._state.show if kind in ("play", "knock") else kind
        state = replace(self._state, game=game and replace(game, asides=0), show=show)
        return self._chance.choice(self._shows[kind][group]).format(**roles), state

    def _tell(self, wish: Wish, listed: Sequence[str]) -> Played:
        """Tell a joke or story about the subject that the user wants. If there is none, say so, and tell one
        about something else."""
        fit = fitting(self._shows, wish, listed)
        text, state = self._new(wish.kind, fit or listed)
        return (self._without(wish) if wish.thing and not fit else "") + text, state

    def _without(self, wish: Wish) -> str:
        return f"{self._chance.choice(self._shows['without']).format(thing=wish.thing, kind=wish.kind)} "

    def _new(self, kind: str, listed: Sequence[str]) -> Played:
        """Return a performance that was not shown yet. When all have been shown, start again."""
        left = [one for one in listed if one not in self._state.shown]
        text = self._chance.choice(left or listed)
        shown = self._state.shown if left else tuple(one for one in self._state.shown if one not in listed)
        return text, replace(self._state, shown=(*shown, text), show=kind, game=None)
