"""`spin_once(timeout_sec=0)`: every second call ends the round of the call before it, and does nothing."""

import json
import time

import rclpy
from std_msgs.msg import Int32


def main():
    rclpy.init()
    node = rclpy.create_node("no_wait")
    received = []
    publisher = node.create_publisher(Int32, "number", 10)
    node.create_subscription(Int32, "number", lambda message: received.append(message.data), 10)
    while publisher.get_subscription_count() < 1:
        time.sleep(0.01)
    for number in range(3):
        publisher.publish(Int32(data=number))
    time.sleep(0.3)
    counts = []
    for _ in range(8):
        rclpy.spin_once(node, timeout_sec=0)
        counts.append(len(received))
    begun = time.monotonic()
    while time.monotonic() < begun + 0.2:
        rclpy.spin_once(node, timeout_sec=0)
    print(json.dumps({"counts": counts, "busy_loop": received == [0, 1, 2]}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
