"""The sender: the pace of messages."""

from modules.platform.webio.visit import in_virtual_time, past
from ravestate.modules.platform.chats.sender import Pace


@in_virtual_time
async def test_a_spare_turn_is_one_for_which_no_message_waits() -> None:
    pace = Pace(2.0)
    await past(10.0)
    for _ in range(3):  # those of the last second, and one more
        await pace.turn()
    assert not pace.spare()
    await past(0.6)
    assert pace.spare()
    assert not pace.spare()
