"""Specification of a sweep: a run, the design of its parameters, metrics and rules for what is kept."""

from __future__ import annotations

import hashlib
import json
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from numbers import Integral
from pathlib import Path
from typing import Final, Generic, Literal, TypeGuard, TypeVar, cast

from simkit import RunSpec, Simulation
from simkit.argument_checks import shown
from simkit.errors import InputError
from simkit.extend import did_you_mean
from simkit.input_file import read_input
from simkit.run_spec import LoadOptions
from simkit.scene.overrides import override_texts, value_text
from simkit.testing.scenarios.readable_files import ReadableFiles
from simkit_learning.sweeps.design import SAMPLINGS, Design, Sampling, SweepRow
from simkit_learning.sweeps.parameter_space import Values
from simkit_learning.sweeps.plain_description import plain_description

Metric = str | Callable[[Simulation], object]
"""Expression of the condition language, or a Python function of the simulation."""
Keep = Literal["failed", "all"] | int
"""Runs whose bundle and bag are kept: all failed ones, all, or at most this number of failed ones."""

_LARGEST_WORLD: Final = 1 << 30  # [bytes]
INVALID: Final = "SK-SWEEP-001"
UNKNOWN_PARAMETER: Final = "SK-SWEEP-002"

_MOST_SEEDS: Final = 1 << 40
ROW_COLUMNS: Final = ("run", "seed")
"""Columns of a result table before the parameters."""
RESULT_COLUMNS: Final = ("exit_code", "status", "end", "code", "message", "time", "steps", "state_hash")
"""Columns of a result table after the metrics."""


Value = TypeVar("Value")


@dataclass(frozen=True)
class SweepOption(Generic[Value]):
    """Option of a sweep: an argument of `simkit.sweep`, a key of a sweep file, and perhaps an option of the command.

    Attributes:
        name: argument of `simkit.sweep`.
        key: key of a sweep file.
        default: value if it is not given.
        expected: allowed values, for messages.
        is_allowed: check of a value.
        words: words among the allowed values.
    """

    name: str
    key: str
    default: Value
    expected: str
    is_allowed: Callable[[object], bool]
    words: tuple[str, ...] = ()

    def allows(self, value: object) -> TypeGuard[Value]:
        """Check whether a value is allowed."""
        return self.is_allowed(value)

    def problems(self, value: object) -> list[str]:
        """Return a message for an argument that is not allowed."""
        if self.allows(value):
            return []
        hint = did_you_mean(str(value), self.words) or f"expected {self.expected}"
        return [f"{INVALID} {self.name}: found {shown(value)}; {hint}"]


def _is_whole(value: object, least: int) -> bool:
    return not isinstance(value, bool) and isinstance(value, Integral) and int(value) >= least


def _are_texts(value: object) -> bool:
    texts = [value] if isinstance(value, str) else value
    return isinstance(texts, (list, tuple)) and all(isinstance(text, str) and text.strip() for text in texts)


SAMPLES: Final = SweepOption[int | None](
    "samples", "samples", None, "a whole number of at least 1", lambda value: value is None or _is_whole(value, 1)
)
SAMPLING: Final = SweepOption[Sampling](
    "sampling", "sampling", "random", " or ".join(SAMPLINGS),
    lambda value: isinstance(value, str) and value in SAMPLINGS, SAMPLINGS,
)  # fmt: skip
DESIGN_SEED: Final = SweepOption[int](
    "design_seed", "design_seed", 0, "a whole number of at least 0", lambda value: _is_whole(value, 0)
)
KEEP: Final = SweepOption[Keep](
    "keep", "keep", 10, "failed, all, or a number of failed runs",
    lambda value: value in ("failed", "all") if isinstance(value, str) else _is_whole(value, 0), ("failed", "all"),
)  # fmt: skip
BAG_TOPICS: Final = SweepOption[str | Sequence[str]]("bag_topics", "bags", (), "a text or a list of texts", _are_texts)
SWEEP_OPTIONS: Final = (SAMPLES, SAMPLING, DESIGN_SEED, KEEP, BAG_TOPICS)
"""Options with a value of their own. Parameters, seeds and metrics have forms that differ between Python and files."""


@dataclass(frozen=True)
class SweepSpec:
    """Specification of a sweep.

    Parameters whose names contain a dot are paths of `--set`. Other names are variables: `{name}` in the texts of the
    run specification (overrides, commands, conditions, spawned models) and of the metrics is replaced by their values.

    Attributes:
        run: specification that all runs share.
        design: values and seeds of the runs.
        metrics: measurements at the end of each run by name.
        keep: runs whose bundle and bag are kept.
        bag_topics: patterns of the topics in the bags of kept runs; empty for no bags.
        files: check of the files that variables name, for the sweep of a file; None for a sweep made in Python.
        left_out: names of the sensors, plugins and controllers without which the world of the sweep runs, with their
            numbers; a run that lacks more than these fails. None before the world is loaded.
        is_warm: True if a worker resets its world between runs instead of loading it again; the results are the same.
    """

    run: RunSpec
    design: Design
    metrics: Mapping[str, Metric] = field(default_factory=dict)
    keep: Keep = KEEP.default
    bag_topics: tuple[str, ...] = ()
    is_warm: bool = True
    left_out: Mapping[str, int] | None = None
    files: ReadableFiles | None = None

    def __post_init__(self) -> None:
        raise_problems(KEEP.problems(self.keep))

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the result table."""
        return (*ROW_COLUMNS, *self.design.names, *self.metrics, *RESULT_COLUMNS)

    def fingerprint(self) -> str:
        """Return a hash of everything that decides the results, to recognise a stored sweep."""
        design = self.design
        content = {
            "run": plain_description(_with_relative_folders(self.run)),
            "world": _world_hash(self.run),
            "spaces": [[space.names, plain_description(space.description)] for space in design.spaces],
            "design": plain_description((design.seeds, design.samples, design.sampling, design.design_seed)),
            "listed": plain_description(design.listed),
            "metrics": {name: plain_description(metric) for name, metric in self.metrics.items()},
        }
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    def row_spec(self, row: SweepRow) -> RunSpec:
        """Return the specification of one run."""
        paths, variables = split_values(row.values)
        spec = replace(self.run, seed=row.seed)
        if variables:
            spec = _substitute(spec, variables)
            if self.files is not None:  # a variable can be the name of a model
                self.files.check(spec)
        return replace(spec, overrides=(*spec.overrides, *override_texts(paths)))

    def row_metrics(self, row: SweepRow) -> Mapping[str, Metric]:
        """Return the metrics of one run, with the values of variables."""
        _, variables = split_values(row.values)
        if not variables:
            return self.metrics
        return {
            name: _filled(metric, variables) if isinstance(metric, str) else metric
            for name, metric in self.metrics.items()
        }


def split_values(values: Values) -> tuple[Values, Values]:
    """Return the values of paths, and the values of variables, whose names are identifiers."""
    paths = {name: value for name, value in values.items() if not name.isidentifier()}
    return paths, {name: value for name, value in values.items() if name.isidentifier()}


# ---------------------------------------------------------------------- variables


def _fill(text: str, values: Values) -> str:
    """Replace `{name}` for known names; other braces stay, because messages and expressions may contain them."""
    for name, value in values.items():
        text = text.replace("{" + name + "}", value_text(value))
    return text


def fill_template(value: object, variables: Values) -> object:
    """Return plain data in which each `{name}` is replaced; a text that is only `{name}` becomes the value itself."""
    if isinstance(value, str):
        if value.startswith("{") and value.endswith("}") and value[1:-1] in variables:
            return variables[value[1:-1]]
        return _fill(value, variables)
    if isinstance(value, Mapping):
        return {key: fill_template(item, variables) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return type(value)(fill_template(item, variables) for item in value)
    return value


def _filled(template: str, variables: Values) -> str:
    return value_text(fill_template(template, variables))


def _substitute(spec: RunSpec, variables: Values) -> RunSpec:
    options: LoadOptions = {**spec.options}
    arguments = options.get("xacro_args")
    if isinstance(arguments, Mapping):
        options["xacro_args"] = {name: _filled(text, variables) for name, text in arguments.items()}
    return replace(
        spec,
        overrides=tuple(_filled(text, variables) for text in spec.overrides),
        spawn=tuple(_filled(model, variables) if isinstance(model, str) else model for model in spec.spawn),
        until=_filled(spec.until, variables),
        velocity=None if spec.velocity is None else _filled(spec.velocity, variables),
        commands=tuple(
            {key: fill_template(item, variables) for key, item in command.items()} for command in spec.commands
        ),
        checks=tuple(replace(check, expression=_filled(check.expression, variables)) for check in spec.checks),
        options=options,
    )


def used_variables(spec: SweepSpec) -> set[str]:
    """Return the names of the parameters that occur as `{name}` in the run specification or the metrics."""
    texts = json.dumps(plain_description((spec.run, dict(spec.metrics))))
    return {name for name in spec.design.names if "{" + name + "}" in texts}


def _with_relative_folders(run: RunSpec) -> RunSpec:
    """Return a run whose plugin folders start from its own folder, so that `sweep replay` finds the same sweep."""
    if run.file is None or "plugin_paths" not in run.options:
        return run
    folders = [os.path.relpath(folder, run.folder) for folder in run.options["plugin_paths"]]
    options: LoadOptions = {**run.options, "plugin_paths": folders}
    return replace(run, options=options)


def _world_hash(run: RunSpec) -> str:
    """Return a hash of the world's file; empty for a bundled world or XML text, which have no file of their own."""
    file = run.beside
    if file is None or not file.is_file():
        return ""
    return hashlib.sha256(read_input(file, _LARGEST_WORLD)).hexdigest()


def name_problems(spec: SweepSpec) -> list[str]:
    """Return a message for each column whose name is used twice, and for each variable that is not used."""
    problems: list[str] = []
    seen: set[str] = set()
    for name in spec.columns:
        if name in seen:
            problems.append(f"{INVALID} two columns of the table are named {name!r}: rename the parameter or metric")
        seen.add(name)
    used = used_variables(spec)
    for name in spec.design.names:
        if name.isidentifier() and name not in used:
            problems.append(
                f"{UNKNOWN_PARAMETER} the parameter {name!r} is not used\n    help: write a path with a dot, such as "
                f"tb3::wheel.inertial.mass, or use {{{name}}} in set, commands, until or a metric"
            )
    return problems


def raise_problems(problems: Sequence[str]) -> None:
    """Raise one error for messages that each begin with a code; none for no messages."""
    if problems:
        raise _error(problems)


def _error(problems: Sequence[str]) -> InputError:
    return InputError(problems[0].partition(" ")[0], "\n".join(problems), shows_code=False)


def _duration_problems(duration: object, has_end: bool) -> list[str]:
    """Return a message for a duration that is no number of seconds, or that never ends."""
    if not isinstance(duration, (int, float)) or isinstance(duration, bool) or not duration >= 0:
        return [f"{INVALID} duration: found {duration!r:.60}; expected a number of seconds of at least 0"]
    if math.isinf(duration) and not has_end:
        return [f"{INVALID} duration: found {duration!r}; an endless run needs until"]
    return []


def metric_problems(metrics: object) -> list[str]:
    """Return a message for each metric that is neither an expression nor a function."""
    if not isinstance(metrics, Mapping):
        return [f"{INVALID} metrics: found {shown(metrics)}; expected a mapping of names to expressions or functions"]
    wrong = {name: metric for name, metric in metrics.items() if not (isinstance(metric, str) or callable(metric))}
    return [
        f"{INVALID} metric {name!r}: found {shown(metric)}; expected an expression, or a function of the simulation"
        for name, metric in wrong.items()
    ]


def spec_of_world(world: object, duration: float | None, until: str) -> RunSpec:
    """Return the run specification of a world, or of a specification with another duration and end condition."""
    if (
        duration is not None and hasattr(duration, "item") and getattr(duration, "shape", None) == ()
    ):  # a number of NumPy
        duration = duration.item()
    problems = [] if duration is None else _duration_problems(duration, bool(until or getattr(world, "until", "")))
    if not isinstance(world, (str, os.PathLike, RunSpec)):
        problems.append(f"{INVALID} world: found {shown(world)}; expected a file, a bare name, XML text or a RunSpec")
    if problems or not isinstance(world, (str, os.PathLike, RunSpec)):
        raise _error(problems)
    if isinstance(world, RunSpec):
        run = world if duration is None else replace(world, duration=duration, timeout=None)
        return replace(run, until=until) if until else run
    run = RunSpec(os.fspath(world), until=until, folder=Path.cwd())
    return run if duration is None else replace(run, duration=duration)


def sequence_of_seeds(seeds: object, default: int) -> tuple[int, ...] | range:
    """Return the seeds of a sweep: a number of seeds counts from 0; None means the default.

    Raises:
        InputError: SK-SWEEP-001 a seed is negative, or there is none.
    """
    if seeds is None:
        return (default,)
    is_count = isinstance(seeds, int) and not isinstance(seeds, bool) and seeds < _MOST_SEEDS
    numbers = range(cast(int, seeds)) if is_count else seeds
    listed = numbers if isinstance(numbers, range) else _whole_numbers(numbers)
    if not listed or min(listed[0], listed[-1]) < 0 or (not isinstance(listed, range) and min(listed) < 0):
        raise InputError(INVALID, f"seeds: found {shown(seeds)}; expected a count, or whole numbers of at least 0")
    return listed


def _whole_numbers(values: object) -> tuple[int, ...]:
    """Return the items of a sequence as whole numbers, -1 for other items; empty for what is no sequence."""
    if isinstance(values, str) or not isinstance(values, Iterable):
        return ()
    return tuple(getattr(value, "__index__", lambda: -1)() for value in values)
