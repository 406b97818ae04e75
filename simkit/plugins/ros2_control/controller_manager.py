"""The controller manager: loads, configures and switches controllers, and updates the active ones."""

from __future__ import annotations

import functools
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Literal

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.params import Params
from simkit.plugins.ros2_control.controller import Controller, ControllerEndpoints
from simkit.plugins.ros2_control.hardware import Hardware
from simkit.plugins.ros_parameter_files import ParameterFiles
from simkit.plugins.shared_by_copies import SharedByCopies
from simkit.registry import Kinds

if TYPE_CHECKING:
    from simkit.plugins.base import Plugin

GROUP: Final = "simkit.controllers"
_SECOND: Final = 1_000_000_000
KNOWN_PARAMETERS: Final[Mapping[str, Sequence[str]]] = tomllib.loads(
    Path(__file__).with_name("known_parameters.toml").read_text(encoding="utf-8")
)
"""Names of parameters that are no controller's own, by whose they are."""
State = Literal["unconfigured", "inactive", "active"]


@functools.cache
def controller_kinds() -> Mapping[str, type[Controller]]:
    """Every known controller class by each type name it answers to; computed once, read-only."""

    def names(cls: type[Controller]) -> tuple[str, ...]:
        own: tuple[str, ...] = vars(cls).get("types", ())  # what it inherits is the other's
        return own

    return Kinds("simkit.plugins.ros2_control.controllers", GROUP, Controller, names)  # type: ignore[type-abstract]


@dataclass(slots=True)
class LoadedController:
    """A controller with where it stands.

    Attributes:
        controller: itself.
        type: the name that the file gives its class.
        state: of its life cycle.
        last: simulated time of its last update [ns].
    """

    controller: Controller
    type: str
    state: State = "unconfigured"
    last: int = 0


class ControllerManager(SharedByCopies):
    """Runs the controllers of one robot.

    Args:
        plugin: the plugin that hosts it.
        hardware: what controllers claim.
        files: where parameters come from.
        name: of its node.
        diagnostics: where problems go while the simulation is being loaded.

    Attributes:
        namespace: of its node and those of its controllers, as the files have it.
        controllers: the loaded ones by name, in the order in which they were loaded.
        is_ros_1: whether its services speak as ROS 1's do.
    """

    def __init__(
        self, plugin: Plugin, hardware: Hardware, files: ParameterFiles, name: str, diagnostics: Diagnostics
    ) -> None:
        self.plugin, self.hardware, self.files, self.name = plugin, hardware, files, name
        self._diagnostics: Diagnostics | None = diagnostics
        self.namespace = plugin.ros.namespace
        self.controllers: dict[str, LoadedController] = {}
        self.is_ros_1 = False
        self._last_ns = 0
        self._endpoints: dict[str, ControllerEndpoints] = {}
        # the active ones in their order; None after a change
        self._active_controllers: list[tuple[LoadedController, Controller]] | None = None

    # ------------------------------------------------------------------ what the files say

    @property
    def node(self) -> str:
        """Full name of the node whose parameters declare the controllers: in ROS 1 that is the robot's namespace."""
        return self.namespace if self.is_ros_1 else f"{self.namespace}/{self.name}"

    def declared(self) -> dict[str, str]:
        """Controller -> type, as the files declare them, in their order."""
        found: dict[str, str] = {}
        own = self.files.of_node(self.node)
        for name, entry in (own.below or {}).items() if own is not None else ():
            kind = (entry.below or {}).get("type")
            if kind is not None and kind.text:
                found[name] = kind.text
        return found

    # ------------------------------------------------------------------ life cycle

    @property
    def reports(self) -> Diagnostics:
        """Diagnostics that problems go to: those of the load, later those of the run."""
        found: Diagnostics = self.plugin.sim.engine.reports if self._diagnostics is None else self._diagnostics
        return found

    def load(self, name: str) -> str:
        """Makes a controller of the type that the files declare; returns what is wrong, nothing where all is well."""
        if name in self.controllers:
            return f"a controller named '{name}' was already loaded inside the controller manager"
        kind = self.declared().get(name, "")
        if not kind:
            return f"the 'type' param was not defined for '{name}'"
        cls = controller_kinds().get(kind)
        if cls is None:
            kinds = controller_kinds()
            near = did_you_mean(kind, kinds) or "types: " + ", ".join(kinds)
            return f"controller '{name}' (type '{kind}') is not known; {near}"
        params = self._parameters(name)
        controller = cls(name, self.plugin, params, self.hardware)
        controller.endpoints = self._endpoints.setdefault(name, controller.endpoints)
        self.controllers[name] = LoadedController(controller, kind)
        return ""

    def _parameters(self, name: str) -> Params:
        found, entry = Diagnostics(), self.files.of_node(f"{self.namespace}/{name}")
        if entry is None:
            return Params(name, where=self.plugin.where, diagnostics=found)
        made = entry.params(name, found)
        return made[0] if made else Params(name, where=entry.where, diagnostics=found)

    def configure(self, name: str) -> str:
        """Has a controller read its parameters; returns what is wrong."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._not_found(name)
        if loaded.state == "active":
            return f"controller '{name}' can not be configured from '{loaded.state}' state"
        controller = loaded.controller
        params = controller.params
        before = params.diagnostics.error_count
        for word in KNOWN_PARAMETERS["controller"]:
            params.child(word)
        controller.update_rate = params.integer("update_rate", 0, minimum=0)
        controller.configure()
        commands, states = controller.command_interfaces(), controller.state_interfaces()
        if params.diagnostics.error_count == before:
            self._check_interfaces(controller, commands, self.hardware.commands.names, "command")
            self._check_interfaces(controller, states, self.hardware.states.names, "state")
        params.report_unread("SK-CONTROL-011", f"controller {name!r}")
        said = [d for d in params.diagnostics if d.severity == "error"]
        self.reports.extend(params.diagnostics)
        if params.diagnostics.error_count > before:
            return "; ".join(d.message for d in said)
        controller.states = self.hardware.states.select(states)
        controller.commands = self.hardware.commands.select(commands)
        loaded.state = "inactive"
        return ""

    def _check_interfaces(self, controller: Controller, names: Sequence[str], there: Sequence[str], what: str) -> None:
        for name in dict.fromkeys(names):
            if name not in there:
                near = did_you_mean(name, there) or ("there are: " + ", ".join(there) if there else "there are none")
                message = f"controller {controller.name!r} needs the {what} interface {name!r}, which is not there"
                controller.params.error("SK-CONTROL-012", message, near)

    def _not_found(self, name: str) -> str:
        near = did_you_mean(name, self.controllers)
        return f"could not find a controller named '{name}'" + (f"; {near}" if near else "")

    def conflicts(
        self, name: str, leaving: Iterable[str] = (), coming: Mapping[str, str] | None = None
    ) -> dict[str, str]:
        """Command interfaces of a controller whose joint another one drives: interface -> the other.

        Args:
            name: the controller.
            leaving: active controllers that are about to let go.
            coming: interfaces that others are about to claim, with who.
        """
        gone = set(leaving)
        owners = {one: who for one, who in self.hardware.owners.items() if who not in gone} | dict(coming or {})
        by_joint = {one.rpartition("/")[0]: who for one, who in owners.items() if who != name}
        needed = self.controllers[name].controller.command_interfaces()
        return {one: by_joint[joint] for one in needed if (joint := one.rpartition("/")[0]) in by_joint}

    def activate(self, name: str) -> None:
        """Gives a configured controller its interfaces."""
        loaded = self.controllers[name]
        names = loaded.controller.command_interfaces()
        self.hardware.claim(names, name)
        loaded.state, loaded.last = "active", self.plugin.sim.time_ns
        self._update_active()
        self.hardware.read()
        loaded.controller.activate()

    def _update_active(self) -> None:
        """Has the hardware read what the active controllers need."""
        self._active_controllers = None
        active = (c.controller for c in self.controllers.values() if c.state == "active")
        self.hardware.set_read_interfaces(name for controller in active for name in controller.states.names)

    def deactivate(self, name: str) -> None:
        """Takes its interfaces from an active controller."""
        loaded = self.controllers[name]
        loaded.controller.deactivate()
        self.hardware.release(name)
        loaded.state = "inactive"
        self._update_active()

    def switch(self, activate: Sequence[str], deactivate: Sequence[str], *, strict: bool) -> str:
        """Deactivates controllers, then activates others, all before the next update.

        Args:
            activate, deactivate: names.
            strict: whether nothing is switched where one of them cannot be; else it is left out.

        Returns:
            What is wrong; nothing where all is well.
        """
        problems: list[str] = []
        leaving = self._switchable(deactivate, "deactivate", "active", problems, leaving=())
        coming = self._switchable(activate, "activate", "inactive", problems, leaving=leaving)
        claims: dict[str, str] = {}
        for name in list(coming):
            taken = self.conflicts(name, leaving, claims)
            if taken:
                interface, owner = next(iter(taken.items()))
                problems.append(
                    f"resource conflict for controller '{name}': command interface '{interface}' is already claimed "
                    f"(by '{owner}')"
                )
                coming.remove(name)
            claims |= {one: name for one in self.controllers[name].controller.command_interfaces() if not taken}
        for problem in problems:
            self.reports.warning("SK-CONTROL-010", problem, self.plugin.where)
        wanted = bool(activate or deactivate)
        if problems and (strict or (wanted and not coming and not leaving)):
            return "; ".join(problems)
        for name in leaving:
            self.deactivate(name)
        for name in coming:
            self.activate(name)
        return ""

    def _switchable(
        self, names: Sequence[str], what: str, needed: State, problems: list[str], leaving: Sequence[str]
    ) -> list[str]:
        """Those that can be switched; what keeps the others from it goes to `problems`."""
        found = []
        for name in dict.fromkeys(names):
            loaded = self.controllers.get(name)
            if loaded is None:
                near = did_you_mean(name, self.controllers)
                missing = f"could not {what} controller '{name}' because no controller with this name exists"
                problems.append(f"{missing}; {near}" if near else missing)
            elif loaded.state == needed or (what == "activate" and name in leaving):
                found.append(name)
            else:
                already = "already active" if loaded.state == "active" else f"not in {needed} state"
                reason = already if what == "activate" else "not active"
                problems.append(f"could not {what} controller '{name}' since it is {reason}")
        return found

    def unload(self, name: str) -> str:
        """Forgets a controller; returns what is wrong."""
        loaded = self.controllers.get(name)
        if loaded is None:
            return self._not_found(name)
        if loaded.state == "active":
            return f"controller '{name}' is active; deactivate it before it is unloaded"
        loaded.controller.endpoints.close()
        del self.controllers[name]
        return ""

    # ------------------------------------------------------------------ at work

    def start(self, chosen: Sequence[str]) -> None:
        """Loads, configures and activates controllers in their order; what cannot be is told."""
        for name in chosen:
            where = self._declaration_place(name)
            problem = self.load(name)
            if problem:
                self.reports.warning("SK-CONTROL-013", f"{problem}; it is left out", where)
                continue
            if self.configure(name):
                continue  # its parameters say what is wrong
            taken = self.conflicts(name)
            if taken:
                message = ", ".join(f"{one!r} (of {who!r})" for one, who in taken.items())
                self.reports.note(
                    "SK-CONTROL-014",
                    f"controller {name!r} stays inactive: others that come first have {message}",
                    where,
                    "switch_controller changes over",
                )
                continue
            self.activate(name)
        self._diagnostics = None

    def _declaration_place(self, name: str) -> Where:
        own = self.files.of_node(self.node)
        entry = (own.below or {}).get(name) if own is not None else None
        return self.plugin.where if entry is None else entry.where

    def update(self, now_ns: int) -> None:
        """Reads the hardware, updates the active controllers, writes the commands."""
        self.hardware.read()
        if self._active_controllers is None:
            self._active_controllers = [(c, c.controller) for c in self.controllers.values() if c.state == "active"]
        for loaded, controller in self._active_controllers:
            if controller.update_rate and not self._is_due(loaded, now_ns):
                continue
            if loaded.state == "active":  # still: others may have switched it
                controller.update(now_ns, (now_ns - loaded.last) * 1e-9)
                loaded.last = now_ns
        self.hardware.write((now_ns - self._last_ns) * 1e-9)
        self._last_ns = now_ns

    def _is_due(self, loaded: LoadedController, now_ns: int) -> bool:
        rate = loaded.controller.update_rate
        return now_ns * rate // _SECOND > loaded.last * rate // _SECOND

    def get_state(self) -> object:
        """A copy of everything that changes as it runs."""
        hardware = self.hardware
        return (
            [(n, c, c.type, c.state, c.last, c.controller.get_state()) for n, c in self.controllers.items()],
            {name: dict(ends.handlers) for name, ends in self._endpoints.items()},
            self._last_ns,
            hardware.get_state(),
        )

    def set_state(self, state: Any) -> None:
        """Back to a state from `get_state`."""
        controllers, handlers, self._last_ns, hardware = state
        for name, ends in self._endpoints.items():
            ends.handlers = dict(handlers.get(name, {}))
        self.controllers, self._active_controllers = {}, None
        for name, loaded, kind, where, last, own in controllers:
            loaded.type, loaded.state, loaded.last = kind, where, last
            loaded.controller.set_state(own)
            self.controllers[name] = loaded
        self.hardware.set_state(hardware)
