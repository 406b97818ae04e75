"""QoS: late joiners, depths, incompatible profiles and their events, matched counts."""

import json
import time

import rclpy
from rclpy.event_handler import PublisherEventCallbacks, SubscriptionEventCallbacks
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy, qos_policy_name_from_kind
from std_msgs.msg import Int32, String


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def late_joiner(node, durability, depths):
    publisher = node.create_publisher(Int32, "late", QoSProfile(depth=3, durability=durability))
    for number in range(5):
        publisher.publish(Int32(data=number))
    time.sleep(0.2)
    results = []
    for depth in depths:
        received = []
        subscription = node.create_subscription(
            Int32, "late", lambda m, r=received: r.append(m.data), QoSProfile(depth=depth, durability=durability)
        )
        time.sleep(0.3)
        spin_for(node, 0.3)
        node.destroy_subscription(subscription)
        results.append(received)
    node.destroy_publisher(publisher)
    return results


def keep_last(node):
    received = []

    def callback(message):
        received.append(message.data)
        time.sleep(0.4)

    publisher = node.create_publisher(Int32, "fast", 10)
    subscription = node.create_subscription(Int32, "fast", callback, 2)
    while publisher.get_subscription_count() < 1:
        time.sleep(0.01)
    publisher.publish(Int32(data=0))
    rclpy.spin_once(node)
    for number in range(1, 10):
        publisher.publish(Int32(data=number))
    time.sleep(0.2)
    spin_for(node, 1.5)
    node.destroy_subscription(subscription)
    node.destroy_publisher(publisher)
    return received


def policy(node, offered, requested):
    events = {}
    received = []

    def note(side):
        return lambda event: events.__setitem__(
            side, [qos_policy_name_from_kind(event.last_policy_kind), event.total_count]
        )

    publisher = node.create_publisher(
        Int32, "policy", offered, event_callbacks=PublisherEventCallbacks(incompatible_qos=note("publisher"))
    )
    subscription = node.create_subscription(
        Int32,
        "policy",
        lambda message: received.append(message.data),
        requested,
        event_callbacks=SubscriptionEventCallbacks(incompatible_qos=note("subscription")),
    )
    time.sleep(0.3)
    publisher.publish(Int32(data=7))
    spin_for(node, 0.5)
    node.destroy_publisher(publisher)
    node.destroy_subscription(subscription)
    return [events.get("publisher"), events.get("subscription"), received]


def policies(node):
    best_effort = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    reliable = QoSProfile(depth=5)
    local = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    return {
        "reliability": policy(node, best_effort, reliable),
        "durability": policy(node, reliable, local),
        "both": policy(node, best_effort, local),
        "compatible": policy(node, reliable, best_effort),
    }


def matched(node):
    counts = []
    publisher = node.create_publisher(
        String,
        "matched",
        1,
        event_callbacks=PublisherEventCallbacks(
            matched=lambda event: counts.append([event.current_count, event.current_count_change])
        ),
    )
    subscription = node.create_subscription(String, "matched", lambda message: None, 1)
    spin_for(node, 0.3)
    node.destroy_subscription(subscription)
    spin_for(node, 0.3)
    node.destroy_publisher(publisher)
    return counts


def main():
    rclpy.init()
    node = rclpy.create_node("qos")
    result = {
        "volatile_late_joiner": late_joiner(node, DurabilityPolicy.VOLATILE, [5])[0],
        "transient_local_late_joiner": late_joiner(node, DurabilityPolicy.TRANSIENT_LOCAL, [2, 5]),
        "keep_last": keep_last(node),
        "policies": policies(node),
        "matched": matched(node),
    }
    print(json.dumps(result))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
