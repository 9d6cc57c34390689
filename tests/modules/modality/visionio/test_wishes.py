"""A user can ask the agent to remember or forget their face."""

import pytest

from ravestate.modules.modality.visionio.wishes import wish_of

pytestmark = pytest.mark.usefixtures("reader")


@pytest.mark.parametrize(
    ("text", "wish"),
    [
        ("forget my face", "forget"),
        ("Could you please forget my face?", "forget"),
        ("I want you to delete my face from your database.", "forget"),
        ("Hey, forget what I look like.", "forget"),
        ("remember my face", "remember"),
        ("You should remember how I look!", "remember"),
        ("Do you remember my face?", ""),
        ("I never forget a face.", ""),
        ("My face hurts.", ""),
        ("forget my name", ""),
        ("It looks like rain.", ""),
        ("", ""),
    ],
)
def test_wish_of_recognises_requests_about_a_face(text: str, wish: str) -> None:
    assert wish_of(text) == wish
