"""Exceptions that simkit raises on purpose.

SimkitError                 exit 1
├── InputError              exit 2   invalid input of the user
│   ├── ArgumentTypeError            an argument has another kind than expected; also a TypeError
│   ├── ArgumentValueError           an argument is out of range, NaN or infinite; also a ValueError
│   ├── LoadError                    a file has errors; `.diagnostics` lists all of them
│   │   └── InterfaceError           a definition of a message, service or action has errors
│   ├── MessageError                 a message does not fit its topic; NoMessageError is also a TypeError
│   ├── ServiceError                 a service is unknown, or its name is already used
│   ├── ActionError                  an action is unknown, or its name is already used
│   ├── ParameterError               a parameter is unknown, or its value is not allowed
│   └── TransformError               no pose of a frame in another; also a LookupError
├── SimulationDiverged      exit 3   the physics diverged
├── PluginError             exit 4   a plugin raised
├── PackError               exit 4   a command or a run part of another distribution cannot be used, or raised
├── SubscriberError         exit 4   a callback of a script raised
├── NodeError               exit 4   a program of `add_node` raised; the run went on to its end
├── RegressionError         exit 5   a regression check failed
├── RenderError             exit 2   there is no renderer, or it failed
└── InstallationError       exit 1   MuJoCo is missing, damaged, or has another version

SimkitDeprecationWarning is the class of all warnings about deprecated names.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence
from typing import ClassVar, Final

from simkit import hidden_text
from simkit.deprecation import SimkitDeprecationWarning as SimkitDeprecationWarning
from simkit.deprecation import warn_deprecated
from simkit.diagnostic_record import NOWHERE, Diagnostic, Where
from simkit.number_text import counted

if not hasattr(sys.modules["simkit"], "_DISTRIBUTION"):
    from simkit.name_conflict import conflict_error

    raise conflict_error()


def callback_name(callback: object) -> str:
    """Return the name of a callback with its file and line."""
    while hasattr(callback, "__wrapped__"):  # a wrapper that records or converts
        callback = callback.__wrapped__
    code = getattr(getattr(callback, "__func__", callback), "__code__", None)
    name = str(getattr(callback, "__qualname__", "") or type(callback).__name__)
    return f"{name!r} ({code.co_filename}:{code.co_firstlineno})" if code is not None else repr(name)


def cause_text(error: BaseException) -> str:
    """Return the text of an exception in a user's code: with its code if it is of simkit, else with its class."""
    if not isinstance(error, SimkitError):
        return repr(error)
    return str(error) if error.code in str(error) else f"{error.code} {error}"


_MOST_LISTED = 100  # problems in the text of a LoadError
_CODE: Final = re.compile(r"SK-[A-Z]+-\d{3}")


class SimkitError(Exception):
    """Base class of all errors that simkit raises on purpose.

    `SimkitError(code, message)` has the text `code message`. `SimkitError(message)` has the code of its class; only
    some classes put this code before the text.

    Args:
        code: stable code `SK-AREA-NNN`; without a message, the message.
        message: problem.
        help: what the user can do; a line of its own in the text.
        shows_code: False for a message that has the code already, such as after a place, or that needs none.

    Attributes:
        code: stable code `SK-AREA-NNN`.
        message: problem, without code and help.
        help: what the user can do.
    """

    exit_code: ClassVar[int] = 1
    code: str = "SK-CORE-001"
    _shows_class_code: ClassVar[bool] = False
    _lists_diagnostics: ClassVar[bool] = False  # their text is hidden already

    def __init__(self, code: str, message: str | None = None, *, help: str = "", shows_code: bool = True) -> None:
        if message is None:
            code, message, shows_code = self.code, code, self._shows_class_code
        elif _CODE.fullmatch(message) and not _CODE.fullmatch(code):
            name = type(self).__name__
            warn_deprecated(f"{name}(message, code)", f"{name}(code, message)", since="0.3")
            code, message, shows_code = message, code, False
        text = f"{code} {message}" if shows_code else message
        text += f"\n    help: {help}" if help else ""
        if not self._lists_diagnostics and hidden_text.hides(text):
            message, help = hidden_text.error_without_text(text), ""
            text = message
        super().__init__(text)
        self.code, self.message, self.help = code, message.removeprefix(code).lstrip(), help

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle the exception with all its attributes, independently of the arguments of its constructor."""
        return _restore_error, (type(self), self.args, vars(self))


def _restore_error(kind: type[SimkitError], args: tuple[object, ...], state: dict[str, object]) -> SimkitError:
    error = kind.__new__(kind, *args)
    vars(error).update(state)
    return error


class InputError(SimkitError):
    """Invalid input of the user."""

    exit_code: ClassVar[int] = 2

    code = "SK-INPUT-001"


def raise_together(errors: Sequence[InputError]) -> None:
    """Raise one error with the texts of all errors and the code of the first; do nothing if there is none."""
    if errors:
        raise InputError(errors[0].code, "\n".join(map(str, errors)), shows_code=False)


class ArgumentTypeError(InputError, TypeError):
    """Argument of a Python call that has another kind than the call expects."""

    code = "SK-INPUT-002"


class ArgumentValueError(InputError, ValueError):
    """Argument of a Python call that is NaN, infinite, out of range or of a wrong length."""

    code = "SK-INPUT-003"


class LoadError(InputError):
    """Errors in a file, found while the file was loaded.

    Attributes:
        diagnostics: every problem found in one pass, including warnings and notes.
    """

    _lists_diagnostics = True

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics: tuple[Diagnostic, ...] = tuple(diagnostics)
        errors = [d for d in self.diagnostics if d.severity == "error"] or list(self.diagnostics)
        lines = [str(d) for d in errors[:_MOST_LISTED]]
        if len(errors) > _MOST_LISTED:
            lines.append(f"and {counted(len(errors) - _MOST_LISTED, 'more problem')}; `diagnostics` has all of them")
        super().__init__(errors[0].code if errors else "SK-LOAD-001", "\n".join(lines), shows_code=False)


class InterfaceError(LoadError):
    """Errors in the definitions of messages, services and actions."""


class MessageError(InputError):
    """Message that does not fit the topic it is sent to."""

    code = "SK-MSG-001"


class NoMessageError(MessageError, TypeError):
    """Value that is neither a message nor a dict of a message's fields."""


class ServiceError(InputError):
    """Service that does not exist, or whose name is already used."""

    code = "SK-SERVICE-001"


class ActionError(InputError):
    """Action that does not exist or whose name is already used, or a goal that its controller cannot reach."""

    code = "SK-ACTION-001"


class ParameterError(InputError):
    """Live parameter that does not exist, or a value that the parameter does not accept."""

    code = "SK-PARAMETER-001"


class TransformError(InputError, LookupError):
    """Pose of a frame in another frame that is not known."""

    code = "SK-TF-001"


class SimulationDiverged(SimkitError):
    """Stop of a run whose physics diverged to NaN, infinite or unusable values.

    Attributes:
        joint: scoped name of the first joint (or free model) with an invalid value.
        time: simulated time of the first invalid step [s].
        hint: most frequent cause.
    """

    exit_code: ClassVar[int] = 3

    def __init__(self, joint: str, time: float, hint: str, engine_text: str = "") -> None:
        text = f"the simulation diverged at t={time:.6g} s in {joint!r}: {hint}"
        super().__init__("SK-PHYS-001", f"{text} [engine: {engine_text}]" if engine_text else text)
        self.joint, self.time, self.hint = joint, time, hint


class PluginError(SimkitError):
    """Exception in a plugin; the original exception is `__cause__`.

    Attributes:
        plugin: name of the plugin.
        time: simulated time [s].
    """

    exit_code: ClassVar[int] = 4

    def __init__(self, plugin: str, hook: str, time: float, where: str, reason: str) -> None:
        super().__init__("SK-PLUGIN-004", f"plugin {plugin!r} ({where}) raised in {hook} at t={time:.6g} s: {reason}")
        self.plugin, self.hook, self.time, self.where = plugin, hook, time, where


class NodeError(SimkitError):
    """Exceptions or exit codes that ended programs of `Simulation.add_node`; the first exception is `__cause__`.

    Args:
        failures: for each program, its name with the place and the text of its exception, or its exit code.
    """

    exit_code: ClassVar[int] = 4
    code = "SK-SCEN-010"

    def __init__(self, failures: Sequence[str]) -> None:
        super().__init__(self.code, "\n".join(f"node {failure}" for failure in failures))


class PackError(SimkitError):
    """Fault in a pack of another distribution that the command needs; an exception in its code is `__cause__`.

    Args:
        package: package of the pack.
        text: file, line and fault.
    """

    exit_code: ClassVar[int] = 4
    code = "SK-CLI-058"

    def __init__(self, package: str, text: str) -> None:
        super().__init__(self.code, f"package {package}: {text}")


class SubscriberError(SimkitError):
    """Exception in a callback of a script; the original exception is `__cause__`.

    Args:
        topic: name of the topic, service, action or parameter.
        callback: name of the callback, with its file and line.
        time: simulated time [s].
        reason: text of the exception.
        kind: what the callback answers, such as `service`; empty for a subscriber of a topic.

    Attributes:
        topic: name of the topic, service, action or parameter.
        callback: name of the callback, with its file and line.
        time: simulated time [s].
    """

    exit_code: ClassVar[int] = 4
    code = "SK-TOPIC-002"

    def __init__(self, topic: str, callback: str, time: float, reason: str, kind: str = "") -> None:
        subject = f"callback {callback} of {kind} {topic!r}" if kind else f"subscriber {callback} of {topic!r}"
        super().__init__(self.code, f"{subject} raised at t={time:.6g} s: {reason}")
        self.topic, self.callback, self.time = topic, callback, time


class RegressionError(SimkitError):
    """Difference between the outputs of a run and the golden outputs."""

    exit_code: ClassVar[int] = 5
    code = "SK-GOLDEN-001"


class RenderError(SimkitError):
    """Missing or failed renderer, in a run that needs images.

    Attributes:
        where: place of the camera in its file; empty if the error concerns no single camera.
    """

    exit_code: ClassVar[int] = 2

    code = "SK-RENDER-001"
    _shows_class_code = True

    def __init__(self, code: str, message: str | None = None, where: Where = NOWHERE) -> None:
        place = f" ({where})" if where.file else ""
        super().__init__(*((code + place,) if message is None else (code, message + place)))
        self.message, self.where = self.message.removesuffix(place), where


class InstallationError(SimkitError):
    """Missing or damaged package that simkit needs."""

    code = "SK-CORE-005"
    _shows_class_code = True
