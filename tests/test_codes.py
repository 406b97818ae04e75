"""The catalogue of codes: complete, written out to its page, and every example brings its code about."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app
from simkit.codes import Code, Example, catalogue
from simkit.codes.page import explain, page

ROOT = Path(__file__).resolve().parents[1]
CODE = re.compile(r"\bSK-[A-Z]+-\d{3}\b")
SEVERITIES = {"error", "warning", "note", "stop"}
PATHS = (
    "SIMKIT_RESOURCE_PATH",
    "GZ_SIM_RESOURCE_PATH",
    "IGN_GAZEBO_RESOURCE_PATH",
    "SDF_PATH",
    "GAZEBO_MODEL_PATH",
    "ROS_PACKAGE_PATH",
    "AMENT_PREFIX_PATH",
    "TURTLEBOT3_MODEL",
)


def codes_in_source() -> set[str]:
    """Codes in the text of every module but the catalogue's own."""
    found: set[str] = set()
    for path in (ROOT / "simkit").rglob("*.py"):
        if "codes" not in path.relative_to(ROOT / "simkit").parts[:-1]:
            found |= set(CODE.findall(path.read_text(encoding="utf-8")))
    return found


def test_every_code_in_the_source_has_an_entry() -> None:
    assert codes_in_source() - set(catalogue()) == set()


def test_every_entry_is_in_the_source() -> None:
    assert set(catalogue()) - codes_in_source() == set()


def test_the_page_is_what_the_catalogue_says() -> None:
    """Written with `python -m simkit.codes > docs/diagnostics.md`."""
    assert (ROOT / "docs" / "diagnostics.md").read_text(encoding="utf-8") == page()


@pytest.mark.parametrize("code", catalogue().values(), ids=lambda c: c.code)
def test_an_entry_is_whole(code: Code) -> None:
    assert CODE.fullmatch(code.code)
    assert set(code.severity.split(", ")) <= SEVERITIES
    assert code.meaning and not code.meaning.endswith(".")
    assert (code.example is None) == bool(code.without)
    assert "|" not in code.meaning + code.helps, "it would break the table"
    assert explain(code).startswith(code.code)


@pytest.mark.parametrize("code", [c for c in catalogue().values() if c.example], ids=lambda c: c.code)
def test_the_example_brings_the_code_about(code: Code, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    example = code.example
    assert example is not None
    for name in PATHS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.chdir(tmp_path)
    _write(example.files, tmp_path)
    found = _RUNNERS[example.kind](example, monkeypatch)
    assert code.code in found
    severities = found[code.code]
    assert not severities or severities & set(code.severity.split(", ")), f"it came as {severities}"


def _write(files: Mapping[str, str | bytes], folder: Path) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)


def _check(example: Example, _monkeypatch: pytest.MonkeyPatch) -> dict[str, set[str]]:
    path = Path(f"example{example.suffix}")
    path.write_text(example.text, encoding="utf-8")
    return _severities(simkit.check(path))


def _severities(found: Any) -> dict[str, set[str]]:
    severities: dict[str, set[str]] = {}
    for d in found:
        severities.setdefault(d.code, set()).add(d.severity)
    return severities


def _command(example: Example, monkeypatch: pytest.MonkeyPatch) -> dict[str, set[str]]:
    words = shlex.split(example.text)
    while "=" in words[0]:
        monkeypatch.setenv(*words.pop(0).split("=", 1))
    assert words[0] == "simkit"
    result = CliRunner().invoke(app, words[1:], catch_exceptions=False)
    return {code: set() for code in CODE.findall(result.output)}


def _python(example: Example, _monkeypatch: pytest.MonkeyPatch) -> dict[str, set[str]]:
    printed, names = io.StringIO(), {"__name__": "__main__"}
    found: dict[str, set[str]] = {}
    with contextlib.redirect_stdout(printed):
        try:
            exec(compile(example.text, "example.py", "exec"), names)
        except simkit.SimkitError as error:
            found[error.code] = set()
    sim = names.get("sim")
    if isinstance(sim, simkit.Simulation):
        found.update(_severities(sim.diagnostics))
        sim.close()
    return found | {code: set() for code in CODE.findall(printed.getvalue())}


_RUNNERS = {"xml": _check, "command": _command, "python": _python}


def test_examples_of_paths_leave_the_environment_alone() -> None:
    assert "wafle" not in os.environ.get("TURTLEBOT3_MODEL", "")


def simkit_explain(*arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["explain", *arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def test_a_code_is_explained_with_its_example() -> None:
    status, text, _ = simkit_explain("sdf-004")
    assert status == 0
    for part in ("SK-SDF-004 (error)", "help: the closest name is given", "<parent>bsae</parent>"):
        assert part in text


def test_the_beginning_of_a_code_lists_all_that_begin_so() -> None:
    status, text, _ = simkit_explain("SK-PLUGIN")
    assert status == 0
    assert len(text.splitlines()) == sum(c.startswith("SK-PLUGIN") for c in catalogue())


def test_an_unknown_code_names_the_closest() -> None:
    status, _, text = simkit_explain("SK-SFD-004")
    assert status == 2
    assert "did you mean 'SK-SDF-" in text
