"""Understand the user's words as moves in the game, by the acts and answers that `nlp` finds, and by examples.yaml."""

from __future__ import annotations

from collections.abc import Iterable, Set
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from ravestate.language.contractions import word_set
from ravestate.language.examples import read_examples
from ravestate.language.matcher import Matcher
from ravestate.language.normal import plain
from ravestate.modules.meta.nlp.analysis import Analysis
from ravestate.modules.meta.nlp.question_word import QuestionWord

from .riddles import RIDDLES

WORDS = 5
"""The maximum number of words in the name of an activity."""
SHORT = 3
"""The maximum number of words in an unclear answer. A longer utterance is a remark on something else."""
OF_ACT = (("repeat", "repeat"), ("play", "play"), ("play", "wanted"), ("bored", "play"))
"""Pairs of an act in ``acts.yaml`` and its move. The first pair whose move is possible in this step counts."""
ANY_GAME = word_set("game round")
"""Nouns after *play* that do not name a game."""
SURE = 2
"""The strength of a sure yes or no; *I think so* is weaker."""
SURE_NAME = 0.65
"""The minimum confidence that the user means a known activity. With a lower minimum, the recogniser could learn a wrong
movement."""
FRAMES = ("{}", "it was {}", "I was {}", "is it {}", "are you {}", "you are {}", "no it was {}")
"""Sentences in which the user names an activity."""


@dataclass(frozen=True, slots=True)
class Move:
    """A move of the user in the game."""

    kind: str
    """``yes``, ``no``, ``unclear``, ``ready``, ``named``, ``stop``..."""
    name: str = ""
    """The activity that the user names; empty if the user names none."""


def understand(seen: Analysis, moves: Set[str], known: Iterable[str] = ()) -> Move | None:
    """Return the move that an utterance makes; None if it has nothing to do with the game.

    Args:
        seen: The analysis of the utterance.
        moves: The moves that the game knows at this step; see `game.moves_of`.
        known: The names of the activities that the recogniser knows.
    """
    exactly = "named" in moves and any(map(names().match_exactly, seen.sentences))
    if not exactly and (act := _act(seen, moves)) is not None:
        return act
    asks = seen.question is not None
    answer = _answer(seen, weak="unclear" in moves)
    if answer == "yes" and answer in moves:
        return Move(answer)
    guesses = "hint" in moves and seen.question is QuestionWord.YES_NO  # "is it swimming?"
    if "named" in moves and (guesses or not asks) and (name := name_of(seen, known)):
        if answer == "no" and "yes" in moves:
            return Move("no", name)
        if "yes" not in moves or name in RIDDLES:
            return Move("named", name)
    if answer in moves and (answer != "unclear" or not asks):
        return Move(answer)
    return Move("unclear") if "unclear" in moves and not asks and len(seen.tree.words) <= SHORT else None


def _answer(seen: Analysis, *, weak: bool) -> str:
    """Return ``yes``, ``no`` or ``unclear``; empty if the utterance is not an answer.

    Args:
        seen: The analysis of the utterance.
        weak: Whether a weak answer, such as *I think so*, counts as unclear.
    """
    answer = seen.yesno
    if not answer:
        return ""
    least = SURE if weak else 1
    return "yes" if (answer.yes or 0) >= least else "no" if (answer.no or 0) >= least else "unclear"


def _act(seen: Analysis, moves: Set[str]) -> Move | None:
    """Return the move that the examples of this game or the acts of `nlp` show."""
    matches = [match for match in examples().match_all(seen.sentences) if match is not None]
    best = max((one for one in matches if one.name in moves), key=lambda match: match.score, default=None)
    if "stop" in moves and (best is None or best.name == "stop"):
        # The acts of `nlp` are for any conversation: "ready" would count as a farewell, and "I'd rather not say" as a stop.
        other = any(match.name not in moves for match in matches)
        if "farewell" in seen.acts and not other:
            return Move("farewell")
        if best is not None or ((not other and "secret" not in moves and "stop" in seen.acts) or "quiet" in seen.acts):
            return Move("stop")
    if best is not None:
        return Move(best.name)
    found = (move for act, move in OF_ACT if act in seen.acts and move in moves)
    kind = next(found, None)
    return None if kind is None or (kind == "play" and _names_a_game(seen)) else Move(kind)


def _names_a_game(seen: Analysis) -> bool:
    """Return whether the user wants to play another game, such as chess. Charades itself is the move ``wanted``."""
    verbs = [word for word in seen.tree.words if word.lemma == "play" and word.pos == "VERB"]
    objects = [word for verb in verbs for word in seen.tree.children(verb, "dobj")]
    return any(word.pos in ("NOUN", "PROPN") and word.lemma not in ANY_GAME for word in objects)


def name_of(seen: Analysis, known: Iterable[str] = ()) -> str:
    """Return the activity that an utterance names; empty if it names none.

    If the agent knows a name with this meaning, return that name. Otherwise, return the user's own words: from the verb
    in *-ing* on, or else the words after *it was*.

    Args:
        seen: The analysis of the utterance.
        known: Further names that the recogniser knows.
    """
    said = [plain(sentence) for sentence in seen.sentences]
    for name in known:
        if any(said_one == plain(frame.format(name)) for said_one in said for frame in FRAMES):
            return name
    match = next((match for match in names().match_all(seen.sentences) if match is not None), None)
    if match is not None:
        return match.name
    return _own_words(seen)


def _own_words(seen: Analysis) -> str:
    words = [word for word in seen.tree.words if word.pos not in ("PUNCT", "SPACE", "INTJ")]
    while words and words[0].low in ("no", "nope", "well", "so", "ah", "oh", "not"):
        words = words[1:]
    verb = next((index for index, word in enumerate(words) if word.tag == "VBG"), None)
    if verb is not None:
        words = words[verb:]
    else:
        be = next((index for index, word in enumerate(words) if word.lemma in ("be", "'s") or word.low == "'s"), None)
        words = words[be + 1 :] if be is not None else words
        if not words or words[0].pos in ("PRON", "ADJ", "ADV", "SCONJ", "CCONJ"):
            return ""
    name = " ".join(word.low for word in words)
    return name if 0 < len(words) <= WORDS else ""


@cache
def examples() -> Matcher:
    """Return the classifier of the user's words during the game. It may not be loaded yet; see `load`."""
    found = read_examples(files(__name__.rpartition(".")[0]) / "examples.yaml")
    return Matcher(found.classes, found.none)


@cache
def names() -> Matcher:
    """Return the classifier of the names of activities. It may not be loaded yet; see `load`."""
    found = {riddle.name: [f.format(w) for w in riddle.words for f in FRAMES] for riddle in RIDDLES.values()}
    return Matcher(found, NO_NAMES, least=SURE_NAME)


NO_NAMES = tuple(
    frame.format(name)
    for name in (
        "juggling", "dancing", "playing chess", "a helicopter", "fishing", "skiing", "sleeping", "playing the drums", "cooking",
        "ironing", "playing football", "a dog", "reading a book", "a cat", "skating", "eating", "cycling", "washing",
        "playing golf", "playing tennis", "playing the violin", "playing the flute", "playing the trumpet", "playing cards",
        "playing the piano", "riding a horse", "climbing a ladder", "throwing a ball", "sweeping the floor", "combing your hair",
        "washing your face", "typing", "drawing", "painting", "writing a letter", "taking a photo", "surfing", "sailing",
        "riding a bicycle", "lifting weights", "eating soup", "peeling a banana", "stirring a soup", "sawing", "digging",
    )
    for frame in FRAMES[:4]
)  # fmt: skip
"""Sentences about activities that the agent does not know. For the classifier `names`, they belong to no class."""


def load() -> None:
    """Load both classifiers, unless they are loaded.

    Raises:
        PlatformError: The sentence model is missing.
    """
    examples().load()
    names().load()
