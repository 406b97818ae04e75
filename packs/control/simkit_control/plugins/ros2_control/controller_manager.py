"""Controller manager: loads, configures and switches controllers, and updates the active controllers."""

from __future__ import annotations

import fnmatch
import functools
import re
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

from simkit import Params
from simkit.extend import Diagnostics, SharedByCopies, Where, did_you_mean
from simkit.plugins.ros_parameter_files import Entry, ParameterFiles
from simkit.registry import Kinds
from simkit_control.plugins.ros2_control.controller import Controller, ControllerEndpoints
from simkit_control.plugins.ros2_control.hardware import Hardware

if TYPE_CHECKING:
    from simkit import Plugin

GROUP: Final = "simkit.controllers"
_SECOND: Final = 1_000_000_000
KNOWN_PARAMETERS: Final[Mapping[str, Sequence[str]]] = tomllib.loads(
    Path(__file__).with_name("known_parameters.toml").read_text(encoding="utf-8")
)
"""Names of the parameters that every controller or the manager has, by the kind of node."""
UNSUPPORTED_CONTROLLERS: Final[Sequence[Mapping[str, Any]]] = tomllib.loads(
    Path(__file__).with_name("unsupported_controllers.toml").read_text(encoding="utf-8")
)["unsupported"]
"""Controllers of ROS 2 that do not exist here: patterns of their types, the reason, and what to use instead."""
_CLASS: Final = re.compile(r"\w+/[\w:]+")
State = Literal["unconfigured", "inactive", "active"]


@functools.cache
def controller_kinds() -> Mapping[str, type[Controller]]:
    """Return all controller classes by type name; the mapping is read-only and created once."""

    def names(cls: type[Controller]) -> tuple[str, ...]:
        types: tuple[str, ...] = vars(cls).get("types", ())  # inherited names belong to the base class
        return types

    return Kinds("simkit_control.controllers", GROUP, Controller, names)  # type: ignore[type-abstract]


def _reason_for_unknown(kind: str) -> str:
    """Describe why a controller type does not exist, and which type to use instead."""
    for group in UNSUPPORTED_CONTROLLERS:
        if any(fnmatch.fnmatchcase(kind, pattern) for pattern in group["types"]):
            return f"is not supported: {group['reason']}; instead: {group['use']}"
    near = did_you_mean(kind, controller_kinds())
    return f"is not known; {near or 'the table of controllers in docs/ros2_control.md lists the known types'}"


@dataclass(slots=True)
class LoadedController:
    """Controller with its life cycle state.

    Attributes:
        controller: controller object.
        type: type name of the controller in the file.
        state: life cycle state.
        last: simulated time of the last update [ns].
    """

    controller: Controller
    type: str
    state: State = "unconfigured"
    last: int = 0


class ControllerManager(SharedByCopies):
    """Loads, switches and updates the controllers of one robot.

    Args:
        plugin: plugin that hosts the manager.
        hardware: joints and sensors that the controllers claim.
        files: parameter files of the manager and its controllers.
        name: name of the manager's node.
        diagnostics: diagnostics that receive reports until `start` has returned.

    Attributes:
        namespace: namespace of the manager's node and of the controllers' nodes.
        controllers: loaded controllers by name, in the order in which they were loaded.
        is_ros_1: true if the services use the states and steps of ROS 1.
        is_start_open: true until it is known whether the run has a node that loads controllers; see
            `leave_start_to_nodes`.
        remappings: source and target of the remapping rules of single controllers, by the name of the controller.
    """

    def __init__(
        self, plugin: Plugin, hardware: Hardware, files: ParameterFiles, name: str, diagnostics: Diagnostics
    ) -> None:
        self.plugin, self.hardware, self.files, self.name = plugin, hardware, files, name
        self._diagnostics: Diagnostics | None = diagnostics
        self.namespace = plugin.ros.namespace
        self.controllers: dict[str, LoadedController] = {}
        self.is_ros_1 = self.is_start_open = False
        self.remappings: dict[str, tuple[tuple[str, str], ...]] = {}
        self._last_ns = 0
        self._endpoints: dict[str, ControllerEndpoints] = {}
        # the active controllers in their order; None after a change
        self._active_controllers: list[tuple[LoadedController, Controller]] | None = None

    # ------------------------------------------------------------------ declarations in the files

    @property
    def node(self) -> str:
        """Full name of the node whose parameters declare the controllers; in ROS 1 the robot's namespace."""
        return self.namespace if self.is_ros_1 else f"{self.namespace}/{self.name}"

    def declared(self) -> dict[str, str]:
        """Return the type of each controller that the files declare, in the order of the files."""
        return {name: kind.text for name, kind in self.declarations().items()}

    def declarations(self) -> dict[str, Entry]:
        """Return the entry with the type of each controller.

        The type stands below the name of the controller in the manager's node, or in the controller's own node, where
        the spawner of ros2_control looks for it. The entries of the manager's node come first.
        """
        of_node = self.files.of_node(self.node)
        kinds = (
            {name: (entry.below or {}).get("type") for name, entry in (of_node.below or {}).items()} if of_node else {}
        )
        declared = {name: kind for name, kind in kinds.items() if kind is not None and kind.text}
        for name in self.files.nodes_below(self.namespace):
            entry = self.files.of_node(f"{self.namespace}/{name}")
            kind = (entry.below or {}).get("type") if entry is not None else None
            # nodes that are not controllers may have a parameter `type` too, but not the name of a class
            if name not in declared and name != self.name and kind is not None and _CLASS.fullmatch(kind.text):
                declared[name] = kind
        return declared

    # ------------------------------------------------------------------ life cycle

    @property
    def reports(self) -> Diagnostics:
        """Diagnostics that receive new problems: the loading diagnostics until `start` returns, then the run's."""
        diagnostics: Diagnostics = self.plugin.sim.engine.reports if self._diagnostics is None else self._diagnostics
        return diagnostics

    def load(self, name: str) -> str:
        """Create a controller of the type that the files declare; return the problem, or an empty text."""
        if name in self.controllers:
            return f"a controller named '{name}' was already loaded inside the controller manager"
        kind = self.declared().get(name, "")
        if not kind:
            return f"the 'type' param was not defined for '{name}'"
        cls = controller_kinds().get(kind)
        if cls is None:
            return f"controller '{name}' (type '{kind}') {_reason_for_unknown(kind)}"
        params = self._parameters(name)
        controller = cls(name, self.plugin, params, self.hardware)
        controller.remappings = self.remappings.get(name, ())
        controller.endpoints = self._endpoints.setdefault(name, controller.endpoints)
        controller.endpoints.is_active = functools.partial(self._is_active, name)
        self.controllers[name] = LoadedController(controller, kind)
        return ""

    def _is_active(self, name: str) -> bool:
        loaded = self.controllers.get(name)
        return loaded is not None and loaded.state == "active"

    def _parameters(self, name: str) -> Params:
        problems, entry = Diagnostics(), self.files.of_node(f"{self.namespace}/{name}")
        if entry is None:
            return Params(name, where=self.plugin.where, diagnostics=problems)
        created = entry.params(name, problems)
        return created[0] if created else Params(name, where=entry.where, diagnostics=problems)

    def configure(self, name: str) -> str:
        """Let a controller read its parameters; return the problem, or an empty text."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._not_found(name)
        if loaded.state == "active":
            return f"controller '{name}' can not be configured from '{loaded.state}' state"
        controller = loaded.controller
        params = controller.params
        before = params.diagnostics.error_count
        for parameter in KNOWN_PARAMETERS["controller"]:
            params.child(parameter)
        controller.update_rate = params.integer("update_rate", 0, minimum=0)
        controller.configure()
        commands, states = controller.command_interfaces(), controller.state_interfaces()
        has_errors = params.diagnostics.error_count > before
        missing = [n for n in commands if n not in self.hardware.commands.names]
        missing += [n for n in states if n not in self.hardware.states.names]
        if missing and not has_errors and self._diagnostics is not None and self._is_for_other_robot(commands, states):
            message = f"controller {name!r} is not loaded: the robot does not have {', '.join(dict.fromkeys(missing))}"
            self.reports.warning("SK-CONTROL-012", message, params.where)
            return message
        if not has_errors:
            self._check_interfaces(controller, commands, self.hardware.commands.names, "command")
            self._check_interfaces(controller, states, self.hardware.states.names, "state")
        params.report_unread("SK-CONTROL-011", f"controller {name!r}")
        errors = [d for d in params.diagnostics if d.severity == "error"]
        if errors and self._diagnostics is not None and all(map(self.reports.can_leave_out, errors)):
            params.diagnostics.soften(errors)
            self.reports.extend(params.diagnostics)
            message = f"controller {name!r} ({loaded.type}) is left out, because it has errors"
            message += "; its joints do not follow its commands" if commands else "; it publishes nothing"
            hint = "correct the errors above; with --strict they stop the run"
            self.reports.warning("SK-LOAD-014" if commands else "SK-LOAD-013", message, params.where, hint)
            return "; ".join(d.message for d in errors)
        self.reports.extend(params.diagnostics)
        if params.diagnostics.error_count > before:
            return "; ".join(d.message for d in errors)
        controller.states = self.hardware.states.select(states)
        controller.commands = self.hardware.commands.select(commands)
        loaded.state = "inactive"
        return ""

    def _is_for_other_robot(self, commands: Sequence[str], states: Sequence[str]) -> bool:
        """Check whether a controller belongs to another robot or variant, and other controllers drive this robot.

        A launch file starts only some controllers of a file: the robot has none of the joints of this controller, with
        no similar names, or other controllers drive all its joints. Other missing interfaces are mistakes.
        """
        known = {name.rpartition("/")[0] for name in (*self.hardware.commands.names, *self.hardware.states.names)}
        driven = {name.rpartition("/")[0] for name in self.hardware.owners}
        wanted = {name.rpartition("/")[0] for name in commands}
        owners = wanted | {name.rpartition("/")[0] for name in states}
        is_unknown = not owners & known and not any(did_you_mean(owner, known) for owner in owners)
        has_others = any(loaded.state == "active" for loaded in self.controllers.values())
        return has_others and (is_unknown or bool(wanted and wanted <= driven))

    def _check_interfaces(self, controller: Controller, names: Sequence[str], known: Sequence[str], kind: str) -> None:
        for name in dict.fromkeys(names):
            if name not in known:
                listed = f"the {kind} interfaces are: " + (", ".join(known) or "none")
                message = f"controller {controller.name!r} needs the {kind} interface {name!r}, which does not exist"
                controller.params.error("SK-CONTROL-012", message, did_you_mean(name, known) or listed)

    def _not_found(self, name: str) -> str:
        near = did_you_mean(name, self.controllers)
        return f"could not find a controller named '{name}'" + (f"; {near}" if near else "")

    def conflicts(
        self, name: str, leaving: Iterable[str] = (), claims: Mapping[str, str] | None = None
    ) -> dict[str, str]:
        """Return the command interfaces whose joint another controller drives, with the name of that controller.

        Args:
            name: name of the controller.
            leaving: active controllers that are about to be deactivated.
            claims: interfaces that are about to be claimed, with the name of the claiming controller.
        """
        released = set(leaving)
        owners = {i: owner for i, owner in self.hardware.owners.items() if owner not in released} | dict(claims or {})
        joints = self.hardware.joints

        def unit(interface: str) -> str:
            """Return what one controller can claim: a joint, or one interface of a joint that adds up its commands."""
            joint = interface.rpartition("/")[0]
            return interface if joint in joints and joints[joint].has_gain_commands else joint

        claimed = {unit(i): owner for i, owner in owners.items() if owner != name}
        needed = self.controllers[name].controller.command_interfaces()
        return {i: claimed[unit(i)] for i in needed if unit(i) in claimed}

    def activate(self, name: str) -> None:
        """Activate a configured controller: claim its command interfaces and bind its state interfaces."""
        loaded = self.controllers[name]
        names = loaded.controller.command_interfaces()
        self.hardware.claim(names, name)
        loaded.state, loaded.last = "active", self.plugin.sim.time_ns
        self._update_active()
        self.hardware.read()
        loaded.controller.activate()

    def _update_active(self) -> None:
        """Select the state interfaces of the active controllers for reading."""
        self._active_controllers = None
        active = (c.controller for c in self.controllers.values() if c.state == "active")
        self.hardware.set_read_interfaces(name for controller in active for name in controller.states.names)

    def deactivate(self, name: str) -> None:
        """Deactivate an active controller and release its interfaces."""
        loaded = self.controllers[name]
        loaded.controller.deactivate()
        self.hardware.release(name)
        loaded.state = "inactive"
        self._update_active()

    def switch(self, activate: Sequence[str], deactivate: Sequence[str], *, strict: bool) -> str:
        """Deactivate controllers, then activate others, all before the next update.

        Args:
            activate: names of controllers to activate.
            deactivate: names of controllers to deactivate.
            strict: true to switch no controller if one of them cannot be switched; false to skip only that controller.

        Returns:
            Description of the problem; empty if there is none.
        """
        problems: list[str] = []
        leaving = self._switchable(deactivate, "deactivate", "active", problems, leaving=())
        coming = self._switchable(activate, "activate", "inactive", problems, leaving=leaving)
        claims: dict[str, str] = {}
        for name in list(coming):
            conflicts = self.conflicts(name, leaving, claims)
            if conflicts:
                interface, owner = next(iter(conflicts.items()))
                problems.append(
                    f"resource conflict for controller '{name}': command interface '{interface}' is already claimed "
                    f"(by '{owner}')"
                )
                coming.remove(name)
            claims |= {i: name for i in self.controllers[name].controller.command_interfaces() if not conflicts}
        for problem in problems:
            self.reports.warning("SK-CONTROL-010", problem, self.plugin.where)
        is_request = bool(activate or deactivate)
        if problems and (strict or (is_request and not coming and not leaving)):
            return "; ".join(problems)
        for name in leaving:
            self.deactivate(name)
        for name in coming:
            self.activate(name)
        return ""

    def _switchable(
        self, names: Sequence[str], verb: str, needed: State, problems: list[str], leaving: Sequence[str]
    ) -> list[str]:
        """Return the names that can be switched; append the reasons for the others to `problems`."""
        switchable = []
        for name in dict.fromkeys(names):
            loaded = self.controllers.get(name)
            if loaded is None:
                near = did_you_mean(name, self.controllers)
                missing = f"could not {verb} controller '{name}' because no controller with this name exists"
                problems.append(f"{missing}; {near}" if near else missing)
            elif loaded.state == needed or (verb == "activate" and name in leaving):
                switchable.append(name)
            else:
                already = "already active" if loaded.state == "active" else f"not in {needed} state"
                reason = already if verb == "activate" else "not active"
                problems.append(f"could not {verb} controller '{name}' since it is {reason}")
        return switchable

    def unload(self, name: str) -> str:
        """Remove a controller that is not active; return the problem, or an empty text."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._not_found(name)
        if loaded.state == "active":
            return f"controller '{name}' is active; deactivate it before it is unloaded"
        loaded.controller.endpoints.close()
        del self.controllers[name]
        return ""

    # ------------------------------------------------------------------ run time

    def start(self, chosen: Sequence[str]) -> None:
        """Load, configure and activate controllers in order; report controllers that cannot be activated."""
        for name in chosen:
            problem = self.load(name)
            if problem:
                message, where = f"{problem}; the controller is not loaded", self._declaration_location(name)
                self.reports.warning("SK-CONTROL-013", message, where)
            elif not self.configure(name):  # `configure` has reported its problem
                self.start_configured(name)
        self._diagnostics = None

    def start_configured(self, name: str) -> None:
        """Activate a configured controller at the start; report joints that earlier controllers drive."""
        conflicts = self.conflicts(name)
        if not conflicts:
            self.activate(name)
            return
        claimed = ", ".join(f"{i!r} (of {owner!r})" for i, owner in conflicts.items())
        message = f"controller {name!r} stays inactive: earlier controllers have claimed {claimed}"
        service = self.plugin.ros.topic(f"{self.name}/switch_controller")
        hint = f"call {service} to activate {name} and deactivate the other controllers"
        self.reports.note("SK-CONTROL-014", message, self._declaration_location(name), hint)

    @property
    def is_started_by_nodes(self) -> bool:
        """True if nodes such as spawners load the controllers, so that none of them starts with the robot."""
        sim = self.plugin.sim
        spec = sim.run_spec
        waits = spec is not None and not spec.options.get("start_controllers", True)
        return waits or sim.control.has_controller_nodes

    def leave_start_to_nodes(self) -> None:
        """Unload the controllers that started with the robot if the run has a node that loads controllers.

        The nodes of a run are added after its world was loaded, so the first step, or the first call of a service of
        the manager, decides it.
        """
        if not self.is_start_open:
            return
        self.is_start_open = False
        if self.is_started_by_nodes:
            for name in [name for name, loaded in self.controllers.items() if loaded.state == "active"]:
                self.deactivate(name)
            for name in list(self.controllers):
                self.unload(name)

    def _declaration_location(self, name: str) -> Where:
        of_node = self.files.of_node(self.node)
        entry = (of_node.below or {}).get(name) if of_node is not None else None
        entry = entry or self.declarations().get(name)
        return self.plugin.where if entry is None else entry.where

    def update(self, now_ns: int) -> None:
        """Read the hardware, update the active controllers and write the commands."""
        if self.is_start_open:
            self.leave_start_to_nodes()
        self.hardware.read()
        if self._active_controllers is None:
            self._active_controllers = [(c, c.controller) for c in self.controllers.values() if c.state == "active"]
        for loaded, controller in self._active_controllers:
            if controller.update_rate and not self._is_due(loaded, now_ns):
                continue
            if loaded.state == "active":  # another controller's update may have deactivated it
                controller.update(now_ns, (now_ns - loaded.last) * 1e-9)
                loaded.last = now_ns
        self.hardware.write((now_ns - self._last_ns) * 1e-9)
        self._last_ns = now_ns

    def _is_due(self, loaded: LoadedController, now_ns: int) -> bool:
        rate = loaded.controller.update_rate
        return now_ns * rate // _SECOND > loaded.last * rate // _SECOND

    def get_state(self) -> object:
        """Return a copy of everything that changes at run time."""
        hardware = self.hardware
        return (
            [(n, c, c.type, c.state, c.last, c.controller.get_state()) for n, c in self.controllers.items()],
            {name: dict(endpoints.handlers) for name, endpoints in self._endpoints.items()},
            self._last_ns,
            hardware.get_state(),
            *([True] if self.is_start_open else []),  # a reset goes back to the time before the first step
        )

    def set_state(self, state: Any) -> None:
        """Restore a state from `get_state`."""
        controllers, handlers, self._last_ns, hardware, *is_start_open = state
        self.is_start_open = bool(is_start_open)
        for name, endpoints in self._endpoints.items():
            endpoints.handlers = dict(handlers.get(name, {}))
        self.controllers, self._active_controllers = {}, None
        for name, loaded, kind, state_name, last, controller_state in controllers:
            loaded.type, loaded.state, loaded.last = kind, state_name, last
            loaded.controller.set_state(controller_state)
            self.controllers[name] = loaded
        self.hardware.set_state(hardware)
