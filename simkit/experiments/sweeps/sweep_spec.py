"""Specification of a sweep: a run, the design of its parameters, metrics and rules for what is kept."""

from __future__ import annotations

import functools
import hashlib
import json
import math
import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass, replace
from pathlib import Path
from types import CodeType, FunctionType, MethodType
from typing import Any, Final, Literal, cast

from simkit.argument_checks import shown
from simkit.errors import InputError
from simkit.experiments.sweeps.design import Design, SweepRow
from simkit.input_file import read_input
from simkit.packs import is_shipped
from simkit.run_spec import LoadOptions, RunSpec
from simkit.scene.overrides import override_texts, value_text
from simkit.testing.scenarios.readable_files import ReadableFiles

Metric = str | Callable[[Any], Any]
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
        is_warm: True if a worker resets its world between runs instead of loading it again; the results are the same.
    """

    run: RunSpec
    design: Design
    metrics: Mapping[str, Metric] = field(default_factory=dict)
    keep: Keep = 10
    bag_topics: tuple[str, ...] = ()
    is_warm: bool = True
    files: ReadableFiles | None = None

    def __post_init__(self) -> None:
        is_count = isinstance(self.keep, int) and not isinstance(self.keep, bool) and self.keep >= 0
        if not is_count and self.keep not in ("failed", "all"):
            text = f"keep: found {self.keep!r:.60}; expected 'failed', 'all', or a number of failed runs"
            raise InputError(f"{INVALID} {text}", INVALID)

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
            name: fill_template(one, variables) if isinstance(one, str) else one for name, one in self.metrics.items()
        }


def split_values(values: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the values of paths, and the values of variables, whose names are identifiers."""
    paths = {name: value for name, value in values.items() if not name.isidentifier()}
    return paths, {name: value for name, value in values.items() if name.isidentifier()}


# ---------------------------------------------------------------------- variables


def _fill(text: str, values: Mapping[str, Any]) -> str:
    """Replace `{name}` for known names; other braces stay, because messages and expressions may contain them."""
    for name, value in values.items():
        text = text.replace("{" + name + "}", value_text(value))
    return text


def fill_template(value: Any, variables: Mapping[str, Any]) -> Any:
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


_TEMPLATE_FIELDS: Final = ("overrides", "spawn", "until", "velocity")


def _substitute(spec: RunSpec, variables: Mapping[str, Any]) -> RunSpec:
    changes: dict[str, Any] = {
        name: _as_text(fill_template(getattr(spec, name), variables)) for name in _TEMPLATE_FIELDS
    }
    commands = tuple(fill_template(dict(command), variables) for command in spec.commands)
    checks = tuple(replace(one, expression=_as_text(fill_template(one.expression, variables))) for one in spec.checks)
    options: dict[str, Any] = dict(spec.options)
    arguments = options.get("xacro_args")
    if isinstance(arguments, Mapping):
        options["xacro_args"] = {name: _as_text(fill_template(one, variables)) for name, one in arguments.items()}
    return replace(spec, **changes, commands=commands, checks=checks, options=cast(LoadOptions, options))


def _as_text(value: Any) -> Any:
    if isinstance(value, tuple):
        return tuple(map(_as_text, value))
    return value_text(value) if isinstance(value, (bool, int, float, list)) else value


def used_variables(spec: SweepSpec) -> set[str]:
    """Return the names of the parameters that occur as `{name}` in the run specification or the metrics."""
    texts = json.dumps(plain_description((spec.run, dict(spec.metrics))))
    return {name for name in spec.design.names if "{" + name + "}" in texts}


# ---------------------------------------------------------------------- description


_PLACES: Final = ("file", "folder", "where", "code_requests")
"""Fields that say where a value stands, which differs between machines and working folders, or what is allowed."""


def plain_description(value: Any, seen: dict[int, tuple[int, Any]] | None = None) -> Any:
    """Return any value as plain data that is equal in all processes; functions are described by their names.

    Args:
        value: value to describe.
        seen: objects that are described already, by identity: their number, and the object itself, which thus lives on.
    """
    seen = {} if seen is None else seen
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Mapping):
        return {str(key): plain_description(item, seen) for key, item in value.items() if key != "where"}
    if isinstance(value, range) and len(value) > 1000:
        return repr(value)
    if isinstance(value, (set, frozenset)):
        return sorted((plain_description(item, seen) for item in value), key=repr)
    if isinstance(value, (list, tuple, range)):
        return [plain_description(item, seen) for item in value]
    if is_dataclass(value) and not isinstance(value, type):
        own = {f.name: plain_description(getattr(value, f.name), seen) for f in fields(value) if f.name not in _PLACES}
        return {"type": type(value).__name__, **own}
    if isinstance(value, Path):
        return str(value)
    if isinstance(value, functools.partial):
        return [plain_description(part, seen) for part in (value.func, value.args, value.keywords)]
    if hasattr(value, "tolist"):  # an array or a number of NumPy
        return value.tolist()
    if isinstance(value, MethodType):
        return [plain_description(value.__func__, seen), plain_description(value.__self__, seen)]
    name = getattr(value, "__qualname__", None)
    if isinstance(value, FunctionType):
        cells = [_cell_content(cell) for cell in value.__closure__ or ()]
        bound = plain_description([value.__defaults__, value.__kwdefaults__, *cells], seen)
        return [f"{value.__module__}.{name}", _code_hash(value.__code__), bound]
    if name:
        return f"{value.__module__}.{name} {getattr(value, 'content_hash', '')}".strip()
    return _object_description(value, seen)


def _object_description(value: Any, seen: dict[int, tuple[int, Any]]) -> Any:
    """Return the class of an object with the code of its methods, and its attributes; MuJoCo's objects have none."""
    if id(value) in seen:
        return f"again object {seen[id(value)][0]}"
    seen[id(value)] = len(seen), value
    kind = type(value)
    methods = [_code_hash(one.__code__) for _, one in sorted(vars(kind).items()) if isinstance(one, FunctionType)]
    attributes = {name: one for name, one in getattr(value, "__dict__", {}).items() if not name.startswith("__")}
    if is_shipped(kind):
        methods = []
    return [f"a {kind.__module__}.{kind.__qualname__}", methods, plain_description(attributes, seen)]


def _constant_text(value: object) -> str:
    return repr(sorted(map(repr, value))) if isinstance(value, frozenset) else repr(value)


def _cell_content(cell: Any) -> Any:
    try:
        return None if isinstance(cell.cell_contents, FunctionType) else cell.cell_contents
    except ValueError:  # a variable without a value
        return None


def _code_hash(code: CodeType) -> str:
    """Return a hash of a function's code that does not depend on its file and lines."""
    inner = [_code_hash(one) if isinstance(one, CodeType) else _constant_text(one) for one in code.co_consts]
    return hashlib.sha256(repr((code.co_code, inner, code.co_names)).encode()).hexdigest()[:16]


def _with_relative_folders(run: RunSpec) -> RunSpec:
    """Return a run whose plugin folders start from its own folder, so that `sweep replay` finds the same sweep."""
    if run.file is None or "plugin_paths" not in run.options:
        return run
    folders = [os.path.relpath(folder, run.folder) for folder in run.options["plugin_paths"]]
    return replace(run, options=cast(LoadOptions, {**run.options, "plugin_paths": folders}))


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
    _, variables = split_values(dict.fromkeys(spec.design.names))
    for name in variables:
        if name not in used:
            problems.append(
                f"{UNKNOWN_PARAMETER} the parameter {name!r} is not used\n    help: write a path with a dot, such as "
                f"tb3::wheel.inertial.mass, or use {{{name}}} in set, commands, until or a metric"
            )
    return problems


def raise_problems(problems: Sequence[str]) -> None:
    """Raise one error for messages that each begin with a code; none for no messages."""
    if problems:
        raise InputError("\n".join(problems), problems[0].partition(" ")[0])


def _duration_problems(duration: Any, has_end: bool) -> list[str]:
    """Return a message for a duration that is no number of seconds, or that never ends."""
    if not isinstance(duration, (int, float)) or isinstance(duration, bool) or not duration >= 0:
        return [f"{INVALID} duration: found {duration!r:.60}; expected a number of seconds of at least 0"]
    if math.isinf(duration) and not has_end:
        return [f"{INVALID} duration: found {duration!r}; an endless run needs until"]
    return []


def metric_problems(metrics: Any) -> list[str]:
    """Return a message for each metric that is neither an expression nor a function."""
    if not isinstance(metrics, Mapping):
        return [f"{INVALID} metrics: found {shown(metrics)}; expected a mapping of names to expressions or functions"]
    wrong = {name: one for name, one in metrics.items() if not (isinstance(one, str) or callable(one))}
    return [
        f"{INVALID} metric {name!r}: found {shown(one)}; expected an expression, or a function of the simulation"
        for name, one in wrong.items()
    ]


def spec_of_world(world: Any, duration: float | None, until: str) -> RunSpec:
    """Return the run specification of a world, or of a specification with another duration and end condition."""
    if getattr(duration, "shape", None) == ():  # a number of NumPy
        duration = cast(Any, duration).item()
    problems = [] if duration is None else _duration_problems(duration, bool(until or getattr(world, "until", "")))
    if not isinstance(world, (str, os.PathLike, RunSpec)):
        problems.append(f"{INVALID} world: found {shown(world)}; expected a file, a bare name, XML text or a RunSpec")
    raise_problems(problems)
    if isinstance(world, RunSpec):
        changes: dict[str, Any] = {} if duration is None else {"duration": duration, "timeout": None}
        if until:
            changes["until"] = until
        return replace(world, **changes)
    run = RunSpec(os.fspath(world), until=until, folder=Path.cwd())
    return run if duration is None else replace(run, duration=duration)


def sequence_of_seeds(seeds: int | Sequence[int] | range | None, default: int) -> tuple[int, ...] | range:
    """Return the seeds of a sweep: a number of seeds counts from 0.

    Raises:
        InputError: SK-SWEEP-001 a seed is negative, or there is none.
    """
    if seeds is None:
        return (default,)
    given: Any = seeds  # from YAML, or from a caller that does not check types
    found = range(given) if isinstance(given, int) and not isinstance(given, bool) and given < _MOST_SEEDS else given
    if isinstance(found, (str, bool)) or not hasattr(found, "__iter__"):
        found = [-1]
    listed = found if isinstance(found, range) else tuple(getattr(one, "__index__", lambda: -1)() for one in found)
    if not listed or min(listed[0], listed[-1]) < 0 or (not isinstance(listed, range) and min(listed) < 0):
        raise InputError(
            f"{INVALID} seeds: found {shown(seeds)}; expected a count, or whole numbers of at least 0", INVALID
        )
    return listed
