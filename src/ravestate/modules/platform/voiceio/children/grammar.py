"""The backend of speech recognition with a grammar of commands, by pocketsphinx.

``_children/serve.py`` runs this file.
"""

# pyright: basic
from __future__ import annotations

import math
from typing import Any

DOUBTFUL = 3.0
"""At this mean loss per frame (nats), the confidence is one half. The loss shows how badly the command fits."""


def load(config: dict[str, Any]) -> Any:
    """Load the grammar in the file ``path`` (JSGF); return the function that recognises."""
    from pocketsphinx import Config, Decoder, get_model_path

    decoder = Decoder(
        Config(
            hmm=get_model_path("en-us/en-us"),
            dict=get_model_path("en-us/cmudict-en-us.dict"),
            jsgf=config["path"],
            loglevel="FATAL",
        )
    )

    def handle(_: dict[str, Any], data: bytes) -> tuple[dict[str, Any], bytes]:
        decoder.start_utt()
        decoder.process_raw(data, full_utt=True)
        decoder.end_utt()
        found = decoder.hyp()
        if found is None or not found.hypstr.strip():
            return {"text": "", "confidence": 0.0, "no_speech": 1.0}, b""
        loss = frames = 0.0
        for part in decoder.seg():
            if not part.word.startswith("<"):
                loss -= math.log(max(part.ascore, 1e-300))
                frames += part.end_frame - part.start_frame + 1
        confidence = 1 / (1 + math.exp(min(50.0, 2 * (loss / max(1.0, frames) - DOUBTFUL))))
        return {"text": found.hypstr.strip(), "confidence": confidence, "no_speech": 0.0}, b""

    return handle
