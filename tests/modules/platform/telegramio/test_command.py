"""``ravestate run telegramio``: its messages at the start and at the end."""

import os
import signal
import subprocess
import sys

from modules.platform.telegramio.conftest import Bot


def run(*arguments: str, **environment: str) -> "subprocess.Popen[str]":
    clean = {name: value for name, value in os.environ.items() if "TELEGRAMIO" not in name}
    return subprocess.Popen(
        [sys.executable, "-m", "ravestate", "run", "telegramio", "ravestate.testing.platforms:echo", *arguments],
        env={**clean, **environment}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def test_without_a_token_the_command_says_how_to_get_one() -> None:
    process = run()
    out, said = process.communicate(timeout=60)
    assert (process.returncode, out) == (1, "")
    assert "@BotFather" in said
    assert "export RAVESTATE_TELEGRAMIO_TOKEN=" in said
    assert "Traceback" not in said


def test_a_wrong_token_ends_the_command_with_a_message_that_does_not_show_it(bot: Bot) -> None:
    token = f"{bot.token}-wrong"
    process = run("--set", f"telegramio.base_url={bot.telegram.root}/bot", RAVESTATE_TELEGRAMIO_TOKEN=token)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 1
    assert "refuses the token: compare RAVESTATE_TELEGRAMIO_TOKEN" in said
    assert bot.token.partition(":")[2] not in said
    assert "Traceback" not in said


def test_the_command_prints_the_name_of_the_bot_and_ends_cleanly(bot: Bot) -> None:
    base = f"telegramio.base_url={bot.telegram.root}/bot"
    process = run("--set", base, RAVESTATE_TELEGRAMIO_TOKEN=bot.token)
    assert process.stdout is not None
    assert process.stdout.readline() == "@robin_bot is on Telegram (Ctrl-C ends it)\n"
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert (process.returncode, said) == (0, "")
