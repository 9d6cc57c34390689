"""The check of the software and devices for speech."""

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.platform.voiceio import Settings, checking
from ravestate.modules.platform.voiceio.checking import Line, require


@pytest.fixture(autouse=True)
def _complete_software(monkeypatch: pytest.MonkeyPatch) -> None:
    def present(_: Settings) -> Line:
        return Line("software", True, True, "")

    for name in ("_packages", "_recogniser"):
        monkeypatch.setattr(checking, name, present)


def test_a_conversation_without_a_loudspeaker_passes_the_check() -> None:
    require(Settings(source="in.wav", sink=""))


def test_a_conversation_without_a_microphone_does_not_pass_the_check() -> None:
    with pytest.raises(PlatformError, match=r"no microphone: voiceio\.source is empty: name a device or a file"):
        require(Settings(source="", sink="out.wav"))


def test_a_conversation_with_an_unknown_loudspeaker_does_not_pass_the_check() -> None:
    with pytest.raises(PlatformError, match="no loudspeaker: "):
        require(Settings(source="in.wav", sink="no such loudspeaker"))
