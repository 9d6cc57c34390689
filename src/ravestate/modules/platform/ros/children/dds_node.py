"""A bridge process that joins the network of ROS 2 by DDS (cyclonedds), without an installed ROS 2.

It carries only topics, no services and no actions. A service would need the metadata of each sample (a
message of DDS). The library does not offer these metadata.
"""

# pyright: basic, reportMissingImports=false
from __future__ import annotations

import os
import threading

from pipe import Pipe, reason, serve

BASE, NAME, ARRAY = 1, 2, 3  # the numbers that rosbags gives to the kinds of fields


class DdsNode:
    """A DDS participant that carries out the agent's orders; see `pipe.serve`."""

    def __init__(self, pipe: Pipe, config):
        os.environ.update({key: value for key, value in config["environment"].items() if value})
        from cyclonedds.domain import DomainParticipant

        self._pipe = pipe
        self._participant = DomainParticipant(int(os.environ.get("ROS_DOMAIN_ID", "0")))
        self._channels = {}
        self._topics = {}
        self._lock = threading.Lock()

    def bind(self, channel, binding, outlet):
        """Make a reader or a writer."""
        from cyclonedds.core import Listener
        from cyclonedds.pub import DataWriter
        from cyclonedds.sub import DataReader

        if binding["kind"] not in ("subscriber", "publisher"):
            raise LookupError(
                "{} is a service or an action, which need ROS 2 itself; DDS alone (ros2.backend=dds) carries only topics".format(
                    binding["name"]
                )
            )
        qos = quality(binding["qos"])
        topic = self._topic(binding, qos)
        if binding["kind"] == "publisher":
            self._channels[channel] = (DataWriter(self._participant, topic, qos=qos), topic.data_type)
            return

        read = self._read

        class Reading(Listener):
            def on_data_available(self, reader):
                read(reader, outlet)

        self._channels[channel] = (DataReader(self._participant, topic, qos=qos, listener=Reading()), topic.data_type)

    def _topic(self, binding, qos):
        from cyclonedds.topic import Topic

        key = binding["name"], binding["type"]
        if key not in self._topics:
            kind = raw_type(binding["type"], binding["fields"])
            self._topics[key] = Topic(self._participant, "rt" + binding["name"], kind, qos=qos)
        return self._topics[key]

    def _read(self, reader, outlet):
        with self._lock:
            try:
                for sample in reader.take(N=1000):
                    if sample is not None and sample.sample_info.valid_data:
                        outlet.put(sample.wire)
            except (BrokenPipeError, ConnectionError):
                os._exit(0)  # the agent is gone
            except Exception as error:  # continue with the next message
                self._pipe.note(0, reason(error), "error")

    def message(self, channel, body):
        """Publish a message."""
        writer, kind = self._channels[channel]
        sample = object.__new__(kind)
        sample.wire = bytes(body)
        writer.write(sample)

    def call(self, channel, number, body):
        """Refuse a call."""
        raise LookupError("services need ROS 2 itself")

    def answer(self, channel, number, body, failed):
        """Do nothing: no service is offered."""

    def cancel(self, channel, number):
        """Do nothing: no goal is sent."""

    def unbind(self, channel):
        """Remove the reader or writer that `bind` has made."""
        self._channels.pop(channel, None)

    def ask(self):
        """Return the topics of the network. Count their publishers and subscribers in other participants."""
        import time

        from cyclonedds.builtin import BuiltinDataReader, BuiltinTopicDcpsPublication, BuiltinTopicDcpsSubscription

        own = self._participant.guid
        found = {}
        time.sleep(1.0)  # in this time, other participants announce themselves
        for place, kind in (("publishers", BuiltinTopicDcpsPublication), ("subscribers", BuiltinTopicDcpsSubscription)):
            for sample in BuiltinDataReader(self._participant, kind).read(N=10000):
                if sample.topic_name.startswith("rt/") and sample.participant_key != own:
                    name = sample.topic_name[2:]
                    row = found.setdefault(name, {"name": name, "types": [], "publishers": 0, "subscribers": 0})
                    row[place] += 1
                    type_ = sample.type_name.replace("::dds_::", "::").rstrip("_").replace("::", "/")
                    row["types"] = sorted({*row["types"], type_})
        return {"topics": list(found.values()), "services": [], "actions": []}

    def close(self):
        """Do nothing, because the process ends next."""


def raw_type(name, fields):
    """Return a class for samples that are already in their wire format.

    Args:
        name: The type, for example ``std_msgs/msg/String``.
        fields: The fields of the type, and of all types in it. Each field is a name and a description as in rosbags.
    """
    from cyclonedds.idl import make_idl_struct
    from cyclonedds.idl._main import IDL

    known = {}

    def struct(type_):
        if type_ not in known:
            package, kind, short = type_.split("/")
            title = f"{package}.{kind}.dds_.{short}_"
            known[type_] = make_idl_struct(short, title, {field: described(what) for field, what in fields[type_]})
        return known[type_]

    def described(what):
        from cyclonedds.idl import types

        node, of = what
        if node == BASE:
            base, limit = of
            if base == "string":
                return types.bounded_str[limit] if limit else str
            return {"bool": bool, "octet": types.byte, "char": types.uint8}.get(base) or getattr(types, base)
        if node == NAME:
            return struct(of)
        inner, count = described(of[0]), of[1]
        if node == ARRAY:
            return types.array[inner, count]
        return types.sequence[inner, count] if count else types.sequence[inner]

    raw = struct(name)

    class Bytes(IDL):
        def serialize(self, object, *args, **options):
            return object.wire

        def deserialize(self, data, *args, **options):
            sample = object.__new__(raw)
            object.__setattr__(sample, "wire", bytes(data))
            return sample

    raw.__idl__ = Bytes(raw)
    return raw


def quality(qos):
    """Return a quality of service as an object of cyclonedds. `qos` holds its values by name."""
    from cyclonedds.core import Policy, Qos

    reliable = qos["reliability"] == "reliable"
    return Qos(
        Policy.History.KeepLast(qos["depth"]),
        Policy.Reliability.Reliable(max_blocking_time=10**8) if reliable else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if qos["durability"] == "transient_local" else Policy.Durability.Volatile,
    )


if __name__ == "__main__":
    serve(DdsNode)
