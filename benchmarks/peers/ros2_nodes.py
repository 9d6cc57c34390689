"""Bare nodes of ROS 2 (rclpy): an echo, a node that talks with it (the floor), and a source of numbers and images."""

import itertools
import threading
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from sensor_msgs.msg import Image
from std_msgs.msg import Int32, String
from wire import serve

Seconds = float
WIDTH, HEIGHT = 640, 480
DEEP = QoSProfile(depth=1000)
node = executor = None


def start(name: str) -> None:
    """Start a node in this process."""
    global node, executor
    rclpy.init(args=[])
    node = rclpy.create_node(name, start_parameter_services=False)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()


def echo() -> None:
    """Send each text of /chat back on /back."""
    back = node.create_publisher(String, "/back", DEEP)
    node.create_subscription(String, "/chat", back.publish, DEEP)
    executor.wake()


def talk(count: int) -> list[Seconds]:
    """Send a text to the echo, and the next text when the first is back; return the seconds of each round."""
    times, done = [], threading.Event()
    chat = node.create_publisher(String, "/chat", DEEP)

    def again(message):
        times.append(time.perf_counter())
        if len(times) > count:
            done.set()
        else:
            chat.publish(String(data="text"))

    back = node.create_subscription(String, "/back", again, DEEP)
    executor.wake()
    while not (chat.get_subscription_count() and node.count_publishers("/back")):
        time.sleep(0.05)
    time.sleep(0.5)
    chat.publish(String(data="text"))
    assert done.wait(120)
    node.destroy_subscription(back)
    node.destroy_publisher(chat)
    return [after - before for before, after in itertools.pairwise(times)]


def numbers(count: int, rate: float) -> None:
    """When there is a subscriber, begin to publish `count` numbers on /numbers, `rate` a second."""
    _pace(node.create_publisher(Int32, "/numbers", DEEP), count, rate, lambda number: Int32(data=number))


def images(count: int, rate: float) -> None:
    """When there is a subscriber, begin to publish `count` images on /images, `rate` a second."""
    image = Image(height=HEIGHT, width=WIDTH, encoding="rgb8", step=3 * WIDTH, data=bytes(3 * WIDTH * HEIGHT))
    _pace(node.create_publisher(Image, "/images", QoSProfile(depth=100)), count, rate, lambda number: image)


def _pace(publisher, count, rate, make):
    def run():
        while not publisher.get_subscription_count():
            time.sleep(0.05)
        time.sleep(0.5)
        begin = time.perf_counter()
        for number in range(count):
            time.sleep(max(0.0, begin + number / rate - time.perf_counter()))
            publisher.publish(make(number))

    threading.Thread(target=run, daemon=True).start()


if __name__ == "__main__":
    serve(start, echo, talk, numbers, images)
