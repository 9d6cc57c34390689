"""A user can ask the agent to remember or forget their face. The quality set ``wishes_rows`` has more sentences."""

import pytest

from ravestate.modules.modality.visionio.wishes import wish_of

pytestmark = pytest.mark.usefixtures("reader")


def test_a_wish_must_be_about_the_face() -> None:
    assert wish_of("forget my face") == "forget"
    assert wish_of("remember my face") == "remember"
    assert not any(map(wish_of, ("forget my name", "remember the milk", "My face hurts.", "")))


def test_a_wish_to_forget_a_face_outweighs_a_wish_to_remember_it() -> None:
    assert wish_of("remember my face. No, forget my face.") == "forget"
