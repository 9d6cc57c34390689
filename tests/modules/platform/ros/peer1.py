"""The peer of the ROS 1 tests: a real node. The tests run it with the Python that has rospy."""

import sys
import threading

import actionlib
import genpy
import rospy
from actionlib.msg import TestAction, TestFeedback, TestResult
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Float32, Int32, String


class Raw(genpy.Message):
    """A serialised message of any type."""

    __slots__ = ("data",)
    _slot_types = ("uint8[]",)
    _has_header = False

    def __init__(self, data=b""):
        self.data = data

    def serialize(self, buff):
        buff.write(self.data)

    def deserialize(self, data):
        self.data = data
        return self


def service(type_, md5):
    class Request(Raw):
        _type, _md5sum, _full_text = type_ + "Request", md5, ""

    class Response(Raw):
        _type, _md5sum, _full_text = type_ + "Response", md5, ""

    class Service:
        _type, _md5sum = type_, md5
        _request_class, _response_class = Request, Response

    return Service


def typed(type_, md5, text):
    class Message(Raw):
        _type, _md5sum, _full_text = type_, md5, text

    return Message


SETBOOL = service("std_srvs/SetBool", "09fb03525b03e7ea1fd3992bafd87e16")


def answer(request):
    on = bool(request.data[0])
    text = b"on" if on else b"off"
    return SETBOOL._response_class(bytes([on]) + len(text).to_bytes(4, "little") + text)


def pause(seconds):
    threading.Event().wait(seconds)


def main():
    rospy.init_node("peer", anonymous=True, disable_signals=True)
    options = {"queue_size": 20000, "tcp_nodelay": True}
    back = rospy.Publisher("/back", String, **options)
    numbers = rospy.Publisher("/numbers", Int32, **options)
    image = typed("sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743", "")
    images = rospy.Publisher("/images", image, **options)
    wrong = rospy.Publisher("/wrong", Float32, latch=True, queue_size=1)
    wrong.publish(1.5)
    point = typed("robot_msgs/Reading", f"{sys.argv[1]}", "")
    own = rospy.Publisher("/own", point, latch=True, queue_size=1)
    own.publish(point((7).to_bytes(4, "little") + (4).to_bytes(4, "little") + b"warm"))
    rospy.Service("/lamp", SETBOOL, answer)
    rospy.Service("/silent", SETBOOL, lambda request: threading.Event().wait())

    def burst(message):
        first, count, rate = map(int, message.data.split())
        for n in range(first, first + count):
            numbers.publish(n)
            if rate:
                pause(1 / rate)

    def show(message):
        import struct

        pixels = bytes(640 * 480 * 3)
        head = struct.pack("<IIII", 1, 2, 3, 4) + b"base"
        body = (
            head + struct.pack("<III", 480, 640, 4) + b"rgb8" + b"\0" + struct.pack("<II", 1920, len(pixels)) + pixels
        )
        for _ in range(message.data):
            images.publish(image(body))
            pause(1 / 30)

    rospy.Subscriber("/chat", String, lambda message: back.publish("echo " + message.data), tcp_nodelay=True)
    rospy.Subscriber(
        "/burst", String, lambda message: threading.Thread(target=burst, args=(message,), daemon=True).start()
    )
    rospy.Subscriber(
        "/show", Int32, lambda message: threading.Thread(target=show, args=(message,), daemon=True).start()
    )
    clock = rospy.Publisher("/clock", Clock, queue_size=10)
    speed = [0.0]

    def simulate():
        now = 1000.0
        while True:
            clock.publish(Clock(rospy.Time.from_sec(now)))
            pause(0.01)
            now += 0.01 * speed[0]

    def run(message):
        if not speed[0]:
            threading.Thread(target=simulate, daemon=True).start()
        speed[0] = message.data or 1e-9

    rospy.Subscriber("/speed", Float32, run)
    cancelled = rospy.Publisher("/cancelled", String, latch=True, queue_size=10)

    def count(goal):
        if goal.goal < 0:
            server.set_aborted(TestResult())
            return
        for n in range(goal.goal):
            if server.is_preempt_requested():
                server.set_preempted()
                cancelled.publish("cancelled")
                return
            server.publish_feedback(TestFeedback(n))
            pause(0.01)
        server.set_succeeded(TestResult(goal.goal))

    server = actionlib.SimpleActionServer("/steps", TestAction, count, auto_start=False)
    server.start()
    print("ready", flush=True)
    sys.stdin.read()  # until the test ends


main()
