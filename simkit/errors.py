"""Everything simkit raises on purpose.

SimkitError                 exit 1
├── InputError              exit 2   the user's input cannot be used
│   ├── LoadError                    a file has errors; `.diagnostics` has all of them
│   ├── MessageError                 a message does not fit its topic
│   ├── ServiceError                 no such service, or it cannot be offered
│   ├── ActionError                  no such action, or it cannot be offered
│   └── ParameterError               no such parameter, or a value it does not take
├── SimulationDiverged      exit 3   the physics left the numbers
├── PluginError             exit 4   a plugin raised
├── SubscriberError         exit 4   a subscriber of a topic raised
├── RegressionError         exit 5   a regression check failed
└── RenderError             exit 1   no renderer, or it failed
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from simkit.diagnostic_record import Diagnostic


class SimkitError(Exception):
    """Base of every error that simkit raises on purpose."""

    exit_code: ClassVar[int] = 1
    code: str = "SK-CORE-001"

    def __reduce__(self) -> tuple[Any, ...]:
        """Goes from one process to another whole, whatever its constructor takes."""
        return _restore_error, (type(self), self.args, vars(self))


def _restore_error(kind: type[SimkitError], args: tuple[Any, ...], state: dict[str, Any]) -> SimkitError:
    error = kind.__new__(kind, *args)
    vars(error).update(state)
    return error


class InputError(SimkitError):
    """What the user gave cannot be used.

    Attributes:
        code: stable code `SK-AREA-NNN`.
    """

    exit_code: ClassVar[int] = 2

    code = "SK-INPUT-001"

    def __init__(self, message: str, code: str = "") -> None:
        super().__init__(message)
        self.code = code or self.code


class LoadError(InputError):
    """A file could not be loaded.

    Attributes:
        diagnostics: every problem found in one pass, errors and others.
    """

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics: tuple[Diagnostic, ...] = tuple(diagnostics)
        errors = [d for d in self.diagnostics if d.severity == "error"] or list(self.diagnostics)
        super().__init__("\n".join(str(d) for d in errors), errors[0].code if errors else "SK-LOAD-001")


class MessageError(InputError):
    """A message does not fit the topic it is sent to."""

    code = "SK-MSG-001"


class ServiceError(InputError):
    """A service is not there, or is there already."""

    code = "SK-SERVICE-001"


class ActionError(InputError):
    """An action is not there, is there already, or a goal cannot go where it is told to."""

    code = "SK-ACTION-001"


class ParameterError(InputError):
    """A live parameter is not there, or does not take a value."""

    code = "SK-PARAMETER-001"


class SimulationDiverged(SimkitError):
    """The physics left the range of numbers and the run was stopped.

    Attributes:
        joint: scoped name of the first joint (or free model) with a bad value.
        time: simulated time of the first bad step [s].
        hint: what most often causes this.
    """

    exit_code: ClassVar[int] = 3

    def __init__(self, joint: str, time: float, hint: str, engine_text: str = "") -> None:
        text = f"SK-PHYS-001 the simulation diverged at t={time:.6g} s in {joint!r}: {hint}"
        super().__init__(f"{text} [engine: {engine_text}]" if engine_text else text)
        self.code = "SK-PHYS-001"
        self.joint, self.time, self.hint = joint, time, hint


class PluginError(SimkitError):
    """A plugin raised; the original exception is `__cause__`.

    Attributes:
        plugin: the plugin's name.
        time: simulated time [s].
    """

    exit_code: ClassVar[int] = 4

    def __init__(self, plugin: str, hook: str, time: float, where: str, reason: str) -> None:
        super().__init__(f"SK-PLUGIN-004 plugin {plugin!r} ({where}) raised in {hook} at t={time:.6g} s: {reason}")
        self.code = "SK-PLUGIN-004"
        self.plugin, self.hook, self.time, self.where = plugin, hook, time, where


class SubscriberError(SimkitError):
    """A subscriber's callback raised; the original exception is `__cause__`.

    Attributes:
        topic: that it subscribes to.
        callback: its name, and where it stands.
        time: simulated time [s].
    """

    exit_code: ClassVar[int] = 4
    code = "SK-TOPIC-002"

    def __init__(self, topic: str, callback: str, time: float, reason: str) -> None:
        super().__init__(f"{self.code} subscriber {callback} of {topic!r} raised at t={time:.6g} s: {reason}")
        self.topic, self.callback, self.time = topic, callback, time


class RegressionError(SimkitError):
    """Recorded outputs differ from the golden ones."""

    exit_code: ClassVar[int] = 5
    code = "SK-GOLDEN-001"


class RenderError(SimkitError):
    """No usable renderer, or it failed."""

    def __init__(self, message: str, code: str = "SK-RENDER-001") -> None:
        super().__init__(f"{code} {message}")
        self.code = code
