"""Threads of an executor: callback groups, blocking calls in callbacks, and a rate beside a thread that spins."""

import contextlib
import json
import threading
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from std_srvs.srv import Trigger


def run(groups):
    rclpy.init()
    node = rclpy.create_node("groups")
    calls = []

    def callback(name, timer_of):
        def call():
            timer_of[name].cancel()
            calls.append(f"{name} begins")
            time.sleep(0.4)
            calls.append(f"{name} ends")
            if len(calls) == 4:
                rclpy.shutdown()

        return call

    timers = {}
    for index, (name, group) in enumerate(zip("ab", groups, strict=True)):
        timers[name] = node.create_timer(0.2 + 0.1 * index, callback(name, timers), callback_group=group)
    executor = MultiThreadedExecutor(num_threads=3)
    executor.add_node(node)
    executor.spin()
    time.sleep(0.1)
    return calls


def reentrant():
    rclpy.init()
    node = rclpy.create_node("reentrant")
    running, most = [], []

    def call():
        running.append(1)
        most.append(len(running))
        time.sleep(0.35)
        running.pop()
        if len(most) >= 3:
            rclpy.try_shutdown()

    node.create_timer(0.2, call, callback_group=ReentrantCallbackGroup())
    executor = MultiThreadedExecutor(num_threads=2)
    executor.add_node(node)
    executor.spin()
    time.sleep(0.5)
    return max(most)


def call_in_callback():
    rclpy.init()
    node = rclpy.create_node("caller")
    results = []
    client = node.create_client(Trigger, "answer", callback_group=MutuallyExclusiveCallbackGroup())

    def answer(request, response):
        response.success, response.message = True, "answered"
        return response

    def ask():
        timer.cancel()
        response = client.call(Trigger.Request())
        results.extend([response.success, response.message])
        rclpy.shutdown()

    node.create_service(Trigger, "answer", answer, callback_group=MutuallyExclusiveCallbackGroup())
    client.wait_for_service()
    timer = node.create_timer(0.1, ask)
    executor = MultiThreadedExecutor(num_threads=4)
    rclpy.spin(node, executor)
    time.sleep(0.1)
    return results


def rate():
    rclpy.init()
    node = rclpy.create_node("rate")
    thread = threading.Thread(target=spin_quietly, args=(node,), daemon=True)
    thread.start()
    sleeps = node.create_rate(10)
    begun = time.monotonic()
    for _ in range(3):
        sleeps.sleep()
    count = round((time.monotonic() - begun) / 0.1)
    rclpy.shutdown()
    thread.join()
    return count


def spin_quietly(node):
    with contextlib.suppress(ExternalShutdownException):
        rclpy.spin(node)


def main():
    group = MutuallyExclusiveCallbackGroup()
    result = {
        "exclusive": run([group, group]),
        "two_groups": run([MutuallyExclusiveCallbackGroup(), MutuallyExclusiveCallbackGroup()]),
        "reentrant": reentrant(),
        "call_in_callback": call_in_callback(),
        "rate": rate(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
