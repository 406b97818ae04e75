"""Calls of services: futures, blocking calls, several clients, timeouts and errors."""

import json
import threading

import rclpy
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from std_srvs.srv import SetBool, Trigger


def error_of(function, *arguments, **keywords):
    try:
        return repr(function(*arguments, **keywords))
    except Exception as error:
        return f"{type(error).__name__}: {error}"


def answering(node, name="work"):
    def answer(request, response):
        response.success = True
        response.message = f"{name} {request.data}"
        return response

    return node.create_service(SetBool, name, answer)


def futures():
    node = rclpy.create_node("futures")
    answering(node)
    client = node.create_client(SetBool, "work")
    unused = node.create_client(Trigger, "no_such_service")
    found = {"at once": client.service_is_ready(), "no service": unused.wait_for_service(timeout_sec=0.6)}
    found["ready"] = client.wait_for_service(timeout_sec=5.0)
    calls = []
    future = client.call_async(SetBool.Request(data=True))
    future.add_done_callback(lambda done: calls.append(done.result().message))
    found["done"] = [future.done(), future.result()]
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    found["done"] += [future.done(), future.result().message, calls]
    late = unused.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, late, timeout_sec=0.5)
    found["timeout"] = [late.done(), late.result()]
    found["pending"] = [error_of(client.get_pending_request, 99), unused.remove_pending_request(late)]
    found["wrong request"] = [error_of(client.call_async, SetBool.Response()), error_of(client.call, None)]
    found["names"] = [client.srv_name, client.service_name, client.srv_type.__name__]
    found["destroyed"] = [node.destroy_client(unused), node.destroy_client(unused), error_of(unused.service_is_ready)]
    found["invalid names"] = [error_of(node.create_client, SetBool, name) for name in ("a b", "1a", "a/", "")]
    node.destroy_node()
    return found


def two_clients():
    node, other = rclpy.create_node("first"), rclpy.create_node("second")
    answering(node)
    clients = [node.create_client(SetBool, "work"), other.create_client(SetBool, "work")]
    executor = SingleThreadedExecutor()
    for each in (node, other):
        executor.add_node(each)
    for client in clients:
        client.wait_for_service(timeout_sec=5.0)
    pending = [client.call_async(SetBool.Request(data=flag)) for client, flag in zip(clients, (True, False))]
    for future in pending:
        executor.spin_until_future_complete(future, timeout_sec=5.0)
    found = [future.result().message for future in pending]
    for each in (node, other):
        each.destroy_node()
    return found


def blocking():
    """Call in a callback: with a group of its own and several threads it works, else the time runs out."""
    found = {}
    for name, make_group, make_executor in (
        ("other group", ReentrantCallbackGroup, lambda: MultiThreadedExecutor(4)),
        ("same group", None, lambda: MultiThreadedExecutor(4)),
        ("single thread", MutuallyExclusiveCallbackGroup, SingleThreadedExecutor),
    ):
        node = rclpy.create_node("blocking")
        answering(node)
        client = node.create_client(SetBool, "work", callback_group=make_group() if make_group else None)
        client.wait_for_service(timeout_sec=5.0)
        results = []

        def call():
            timer.cancel()
            response = client.call(SetBool.Request(data=True), timeout_sec=0.5)
            results.append(response and response.message)

        timer = node.create_timer(0.1, call, callback_group=MutuallyExclusiveCallbackGroup() if make_group else None)
        executor = make_executor()
        executor.add_node(node)
        while not results:
            executor.spin_once(timeout_sec=1.0)
        found[name] = results
        executor.shutdown()
        node.destroy_node()
    return found


def beside_a_thread():
    node = rclpy.create_node("beside")
    answering(node)
    client = node.create_client(SetBool, "work")
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    client.wait_for_service(timeout_sec=5.0)
    found = [client.call(SetBool.Request(data=flag)).message for flag in (True, False)]
    executor.shutdown()
    executor.wake()
    thread.join()
    node.destroy_node()
    return found


def coroutine():
    node = rclpy.create_node("coroutine")
    answering(node, "inner")
    inner = node.create_client(SetBool, "inner", callback_group=ReentrantCallbackGroup())

    async def outer(request, response):
        answer = await inner.call_async(SetBool.Request(data=True))
        response.message = f"outer of {answer.message}"
        return response

    node.create_service(Trigger, "outer", outer, callback_group=ReentrantCallbackGroup())
    client = node.create_client(Trigger, "outer", callback_group=ReentrantCallbackGroup())
    inner.wait_for_service(timeout_sec=5.0)
    client.wait_for_service(timeout_sec=5.0)
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=5.0)
    message = future.result().message
    node.destroy_node()
    return message


def errors():
    found = {}
    for name, answer in (("raises", lambda request, response: 1 / 0), ("nothing", lambda request, response: None)):
        node = rclpy.create_node("errors")
        node.create_service(Trigger, "work", answer)
        client = node.create_client(Trigger, "work")
        client.wait_for_service(timeout_sec=5.0)
        future = client.call_async(Trigger.Request())
        found[name] = error_of(rclpy.spin_until_future_complete, node, future, timeout_sec=2.0)
        node.destroy_node()
    return found


def callback_that_raises():
    node = rclpy.create_node("raising")
    answering(node)
    client = node.create_client(SetBool, "work")
    client.wait_for_service(timeout_sec=5.0)
    future = client.call_async(SetBool.Request(data=True))
    future.add_done_callback(lambda done: [].pop())

    def spin():
        for _ in range(10):
            rclpy.spin_once(node, timeout_sec=0.2)

    found = error_of(spin)
    node.destroy_node()
    return found


def main():
    rclpy.init()
    functions = (futures, two_clients, blocking, beside_a_thread, coroutine, errors, callback_that_raises)
    print(json.dumps({function.__name__: function() for function in functions}, indent=1))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
