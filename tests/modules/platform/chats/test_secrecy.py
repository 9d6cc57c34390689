"""Secrets do not appear in the log, even if other libraries log them."""

import logging

import pytest

from ravestate.modules.platform.chats import secret

TOKEN = "123456:AAbbCCddEEff"


def test_a_secret_is_replaced_in_messages_arguments_and_tracebacks(caplog: pytest.LogCaptureFixture) -> None:
    log = logging.getLogger("some.library")
    with secret(TOKEN, TOKEN.partition(":")[2]):
        log.warning("GET /bot%s/getMe", TOKEN)
        log.warning("the end of it is " + TOKEN[7:])  # noqa: G003
        try:
            raise ValueError(f"wrong: {TOKEN}")
        except ValueError:
            log.exception("it failed")
        log.warning("nothing to hide %s %s", 1, 2)
    assert TOKEN[7:] not in caplog.text
    assert "GET /bot[secret]/getMe" in caplog.text
    assert "ValueError: wrong: [secret]" in caplog.text
    assert "nothing to hide 1 2" in caplog.text


def test_after_the_with_block_the_log_shows_the_text_again(caplog: pytest.LogCaptureFixture) -> None:
    before = logging.getLogRecordFactory()
    with secret(TOKEN):
        pass
    assert logging.getLogRecordFactory() is before
    logging.getLogger("some.library").warning(TOKEN)
    assert TOKEN in caplog.text


def test_the_end_of_one_platform_does_not_reveal_the_secrets_of_another(caplog: pytest.LogCaptureFixture) -> None:
    before, log = logging.getLogRecordFactory(), logging.getLogger("some.library")
    first, second = secret(TOKEN, "password"), secret("another token", "password")
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    log.warning("another token and a password are still secret")
    assert "[secret] and a [secret] are still secret" in caplog.text
    second.__exit__(None, None, None)
    assert logging.getLogRecordFactory() is before
