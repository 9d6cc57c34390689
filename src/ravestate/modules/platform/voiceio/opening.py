"""The parts of a spoken conversation (line, ear, mouth and models), and functions that open them.

The line is a microphone and a loudspeaker. The ear detects the user's speech; the mouth plays the agent's utterances.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from ravestate.modules.modality.rawio.line import Line

from .ear import Ear, Turn
from .echo import EchoCanceller
from .models import smart_turn
from .mouth import Mouth
from .pair import Pair
from .recogniser import Recognised, Recogniser
from .settings import Settings
from .synthesiser import Synthesiser
from .turn import Melody, is_back_channel, is_demand, is_echo, melody_of, wanted_silence
from .wav_line import WavLine

SURE = 0.55
"""The minimum confidence for a short sound to interrupt the agent. Recognisers may hear "Amen" in an "mm"."""


@dataclass(slots=True)
class Conversation:
    """The open parts of a conversation on one line."""

    line: Line
    ear: Ear
    mouth: Mouth
    recogniser: Recogniser
    melody: Melody | None
    settings: Settings
    closed: bool = False

    def close(self, *, linger: bool = False) -> None:
        """Close the line, and release the models. With `linger`, the models stay loaded for a while.

        Raises:
            PlatformError: The file for the loudspeaker's sound cannot be written. All parts are closed nevertheless.
        """
        self.closed = True
        with ExitStack() as parts:  # close all parts, even if one of them fails
            parts.callback(self.mouth.voice.close, linger=linger)
            parts.callback(self.recogniser.close, linger=linger)
            parts.callback(self.ear.close)
            parts.callback(self.line.close)

    async def words(self, sound: bytes, *, partial: bool = False) -> Recognised:
        """Return the words in a sound. A cancelled request is dropped if it is still waiting for earlier requests.

        Args:
            sound: The sound (16 kHz).
            partial: Whether the sound is the beginning of an utterance, for a caption.

        Raises:
            PlatformError: The recogniser fails.
        """
        unwanted = threading.Event()
        try:
            return await asyncio.to_thread(self.recogniser.recognise, sound, partial=partial, unwanted=unwanted)
        finally:
            unwanted.set()

    async def judge(self, turn: Turn) -> tuple[Recognised, float]:
        """Return the words of a turn, and how many seconds of silence end it.

        Raises:
            PlatformError: The recogniser fails.
        """
        sound, melody = turn.sound, self.melody
        hearing = asyncio.create_task(self.words(sound))
        try:
            complete = None if melody is None else await asyncio.to_thread(melody.complete, sound)
            found = await hearing
        finally:
            hearing.cancel()  # if the turn continues, these words and their error are no longer needed
        return found, 0.0 if turn.full else wanted_silence(found.text, complete, self.settings, found.last)

    def verdict(self, turn: Turn, found: Recognised) -> tuple[str, str]:
        """Return the kind of a turn (``utterance``, ``back_channel``, ``false_alarm``), with its words or the reason."""
        if not found.text:
            return "false_alarm", "there are no words in the sound"
        if turn.agent_spoke:
            if is_echo(found.text, self.mouth.said):
                return "false_alarm", f"the agent's own voice: {found.text}"
            if is_back_channel(found.text, self.settings.language):
                return "back_channel", found.text
            short = turn.end - turn.start < self.settings.back_channel
            sure = SURE if short and not is_demand(found.text, self.settings.language) else 0.0
            if found.confidence < max(sure, self.settings.ask_back_below):
                return "false_alarm", f"hardly words: {found.text}"
        return "utterance", found.text


async def open_conversation(given: Line | None, settings: Settings, warn: Callable[[str], None]) -> Conversation:
    """Load the models and open the line.

    Args:
        given: A platform's line; None to open the files or devices that the settings name.
        settings: The module's settings.
        warn: A function to call with a sentence about each missing part that is not essential.

    Raises:
        PlatformError: A model, a program or a device is missing. The message says how to get it.
    """
    recogniser = Recogniser(settings)  # not in a thread, where a cancellation would leave it open
    voice = line = None
    try:
        recorded = given is None and is_file(settings.source)  # if so, no other conversation may influence this one
        voice = Synthesiser(settings, shared=not recorded)
        await asyncio.gather(asyncio.to_thread(recogniser.load), asyncio.to_thread(voice.load))
        if (melody := await asyncio.to_thread(_melody)) is None:
            warn("there is no model for the end of a turn (smart-turn): pauses are longer. `make voice` fetches it")
        line = given or await open_line(settings)
        ear = await asyncio.to_thread(Ear, settings.speech, settings.pause, _canceller(line, settings, warn))
    except BaseException:
        if line is not None and given is None:
            line.close()
        recogniser.close()
        if voice is not None:
            voice.close()
        raise
    return Conversation(line, ear, Mouth(line, voice), recogniser, melody, settings)


def is_file(name: str) -> bool:
    """Return whether the setting `source` or `sink` names a file rather than a device."""
    return Path(name).suffix.lower() in (".wav", ".ogg", ".mp3", ".flac", ".m4a", ".opus")


async def open_line(settings: Settings) -> Line:
    """Open a line to the files or devices that the settings name. The source may be a file, and the sink a device.

    Raises:
        PlatformError: A file or a device cannot be opened.
    """
    source, sink = _file(settings.source), _file(settings.sink)
    by_clock = sink is not None or not settings.sink
    files = await asyncio.to_thread(WavLine, source, sink) if source or by_clock else None
    if files is not None and source and by_clock:
        return files
    devices = _devices("" if source else settings.source, "" if by_clock else settings.sink)
    if files is None:
        return devices
    files.begin()
    return Pair(files, devices) if source else Pair(devices, files)


def _file(name: str) -> Path | None:
    return Path(name).expanduser() if is_file(name) else None


def _devices(source: str, sink: str) -> Line:
    from .device_line import DeviceLine

    return DeviceLine(source, sink)


def _melody() -> Melody | None:
    file = smart_turn()
    return None if file is None else melody_of(file)


def _canceller(line: Line, settings: Settings, warn: Callable[[str], None]) -> EchoCanceller | None:
    if settings.half_duplex or not settings.echo_cancellation or line.cancels_echo:
        return None
    try:
        return EchoCanceller()
    except OSError:
        warn("there is no echo cancellation: apt-get install libspeexdsp1, or use headphones")
        return None
