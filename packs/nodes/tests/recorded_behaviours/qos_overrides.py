"""Parameters that replace policies of the quality of service."""

import json

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSPolicyKind, QoSProfile
from rclpy.qos_overriding_options import QosCallbackResult, QoSOverridingOptions
from std_msgs.msg import String


def error_of(function):
    try:
        function()
    except Exception as error:
        return f"{type(error).__name__}|{error}"
    return "none"


def policies(profile):
    return [profile.depth, profile.reliability.name, profile.durability.name, profile.lifespan.nanoseconds]


def main():
    values = ["publisher.depth:=5", "publisher.reliability:=best_effort", "subscription_second.durability:=loud"]
    rules = [word for value in values for word in ("-p", f"qos_overrides./a/chat.{value}")]
    rclpy.init(args=["p", "--ros-args", *rules])
    node = Node("n", namespace="a")
    default = QoSOverridingOptions.with_default_policies()
    kinds = [QoSPolicyKind.DURABILITY, QoSPolicyKind.LIFESPAN, QoSPolicyKind.AVOID_ROS_NAMESPACE_CONVENTIONS]
    publishers = [
        node.create_publisher(String, "chat", QoSProfile(depth=8), qos_overriding_options=options)
        for options in (default, QoSOverridingOptions(kinds, entity_id="second"), default)
    ]
    subscription = node.create_subscription(
        String, "chat", print, 3, qos_overriding_options=QoSOverridingOptions([QoSPolicyKind.LIFESPAN, *kinds[:1]])
    )

    def refuse(profile):
        return QosCallbackResult(successful=False, reason=f"depth {profile.depth}")

    bad = QoSOverridingOptions(kinds, entity_id="second")
    refused = QoSOverridingOptions.with_default_policies(callback=refuse)
    result = {
        "publishers": [policies(publisher.qos_profile) for publisher in publishers],
        "subscription": policies(subscription.qos_profile),
        "parameters": {name: p.value for name, p in sorted(node.get_parameters_by_prefix("qos_overrides").items())},
        "descriptor": node.describe_parameter("qos_overrides./a/chat.publisher.depth").description,
        "errors": [
            error_of(lambda: node.create_subscription(String, "chat", print, 3, qos_overriding_options=bad)),
            error_of(lambda: node.create_publisher(String, "other", 3, qos_overriding_options=refused)),
        ],
    }
    print(json.dumps(result))
    rclpy.shutdown()


if __name__ == "__main__":
    main()
