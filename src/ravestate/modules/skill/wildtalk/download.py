"""The download of a chat model from the hub: resumed after an interruption, and verified before it counts."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import math
import os
import shutil
import time
from collections.abc import Callable, Generator
from typing import IO, TYPE_CHECKING

from ravestate.errors import PlatformError

from .backend import Progress
from .model_store import CatalogueModel

if TYPE_CHECKING:
    import httpx

HUB = "https://huggingface.co"
TRIES = 5
"""Attempts in a row that may fail before a byte arrives."""
LONGEST = 120.0
"""The longest wait in seconds that a hub may ask for before another attempt."""
SPARE = 64 << 20
"""Bytes that a download leaves free on the disk."""

_AGAIN = (408, 429, 500, 502, 503, 504)


def size_of(number: float) -> str:
    """Return a number of bytes for people."""
    return f"{number / 1e9:.1f} GB" if number >= 1e9 else f"{number / 1e6:.0f} MB"


def download(model: CatalogueModel, progress: Progress, sleep: Callable[[float], None] = time.sleep) -> None:
    """Fetch a model's file. An unfinished download is continued; a finished one is verified and gets its name.

    ``HF_ENDPOINT`` names another hub, and ``HF_TOKEN`` a token for it, as for other programs of the hub.

    Args:
        model: The model; its `part` keeps the bytes of an interrupted download.
        progress: A callback with the fraction of the file that has arrived.
        sleep: Waits between attempts.

    Raises:
        PlatformError: The hub, the network or the disk refuses, or the file is not the catalogue's. The message says
            what to do.
    """
    try:
        import httpx
    except ImportError as error:
        raise PlatformError("fetching a model needs httpx: pip install 'ravestate[wildtalk]'") from error
    hub = os.environ.get("HF_ENDPOINT", "").strip().rstrip("/") or HUB
    if os.environ.get("HF_HUB_OFFLINE", "").upper() in ("1", "ON", "YES", "TRUE"):
        raise PlatformError("HF_HUB_OFFLINE forbids downloads: unset it, and repeat the command")
    try:
        model.part.parent.mkdir(parents=True, exist_ok=True)
        with _alone(model) as part, httpx.Client(headers=_headers(hub), follow_redirects=True, timeout=30.0) as client:
            _fetch(model, part, hub, client, progress, sleep)
            _verify(model, part)
        os.replace(model.part, model.path)
    except OSError as error:
        if error.errno == errno.ENOSPC:
            raise PlatformError(
                f"the disk is full{_kept(model)}: free {size_of(model.size)} at {model.part.parent}, and repeat the command"
            ) from error
        raise PlatformError(f"{model.part} cannot be written: {error.strerror or error}") from error


def _public(hub: str) -> str:
    """Return the hub's address without a password."""
    scheme, mark, rest = hub.rpartition("://")
    return f"{scheme}{mark}{rest.rpartition('@')[2]}"


def _headers(hub: str) -> dict[str, str]:
    """Return the request's headers. A token goes only to an encrypted hub, or to one on this machine."""
    token = os.environ.get("HF_TOKEN", "").strip()
    secure = hub.startswith(("https://", "http://localhost", "http://127."))
    return {
        "Accept-Encoding": "identity",
        **(
            {"Authorization": f"Bearer {token}"} if token and secure and token.isascii() and token.isprintable() else {}
        ),
    }


@contextlib.contextmanager
def _alone(model: CatalogueModel) -> Generator[IO[bytes]]:
    """Open the unfinished file, and refuse a second process that fetches the same model. An empty file is removed."""
    empty = False
    try:
        with model.part.open("ab") as part:
            try:
                import fcntl

                fcntl.lockf(part, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except ImportError:  # Windows has no such lock
                pass
            except BlockingIOError:
                raise PlatformError(f"another process fetches {model.name} just now") from None
            try:
                yield part
            finally:
                empty = not part.tell()
    finally:
        if empty:
            model.part.unlink()


def _fetch(
    model: CatalogueModel,
    part: IO[bytes],
    hub: str,
    client: httpx.Client,
    progress: Progress,
    sleep: Callable[[float], None],
) -> None:
    """Append to `part` until the file is complete; go on after each broken connection."""
    import httpx

    _make_room(model, part)
    begin, failed = part.tell(), 0
    while (have := part.tell()) < model.size:
        wait, reason = 2.0**failed, "it sent less than the whole file"
        try:
            wait, reason = _attempt(model, part, hub, client, progress) or (wait, reason)
        except (httpx.InvalidURL, httpx.UnsupportedProtocol) as error:
            raise PlatformError(f"HF_ENDPOINT is not a web address: {error}") from error
        except (httpx.TransportError, httpx.TooManyRedirects, httpx.DecodingError) as error:
            reason = str(error) or type(error).__name__
            if isinstance(error, httpx.ConnectError) and have == begin:
                wait = math.inf  # there is no network, or no such hub
        failed = 0 if part.tell() > have else failed + 1
        if failed >= TRIES or wait > LONGEST:
            raise PlatformError(
                f"{_public(hub)} does not deliver {model.file} ({reason}){_kept(model)}. Check the network, or name a mirror in "
                f"HF_ENDPOINT, and repeat the command. Or copy any chat model in GGUF format into {model.part.parent}"
            )
        if part.tell() < model.size:
            sleep(wait)
    progress(1.0)


def _attempt(
    model: CatalogueModel, part: IO[bytes], hub: str, client: httpx.Client, progress: Progress
) -> tuple[float, str] | None:
    """Send one request, and write what arrives. Return how long to wait, and why, if the hub asks for it."""
    have = part.tell()
    address = f"{hub}/{model.repository}/resolve/{model.revision}/{model.file}"
    with client.stream("GET", address, headers={"Range": f"bytes={have}-"} if have else {}) as answer:
        status = answer.status_code
        if status in _AGAIN:
            asked = answer.headers.get("Retry-After", "")
            wait = float(asked) if asked.isascii() and asked.isdigit() else 2.0
            return wait, f"it answers {status}" + (f" and asks to wait {wait:.0f} s" if wait > LONGEST else "")
        if status not in (200, 206):
            raise _refusal(model, hub, status)
        if status == 200 and have:  # this hub sends whole files only
            part.truncate(0)
            part.seek(0)
        elif status == 206 and not answer.headers.get("Content-Range", "").startswith(f"bytes {have}-"):
            raise PlatformError(f"{_public(hub)} sent another part of {model.file} than was asked for")
        for block in answer.iter_bytes():
            part.write(block)
            if part.tell() > model.size:
                break  # not this file; the checksum will say so
            progress(part.tell() / model.size)
    part.flush()
    return None


def _refusal(model: CatalogueModel, hub: str, status: int) -> PlatformError:
    hub = _public(hub)
    if status in (401, 403):
        return PlatformError(
            f"{hub} does not give {model.file} to everybody ({status}): put a token of your account there into HF_TOKEN"
        )
    if status == 404:
        return PlatformError(
            f"{hub} has no {model.repository}/{model.file} any more (404): take another model (ravestate model list)"
        )
    return PlatformError(f"{hub} refuses {model.file} ({status}): is HF_ENDPOINT right?")


def _make_room(model: CatalogueModel, part: IO[bytes]) -> None:
    if part.tell() > model.size:
        part.truncate(0)
        part.seek(0)
    missing = model.size - part.tell()
    if missing and shutil.disk_usage(model.part.parent).free < missing + SPARE:
        free = size_of(shutil.disk_usage(model.part.parent).free)
        raise PlatformError(
            f"{model.name} needs {size_of(missing + SPARE)} at {model.part.parent}, where {free} are free"
        )


def _verify(model: CatalogueModel, part: IO[bytes]) -> None:
    part.flush()
    os.fsync(part.fileno())
    with model.part.open("rb") as file:
        found = hashlib.file_digest(file, "sha256").hexdigest()
    if found != model.sha256:
        model.part.unlink()
        raise PlatformError(
            f"the file that arrived is not {model.file}: its SHA-256 is {found}, not {model.sha256}. It is removed; repeat "
            "the command, and if this happens again, the network or the hub changes files"
        )


def _kept(model: CatalogueModel) -> str:
    """Return how much of a model has arrived, as the end of a message; empty for nothing."""
    have = model.part.stat().st_size if model.part.exists() else 0
    return f"; {size_of(have)} of {size_of(model.size)} are kept in {model.part}" if have else ""


def interrupted(model: CatalogueModel) -> str:
    """Return the message for a download that the user interrupts."""
    kept = _kept(model)
    return f"interrupted{kept}, and the same command continues" if kept else "interrupted; nothing had arrived yet"
