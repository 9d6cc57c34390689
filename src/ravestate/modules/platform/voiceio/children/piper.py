"""The backend of speech synthesis by Piper.

``_children/serve.py`` runs this file, with the interpreter of Piper's environment.
"""

# pyright: basic
from __future__ import annotations

import importlib
from typing import Any

STRESS = "ˈˌː"
"""Marks of stress and length, which are not phonemes."""


def load(config: dict[str, Any]) -> Any:
    """Load the voice file ``voice``; return the function that synthesises."""
    importlib.import_module("onnxruntime").set_seed(1)  # the same texts in the same order sound the same
    piper: Any = importlib.import_module("piper")  # only Piper's environment has this package
    voice = piper.PiperVoice.load(config["voice"], include_alignments=True)

    def handle(header: dict[str, Any], _: bytes) -> tuple[dict[str, Any], bytes]:
        normal = voice.config.length_scale or 1.0
        style = piper.SynthesisConfig(
            length_scale=normal / header["rate"],
            noise_scale=min(1.0, 0.667 * header["range"]),
            noise_w_scale=min(1.0, 0.8 * header["range"]),
        )
        sound = bytearray()
        spoken: list[list[float]] = []
        for chunk in voice.synthesize(header["text"], style, include_alignments=True):
            here = len(sound) / 2 / chunk.sample_rate
            within = False
            for part in chunk.phoneme_alignments or ():
                if part.phoneme == " ":
                    within = False
                elif part.phoneme.isalpha() or part.phoneme in STRESS:
                    if not within:
                        spoken.append([here, 0])
                    within = True
                    spoken[-1][1] += part.phoneme not in STRESS
                here += part.num_samples / chunk.sample_rate
            sound += chunk.audio_int16_bytes
        return {"rate": voice.config.sample_rate, "spoken": spoken}, bytes(sound)

    handle({"text": "Ready.", "rate": 1.0, "range": 1.0}, b"")
    return handle
