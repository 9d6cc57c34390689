"""Slots that are bound to topics, services and actions. `ros1` and `ros2` declare them on a designer's module."""

from __future__ import annotations

import asyncio
import contextlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, cast

import ravestate as rs
from ravestate.declare.arguments import check_name
from ravestate.declare.condition import Compound, Condition, Constraint
from ravestate.declare.module import as_module
from ravestate.declare.signal import Signal
from ravestate.declare.wording import place_of_call
from ravestate.errors import DeclarationError, PlatformError

from .definitions import full_name
from .naming import quality

if TYPE_CHECKING:
    from .goals import GoalTopics
    from .node import Channel, Node

DEEP = 1000
"""With ``keep="all"``, ROS 2 queues at most this many messages for the agent, unless `qos` sets a depth."""


@dataclass(frozen=True, slots=True)
class Binding:
    """The topic, service or action to which a slot is bound.

    Attributes:
        version: 1 for ROS 1, 2 for ROS 2.
        kind: The role of the slot.
        name: The name of the topic, service or action, as the designer wrote it.
        type: The name of the type, as the designer wrote it.
        options: The arguments of the `Node` method that opens the topic, service or action.
    """

    version: Literal[1, 2]
    kind: Literal["subscriber", "publisher", "service", "action"]
    name: str
    type: str
    options: Mapping[str, Any] = field(default_factory=dict[str, Any])

    def open(self, node: Node) -> Channel | GoalTopics:
        """Open the channel of a publisher, a service or an action."""
        if self.kind == "publisher":
            return node.advertise(self.name, self.type, **self.options)
        if self.kind == "service":
            return node.client(self.name, self.type, **self.options)
        return node.action(self.name, self.type, **self.options)


class TopicSlot(rs.Slot[Any]):
    """A slot that is bound to a topic. Its value is the last message; None before the first message."""

    __slots__ = ("binding",)
    binding: Binding


class ServiceSlot(TopicSlot):
    """A slot that is bound to a service.

    A write is a request, and raises ``requested``. The response raises ``changed``. A failure raises ``failed``; the
    payload is the reason.
    """

    __slots__ = ("failed", "requested")
    names = ("requested",)
    answers: tuple[str, ...] = ("changed", "failed")
    """The signals that report on a request. A write to the slot does not raise them."""
    requested: rs.Signal[Any]
    failed: rs.Signal[str]


class ActionSlot(ServiceSlot):
    """A slot that is bound to an action.

    A write is a goal, and raises ``requested``. Feedback raises ``feedback``, and the result raises ``changed``. A
    failure (no server, refused, aborted, cancelled) raises ``failed``; the payload is the reason. If the slot's own
    ``until`` cancels a goal, no signal reports this.
    """

    __slots__ = ("feedback",)
    answers = ("changed", "failed", "feedback")
    feedback: rs.Signal[Any]


@dataclass(eq=False, slots=True)
class Goal:
    """A goal whose sender waits for the result; see `perform`."""

    value: Any
    result: asyncio.Future[Any]
    task: asyncio.Task[Any] | None = None

    def follow(self, task: asyncio.Task[Any]) -> None:
        """Pass the outcome of `task` to the goal's sender. The task sends the goal to the server, and waits for the result."""
        self.task = task
        task.add_done_callback(self._end)

    def fail(self, reason: str) -> None:
        """End the sender's wait with an error."""
        if not self.result.done():
            self.result.set_exception(PlatformError(reason))

    def _end(self, task: asyncio.Task[Any]) -> None:
        if reason := _failure(task):
            self.fail(reason)
        elif not self.result.done():
            self.result.set_result(task.result())

    def cancel(self) -> None:
        """Cancel the goal."""
        if self.task is not None:
            self.task.cancel()
        self.result.cancel()


class Declarations:
    """Declares slots for one version of ROS on designers' modules.

    Args:
        version: 1 or 2.
        module: The module ``ros1`` or ``ros2``. A designer's module on which slots are declared here requires it.
        node: The slot of `module` that holds the context's node.
    """

    def __init__(self, version: Literal[1, 2], module: rs.Module, node: rs.Slot[Node | None]) -> None:
        self.version: Literal[1, 2] = version
        self.module = module
        self.node = node

    def subscriber(
        self,
        module: Any,
        name: str,
        *,
        topic: str,
        type: str,
        keep: Literal["latest", "all"] = "latest",
        rate: float | None = None,
        qos: str | Mapping[str, Any] | None = None,
        latch: bool = False,
    ) -> rs.Slot[Any]:
        """Declare a slot that follows a topic: each message becomes the slot's value, and raises ``.changed``.

        Args:
            module: The module to declare the slot on.
            name: The slot's name.
            topic: The topic, for example ``/chat``. Relative names and ``~private`` names are allowed.
            type: The type of the topic's messages, for example ``std_msgs/String``.
            keep: With ``latest``, a newer message replaces a waiting message. With ``all``, the slot gets every message, unless
                `rate` is given or a queue overflows.
            rate: The maximum number of messages per second. The slot gets the newest message of each interval (1 / `rate` seconds).
            qos: ROS 2: ``sensor_data``, ``latched``, or a dict of ``depth``, ``reliability``, ``durability``.
            latch: ROS 2: whether to get the last message that a publisher has kept for late subscribers.

        Raises:
            DeclarationError: An argument is wrong.
        """
        self._check(type, "msg")
        if keep not in ("latest", "all"):
            raise DeclarationError(f"subscriber {name}: keep={keep!r}: write keep='latest' or keep='all'")
        if rate is not None and not (isinstance(rate, (int, float)) and rate > 0):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise DeclarationError(f"subscriber {name}: rate={rate!r} must be a number of messages per second above 0")
        options = {
            "latest": keep == "latest", "rate": rate,
            "qos": quality(qos, depth=DEEP if keep == "all" else 10, latch=latch),
        }  # fmt: skip
        binding = Binding(self.version, "subscriber", topic, type, options)
        slot = self._slot(module, name, TopicSlot, binding, keep="latest" if keep == "latest" else "all", input=True)
        node = self.node

        @as_module(module).rule(
            when=node.changed.max_age(None).detached(),
            reads=node,
            writes=slot,
            until=node.changed,
            detached=True,  # each message is a separate cause
            background=True,
            name=f"{name}_receive",
        )
        async def receive(ctx: rs.RuleContext) -> rs.Resign | None:
            """Write each message of the topic to the slot."""
            if (here := ctx[node]) is None:
                return rs.Resign("there is no node")
            await here.prepare()

            def take(message: Any) -> None:
                ctx[slot] = message

            channel = _opened(ctx, here, slot, take)
            try:
                await asyncio.get_running_loop().create_future()
            finally:
                if channel is not None:
                    channel.close()
            return None

        return slot

    def publisher(
        self,
        module: Any,
        name: str,
        *,
        topic: str,
        type: str,
        latch: bool = False,
        qos: str | Mapping[str, Any] | None = None,
    ) -> rs.Slot[Any]:
        """Declare a slot that publishes: each write becomes a message on a topic.

        Args:
            module, name, topic, type, qos: As for `subscriber`.
            latch: Whether subscribers that come later get the last message. In ROS 2, a `qos` with the durability
                ``transient_local`` means the same.

        Raises:
            DeclarationError: An argument is wrong.
        """
        self._check(type, "msg")
        options = {"latch": latch, "qos": quality(qos, depth=100, latch=latch)}
        slot = self._slot(module, name, TopicSlot, Binding(self.version, "publisher", topic, type, options))
        node = self.node

        @as_module(module).rule(
            when=slot.changed.max_age(None).detached(), reads=node, background=True, name=f"{name}_publish"
        )
        async def publish(ctx: rs.RuleContext) -> rs.Resign | None:
            """Publish each value of the slot."""
            if (here := ctx[node]) is None:
                return rs.Resign("there is no node")
            await here.prepare()
            cast("Channel", _channel(here, slot)).publish(ctx.payload(slot.changed))
            return None

        return slot

    def service(self, module: Any, name: str, *, service: str, type: str, timeout: float = 5.0) -> ServiceSlot:
        """Declare a slot that calls a service. A write is the request, and ``.changed`` carries the response.

        Args:
            module, name: As for `subscriber`.
            service: The service's name.
            type: The service's type, for example ``std_srvs/SetBool``.
            timeout: If no response comes within this many seconds, the slot raises ``.failed``.

        Raises:
            DeclarationError: An argument is wrong.
        """
        self._check(type, "srv")
        binding = Binding(self.version, "service", service, type, {"timeout": _seconds(timeout, name)})
        slot = self._slot(module, name, ServiceSlot, binding)
        node = self.node

        @as_module(module).rule(
            when=slot.requested.max_age(None), reads=node, emits=(slot.changed, slot.failed), name=f"{name}_call"
        )
        async def call(ctx: rs.RuleContext) -> rs.Resign | None:
            """Call the service, and raise the signal of its answer."""
            if (here := ctx[node]) is None:
                return rs.Resign("there is no node")
            await here.prepare()
            try:
                answer = await _channel(here, slot).call(ctx.payload(slot.requested))
            except PlatformError as error:
                ctx.log.warning("%s", error)
                ctx.emit(slot.failed, str(error))
            else:
                ctx.emit(slot.changed, answer)
            return None

        return slot

    def action(
        self,
        module: Any,
        name: str,
        *,
        action: str,
        type: str,
        timeout: float = 5.0,
        until: Condition | None = None,
    ) -> ActionSlot:
        """Declare a slot that is bound to an action. A write is the goal, and ``.changed`` carries the result.

        Feedback raises ``.feedback``. The slot cancels its goals when `until` is met, or when the ``until`` of a rule
        that writes the slot is met. Only the second case raises ``.failed``.

        Args:
            module, name: As for `subscriber`.
            action: The action's name.
            type: The action's type: ``nav2_msgs/NavigateToPose``, or ``move_base_msgs/MoveBase`` in ROS 1.
            timeout: The action's server must appear within this many seconds.
            until: A condition that cancels the goal.

        Raises:
            DeclarationError: An argument is wrong.
        """
        self._check(type, "action")
        binding = Binding(self.version, "action", action, type, {"timeout": _seconds(timeout, name)})
        slot = self._slot(module, name, ActionSlot, binding)
        node = self.node

        @as_module(module).rule(
            when=slot.requested.max_age(None),
            reads=node,
            emits=(slot.changed, slot.failed, slot.feedback),
            until=until,
            name=f"{name}_act",
        )
        async def act(ctx: rs.RuleContext) -> rs.Resign | None:
            """Send the goal, and raise the signals of its feedback and its result."""
            asked = ctx.payload(slot.requested)
            if (here := ctx[node]) is None:
                if isinstance(asked, Goal):
                    asked.fail(f"{slot.name} has no node; in virtual time, there is none")
                return rs.Resign("there is no node")

            async def send() -> Any:
                await here.prepare()
                value = asked.value if isinstance(asked, Goal) else asked
                return await _channel(here, slot).call(value, lambda message: ctx.emit(slot.feedback, message))

            task = asyncio.create_task(send())
            goals = here.goals.setdefault(slot.name, set())
            goals.add(task)
            if isinstance(asked, Goal):
                asked.follow(task)
            try:
                await asyncio.wait((task,))
            finally:
                task.cancel()
                goals.discard(task)
            if reason := _failure(task):
                ctx.emit(slot.failed, reason)
            else:
                ctx.emit(slot.changed, task.result())
            return None

        return slot

    # ------------------------------------------------------------------------------- internals

    def _check(self, type: str, kind: str) -> None:
        try:
            full_name(type, kind)
        except PlatformError as error:
            raise DeclarationError(str(error)) from None

    def _slot(self, module: Any, name: str, cls: type[Any], binding: Binding, **options: Any) -> Any:
        owner = as_module(module)
        check_name(name, f"{owner.name}.slot")
        slot = cls(f"{owner.name}:{name}", None, origin=place_of_call(), always=True, **options)
        slot.binding = binding
        if isinstance(slot, ServiceSlot):
            for what in slot.answers:
                answer: rs.Signal[Any] = rs.Signal(f"{slot.name}:{what}", None, origin=slot.origin)
                setattr(slot, what, answer)
                owner.signals.append(answer)
        owner.slots.append(slot)
        if self.module not in owner.requires and owner is not self.module:
            owner.requires.append(self.module)
        return slot


async def perform(ctx: rs.RuleContext, slot: ActionSlot, goal: Any) -> Any:
    """Send a goal from a rule, and return its result. If the rule is interrupted, the goal is cancelled.

    Args:
        ctx: The rule's context; the rule declares ``writes=slot``.
        slot: The slot of the action.
        goal: The goal: any value that you could write to the slot.

    Raises:
        PlatformError: The goal was refused, aborted or cancelled, or there is no server. In virtual time,
            there is no node, so every goal fails.
    """
    sent = Goal(goal, asyncio.get_running_loop().create_future())
    ctx[slot] = sent
    try:
        return await sent.result
    except asyncio.CancelledError:
        sent.cancel()
        raise


def _failure(task: asyncio.Task[Any]) -> str:
    """Return the reason why a goal has no result, or an empty text if the goal has one."""
    return "the goal was cancelled" if task.cancelled() else str(task.exception() or "")


def is_bound(ctx: rs.RuleContext, version: int) -> bool:
    """Return whether a slot of the context is bound to a topic, service or action of this version of ROS."""
    return any(isinstance(slot, TopicSlot) and slot.binding.version == version for slot in ctx.policy.slots.values())


def bind_all(ctx: rs.RuleContext, node: Node, version: int) -> None:
    """Open the channels of a context's slots that publish or call, and add the rules that cancel goals."""
    for slot in ctx.policy.slots.values():
        if isinstance(slot, TopicSlot) and slot.binding.version == version and slot.binding.kind != "subscriber":
            with contextlib.suppress(PlatformError):  # an unknown type; the slot's own rule reports it at its first use
                _channel(node, slot)
            if isinstance(slot, ActionSlot):
                _cancel_with_writers(ctx, node, slot)


def _cancel_with_writers(ctx: rs.RuleContext, node: Node, slot: ActionSlot) -> None:
    """Cancel a slot's goals when the ``until`` of a rule that writes the slot is met."""
    for rule in list(ctx.policy.rules.values()):
        if slot in rule.writes and rule.until is not None:
            owner, name = slot.name.split(":")
            title = f"{name}_cancel_{rule.name.replace(':', '_')}"

            @rs.Module(owner).rule(when=_looking(rule.until), background=True, name=title)
            async def cancel(ctx: rs.RuleContext) -> None:
                """Cancel the slot's open goals."""
                for task in list(node.goals.get(slot.name, ())):
                    task.cancel()

            ctx.add_rule(cancel)


def _looking(condition: Condition) -> Condition:
    """Return a condition that is met whenever `condition` is met, but consumes nothing (law L19)."""
    if isinstance(condition, Compound):
        return type(condition)(tuple(_looking(part) for part in condition.parts))
    if isinstance(condition, (Signal, Constraint)):
        return condition.detached()  # pyright: ignore[reportUnknownMemberType,reportUnknownVariableType]
    return condition


def _channel(node: Node, slot: TopicSlot) -> Channel | GoalTopics:
    """Return the channel of a slot that publishes or calls. The first call opens the channel."""
    channel = node.bound.get(slot.name)
    if channel is None:
        channel = node.bound[slot.name] = slot.binding.open(node)
    return channel


def _opened(ctx: rs.RuleContext, node: Node, slot: TopicSlot, take: Any) -> Channel | None:
    binding = slot.binding
    try:
        return node.subscribe(binding.name, binding.type, take, **binding.options)
    except PlatformError as error:
        ctx.log.error("%s: %s", slot.name, error)
        return None


def _seconds(timeout: object, name: str) -> float:
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) or timeout <= 0:
        raise DeclarationError(f"{name}: timeout={timeout!r} must be a number of seconds above 0")
    return float(timeout)
