"""Metrics of a run: expressions of the condition language and Python functions of the simulation."""

from __future__ import annotations

import hashlib
import inspect
import math
from collections.abc import Callable, Generator, Mapping
from functools import partial
from importlib import import_module, util
from pathlib import Path
from types import ModuleType, TracebackType
from typing import Final

from simkit import Simulation
from simkit.diagnostics import shorten
from simkit.errors import InputError, SimkitError
from simkit.extend import did_you_mean
from simkit.input_file import read_input
from simkit.linked_files import hide_linked_text
from simkit.testing.conditions.binder import bind_value
from simkit.testing.conditions.bound_expression import BoundNode
from simkit.testing.conditions.syntax_tree import UndecidedValue
from simkit.testing.conditions.value_types import NUMBER, TEXT, TRUTH
from simkit.testing.conditions.world_view import WorldView
from simkit_learning.sweeps.parameter_space import Scalar
from simkit_learning.sweeps.sweep_spec import Metric

_LARGEST_FILE: Final = 64 << 20  # [bytes]
METRIC_FAILED: Final = "SK-SWEEP-004"


class MetricError(SimkitError):
    """Python function of a metric that raised, or that returned no number, text, true or false."""

    exit_code = 4
    code = METRIC_FAILED


class RunMetrics:
    """Metrics of one run; a context manager around the run.

    A function is called at the end of the run. The code of a generator function up to its first `yield` is executed
    before the run, and the second `yield` gives the value, so that the function can subscribe to topics.

    Args:
        sim: simulation at the start of the run.
        metrics: metrics by name.

    Raises:
        InputError: expressions have errors; the message lists all of them.
    """

    def __init__(self, sim: Simulation, metrics: Mapping[str, Metric]) -> None:
        self._sim = sim
        self._view = WorldView(sim)
        self._metrics = metrics
        self._parts: dict[str, BoundNode] = {}
        self._generators: dict[str, Generator[object, None, None]] = {}
        problems = []
        for name, metric in metrics.items():
            if isinstance(metric, str):
                try:
                    self._parts[name] = bind_value(metric, self._view, (NUMBER, TEXT, TRUTH), "the metric")
                except InputError as error:
                    problems.append((f"metric {name!r}: {error}", error.code))
        if problems:
            raise InputError(problems[0][1], "\n".join(text for text, _ in problems), shows_code=False)

    def __enter__(self) -> RunMetrics:
        self._before = set(map(id, self._sim.communication.bus.subscriptions()))
        self._view.open()
        try:
            for name, metric in self._metrics.items():
                if inspect.isgeneratorfunction(metric):
                    generator = metric(self._sim)
                    self._call(name, partial(next, generator))
                    self._generators[name] = generator
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._view.close()
        for generator in self._generators.values():
            generator.close()
        for subscription in self._sim.communication.bus.subscriptions():  # a function may leave its subscriptions open
            if id(subscription) not in self._before:
                subscription.close()

    def values(self) -> dict[str, Scalar]:
        """Return the values at the present time; NaN for an expression whose value is unknown.

        Raises:
            MetricError: a function failed.
        """
        return {name: self._value(name, metric) for name, metric in self._metrics.items()}

    def _value(self, name: str, metric: Metric) -> Scalar:
        if isinstance(metric, str):
            try:
                return _plain(name, self._parts[name].get())
            except UndecidedValue:
                return math.nan
        if name in self._generators:
            return _plain(name, self._call(name, partial(next, self._generators[name])))
        return _plain(name, self._call(name, lambda: metric(self._sim)))

    def _call(self, name: str, function: Callable[[], object]) -> object:
        try:
            return function()
        except SimkitError:
            raise
        except StopIteration:
            text = "the generator function ended before its second `yield`, which gives the value"
            raise MetricError(METRIC_FAILED, f"metric {name!r}: {text}") from None
        except Exception as error:
            raise MetricError(METRIC_FAILED, f"metric {name!r} raised {type(error).__name__}: {error}") from error


def _plain(name: str, value: object) -> Scalar:
    """Return a value of a metric as a plain number, text, or true or false; None becomes NaN."""
    if hasattr(value, "item") and getattr(value, "size", 1) == 1:
        value = value.item()
    if value is None:
        return math.nan
    if isinstance(value, (bool, int, float, str)):
        return value
    expected = "expected a number, a text, true or false"
    raise MetricError(METRIC_FAILED, f"metric {name!r} returned {shorten(repr(value), 60)}; {expected}")


def metric_function(text: str, folder: Path) -> Callable[[Simulation], object]:
    """Return the function that `file.py:function` or `package.module:function` names.

    Args:
        text: name of the function.
        folder: folder that relative paths of files start from.

    Raises:
        InputError: SK-SWEEP-005 the file or function does not exist, or the file cannot be imported.
    """
    source, colon, name = text.rpartition(":")
    if not colon or not source:
        raise _no_function(text, "write file.py:function or package.module:function")
    try:
        module = _file_module(folder / source) if source.endswith(".py") else import_module(source)
    except (ImportError, OSError) as error:
        raise _no_function(text, str(error)) from None
    except Exception as error:  # noqa: BLE001 - the file may raise anything
        raise _no_function(text, f"importing it raised {type(error).__name__}: {error}") from None
    function = getattr(module, name, None)
    if not callable(function):
        known = [key for key, value in vars(module).items() if callable(value) and not key.startswith("_")]
        raise _no_function(text, did_you_mean(name, known) or f"{source} has no function {name!r}")
    return function  # type: ignore[no-any-return]  # a function of the user


def _file_module(path: Path) -> ModuleType:
    """Import a Python file and return its module."""
    spec = util.spec_from_file_location(f"simkit_sweep_{path.stem}", path)
    if spec is None or spec.loader is None or not path.is_file():
        raise ImportError(f"there is no file {path}")
    hide_linked_text(path)
    module = util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def _no_function(text: str, reason: str) -> InputError:
    return InputError("SK-SWEEP-005", f"cannot use the function {text!r}: {reason}")


def _content_hash(function: Callable[[Simulation], object]) -> str:
    """Return a hash of the file that a function is from; empty if it has no Python file."""
    file = inspect.getsourcefile(inspect.unwrap(function)) if hasattr(function, "__code__") else None
    return "" if file is None else hashlib.sha256(read_input(Path(file), _LARGEST_FILE)).hexdigest()


class FileMetric:
    """Metric whose function is in a file; it can be sent to other processes, which read the file there.

    Args:
        text: `file.py:function` or `package.module:function`.
        folder: folder that relative paths start from.

    Attributes:
        fingerprint_text: name and hash of the file's content, so that a stored sweep is not continued with another
            function. The name of this class is the one that it had when the first sweeps were stored.
    """

    def __init__(self, text: str, folder: Path) -> None:
        self._text, self._folder = text, folder
        self.function = metric_function(text, folder)
        name = f"simkit.experiments.sweeps.metrics.{text}"
        self.fingerprint_text = f"{name} {_content_hash(self.function)}".strip()
        self.__wrapped__ = self.function  # tells `inspect` whether it is a generator function

    def __call__(self, sim: Simulation) -> object:
        """Return the value of the metric."""
        return self.function(sim)

    def __reduce__(self) -> tuple[type[FileMetric], tuple[str, Path]]:
        return FileMetric, (self._text, self._folder)
