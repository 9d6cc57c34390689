"""Bare nodes of ROS 1 (rospy): an echo, a node that talks with it (the floor), and a source of numbers and images."""

import itertools
import struct
import threading
import time

import genpy
import rospy
from std_msgs.msg import Int32, String
from wire import serve

Seconds = float
WIDTH, HEIGHT = 640, 480
OPTIONS = {"queue_size": 100_000, "tcp_nodelay": True}


class Image(genpy.Message):
    """A sensor_msgs/Image in its wire form, because Debian's rospy does not have the package of this type."""

    __slots__ = ("data",)
    _slot_types = ("uint8[]",)
    _type, _md5sum, _full_text, _has_header = "sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743", "", False

    def serialize(self, buff):
        buff.write(self.data)


def start(name: str) -> None:
    """Start a node in this process."""
    rospy.init_node(name, disable_signals=True, disable_rosout=True)


def echo() -> None:
    """Send each text of /chat back on /back."""
    back = rospy.Publisher("/back", String, **OPTIONS)
    rospy.Subscriber("/chat", String, lambda message: back.publish(message.data), tcp_nodelay=True)


def talk(count: int) -> list[Seconds]:
    """Send a text to the echo, and the next text when the first is back; return the seconds of each round."""
    times, done = [], threading.Event()
    chat = rospy.Publisher("/chat", String, **OPTIONS)

    def again(message):
        times.append(time.perf_counter())
        if len(times) > count:
            done.set()
        else:
            chat.publish("text")

    back = rospy.Subscriber("/back", String, again, tcp_nodelay=True)
    while not (chat.get_num_connections() and back.get_num_connections()):
        time.sleep(0.05)
    chat.publish("text")
    assert done.wait(120)
    back.unregister()
    chat.unregister()
    return [after - before for before, after in itertools.pairwise(times)]


def numbers(count: int, rate: float) -> None:
    """When there is a subscriber, begin to publish `count` numbers on /numbers, `rate` a second."""
    _pace(rospy.Publisher("/numbers", Int32, **OPTIONS), count, rate, lambda number: number)


def images(count: int, rate: float) -> None:
    """When there is a subscriber, begin to publish `count` images on /images, `rate` a second."""
    size = 3 * WIDTH * HEIGHT
    head = struct.pack("<IIII", 0, 0, 0, 0) + struct.pack("<III", HEIGHT, WIDTH, 4) + b"rgb8\0"
    image = Image(head + struct.pack("<II", 3 * WIDTH, size) + bytes(size))
    _pace(rospy.Publisher("/images", Image, queue_size=100), count, rate, lambda number: image)


def _pace(publisher, count, rate, make):
    def run():
        while not publisher.get_num_connections():
            time.sleep(0.05)
        time.sleep(0.5)
        begin = time.perf_counter()
        for number in range(count):
            time.sleep(max(0.0, begin + number / rate - time.perf_counter()))
            publisher.publish(make(number))

    threading.Thread(target=run, daemon=True).start()


if __name__ == "__main__":
    serve(start, echo, talk, numbers, images)
