"""The history numbers the messages of a conversation without gaps, and limits their count and total length."""

from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.platform.webio.history import History


def test_messages_are_numbered_and_kept_in_order() -> None:
    history = History()
    assert (history.first, history.last) == (1, 0)
    history.add("agent", "Hello!", 1)
    history.add("user", "hello", 2, "a")
    assert [(m.n, m.speaker, m.text, m.time, m.id) for m in history.since(0)] == [
        (1, "agent", "Hello!", 1, None),
        (2, "user", "hello", 2, "a"),
    ]
    assert [message.n for message in history.since(1)] == [2]
    assert list(history.since(2)) == []


@given(st.lists(st.text(max_size=30)), st.integers(0, 40))
def test_a_history_stays_within_its_limits_and_has_no_gaps(texts: list[str], since: int) -> None:
    history = History(messages=5, characters=40)
    for text in texts:
        history.add("agent", text, 0)
        kept = list(history.since(0))
        assert len(kept) <= 5
        assert sum(len(message.text) for message in kept) <= 40
        assert [message.n for message in kept] == list(range(history.first, history.last + 1))
    assert [message.n for message in history.since(since)] == [
        n for n in range(history.first, history.last + 1) if n > since
    ]


def test_a_message_longer_than_the_limit_of_the_history_is_cut() -> None:
    history = History(characters=10)
    history.add("agent", "x" * 11, 0)
    assert [message.text for message in history.since(0)] == ["x" * 10]


def test_messages_can_be_added_while_the_history_is_read() -> None:
    history = History(messages=2)
    history.add("agent", "one", 0)
    seen: list[int] = []
    for message in history.since(0):
        seen.append(message.n)
        if message.n == 1:
            for text in ("two", "three", "four"):
                history.add("agent", text, 0)
    assert seen == [1, 3, 4]
