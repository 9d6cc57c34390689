"""The vision worker on real photos: it finds and recognises faces, and survives any picture."""

import asyncio
from itertools import combinations
from math import dist
from pathlib import Path
from types import SimpleNamespace

import pytest

from modules.modality.visionio.photographs import OBAMA, OTHERS, eye, faces, look, make, photo
from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio.frames import Frame, Frames
from ravestate.modules.modality.visionio.names import Settings
from ravestate.modules.modality.visionio.people import MERGE

THRESHOLD = Settings().threshold


def test_every_face_in_the_photos_is_found_once() -> None:
    assert set(faces()) == {*OBAMA, *OTHERS}


def test_the_distances_of_different_people_are_above_the_threshold() -> None:
    """Compare all pairs of six photos of one man and photos of eight other people."""
    vectors = {name: face.vector for name, face in faces().items()}
    same = [dist(vectors[one], vectors[other]) for one, other in combinations(OBAMA, 2)]
    different = [dist(vectors[one], vectors[other]) for one in OBAMA for other in OTHERS]
    different += [dist(vectors[one], vectors[other]) for one, other in combinations(OTHERS, 2)]
    assert len(same) == 15 and len(different) == 76
    assert max(same) <= MERGE < THRESHOLD < 0.64 <= min(different)


def test_a_vector_has_128_numbers_and_a_quality() -> None:
    for face in faces().values():
        assert len(face.vector) == 128 and 0.1 <= face.quality <= 1


def test_the_worker_computes_no_new_vector_for_a_known_face(monkeypatch: pytest.MonkeyPatch) -> None:
    data, box = photo("biden").read_bytes(), faces()["biden"].box
    [known] = look(data, known=[{"track": 7, "box": box, "fresh": True}])["faces"]
    assert (known["track"], known["vector"], known["quality"]) == (7, None, None)
    [stale] = look(data, known=[{"track": 7, "box": box, "fresh": False}])["faces"]
    assert stale["track"] == 7 and len(stale["vector"]) == 128
    [new] = look(data, known=[{"track": 7, "box": [0, 0, 10, 10], "fresh": True}])["faces"]
    assert new["track"] is None and len(new["vector"]) == 128


def test_a_request_limits_the_number_of_vectors() -> None:
    found = look(photo("six").read_bytes(), most=2)["faces"]
    assert [face["vector"] is not None for face in found] == [True, True, False, False, False, False]


def test_at_least_20_of_24_faces_in_a_picture_are_found(tmp_path: Path) -> None:
    """The faces are 46 to 66 pixels wide in the scaled picture that the worker searches."""
    file = tmp_path / "crowd.jpg"
    make(
        """
six = cv2.imread(a[0])
cv2.imwrite(a[1], np.vstack([np.hstack([six, six]), np.hstack([six, six])]))
""",
        photo("six"), file,
    )  # fmt: skip
    seen = look(file.read_bytes(), most=3)
    assert len(seen["faces"]) >= 20
    assert sum(face["vector"] is not None for face in seen["faces"]) == 3


def test_a_face_in_an_8k_picture_is_found_at_its_place(tmp_path: Path) -> None:
    file = tmp_path / "large.jpg"
    make("cv2.imwrite(a[1], cv2.resize(cv2.imread(a[0]), (7680, 9595)))", photo("obama"), file)
    seen = look(file.read_bytes())
    assert seen["picture"] == [7680, 9595]
    [face] = seen["faces"]
    assert dist(face["vector"], faces()["obama"].vector) < 0.2
    assert face["box"][2] > 2000


def test_a_black_picture_is_dark_and_has_no_face(tmp_path: Path) -> None:
    file = tmp_path / "black.png"
    make("cv2.imwrite(a[0], np.zeros((480, 640, 3), np.uint8))", file)
    assert look(file.read_bytes()) == {"picture": [640, 480], "dark": True, "faces": []}
    assert look(photo("biden").read_bytes())["dark"] is False


def test_the_worker_reads_raw_pixels(tmp_path: Path) -> None:
    file = tmp_path / "raw"
    make("open(a[1], 'wb').write(cv2.cvtColor(cv2.imread(a[0]), cv2.COLOR_BGR2RGB).tobytes())", photo("hanks"), file)
    seen = eye().look_now(["faces"], {"thorough": True}, frame=Frame(file.read_bytes(), (112, 112)))
    assert seen is not None
    assert dist(seen["faces"][0]["vector"], faces()["hanks"].vector) < 0.1


@pytest.mark.parametrize("encoding", ["bgr8", "rgba8", "mono8"])
def test_the_worker_reads_pictures_from_ros(tmp_path: Path, encoding: str) -> None:
    """The rows are padded, as ROS allows."""
    file = tmp_path / "raw"
    make(
        """
kind = {"bgr8": None, "rgba8": cv2.COLOR_BGR2RGBA, "mono8": cv2.COLOR_BGR2GRAY}[a[2]]
picture = cv2.imread(a[0])
rows = (picture if kind is None else cv2.cvtColor(picture, kind)).reshape(112, -1)
open(a[1], "wb").write(np.hstack([rows, np.zeros((112, 5), np.uint8)]).tobytes())
""",
        photo("hanks"), file, encoding,
    )  # fmt: skip
    frames = Frames()
    data = file.read_bytes()
    frames.put_message(
        SimpleNamespace(data=list(data), height=112, width=112, encoding=encoding, step=len(data) // 112)
    )
    frame = asyncio.run(frames.next())
    seen = eye().look_now(["faces"], {"thorough": 1}, frame=frame)
    assert seen is not None
    assert dist(seen["faces"][0]["vector"], faces()["hanks"].vector) < (0.4 if encoding == "mono8" else 0.1)


@pytest.mark.parametrize(
    ("data", "shape", "why"),
    [
        (b"not a picture", None, "not a readable picture"),
        (b"\xff\xd8\xff\xe0" + bytes(100), None, "not a readable picture"),
        (bytes(10), (4, 4), "not a picture of 4 x 4 pixels in rgb8"),
        (b"", None, "the picture is empty"),
    ],
)
def test_a_corrupt_picture_is_reported(data: bytes, shape: tuple[int, int] | None, why: str) -> None:
    with pytest.raises(PlatformError, match=why):
        eye().look_now(["faces"], {}, frame=Frame(data, shape))
    assert look(photo("biden").read_bytes())["faces"]  # the worker still works


def test_a_compressed_picture_of_gigabytes_is_refused(tmp_path: Path) -> None:
    import struct
    import zlib

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = struct.pack(">IIBBBBB", 60_000, 60_000, 8, 2, 0, 0, 0)
    bomb = (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(bytes(1000))) + chunk(b"IEND", b"")
    )
    with pytest.raises(PlatformError, match=r"cannot be read|not a readable picture"):
        eye().look_now(["faces"], {}, frame=Frame(bomb))
