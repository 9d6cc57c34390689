"""The progress bar appears only on a terminal, and only if the work takes long."""

import io
import sys

import pytest

from ravestate.modules.skill.wildtalk.progress import ProgressBar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_bar_is_drawn_on_a_terminal_and_removed_at_the_end() -> None:
    screen = Terminal()
    with ProgressBar("Loading", delay=0.0, stream=screen) as bar:
        for percent in range(0, 101, 10):
            bar(percent / 100)
        assert "Loading" in screen.getvalue()
        assert "%" in screen.getvalue()
    assert screen.getvalue().endswith("\r")


@pytest.mark.parametrize(("screen", "delay"), [(io.StringIO(), 0.0), (Terminal(), 9999.0)])
def test_nothing_is_drawn_without_a_terminal_or_before_the_delay(screen: io.StringIO, delay: float) -> None:
    with ProgressBar("Loading", delay=delay, stream=screen) as bar:
        bar(0.5)
        bar(1.0)
    assert screen.getvalue() == ""


def test_quick_work_needs_no_bar() -> None:
    screen = Terminal()
    with ProgressBar("Loading", delay=0.0, stream=screen) as bar:
        bar(1.0)
    assert screen.getvalue() == ""


def test_while_a_prompt_is_shown_the_bar_above_it_is_one_line_of_text(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    with ProgressBar("Loading", delay=0.0) as bar:
        for percent in range(101):
            bar(percent / 100)
    assert screen.getvalue() == "Loading…\n"


def test_while_a_prompt_is_shown_a_finished_bar_is_not_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    screen = Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    with ProgressBar("Loading", delay=0.0) as bar:
        bar(1.0)
    assert screen.getvalue() == ""


def test_without_tqdm_or_standard_error_nothing_is_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "tqdm", None)
    screen = Terminal()
    ProgressBar("Loading", delay=0.0, stream=screen)(0.5)
    assert screen.getvalue() == ""
    monkeypatch.setattr(sys, "stderr", None)
    ProgressBar("Loading", delay=0.0)(0.5)
