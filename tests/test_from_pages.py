"""Pages docs/from and docs/troubleshooting.md: each command, name, element and code in them exists."""

from __future__ import annotations

import ast
import functools
import inspect
import re
import shlex
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

import simkit
from simkit.cli import app
from simkit.cli.diagnostic_catalogue import catalogue
from simkit.sensors.base import Sensor

ROOT = Path(__file__).resolve().parents[1]
TROUBLESHOOTING = (ROOT / "docs" / "troubleshooting.md").read_text("utf-8")
PAGES = sorted((ROOT / "docs" / "from").glob("*.md"))
OBJECTS: dict[str, Any] = {
    "simkit": simkit,
    "sim": simkit.Simulation,
    "model": simkit.Model,
    "joint": simkit.Joint,
    "link": simkit.Link,
    "sensor": Sensor,
    "plugin": simkit.ModelPlugin,
    "params": simkit.Params,
}
PATHS = re.findall(r"^\| `([^`@]+)", (ROOT / "docs/elements.md").read_text("utf-8"), re.MULTILINE)
ELEMENTS = {re.sub(r"\[\w+\]", "", name) for path in PATHS for name in path.split("/")}
GAZEBOS_OPTIONS = {"-r", "-s", "--headless-rendering"}
SENSORS = set(re.findall(r"^\| \[`(\w+)`", (ROOT / "docs/sensors/index.md").read_text("utf-8"), re.MULTILINE))


def cells(text: str) -> Iterator[tuple[str, bool]]:
    """Yield each code span of the tables right of their first column, and whether its column is that of simkit."""
    columns: list[str] = []
    for line in text.splitlines():
        if not line.startswith("|"):
            columns = []
            continue
        row = [cell.strip() for cell in line.strip("|").split("|")]
        columns = columns or row
        for title, cell in list(zip(columns, row, strict=True))[1:]:
            for span in re.findall(r"`([^`]+)`", cell):
                yield span, "simkit" in title


SPANS = [
    pytest.param(span, is_simkit, id=f"{page.stem}: {span}")
    for page in PAGES
    for span, is_simkit in dict.fromkeys(cells(page.read_text("utf-8")))
]


@functools.cache
def root_command() -> Any:
    return typer.main.get_command(app)


def unknown_options(words: list[str]) -> list[str]:
    """Return the options in the words of a command line that its command does not have; fail for an unknown command."""
    command = root_command()
    context = command.context_class(command, info_name="simkit")
    while words and hasattr(command, "list_commands"):
        assert words[0] in command.list_commands(context), words
        command = command.get_command(context, words.pop(0))
        command = getattr(command, "real", command)
    options = {name for parameter in command.params for name in parameter.opts}
    own = words[: words.index("--ros-args")] if "--ros-args" in words else words
    return [word for word in own if re.match(r"--?[a-z]", word) and word not in options]


def check_python(code: str) -> None:
    """Fail if an expression on an object of simkit names an attribute or an argument that does not exist."""
    for node in ast.walk(ast.parse(code, mode="eval")):
        call = node if isinstance(node, ast.Call) else None
        chain = ast.unparse(call.func if call else node) if call or isinstance(node, ast.Attribute) else ""
        if not re.fullmatch(r"(\w+)(\.\w+)+", chain) or chain.startswith("sim.mj_data."):
            continue
        first, *rest = chain.split(".")
        found = OBJECTS[first]
        is_method = inspect.isclass(found)
        for name in rest:
            assert hasattr(found, name), f"{found} has no {name}"
            found = inspect.getattr_static(found, name) if first != "simkit" else getattr(found, name)
        if call:
            own: list[Any] = [None] if is_method else []
            keywords = {keyword.arg: None for keyword in call.keywords if keyword.arg}
            inspect.signature(found).bind(*own, *call.args, **keywords)


@pytest.mark.needs_packs
@pytest.mark.parametrize(("span", "is_simkit"), SPANS)
def test_a_name_of_simkit_in_the_tables_exists(span: str, is_simkit: bool) -> None:
    if span.startswith("simkit "):
        assert unknown_options(shlex.split(span)[1:]) == []
    elif re.match(r"--?[a-z]", span) and (is_simkit or span not in GAZEBOS_OPTIONS):
        assert unknown_options(["run", *shlex.split(span)]) == []
    elif re.match(rf"({'|'.join(OBJECTS)})\.", span):
        check_python(span)
    elif names := re.findall(r"^<(?:simkit:)?(\w+)", span):
        assert set(names) <= ELEMENTS or not is_simkit
    elif re.match(r"lib\w|gz-|ignition-", span) and len(span) > 4:
        plugin = f'<plugin filename="{span}" name="plugin"/>'
        model = f'<model name="robot"><link name="base"/>{plugin}</model>'
        found = simkit.check(f'<sdf version="1.9"><world name="hall">{plugin}{model}</world></sdf>')
        assert "SK-PLUGIN-001" not in {problem.code for problem in found}
    elif is_simkit:
        assert span in SENSORS, "no command, option, element, plugin, sensor or expression of simkit"


@pytest.mark.needs_packs
@pytest.mark.parametrize("span", sorted(set(re.findall(r"`((?:simkit |--)[^`]+)`", TROUBLESHOOTING))))
def test_a_command_of_the_page_of_symptoms_exists(span: str) -> None:
    words = shlex.split(span)
    assert unknown_options(words[1:] if words[0] == "simkit" else ["run", *words]) == []


@pytest.mark.needs_packs
def test_the_codes_of_the_page_of_symptoms_exist() -> None:
    codes = set(re.findall(r"SK-[A-Z]+-\d{3}", TROUBLESHOOTING))
    assert len(codes) > 20
    assert codes <= set(catalogue())


@pytest.mark.needs_packs
def test_the_check_finds_wrong_names() -> None:
    assert unknown_options(["run", "--fast", "--seed", "1"]) == ["--fast"]
    with pytest.raises(AssertionError):
        unknown_options(["topic", "listen"])
    with pytest.raises(AssertionError):
        check_python("sim.steps(3)")
    with pytest.raises(TypeError):
        check_python('simkit.load("a.sdf", speed=2)')
    with pytest.raises(AssertionError):
        test_a_name_of_simkit_in_the_tables_exists("libgazebo_ros_diff_drivee.so", is_simkit=True)
