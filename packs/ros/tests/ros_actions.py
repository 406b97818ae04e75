"""Classes for `rclpy.action.ActionClient` of actions whose packages are not installed, in the Python of ROS.

No package with such actions has wheels. The classes are the bridge's opaque ones, with properties that encode and
decode the fields that an ActionClient uses. Goals, results and feedback are messages of `simkit.msgs`.
"""

from __future__ import annotations

import ctypes
import struct
from types import SimpleNamespace
from typing import Any

from action_msgs.msg import GoalStatusArray
from action_msgs.srv import CancelGoal
from builtin_interfaces.msg import Time
from unique_identifier_msgs.msg import UUID

from simkit import msgs
from simkit.msgs.derived_types import derived_type
from simkit.msgs.type_hashes import rihs
from simkit_ros import opaque_types
from simkit_ros.type_support import GETTER, capsule

HEADER = opaque_types.CDR_HEADER


class ActionSupport(ctypes.Structure):
    _fields_ = [(name, ctypes.c_void_p) for name in ("goal", "result", "cancel", "feedback", "status")] + [
        (name, GETTER) for name in ("hash", "description", "sources")
    ]


def action_class(name: str) -> Any:
    """The class of an action, as `rosidl` would have generated it."""
    for part in ("Goal", "Result", "Feedback"):
        msgs.full_name(f"{name}_{part}")
    send = opaque_types.service_class(f"{name}_SendGoal", rihs(f"{name}_SendGoal"))
    result = opaque_types.service_class(f"{name}_GetResult", rihs(f"{name}_GetResult"))
    feedback = opaque_types.message_class(f"{name}_FeedbackMessage", rihs(f"{name}_FeedbackMessage"))
    derived_type(f"{name}_GetResult_Response")

    def set_id(self: Any, value: UUID) -> None:
        self.cdr = HEADER + bytes(value.uuid) + self.cdr[20:]

    def get_id(self: Any) -> UUID:
        return UUID(uuid=list(self.cdr[4:20]))

    def set_goal(self: Any, value: Any) -> None:
        self.cdr = self.cdr[:20] + msgs.serialize(value)[4:]

    def stamp(self: Any) -> Time:
        sec, nanosec = struct.unpack("<iI", self.cdr[8:16])
        return Time(sec=sec, nanosec=nanosec)

    for cls in (send.Request, result.Request, feedback):
        cls.goal_id = property(get_id, set_id)
    send.Request.goal = property(None, set_goal)
    send.Response.accepted = property(lambda self: bool(self.cdr[4]))
    send.Response.stamp = property(stamp)
    result.Response.status = property(lambda self: self.cdr[4])
    result.Response.result = property(
        lambda self: msgs.type_store().deserialize_cdr(self.cdr, f"{name}_GetResult_Response").result
    )
    feedback.feedback = property(lambda self: msgs.deserialize(HEADER + self.cdr[20:], f"{name}_Feedback"))

    parts = [address(cls) for cls in (send, result, CancelGoal, feedback, GoalStatusArray)]
    support = opaque_types._runtime().keep(ActionSupport(*parts, *opaque_types._description(name, rihs(name))))
    metaclass = type("Metaclass", (type,), {"_TYPE_SUPPORT": capsule(ctypes.addressof(support))})
    impl = SimpleNamespace(SendGoalService=send, GetResultService=result, FeedbackMessage=feedback)
    impl.CancelGoalService, impl.GoalStatusMessage = CancelGoal, GoalStatusArray
    return metaclass(
        name.split("/")[-1], (), {"Impl": impl, "Goal": msgs.type_of(f"{name}_Goal"), "Result": None, "Feedback": None}
    )


def address(cls: Any) -> int:
    """The address of an installed or opaque class's type support."""
    if cls.__class__._TYPE_SUPPORT is None:
        cls.__class__.__import_type_support__()
    api = ctypes.pythonapi
    api.PyCapsule_GetName.restype, api.PyCapsule_GetName.argtypes = ctypes.c_char_p, [ctypes.py_object]
    api.PyCapsule_GetPointer.restype = ctypes.c_void_p
    api.PyCapsule_GetPointer.argtypes = [ctypes.py_object, ctypes.c_char_p]
    found = cls.__class__._TYPE_SUPPORT
    return int(api.PyCapsule_GetPointer(found, api.PyCapsule_GetName(found)))
