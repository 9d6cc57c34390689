"""A scene in a video file, with the real vision worker, memory and greetings, also after a restart."""

from pathlib import Path

import pytest

from modules.modality.visionio.photographs import make, photo
from ravestate.modules import hibye, interloc, persqa, visionio
from ravestate.testing import simulate

pytestmark = pytest.mark.usefixtures("reader")

SCENE = """
def person(file, size):
    picture = cv2.imread(file)
    scale = size / picture.shape[0]
    return cv2.resize(picture, None, fx=scale, fy=scale, interpolation=cv2.INTER_AREA)

def shot(people, second):
    room = np.full((480, 640, 3), 150, np.uint8)
    room[300:] = 90
    for number, one in enumerate(people):
        x = (640 - sum(p.shape[1] for p in people)) // (len(people) + 1) * (number + 1)
        x += sum(p.shape[1] for p in people[:number]) + int(8 * np.sin(3 * second))  # they sway
        room[480 - one.shape[0]:, x:x + one.shape[1]] = one
    noise = np.random.default_rng(int(second * 10)).integers(0, 12, room.shape, np.uint8)
    return cv2.add(room, noise)

barack, again, joe = person(a[0], 440), person(a[1], 420), person(a[2], 440)
out = cv2.VideoWriter(a[3], cv2.VideoWriter_fourcc(*"mp4v"), 10, (640, 480))
for number in range(450):
    second = number / 10
    people = [barack] if 2 <= second < 14 else [again, joe] if 26 <= second < 34 else []
    out.write(shot(people, second))
out.release()
"""


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A video of 45 s: a man comes (at 2 s), leaves (14 s), and returns with another man (26 s). Both leave (34 s)."""
    file = tmp_path_factory.mktemp("scene") / "scene.mp4"
    make(SCENE, photo("obama"), photo("obama2"), photo("biden"), file)
    return file


def test_a_person_is_recognised_in_a_video_and_again_after_a_restart(scene: Path, memory: Path) -> None:
    settings = {
        "visionio": {"source": str(scene), "fps": 2},
        "ontology": {"path": str(memory)},
        "idle": {"bored_after": 1e6},
    }
    with simulate(hibye.module, persqa.module, visionio.module, settings=settings) as sim:
        sim.advance(1.9)
        assert sim.said == [] and not sim.read(interloc.users)
        sim.advance(3.1)
        assert len(sim.said) == 1 and list(sim.read(interloc.users).values()) == [None]
        sim.say("My name is Barack.")
        sim.advance(5)
        assert "emember your face" in sim.said[-1] and "Barack" in sim.said[-1]
        sim.say("yes")
        sim.advance(3)
        assert "know you" in sim.said[-1]
        sim.advance(12)
        assert not sim.read(interloc.users)
        before = len(sim.said)
        sim.advance(6)  # at 31 s, the man is back with a stranger
        assert sorted(map(str, sim.read(interloc.users).values())) == ["Barack", "None"]
        assert any("Barack" in text for text in sim.said[before:])
        sim.advance(20)  # the video is over
        assert not sim.read(interloc.users) and not sim.read(visionio.visitors)
        assert sim.failures == []
    with simulate(hibye.module, persqa.module, visionio.module, settings=settings) as sim:
        sim.advance(6)
        assert list(sim.read(interloc.users).values()) == ["Barack"] and "Barack" in sim.said[0]
        assert sim.failures == []
