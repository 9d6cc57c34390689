"""Server-sent events, as far as OpenAI-compatible servers use them: bytes in, payloads out."""

from __future__ import annotations

__all__ = ["EventTooLong", "Events"]


class EventTooLong(ValueError):
    """A line of the stream exceeds the limit: this is no stream of events."""


class Events:
    """Cuts a stream of bytes into the payloads of its ``data:`` lines.

    Each line counts as one event (these servers put each JSON document on one line), comments and other
    fields are skipped. Lines end in ``\\n`` or ``\\r\\n`` only: U+2028 and its like may stand in a JSON text.

    Example:
        >>> Events().feed(b': ping\\n\\ndata: {"a": 1}\\n\\ndata: [DO')
        ['{"a": 1}']
    """

    def __init__(self, limit: int = 1 << 20) -> None:
        """`limit`: no line is longer than so many bytes."""
        self._limit = limit
        self._rest = b""

    def feed(self, received: bytes) -> list[str]:
        """Take what was received, and return the payloads that it completes.

        Raises:
            EventTooLong: A line exceeds the limit.
        """
        *lines, self._rest = (self._rest + received).split(b"\n")
        if len(self._rest) > self._limit:
            raise EventTooLong(f"a line of more than {self._limit} bytes")
        return [payload for line in lines if (payload := _payload(line)) is not None]

    def finish(self) -> list[str]:
        """Return the payload of a last line that had no line end."""
        line, self._rest = self._rest, b""
        payload = _payload(line)
        return [] if payload is None else [payload]


def _payload(line: bytes) -> str | None:
    field, colon, value = line.rstrip(b"\r").partition(b":")
    # llama.cpp used to report a failure in a field of its own.
    if not colon or field.removeprefix(b"\xef\xbb\xbf") not in (b"data", b"error"):
        return None
    text = value.decode("utf-8", "replace").removeprefix(" ")
    return f'{{"error": {text}}}' if field == b"error" else text
