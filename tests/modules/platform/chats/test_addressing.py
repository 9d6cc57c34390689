"""The agent recognises names, mentions and commands in messages."""

import pytest

from ravestate.modules.platform.chats.addressing import addressed, command_in, mentions, without_mention


@pytest.mark.parametrize(
    ("text", "name"),
    [("/stop", "stop"), ("/Stop", "stop"), ("!forget", "forget"), ("/help@robin_bot", "help"), ("/help ", "help"),
     ("/dance", None), ("stop", None), ("please /stop", None), ("/stop it", None), ("", None)],
)  # fmt: skip
def test_a_command_counts_only_as_the_whole_message(text: str, name: str | None) -> None:
    assert command_in(text) == name


@pytest.mark.parametrize(
    ("text", "group", "called", "found"),
    [("/help@other_bot", False, False, None), ("/help@Robin_Bot", True, False, ("help", "/help@Robin_Bot")),
     ("/help", True, False, ("help", "/help")), ("Ask other_bot", False, False, (None, "Ask other_bot")),
     ("How are you?", True, False, None), ("How are you?", True, True, (None, "How are you?")),
     ("Robin, how are you?", True, False, (None, "Robin, how are you?")),
     ("@robin_bot: how are you?", True, False, (None, "how are you?"))],
)  # fmt: skip
def test_in_a_group_the_agent_gets_only_messages_that_address_it(
    text: str, group: bool, called: bool, found: object
) -> None:
    assert addressed(text, ("@robin_bot",), ("Robin",), group=group, called=called) == found


@pytest.mark.parametrize(
    ("text", "found"),
    [("Robin, hello", True), ("hello robin!", True), ("the robins sing", False), ("", False),
     ("ask @robin_bot", True), ("ask @robin_bottle", False)],
)  # fmt: skip
def test_the_function_mentions_finds_a_name_only_as_a_whole_word(text: str, found: bool) -> None:
    assert mentions(text, ("Robin", "@robin_bot", "")) is found


@pytest.mark.parametrize(
    ("text", "rest"),
    [("@robin_bot, hello", "hello"), ("hello @Robin_Bot", "hello"), ("hello", "hello"),
     ("write to me@robin_bot.org", "write to me@robin_bot.org")],
)  # fmt: skip
def test_without_mention_removes_the_mention_from_a_text(text: str, rest: str) -> None:
    assert without_mention(text, "@robin_bot") == rest


def test_without_mention_reads_a_text_of_many_spaces() -> None:
    spaces = 200_000 * " "  # with a search that grows with the square of this number, the test would not end
    assert without_mention(f"a{spaces}b", "@robin_bot") == f"a{spaces}b"
    assert without_mention(f"a{spaces}@robin_bot b", "@robin_bot") == "a b"
