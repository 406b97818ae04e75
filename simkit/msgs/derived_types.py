"""Types that ROS 2 derives from a service or an action, registered in the type store on request.

A service `S` is itself a type of its request, response and event. An action `A` has the services `A_SendGoal` and
`A_GetResult` and the message `A_FeedbackMessage`. ROS 2 sends these types and puts their hashes into its graph.
"""

from __future__ import annotations

import re

from simkit.msgs.message_types import ARRAY, BASE, NAME, SEQUENCE, FieldNode, Message, rihs, type_of, type_store

_UUID = "unique_identifier_msgs/msg/UUID"
_DERIVED = re.compile(r"_(SendGoal|GetResult)(_Request|_Response|_Event)?$|_FeedbackMessage$|_Event$")
_OF_ACTIONS: dict[str, tuple[tuple[str, str], ...]] = {
    "_SendGoal_Request": (("goal_id", _UUID), ("goal", "{0}_Goal")),
    "_SendGoal_Response": (("accepted", "bool"), ("stamp", "builtin_interfaces/msg/Time")),
    "_GetResult_Request": (("goal_id", _UUID),),
    "_GetResult_Response": (("status", "int8"), ("result", "{0}_Result")),
    "_FeedbackMessage": (("goal_id", _UUID), ("feedback", "{0}_Feedback")),
    "": (
        *(("goal", "{0}_Goal"), ("result", "{0}_Result"), ("feedback", "{0}_Feedback")),
        *(("send_goal_service", "{0}_SendGoal"), ("get_result_service", "{0}_GetResult")),
        ("feedback_message", "{0}_FeedbackMessage"),
    ),
}
_INFO = "service_msgs/msg/ServiceEventInfo"
_INFO_FIELDS: tuple[tuple[str, FieldNode], ...] = (
    ("event_type", (BASE, ("uint8", 0))),
    ("stamp", (NAME, "builtin_interfaces/msg/Time")),
    ("client_gid", (ARRAY, ((BASE, ("uint8", 0)), 16))),
    ("sequence_number", (BASE, ("int64", 0))),
)


def derived_type(type_name: str) -> type[Message]:
    """Return the class of a type that ROS 2 derives, such as `example_interfaces/action/Fibonacci_GetResult_Response`.

    Raises:
        MessageError: the service or action of the type is unknown.
    """
    _register(type_name)
    return type_of(type_name)


def interface_hash(type_name: str) -> str:
    """Return the type hash (`RIHS01_…`) of a message, a service, an action or a type derived from one.

    Raises:
        MessageError: the type is unknown.
    """
    if type_name.split("/")[1:2] != ["msg"]:
        _register(type_name)
    return rihs(type_name)


def _register(type_name: str) -> None:
    store = type_store()
    if type_name in store.fielddefs:
        return
    _, kind, name = type_name.split("/")
    fields: list[tuple[str, FieldNode]] = []
    if name.endswith("_Event"):
        service = type_name.removesuffix("_Event")
        # rosbags gives `char` another number in the hash than ROS 2, for which it is uint8
        store.fielddefs[_INFO] = ([], list(_INFO_FIELDS))
        fields.append(("info", (NAME, _INFO)))
        for part in ("Request", "Response"):
            fields.append((part.lower(), (SEQUENCE, (_node(f"{service}_{part}"), 1))))
    elif kind == "srv" or name.endswith(("_SendGoal", "_GetResult")):
        for part in ("Request", "Response", "Event"):
            fields.append((f"{part.lower()}_message", _node(f"{type_name}_{part}")))
    else:
        suffix = found[0] if (found := _DERIVED.search(name)) else ""
        action = type_name.removesuffix(suffix) if suffix else type_name
        for field, field_type in _OF_ACTIONS[suffix]:
            fields.append((field, _node(field_type.format(action))))
    store.register({type_name: ([], fields)})


def _node(type_name: str) -> FieldNode:
    """Return the node of a field; its type is registered first if ROS 2 derives it."""
    if "/" not in type_name:
        return BASE, (type_name, 0)
    if "/msg/" not in type_name:
        if _is_derived(type_name):
            _register(type_name)
        else:
            type_of(type_name)
    return NAME, type_name


def _is_derived(type_name: str) -> bool:
    return _DERIVED.search(type_name) is not None
