"""A voice and a loudspeaker for Pipecat's tests. Each character sounds for 10 ms. Its samples are its code point."""

import asyncio
from array import array
from collections.abc import AsyncGenerator

from pipecat.frames.frames import Frame, InterruptionFrame, OutputAudioRawFrame, StartFrame, TTSAudioRawFrame
from pipecat.processors.frame_processor import FrameDirection
from pipecat.services.settings import TTSSettings
from pipecat.services.tts_service import TTSService
from pipecat.transports.base_output import BaseOutputTransport
from pipecat.transports.base_transport import TransportParams

RATE = 16_000
SAMPLES = RATE // 100
"""The number of samples for one character."""


class Voice(TTSService):
    """A stand-in for a voice. It turns characters into samples."""

    def __init__(self) -> None:
        settings = TTSSettings(model=None, voice=None, language=None)
        super().__init__(sample_rate=RATE, push_start_frame=True, push_stop_frames=True, settings=settings)

    async def run_tts(self, text: str, context_id: str) -> AsyncGenerator[Frame | None, None]:
        for character in text:
            sound = array("h", [ord(character)] * SAMPLES).tobytes()
            yield TTSAudioRawFrame(sound, RATE, 1, context_id=context_id)


class Loudspeaker(BaseOutputTransport):
    """A loudspeaker that plays instantly. After `most` characters, it stops until the user interrupts the agent."""

    def __init__(self) -> None:
        super().__init__(TransportParams(audio_out_enabled=True, audio_out_sample_rate=RATE, audio_out_10ms_chunks=1))
        self.most = 10**6
        self.stopped = asyncio.Event()
        """Set when the loudspeaker has played `most` characters."""
        self._interrupted = asyncio.Event()
        self.played = ""
        """The characters that the user has heard."""

    async def start(self, frame: StartFrame) -> None:
        await super().start(frame)
        await self.set_transport_ready(frame)

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        if isinstance(frame, InterruptionFrame) and self.stopped.is_set():
            self.most = 10**6
            self._interrupted.set()
        await super().process_frame(frame, direction)

    async def write_audio_frame(self, frame: OutputAudioRawFrame) -> bool:
        sound = array("h", frame.audio)
        self.played += "".join(map(chr, filter(None, sound[SAMPLES - 1 :: SAMPLES])))
        if len(self.played) >= self.most:
            self.stopped.set()
            await self._interrupted.wait()
        return True
