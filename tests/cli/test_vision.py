"""``ravestate vision`` names the people in pictures, learns faces, and checks the worker and the camera."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli.examples import call
from modules.modality.visionio.photographs import eye, photo
from ravestate.modules.modality.visionio import places

LINE = re.compile(r"(\S.*?) +(-|\d\.\d{3})  -?\d+,-?\d+,\d+,\d+  (.+)")


@pytest.fixture(scope="module", autouse=True)
def worker() -> Iterator[None]:
    """Keep one vision worker for all commands. Otherwise each command would start its own."""
    eye()
    yield
    eye().close()
    eye.cache_clear()


def rows(text: str) -> list[tuple[str, str, str]]:
    """Return the name, the distance and the file's stem from each line."""
    found = [LINE.fullmatch(line) for line in text.splitlines()]
    return [(hit[1], hit[2], Path(hit[3]).stem) for hit in found if hit is not None]


def test_vision_who_names_a_face_only_between_vision_learn_and_vision_forget(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    memory = ("--path", str(tmp_path / "memory.lbug"))
    code, out, errors = call(capsys, "vision", "who", *memory, str(photo("obama")))
    assert code == 0 and rows(out) == [("unknown", "-", "obama")] and "there is no memory in" in errors
    assert not (tmp_path / "memory.lbug").exists()
    code, out, _ = call(capsys, "vision", "learn", *memory, "Barack", str(photo("obama")), str(photo("obama2")))
    assert (code, out) == (0, "learnt 2 views of Barack\n")
    code, out, _ = call(capsys, "vision", "who", *memory, str(photo("obama3")), str(photo("biden")), str(photo("six")))
    assert code == 0
    assert [name for name, _, _ in rows(out)] == ["Barack", *["unknown"] * 7]
    assert [float(distance) <= 0.45 for _, distance, _ in rows(out)] == [True, *[False] * 7]
    code, out, _ = call(capsys, "vision", "learn", *memory, "Barack", str(photo("obama")))
    assert (code, out) == (0, "learnt 0 views of Barack\n")  # the view is known already
    # Memory knows this face under another name.
    code, _, errors = call(capsys, "vision", "learn", *memory, "Joe", str(photo("obama3")))
    assert code == 1 and "memory knows this face as Barack" in errors and "memory forget" in errors
    code, out, _ = call(capsys, "memory", *memory, "forget", "--yes", "Barack")
    assert (code, out) == (0, "forgot 3 nodes\n")
    code, out, _ = call(capsys, "vision", "who", *memory, str(photo("obama")))
    assert rows(out) == [("unknown", "-", "obama")]


def test_files_that_are_not_pictures_are_reported_and_other_files_are_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = tmp_path / "bad.jpg"
    bad.write_bytes(b"not a picture")
    code, out, errors = call(capsys, "vision", "who", str(bad), str(photo("hanks")))
    assert code == 1 and "bad.jpg: the bytes are not a readable picture" in errors and len(rows(out)) == 1
    code, _, errors = call(capsys, "vision", "who", str(tmp_path / "none.jpg"))
    assert code == 2 and "there is no file" in errors
    code, _, errors = call(capsys, "vision", "who", str(tmp_path))
    assert code == 2 and "is a folder" in errors


@pytest.mark.parametrize(
    ("files", "why"),
    [(("six",), "has 6 faces"), (("obama", "biden"), "shows a different person")],
)
def test_vision_learn_refuses_a_picture_of_several_people_and_pictures_of_different_people(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], files: tuple[str, ...], why: str
) -> None:
    memory = tmp_path / "memory.lbug"
    code, _, errors = call(capsys, "vision", "learn", "--path", str(memory), "Ada", *(str(photo(one)) for one in files))
    assert code == 2 and why in errors and not memory.exists()


def test_the_action_check_reports_the_worker_and_the_camera(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = call(capsys, "vision", "check", "--set", "visionio.source=/dev/video9")
    assert code == 0 and "finds and recognises faces" in out and "/dev/video9" in out


def test_the_message_for_a_missing_part_says_how_to_install_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(places.sys, "prefix", str(tmp_path / "env"))
    monkeypatch.setattr(places, "find_spec", lambda _: None)
    code, _, errors = call(capsys, "vision", "who", str(photo("hanks")))
    assert code == 1 and "make eyes" in errors and "ravestate[eyes]" in errors
    code, out, _ = call(capsys, "vision", "check")
    assert code == 1 and "MISSING" in out
    code, _, errors = call(capsys, "vision", "who", str(photo("hanks")), "--set", "visionio.python=/no/python")
    assert code == 1 and "there is no such file" in errors
