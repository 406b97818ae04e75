"""One callback a `spin_once`: timers, subscriptions, guard conditions, clients and services, one message a round."""

import json
import time

import rclpy
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


def kinds():
    node = rclpy.create_node("order")
    calls = []
    service = node.create_service(Trigger, "work", lambda request, response: calls.append("service") or response)
    client = node.create_client(Trigger, "work")
    guard = node.create_guard_condition(lambda: calls.append("guard"))
    publisher = node.create_publisher(Int32, "number", 10)
    node.create_subscription(Int32, "number", lambda message: calls.append("subscription"), 10)
    timer = node.create_timer(0.2, lambda: (calls.append("timer"), timer.cancel()))
    client.wait_for_service(timeout_sec=5.0)
    while publisher.get_subscription_count() < 1:
        time.sleep(0.01)
    timer.reset()
    client.call_async(Trigger.Request()).add_done_callback(lambda future: calls.append("client"))
    publisher.publish(Int32(data=1))
    guard.trigger()
    time.sleep(0.5)
    lengths = []
    for _ in range(6):
        rclpy.spin_once(node, timeout_sec=0.3)
        lengths.append(len(calls))
    assert lengths[:4] == [1, 2, 3, 4], lengths
    assert service.srv_name == "work"
    node.destroy_node()
    return calls


def rounds():
    node = rclpy.create_node("rounds")
    calls = []
    publishers = [node.create_publisher(Int32, name, 10) for name in "ab"]
    node.create_subscription(Int32, "a", lambda message: calls.append(f"a{message.data}"), 10)
    node.create_subscription(Int32, "b", lambda message: calls.append(f"b{message.data}"), 10)
    while any(publisher.get_subscription_count() < 1 for publisher in publishers):
        time.sleep(0.01)
    for number in range(3):
        publishers[0].publish(Int32(data=number))
    for number in range(2):
        publishers[1].publish(Int32(data=number))
    time.sleep(0.3)
    while len(calls) < 5:
        rclpy.spin_once(node, timeout_sec=1.0)
    node.destroy_node()
    return calls


def main():
    rclpy.init()
    print(json.dumps({"kinds": kinds(), "rounds": rounds()}))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
