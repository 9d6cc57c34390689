"""The camera of a platform keeps only the newest picture."""

import asyncio
import threading
from types import SimpleNamespace

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.modality.visionio.frames import Frame, Frames


def test_the_method_next_returns_only_the_newest_picture() -> None:
    async def watch() -> None:
        frames = Frames()
        for number in range(5):
            frames.put(bytes([number]))
        frame = await frames.next()
        assert frame is not None and frame.data == b"\4" and frames.dropped == 4

    asyncio.run(watch())


def test_a_picture_from_another_thread_wakes_the_agent() -> None:
    async def watch() -> Frame | None:
        frames = Frames()
        other = threading.Thread(target=frames.put, args=(b"pixels", (1, 2)))
        asyncio.get_running_loop().call_soon(other.start)
        return await frames.next()

    frame = asyncio.run(watch())
    assert frame is not None and (frame.data, frame.shape) == (b"pixels", (1, 2))
    assert "pixels" not in repr(frame)


def test_put_message_accepts_pictures_from_ros() -> None:
    frames = Frames()
    frames.put_message(SimpleNamespace(format="jpeg", data=[1, 2]))
    frame = asyncio.run(frames.next())
    assert frame is not None and (frame.data, frame.shape) == (b"\1\2", None)
    frames.put_message(SimpleNamespace(data=bytes(6), height=1, width=2, step=6, encoding="8UC3"))
    frame = asyncio.run(frames.next())
    assert frame is not None and (frame.shape, frame.encoding, frame.step) == ((1, 2), "bgr8", 6)
    with pytest.raises(PlatformError, match="'32FC1': publish one of rgb8, bgr8"):
        frames.put_message(SimpleNamespace(data=b"", height=1, width=1, step=4, encoding="32FC1"))


def test_the_method_next_returns_none_once_the_camera_is_closed() -> None:
    async def watch() -> None:
        frames = Frames()
        asyncio.get_running_loop().call_soon(frames.close)
        assert await frames.next() is None
        frames.put(b"late")
        assert await frames.next() is None

    asyncio.run(watch())


def test_the_method_taken_waits_until_a_call_of_next_returns_the_picture_or_the_camera_closes() -> None:
    async def watch() -> None:
        frames = Frames()
        await frames.taken()  # returns immediately, because there is no picture
        order: list[str] = []

        async def wait() -> None:
            await frames.taken()
            order.append("due")

        async def take() -> None:
            order.append("taken")
            assert await frames.next() is not None

        async def close() -> None:
            order.append("closed")
            frames.close()

        for end in (take, close):
            frames.put(b"pixels")
            await asyncio.gather(wait(), end())
        assert order == ["taken", "due", "closed", "due"]

    asyncio.run(watch())


def test_each_waiting_call_of_next_gets_a_picture() -> None:
    async def watch() -> None:
        frames = Frames()

        async def show() -> None:
            frames.put(b"1")
            await frames.taken()
            frames.put(b"2")

        async with asyncio.TaskGroup() as group:
            first, second = (group.create_task(frames.next()) for _ in range(2))
            group.create_task(show())  # tasks begin in order, so both calls wait before the first picture comes
        assert sorted(frame.data for frame in (first.result(), second.result()) if frame is not None) == [b"1", b"2"]

    asyncio.run(asyncio.wait_for(watch(), 10))


def test_a_picture_may_come_after_the_loop_of_a_cancelled_call_has_closed() -> None:
    frames = Frames()

    async def give_up() -> None:
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0):
                await frames.next()

    asyncio.run(give_up())
    frames.put(b"pixels")
    frame = asyncio.run(frames.next())
    assert frame is not None and frame.data == b"pixels"
