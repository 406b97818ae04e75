"""Publishers, subscriptions and nodes after their destruction, and calls after the shutdown."""

import json
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import Int32


def error_of(function):
    try:
        function()
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return "none"


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def main():
    rclpy.init()
    node = rclpy.create_node("one")
    received = []
    publisher = node.create_publisher(Int32, "number", 10)

    def on_message(message):
        received.append(message.data)
        node.destroy_subscription(subscription)

    subscription = node.create_subscription(Int32, "number", on_message, 10)
    counts = [publisher.get_subscription_count()]
    for number in range(3):
        publisher.publish(Int32(data=number))
    time.sleep(0.2)
    spin_for(node, 0.3)
    counts.append(publisher.get_subscription_count())
    result = {"in_callback": received, "counts": counts}
    result["wrong_type"] = error_of(lambda: publisher.publish("text")).split(":")[0]
    result["destroy"] = [node.destroy_publisher(publisher), node.destroy_publisher(publisher)]
    result["publish"] = error_of(lambda: publisher.publish(Int32()))
    executor = SingleThreadedExecutor()
    names = [sorted(n.get_name() for n in executor.get_nodes())]
    other = rclpy.create_node("two")
    executor.add_node(node)
    executor.add_node(other)
    names.append(sorted(n.get_name() for n in executor.get_nodes()))
    executor.remove_node(node)
    names.append(sorted(n.get_name() for n in executor.get_nodes()))
    result["nodes"] = names
    node.destroy_node()
    result["node"] = error_of(node.get_name)
    result["log"] = node.get_logger().info("after the end of the node")
    result["twice"] = error_of(node.destroy_node)
    late = other.create_publisher(Int32, "late", 1)
    rclpy.shutdown()
    result["after_shutdown"] = [
        error_of(lambda: late.publish(Int32())).split(":")[0],
        error_of(lambda: rclpy.create_node("three")),
    ]
    result["shutdown_twice"] = error_of(rclpy.shutdown)
    result["try_shutdown"] = error_of(rclpy.try_shutdown)
    print(json.dumps(result))


if __name__ == "__main__":
    main()
