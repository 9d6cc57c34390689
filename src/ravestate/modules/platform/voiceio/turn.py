"""Decide when the user's turn is over, from its melody, its words, and the silence after it.

The melody is the rise and fall of the voice.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal

from ravestate.modules.modality.rawio.line import IN_RATE
from ravestate.yaml_text import load_yaml

from .settings import Settings

WINDOW = 8.0
"""The melody model hears this many seconds at the end of a turn."""

UNFINISHED = 0.3
"""If the probability of a complete melody is below this share of the setting `complete`, the user wants to say more,
whatever the words are."""

ANOTHER = 0.03
"""The recogniser's candidates for the last word may include words that seldom end a sentence, such as *my*. If these
have at least this probability together, it is doubtful whether the turn is over."""
UNCLEAR = 0.3
"""If the probability of every candidate is below this, the last word is unclear, for example because it was cut off."""

_SOUND = re.compile(r"a?(?:ha|he|hi|ho|heh|hah)+h?|(?:[mnh]+[-.]?)+|m(?:[-.][a-z]{1,2})*[-.][mnh]+")
"""Laughter and hums in a recogniser's spelling: "hahaha", "mm-hmm", "m-h-m", "m-a-k-m"."""
_EDGES = ".,!?…;:\"'“”‘’()-–— "


class Melody:
    """A model that judges by the sound whether a turn is complete (smart-turn)."""

    def __init__(self, file: Path) -> None:
        """Load the model in a file.

        Raises:
            PlatformError: The file cannot be loaded.
        """
        from faster_whisper.feature_extractor import FeatureExtractor  # pyright: ignore[reportMissingTypeStubs]

        from .activity import session

        self._session = session(file)
        self._input: str = self._session.get_inputs()[0].name
        self._features: Any = FeatureExtractor(chunk_length=int(WINDOW))

    def complete(self, pcm: bytes) -> float:
        """Return the probability that a turn is complete.

        `pcm` is its sound (16 kHz), with 0.2 s of silence at the end.
        """
        import numpy as np

        wanted = int(WINDOW * IN_RATE)
        sound = np.frombuffer(pcm[-2 * wanted :], "<i2").astype(np.float32) / 32768
        sound = np.pad(sound, (wanted - len(sound), 0))
        sound = (sound - sound.mean()) / np.sqrt(sound.var() + 1e-7)
        features = self._features(sound, padding=0)[:, : int(WINDOW * 100)]
        features = np.pad(features, ((0, 0), (0, int(WINDOW * 100) - features.shape[1])), mode="edge")
        (found,) = self._session.run(None, {self._input: features[None].astype(np.float32)})
        return float(found.reshape(-1)[0])


@lru_cache(maxsize=1)
def melody_of(file: Path) -> Melody:
    """Return the model in a file. It stays loaded, and all conversations may share it, because it stores no sounds.

    Raises:
        PlatformError: The file cannot be loaded.
    """
    return Melody(file)


def wanted_silence(
    text: str, complete: float | None, settings: Settings, last: Mapping[str, float] | None = None
) -> float:
    """Return how many seconds of silence end a turn.

    Args:
        text: The words so far.
        complete: The probability that the melody is complete; None if there is no model.
        settings: The settings with the pauses and limits.
        last: The recogniser's candidates for the last word, with their probabilities.
    """
    words = completeness(text, settings.language)
    if words == "complete" and last and _may_go_on(text, last, settings.language):
        words = "doubtful"
    if words == "open" or (complete is not None and complete < UNFINISHED * settings.complete):
        return settings.longest_pause
    sure = words == "complete" and complete is not None and complete >= settings.complete
    return min(settings.pause if sure else settings.doubtful_pause, settings.longest_pause)


def completeness(text: str, language: str = "en") -> Literal["open", "doubtful", "complete"]:
    """Judge by its last word and mark whether a text is complete: open after *the* or a comma, doubtful after *that*.

    Example:
        >>> completeness("I would like to go to the"), completeness("I think that"), completeness("Go home.")
        ('open', 'doubtful', 'complete')
    """
    text = text.strip()
    if not text:
        return "complete"
    known, last = _words(language), _bare(text.split()[-1])
    if text.endswith((",", "...", "…", "-", "—", ":")) or (last in known["open"] and not text.endswith(("?", "!"))):
        return "open"
    return "doubtful" if last in known["doubtful"] and not text.endswith(("?", "!")) else "complete"


def _may_go_on(text: str, last: Mapping[str, float], language: str) -> bool:
    """Return whether the last word is unclear, or may be a different word that seldom ends a sentence.

    A recogniser has learnt from whole sentences. So it may hear "a photograph of mine" if the user says "a photograph
    of my", and pauses.
    """
    known, written = _words(language), _bare(text.split()[-1])
    more = known["open"] | known["doubtful"]
    others = sum(share for word, share in last.items() if word in more and word != written)
    return others >= ANOTHER or max(last.values()) < UNCLEAR


def is_back_channel(text: str, language: str = "en") -> bool:
    """Return whether the words (at most six) show merely that the user is listening or laughing.

    Example:
        >>> is_back_channel("Yeah, I see."), is_back_channel("Ha ha ha!"), is_back_channel("Yes, but why?")
        (True, True, False)
    """
    known = _words(language)["back_channels"]
    words = [bare for word in text.split() if (bare := _bare(word))]
    at = 0
    while at < len(words):
        for length in (3, 2, 1):
            phrase = " ".join(words[at : at + length])
            if phrase in known or (length == 1 and _SOUND.fullmatch(phrase)):
                at += length
                break
        else:
            return False
    return bool(words) and len(words) <= 6


def is_demand(text: str, language: str = "en") -> bool:
    """Return whether the words ask the agent to stop or to listen.

    Example:
        >>> is_demand("Hey, wait."), is_demand("In a month")
        (True, False)
    """
    return any(_bare(word) in _words(language)["demands"] for word in text.split())


def is_echo(text: str, spoken: str) -> bool:
    """Return whether the recognised words (at least three) are mostly a passage of the agent's own words.

    Example:
        >>> is_echo("lived in a museum", "Once there was a robot. It lived in a museum.")
        True
    """
    heard = [bare for word in text.split() if (bare := _bare(word))]
    own = [bare for word in spoken.split() if (bare := _bare(word))]
    if len(heard) < 3 or not own:
        return False
    blocks = difflib.SequenceMatcher(None, heard, own, autojunk=False).get_matching_blocks()
    longest = max(block.size for block in blocks)
    return longest >= 2 and sum(block.size for block in blocks) >= 0.7 * len(heard)


def _bare(word: str) -> str:
    return word.casefold().strip(_EDGES).replace("’", "'")


@lru_cache(maxsize=16)
def _words(language: str) -> Mapping[str, frozenset[str]]:
    file = files(__package__ or "") / "words.yaml"
    book: Mapping[str, Mapping[str, Sequence[str]]] = load_yaml(file.read_text(encoding="utf-8"), file.name)
    found = book.get(language.partition("-")[0].lower(), book["en"])
    return {role: frozenset(_bare(word) for word in words) for role, words in found.items()}
