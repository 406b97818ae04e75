"""Plugin that runs a system written for gz-sim: an object or a module with `configure`, `pre_update`, `update`, …."""

from __future__ import annotations

import copy
import threading
import types
from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from typing import TYPE_CHECKING, Any, Final

from simkit import Params
from simkit.plugins.adapters import SystemPlugin, user_code_line
from simkit.plugins.joint_states import JointStatePublisher
from simkit_gz_python import import_hook, simulation_context
from simkit_gz_python.sdformat import Element
from simkit_gz_python.sim.entity_table import WORLD_ENTITY
from simkit_gz_python.sim.system_hub import EventManager, hub_of

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit_gz_python.sim.entity_component_manager import EntityComponentManager

System = Any
"""Object or module of a user with some of the hooks."""

_MODULE = (types.ModuleType, types.FunctionType, types.BuiltinFunctionType, type)

_STATELESS: Final = (type(threading.Lock()), type(threading.RLock()), types.ModuleType)
"""Types of attributes without a state to restore: modules, and locks, because simkit calls systems in one thread."""


class GzSystem(SystemPlugin):
    """Plugin that runs a system of Gazebo. The state of the plugin is the state of the system.

    Args:
        system: Object or module with some of the hooks; None if a subclass finds it in `find_system`.

    Attributes:
        system: Object with the hooks; None before `load`.
        shadow: True if simkit's `gz` modules take precedence over installed ones.
    """

    simulator = "gz"
    hooks = ("configure", "pre_update", "update", "post_update", "reset", "shutdown")
    factories = ("get_system",)
    is_gz_system = True
    shadow = False

    def __init__(self, system: System = None) -> None:
        super().__init__(system)
        self.system: System = None
        self._calls: dict[str, Callable[..., None]] = {}
        # names of attributes that cannot be copied, so that snapshots do not contain them
        self._outside: set[str] = set()
        self._hub: Any = None  # state shared by all systems of the simulation

    # ------------------------------------------------------------------ simkit's hooks

    def find_system(self) -> System:
        """Return the system to run; None after a reported error."""
        return self._initial_system if self.wrapped_system is None else self.system_of(self.wrapped_system)

    def code_objects(self) -> tuple[object, ...]:
        return (self,) if self.system is None else (self.system, self)

    def importing(self) -> AbstractContextManager[None]:
        return import_hook.importable(self.shadow)

    def load(self, parent: object, params: Params) -> None:
        self._hub = hub_of(self.sim)
        self._hub.ecm.published = _joint_state_publishers
        before, hook = simulation_context.enter_simulation(self.sim, self), "get_system"
        try:
            with self.importing():
                self.system = self.find_system()
                methods = {hook: getattr(self.system, hook, None) for hook in self.hooks}
                self._calls = {hook: call for hook, call in methods.items() if callable(call)}
                hook = "configure"
                if hook in self._calls:
                    entity = _entity_of(self._hub.ecm, parent)
                    self._calls[hook](entity, Element(params), self._hub.ecm, EventManager())
        except Exception as error:  # noqa: BLE001 - a user's system may raise anything
            self.sim.engine.faults.meet(self, f"{hook}{user_code_line(error)}", error)
        finally:
            simulation_context.leave_simulation(before)

    def before_step(self) -> None:
        if "pre_update" in self._calls:
            self.call("pre_update", self._hub.info(1))

    def update_step(self) -> None:
        """Call `update` after all `before_step` hooks; the last system then executes the commands of all systems."""
        if "update" in self._calls:
            self.call("update", self._hub.info(1))
        self._hub.look()
        if self is self._hub.last:
            self._hub.carry_out()

    def after_step(self) -> None:
        if "post_update" in self._calls:
            self.call("post_update", self._hub.info(0))

    def reset(self) -> None:
        if "reset" in self._calls:
            self.call("reset", self._hub.info(0))

    def close(self) -> None:
        if "shutdown" in self._calls:
            self.call("shutdown")

    def call(self, hook: str, *info: object) -> None:
        """Call a hook of the system if it exists; exceptions are reported as faults of this plugin.

        Args:
            hook: Name of the hook.
            *info: `UpdateInfo` of the step; omitted for `shutdown`.
        """
        method = self._calls.get(hook)
        if method is None:
            return
        before = simulation_context.enter_simulation(self.sim, self)
        import_hook.enter(self.shadow)
        try:
            method(*info, *((self._hub.ecm,) if info else ()))
        except Exception as error:  # noqa: BLE001 - a user's system may raise anything
            self.sim.engine.faults.meet(self, f"{hook}{user_code_line(error)}", error)
        finally:
            import_hook.leave()
            simulation_context.leave_simulation(before)

    # ------------------------------------------------------------------ state

    def get_state(self) -> dict[str, object]:
        """Return the system's attributes (a module's variables), each copied separately.

        The state of the first system also contains the entities.
        """
        if self._hub is None:
            return {}  # the plugin was never loaded
        memo: dict[int, object] = {id(self): self, id(self.system): self.system}
        state: dict[str, object] = {}
        for name, value in _variables(self.system).items():
            if isinstance(value, _STATELESS):
                self._outside.add(name)
                continue
            try:
                state[name] = copy.deepcopy(value, memo)
            except Exception as error:  # noqa: BLE001 - a foreign object may raise anything when copied
                self._report_uncopied(name, error)
        self._hub.look()
        shared = self._hub.ecm.get_state() if self is self._hub.first or self._hub.first is None else None
        return {"variables": state, "entities": shared}

    def set_state(self, state: Mapping[str, Any]) -> None:
        """Restore a state from `get_state`.

        Attributes that the system added later are deleted. Attributes that cannot be copied keep their values.
        """
        if not state:
            return
        memo: dict[int, object] = {id(self): self, id(self.system): self.system}
        saved, variables = copy.deepcopy(dict(state["variables"]), memo), getattr(self.system, "__dict__", {})
        for name in [n for n in _variables(self.system) if n not in saved and n not in self._outside]:
            del variables[name]
        variables.update(saved)
        if state["entities"] is not None:
            self._hub.ecm.set_state(state["entities"])

    def _report_uncopied(self, name: str, error: Exception) -> None:
        if name not in self._outside:
            self._outside.add(name)
            attribute = f"plugin {self.name!r}: attribute {name!r}"
            message = f"{attribute} cannot be copied, so snapshots and resets do not restore it: {error}"
            self.sim.engine.reports.warning("SK-PLUGIN-006", message, self.where, "add __deepcopy__ to its class")


def _variables(system: object) -> dict[str, object]:
    """Return the state of a system: an object's attributes, or a module's variables that hold data."""
    variables = getattr(system, "__dict__", {})
    if not isinstance(system, types.ModuleType):
        return dict(variables)
    return {n: v for n, v in variables.items() if not (n.startswith("__") or isinstance(v, _MODULE))}


def _joint_state_publishers(sim: Simulation) -> frozenset[str]:
    plugins = sim.engine.structure.all_plugins()
    return frozenset(name for p in plugins if isinstance(p, JointStatePublisher) for name in p.joint_names)


def _entity_of(ecm: EntityComponentManager, parent: object) -> int:
    """Return the entity number of a plugin's parent in the entity-component manager."""
    scoped = getattr(parent, "scoped", "")
    if not scoped:
        return WORLD_ENTITY
    kind = type(parent).__name__.lower()
    kinds = (kind,) if kind in ("model", "visual") else ("sensor",)
    return next((r.entity for r in ecm.sync() if r.kind in kinds and r.scene.scoped == scoped), WORLD_ENTITY)
