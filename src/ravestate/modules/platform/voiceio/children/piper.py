"""The backend of synthesis by Piper. `serve` runs this file with the interpreter of Piper's own environment."""

# pyright: basic
from __future__ import annotations

from typing import Any


def load(config: dict[str, Any]) -> Any:
    """Load the voice file ``voice``; return the function that synthesises."""
    from piper import PiperVoice, SynthesisConfig  # pyright: ignore[reportMissingImports]

    voice = PiperVoice.load(config["voice"], include_alignments=True)

    def handle(header: dict[str, Any], _: bytes) -> tuple[dict[str, Any], bytes]:
        normal = voice.config.length_scale or 1.0
        style = SynthesisConfig(
            length_scale=normal / header["rate"],
            noise_scale=min(1.0, 0.667 * header["range"]),
            noise_w_scale=0.8,
        )
        sound = bytearray()
        starts: list[float] = []
        for chunk in voice.synthesize(header["text"], style, include_alignments=True):
            here = len(sound) / 2 / chunk.sample_rate
            open_word = False
            for part in chunk.phoneme_alignments or ():
                if part.phoneme == " ":
                    open_word = False
                elif part.phoneme.isalnum() or part.phoneme in "ˈˌ":
                    if not open_word:
                        starts.append(here)
                    open_word = True
                here += part.num_samples / chunk.sample_rate
            sound += chunk.audio_int16_bytes
        return {"rate": voice.config.sample_rate, "starts": starts}, bytes(sound)

    handle({"text": "Ready.", "rate": 1.0, "range": 1.0}, b"")
    return handle
