"""`simkit explain` and the catalogue of codes: complete, formatted as a page, and every example causes its code."""

from __future__ import annotations

import contextlib
import io
import os
import re
import shlex
import subprocess
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli import app, diagnostic_catalogue
from simkit.cli.diagnostic_catalogue import Example, catalogue, code_text, page
from simkit.sensors.cameras.rendering import gl_context

ROOT = Path(__file__).resolve().parents[2]
CODE = re.compile(r"\bSK-[A-Z]+-\d{3}\b")
REPORT = re.compile(r"""(?:\.(warning|error|note)\(|"(warning|error|note)",)\s*"(SK-[A-Z]+-\d{3})\"""")
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


def sources() -> dict[Path, str]:
    """Return the text of every module."""
    files = [*ROOT.glob("simkit/**/*.py"), *ROOT.glob("packs/*/simkit_*/**/*.py")]
    return {path: path.read_text(encoding="utf-8") for path in files}


def codes_in_source() -> set[str]:
    """Return the codes in the text of every module."""
    return {code for text in sources().values() for code in CODE.findall(text)}


def area_of(code: str) -> str:
    return code.split("-")[1]


def test_the_catalogue_has_the_codes_of_the_source_and_no_others() -> None:
    assert set(catalogue()) == codes_in_source()


def test_a_code_is_reported_with_a_severity_of_its_entry() -> None:
    wrong = [
        f"{path.relative_to(ROOT)}: {method or argument} {code}"
        for path, text in sources().items()
        for method, argument, code in REPORT.findall(text)
        if (method or argument) not in catalogue()[code].severity
    ]
    assert not wrong


def test_the_page_has_a_row_and_a_heading_for_every_code_in_the_source() -> None:
    text = page()
    assert set(re.findall(r"^\| \[`(SK-[A-Z]+-\d{3})`\]", text, flags=re.MULTILINE)) == codes_in_source()
    assert set(re.findall(r"^### (SK-[A-Z]+-\d{3})$", text, flags=re.MULTILINE)) == codes_in_source()


def test_the_page_begins_with_files_and_has_every_area_once() -> None:
    titles = re.findall(r"^## (.+)$", page(), flags=re.MULTILINE)
    assert titles[0] == "Files"
    assert len(titles) == len(set(titles)) == len(set(map(area_of, catalogue())))


def test_python_m_prints_the_page() -> None:
    command = [sys.executable, "-m", "simkit.cli.diagnostic_catalogue"]
    printed = subprocess.run(command, capture_output=True, check=True, encoding="utf-8").stdout
    assert printed == page()


def test_every_file_holds_the_codes_of_its_own_area() -> None:
    files = [
        *ROOT.glob("simkit/cli/diagnostic_codes/*.toml"),
        *ROOT.glob("packs/*/simkit_*/cli/diagnostic_codes/*.toml"),
    ]
    for area in {path.stem for path in files}:
        found = catalogue(f"SK-{area.upper()}-")
        in_files = []
        for path in [path for path in files if path.stem == area]:
            codes = [name for name in tomllib.loads(path.read_text(encoding="utf-8")) if name.startswith("SK-")]
            assert codes == sorted(codes) and codes, path
            assert {area_of(code) for code in codes} == {area.upper()}
            in_files += codes
        assert list(found) == sorted(in_files)


def test_one_code_is_explained_from_the_file_of_its_area_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    read: list[str] = []
    loads = tomllib.loads
    diagnostic_catalogue._area.cache_clear()
    monkeypatch.setattr(tomllib, "loads", lambda text: read.append(text) or loads(text))
    assert list(catalogue("SK-SDF-004")) == ["SK-SDF-004"]
    assert len(read) == 1


def test_every_entry_is_complete() -> None:
    for code in catalogue().values():
        assert CODE.fullmatch(code.code)
        assert set(code.severity.split(", ")) <= SEVERITIES, code.code
        assert code.meaning and not code.meaning.endswith("."), code.code
        assert (code.example is None) == bool(code.without), code.code
        assert "|" not in code.meaning + code.helps, f"{code.code}: it would break the table"
        assert code_text(code).startswith(code.code)


@pytest.mark.leaves_out
@pytest.mark.parametrize("area", sorted(set(map(area_of, catalogue()))))
def test_every_example_of_an_area_causes_its_code(area: str, tmp_path: Path) -> None:
    wrong = {}
    for code in catalogue(f"SK-{area}-").values():
        if code.example is None or (code.code == "SK-RENDER-011" and not _has_opengl()):
            continue
        folder = tmp_path / code.code
        folder.mkdir()
        with pytest.MonkeyPatch.context() as monkeypatch:
            for name in PATHS:
                monkeypatch.delenv(name, raising=False)
            monkeypatch.chdir(folder)
            _write(code.example.files, folder)
            try:
                found = _RUNNERS[code.example.kind](code.example, monkeypatch)
            except Exception as error:
                error.add_note(f"in the example of {code.code}")
                raise
        severities = found.get(code.code)
        if severities and found.keys() & {"SK-LOAD-013", "SK-LOAD-014"} and code.severity == "error":
            severities = severities | {"error"}  # a sensor or plugin with errors is left out
        if severities is None or (severities and not severities & set(code.severity.split(", "))):
            wrong[code.code] = found
    assert not wrong


def _has_opengl() -> bool:
    try:
        gl_context.ensure_open()
    except simkit.RenderError:
        return False
    return True


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
    for part in ("SK-SDF-004 (error)", "help: the message suggests the closest name", "<parent>bsae</parent>"):
        assert part in text


def test_the_beginning_of_a_code_lists_all_that_begin_so() -> None:
    status, text, _ = simkit_explain("SK-PLUGIN")
    assert status == 0
    assert len(text.splitlines()) == sum(c.startswith("SK-PLUGIN") for c in catalogue())


def test_an_unknown_code_names_the_closest() -> None:
    status, _, text = simkit_explain("SK-SFD-004")
    assert status == 2
    assert "did you mean 'SK-SDF-" in text
