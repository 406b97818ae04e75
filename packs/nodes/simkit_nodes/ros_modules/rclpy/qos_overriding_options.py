"""Parameters that replace policies of the quality of service of a publisher or a subscription."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, Final

from simkit_nodes.interfaces import ROS2
from simkit_nodes.ros_modules.rclpy import qos as policies
from simkit_nodes.ros_modules.rclpy.duration import Duration
from simkit_nodes.ros_modules.rclpy.exceptions import ParameterAlreadyDeclaredException
from simkit_nodes.ros_modules.rclpy.qos import QoSPolicyKind, QoSProfile

if TYPE_CHECKING:
    from simkit_nodes.ros_modules.rclpy.node import Node

__all__ = ["InvalidQosOverridesError", "QoSOverridingOptions", "QosCallbackResult", "QosCallbackType"]

QosCallbackResult: Any = ROS2.message_class("rcl_interfaces/msg/SetParametersResult")
QosCallbackType = Callable[[QoSProfile], Any]
_DEFAULT_KINDS: Final = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)


class InvalidQosOverridesError(Exception):
    """Parameters that the callback of the options has refused."""


class QoSOverridingOptions:
    """Policies that parameters may replace.

    Args:
        policy_kinds: policies; each has a parameter.
        callback: function that checks the resulting profile, and returns a `QosCallbackResult`.
        entity_id: name that distinguishes several publishers or subscriptions of a topic.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: QosCallbackType | None = None,
        entity_id: str | None = None,
    ) -> None:
        self.policy_kinds, self.callback, self.entity_id = policy_kinds, callback, entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: QosCallbackType | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """Return options for history, depth and reliability."""
        return cls(_DEFAULT_KINDS, callback=callback, entity_id=entity_id)


def declare_qos_parameters(
    node: Node, kind: str, topic: str, profile: QoSProfile, options: QoSOverridingOptions
) -> None:
    """Declare the parameters of a publisher or a subscription, and change its profile to their values.

    Args:
        node: node of the publisher or the subscription.
        kind: `publisher` or `subscription`.
        topic: absolute name of the topic.
        profile: quality of service; it is changed.
        options: policies with a parameter.

    Raises:
        InvalidQosOverridesError: the callback has refused the profile.
        RuntimeError: a parameter names no value of its policy.
    """
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    about = f"for {kind} `{topic}` with id `{options.entity_id}`"
    for policy in options.policy_kinds:
        name = policy.name.lower()
        if kind == "subscription" and policy == QoSPolicyKind.LIFESPAN:
            continue
        parameter, default = f"qos_overrides.{topic}.{kind}{suffix}.{name}", getattr(profile, name)
        descriptor = ROS2.message_class("rcl_interfaces/msg/ParameterDescriptor")(
            description=f"{name} {about}", read_only=True
        )
        try:
            value = node.declare_parameter(parameter, _parameter_value(default), descriptor).value
        except ParameterAlreadyDeclaredException:
            value = node.get_parameter(parameter).value
        setattr(profile, name, _policy_value(default, name, value))
    result = None if options.callback is None else options.callback(profile)
    if result is not None and not result.successful:
        raise InvalidQosOverridesError(f"Provided QoS overrides {about}, are not valid: {result.reason}")


def _parameter_value(value: Any) -> str | int | bool:
    if isinstance(value, policies.QoSPolicyEnum):
        if value.name == "UNKNOWN":
            raise ValueError("User provided QoS profile is invalid")
        return value.short_key
    return value.nanoseconds if isinstance(value, Duration) else value


def _policy_value(default: Any, name: str, value: Any) -> Any:
    if isinstance(default, Duration):
        return Duration(nanoseconds=value)
    if isinstance(default, policies.QoSPolicyEnum):
        try:
            return type(default)[value.upper()]
        except KeyError:
            raise RuntimeError(f"Unexpected QoS override for policy `{name}`: `{value}`") from None
    return value
