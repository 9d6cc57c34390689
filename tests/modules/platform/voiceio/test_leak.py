"""`Leak` hides the loudspeaker's echo from the agent, but not the speech of a user during the echo."""

import numpy as np

from modules.platform.voiceio.speech import spoken, track
from modules.platform.voiceio.test_echo import room
from ravestate.modules.platform.voiceio.activity import CHUNK
from ravestate.modules.platform.voiceio.ear import Ear
from ravestate.modules.platform.voiceio.echo import FRAME, EchoCanceller
from ravestate.modules.platform.voiceio.leak import Leak

FAR = "Once there was a robot. It lived in a museum full of old paintings."


def sound(*parts: tuple[float, str | bytes]) -> np.ndarray:
    return np.frombuffer(track(*parts, length=5.0), "<i2").astype(float)


def hidden(near: np.ndarray, far: np.ndarray) -> tuple[np.ndarray, Leak]:
    """Return whether a `Leak` hides each chunk of the microphone's sound `near`; also return the `Leak`."""
    leak, found, chunk = Leak(), list[bool](), 0
    for at in range(0, len(near) - FRAME, FRAME):
        leak.play(near[at : at + FRAME].astype("<i2"), far[at : at + FRAME].astype("<i2"))
        while (chunk + 1) * CHUNK <= at + FRAME:
            found.append(leak.hides(near[chunk * CHUNK : (chunk + 1) * CHUNK].astype("<i2")))
            chunk += 1
    return np.array(found), leak


def chunks(begin: float, end: float) -> slice:
    return slice(round(begin * 16000 / CHUNK), round(end * 16000 / CHUNK))


def test_a_user_who_still_speaks_when_the_agent_begins_is_hidden_only_for_a_moment() -> None:
    for soft in (1.0, 0.1):
        user = soft * sound((0.9, spoken("The mountains, and my grandmother, and the old house near the sea.")))
        found, leak = hidden(user, sound((1.0, FAR)))
        assert not leak.echoes
        assert not found[chunks(1.4, 3.0)].any()


def test_a_microphone_that_was_silent_while_the_agent_spoke_has_no_echo() -> None:
    found, leak = hidden(sound((3.0, "Stop, that is enough.")), sound((0.5, FAR)))
    assert not leak.echoes and not leak.possible
    assert not found[chunks(3.0, 4.0)].any()


def test_an_echo_is_hidden_from_its_beginning() -> None:
    far = sound((0.5, FAR))
    for decibels in (-10.0, -30.0):
        found, leak = hidden(room(far, decibels), far)
        assert leak.echoes
        assert found[chunks(0.6, 3.5)].mean() > 0.95


def test_an_echo_that_begins_later_is_noticed() -> None:
    """This happens, for example, when the user takes off their headphones."""
    far = sound((0.5, FAR))
    leak = Leak()
    for near in (np.zeros(len(far)), room(far)):
        for at in range(0, len(far) - FRAME, FRAME):
            leak.play(near[at : at + FRAME].astype("<i2"), far[at : at + FRAME].astype("<i2"))
        assert leak.echoes == bool(near.any())


def articulate(near: np.ndarray, far: np.ndarray) -> list[float]:
    """Return the times of the event *articulate* of an ear with a canceller while the agent speaks (seconds)."""
    ear, found = Ear(canceller=EchoCanceller()), list[float]()
    a, b = (np.clip(each, -32768, 32767).astype("<i2").tobytes() for each in (near, far))
    for at in range(0, len(a) - 640, 640):
        events = ear.feed(a[at : at + 640], at / 32000, b[at : at + 640], agent_speaks=True)
        found += [at / 32000 for event in events if event == "articulate"]
    ear.close()
    return found


def test_despite_an_echo_the_ear_hears_a_user_who_still_speaks_when_the_agent_begins() -> None:
    """The canceller does not know the room yet. It must not learn from the user's voice that the echo is loud."""
    for voice in ("piper", "espeak:en-us"):
        far, user = sound((0.5, spoken(FAR, voice))), sound((0.7, "Do you know a story about an old ship?"))
        for decibels in (-10.0, -20.0):
            echo = room(far, decibels)
            assert articulate(echo, far) == []
            assert [] < articulate(user + echo, far) < [1.7], (voice, decibels)
