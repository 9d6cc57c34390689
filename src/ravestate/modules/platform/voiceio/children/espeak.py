"""The backend of speech synthesis by the library espeak-ng. ``_children/serve.py`` runs this file."""

# pyright: basic
from __future__ import annotations

import ctypes
import ctypes.util
from typing import Any

# The values of constants in espeak-ng's speak_lib.h.
SYNCHRONOUS, UTF8, CHARACTERS = 2, 1, 1
RATE, PITCH, RANGE = 1, 3, 4  # the codes of parameters
WORD, END = 1, 0  # the codes of kinds of events
NORMAL_RATE = 165  # words per minute


class Event(ctypes.Structure):
    """An event of the library: the beginning of a word in the text and in the sound."""

    _fields_ = (
        ("type", ctypes.c_int),
        ("unique_identifier", ctypes.c_uint),
        ("text_position", ctypes.c_int),
        ("length", ctypes.c_int),
        ("audio_position", ctypes.c_int),
        ("sample", ctypes.c_int),
        ("user_data", ctypes.c_void_p),
        ("id", ctypes.c_char * 8),
    )


class Voice(ctypes.Structure):
    """The properties by which the library looks for a voice."""

    _fields_ = (
        ("name", ctypes.c_char_p),
        ("languages", ctypes.c_char_p),
        ("identifier", ctypes.c_char_p),
        ("gender", ctypes.c_ubyte),
        ("age", ctypes.c_ubyte),
        ("variant", ctypes.c_ubyte),
        ("xx1", ctypes.c_ubyte),
        ("score", ctypes.c_int),
        ("spare", ctypes.c_void_p),
    )


CALLBACK = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.POINTER(ctypes.c_short), ctypes.c_int, ctypes.POINTER(Event))


def load(config: dict[str, Any]) -> Any:
    """Open the library with the voice ``voice``; return the function that synthesises."""
    name = ctypes.util.find_library("espeak-ng") or "libespeak-ng.so.1"
    try:
        library = ctypes.CDLL(name)
    except OSError:
        raise OSError("espeak-ng is not installed") from None
    rate = library.espeak_Initialize(SYNCHRONOUS, 0, None, 1 << 15)
    if rate <= 0:
        raise OSError("espeak-ng has no data: install the package espeak-ng-data")
    voice = config["voice"].encode()
    # If no voice has this name, look for a voice of this language. It may have another name, or another region.
    if library.espeak_SetVoiceByName(voice) and library.espeak_SetVoiceByProperties(
        ctypes.byref(Voice(languages=voice))
    ):
        raise ValueError(
            f"espeak-ng has no voice {config['voice']!r}: espeak-ng --voices lists the names for voiceio.voice"
        )
    sound = bytearray()
    places: list[tuple[int, float]] = []

    @CALLBACK
    def take(samples: Any, count: int, events: Any) -> int:
        if samples and count > 0:
            sound.extend(ctypes.string_at(samples, 2 * count))
        number = 0
        while events[number].type != END:
            event = events[number]
            if event.type == WORD:
                places.append((event.text_position - 1, event.audio_position / 1000))
            number += 1
        return 0

    library.espeak_SetSynthCallback(take)

    def handle(header: dict[str, Any], _: bytes) -> tuple[dict[str, Any], bytes]:
        sound.clear()
        places.clear()
        library.espeak_SetParameter(RATE, round(NORMAL_RATE * header["rate"]), 0)
        library.espeak_SetParameter(PITCH, min(99, max(0, round(50 + 60 * (header["pitch"] - 1)))), 0)
        library.espeak_SetParameter(RANGE, min(99, max(0, round(50 * header["range"]))), 0)
        text = header["text"].encode() + b"\0"
        library.espeak_Synth(text, ctypes.c_size_t(len(text)), 0, CHARACTERS, 0, UTF8, None, None)
        return {"rate": rate, "places": list(places)}, bytes(sound)

    handle.callback = take  # pyright: ignore[reportFunctionMemberAccess]  # the library keeps no reference to it
    handle({"text": "ready", "rate": 1.0, "pitch": 1.0, "range": 1.0}, b"")
    return handle
