"""Functions that find the Python interpreter for the vision worker, and this machine's camera."""

from __future__ import annotations

import sys
from importlib.util import find_spec
from pathlib import Path

from ravestate.errors import PlatformError
from ravestate.folders import user_folder

MEND = "run `make eyes`, or pip install 'ravestate[eyes]', or set visionio.python to a Python that has the packages"
"""The advice at the end of an error message."""
NEEDED = ("dlib", "cv2", "face_recognition_models")


def eyes_python(given: Path | None = None) -> str:
    """Return the interpreter for the vision worker: `given`, the interpreter of ``make eyes``, or the current one.

    Only the current interpreter is searched for the packages.

    Raises:
        PlatformError: The file `given` does not exist, or the current interpreter lacks a package. The message says how
            to get the packages.
    """
    if given is not None:
        path = given.expanduser()
        if not path.is_file():
            raise PlatformError(f"visionio.python = {str(given)!r}: there is no such file. {MEND}")
        return str(path)
    for folder in (Path(sys.prefix).parent / ".venvs" / "eyes", user_folder("data") / "eyes"):
        if (folder / "bin" / "python").is_file():
            return str(folder / "bin" / "python")
    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise PlatformError(f"visionio needs the packages of the eyes ({', '.join(missing)} missing): {MEND}")
    return sys.executable


def default_camera() -> str | None:
    """Return the first camera of this machine; None if there is none."""
    found = sorted(Path("/dev").glob("video[0-9]*"), key=lambda one: (len(one.name), one.name))
    return str(found[0]) if found else None
