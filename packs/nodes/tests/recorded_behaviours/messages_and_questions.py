"""Bytes instead of messages, what is known about a message, `wait_for_message`, and questions about the graph."""

import json
import threading
import time

import rclpy
from rclpy.qos import QoSProfile, ReliabilityPolicy
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.wait_for_message import wait_for_message
from std_msgs.msg import Int32, String


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def main():
    rclpy.init()
    node = rclpy.create_node("question", namespace="ask")
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    publisher = node.create_publisher(Int32, "number", best_effort)
    raw, numbers, infos = [], [], []
    first = node.create_subscription(Int32, "number", raw.append, best_effort, raw=True)
    second = node.create_subscription(
        Int32, "number", lambda message, info: (numbers.append(message.data), infos.append(info)), best_effort
    )
    result = {"count": [node.count_publishers("number"), node.count_subscribers("number"), node.count_publishers("x")]}
    publisher.publish(Int32(data=7))
    publisher.publish(serialize_message(Int32(data=8)))
    time.sleep(0.2)
    spin_for(node, 0.3)
    result["raw"] = [type(raw[0]).__name__, deserialize_message(raw[0], Int32).data]
    result["bytes"] = numbers[1]
    last = infos[1]
    result["info"] = [sorted(last), last["publication_sequence_number"], last["reception_sequence_number"]]
    node.create_subscription(String, "text", lambda message: None, 1)
    names = node.get_topic_names_and_types()
    result["types"] = [[name, types] for name, types in names if name.startswith("/ask/")]
    result["nodes"] = [list(pair) for pair in node.get_node_names_and_namespaces() if pair[0] == "question"]
    result["publishers"] = [
        [
            info.node_name,
            info.node_namespace,
            info.topic_type,
            info.endpoint_type.name,
            info.qos_profile.reliability.name,
            info.qos_profile.durability.name,
            info.qos_profile.history.name,
            len(info.endpoint_gid),
        ]
        for info in node.get_publishers_info_by_topic("number")
    ]
    topics = node.get_publisher_names_and_types_by_node("question", "/ask")
    result["by_node"] = [[name, types] for name, types in topics if name.startswith("/ask/")]
    try:
        node.get_publisher_names_and_types_by_node("nobody", "/ask")
    except Exception as error:
        result["no_node"] = type(error).__name__
    node.destroy_subscription(first)
    node.destroy_subscription(second)
    reliable = node.create_publisher(Int32, "wait", 1)

    def publish_later():
        while reliable.get_subscription_count() < 1:
            time.sleep(0.05)
        reliable.publish(Int32(data=5))

    thread = threading.Thread(target=publish_later)
    thread.start()
    has_come, message = wait_for_message(Int32, node, "wait", time_to_wait=5.0)
    thread.join()
    result["wait"] = [[has_come, message.data], list(wait_for_message(Int32, node, "wait", time_to_wait=0.2))]
    calls = []
    guard = node.create_guard_condition(lambda: calls.append("triggered"))
    threading.Timer(0.2, guard.trigger).start()
    rclpy.spin_once(node, timeout_sec=5.0)
    result["guard"] = calls
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
