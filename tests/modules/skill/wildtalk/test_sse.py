"""Server-sent events: however they arrive, the same payloads come out."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.wildtalk.sse import Events, EventTooLong

STREAM = '\ufeffdata: {"a": "ä\u2028b"}\n\n: ping\n\nid: 1\r\ndata:[1]\r\n\r\nnonsense\ndata\ndata:  two\nerror: {}\ndata: end'
PAYLOADS = ['{"a": "ä\u2028b"}', "[1]", " two", '{"error": {}}', "end"]


@given(st.lists(st.integers(0, len(STREAM.encode()))))
def test_however_it_is_cut_the_same_comes_out(places: list[int]) -> None:
    stream, events, payloads = STREAM.encode(), Events(), list[str]()
    places = [0, *sorted(places), len(stream)]
    for begin, end in pairwise(places):
        payloads += events.feed(stream[begin:end])
    assert payloads + events.finish() == PAYLOADS
    assert events.finish() == []


def test_bytes_that_are_no_text_are_replaced() -> None:
    assert Events().feed(b"data: \xff\n") == ["\ufffd"]


def test_an_endless_line_is_refused() -> None:
    events = Events(limit=10)
    assert events.feed(b"data: 12345678\n123") == ["12345678"]
    with pytest.raises(EventTooLong, match="more than 10 bytes"):
        events.feed(b"45678901")
