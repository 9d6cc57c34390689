"""The rules of a robot: they hear, speak, and move the face and the head."""

from __future__ import annotations

import asyncio
import unicodedata
from typing import Any
from weakref import WeakSet

import ravestate as rs
from ravestate.errors import PlatformError
from ravestate.modules import interloc, rawio, ros1, ros2
from ravestate.modules.platform.ros import Node, NodeSettings, open_node
from ravestate.modules.platform.ros.places import Place

from .connection import Connection
from .names import Pose, Settings, body, direction, expression, gaze, gesture, here, module, speaking, words
from .robot import load_robot

THOUGHTFUL = Pose(yaw=0.25, pitch=0.2)
"""The gaze of a thinking robot."""
_connected: WeakSet[Node] = WeakSet()
"""The nodes that already have a connection to the robot. The slot `body` does not suffice: two runs of `connect` may
begin together."""
THINKS_AFTER = 0.6
"""After this many seconds of work, a robot shows that it is thinking."""


@module.rule(
    when=rs.startup.detached()
    | here.true.max_age(None).detached()
    | ros1.node.changed.max_age(None).detached()
    | ros2.node.changed.max_age(None).detached(),
    reads=(here, ros1.node, ros2.node),
    writes=(body, words, direction, interloc.users),
    detached=True,  # each message of a sensor is a separate cause
    background=True,
)
async def connect(ctx: rs.RuleContext) -> rs.Resign | None:
    """Connect to the robot, and pass on the messages of its sensors."""
    settings: Settings = ctx.settings
    if getattr(asyncio.get_running_loop(), "is_virtual", False):
        return rs.Resign("time is virtual: a test writes the slots")
    if (reason := _not_now(ctx)) is not None:
        return rs.Resign(reason)
    own: Node | None = None
    try:
        robot = load_robot(settings.robot)
        node = ctx[ros1.node] if settings.link == "ros1" else ctx[ros2.node]
        if settings.link == "bus":
            node = own = open_node(2, NodeSettings(bus=settings.bus), _nowhere, {}, bus=True)
        assert node is not None  # `_not_now` has checked this
        made = Connection(robot, node, ctx.sleep, lambda: ctx.now, settings.speech_timeout)
        _connected.add(node)
        ctx[body] = made  # write the slot before `open`, so that the first words wait until the connection is open
        await made.open()

        def hear(message: Any) -> None:
            assert robot.hear is not None
            if text := str(robot.hear.unpack(message)).strip():
                ctx[words] = text

        def notice(message: Any) -> None:
            assert robot.direction is not None
            if (angle := robot.direction.radians(message)) is not None:
                ctx[direction] = angle

        def see(message: Any) -> None:
            assert robot.people is not None
            names = [name for each in str(robot.people.unpack(message)).split(",") if (name := each.strip())]
            for key in [key for key in ctx[interloc.users] if key.startswith("roboyio:")]:
                if key.partition(":")[2] not in names:
                    ctx[interloc.users].remove(key)
            for name in names:
                if f"roboyio:{name}" not in ctx[interloc.users]:
                    ctx[interloc.users].add(f"roboyio:{name}", name)

        made.listen(robot.hear, hear)
        made.listen(robot.direction, notice)
        made.listen(robot.people, see)
        add_feelings(ctx)
        await asyncio.get_running_loop().create_future()
    except rs.RavestateError as error:
        ctx.stop(error)
    finally:
        ctx[body] = None
        if own is not None:
            await own.close()
    return None


def _not_now(ctx: rs.RuleContext) -> str | None:
    """Return why this run of `connect` must not connect; None if it may connect."""
    link: str = ctx.settings.link
    others = [each.name for each in ctx.policy.modules if each.serve is not None and each is not module]
    if others and not ctx[here]:
        return f"the user of this context is on {others[0]}, and the robot has a context of its own"
    if link != "bus":
        node = ctx[ros1.node if link == "ros1" else ros2.node]
        if node is None:
            return f"{link} is not connected"
        return "the robot is connected" if node in _connected else None
    if ctx[body] is not None:
        return "the robot is connected"
    asked = bool(ctx.payload(here.true))
    at_startup = not asked and not ctx.payload(ros1.node.changed) and not ctx.payload(ros2.node.changed)
    if asked if others else at_startup:
        return None
    return "the bus needs no node of ROS"


def _nowhere() -> Place:
    """Raise an error: a node on the built-in bus has no program that connects it to ROS."""
    raise PlatformError("the bus has no program")


@module.rule(when=words.changed.max_age(None), writes=rawio.input)
async def understand(ctx: rs.RuleContext) -> None:
    """Pass on the words that the robot heard."""
    ctx[rawio.input] = ctx.payload(words.changed)


# ------------------------------------------------------------------------------------ speaking


@module.rule(
    when=rawio.output.changed.max_age(None).detached(),
    reads=body,
    writes=(speaking, rawio.heard),
    until=rawio.hush,
    background=True,
)
async def speak(ctx: rs.RuleContext) -> rs.Resign | None:
    """Speak each utterance, one after another. After a failure, ``rawio.heard`` does not get the words."""
    text = speakable(ctx.payload(rawio.output.changed))
    if (robot := ctx[body]) is None or not text:
        return rs.Resign("there is no robot" if text else "there is nothing to say aloud")
    async with robot.turn:
        ctx[speaking] = True
        try:
            await robot.say(text)
            ctx[rawio.heard] = text
        except PlatformError as error:
            ctx.log.error("%s", error)
        finally:
            ctx[speaking] = False
    return None


def speakable(text: str) -> str:
    """Return a text without emoji and other symbols that have no sound; empty if no letter or digit is left."""
    kept = "".join(each for each in text if unicodedata.category(each) not in ("So", "Sk", "Cf") and each != "\ufe0f")
    return " ".join(kept.split()) if any(each.isalnum() for each in kept) else ""


# ------------------------------------------------------------------------------------ the head


@module.rule(when=words.changed.detached(), reads=direction, writes=gaze, background=True)
async def face_speaker(ctx: rs.RuleContext) -> None:
    """Look at the person who speaks; straight ahead if the direction is unknown."""
    ctx[gaze] = Pose(yaw=ctx[direction] or 0.0)


@module.rule(when=direction.changed.max_age(0.5).detached(), writes=gaze, background=True)
async def turn_to_sound(ctx: rs.RuleContext) -> rs.Resign | None:
    """Turn towards a person who begins to speak."""
    where = ctx.payload(direction.changed)
    if where is None:
        return rs.Resign("nobody speaks")
    ctx[gaze] = Pose(yaw=where)
    return None


@module.rule(
    when=rs.activity.true.min_age(THINKS_AFTER).max_age(None).detached() & rs.activity.holds(bool),
    reads=(direction, speaking),
    writes=(gaze, expression),
    until=rs.activity.false | rawio.output.changed | rs.shutdown,
    background=True,
)
async def think(ctx: rs.RuleContext) -> rs.Resign | None:
    """Look up and away when an answer is slow. Look back when the answer comes."""
    if ctx[speaking]:
        return rs.Resign("the robot speaks")
    ctx[gaze] = THOUGHTFUL
    ctx[expression] = "thinking"
    try:
        await asyncio.get_running_loop().create_future()
    finally:
        ctx[gaze] = Pose(yaw=ctx[direction] or 0.0)
        ctx[expression] = "neutral"
    return None


@module.rule(
    when=rs.startup.detached() | rs.activity.false.max_age(None).detached(),
    writes=gaze,
    until=words.changed | rs.activity.true | rs.shutdown,
    detached=True,  # each glance is a separate cause
    background=True,
)
async def look_around(ctx: rs.RuleContext) -> None:
    """Glance around while nothing happens."""
    settings: Settings = ctx.settings
    while True:
        await ctx.sleep(settings.look_around * (0.5 + ctx.random.random()))
        ctx[gaze] = Pose(yaw=ctx.random.uniform(-0.5, 0.5), pitch=ctx.random.uniform(-0.1, 0.15))
        await ctx.sleep(1.0 + ctx.random.random())
        ctx[gaze] = Pose()


@module.rule(when=interloc.users.added.max_age(1.0).detached(), writes=gesture, background=True)
async def greet_with_hand(ctx: rs.RuleContext) -> None:
    """Wave at a person who comes."""
    ctx[gesture] = "wave"


# ------------------------------------------------------------------------------------ to the robot


@module.rule(when=expression.changed.max_age(None).detached(), reads=body, background=True)
async def send_expression(ctx: rs.RuleContext) -> rs.Resign | None:
    """Show the expression on the robot's face."""
    if (robot := ctx[body]) is None:
        return rs.Resign("there is no robot")
    await _careful(ctx, robot.express(ctx.payload(expression.changed)))
    return None


@module.rule(when=gaze.changed.max_age(None).detached(), reads=body, background=True)
async def send_gaze(ctx: rs.RuleContext) -> rs.Resign | None:
    """Turn the robot's head."""
    if (robot := ctx[body]) is None:
        return rs.Resign("there is no robot")
    await _careful(ctx, robot.look(ctx.payload(gaze.changed)))
    return None


@module.rule(when=gesture.changed.max_age(None).detached(), reads=body, background=True)
async def send_gesture(ctx: rs.RuleContext) -> rs.Resign | None:
    """Perform the gesture."""
    if (robot := ctx[body]) is None:
        return rs.Resign("there is no robot")
    await _careful(ctx, robot.perform(ctx.payload(gesture.changed)))
    return None


async def _careful(ctx: rs.RuleContext, act: Any) -> None:
    """Await a command to the robot, and log a failure."""
    try:
        await act
    except PlatformError as error:
        ctx.log.warning("%s", error)


# ------------------------------------------------------------------------------------ feelings


def add_feelings(ctx: rs.RuleContext) -> None:
    """Add the rule that shows the agent's feelings, if the agent has the module `emotion`."""
    if "emotion:felt" not in ctx.policy.slots or "roboyio-feelings:feel" in ctx.policy.rules:
        return
    from ravestate.modules import emotion

    seconds: float = ctx.settings.feeling
    extra = rs.Module("roboyio-feelings", requires=[module, emotion])

    @extra.rule(
        when=emotion.felt.changed.max_age(None).detached(),
        writes=(expression, gesture),
        until=emotion.felt.changed,
        background=True,
    )
    async def feel(ctx: rs.RuleContext) -> None:
        """Show a feeling for a while. Nod if the feeling is ``happy``."""
        feeling = ctx.payload(emotion.felt.changed) or "neutral"
        ctx[expression] = feeling
        if feeling == "happy":
            ctx[gesture] = "nod"
        try:
            await ctx.sleep(seconds)
        finally:
            ctx[expression] = "neutral"

    ctx.add_rule(feel)
