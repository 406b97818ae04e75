"""Spins inside callbacks, several executors, contexts and nodes, and callbacks of all kinds."""

import functools
import json
import threading
import time

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.context import Context
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


def nested(group):
    node = rclpy.create_node("nested")
    calls = []
    node.create_service(Trigger, "work", lambda request, response: response, callback_group=ReentrantCallbackGroup())
    client = node.create_client(Trigger, "work", callback_group=group)
    client.wait_for_service()

    def on_timer():
        timer.cancel()
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        calls.extend([future.done(), "after"])

    timer = node.create_timer(0.1, on_timer, callback_group=group)
    end = time.monotonic() + 1.5
    while time.monotonic() < end and not calls:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    return calls


def created_in_callback():
    node = rclpy.create_node("creator")
    calls = []

    def first():
        calls.append("first")
        timer.cancel()
        node.create_timer(0.1, lambda: calls.append("second"))

    timer = node.create_timer(0.1, first)
    while len(calls) < 3:
        rclpy.spin_once(node, timeout_sec=0.1)
    node.destroy_node()
    return calls


class Listener(Node):
    def __init__(self, calls):
        super().__init__("listener")
        self.calls = calls
        self.create_subscription(Int32, "kind", self.on_message, 1)

    def on_message(self, message):
        self.calls.append(f"method {message.data}")


class CallableObject:
    def __init__(self, calls):
        self.calls = calls

    def __call__(self, message):
        self.calls.append(f"object {message.data}")


def kinds_of_callbacks():
    calls = []
    node = Listener(calls)
    node.create_subscription(
        Int32, "kind", functools.partial(lambda calls, m: calls.append(f"partial {m.data}"), calls), 1
    )
    node.create_subscription(Int32, "kind", CallableObject(calls), 1)
    node.create_subscription(Int32, "kind", lambda m, calls=calls: calls.append(f"lambda {getattr(m, 'data', m)}"), 1)
    publisher = node.create_publisher(Int32, "kind", 1)
    publisher.publish(Int32(data=1))
    time.sleep(0.2)
    for _ in range(4):
        rclpy.spin_once(node, timeout_sec=1.0)
    node.destroy_node()
    return calls


def two_executors():
    counts = [0, 0]
    threads = []

    def spin(index):
        node = rclpy.create_node(f"executor_{index}")
        executor = SingleThreadedExecutor()
        executor.add_node(node)

        def count():
            counts[index] += 1

        node.create_timer(0.1, count)
        while counts[index] < 3:
            executor.spin_once(timeout_sec=1.0)

    for index in range(2):
        threads.append(threading.Thread(target=spin, args=(index,)))
        threads[-1].start()
    for thread in threads:
        thread.join()
    return counts


def contexts():
    context = Context()
    rclpy.init(context=context)
    results = [rclpy.ok(), rclpy.ok(context=context)]
    node = rclpy.create_node("own_context", context=context)
    executor = SingleThreadedExecutor(context=context)
    executor.add_node(node)
    calls = []
    node.create_timer(0.1, lambda: calls.append(1))
    while len(calls) < 2:
        executor.spin_once(timeout_sec=1.0)
    rclpy.shutdown(context=context)
    return [*results, rclpy.ok(context=context), rclpy.ok(), len(calls)]


def await_in_threads():
    node = rclpy.create_node("awaiter")
    calls = []
    group = ReentrantCallbackGroup()

    def answer(request, response):
        time.sleep(0.3)
        response.success = True
        return response

    node.create_service(Trigger, "slow", answer, callback_group=group)
    client = node.create_client(Trigger, "slow", callback_group=group)
    client.wait_for_service()

    async def ask():
        if calls.count("begin") == 2:
            return
        calls.append("begin")
        response = await client.call_async(Trigger.Request())
        calls.append(f"end {response.success}")

    node.create_timer(0.1, ask, callback_group=group)
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    while len(calls) < 4:
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()
    node.destroy_node()
    return calls


def raise_in_subscription():
    node = rclpy.create_node("raiser")
    calls = []

    def on_message(message):
        calls.append(message.data)
        raise RuntimeError("wrong")

    node.create_subscription(Int32, "raise", on_message, 1)
    node.create_publisher(Int32, "raise", 1).publish(Int32(data=1))
    name = "none"
    try:
        rclpy.spin(node)
    except RuntimeError as error:
        name = type(error).__name__
    node.destroy_node()
    return [name, calls[0]]


def second_init():
    counts = []
    for _ in range(2):
        rclpy.shutdown()
        rclpy.init()
        node = rclpy.create_node("again")
        calls = []
        node.create_timer(0.1, lambda calls=calls: calls.append(1))
        rclpy.spin_once(node, timeout_sec=2.0)
        counts.append(len(calls))
    return counts


def main():
    rclpy.init()
    result = {
        "nested": nested(ReentrantCallbackGroup()),
        "nested_in_exclusive_group": nested(MutuallyExclusiveCallbackGroup()),
        "created_in_callback": created_in_callback(),
        "kinds_of_callbacks": kinds_of_callbacks(),
        "two_executors": two_executors(),
        "contexts": contexts(),
        "await_in_threads": await_in_threads(),
        "raise_in_subscription": raise_in_subscription(),
        "second_init": second_init(),
    }
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
