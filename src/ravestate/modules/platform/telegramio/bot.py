"""The bot: it logs in, gets updates by polling or by a webhook, and passes their messages to the room (all its chats)."""

from __future__ import annotations

import asyncio
import hashlib
import logging
import sqlite3
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from telegram import Bot, Update, User
from telegram.error import BadRequest, Conflict, InvalidToken, TelegramError

from ravestate.errors import PlatformError
from ravestate.modules.platform.chats import COMMANDS, Attempts, Incoming, Room

from .carrier import TelegramCarrier
from .requests import Requests, wait_of
from .updates import KINDS, incoming

if TYPE_CHECKING:
    from ravestate.runtime.agent import Agent

    from .names import Settings

POLL = 30  # if there are no updates, the server waits this many seconds before it answers
MOST = 100  # the maximum number of updates in an answer
PATIENCE = 10  # the bot waits for an answer with updates for `POLL` seconds, and for this many more
ANSWER = 20.0  # the maximum number of seconds to wait for the answer to a request, except a request for updates
CONFLICTS = 4  # after this many conflicts in a row, the bot gives up, because another program polls the same bot
SETTLED = 60.0  # a bot that has run for this many seconds does not give up, because the other program came later
CONFLICT_WAIT = 2.0  # the first wait after a conflict (seconds); a request from before a crash is a conflict, too
REVOKED = "telegramio: the token is no longer valid: @BotFather has the new one"
SECRET = "x-telegram-bot-api-secret-token"

log = logging.getLogger("ravestate.telegramio")


async def run(agent: Agent, settings: Settings, token: str) -> None:
    """Run the bot until cancelled."""
    root = settings.base_url.rstrip("/").removesuffix("/bot")
    requests = Requests(connection_pool_size=16, read_timeout=ANSWER, pool_timeout=ANSWER)
    polls = Requests(connection_pool_size=1)
    bot = Bot(token, f"{root}/bot", f"{root}/file/bot", request=requests, get_updates_request=polls)
    try:
        me = await _log_in(bot, root)
        carrier = TelegramCarrier(bot, settings.rate, settings.drafts)
        async with Room(agent, "telegramio", carrier, str(me.id)) as room:
            inlet = Inlet(bot, me, room, carrier, settings)
            sys.stdout.write(f"@{me.username} is on Telegram (Ctrl-C ends it)\n")
            sys.stdout.flush()
            await (inlet.listen(settings.webhook, token) if settings.webhook else inlet.poll())
    finally:
        await bot.shutdown()


async def _log_in(bot: Bot, root: str) -> User:
    """Log in, and return the bot's own user. After any failure except a refused token, try again."""
    attempts = Attempts(log, f"{root} does not answer")
    while True:
        try:
            await bot.initialize()
            await bot.set_my_commands(list(COMMANDS.items()))
            return bot.bot
        except InvalidToken:
            raise PlatformError(
                f"telegramio: {root} refuses the token: compare RAVESTATE_TELEGRAMIO_TOKEN with the token that @BotFather "
                "shows (/mybots)"
            ) from None
        except TelegramError as error:
            await attempts.fail(error.message, wait_of(error))


class Inlet:
    """Gets updates from the server, and passes their messages to `room` (all chats of the bot)."""

    def __init__(self, bot: Bot, me: User, room: Room, carrier: TelegramCarrier, settings: Settings) -> None:
        self._bot, self._me, self._room, self._carrier, self._settings = bot, me, room, carrier, settings

    async def listen(self, url: str, token: str) -> None:
        """Receive the updates that the server sends to a webhook. The webhook stays set at the end, so no update is lost."""
        from ravestate.modules.platform.chats.webhook import listen

        secret = hashlib.sha256(f"webhook {token}".encode()).hexdigest()
        address = (self._settings.host, self._settings.port)

        async def announce() -> None:
            attempts = Attempts(log, "the webhook is not set")
            while not self._carrier.current.is_set():
                try:
                    await self._bot.set_webhook(url, secret_token=secret, allowed_updates=KINDS)
                    self._carrier.current.set()
                except BadRequest as error:
                    raise PlatformError(
                        f"telegramio: Telegram refuses the webhook {url}: {error.message} (setting telegramio.webhook)"
                    ) from None
                except InvalidToken:
                    raise PlatformError(REVOKED) from None
                except TelegramError as error:
                    await attempts.fail(error, wait_of(error))

        await listen(url, address, SECRET, secret, lambda update: self.take([update]), announce)

    async def poll(self) -> None:
        """Ask the server for updates until cancelled."""
        offset, conflicts, ready = 0, 0, False
        attempts = Attempts(log, "no updates")
        now = asyncio.get_running_loop().time
        settled = now() + SETTLED
        # `Bot.get_updates` would fail for all updates of an answer if one of them is malformed.
        post: Any = self._bot._post  # pyright: ignore[reportPrivateUsage]
        while True:
            try:
                ready = ready or await self._bot.delete_webhook()
                hold = POLL if self._carrier.current.is_set() else 0
                request: dict[str, Any] = {"timeout": hold, "allowed_updates": KINDS, "offset": offset or None}
                updates: list[Any] = await post("getUpdates", request, read_timeout=hold + PATIENCE)
                self.take(updates)
                offset = max((int(each["update_id"]) + 1 for each in updates), default=offset)
                if len(updates) < MOST:
                    self._carrier.current.set()
                conflicts = 0
                attempts.succeed()
            except InvalidToken:
                raise PlatformError(REVOKED) from None
            except Conflict as error:
                conflicts += 1
                if conflicts >= CONFLICTS and now() < settled:
                    raise PlatformError(
                        "telegramio: another program gets the messages of this bot: end it, or make another bot "
                        f"({error.message})"
                    ) from None
                log.warning("another program asks for the messages of this bot")
                await asyncio.sleep(CONFLICT_WAIT * min(conflicts, CONFLICTS))
            except (TelegramError, sqlite3.Error, TypeError, KeyError, ValueError) as error:
                await attempts.fail(error, wait_of(error))

    def take(self, updates: Sequence[Mapping[str, Any]]) -> None:
        """Pass updates to the room, which stores them. The caller may acknowledge them after the call."""
        self._room.receive(self._room.read(updates, self._read))

    def _read(self, data: Mapping[str, Any]) -> Incoming | None:
        update = Update.de_json(dict(data), self._bot)
        if (known := update.effective_message) is not None:
            self._carrier.note(str(known.chat.id), str(known.message_id))
        return incoming(update, self._me, {self._me.first_name, *self._room.called})
