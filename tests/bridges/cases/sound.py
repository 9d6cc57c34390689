"""A voice and a loudspeaker for LiveKit's tests. Each character sounds for 10 ms. Its samples are its code point."""

import asyncio
import time
from array import array

from livekit import rtc
from livekit.agents import DEFAULT_API_CONNECT_OPTIONS, APIConnectOptions, tts
from livekit.agents.voice import io

RATE = 16_000
SAMPLES = RATE // 100
"""The number of samples for one character."""


def words_in(sound: "array[int]") -> str:
    """Return the text of a sound, without silence and without a character that is cut off."""
    ends = sound[SAMPLES - 1 :: SAMPLES]
    return "".join(map(chr, filter(None, ends)))


class Voice(tts.TTS[str]):
    """A stand-in for a voice. It turns characters into samples."""

    def __init__(self) -> None:
        super().__init__(capabilities=tts.TTSCapabilities(streaming=False), sample_rate=RATE, num_channels=1)

    def synthesize(
        self, text: str, *, conn_options: APIConnectOptions = DEFAULT_API_CONNECT_OPTIONS
    ) -> tts.ChunkedStream:
        return _Speech(tts=self, input_text=text, conn_options=conn_options)


class _Speech(tts.ChunkedStream):
    async def _run(self, output_emitter: tts.AudioEmitter) -> None:
        output_emitter.initialize(request_id="1", sample_rate=RATE, num_channels=1, mime_type="audio/pcm")
        for character in self.input_text:
            output_emitter.push(array("h", [ord(character)] * SAMPLES).tobytes())
        output_emitter.flush()


class Loudspeaker(io.AudioOutput):
    """A loudspeaker that plays instantly. After `most` characters of an utterance, it stops until an interruption."""

    def __init__(self) -> None:
        super().__init__(label="loudspeaker", capabilities=io.AudioOutputCapabilities(pause=False), sample_rate=RATE)
        self.most = 10**6
        self.stopped = asyncio.Event()
        """Set when the loudspeaker has played `most` characters."""
        self.played: list[str] = []
        """The utterances that the user has heard."""
        self._sound = array("h")

    async def capture_frame(self, frame: rtc.AudioFrame) -> None:
        await super().capture_frame(frame)
        if not self._sound:
            self.on_playback_started(created_at=time.time())
        self._sound.extend(frame.data)
        if len(self._sound) >= self.most * SAMPLES:
            self.stopped.set()

    def flush(self) -> None:
        super().flush()
        if self._sound and not self.stopped.is_set():
            self._end(interrupted=False)

    def clear_buffer(self) -> None:
        if self._sound:
            self._end(interrupted=True)

    def _end(self, *, interrupted: bool) -> None:
        heard = self._sound[: self.most * SAMPLES]
        self._sound = array("h")
        self.played.append(words_in(heard))
        self.on_playback_finished(
            playback_position=len(heard) / RATE, interrupted=interrupted, synchronized_transcript=words_in(heard)
        )
