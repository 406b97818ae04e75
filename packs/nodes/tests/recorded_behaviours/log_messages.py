"""Log messages: levels, children, `once`, `skip_first`, throttling, and `/rosout`."""

import json
import time

import rclpy
from rcl_interfaces.msg import Log
from rclpy.logging import LoggingSeverity, get_logger, set_logger_level
from rclpy.qos import DurabilityPolicy, QoSProfile


def error_of(function):
    try:
        function()
    except Exception as error:
        return type(error).__name__
    return "none"


def main():
    rclpy.init()
    node = rclpy.create_node("logs", namespace="a")
    logger = node.get_logger()
    result = {
        "once": [logger.info("once", once=True) for _ in range(3)],
        "skip_first": [logger.info("skip", skip_first=True) for _ in range(3)],
    }
    throttle = []
    for pause in (0.1, 0.6, 0.0):
        throttle.append(logger.info("throttle", throttle_duration_sec=0.5))
        time.sleep(pause)
    result["throttle"] = throttle
    child = logger.get_child("child")
    levels = [logger.debug("no"), logger.warning("yes"), logger.warn("yes")]
    effective = [logger.get_effective_level().name]
    logger.set_level(LoggingSeverity.ERROR)
    effective += [logger.get_effective_level().name, child.get_effective_level().name]
    levels.append(child.warning("no"))
    set_logger_level("a.logs.child", LoggingSeverity.DEBUG)
    levels.append(child.debug("yes"))
    effective.append(child.get_effective_level().name)
    result["levels"], result["effective"] = levels, effective
    result["names"] = [logger.name, child.name, get_logger("free").name]
    logger.set_level(LoggingSeverity.INFO)

    def change_level():
        for severity in (LoggingSeverity.INFO, LoggingSeverity.WARN):
            logger.log("text", severity)

    result["errors"] = [
        error_of(lambda: logger.info("x", wrong=True)),
        error_of(change_level),
        error_of(lambda: get_logger("")),
        error_of(lambda: logger.error(RuntimeError("no text"))),
        error_of(lambda: logger.info(3)),
        error_of(lambda: logger.debug(3)),
    ]
    logger.set_level(LoggingSeverity.WARN)
    logger.warning("one")
    child.error("two")
    received = []
    qos = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    node.create_subscription(Log, "/rosout", received.append, qos)
    end = time.monotonic() + 1.0
    while time.monotonic() < end:
        rclpy.spin_once(node, timeout_sec=0.1)
    chosen = [message for message in received if message.msg in ("one", "two")]
    result["rosout"] = [[message.name, message.level, message.msg] for message in chosen]
    result["function"] = sorted({message.function for message in chosen})
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
