"""Scenario files in Python: they are run, and have a `scenario`."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from simkit.diagnostics import Diagnostics, Where
from simkit.errors import LoadError
from simkit.scenario.document import beside, shown
from simkit.scenario.scenario import Scenario
from simkit.scenario.validity import problems_of


def scenario_of_python(file: Path, diagnostics: Diagnostics) -> Scenario:
    """The `scenario` of a Python file, which is run.

    Raises:
        LoadError: SK-SCEN-001 there is no such file; SK-SCEN-005 it failed, or has no scenario; SK-SCEN-003 for
            every value of it that is not of those that are allowed.
    """
    where = Where(str(file))
    problem: Callable[..., None] = diagnostics.error
    found: Any = None
    spec = importlib.util.spec_from_file_location(f"simkit_scenario_{file.stem}", file)
    if spec is None or spec.loader is None or not file.is_file():
        problem("SK-SCEN-001", "cannot be read: no such file", where)
        raise LoadError(tuple(diagnostics))
    module = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:
        line = _line_in(error, file)
        problem("SK-SCEN-005", f"running it failed: {type(error).__name__}: {error}", Where(str(file), line))
        raise LoadError(tuple(diagnostics)) from error
    found = getattr(module, "scenario", None)
    if not isinstance(found, Scenario):
        hint = "from simkit.scenario import Scenario; scenario = Scenario(world=..., duration=...)"
        problem("SK-SCEN-005", f"'scenario' is {shown(found)}, allowed is a Scenario", where, hint)
        raise LoadError(tuple(diagnostics))
    for message in problems_of(found):
        problem("SK-SCEN-003", message, where)
    diagnostics.raise_if_errors()
    folder = file.parent if found.folder == Path() else found.folder
    return replace(found, folder=folder, file=file, spawn=tuple(beside(folder, one) for one in found.spawn))


def _line_in(error: BaseException, file: Path) -> int | None:
    """The last line of a file that an error came through."""
    if isinstance(error, SyntaxError) and error.filename == str(file):
        return error.lineno
    line, trace = None, error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename == str(file):
            line = trace.tb_lineno
        trace = trace.tb_next
    return line
