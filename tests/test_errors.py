"""Errors go from one process to another as they are."""

from __future__ import annotations

import pickle

import pytest

from simkit.diagnostics import Diagnostic
from simkit.errors import InputError, LoadError, PluginError, RenderError, SimkitError, SimulationDiverged

FOUND = Diagnostic("SK-XML-001", "error", "no end", "a.sdf", 3)


@pytest.mark.parametrize(
    "error",
    [
        InputError("no such file", "SK-CLI-016"),
        LoadError([FOUND]),
        SimulationDiverged("wheel", 0.5, "a stiff spring"),
        PluginError("brake", "after_step", 1.0, "a.sdf:3", "a division by zero"),
        RenderError("no display"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_error_is_the_same_after_pickling(error: SimkitError) -> None:
    arrived = pickle.loads(pickle.dumps(error))
    assert type(arrived) is type(error)
    assert (str(arrived), arrived.code, vars(arrived)) == (str(error), error.code, vars(error))
