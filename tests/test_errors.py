"""Errors go from one process to another as they are."""

from __future__ import annotations

import pickle
import re
from pathlib import Path

import pytest

import simkit.errors
from simkit.diagnostic_record import Where
from simkit.diagnostics import Diagnostic
from simkit.errors import InputError, LoadError, PluginError, RenderError, SimkitError, SimulationDiverged

FOUND = Diagnostic("SK-XML-001", "error", "no end", "a.sdf", 3)


@pytest.mark.parametrize(
    "error",
    [
        InputError("SK-CLI-016", "no such file"),
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


@pytest.mark.parametrize(
    ("error", "text", "code"),
    [
        (InputError("SK-CLI-016", "no such file"), "SK-CLI-016 no such file", "SK-CLI-016"),
        (InputError("SK-CLI-016", "no file", help="write it"), "SK-CLI-016 no file\n    help: write it", "SK-CLI-016"),
        (InputError("SK-NAME-002", "link 'a' was removed", shows_code=False), "link 'a' was removed", "SK-NAME-002"),
        (InputError("no such file"), "no such file", "SK-INPUT-001"),
        (RenderError("no display"), "SK-RENDER-001 no display", "SK-RENDER-001"),
        (
            RenderError("SK-RENDER-002", "no image", Where("w.sdf", 3)),
            "SK-RENDER-002 no image (w.sdf:3)",
            "SK-RENDER-002",
        ),
    ],
)
def test_an_error_writes_its_code_before_its_message(error: SimkitError, text: str, code: str) -> None:
    assert (str(error), error.code) == (text, code)


def test_an_error_has_its_message_and_its_help_apart() -> None:
    error = InputError("SK-CLI-016", "no file", help="write it")
    assert (error.message, error.help) == ("no file", "write it")
    assert InputError("SK-CLI-014", "SK-CLI-014 a\nSK-CLI-014 b", shows_code=False).message == "a\nSK-CLI-014 b"


def test_the_tables_of_exit_codes_have_the_codes_of_the_errors() -> None:
    errors = {kind.__name__: kind.exit_code for kind in vars(simkit.errors).values() if _is_error(kind)}
    tree = re.findall(r"(\w+) +exit (\d)", simkit.errors.__doc__ or "")
    assert {name: errors[name] for name, _ in tree} == {name: int(code) for name, code in tree}
    page = (Path(__file__).parents[1] / "docs" / "ci.md").read_text("utf-8").partition("## Exit codes")[2]
    listed = re.findall(r"^\| ([\d, ]+) \|", page.partition("\n## ")[0], re.MULTILINE)
    signals = [128 + 1, 128 + 2, 128 + 15]  # SIGHUP, SIGINT, SIGTERM
    assert [int(code) for codes in listed for code in codes.split(",")] == sorted({0, *errors.values(), *signals})


def _is_error(value: object) -> bool:
    return isinstance(value, type) and issubclass(value, SimkitError)
