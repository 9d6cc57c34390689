"""The files of the built pages. All pages share one icon."""

import re
from pathlib import Path

import pytest
from starlette.testclient import TestClient

from ravestate.board.application import PAGE as BOARD
from ravestate.modules.platform.roboyio.page_server import PAGE as ROBOT
from ravestate.modules.platform.webio.application import PAGE as CHAT
from ravestate.modules.platform.webio.pages import LOGO, Pages


@pytest.mark.parametrize("folder", [BOARD, CHAT, ROBOT], ids=["board", "chat", "robot"])
def test_a_page_has_all_files_that_it_names(folder: Path) -> None:
    client = TestClient(Pages(folder))
    names = re.findall(r'(?:href|src)="\./([^"]+)"', client.get("/").text)
    assert LOGO in names
    assert {name: client.get(f"/{name}").status_code for name in names} == dict.fromkeys(names, 200)


def test_the_icon_is_the_same_file_on_all_pages() -> None:
    assert not (BOARD / LOGO).exists() and not (ROBOT / LOGO).exists()
    assert TestClient(Pages(BOARD)).get(f"/{LOGO}").content == (CHAT / LOGO).read_bytes()
