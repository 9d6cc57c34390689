"""Download a chat model from the hub of Hugging Face: resume after an interruption, and verify the file before it is
used."""

from __future__ import annotations

import contextlib
import errno
import hashlib
import logging
import os
import shutil
from collections.abc import Generator
from typing import Any, BinaryIO, cast

from ravestate.errors import PlatformError

from .model_store import CatalogueModel

SPARE = 64 << 20
"""The least number of bytes that a download must leave free on the disk."""


def size_of(number: float) -> str:
    """Return a number of bytes in a form that people read easily, such as ``1.1 GB``."""
    return f"{number / 1e9:.1f} GB" if number >= 1e9 else f"{number / 1e6:.0f} MB"


def download(model: CatalogueModel) -> None:
    """Fetch a model's file, with a progress bar on a terminal. Verify the finished file, then give it its name.

    `model.part` keeps the bytes of an interrupted download for the next call. As in other programs for the hub,
    ``HF_ENDPOINT`` may give the address of another hub, and ``HF_TOKEN`` a token.

    Raises:
        PlatformError: The hub, the network or the disk fails, or the file differs from the catalogue's checksum. The
            message names the remedy.
    """
    if os.environ.get("HF_HUB_OFFLINE", "").upper() in ("1", "ON", "YES", "TRUE"):
        raise PlatformError("HF_HUB_OFFLINE forbids downloads: unset it, and repeat the command")
    try:
        model.part.parent.mkdir(parents=True, exist_ok=True)
        with alone(model) as part:
            _fetch(model, part)
            _verify(model, part)
        os.replace(model.part, model.path)
    except OSError as error:
        if error.errno == errno.ENOSPC:
            raise PlatformError(
                f"the disk is full{_kept(model)}: free {size_of(model.size)} at {model.part.parent}, and repeat the command"
            ) from error
        raise PlatformError(f"{model.part} cannot be written: {error.strerror or error}") from error


@contextlib.contextmanager
def alone(model: CatalogueModel) -> Generator[BinaryIO]:
    """Open the unfinished file, and refuse a second process that fetches or removes the model. At the end, remove an empty
    file."""
    with model.part.open("ab") as part:
        try:
            import fcntl

            fcntl.lockf(part, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except ImportError:  # Windows has no such lock
            pass
        except BlockingIOError:
            raise PlatformError(f"another process is fetching {model.name}: wait until it has finished") from None
        try:
            yield part
        finally:
            if not part.tell():
                model.part.unlink(missing_ok=True)


def _fetch(model: CatalogueModel, part: BinaryIO) -> None:
    """Append the rest of the file to `part`. After a broken connection, the library resumes."""
    try:
        import httpx2
        from huggingface_hub import file_download, get_token, hf_hub_url
        from huggingface_hub.errors import HfHubHTTPError
    except ImportError as error:
        raise PlatformError("fetching a model needs huggingface_hub: pip install 'ravestate[wildtalk]'") from error
    hub = os.environ.get("HF_ENDPOINT", "").strip().rstrip("/") or "https://huggingface.co"
    public = hub.rpartition("@")[2]  # without a password
    # A token goes only to an encrypted hub, or to a hub on this machine.
    token = get_token() if hub.startswith(("https://", "http://localhost", "http://127.")) else None
    if part.tell() > model.size:
        part.truncate(0)
    have = part.seek(0, os.SEEK_END)
    free = shutil.disk_usage(model.part.parent).free
    if have < model.size and free < model.size - have + SPARE:
        raise PlatformError(
            f"{model.name} needs {size_of(model.size - have + SPARE)} at {model.part.parent}, where {size_of(free)} are free"
        )
    logging.getLogger("huggingface_hub").setLevel(logging.ERROR)  # the library logs each attempt as a warning
    try:
        cast("Any", file_download).http_get(
            hf_hub_url(model.repository, model.file, revision=model.revision, endpoint=hub),
            part,
            resume_size=have,
            headers={"Accept-Encoding": "identity", **({"Authorization": f"Bearer {token}"} if token else {})},
            expected_size=model.size,
            displayed_filename=f"Fetching {model.name}",
        )
    except HfHubHTTPError as error:
        status = error.response.status_code
        mend = {
            401: "put a token of your account there into HF_TOKEN",
            403: "put a token of your account there into HF_TOKEN",
            404: "it no longer has the file; take another model (ravestate model list)",
        }.get(
            status, "wait, and repeat the command" if status in (408, 429) or status >= 500 else "is HF_ENDPOINT right?"
        )
        raise PlatformError(f"{public} refuses {model.file} ({status}): {mend}") from error
    except (httpx2.InvalidURL, httpx2.UnsupportedProtocol) as error:
        raise PlatformError(f"HF_ENDPOINT is not a web address: {error}") from error
    except (httpx2.HTTPError, OSError) as error:
        if getattr(error, "errno", None) is not None:
            raise
        if part.tell() >= model.size:
            return  # the file is too long; the checksum will show that
        raise PlatformError(
            f"{public} does not deliver {model.file} ({error}){_kept(model)}. Check the network, or name a mirror in "
            f"HF_ENDPOINT, and repeat the command. Or copy any chat model in GGUF format into {model.part.parent}"
        ) from error


def _verify(model: CatalogueModel, part: BinaryIO) -> None:
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
    """Return the end of a message, with the size of the part that has arrived; empty if no byte has arrived."""
    have = model.part.stat().st_size if model.part.exists() else 0
    return f"; {size_of(have)} of {size_of(model.size)} are kept in {model.part}" if have else ""


def interrupted(model: CatalogueModel) -> str:
    """Return the message for a download that the user interrupts."""
    kept = _kept(model)
    return f"interrupted{kept}, and the same command continues" if kept else "interrupted; nothing had arrived yet"
