"""Timers: the first call after one period, one after a stall, then the old grid; cancel, reset, autostart."""

import json
import time

import rclpy


def stall(node):
    times = []
    begun = time.monotonic()

    def call():
        times.append(round((time.monotonic() - begun) / 0.2) * 0.2)
        if len(times) == 2:
            time.sleep(1.4)

    timer = node.create_timer(0.4, call)
    while len(times) < 5:
        rclpy.spin_once(node)
    node.destroy_timer(timer)
    return [round(t, 1) for t in times]


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def main():
    rclpy.init()
    node = rclpy.create_node("timers")
    result = {"stall": stall(node)}
    begun = time.monotonic()
    times = []
    timer = node.create_timer(0.4, lambda: times.append(round(time.monotonic() - begun, 1)))
    states = [timer.is_canceled()]
    spin_for(node, 0.6)
    timer.cancel()
    states.append(timer.is_canceled())
    spin_for(node, 0.6)
    result["after_cancel"] = list(times)
    begun = time.monotonic()
    times.clear()
    timer.reset()
    states.append(timer.is_canceled())
    spin_for(node, 0.6)
    result["after_reset"] = list(times)
    result["is_canceled"] = states
    node.destroy_timer(timer)
    calls = []
    node.create_timer(0.1, lambda: calls.append(1), autostart=False)
    once = node.create_timer(0.1, lambda: (calls.append(2), node.destroy_timer(once)))
    spin_for(node, 0.5)
    result["without_autostart"] = calls.count(1)
    result["in_callback"] = calls.count(2)
    print(json.dumps(result))
    node.destroy_node()
    rclpy.shutdown()


if __name__ == "__main__":
    main()
