"""Destruction of an object that is destroyed already, and of the node that has it."""

import json

import rclpy
from rclpy.exceptions import InvalidHandle
from std_msgs.msg import String
from std_srvs.srv import Trigger


def main():
    rclpy.init()
    node = rclpy.create_node("destroyed")
    objects = {
        "subscription": node.create_subscription(String, "talk", print, 1),
        "publisher": node.create_publisher(String, "talk", 1),
        "client": node.create_client(Trigger, "call"),
        "service": node.create_service(Trigger, "answer", lambda request, response: response),
        "timer": node.create_timer(1.0, print),
    }
    uses = {
        "publisher": lambda: objects["publisher"].publish(String()),
        "client": lambda: objects["client"].call_async(Trigger.Request()),
        "timer": lambda: objects["timer"].reset(),
    }
    results = {}
    for name, item in objects.items():
        item.destroy()
        item.destroy()
        try:
            uses.get(name, bool)()
            results[name] = "nothing"
        except InvalidHandle:
            results[name] = "InvalidHandle"
    node.destroy_node()
    node.destroy_node()
    results["node"] = "nothing"
    rclpy.shutdown()
    print(json.dumps(results))


if __name__ == "__main__":
    main()
