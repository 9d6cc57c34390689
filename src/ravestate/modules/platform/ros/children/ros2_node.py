"""The bridge process of ROS 2: an rclpy node that passes on messages in their wire format (CDR)."""

# pyright: basic, reportMissingImports=false
from __future__ import annotations

import importlib
import os
import sys
import threading

from pipe import ANSWER, CALL, FAULT, FEEDBACK, SEEKING, Pipe, every, reason, serve

LOOK = 1.0  # seconds between two checks of the message types that other nodes use

UNKNOWN = "_NODE_NAME_UNKNOWN_"

STATUS = {4: "succeeded", 5: "cancelled", 6: "aborted"}  # final states of a goal in action_msgs/GoalStatus


class Ros2Node:
    """An rclpy node that carries out the agent's orders; see `pipe.serve`."""

    def __init__(self, pipe: Pipe, config):
        os.environ.update({key: value for key, value in config["environment"].items() if value})
        if not os.path.exists("DEFAULT_FASTDDS_PROFILES.xml"):  # the user's own file comes first
            os.environ.setdefault(
                "FASTDDS_DEFAULT_PROFILES_FILE", os.path.join(os.path.dirname(__file__), "fastdds.xml")
            )
        import rclpy
        from rclpy.executors import SingleThreadedExecutor

        self._pipe = pipe
        rclpy.init(args=[])
        namespace, _, name = config["name"].rpartition("/")
        self._node = rclpy.create_node(
            name, namespace=namespace or "/", use_global_arguments=False, start_parameter_services=False
        )
        self._channels = {}
        self._bindings = {}
        self._goals = {}
        self._calls = {}
        self._replies = {}
        self._number = 0
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._spinning = threading.Thread(target=self._spin, daemon=True)
        self._spinning.start()
        self._named = set()
        every(LOOK, self._look_at_types)

    def _spin(self):
        from rclpy.executors import ExternalShutdownException, ShutdownException

        while True:
            try:
                self._executor.spin()
                return
            except (ExternalShutdownException, ShutdownException):
                return
            except (BrokenPipeError, ConnectionError):
                os._exit(0)  # the agent is gone
            except Exception as error:  # continue with the next message
                self._pipe.note(0, reason(error), "error")

    def bind(self, channel, binding, outlet):
        """Make the channel's subscriber, publisher, service client, service server or action client."""
        kind, name = binding["kind"], binding["name"]
        self._bindings[channel] = binding
        cls = interface(binding["type"])
        if kind == "subscriber":
            from rclpy.event_handler import SubscriptionEventCallbacks

            events = SubscriptionEventCallbacks(incompatible_qos=lambda info: self._incompatible(channel, info))
            thing = self._node.create_subscription(
                cls, name, outlet.put, quality(binding["qos"]), raw=True, event_callbacks=events
            )
        elif kind == "publisher":
            from rclpy.event_handler import PublisherEventCallbacks

            events = PublisherEventCallbacks(incompatible_qos=lambda info: self._incompatible(channel, info))
            thing = self._node.create_publisher(cls, name, quality(binding["qos"]), event_callbacks=events)
        elif kind == "client":
            thing = self._node.create_client(cls, name)
        elif kind == "server":
            from rclpy.callback_groups import ReentrantCallbackGroup

            async def answer(request, response):
                return await self._serve(channel, cls, request)

            thing = self._node.create_service(cls, name, answer, callback_group=ReentrantCallbackGroup())
        else:
            from rclpy.action import ActionClient

            thing = ActionClient(self._node, cls, name)
        self._channels[channel] = thing
        self._executor.wake()

    def _look_at_types(self):
        """Warn about each node whose type for a topic is not this node's type. ROS 2 does not connect such a node, and does not report the mismatch."""
        for channel, binding in list(self._bindings.items()):
            name, type_ = binding["name"], binding["type"]
            if binding["kind"] == "subscriber":
                others, act, ours = self._node.get_publishers_info_by_topic(name), "publishes", "reads"
            elif binding["kind"] == "publisher":
                others, act, ours = self._node.get_subscriptions_info_by_topic(name), "reads", "publishes"
            else:
                continue
            for info in others:
                if info.node_name == UNKNOWN:
                    continue  # ROS 2 reports a node's topic a moment before the node's name
                other = channel, info.node_namespace.rstrip("/") + "/" + info.node_name, info.topic_type
                if info.topic_type != type_ and other not in self._named:
                    self._named.add(other)
                    self._pipe.note(
                        channel,
                        f"{name}: {other[1]} {act} {info.topic_type}, which is not the {type_} that the agent {ours}: "
                        f"write type={info.topic_type!r}",
                    )

    def _incompatible(self, channel, info):
        policy = str(getattr(info.last_policy_kind, "name", info.last_policy_kind)).lower()
        self._pipe.note(
            channel,
            "{}: the other end offers another quality of service ({}): write qos='sensor_data' for a best-effort topic, "
            "or latch=True for a transient-local one".format(self._bindings[channel]["name"], policy),
        )

    async def _serve(self, channel, cls, request):
        from rclpy.serialization import deserialize_message, serialize_message
        from rclpy.task import Future

        self._number += 1
        number = self._number
        future = self._replies[number] = Future(executor=self._executor)
        self._pipe.send(CALL, channel, number, serialize_message(request))
        body, failed = await future
        if failed:
            self._pipe.note(channel, bytes(body).decode("utf-8", "replace"))
            return cls.Response()  # a service of ROS 2 cannot answer that it has failed
        return deserialize_message(bytes(body), cls.Response)

    def message(self, channel, body):
        """Publish a message."""
        self._channels[channel].publish(bytes(body))

    def call(self, channel, number, body):
        """Call a service, or send a goal to an action server, in a thread, because the server may not be there yet."""
        act = self._call
        if self._bindings[channel]["kind"] == "action":
            act = self._act
            self._goals[channel, number] = {"handle": None, "cancelled": False}  # first, so that `cancel` finds it
        else:
            self._calls[channel, number] = {"future": None, "cancelled": False}
        threading.Thread(target=self._careful, args=(act, channel, number, bytes(body)), daemon=True).start()

    def _careful(self, act, channel, number, body):
        try:
            act(channel, number, body)
        except Exception as error:  # the caller gets the reason of any failure
            self._goals.pop((channel, number), None)
            self._calls.pop((channel, number), None)
            self._pipe.tell(FAULT, reason(error), channel, number)

    def _call(self, channel, number, body):
        from rclpy.serialization import deserialize_message, serialize_message

        binding, client = self._bindings[channel], self._channels[channel]
        cls = interface(binding["type"])
        call = self._calls.get((channel, number), {"cancelled": True})
        if not client.wait_for_service(timeout_sec=SEEKING * binding["timeout"]):
            raise LookupError("nobody offers the service {}{}".format(binding["name"], self._hint(binding)))

        def done(future):
            self._calls.pop((channel, number), None)
            error = future.exception()
            if error is not None:
                self._pipe.tell(FAULT, reason(error), channel, number)
            else:
                self._pipe.send(ANSWER, channel, number, serialize_message(future.result()))

        if call["cancelled"]:
            return
        future = call["future"] = client.call_async(deserialize_message(body, cls.Request))
        if call["cancelled"]:  # `cancel` may have come before there was a future
            client.remove_pending_request(future)
            return
        future.add_done_callback(done)
        self._executor.wake()

    def _hint(self, binding):
        for name, types in self._node.get_service_names_and_types():
            if name == binding["name"] and types != [binding["type"]]:
                return " with the type {}: it has {}".format(binding["type"], ", ".join(types))
        return ""

    def _act(self, channel, number, body):
        from rclpy.serialization import deserialize_message, serialize_message

        binding, client = self._bindings[channel], self._channels[channel]
        cls = interface(binding["type"])
        goal = self._goals[channel, number]
        if not client.wait_for_server(timeout_sec=binding["timeout"]):
            raise LookupError("nobody offers the action {}".format(binding["name"]))

        def feedback(message):
            self._pipe.send(FEEDBACK, channel, number, serialize_message(message.feedback))

        def accepted(future):
            handle = future.result()
            if not handle.accepted:
                self._goals.pop((channel, number), None)
                self._pipe.tell(FAULT, "the goal was refused", channel, number)
                return
            goal["handle"] = handle
            handle.get_result_async().add_done_callback(ended)
            if goal["cancelled"]:
                handle.cancel_goal_async()

        def ended(future):
            self._goals.pop((channel, number), None)
            answer = future.result()
            status = STATUS.get(answer.status, str(answer.status))
            if status == "succeeded":
                self._pipe.send(ANSWER, channel, number, serialize_message(answer.result))
            else:
                self._pipe.tell(FAULT, f"the goal was {status}", channel, number)

        message = deserialize_message(body, cls.Goal)

        def send():
            if goal["cancelled"]:
                self._goals.pop((channel, number), None)
                return
            try:
                client.send_goal_async(message, feedback).add_done_callback(accepted)
            except Exception as error:  # the caller gets the reason of any failure
                self._pipe.tell(FAULT, reason(error), channel, number)

        # Send on the executor's thread. On another thread, the answer might come before the client expects it.
        self._executor.create_task(send)

    def answer(self, channel, number, body, failed):
        """Answer a call of a service that the agent offers."""
        future = self._replies.pop(number, None)
        if future is not None:
            future.set_result((body, failed))
            self._executor.wake()

    def cancel(self, channel, number):
        """Cancel a goal, or forget a call. A call without an answer would otherwise stay in memory."""
        call = self._calls.pop((channel, number), None)
        if call is not None:
            call["cancelled"] = True
            if call["future"] is not None:
                self._channels[channel].remove_pending_request(call["future"])
        goal = self._goals.get((channel, number))
        if goal is not None:
            goal["cancelled"] = True
            if goal["handle"] is not None:
                self._executor.create_task(goal["handle"].cancel_goal_async)

    def unbind(self, channel):
        """Remove the entity that `bind` has made."""
        thing = self._channels.pop(channel, None)
        kind = self._bindings.pop(channel, {}).get("kind")
        if thing is None:
            return
        if kind == "action":
            thing.destroy()
        else:
            # Destroy the entity through the node, so that the node first removes the entity from its list. Otherwise the
            # executor would fail again and again on the destroyed entity.
            forget = {"subscriber": "subscription", "server": "service"}.get(kind, kind)
            getattr(self._node, f"destroy_{forget}")(thing)
        self._executor.wake()

    def ask(self):
        """Return the topics, services and actions of the network. Count their users in other nodes only."""
        node = self._node
        topics = []
        own = node.get_name(), node.get_namespace()

        def others(infos):
            return len([info for info in infos if (info.node_name, info.node_namespace) != own])

        for name, types in node.get_topic_names_and_types():
            publishers, subscribers = (
                node.get_publishers_info_by_topic(name),
                node.get_subscriptions_info_by_topic(name),
            )
            offered = {info.qos_profile.reliability.name.lower() for info in publishers}
            topics.append({
                "name": name, "types": list(types), "publishers": others(publishers), "subscribers": others(subscribers),
                "reliability": sorted(offered),
            })  # fmt: skip
        served = {}
        for found, space in node.get_node_names_and_namespaces():
            if (found, space) != own:
                for name, _ in node.get_service_names_and_types_by_node(found, space):
                    served[name] = served.get(name, 0) + 1
        services = [
            {"name": name, "types": list(types), "servers": served.get(name, 0)}
            for name, types in node.get_service_names_and_types()
        ]
        from rclpy.action import get_action_names_and_types

        actions = [
            {"name": name, "types": list(types), "servers": served.get(name + "/_action/send_goal", 0)}
            for name, types in get_action_names_and_types(node)
        ]
        return {"topics": topics, "services": services, "actions": actions}

    def close(self):
        """Shut rclpy down, then join its thread."""
        import rclpy

        self._executor.shutdown(timeout_sec=1.0)
        rclpy.try_shutdown()
        self._spinning.join(1.0)


def interface(name):
    """Return the class of a type such as ``std_msgs/msg/String``.

    Raises:
        LookupError: The ROS 2 installation does not have the type.
    """
    package, kind, short = name.split("/")
    try:
        return getattr(importlib.import_module(package + "." + kind), short)
    except (ImportError, AttributeError):
        raise LookupError(
            f"ROS 2 at {sys.prefix} does not have the type {name}: source the workspace in which {package} is built, or set ros2.backend=dds, "
            "which needs only its .msg files"
        ) from None


def quality(qos):
    """Return a quality of service as an rclpy profile. `qos` holds its values by name."""
    from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

    return QoSProfile(
        depth=qos["depth"],
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy[qos["reliability"].upper()],
        durability=DurabilityPolicy[qos["durability"].upper()],
    )


if __name__ == "__main__":
    import rclpy  # noqa: F401  # its PyPI package restarts the interpreter, so import it before the pipe opens

    serve(Ros2Node)
