"""Destruction of a timer in its own callback, not by way of the node."""

import json
import time

import rclpy


def main():
    rclpy.init()
    node = rclpy.create_node("destroying")
    calls = []

    def call_once():
        calls.append("once")
        once.destroy()

    once = node.create_timer(0.05, call_once)
    node.create_timer(0.1, lambda: calls.append("always"))
    deadline = time.monotonic() + 5.0
    while len(calls) < 4 and time.monotonic() < deadline:
        rclpy.spin_once(node, timeout_sec=0.05)
    print(json.dumps({"calls": calls}))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
