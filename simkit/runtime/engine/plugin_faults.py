"""What becomes of a plugin that raises: it stops the run, or it is left out from then on.

Everything of a plugin that is called while the run goes, hooks and callbacks, is called through `PluginFaults.guard`.
Who watches from another thread finds what is being called in the stack (`active_plugin_calls`), so that watching costs
nothing.
"""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from types import CodeType, FrameType, TracebackType
from typing import TYPE_CHECKING, Any, Final, Protocol, TypeVar

from simkit.errors import InputError, PluginError, SimkitError, SimulationDiverged
from simkit.run_spec import PluginErrorPolicy

if TYPE_CHECKING:
    from simkit.runtime.engine.engine_state import EngineState
    from simkit.runtime.engine.entity_structure import AttachedPlugin, AttachedSensor, AttachedState, WorldStructure

R = TypeVar("R")

PLUGIN_ERROR_POLICIES: Final[tuple[PluginErrorPolicy, ...]] = ("stop", "disable")


@dataclass(frozen=True, slots=True)
class PluginCall:
    """A plugin's hook or callback that is at work.

    Attributes:
        plugin: whose.
        hook: which, in words.
        frame: its frame, another for another call.
        line: file:line where it is now, and the function.
    """

    plugin: AttachedPlugin
    hook: str
    frame: FrameType
    line: str


class PluginInterfaces(Protocol):
    """Topics, services, actions and parameters of plugins."""

    def set_active(self, owners: Sequence[object]) -> None:
        """Leaves only what these plugins and sensors opened in use."""

    def abandon(self, owner: object, reason: str) -> None:
        """Ends what a plugin is at work on for others."""


class PluginFaults:
    """Calls what plugins are made of, and knows which of them are left out.

    Args:
        engine: whose plugins.
        reschedule: called when a plugin is left out.
        on_error: what the user asked for, which goes over what files and classes say; None leaves it to them.

    Attributes:
        interfaces: what plugins have opened.
    """

    interfaces: PluginInterfaces

    def __init__(
        self, engine: EngineState, reschedule: Callable[[], None], on_error: PluginErrorPolicy | None = None
    ) -> None:
        self._engine, self._reschedule, self.on_error = engine, reschedule, on_error
        self._disabled: dict[int, AttachedPlugin] = {}

    # ------------------------------------------------------------------ who is at work

    def is_disabled(self, plugin: AttachedPlugin) -> bool:
        """Whether a plugin raised and is left out."""
        return id(plugin) in self._disabled

    def living(self, structure: WorldStructure) -> list[AttachedSensor | AttachedPlugin]:
        """The sensors and plugins of a structure, without the plugins that are left out."""
        plugins = structure.all_plugins()
        return [*structure.all_sensors(), *(p for p in plugins if id(p) not in self._disabled)]

    def policy(self, plugin: AttachedPlugin) -> PluginErrorPolicy:
        """What becomes of this plugin when it raises: what the user asked for, else the file, else the class."""
        return self.on_error or plugin.on_error or "stop"

    # ------------------------------------------------------------------ calling

    def guard(self, plugin: object, hook: str, method: Callable[..., R]) -> Callable[..., R | None]:
        """A hook or callback as something to call: what it raises stops the run, or takes the plugin out of it.

        Of a plugin that is left out it does nothing and gives None.
        """
        disabled, key = self._disabled, id(plugin)

        def call(*values: object) -> R | None:
            if key in disabled:
                return None
            try:
                return method(*values)
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self.meet(plugin, hook, error)
                return None

        return call

    def task(self, plugin: object, hook: str) -> Callable[[int], None]:
        """A hook without arguments as a task of the scheduler."""
        disabled, key, method = self._disabled, id(plugin), getattr(plugin, hook)

        def call(_: int = 0) -> None:
            if key in disabled:
                return
            try:
                method()
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self.meet(plugin, hook, error)

        return call

    def meet(self, plugin: Any, hook: str, error: Exception) -> None:
        """Stops the run, or goes on without the plugin; to be called while the exception is being handled.

        Raises:
            PluginError: the run is to stop; the exception is its `__cause__`.
            SimkitError: the exception itself, where it is not of the plugin's making: the physics diverged, there is
                no renderer, another plugin stopped the run.
        """
        if isinstance(error, SimkitError) and not isinstance(error, InputError):
            raise error
        if self.policy(plugin) == "stop":
            raise PluginError(plugin.name, hook, self._engine.time, str(plugin.where), repr(error)) from error
        if (
            isinstance(error, RecursionError)
            and sum(c.plugin is plugin for c in active_plugin_calls(sys._getframe())) > 1
        ):
            raise error  # there is no room left to do anything in; the outermost call of it meets it again
        self.disable(plugin, hook, error)

    def state_of(self, plugin: AttachedPlugin) -> AttachedState:
        """What a snapshot keeps of a plugin; None of one that raised over it and is left out."""
        try:
            return call_plugin(plugin, "get_state", plugin.get_state)
        except Exception as error:  # noqa: BLE001 - a plugin may raise anything
            if not self.is_disabled(plugin):
                self.meet(plugin, "get_state", error)
        return None

    def take_back(self, plugin: AttachedPlugin, state: AttachedState) -> None:
        """Brings a plugin back to what `state_of` gave."""
        if state is None:
            return
        try:
            call_plugin(plugin, "set_state", plugin.set_state, state)
        except Exception as error:  # noqa: BLE001 - a plugin may raise anything
            if not self.is_disabled(plugin):
                self.meet(plugin, "set_state", error)

    # ------------------------------------------------------------------ leaving out

    def disable(self, plugin: AttachedPlugin, hook: str, error: BaseException) -> None:
        """Leaves a plugin out from now on: no hook of it runs, nothing it opened is there, its servos let go."""
        engine = self._engine
        if id(plugin) in self._disabled:
            return
        self._disabled[id(plugin)] = plugin
        last = " ".join(traceback.format_exception_only(error)[-1].split())
        text = f"plugin {plugin.name!r} raised in {hook} at t={engine.time:.6g} s and is left out from then on: {last}"
        place = innermost_frame(error.__traceback__)
        engine.reports.warning("SK-PLUGIN-020", text, plugin.where, f"raised at {place}" if place else "")
        engine.log.warning("%s: %s (%s)", plugin.where, text, place)
        self._apply()
        self.interfaces.abandon(plugin, f"plugin {plugin.name!r} is left out: {last}")
        release_servos(engine, plugin)
        self._reschedule()

    def _apply(self) -> None:
        self.interfaces.set_active(self.living(self._engine.structure))

    # ------------------------------------------------------------------ state

    def get_state(self) -> tuple[AttachedPlugin, ...]:
        """Who is left out."""
        return tuple(self._disabled.values())

    def set_state(self, state: Iterable[AttachedPlugin]) -> None:
        """Back to a state from `get_state`: a plugin that raised since is at work again."""
        before = set(self._disabled)
        self._disabled.clear()
        self._disabled.update({id(plugin): plugin for plugin in state})
        if set(self._disabled) != before:
            self._apply()


def release_servos(engine: EngineState, plugin: AttachedPlugin) -> None:
    """Lets go of the joints that a plugin's servos and motors hold; snapshots and reset bring them back."""
    there = {ref.name for record in engine.structure.builder.records.values() for ref in record.actuators}
    refs = [ref for ref in plugin._actuators if ref.name in there]
    if refs:
        gains, biases = engine.touch("actuator_gainprm"), engine.touch("actuator_biasprm")
        for ref in refs:
            index = engine.names.actuator(ref)
            gains[index], biases[index] = 0.0, 0.0


def innermost_frame(trace: TracebackType | None) -> str:
    """Where a traceback ends: file:line and function."""
    frames = traceback.extract_tb(trace)
    return f"{frames[-1].filename}:{frames[-1].lineno} in {frames[-1].name}" if frames else ""


def _guard_codes() -> frozenset[CodeType]:
    """Of the functions through which plugins are called."""
    makers = (PluginFaults.guard.__code__, PluginFaults.task.__code__, call_plugin.__code__)
    inner = [c for code in makers[:2] for c in code.co_consts if isinstance(c, CodeType) and c.co_name == "call"]
    return frozenset((*inner, call_plugin.__code__))


def is_guarded(callback: object) -> bool:
    """Whether it is of `Faults.guard`: what still comes out of it is to go on upwards."""
    return getattr(callback, "__code__", None) in _guard_codes()


def call_plugin(plugin: object, hook: str, method: Callable[..., R], *values: object) -> R:  # noqa: ARG001 - `active_plugin_calls` reads
    """Calls something of a plugin that is not guarded (`prepare`, `load`), so that `active_plugin_calls` finds it."""
    return method(*values)


def active_plugin_calls(frame: FrameType | None) -> list[PluginCall]:
    """The calls of plugins in a stack, the innermost first; none where no plugin is at work.

    Args:
        frame: the innermost frame of the stack, such as `sys._current_frames()` gives of a thread.
    """
    codes, found, now = _guard_codes(), [], frame
    while frame is not None and now is not None:
        if frame.f_code in codes:
            line = f"{now.f_code.co_filename}:{now.f_lineno} in {now.f_code.co_name}"
            names = frame.f_locals
            if hasattr(names.get("plugin"), "where"):  # not a service that nobody's plugin offers
                found.append(PluginCall(names["plugin"], names["hook"], frame, line))
            now = frame.f_back
        frame = frame.f_back
    return found


_MAX_EXPLANATIONS = 3


def add_driver_hints(plugins: Sequence[object], error: SimulationDiverged) -> None:
    """Adds to the error what plugins have to do with it.

    Those are asked that have a method `explain_divergence(name) -> str`: with the joint where it happened, and where
    none of them drives that, with the model.
    """
    found = _explanations(plugins, error.joint) or _explanations(plugins, error.joint.split("::")[0])
    if found:
        more = "; ".join(found[:_MAX_EXPLANATIONS]) + (
            f"; and {len(found) - _MAX_EXPLANATIONS} more" if len(found) > _MAX_EXPLANATIONS else ""
        )
        error.hint = f"{error.hint}; {more}"
        error.args = (f"{error.args[0]}; {more}",)


def _explanations(plugins: Sequence[object], name: str) -> list[str]:
    asked = (getattr(plugin, "explain_divergence", None) for plugin in plugins)
    return [text for explain in asked if explain is not None and (text := explain(name))]
