"""A feeling of the agent changes the prosody of its speech for a while."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from modules.platform.voiceio.speech import FAST, Scripted, storyteller, wav
from ravestate.modules import emotion, rawio, voiceio
from ravestate.modules.platform.voiceio import Prosody, opening
from ravestate.modules.platform.voiceio.feelings import LASTS
from ravestate.modules.platform.voiceio.manner import FEELINGS
from ravestate.modules.platform.voiceio.synthesiser import Synthesiser
from ravestate.modules.platform.voiceio.wav_line import WavLine
from ravestate.testing import simulate


def test_a_happy_agent_speaks_with_another_prosody_for_a_while(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(opening, "Recogniser", Scripted(""))
    manners: list[Any] = []
    speak = Synthesiser.speak

    def note(self: Synthesiser, text: str, prosody: Prosody | None = None) -> Any:
        manners.append(prosody)
        return speak(self, text, prosody)

    monkeypatch.setattr(Synthesiser, "speak", note)
    settings = {**FAST, "emotion": {"emoji": False, "happy": 0.0, "shy": 0.0, "affectionate": 0.0}}
    with simulate(storyteller(), emotion, voiceio, settings=settings) as sim:
        sim.put(rawio.sound, WavLine(wav(tmp_path / "in.wav", bytes(32000 * 60))))
        sim.advance(0.5)
        sim.emit(emotion.happy)
        sim.say("Good evening.")
        sim.advance(3.0)
        assert sim.read(voiceio.prosody) == FEELINGS["happy"] == manners[-1]
        sim.advance(LASTS)
        sim.say("Good evening.")
        sim.advance(3.0)
        assert sim.read(voiceio.prosody) == Prosody() == manners[-1]
        assert not sim.failures
