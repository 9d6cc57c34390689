"""The settings that all messengers have."""

import pytest

from ravestate.modules import matrixio, telegramio


@pytest.mark.parametrize("address", ["", "museum.example", "127.0.0.1:8081/bot", "http://", "ftp://museum.example"])
def test_an_address_to_which_no_request_is_possible_is_refused(address: str) -> None:
    message = r"write a whole address, e\.g\. https://museum\.example"
    with pytest.raises(ValueError, match=message):
        matrixio.Settings(homeserver=address)
    for name in ("base_url", "webhook"):
        with pytest.raises(ValueError, match=message):
            telegramio.Settings.model_validate({name: address})


@pytest.mark.parametrize("address", ["http://127.0.0.1:8081/bot", "https://museum.example", "http://[::1]:8008/"])
def test_a_whole_address_is_kept_as_it_is(address: str) -> None:
    assert matrixio.Settings(homeserver=address).homeserver == address
