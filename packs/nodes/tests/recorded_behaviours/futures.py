"""Futures: states, callbacks, exceptions and cancelled tasks."""

import json

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.task import Future, Task


def state(future):
    return [future.done(), future.cancelled()]


def main():
    rclpy.init()
    node = rclpy.create_node("futures")
    future, cancelled, calls = Future(), Future(), []
    states = [state(future)]
    future.add_done_callback(lambda f: calls.append(f"first {f.result()}"))
    future.set_result(1)
    future.add_done_callback(lambda f: calls.append(f"late {f.result()}"))
    states.append(state(future))
    cancelled.cancel()
    states.append(state(cancelled))
    cancelled.set_result(2)
    states.append(state(cancelled))
    result = {"states": states, "callbacks": calls}
    removed, ignored = Future(), []
    removed.add_done_callback(ignored.append)
    result["removed"] = [removed.remove_done_callback(ignored.append) for _ in range(2)]
    removed.set_result(0)
    result["removed"].append(ignored)
    failed = Future()
    failed.set_exception(ValueError("no"))
    names = [type(failed.exception()).__name__]
    try:
        failed.result()
    except ValueError as error:
        names.append(type(error).__name__)
    result["exception"] = names
    good, bad = Task(lambda a, b: a + b, [1], {"b": 2}), Task(lambda: 1 / 0)
    good()
    bad()
    result["task"] = [good.result(), type(bad.exception()).__name__]
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    order = []

    async def forever():
        await Future()

    task = executor.create_task(forever)
    executor.spin_once(timeout_sec=0.1)
    task.cancel()
    result["cancelled_task"] = [task.cancelled(), task.done()]
    waiting = Future()
    timer = node.create_timer(0.1, lambda: (waiting.cancel(), timer.cancel()))
    executor.spin_until_future_complete(waiting, timeout_sec=5.0)
    result["cancelled_spin"] = "returned"
    executor.create_task(order.append, "a")
    executor.create_task(order.append, "b")
    for _ in range(2):
        executor.spin_once(timeout_sec=0.1)
    result["order"] = order
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
