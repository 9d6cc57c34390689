"""The bridge process of ROS 1: a rospy node that passes on messages in their wire format."""

# pyright: basic, reportMissingImports=false
from __future__ import annotations

import os
import socket
import threading
import time
import xmlrpc.client

from pipe import ANSWER, CALL, FAULT, LARGE, PUBLISHER, SEEKING, SUBSCRIBER, Pipe, every, reason, serve

PROBE = 1.0  # seconds between two checks of the ROS master


def message_class(type_, md5, text=""):
    """Return a class for messages that stay bytes in their wire format."""
    import genpy

    class Raw(genpy.Message):
        __slots__ = ("data",)
        _slot_types = ("uint8[]",)
        _type = type_
        _md5sum = md5
        _full_text = text
        _has_header = False

        def __init__(self, data=b""):
            self.data = data

        def serialize(self, buff):
            buff.write(self.data)

        def deserialize(self, data):
            self.data = data
            return self

    return Raw


def call_class():
    """Return the class of a service call that another thread may end at any time."""
    import rospy

    class Call(rospy.ServiceProxy):
        ended = False
        connection = None

        @property
        def transport(self):
            return self.connection

        @transport.setter
        def transport(self, made):  # rospy sets the transport when it has connected
            self.connection = made
            if made is not None and self.ended:
                made.close()

        def end(self):
            self.ended = True
            self.close()

    return Call


def transport_class(node):
    """Return the class of a connection with a publisher. If the first message is small, the agent gets the connection."""
    from rospy.exceptions import TransportTerminated
    from rospy.impl.tcpros_base import TCPROSTransport, recv_buff

    class Transport(TCPROSTransport):
        def receive_loop(self, msgs_callback):
            node.check(self.name, self.header)
            try:
                while self.read_buff.tell() < 4:  # the first 4 bytes are the length of the first message
                    recv_buff(self.socket, self.read_buff, self.protocol.buff_size)
                first = self.read_buff.getvalue()[: self.read_buff.tell()]
            except (TransportTerminated, AttributeError):
                first = b""  # the connection is closed, which rospy notices by itself
            if first and int.from_bytes(first[:4], "little") < LARGE:
                node.from_publisher(self, first)
            else:
                super().receive_loop(msgs_callback)

    return Transport


class Ros1Node:
    """A rospy node that carries out the agent's orders; see `pipe.serve`."""

    def __init__(self, pipe: Pipe, config):
        os.environ.update({key: value for key, value in config["environment"].items() if value})
        import rosgraph

        self._pipe = pipe
        self._uri = rosgraph.get_master_uri()
        waits = False
        while not self._master_pid():
            if not waits:
                pipe.note(0, f"waits for a ROS master at {self._uri}: start one with `roscore`")
                waits = True
            time.sleep(PROBE / 4)
        self._pid = self._master_pid()
        namespace, _, name = config["name"].rpartition("/")
        os.environ["ROS_NAMESPACE"] = namespace or "/"
        import rospy
        import rospy.impl.simtime
        import rospy.impl.tcpros_pubsub
        import rospy.topics

        self._rospy = rospy
        rospy.topics.QueuedConnection = self._to_subscriber  # instead of rospy's own queue and thread
        rospy.impl.tcpros_pubsub.TCPROSTransport = transport_class(self)
        rospy.impl.simtime._is_use_simtime = lambda: False  # else rospy would follow /clock; only the agent may do so
        self._call_class = call_class()
        rospy.init_node(name, argv=["node"], disable_signals=True, disable_rosout=True, log_level=rospy.ERROR)
        self._channels = {}
        self._bindings = {}
        self._replies = {}
        self._calls = {}
        self._connections = {}
        self._number = 0
        self._lock = threading.Lock()
        every(PROBE, self._look_at_master)

    def _master_pid(self):
        try:
            proxy = xmlrpc.client.ServerProxy(self._uri)
            code, _, pid = proxy.getPid("/ravestate")  # type: ignore[misc]  # rospy's answers have no types
            return pid if code == 1 else 0
        except (OSError, xmlrpc.client.Error):
            return 0

    def _look_at_master(self):
        """End the process if a new master has replaced the old one. The agent then starts a process for the new master."""
        pid = self._master_pid()
        if pid == self._pid:
            return
        if not pid:
            self._pipe.note(0, f"the ROS master at {self._uri} is gone; the node waits until it is back")
            while not (pid := self._master_pid()):
                time.sleep(PROBE / 4)
        if pid != self._pid:
            os._exit(3)
        self._pipe.note(0, "the ROS master is back", "info")

    def bind(self, channel, binding, outlet):
        rospy, kind = self._rospy, binding["kind"]
        self._bindings[channel] = binding
        type_, md5 = binding.get("type"), binding.get("md5")
        if kind == "subscriber":
            self._channels[channel] = self._subscribe(channel, binding, outlet)
        elif kind == "publisher":
            self._channels[channel] = rospy.Publisher(
                binding["name"], message_class(type_, md5, binding["text"]), latch=binding["latch"],
                queue_size=binding["depth"], tcp_nodelay=True,
            )  # fmt: skip
        elif kind == "client":
            self._channels[channel] = self._service_class(type_, "*")
        elif kind == "server":
            service = self._service_class(type_, md5)
            self._channels[channel] = rospy.Service(
                binding["name"], service, lambda request: self._serve(channel, service, request)
            )

    def _subscribe(self, channel, binding, outlet):
        rospy = self._rospy

        def take(message):
            if _suits(binding, message._connection_header):
                outlet.put(message._buff)

        # rospy's queue has no limit, because all subscribers of a topic share it. The outlet skips old messages instead.
        # rospy allocates a new buffer for each read. Reading an image in parts costs less than allocating a large buffer.
        subscriber = rospy.Subscriber(
            binding["name"], rospy.AnyMsg, take, queue_size=None, buff_size=1 << 16, tcp_nodelay=True
        )
        for connection in subscriber.impl.connections:
            self.check(binding["name"], connection.header)
        return subscriber

    def check(self, topic, header):
        """Warn the agent about each of its subscriptions to `topic` whose type is not the publisher's type."""
        for channel, binding in list(self._bindings.items()):
            if header and binding["kind"] == "subscriber" and binding["name"] == topic and not _suits(binding, header):
                self._pipe.note(channel, _mismatch(binding, header))

    def _to_subscriber(self, connection, depth):
        self._hand_over(SUBSCRIBER, connection, {"topic": connection.name, "depth": depth})
        return connection

    def from_publisher(self, connection, first):
        """Give the agent a connection with a publisher, and the bytes that this process has already read from it."""
        header = connection.header
        what = {
            "topic": connection.name, "type": header["type"], "md5": header["md5sum"],
            "latching": connection.is_latched, "first": first.decode("latin-1"),
        }  # fmt: skip
        self._hand_over(PUBLISHER, connection, what)

    def _hand_over(self, kind, connection, what):
        with self._lock:
            self._number += 1
            number = self._number
            self._connections[number] = connection
        self._pipe.hand_over(connection.socket, kind, number, what)

    def hang_up(self, number):
        """Close and forget a connection that the agent or the other node has ended."""
        self._connections.pop(number).close()

    def _service_class(self, type_, md5):
        class Service:
            _type = type_
            _md5sum = md5
            _request_class = message_class(type_ + "Request", md5)
            _response_class = message_class(type_ + "Response", md5)

        return Service

    def _serve(self, channel, service, request):
        with self._lock:
            self._number += 1
            number = self._number
            done = self._replies[number] = [threading.Event(), b"", False]
        self._pipe.send(CALL, channel, number, request.data)
        done[0].wait()
        if done[2]:
            raise self._rospy.ServiceException(bytes(done[1]).decode("utf-8", "replace"))
        return service._response_class(bytes(done[1]))

    def message(self, channel, body):
        """Drop a message. The agent passes a message to the bridge only if the topic has no subscriber."""

    def call(self, channel, number, body):
        # A persistent proxy keeps its connection, which `cancel` closes.
        binding, service = self._bindings[channel], self._channels[channel]
        call = self._calls[channel, number] = self._call_class(binding["name"], service, persistent=True)
        arguments = channel, number, bytes(body), call, binding, service
        threading.Thread(target=self._call, args=arguments, daemon=True).start()

    def _call(self, channel, number, body, call, binding, service):
        name = binding["name"]
        try:
            self._wait_for(name, SEEKING * binding["timeout"])
            found = service_header(self._rospy.resolve_name(name), self._uri)
            if found.get("md5sum") not in (None, binding["md5"]):
                raise TypeError(
                    "the service {} has the type {}, not {}: write type={!r}".format(
                        name, found.get("type"), service._type, found.get("type")
                    )
                )
            if not call.ended:
                answer = call(service._request_class(body))
                self._pipe.send(ANSWER, channel, number, answer.data)
        except Exception as error:  # the caller gets the reason of each failure
            self._pipe.tell(FAULT, reason(error), channel, number)
        finally:
            self._calls.pop((channel, number), None)
            call.end()

    def _wait_for(self, service, seconds):
        try:
            self._rospy.wait_for_service(service, timeout=seconds)
        except self._rospy.ROSException:
            raise LookupError(f"nobody offers the service {service}") from None

    def answer(self, channel, number, body, failed):
        done = self._replies.pop(number, None)
        if done is not None:
            done[1], done[2] = body, failed
            done[0].set()

    def cancel(self, channel, number):
        """End the connection of a call, so that its thread ends. ROS 1 has no way to withdraw the call itself."""
        call = self._calls.pop((channel, number), None)
        if call is not None:
            call.end()

    def unbind(self, channel):
        self._bindings.pop(channel, None)
        thing = self._channels.pop(channel, None)
        if hasattr(thing, "unregister"):
            thing.unregister()
        elif hasattr(thing, "shutdown"):
            thing.shutdown()

    def ask(self):
        import rosgraph

        master = rosgraph.Master(self._rospy.get_name())
        publishers, subscribers, services = master.getSystemState()
        types = dict(master.getTopicTypes())
        own = self._rospy.get_name()
        found = {}
        for place, rows in (("publishers", publishers), ("subscribers", subscribers)):
            for name, nodes in rows:
                row = found.setdefault(name, {"name": name, "types": [], "publishers": 0, "subscribers": 0})
                row[place] = len([node for node in nodes if node != own])
                if types.get(name, "*") != "*":
                    row["types"] = [types[name]]
        listed = []
        for name, nodes in services:
            type_ = service_header(name, self._uri).get("type") if own not in nodes else None
            listed.append(
                {"name": name, "types": [type_] if type_ else [], "servers": len([n for n in nodes if n != own])}
            )
        actions = []
        for name, row in found.items():  # an action is a group of topics
            action, _, end = name.rpartition("/")
            goal = found.get(action + "/goal", {"types": []})["types"]
            if end == "status" and row["types"] == ["actionlib_msgs/GoalStatusArray"] and goal:
                type_ = goal[0][: -len("ActionGoal")]
                actions.append({"name": action, "types": [type_], "servers": row["publishers"]})
        return {"topics": list(found.values()), "services": listed, "actions": actions}

    def close(self):
        self._rospy.signal_shutdown("the agent ends")


def _suits(binding, header):
    return header.get("type") == binding["type"] and header.get("md5sum", "*") in (binding["md5"], "*")


def _mismatch(binding, header):
    return "{}: {} publishes {}, which is not the {} that the agent reads: write type={!r}{}".format(
        binding["name"], header.get("callerid"), header.get("type"), binding["type"], header.get("type"),
        " (same name, but other fields: give the agent the publisher's .msg files in ros1.definitions)"
        if header.get("type") == binding["type"] else "",
    )  # fmt: skip


def service_header(name, uri):
    """Return the header fields of a service, such as its type and MD5 sum, or ``{}`` if the service does not answer."""
    import rosgraph
    from rosgraph.network import read_ros_handshake_header, write_ros_handshake_header

    try:
        address = rosgraph.Master("/ravestate", uri).lookupService(name)
        host, _, port = address[len("rosrpc://") :].rpartition(":")
        with socket.create_connection((host, int(port.strip("/"))), timeout=2.0) as sock:
            from io import BytesIO

            fields = {"probe": "1", "md5sum": "*", "callerid": "/ravestate", "service": name}
            write_ros_handshake_header(sock, fields)
            return dict(read_ros_handshake_header(sock, BytesIO(), 2048))
    except Exception:  # rosgraph raises many kinds of errors if a service is gone or broken; the type stays unknown
        return {}


if __name__ == "__main__":
    serve(Ros1Node)
