"""Deadlines and lifespans of messages, and exceptions in an executor with several threads."""

import json
import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import QoSProfile
from std_msgs.msg import Int32


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def deadline(publishes):
    node = rclpy.create_node("deadline")
    offered, requested = [], []
    qos = QoSProfile(depth=5, deadline=Duration(seconds=0.4))
    publisher = node.create_publisher(
        Int32,
        "limit",
        qos,
        event_callbacks=PublisherEventCallbacks(deadline=lambda event: offered.append(event.total_count)),
    )
    node.create_subscription(
        Int32,
        "limit",
        lambda message: None,
        qos,
        event_callbacks=SubscriptionEventCallbacks(deadline=lambda event: requested.append(event.total_count)),
    )
    spin_for(node, 0.2)
    if publishes:
        publisher.publish(Int32())
    spin_for(node, 1.4)
    node.destroy_node()
    return [offered, requested]


def lifespan(is_of_subscription):
    node = rclpy.create_node("lifespan")
    received = []
    qos = QoSProfile(depth=5, lifespan=Duration(seconds=0.5))
    publisher = node.create_publisher(Int32, "short", qos)
    node.create_subscription(
        Int32, "short", lambda message: received.append(message.data), qos if is_of_subscription else 5
    )
    time.sleep(0.1)
    publisher.publish(Int32(data=1))
    time.sleep(1.0)
    publisher.publish(Int32(data=2))
    publisher.publish(Int32(data=3))
    spin_for(node, 0.2)
    node.destroy_node()
    return received


def exception():
    node = rclpy.create_node("exception")
    group = ReentrantCallbackGroup()

    def fail():
        timer.cancel()
        raise KeyError("wrong")

    timer = node.create_timer(0.2, fail, callback_group=group)
    node.create_timer(0.3, lambda: None, callback_group=group)
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    try:
        executor.spin()
    except KeyError as error:
        return type(error).__name__
    return "none"


def main():
    rclpy.init()
    result = {
        "never_published": deadline(publishes=False),
        "published_once": deadline(publishes=True),
        "lifespan": [lifespan(is_of_subscription=False), lifespan(is_of_subscription=True)],
        "exception": exception(),
    }
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
