"""Names, mentions and commands in messages."""

import pytest

from ravestate.modules.platform.chats.addressing import command_in, for_another, is_emoji, mentions, without_mention


@pytest.mark.parametrize(
    ("text", "name"),
    [("/stop", "stop"), ("/Stop", "stop"), ("!forget", "forget"), ("/help@robin_bot", "help"), ("/help ", "help"),
     ("/dance", None), ("stop", None), ("please /stop", None), ("/stop it", None), ("", None)],
)  # fmt: skip
def test_a_command_is_the_whole_message(text: str, name: str | None) -> None:
    assert command_in(text) == name


def test_a_command_may_be_for_another_bot() -> None:
    assert for_another("/help@other_bot", "robin_bot")
    assert not for_another("/help@Robin_Bot", "robin_bot")
    assert not for_another("/help", "robin_bot")
    assert not for_another("Ask other_bot", "robin_bot")


@pytest.mark.parametrize(
    ("text", "found"),
    [("Robin, hello", True), ("hello robin!", True), ("the robins sing", False), ("", False),
     ("ask @robin_bot", True), ("ask @robin_bottle", False)],
)  # fmt: skip
def test_a_name_is_a_word_of_its_own(text: str, found: bool) -> None:
    assert mentions(text, ("Robin", "@robin_bot", "")) is found


@pytest.mark.parametrize(
    ("text", "rest"),
    [("@robin_bot, hello", "hello"), ("hello @Robin_Bot", "hello"), ("hello", "hello"),
     ("write to me@robin_bot.org", "write to me@robin_bot.org")],
)  # fmt: skip
def test_a_mention_is_cut_out(text: str, rest: str) -> None:
    assert without_mention(text, "@robin_bot") == rest


@pytest.mark.parametrize(
    ("text", "is_one"), [("👍", True), ("🇩🇪", True), ("👍🏽", True), ("☹️", True), ("a", False), ("🎈 ok", False)]
)
def test_an_emoji_alone(text: str, is_one: bool) -> None:
    assert is_emoji(text) is is_one
