"""Coroutines as callbacks, futures, tasks of an executor, and `spin_until_future_complete`."""

import json
import time

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.task import Future
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


def spin_for(node, seconds):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


def await_future(node):
    calls = []
    future = Future()

    async def on_message(message):
        calls.append("begin")
        calls.append(f"end {await future}")

    def on_timer():
        calls.append("timer")
        future.set_result(5)
        timer.cancel()

    publisher = node.create_publisher(Int32, "start", 1)
    node.create_subscription(Int32, "start", on_message, 1, callback_group=ReentrantCallbackGroup())
    while publisher.get_subscription_count() < 1:
        time.sleep(0.01)
    publisher.publish(Int32())
    time.sleep(0.1)
    timer = node.create_timer(0.3, on_timer)
    spin_for(node, 0.8)
    return calls


def await_in_exclusive_group(node):
    calls = []
    future = Future()

    async def on_timer():
        calls.append("begin")
        first.cancel()
        calls.append(f"end {await future}")

    first = node.create_timer(0.2, on_timer)
    second = node.create_timer(0.4, lambda: future.set_result(5))
    spin_for(node, 1.2)
    results = list(calls)
    node.destroy_timer(second)
    future.set_result(6)
    spin_for(node, 0.2)
    return results


def await_service(node):
    results = []
    node.create_service(Trigger, "answer", lambda request, response: setattr(response, "success", True) or response)
    client = node.create_client(Trigger, "answer")
    client.wait_for_service()

    async def ask():
        timer.cancel()
        response = await client.call_async(Trigger.Request())
        results.extend([response.success, "awaited"])

    timer = node.create_timer(0.1, ask, callback_group=ReentrantCallbackGroup())
    spin_for(node, 0.8)
    return results


def tasks(node):
    calls = []
    executor = SingleThreadedExecutor()
    executor.add_node(node)

    async def double(value):
        calls.append(f"coroutine {2 * value}")
        return 2 * value

    task = executor.create_task(double, 2)
    task.add_done_callback(lambda future: calls.append(f"done {future.result()}"))
    executor.create_task(lambda value: calls.append(f"task {value}"), 3)
    for _ in range(5):
        executor.spin_once(timeout_sec=0.1)
    executor.remove_node(node)
    executor.shutdown()
    return sorted(calls, key=["task 3", "done 4", "coroutine 4"].index)


def timeout(node):
    future = Future()
    rclpy.spin_until_future_complete(node, future, timeout_sec=0.2)
    results = [future.done()]
    timer = node.create_timer(0.1, lambda: (future.set_result(1), timer.cancel()))
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    return [*results, future.done()]


def exception(node):
    def fail():
        timer.cancel()
        raise KeyError("wrong")

    timer = node.create_timer(0.1, fail)
    try:
        rclpy.spin(node)
    except KeyError as error:
        return f"{type(error).__name__}: {error}"
    return "no exception"


def end(node):
    node.create_timer(0.1, rclpy.shutdown)
    rclpy.spin(node)
    return ["spin returned", f"ok {rclpy.ok()}"]


def external():
    import threading

    rclpy.init()
    node = rclpy.create_node("external")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    caught = []

    def spin():
        try:
            executor.spin()
        except ExternalShutdownException as error:
            caught.append(type(error).__name__)

    thread = threading.Thread(target=spin)
    thread.start()
    time.sleep(0.3)
    rclpy.shutdown()
    thread.join()
    return caught[0]


def on_new_node(function):
    node = rclpy.create_node(function.__name__)
    result = function(node)
    if rclpy.ok():
        node.destroy_node()
    return result


def main():
    rclpy.init()
    result = {
        "await": on_new_node(await_future),
        "await_in_exclusive_group": on_new_node(await_in_exclusive_group),
        "service": on_new_node(await_service),
        "task": on_new_node(tasks),
        "timeout": on_new_node(timeout),
        "exception": on_new_node(exception),
        "ended": on_new_node(end),
        "external": external(),
    }
    print(json.dumps(result))


if __name__ == "__main__":
    main()
