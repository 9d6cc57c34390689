"""The access check: hosts, origins and the token."""

import asyncio

import pytest

from modules.platform.webio.visit import in_virtual_time
from ravestate.modules import webio
from ravestate.modules.platform.webio import Settings
from ravestate.modules.platform.webio.access import Access, is_local
from ravestate.modules.platform.webio.fields import ProtocolError
from ravestate.settings import load_settings

TOKEN = "open sesame, please"


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "[::1]", "127.9.9.9"])
def test_an_address_of_this_machine_is_local(host: str) -> None:
    assert is_local(host)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.0.7", "museum.example", "", "localhost.evil.example"])
def test_an_address_that_other_machines_can_reach_is_not_local(host: str) -> None:
    assert not is_local(host)


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("127.0.0.1:8420", None),
        ("localhost:8420", "http://localhost:8420"),
        ("[::1]:8420", "http://[::1]:8420"),
        ("LOCALHOST:8420", "http://localhost:8420"),
        ("chat.museum.example", "https://chat.museum.example"),
        ("127.0.0.1:8420", "https://chat.museum.example"),
    ],
)
def test_the_page_itself_and_sites_that_may_embed_it_may_connect(host: str, origin: str | None) -> None:
    access = Access(Settings(origins=("https://chat.museum.example",)))
    assert access.refusal({"host": host} | ({"origin": origin} if origin else {})) is None


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("127.0.0.1:8420", "https://evil.example"),
        ("127.0.0.1:8420", "http://127.0.0.1:9999"),
        ("127.0.0.1:8420", "null"),
        ("127.0.0.1:8420", "http://["),
        ("127.0.0.1:8420", "https://museum.example.evil.example"),
        ("evil.example:8420", "http://evil.example:8420"),  # a foreign name whose address is this machine
        ("evil.example", None),
        ("127.0.0.1.evil.example", None),
        ("", None),
        ("[", None),
    ],
)
def test_other_host_names_and_other_sites_are_refused(host: str, origin: str | None) -> None:
    access = Access(Settings(origins=("https://museum.example",)))
    refusal = access.refusal({"host": host} | ({"origin": origin} if origin else {}))
    assert refusal is not None
    assert "webio.origins" in refusal


@pytest.mark.parametrize(
    ("host", "origin"),
    [
        ("127.0.0.1:8420", None),
        ("127.0.0.1:8420", "http://127.0.0.1:8420"),
        ("chat.museum.example", "https://chat.museum.example"),
        ("CHAT.museum.example:444", "https://chat.museum.example:444"),
    ],
)
def test_the_page_itself_may_inspect_the_agent(host: str, origin: str | None) -> None:
    access = Access(Settings(origins=("https://museum.example",)))
    assert access.refusal_of_board({"host": host} | ({"origin": origin} if origin else {})) is None


@pytest.mark.parametrize("origin", ["https://museum.example", "http://127.0.0.1:9999", "null"])
def test_a_site_that_may_embed_the_page_may_not_inspect_the_agent(origin: str) -> None:
    access = Access(Settings(origins=("https://museum.example",)))
    refusal = access.refusal_of_board({"host": "127.0.0.1:8420", "origin": origin})
    assert refusal is not None
    assert f"{origin!r} may not inspect the agent" in refusal


EMBEDDED = {"host": "127.0.0.1:8420", "sec-fetch-dest": "iframe"}


@pytest.mark.parametrize("referer", ["http://museum.example/", "HTTP://museum.example/a?b", "http://museum.example"])
def test_foreign_embedder_returns_a_site_that_embeds_the_chat_without_permission(referer: str) -> None:
    assert Access(Settings()).foreign_embedder({**EMBEDDED, "referer": referer}) == "http://museum.example"


@pytest.mark.parametrize(
    "headers",
    [
        {**EMBEDDED, "referer": "https://museum.example/"},  # a site that may embed the chat
        {**EMBEDDED, "referer": "http://127.0.0.1:8420/"},  # the page's own site
        {**EMBEDDED, "referer": "https://evil.example/", "sec-fetch-dest": "document"},  # from a link, not a frame
        {**EMBEDDED, "referer": "about:client"},
        EMBEDDED,
        {},
    ],
)
def test_foreign_embedder_returns_none_for_allowed_and_unknown_sites(headers: dict[str, str]) -> None:
    assert Access(Settings(origins=("https://museum.example",))).foreign_embedder(headers) is None


def test_with_a_token_any_host_name_is_allowed_but_not_any_site() -> None:
    access = Access(Settings(token=TOKEN))
    assert access.refusal({"host": "robot.lan", "origin": "http://robot.lan"}) is None
    assert access.refusal({"host": "robot.lan", "origin": "https://evil.example"}) is not None


@pytest.mark.parametrize("token", [None, "", "open sesame", TOKEN + "!", "ö", "\ud800"])
def test_a_wrong_token_is_refused(token: str | None) -> None:
    assert not Access(Settings(token=TOKEN)).admits(token)


def test_the_right_token_is_accepted_and_without_the_setting_no_token_is_needed() -> None:
    assert Access(Settings(token=TOKEN)).admits(TOKEN)
    assert Access(Settings()).admits(None)


@in_virtual_time
async def test_a_wrong_token_is_refused_only_after_a_second() -> None:
    access, now = Access(Settings(token=TOKEN)), asyncio.get_running_loop().time
    with pytest.raises(ProtocolError, match="the token is wrong"):
        await access.check_token("guess")
    assert now() == 1.0
    with pytest.raises(ProtocolError, match="a token is needed"):
        await access.check_token(None)


@pytest.mark.parametrize("origin", ["museum.example", "https://museum.example/", "*", "https://a; script-src *"])
def test_the_setting_origins_refuses_a_text_that_is_not_an_origin(origin: str) -> None:
    with pytest.raises(ValueError, match=r"write an origin, e\.g\. https://museum\.example"):
        Settings(origins=(origin,))


def test_the_setting_token_refuses_a_short_token() -> None:
    with pytest.raises(ValueError, match="write at least 12 characters"):
        Settings(token="secret")


@pytest.mark.parametrize(
    "token", ["schlüssel-zum-museum", "line feed at the end\n", " space-at-the-start", "tab\tin-the-middle"]
)
def test_the_setting_token_refuses_a_token_that_a_header_cannot_carry(token: str) -> None:
    with pytest.raises(ValueError, match="write only ASCII characters, without control characters"):
        Settings.model_validate({"token": token})


def test_a_token_of_digits_from_the_environment_is_read_as_text() -> None:
    variables = {"RAVESTATE_WEBIO_TOKEN": "123456789012"}
    assert Access(load_settings([webio.module], None, variables)["webio"]).admits("123456789012")
