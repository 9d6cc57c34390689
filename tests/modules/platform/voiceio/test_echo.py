"""The echo canceller removes the agent's voice from the microphone's sound, but not the user's voice."""

import numpy as np

from modules.platform.voiceio.speech import spoken, track
from ravestate.modules.platform.voiceio.echo import FRAME, EchoCanceller


def room(far: np.ndarray, decibels: float = -10.0, delay: float = 0.03) -> np.ndarray:
    """Return the echo of a sound in a room: delayed, softer, and with two reflections."""
    out = np.zeros(len(far))
    for late, gain in ((0.0, 1.0), (0.012, 0.4), (0.031, 0.2)):
        shift = round((delay + late) * 16000)
        out[shift:] += gain * far[: len(far) - shift]
    return out * 10 ** (decibels / 20)


def cleaned(near: np.ndarray, far: np.ndarray) -> np.ndarray:
    canceller = EchoCanceller()
    size = 2 * FRAME
    a, b = (np.clip(x, -32768, 32767).astype("<i2").tobytes() for x in (near, far))
    out = b"".join(canceller.clean(a[i : i + size], b[i : i + size]) for i in range(0, len(a) - size + 1, size))
    canceller.close()
    return np.frombuffer(out, "<i2").astype(float)


def power(sound: np.ndarray) -> float:
    return float(10 * np.log10(np.mean(sound**2) + 1e-9))


def voice(*parts: tuple[float, str | bytes]) -> np.ndarray:
    return np.frombuffer(track(*parts, length=12.0), "<i2").astype(float)


def test_the_canceller_removes_the_echo_and_keeps_the_users_voice() -> None:
    far = voice((0.2, "Once there was a robot. It lived in a museum full of old paintings."), (6.0, STORY))
    user = voice((9.0, spoken("What time is it?", "espeak:en-us")))
    out = cleaned(room(far) + user, far)
    alone = slice(3 * 16000, 8 * 16000)  # the filter has learnt the room by then
    assert power(out[alone]) < power(room(far)[alone]) - 20
    both = slice(round(9.0 * 16000), round(9.8 * 16000))
    assert abs(power(out[both]) - power(user[both])) < 6


STORY = "One night it heard a strange noise in the hall, and it went to look for the reason."


def test_without_sound_from_the_loudspeaker_the_users_voice_stays_unchanged() -> None:
    user = voice((1.0, "What time is it?"))
    out = cleaned(user, np.zeros(len(user)))
    assert abs(power(out) - power(user[: len(out)])) < 1
