"""The peer of the ROS 2 tests: a real node. The tests run it with the Python that has rclpy."""

import sys
import threading

import rclpy
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rclpy.task import Future
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image
from std_msgs.msg import Float32, Int32, String
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci


def pause(seconds):
    threading.Event().wait(seconds)


def main():
    rclpy.init()
    node = rclpy.create_node("peer", start_parameter_services=False)
    group = ReentrantCallbackGroup()
    deep = QoSProfile(depth=2000)
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    quick = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    back = node.create_publisher(String, "/back", deep)
    numbers = node.create_publisher(Int32, "/numbers", deep)
    images = node.create_publisher(Image, "/images", QoSProfile(depth=5))
    wrong = node.create_publisher(Float32, "/wrong", latched)
    wrong.publish(Float32(data=1.5))
    sensor = node.create_publisher(Int32, "/sensor", quick)
    cancelled = node.create_publisher(String, "/cancelled", latched)

    def burst(message):
        first, count, rate = map(int, message.data.split())
        for n in range(first, first + count):
            numbers.publish(Int32(data=n))
            if rate:
                pause(1 / rate)

    def show(message):
        picture = Image(height=480, width=640, encoding="rgb8", step=1920, data=bytes(640 * 480 * 3))
        for _ in range(message.data):
            images.publish(picture)
            pause(1 / 30)

    def lamp(request, response):
        response.success, response.message = request.data, "on" if request.data else "off"
        return response

    async def silent(request, response):
        await Future()  # this service never answers, and occupies no thread
        return response

    def count(goal):
        feedback, sequence = Fibonacci.Feedback(), [0, 1]
        while len(sequence) < goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled()
                cancelled.publish(String(data="cancelled"))
                return Fibonacci.Result()
            sequence.append(sequence[-1] + sequence[-2])
            feedback.sequence = sequence[-5:]
            feedback.sequence = [min(n, 2**30) for n in feedback.sequence]
            goal.publish_feedback(feedback)
            pause(0.01 if goal.request.order < 100 else 0.05)
        goal.succeed()
        result = Fibonacci.Result()
        result.sequence = sequence
        return result

    node.create_subscription(String, "/chat", lambda message: back.publish(String(data="echo " + message.data)), deep)
    node.create_subscription(
        String, "/burst", lambda message: threading.Thread(target=burst, args=(message,), daemon=True).start(), 10
    )
    node.create_subscription(
        Int32, "/show", lambda message: threading.Thread(target=show, args=(message,), daemon=True).start(), 10
    )
    node.create_service(SetBool, "/lamp", lamp, callback_group=group)
    node.create_service(SetBool, "/silent", silent, callback_group=group)
    ActionServer(
        node, Fibonacci, "/count", count, callback_group=group, cancel_callback=lambda goal: CancelResponse.ACCEPT
    )

    clock = node.create_publisher(Clock, "/clock", quick)
    speed = [0.0]

    def simulate():
        now, message = 1000.0, Clock()
        while True:
            message.clock.sec, message.clock.nanosec = int(now), int(now % 1 * 1e9)
            clock.publish(message)
            pause(0.01)
            now += 0.01 * speed[0]

    def run(message):
        if not speed[0]:
            threading.Thread(target=simulate, daemon=True).start()
        speed[0] = message.data or 1e-9

    node.create_subscription(Float32, "/speed", run, 10)

    def tick():
        sensor.publish(Int32(data=3))

    node.create_timer(0.1, tick)
    executor = MultiThreadedExecutor(4)
    executor.add_node(node)
    threading.Thread(target=executor.spin, daemon=True).start()
    print("ready", flush=True)
    sys.stdin.read()  # until the test ends
    import os

    os._exit(0)


main()
