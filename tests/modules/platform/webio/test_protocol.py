"""Frames: `parse` returns a record for each text or raises a `ProtocolError`, and reads all that `serialise` writes."""

import json
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules._text import printable
from ravestate.modules.platform.webio.fields import GREATEST, ProtocolError, heard_text
from ravestate.modules.platform.webio.frames import (
    CLIENT,
    SERVER,
    Bye,
    ClientFrame,
    Ended,
    Error,
    Hello,
    Message,
    Paused,
    Piece,
    Ping,
    Pong,
    Renamed,
    Say,
    Typing,
    Welcome,
    Writing,
)
from ravestate.modules.platform.webio.protocol import parse, serialise

texts = st.text().map(printable)
keys = st.from_regex(r"[A-Za-z0-9_-]{1,64}", fullmatch=True)
numbers = st.integers(0, GREATEST)
names = st.text(st.characters(categories=("L", "N")), min_size=1, max_size=80)

client_frames = st.one_of(
    st.builds(Hello, st.just(1), st.none() | keys, numbers, st.none() | st.text(), st.none() | names),
    st.builds(Say, keys, texts.filter(str.strip)),
    st.just(Writing()),
    st.just(Bye()),
    st.just(Ping()),
)
server_frames = st.one_of(
    st.builds(
        Welcome,
        st.just(1),
        keys,
        st.booleans(),
        numbers,
        texts,
        st.none() | texts,
        numbers,
        st.booleans(),
        st.lists(texts, max_size=3).map(tuple),
    ),
    st.builds(Renamed, texts),
    st.builds(Message, numbers, st.sampled_from(("user", "agent")), texts, numbers, st.none() | keys),
    st.builds(Piece, numbers, texts),
    st.builds(Typing, st.booleans()),
    st.builds(Paused, st.booleans()),
    st.builds(Ended, texts),
    st.builds(Error, texts, texts),
    st.just(Pong()),
)
values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)
FIELDS = ("v", "session", "last", "token", "name", "id", "text")


@given(client_frames)
def test_parse_reads_each_serialised_frame_of_a_client(frame: Any) -> None:
    assert parse(serialise(frame), CLIENT) == frame


@given(server_frames)
def test_parse_reads_each_serialised_frame_of_the_server(frame: Any) -> None:
    assert parse(serialise(frame), SERVER) == frame


def understood(text: str | bytes) -> bool:
    """Return whether a text is a client's frame. Any error other than a `ProtocolError` fails the test."""
    try:
        frame = parse(text, CLIENT)
    except ProtocolError as error:
        assert error.code in ("malformed", "too-long", "version")
        str(error).encode()  # the error can be sent to the client
        return False
    assert isinstance(frame, ClientFrame)
    serialise(frame).encode()
    return True


@given(st.text() | st.binary())
def test_parse_accepts_or_refuses_any_text(text: str | bytes) -> None:
    understood(text)


@given(values)
def test_parse_accepts_or_refuses_any_json(value: Any) -> None:
    understood(json.dumps(value))


@given(
    st.sampled_from(("hello", "say", "writing", "bye", "ping", "welcome", "message")),
    st.dictionaries(st.sampled_from(FIELDS), values),
)
def test_parse_accepts_or_refuses_any_fields(name: str, fields: dict[str, Any]) -> None:
    understood(json.dumps({**fields, "type": name}))


@pytest.mark.parametrize(
    "text", ["[" * 60_000, '{"type":' * 20_000, "1" * 60_000, '{"type": "ping", "x": NaN}', "\ud800"]
)
def test_parse_accepts_or_refuses_malicious_texts(text: str) -> None:
    understood(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("hello", 'not JSON: \'hello\'; a frame is an object: {"type": "hello", "v": 1}'),
        (b"{}", "a frame is a text message, not a binary one"),
        ("[1]", '\'[1]\' is not an object: write {"type": "hello", "v": 1}'),
        ("{}", "\"type\": 'None' is none of hello, say, writing, bye, ping"),
        (
            '{"type": "hallo"}',
            "'hallo' is none of hello, say, writing, bye, ping, microphone, played, hush, camera, picture; did you mean 'hello'?",
        ),
        ('{"type": ["say"]}', "is none of hello, say, writing, bye, ping"),
        ('{"type": "hello"}', 'hello lacks "v": the version, 1'),
        ('{"type": "hello", "v": true}', "hello: \"v\": 'True' is not the version, 1"),
        ('{"type": "hello", "v": 1, "last": -1}', "hello: \"last\": '-1' is not a whole number from 0 on"),
        ('{"type": "hello", "v": 1, "last": 1.0}', "is not a whole number from 0 on"),
        ('{"type": "hello", "v": 1, "session": "../x"}', "is not 1 to 64 letters, digits, - or _"),
        ('{"type": "hello", "v": 1, "name": "   "}', "is not a text of 1 to 80 characters"),
        ('{"type": "say", "text": "hi"}', 'say lacks "id": 1 to 64 letters, digits, - or _'),
        ('{"type": "say", "id": "a", "text": 7}', "say: \"text\": '7' is not a text"),
    ],
)
def test_the_error_for_a_malformed_frame_says_what_is_expected(text: str | bytes, said: str) -> None:
    with pytest.raises(ProtocolError) as refused:
        parse(text, CLIENT)
    assert refused.value.code == "malformed"
    assert said in str(refused.value)


def test_a_frame_of_another_protocol_version_is_refused() -> None:
    with pytest.raises(ProtocolError, match='"v": 2: this side speaks version 1 only') as refused:
        parse('{"type": "hello", "v": 2}', CLIENT)
    assert refused.value.code == "version"


def test_unknown_fields_are_ignored() -> None:
    assert parse('{"type": "bye", "why": "tired"}', CLIENT) == Bye()


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("Ada\n Lovelace", "Ada Lovelace"),
        ("\u202eAda\u2069", "Ada"),
        ("\u0928\u093f\u200d\u0915", "\u0928\u093f\u200d\u0915"),  # a word that needs the zero-width joiner
    ],
)
def test_names_lose_line_breaks_and_characters_for_the_direction_of_writing(name: str, shown: str) -> None:
    assert parse(json.dumps({"type": "hello", "v": 1, "name": name}), CLIENT).name == shown


def test_texts_lose_control_characters() -> None:
    text = json.dumps({"type": "say", "id": "a", "text": "a\x1b[31mb\x00\ud800"})
    assert parse(text, CLIENT).text == "ab\ufffd"


@pytest.mark.parametrize(
    ("text", "heard"),
    [
        ("Hello", "Hello"),
        ("a\r\nb\tc", "a\nb\tc"),
        ("\x1b[2Ja\x00b\ud800", "ab\ufffd"),
        ("\x00" + "x" * 10_000, "x" * 10_000),
    ],
)
def test_heard_text_returns_the_readable_part_of_a_text(text: str, heard: str) -> None:
    assert heard_text(text) == heard


@pytest.mark.parametrize(
    ("text", "code"),
    [("x" * 10_001, "too-long"), ("", "empty"), (" \n\t", "empty"), ("\x85\x1b[0m", "empty")],
)
def test_long_and_empty_texts_are_refused(text: str, code: str) -> None:
    with pytest.raises(ProtocolError) as refused:
        heard_text(text)
    assert (refused.value.code, refused.value.id) == (code, None)
    with pytest.raises(ProtocolError) as refused:
        parse(json.dumps({"type": "say", "id": "a", "text": text}), CLIENT)
    assert (refused.value.code, refused.value.id) == (code, "a")
