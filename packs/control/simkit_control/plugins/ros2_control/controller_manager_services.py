"""Services of the controller manager for spawners, `ros2 control` and rqt's controller page."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any, Final

from simkit.msgs import Message
from simkit_control.plugins.ros2_control.controller import Controller
from simkit_control.plugins.ros2_control.controller_manager import ControllerManager, LoadedController, controller_kinds
from simkit_control.plugins.ros2_control.controller_parameters import set_parameters

if TYPE_CHECKING:
    from simkit.msgs import SetHardwareComponentState_Request, SwitchController_Request
    from simkit_control.plugins.ros2_control.hardware_description import ComponentDescription

Handler = Callable[[Any], object]
"""Function that answers a request of a service."""

_STRICT: Final = 2
_BEST_EFFORT: Final = 1
_LIFE_CYCLE: Final = {1: "unconfigured", 2: "inactive", 3: "active", 4: "finalized"}
"""State names of `lifecycle_msgs/msg/State` by id."""

_ROS_1_STATES: Final = {"unconfigured": "initialized", "inactive": "stopped", "active": "running"}


def offer_services(manager: ControllerManager) -> None:
    """Offer the services of a controller manager below its node."""
    handlers: dict[str, Handler] = {
        "ListControllers": lambda _: {"controller": [_state(manager, n, c) for n, c in manager.controllers.items()]},
        "ListControllerTypes": lambda _: _types(),
        "LoadController": lambda request: {"ok": _load(manager, request.name)},
        "ConfigureController": lambda request: {"ok": _report_problem(manager, manager.configure(request.name))},
        "SwitchController": lambda request: {"ok": _switch(manager, request)},
        "UnloadController": lambda request: {"ok": _report_problem(manager, manager.unload(request.name))},
        "ReloadControllerLibraries": lambda request: {"ok": _reload(manager, bool(request.force_kill))},
        "ListHardwareComponents": lambda _: {
            "component": [_component(manager, c) for c in manager.hardware.components]
        },
        "ListHardwareInterfaces": lambda _: _interfaces(manager),
        "SetHardwareComponentState": lambda request: _set_component(manager, request),
    }
    for name, handler in handlers.items():
        snake = "".join(f"_{c.lower()}" if c.isupper() else c for c in name).lstrip("_")
        manager.plugin.offer(
            f"{manager.name}/{snake}", f"controller_manager_msgs/srv/{name}", _settled(manager, handler)
        )
    if not manager.is_ros_1:
        name = f"{manager.name}/set_parameters"
        handler = _settled(manager, partial(set_parameters, manager))
        manager.plugin.offer(name, "rcl_interfaces/srv/SetParameters", handler)


def _settled(manager: ControllerManager, handler: Handler) -> Handler:
    """Return a handler of a service that decides first who starts the controllers."""

    def handle(request: Message) -> object:
        manager.leave_start_to_nodes()
        return handler(request)

    return handle


def _report_problem(manager: ControllerManager, problem: str) -> bool:
    """Report a problem; return true if the problem is empty, that is, if there is none."""
    if problem:
        manager.reports.warning("SK-CONTROL-010", problem, manager.plugin.where)
    return not problem


def _state(manager: ControllerManager, name: str, loaded: LoadedController) -> dict[str, object]:
    controller = loaded.controller
    is_configured = loaded.state != "unconfigured"
    return {
        "name": name,
        "state": _ROS_1_STATES[loaded.state] if manager.is_ros_1 else loaded.state,
        "type": loaded.type,
        "claimed_interfaces": [i for i, owner in manager.hardware.owners.items() if owner == name],
        "required_command_interfaces": list(controller.command_interfaces()) if is_configured else [],
        "required_state_interfaces": list(controller.state_interfaces()) if is_configured else [],
    }


def _types() -> dict[str, object]:
    kinds = list(controller_kinds())
    return {"types": kinds, "base_classes": [f"{Controller.__module__}.{Controller.__name__}"] * len(kinds)}


def _load(manager: ControllerManager, name: str) -> bool:
    done = _report_problem(manager, manager.load(name))
    # in ROS 1, loading includes configuring
    return _report_problem(manager, manager.configure(name)) if done and manager.is_ros_1 else done


def _switch(manager: ControllerManager, request: SwitchController_Request) -> bool:
    strictness = int(request.strictness)
    if strictness not in (0, _BEST_EFFORT, _STRICT):
        return _report_problem(manager, f"the strictness {strictness} is not known; use 1 (best effort) or 2 (strict)")
    activate = [*request.activate_controllers, *request.start_controllers]
    deactivate = [*request.deactivate_controllers, *request.stop_controllers]
    return not manager.switch(activate, deactivate, strict=strictness == _STRICT)


def _reload(manager: ControllerManager, force_kill: bool) -> bool:
    """Unload all controllers; if one is active, `force_kill` must be set. Python has no library to reload."""
    active = [name for name, loaded in manager.controllers.items() if loaded.state == "active"]
    if active and not force_kill:
        return _report_problem(manager, "controllers are active, so libraries are not reloaded: " + ", ".join(active))
    for name in active:
        manager.deactivate(name)
    for name in list(manager.controllers):
        manager.unload(name)
    return True


def _interface(manager: ControllerManager, name: str, *, is_command: bool) -> dict[str, object]:
    return {"name": name, "is_available": True, "is_claimed": is_command and name in manager.hardware.owners}


def _interfaces(manager: ControllerManager) -> dict[str, object]:
    hardware = manager.hardware
    return {
        "command_interfaces": [_interface(manager, n, is_command=True) for n in hardware.commands.names],
        "state_interfaces": [_interface(manager, n, is_command=False) for n in hardware.states.names],
    }


def _component(manager: ControllerManager, component: ComponentDescription) -> dict[str, object]:
    owners = {joint.name for joint in component.joints} | {sensor.name for sensor in component.sensors}
    hardware = manager.hardware

    def own(names: tuple[str, ...], *, is_command: bool) -> list[dict[str, object]]:
        own_names = (name for name in names if name.rpartition("/")[0] in owners)
        return [_interface(manager, name, is_command=is_command) for name in own_names]

    return {
        "name": component.name,
        "type": component.kind,
        "class_type": component.plugin,
        "state": {"id": 3, "label": "active"},
        "command_interfaces": own(hardware.commands.names, is_command=True),
        "state_interfaces": own(hardware.states.names, is_command=False),
    }


def _set_component(manager: ControllerManager, request: SetHardwareComponentState_Request) -> dict[str, object]:
    """Accept only the state `active`, because simulated hardware is always active."""
    active = {"id": 3, "label": "active"}
    names = [component.name for component in manager.hardware.components]
    if request.name not in names:
        _report_problem(
            manager,
            f"there is no hardware component '{request.name}'; the components are: {', '.join(names) or 'none'}",
        )
        return {"ok": False}
    target = _LIFE_CYCLE.get(int(request.target_state.id), "") or str(request.target_state.label)
    if target != "active":
        _report_problem(
            manager, f"the hardware '{request.name}' is simulated and always active; it cannot be {target or 'unknown'}"
        )
        return {"ok": False, "state": active}
    return {"ok": True, "state": active}
