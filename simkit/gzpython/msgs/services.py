"""Services of gz by messages of gz, as far as the simulation offers them with ROS's types."""

from __future__ import annotations

from typing import Any, Final

from simkit.errors import InputError
from simkit.gzpython.msgs.message import Message
from simkit.gzpython.msgs.ros import fields_of

TAKEN: Final = ("WorldControl", "EntityFactory", "Entity", "Pose", "Boolean", "Empty")
"""Messages that are known as requests."""


def call(sim: Any, service: str, request: Message, response_kind: type[Message]) -> tuple[bool, Message]:
    """Calls a service: whether it is there and was understood, and the response (of Boolean: whether it succeeded)."""
    response = response_kind()
    if service not in sim.services():
        return False, response
    try:
        answer = sim.call(service, _fields(request))
    except InputError:
        return False, response
    succeeded = bool(getattr(answer, "success", True))
    if "data" in response_kind.FIELDS and response_kind.FIELDS["data"] == "b":
        response.data = succeeded
    return True, response


def _fields(request: Any) -> dict[str, Any]:
    """The fields of the ROS service that does the same.

    Raises:
        InputError: simkit has none.
    """
    kind = type(request).__name__
    if kind == "WorldControl":
        reset = {name: getattr(request.reset, name) for name in ("all", "time_only", "model_only")}
        control = {name: getattr(request, name) for name in ("pause", "step", "multi_step", "seed")}
        until = {"sec": request.run_to_sim_time.sec, "nanosec": request.run_to_sim_time.nsec}
        return {"world_control": {**control, "reset": reset, "run_to_sim_time": until}}
    if kind == "EntityFactory":
        names = ("name", "allow_renaming", "sdf", "sdf_filename", "clone_name")
        plain = {name: getattr(request, name) for name in names}
        return {"entity_factory": {**plain, "pose": fields_of(request.pose)}}
    if kind == "Entity":
        return {"entity": {name: getattr(request, name) for name in ("id", "name", "type")}}
    if kind == "Pose":
        return {"entity": {"name": request.name, "id": request.id, "type": 2}, "pose": fields_of(request)}
    if kind == "Boolean":
        return {"data": request.data}
    if kind == "Empty":
        return {}
    raise InputError(f"simkit has no service that takes gz.msgs.{kind}")
