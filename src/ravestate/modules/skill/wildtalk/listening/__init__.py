"""The listening skill: small talk without a language model, from authored phrases that suit the user's utterance."""

from __future__ import annotations

from .backend import ListeningBackend
from .hearing import Heard
from .listener import Answer, Listener
from .state import Overheard, State

__all__ = ["Answer", "Heard", "Listener", "ListeningBackend", "Overheard", "State"]
