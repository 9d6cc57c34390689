"""The bot: it logs in, gets updates by polling or by a webhook, and gives them to the room."""

from __future__ import annotations

import asyncio
import hashlib
import logging
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from telegram import Bot, User
from telegram.error import Conflict, InvalidToken, TelegramError

from ravestate.errors import PlatformError
from ravestate.modules import interloc
from ravestate.modules.platform.chats import COMMANDS, Incoming, Room, Store
from ravestate.modules.platform.chats.sender import back_off
from ravestate.modules.platform.chats.voice import words_in

from .carrier import TelegramCarrier
from .names import Settings, chat, command
from .requests import FloodError, Requests
from .serving import store_path
from .updates import KINDS, allowed, incoming, parse

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

POLL = 30
"""The seconds for which the server holds a request for updates, if there are none."""

CONFLICTS = 4
"""The number of conflicts in a row after which the bot gives up: another program polls it all the time."""

CONFLICT_WAIT = 2.0
"""The seconds to wait after the first conflict. After a crash, the server still holds the old process's request."""

log = logging.getLogger("ravestate.telegramio")


async def run(agent: Agent, settings: Settings, token: str) -> None:
    """Run the bot until cancelled."""
    root = settings.base_url.rstrip("/").removesuffix("/bot")
    bot = Bot(
        token,
        base_url=f"{root}/bot",
        base_file_url=f"{root}/file/bot",
        request=Requests(connection_pool_size=16, read_timeout=20.0, pool_timeout=20.0),
        get_updates_request=Requests(connection_pool_size=1),
    )
    try:
        me = await _log_in(bot, root)
        carrier = TelegramCarrier(bot, settings.rate)
        room = Room(
            agent, name="telegramio", carrier=carrier, store=Store(store_path(settings, me.id)), slot=chat,
            command=command, rest=settings.rest, limit=settings.chats, transcribe=words_in,
        )  # fmt: skip
        async with room:
            inlet = Inlet(bot, me, room, carrier, settings)
            log.info("@%s is on Telegram (Ctrl-C ends it)", me.username)
            await inlet.run(token)
    finally:
        await bot.shutdown()


async def _log_in(bot: Bot, root: str) -> User:
    """Return the bot's own user; wait until the server answers."""
    attempt = 0
    while True:
        try:
            await bot.initialize()
            await bot.set_my_commands(list(COMMANDS.items()))
            return bot.bot
        except InvalidToken:
            raise PlatformError(
                f"telegramio: {root} refuses the token: compare RAVESTATE_TELEGRAMIO_TOKEN with the one that @BotFather "
                "shows (/mybots)"
            ) from None
        except FloodError as error:
            await asyncio.sleep(error.seconds)
        except TelegramError as error:
            if attempt in (0, 5):
                log.warning("%s does not answer (%s); trying again", root, error.message)
            await asyncio.sleep(back_off(attempt))
            attempt += 1


class Inlet:
    """Takes updates from the server, and gives them to a room."""

    def __init__(self, bot: Bot, me: User, room: Room, carrier: TelegramCarrier, settings: Settings) -> None:
        self._bot = bot
        self._me = me
        self._room = room
        self._carrier = carrier
        self._settings = settings
        self._refused: set[int] = set()

    async def run(self, token: str) -> None:
        """Take updates until cancelled."""
        if self._settings.webhook:
            from .webhook import listen

            secret = hashlib.sha256(f"webhook {token}".encode()).hexdigest()
            await listen(self._bot, self._settings, secret, KINDS, self.take)
        else:
            await self._poll()

    async def _poll(self) -> None:
        offset, attempt, conflicts, ready = None, 0, 0, False
        while True:
            try:
                if not ready:
                    ready = await self._bot.delete_webhook()
                request = {"timeout": POLL, "allowed_updates": KINDS, **({"offset": offset} if offset else {})}
                # `Bot.get_updates` would fail for all updates of an answer if one of them is malformed.
                post: Any = self._bot._post  # pyright: ignore[reportPrivateUsage]
                found: Any = await post("getUpdates", request, read_timeout=POLL + 10)
                updates = [each for each in found if isinstance(each, dict)]
                self.take(updates)
                offset = max((each.get("update_id", 0) + 1 for each in updates), default=offset)
                attempt = conflicts = 0
            except InvalidToken:
                raise PlatformError(
                    "telegramio: the server no longer accepts the token: @BotFather has the new one"
                ) from None
            except Conflict as error:
                conflicts += 1
                if conflicts >= CONFLICTS:
                    raise PlatformError(
                        "telegramio: another program gets the messages of this bot: end it, or make another bot "
                        f"({error.message})"
                    ) from None
                await asyncio.sleep(CONFLICT_WAIT * conflicts)
            except FloodError as error:
                await asyncio.sleep(error.seconds)
            except (TelegramError, TypeError) as error:
                log.log(logging.WARNING if attempt == 3 else logging.INFO, "no updates: %s", error)
                await asyncio.sleep(back_off(attempt))
                attempt += 1

    def take(self, updates: Sequence[Mapping[str, Any]]) -> None:
        """Give updates to the room. After the call they are kept, and may be acknowledged."""
        messages: list[Incoming] = []
        for data in updates:
            try:
                update = parse(data, self._bot)
                if update is None:
                    continue
                if message := update.effective_message:
                    self._carrier.note(str(message.chat.id), str(message.message_id))
                if not allowed(update, self._settings.allow):
                    self._refuse(update.effective_user)
                elif (message := incoming(update, self._me, self._names)) is not None:
                    messages.append(message)
            except Exception:
                log.exception("an update cannot be read, and is left out")
        self._room.receive(messages)

    @property
    def _names(self) -> tuple[str, ...]:
        return (interloc.agent.default, self._me.first_name)

    def _refuse(self, user: User | None) -> None:
        if user is not None and user.id not in self._refused:
            self._refused.add(user.id)
            log.warning("%s (%s) is not in telegramio.allow, and gets no answer", user.id, user.first_name)
