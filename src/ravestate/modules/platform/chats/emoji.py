"""Recognise a text that is a single emoji, as *Unicode Emoji* (UTS #51) defines one."""

from __future__ import annotations

import re

PICTURES = (
    "⌚⌛⏩-⏬⏰⏳◽◾☔☕♈-♓♿⚓⚡⚪⚫⚽⚾⛄⛅⛎⛔⛪⛲⛳⛵⛺⛽✅✊✋✨❌❎❓-❕❗➕-➗➰➿⬛⬜⭐⭕🀄🃏🆎🆑-🆚🈁🈚🈯🈲-🈶🈸-🈺🉐🉑"
    "🌀-🌠🌭-🌵🌷-🍼🍾-🎓🎠-🏊🏏-🏓🏠-🏰🏴🏸-🐾👀👂-📼📿-🔽🕋-🕎🕐-🕧🕺🖕🖖🖤🗻-🙏🚀-🛅🛌🛐-🛒🛕-🛟🛫🛬🛴-🛼🟠-🟰🤌-🤺🤼-🥅🥇-🧿"
    "🩰-\U0001faff"
)
"""The characters that are emoji by themselves (``Emoji_Presentation``), with the code points in reserve between them.
Python's `unicodedata` does not have this property."""

SIGNS = (
    "©®‼⁉™ℹ↔-↙↩↪⌨⏏⏭-⏯⏱⏲⏸-⏺Ⓜ▪▫▶◀◻◼☀-☄☎☑☘☝☠☢☣☦☪☮☯☸-☺♀♂♟♠♣♥♦♨♻♾⚒⚔-⚗⚙⚛⚜⚠⚧⚰⚱⛈⛏⛑⛓⛩⛰⛱⛴⛷-⛹✂✈✉✌✍✏✒✔✖✝✡✳✴❄❇❣❤➡⤴⤵"
    "⬅-⬇〰〽㊗㊙🅰🅱🅾🅿🈂🈷🌡🌤-🌬🌶🍽🎖🎗🎙-🎛🎞🎟🏋-🏎🏔-🏟🏳🏵🏷🐿👁📽🕉🕊🕯🕰🕳-🕹🖇🖊-🖍🖐🖥🖨🖱🖲🖼🗂-🗄🗑-🗓🗜-🗞🗡🗣🗨🗯🗳🗺🛋🛍-🛏🛠-🛥🛩🛰🛳"
)
"""The characters that are emoji only with a variation selector, a skin tone, or a joined emoji; else they are text."""

_PICTURE = rf"[{PICTURES}](?:[🏻-🏿]?\ufe0f?|[\U000e0020-\U000e007e]+\U000e007f)"  # the tags make a region's flag
_SIGN = rf"[{SIGNS}](?:\ufe0f|[🏻-🏿])"
_JOINED = rf"(?:{_PICTURE}|{_SIGN}|[{SIGNS}])"  # senders may leave out the variation selector of a joined sign
_KEY = r"[0-9#*]\ufe0f?\u20e3"
_FLAG = r"[🇦-🇿]{2}"
EMOJI = re.compile(rf"{_FLAG}|{_KEY}|{_JOINED}(?:\u200d{_JOINED})+|{_PICTURE}|{_SIGN}")


def is_emoji(text: str) -> bool:
    """Return whether a text is exactly one emoji.

    Example:
        >>> is_emoji("❤️"), is_emoji("👩‍🚀"), is_emoji("👍👍"), is_emoji("ok"), is_emoji("")
        (True, True, False, False, False)
    """
    return EMOJI.fullmatch(text) is not None
