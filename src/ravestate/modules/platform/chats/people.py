"""The people in a chat: their names for the agent, and their accounts in its memory."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from typing import TYPE_CHECKING

from ravestate.errors import RavestateError
from ravestate.modules import interloc

from .messages import Person

if TYPE_CHECKING:
    from ravestate.modules.meta.ontology import Graph, Memory, Node
    from ravestate.runtime.context import Context

MEMORY = "ontology:memory"
PATIENCE = 30.0
"""The maximum number of seconds to wait for memory. After that, the conversation begins without memory."""


async def welcome(context: Context, platform: str, person: Person, log: logging.Logger, origin: object) -> None:
    """Add a person to the present users, with the name that memory has for their account.

    If memory has no name, use the person's name on the messenger. If memory fails or takes too long, use no name.

    The rules that react to the new user, such as a greeting, get `origin` as ``ctx.origin``.
    """
    name: str | None = person.name
    try:
        async with asyncio.timeout(PATIENCE):
            memory = await _memory(context)
            if memory is not None:
                account = _account(platform, person)
                node = await memory.together(lambda graph: _known(graph, account, person.name))
                name = interloc.Recognised(node["name"], node) if node.get("name") else name
    except (RavestateError, TimeoutError) as error:
        log.warning("memory could not look up a person: %s", str(error) or "it took too long")
        name = None  # memory may know another person of this name
    join(context, key(platform, person), name, origin)


async def recalled(context: Context) -> None:
    """Wait until memory has answered the rules' questions about a new person, and the rules have noted the answers."""
    with contextlib.suppress(RavestateError, TimeoutError):
        async with asyncio.timeout(PATIENCE):
            for _ in range(2):  # the rules may ask again after the first answer; memory answers in order
                if (memory := await _memory(context)) is not None:
                    await memory.together(lambda _: None)


def join(context: Context, key: str, name: str | None, origin: object = None) -> None:
    """Add a user to the present users."""
    context.put(interloc.users, {**context.read(interloc.users), key: name}, origin=origin)


def leave(context: Context, key: str, origin: object = None) -> None:
    """Remove a user from the present users."""
    users = context.read(interloc.users)
    context.put(interloc.users, {each: user for each, user in users.items() if each != key}, origin=origin)


def present(context: Context, platform: str, person: Person) -> bool:
    """Return whether a person is one of the present users."""
    return key(platform, person) in context.read(interloc.users)


async def forget(context: Context, platform: str, person: Person) -> None:
    """Remove a person from memory, and raise ``interloc.forgotten``.

    This also removes the entries that only this person needs (see `Graph.forget`).

    Raises:
        RavestateError: Memory failed.
    """
    memory = await _memory(context)
    account = _account(platform, person)
    if memory is not None:
        for known in await memory.find("Account", name=account):
            for node in await memory.related(known, "has_account", back=True):
                await memory.forget(node)
    context.emit(interloc.forgotten)


def key(platform: str, person: Person) -> str:
    """Return the key of a person in ``interloc.users``."""
    return f"{platform}-{person.id}"


def _account(platform: str, person: Person) -> str:
    return f"{platform}:{person.id}"


async def _memory(context: Context) -> Memory | None:
    """Return the agent's open memory; None if the agent has none."""
    if MEMORY not in context.policy.slots:
        return None
    from ravestate.modules import ontology

    for _ in range(3):  # the rule that opens memory needs a few turns of the loop
        if (memory := context.read(ontology.memory)) is not None:
            await memory.opened()
            return memory
        await asyncio.sleep(0)
    return None


def _known(graph: Graph, account: str, name: str | None) -> Node:
    """Return the person who has an account. If memory knows nobody with this account, save a new person."""
    from ravestate.modules.meta.ontology import Node

    known = graph.find("Account", {"name": account})
    people = graph.related(known[0], "has_account", back=True) if known else []
    if people:
        return people[0]
    person = graph.save(Node("Person", {"name": name}))
    graph.relate(person, "has_account", known[0] if known else graph.save(Node("Account", {"name": account})), {})
    return person
