"""Types that ROS 2 derives from services and actions, and sends or puts into its graph.

A service `S` is itself a type of its request, response and event. An action `A` has the services `A_SendGoal` and
`A_GetResult` and the message `A_FeedbackMessage`.
"""

from __future__ import annotations

from typing import Any, Final

from simkit.errors import MessageError
from simkit.msgs.definition_parser import BASE, NAME, PARTS, SEQUENCE, FieldNode
from simkit.msgs.message_types import Message, make_picklable, type_of, type_store

Fields = list[tuple[str, Any]]
_EVENT_INFO: Final = "service_msgs/msg/ServiceEventInfo"


def is_derived(name: str) -> bool:
    """Check for a service or action itself, or for a type that ROS 2 derives from it."""
    kind, _, short = name.partition("/")[2].partition("/")
    return kind in ("srv", "action") and "_" + short.partition("_")[2] not in PARTS[kind]


def derived_type(name: str) -> type[Message]:
    """Return the class of a derived type, such as `example_interfaces/action/Fibonacci_GetResult_Response`.

    Raises:
        MessageError: the service or action of the type is unknown.
    """
    if name not in type_store().fielddefs:
        fields = derived_fields(name)
        for _, (kind, content) in fields:
            if kind == NAME:
                (derived_type if is_derived(content) else type_of)(content)
        type_store().register({name: ([], fields)})
        make_picklable(type_store().types[name], derived_type)
    return type_of(name)


def derived_fields(name: str) -> Fields:
    """Return the fields of a derived type.

    Raises:
        MessageError: the type is unknown.
    """
    base, _, suffix = name.rpartition("/")[2].partition("_")
    return _fields_of(f"{name.rpartition('/')[0]}/{base}", name.partition("/")[2].partition("/")[0], suffix)


def _service(name: str) -> Fields:
    return [(f"{part.lower()}_message", (NAME, f"{name}_{part}")) for part in ("Request", "Response", "Event")]


def _event(name: str) -> Fields:
    parts = [(part.lower(), (SEQUENCE, ((NAME, f"{name}_{part}"), 1))) for part in ("Request", "Response")]
    return [("info", (NAME, _EVENT_INFO)), *parts]


def _fields_of(name: str, kind: str, suffix: str) -> Fields:
    """Return the fields of a service or action itself, or of one of the types that ROS 2 derives from it."""
    if kind == "srv":
        make_fields = {"": _service, "Event": _event}.get(suffix)
        if make_fields is not None:
            return make_fields(name)
    goal_id: tuple[str, FieldNode] = ("goal_id", (NAME, "unique_identifier_msgs/msg/UUID"))
    stamp: tuple[str, FieldNode] = ("stamp", (NAME, "builtin_interfaces/msg/Time"))
    table: dict[str, Fields] = {
        "": [
            *((part.lower(), (NAME, f"{name}_{part}")) for part in ("Goal", "Result", "Feedback")),
            ("send_goal_service", (NAME, f"{name}_SendGoal")),
            ("get_result_service", (NAME, f"{name}_GetResult")),
            ("feedback_message", (NAME, f"{name}_FeedbackMessage")),
        ],
        "SendGoal_Request": [goal_id, ("goal", (NAME, f"{name}_Goal"))],
        "SendGoal_Response": [("accepted", (BASE, ("bool", 0))), stamp],
        "GetResult_Request": [goal_id],
        "GetResult_Response": [("status", (BASE, ("int8", 0))), ("result", (NAME, f"{name}_Result"))],
        "FeedbackMessage": [goal_id, ("feedback", (NAME, f"{name}_Feedback"))],
    }
    for word in ("SendGoal", "GetResult"):
        table[word], table[f"{word}_Event"] = _service(f"{name}_{word}"), _event(f"{name}_{word}")
    if kind == "action" and suffix in table:
        return table[suffix]
    raise MessageError(f"unknown type {name}_{suffix}")
