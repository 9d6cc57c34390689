"""The carrier edits and deletes the agent's messages, without a homeserver."""

import asyncio
from types import SimpleNamespace
from typing import Any

from ravestate.modules.platform.chats import Outgoing
from ravestate.modules.platform.matrixio.carrier import MatrixCarrier


class Client:
    """A stand-in for the client of matrix-nio. It notes the requests, and each event gets a new id."""

    def __init__(self) -> None:
        self.requests: list[tuple[Any, ...]] = []

    async def room_send(self, room: str, kind: str, content: dict[str, Any], **_: Any) -> Any:
        return self._answer("send", room, content)

    async def room_redact(self, room: str, event: str, tx_id: str) -> Any:
        return self._answer("redact", room, event, tx_id)

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
