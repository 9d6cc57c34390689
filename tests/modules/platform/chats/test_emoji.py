"""A text is an emoji if it is exactly one emoji, as Unicode defines one."""

import pytest
import regex

from ravestate.modules.platform.chats.emoji import is_emoji


@pytest.mark.parametrize(
    "text",
    ["👍", "🇩🇪", "👍🏽", "☹️", "❤️", "❤️‍🔥", "❤‍🔥", "☝🏽", "1️⃣", "#️⃣", "©️", "🏴‍☠️", "👁️‍🗨️", "🏳️‍🌈", "👩‍⚕",
     "👩🏽‍❤️‍💋‍👨🏾", "👨‍👩‍👧‍👦", "🏴\U000e0067\U000e0062\U000e0065\U000e006e\U000e0067\U000e007f", "🫩"],
)  # fmt: skip
def test_a_single_emoji_is_recognised(text: str) -> None:
    assert is_emoji(text)


@pytest.mark.parametrize(
    "text",
    ["👍👍", "😀😀😀", "👍🏽👍🏽", "🇩🇪🇫🇷", "🇩", "❤️❤️", "1️⃣2️⃣", "©", "™", "❤", "㈱", "→", "1", "1️", "#", "a", "a️", "", "🎈 ok",
     "👍 ", "👍\n", "👩‍", "‍👩", "️", "☝🏽🏽"],
)  # fmt: skip
def test_a_text_with_several_emoji_or_none_is_no_emoji(text: str) -> None:
    assert not is_emoji(text)


def test_each_character_is_an_emoji_exactly_if_unicode_says_so() -> None:
    characters = "".join(map(chr, range(0x20000)))  # no emoji lies beyond
    known = regex.findall(r"[^\p{Cn}\p{Regional_Indicator}0-9#*]", characters)
    assert [each for each in known if is_emoji(each)] == regex.findall(r"\p{Emoji_Presentation}", "".join(known))
    assert [each for each in known if is_emoji(f"{each}\ufe0f")] == regex.findall(r"\p{Emoji}", "".join(known))
