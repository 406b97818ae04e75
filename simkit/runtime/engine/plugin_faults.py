"""Handling of plugins that raise: an exception stops the run, or disables the plugin from then on.

`PluginFaults.guard` wraps every hook and callback of a plugin that is called during a run. A watcher on another thread
finds the active call in the stack (`active_plugin_calls`), so that the watcher does not slow down the calls.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from types import CodeType, FrameType, TracebackType
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast

from simkit.errors import InputError, InterfaceError, PluginError, SimkitError, SimulationDiverged, cause_text
from simkit.memory_error import find_memory_error
from simkit.run_spec import PluginErrorPolicy

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState
    from simkit.runtime.engine.entity_structure import AttachedPlugin, AttachedSensor, AttachedState, WorldStructure

R = TypeVar("R")

PLUGIN_ERROR_POLICIES: Final[tuple[PluginErrorPolicy, ...]] = ("stop", "disable")


@dataclass(frozen=True, slots=True)
class PluginCall:
    """Running hook or callback of a plugin.

    Attributes:
        plugin: plugin of the call.
        hook: name of the hook or callback.
        frame: stack frame of the call; every call has its own.
        line: file:line and function that are being executed.
    """

    plugin: AttachedPlugin
    hook: str
    frame: FrameType
    line: str


CallObserver = Callable[[object, str, Callable[[], object]], object]
"""Function that receives a plugin, the name of its hook or callback, and the call, and returns the call's result."""


class PluginFaults:
    """Caller of plugin code; keeps the set of disabled plugins.

    Args:
        engine: engine of the plugins.
        reschedule: function that is called when a plugin is disabled.
        on_error: policy of the user, with priority over files and classes; None uses theirs.
    """

    def __init__(
        self, engine: EngineState, reschedule: Callable[[], None], on_error: PluginErrorPolicy | None = None
    ) -> None:
        self._engine, self._reschedule, self.on_error = engine, reschedule, on_error
        self._disabled: dict[int, AttachedPlugin] = {}
        self._observers: list[CallObserver] = []
        self._tasks: dict[tuple[int, str], tuple[Callable[[], object], Callable[[int], None]]] = {}
        self._new_tasks: dict[tuple[int, str], tuple[Callable[[], object], Callable[[int], None]]] | None = None

    # ------------------------------------------------------------------ enabled plugins

    def is_disabled(self, plugin: AttachedPlugin) -> bool:
        """Check whether a plugin raised and is disabled."""
        return id(plugin) in self._disabled

    @property
    def disabled(self) -> tuple[AttachedPlugin, ...]:
        """Plugins that raised and are disabled."""
        return tuple(self._disabled.values())

    def living(self, structure: WorldStructure) -> list[AttachedSensor | AttachedPlugin]:
        """Return the sensors and plugins of a structure, without disabled plugins."""
        plugins = structure.all_plugins()
        return [*structure.all_sensors(), *(p for p in plugins if id(p) not in self._disabled)]

    def policy(self, plugin: AttachedPlugin) -> PluginErrorPolicy:
        """Return the error policy of a plugin: the policy of the user, else of the file, else of the plugin's class."""
        return self.on_error or plugin.on_error or "stop"

    # ------------------------------------------------------------------ calling

    def observe(self, observer: CallObserver) -> None:
        """Make all further calls of plugins through an observer, each plugin by a call of its own.

        Raises:
            ValueError: the calls have an observer already.
        """
        if self._observers:
            raise ValueError("the calls of plugins have an observer already")
        self._observers.append(observer)
        self._reschedule()

    @property
    def is_observed(self) -> bool:
        """True if an observer makes the calls, so that plugins are not called in groups."""
        return bool(self._observers)

    def guard(self, plugin: object, hook: str, method: Callable[..., R]) -> Callable[..., R | None]:
        """Wrap a hook or callback: its exceptions stop the run or disable the plugin.

        The wrapper of a disabled plugin does nothing and returns None.
        """
        disabled, observers, key = self._disabled, self._observers, id(plugin)

        def call(*values: object) -> R | None:
            if key in disabled:
                return None
            try:
                if observers:
                    return cast(R, observers[0](plugin, hook, partial(method, *values)))
                return method(*values)
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self.meet(plugin, hook, error)
                return None

        return call

    def begin_schedule(self) -> None:
        """Keep the tasks that are made from now on for the next schedule."""
        self._new_tasks = {}

    def end_schedule(self) -> None:
        """Forget the tasks that are not in the new schedule, such as those of removed plugins."""
        self._tasks, self._new_tasks = self._new_tasks or {}, None

    def task(self, plugin: object, hook: str) -> Callable[[int], None]:
        """Return a hook without arguments as a task of the scheduler.

        The next schedule gets the same task for the same hook, so that it is recognised as equal.
        """
        disabled, observers, key, method = self._disabled, self._observers, id(plugin), getattr(plugin, hook)
        known = self._tasks.get((key, hook))
        if known is not None and known[0] == method:
            if self._new_tasks is not None:
                self._new_tasks[key, hook] = known
            return known[1]

        def call(_: int = 0) -> None:
            if key in disabled:
                return
            try:
                if observers:
                    observers[0](plugin, hook, method)
                else:
                    method()
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self.meet(plugin, hook, error)

        if self._new_tasks is not None:
            self._new_tasks[key, hook] = method, call
        return call

    def meet(self, plugin: Any, hook: str, error: Exception) -> None:
        """Handle an exception of a plugin: stop the run or disable the plugin. Call it inside the `except` block.

        Raises:
            PluginError: the policy is "stop"; the exception is its `__cause__`.
            SimkitError: the exception itself, if the plugin did not cause it: the physics diverged, there is no
                renderer, another plugin stopped the run, or the definition of a type has errors.
        """
        if too_little := find_memory_error(error):
            raise too_little from error
        if isinstance(error, InterfaceError) or (isinstance(error, SimkitError) and not isinstance(error, InputError)):
            raise error
        if self.policy(plugin) == "stop":
            raise PluginError(plugin.name, hook, self._engine.time, str(plugin.where), cause_text(error)) from error
        if (
            isinstance(error, RecursionError)
            and sum(c.plugin is plugin for c in active_plugin_calls(sys._getframe())) > 1
        ):
            raise error  # the stack is full; the outermost call of the plugin handles it
        self.disable(plugin, hook, error)

    def state_of(self, plugin: AttachedPlugin) -> AttachedState:
        """Return the state of a plugin for a snapshot.

        The state is None if the plugin raises in `get_state` and is therefore disabled.
        """
        try:
            return call_plugin(plugin, "get_state", plugin.get_state)
        except Exception as error:  # noqa: BLE001 - a plugin may raise anything
            if not self.is_disabled(plugin):
                self.meet(plugin, "get_state", error)
        return None

    def take_back(self, plugin: AttachedPlugin, state: AttachedState) -> None:
        """Restore a plugin to a state from `state_of`."""
        if state is None:
            return
        try:
            call_plugin(plugin, "set_state", plugin.set_state, state)
        except Exception as error:  # noqa: BLE001 - a plugin may raise anything
            if not self.is_disabled(plugin):
                self.meet(plugin, "set_state", error)

    # ------------------------------------------------------------------ disabling

    def disable(self, plugin: AttachedPlugin, hook: str, error: BaseException) -> None:
        """Disable a plugin: stop calling its hooks, close its interfaces and release its servos."""
        engine = self._engine
        if id(plugin) in self._disabled:
            return
        self._disabled[id(plugin)] = plugin
        last = " ".join(traceback.format_exception_only(error)[-1].split())
        text = f"plugin {plugin.name!r} raised in {hook} at t={engine.time:.6g} s and is disabled from then on: {last}"
        line = innermost_frame(error.__traceback__)
        engine.reports.warning("SK-PLUGIN-020", text, plugin.where, f"raised at {line}" if line else "")
        engine.log.warning("%s: %s (%s)", plugin.where, text, line)
        self._apply()
        engine.callbacks.abandon(plugin, f"plugin {plugin.name!r} is disabled: {last}")
        release_servos(engine, plugin, self.is_disabled)
        self._reschedule()

    def _apply(self) -> None:
        self._engine.callbacks.set_active(self.living(self._engine.structure))

    # ------------------------------------------------------------------ state

    def get_state(self) -> tuple[AttachedPlugin, ...]:
        """Return the disabled plugins."""
        return tuple(self._disabled.values())

    def set_state(self, state: Iterable[AttachedPlugin]) -> None:
        """Restore a state from `get_state`; a plugin that raised since then is enabled again."""
        before = set(self._disabled)
        self._disabled.clear()
        self._disabled.update({id(plugin): plugin for plugin in state})
        if set(self._disabled) != before:
            self._apply()


def release_servos(engine: EngineState, plugin: AttachedPlugin, is_disabled: Callable[[AttachedPlugin], bool]) -> None:
    """Release the joints that a plugin's servos and motors hold; a restore or reset restores the servos and motors.

    A servo that another plugin shares stays, until that plugin is disabled as well.
    """
    present = {ref.name for record in engine.structure.builder.records.values() for ref in record.actuators}
    entry = engine.structure.entry_of(plugin)
    others = [p for p in engine.structure.all_plugins() if p is not plugin and not is_disabled(p)]
    shared = {ref for p in others if (other := engine.structure.entry_of(p)) is not None for ref in other.actuators}
    refs = [ref for ref in (() if entry is None else entry.actuators) if ref.name in present and ref not in shared]
    if refs:
        gains, biases = engine.touch("actuator_gainprm"), engine.touch("actuator_biasprm")
        for ref in refs:
            index = engine.names.actuator(ref)
            gains[index], biases[index] = 0.0, 0.0


def innermost_frame(trace: TracebackType | None) -> str:
    """Return file:line and function of the innermost frame of a traceback."""
    frames = traceback.extract_tb(trace)
    return f"{frames[-1].filename}:{frames[-1].lineno} in {frames[-1].name}" if frames else ""


def _guard_codes() -> frozenset[CodeType]:
    """Return the code objects of the functions that call plugins."""
    makers = (PluginFaults.guard.__code__, PluginFaults.task.__code__, call_plugin.__code__)
    inner = [c for code in makers[:2] for c in code.co_consts if isinstance(c, CodeType) and c.co_name == "call"]
    return frozenset((*inner, call_plugin.__code__))


def is_guarded(callback: object) -> bool:
    """Check whether a callback comes from `PluginFaults.guard`, so that its exceptions must propagate."""
    return getattr(callback, "__code__", None) in _guard_codes()


def call_plugin(plugin: object, hook: str, method: Callable[..., R], *values: object) -> R:  # noqa: ARG001 - `active_plugin_calls` reads
    """Call an unguarded function of a plugin (`prepare`, `load`), so that `active_plugin_calls` finds the call."""
    return method(*values)


def active_plugin_calls(frame: FrameType | None) -> list[PluginCall]:
    """Return the calls of plugins in a stack, the innermost first.

    Args:
        frame: innermost frame of the stack, such as an item of `sys._current_frames()`.
    """
    codes, calls, now = _guard_codes(), [], frame
    while frame is not None and now is not None:
        if frame.f_code in codes:
            line = f"{now.f_code.co_filename}:{now.f_lineno} in {now.f_code.co_name}"
            names = frame.f_locals
            if hasattr(names.get("plugin"), "where"):  # a service of user code has no plugin
                calls.append(PluginCall(names["plugin"], names["hook"], frame, line))
            now = frame.f_back
        frame = frame.f_back
    return calls


_MAX_EXPLANATIONS = 3


def add_driver_hints(plugins: Sequence[object], error: SimulationDiverged, commands: Sequence[str] = ()) -> None:
    """Add the explanations of plugins and the largest commands to a divergence error.

    A plugin explains with its method `explain_divergence(name) -> str`. The name is that of the diverged joint. If no
    plugin drives the joint, the name is that of the model.
    """
    hints = explanations(plugins, error.joint) or explanations(plugins, error.joint.split("::")[0])
    hints = [*commands, *hints]
    if hints:
        more = "; ".join(hints[:_MAX_EXPLANATIONS]) + (
            f"; and {len(hints) - _MAX_EXPLANATIONS} more" if len(hints) > _MAX_EXPLANATIONS else ""
        )
        error.hint = f"{error.hint}; {more}"
        error.args = (f"{error.args[0]}; {more}",)


def explanations(plugins: Sequence[object], name: str) -> list[str]:
    """Return the explanations of plugins that drive a joint or a model."""
    methods = (getattr(plugin, "explain_divergence", None) for plugin in plugins)
    return [text for explain in methods if explain is not None and (text := explain(name))]
