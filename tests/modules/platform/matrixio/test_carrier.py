"""The carrier edits and deletes the agent's messages, and fetches files, without a homeserver."""

import asyncio
import json
from types import SimpleNamespace
from typing import Any

import pytest
from nio.crypto import encrypt_attachment

from ravestate.modules.platform.chats import DeliveryError, Outgoing
from ravestate.modules.platform.matrixio.carrier import MatrixCarrier

SECRET, KEYS = encrypt_attachment(b"a picture")
"""The bytes of an encrypted file, and the fields with which its sender describes it."""


class Client:
    """A stand-in for the client of matrix-nio. It notes the requests, and each event gets a new id."""

    def __init__(self) -> None:
        self.requests: list[tuple[Any, ...]] = []

    async def room_send(self, room: str, kind: str, content: dict[str, Any], **_: Any) -> Any:
        return self._answer("send", room, content)

    async def room_redact(self, room: str, event: str, tx_id: str) -> Any:
        return self._answer("redact", room, event, tx_id)

    async def download(self, url: str) -> Any:
        self.requests.append(("download", url))
        return SimpleNamespace(body=SECRET, transport_response=SimpleNamespace(status=200))

    def _answer(self, *request: Any) -> Any:
        self.requests.append(request)
        return SimpleNamespace(event_id=f"$new{len(self.requests)}", transport_response=SimpleNamespace(status=200))


def sent(*messages: Outgoing) -> tuple[list[str], list[tuple[Any, ...]]]:
    client = Client()
    carrier = MatrixCarrier(client)  # type: ignore[arg-type]

    async def send() -> list[str]:
        return [await carrier.send(message, False) for message in messages]

    return asyncio.run(send()), client.requests


def test_a_second_edit_relates_to_the_first_event_and_not_to_the_first_edit() -> None:
    """An event that replaces an event must not be replaced itself (client-server API, event replacements)."""
    ids, requests = sent(
        Outgoing(key="1", chat="!r", text="one"), Outgoing(key="2", chat="!r", kind="edit", to="$new1")
    )
    assert ids == ["$new1", "$new1"]
    assert requests[1][2]["m.relates_to"] == {"rel_type": "m.replace", "event_id": "$new1"}


def test_a_message_is_deleted_by_a_redaction_with_the_key_of_the_order() -> None:
    _, requests = sent(Outgoing(key="k", chat="!r", kind="delete", to="$old"))
    assert requests == [("redact", "!r", "$old", "k")]


def fetched(file: str) -> bytes:
    return asyncio.run(MatrixCarrier(Client()).fetch(file))  # type: ignore[arg-type]


def test_an_encrypted_file_is_decrypted() -> None:
    assert fetched(json.dumps({**KEYS, "url": "mxc://x/1"})) == b"a picture"


@pytest.mark.parametrize(
    "file",
    [
        "https://example.org/x.png",
        "mxc://[",
        "[]",
        json.dumps(KEYS),
        json.dumps({**KEYS, "url": 1}),
        json.dumps({**KEYS, "url": "mxc://x/1", "key": {}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "key": "a text"}),
        json.dumps({**KEYS, "url": "mxc://x/1", "key": {"k": "AAAA"}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "hashes": {}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "hashes": {"sha256": 1}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "hashes": {"sha256": "é"}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "hashes": {"sha256": "AAAA"}}),
        json.dumps({**KEYS, "url": "mxc://x/1", "iv": "_" * 100}),
        json.dumps({**KEYS, "url": "mxc://x/1", "iv": ""}),
        json.dumps({**KEYS, "url": "mxc://x/1", "iv": None}),
    ],
)
def test_a_damaged_or_forged_file_is_an_error_of_the_delivery_which_is_not_tried_again(file: str) -> None:
    with pytest.raises(DeliveryError, match="damaged") as caught:
        fetched(file)
    assert caught.value.final
