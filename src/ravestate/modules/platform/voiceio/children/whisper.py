"""The backend of speech recognition by faster-whisper. ``_children/serve.py`` runs this file.

Whisper reads windows of 30 seconds, and its encoder takes as long for silence as for speech. So this backend does not
fill the window: it adds only a few seconds of silence (`TAIL`) to a sound. A sentence then takes a fifth of the time. A
sound has at most 25 seconds. In such a short window, the model often overlooks the end of the sound, and writes the
same words again. The backend cuts off the repetition.
"""

# pyright: basic
from __future__ import annotations

import math
import zlib
from typing import Any

TAIL = 5.0
"""This many seconds of silence follow the sound. With less silence, the model repeats itself more often."""
MOST = 8
"""The maximum number of tokens in a second of speech. People say at most five words a second."""
PHRASE = 3
"""A repeated phrase is cut off if it has at least this many words. People do repeat shorter phrases ("no, no")."""
PLAUSIBLE = 0.02
"""A candidate for the last word is reported if its probability is greater than this."""
POOR = -1.0
"""If the mean log probability of the tokens is below this, the backend tries again with windows of 30 seconds."""
REPEATED = 2.4
"""A text with a greater compression ratio than this is repetitive, which shows that the model is confused."""


def load(config: dict[str, Any]) -> Any:
    """Load the model in the folder ``path`` for a ``language``; return the function that recognises."""
    import numpy as np
    from faster_whisper import WhisperModel
    from faster_whisper.audio import pad_or_trim
    from faster_whisper.tokenizer import Tokenizer
    from faster_whisper.transcribe import get_suppressed_tokens

    model = WhisperModel(config["path"], device="auto", compute_type="default" if config["exact"] else "int8",
                         cpu_threads=config["threads"], local_files_only=True)  # fmt: skip
    spoken = config["language"]
    if not model.model.is_multilingual:
        if spoken not in ("", "en"):
            raise ValueError(f"the model {config['path']} knows only English, not the language {spoken!r}")
        spoken = "en"
    suppressed: Any = get_suppressed_tokens  # the package's types are wrong
    tokenizers: dict[str, Tokenizer] = {}

    def tokenizer_of(language: str) -> Tokenizer:
        if language not in tokenizers:
            tokenizers[language] = Tokenizer(
                model.hf_tokenizer, model.model.is_multilingual, task="transcribe", language=language
            )
        return tokenizers[language]

    def quick(sound: Any) -> dict[str, Any]:
        most = 16 + int(MOST * len(sound) / 16000)
        features = model.feature_extractor(sound, padding=int(TAIL * 16000))
        features = pad_or_trim(features, features.shape[-1] // 2 * 2)
        encoded = model.encode(features)
        language = spoken
        if not language:
            whole = model.feature_extractor(sound[: 10 * 16000])
            language = model.model.detect_language(model.encode(pad_or_trim(whole)))[0][0][0][2:-2]
        tokenizer = tokenizer_of(language)
        result = model.model.generate(
            encoded,
            [model.get_prompt(tokenizer, [], without_timestamps=True)],
            beam_size=1,
            max_length=min(224, most),
            return_logits_vocab=True,
            return_no_speech_prob=True,
            suppress_tokens=suppressed(tokenizer, [-1]),
        )[0]
        tokens = result.sequences_ids[0]
        steps = [_log_probabilities(np, step) for step in result.logits[0]]
        parts = [tokenizer.decode([token]) for token in tokens]
        begins = [at for at, part in enumerate(parts) if at == 0 or part.startswith(" ")]
        words = [_bare("".join(parts[at:end])) for at, end in zip(begins, [*begins[1:], len(parts)], strict=True)]
        kept = without_repetition(words, at_limit=len(tokens) >= len(steps))
        count = begins[kept] if kept < len(begins) else len(tokens)
        written = [number for number in range(kept) if words[number]]
        text = tokenizer.decode(tokens[:count]).strip()
        return {
            "text": text if count == len(tokens) else text.rstrip(" ,-"),  # the comma was before the repetition
            "logprob": float(sum(steps[at][tokens[at]] for at in range(count))) / (count + 1),
            "no_speech": result.no_speech_prob,
            "last": _plausible(np, tokenizer, steps[begins[written[-1]]]) if written else {},
        }

    def whole(sound: Any) -> dict[str, Any]:
        found, _ = model.transcribe(
            sound, language=spoken or None, beam_size=5,
            condition_on_previous_text=False, without_timestamps=True,
        )  # fmt: skip
        segments = list(found)
        if not segments:
            return {"text": "", "logprob": -10.0, "no_speech": 1.0, "last": {}}
        lengths = [max(1, len(segment.tokens)) for segment in segments]
        mean = sum(s.avg_logprob * n for s, n in zip(segments, lengths, strict=True)) / sum(lengths)
        return {
            "text": " ".join(segment.text.strip() for segment in segments),
            "logprob": mean,
            "no_speech": min(segment.no_speech_prob for segment in segments),
            "last": {},
        }

    def handle(header: dict[str, Any], data: bytes) -> tuple[dict[str, Any], bytes]:
        sound = np.frombuffer(data, "<i2").astype(np.float32) / 32768
        found = quick(sound)
        if not header["partial"] and (found["logprob"] < POOR or _repeats(found["text"])):
            again = whole(sound)
            found = again if again["logprob"] > found["logprob"] or _repeats(found["text"]) else found
        found["confidence"] = math.exp(min(0.0, found.pop("logprob")))
        return found, b""

    handle({"partial": True}, bytes(32000))  # the first run is slow
    return handle


def without_repetition(words: list[str], *, at_limit: bool) -> int:
    """Return the number of words to keep: if the words are one phrase again and again, those of the first phrase.

    Otherwise, keep all words. `at_limit` is whether the model wrote as many tokens as it may. If so, even a short or partial repetition
    counts.
    """
    for length in range(1 if at_limit else PHRASE, len(words)):
        if all(words[at] == words[at - length] for at in range(length, len(words))):
            return length if at_limit or len(words) >= 2 * length else len(words)
    return len(words)


def _plausible(np: Any, tokenizer: Any, step: Any) -> dict[str, float]:
    """Return the plausible words for one step of the model, with their probabilities."""
    likely = [int(token) for token in np.flatnonzero(step > math.log(PLAUSIBLE)) if token < tokenizer.eot]
    found: dict[str, float] = {}
    for token in likely:
        word = _bare(tokenizer.decode([token]))
        found[word] = found.get(word, 0.0) + math.exp(float(step[token]))
    return found


def _log_probabilities(np: Any, step: Any) -> Any:
    scores = np.array(step).reshape(-1).astype(np.float32)
    scores -= scores.max()
    return scores - math.log(float(np.exp(scores).sum()))


def _bare(word: str) -> str:
    return "".join(c for c in word.casefold() if c.isalnum() or c == "'")


def _repeats(text: str) -> bool:
    raw = text.encode()
    return len(raw) > 40 and len(raw) / len(zlib.compress(raw)) > REPEATED
