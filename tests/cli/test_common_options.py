"""Options that every command has: `-q`, `-v`, `--json`, and the variable NO_COLOR."""

from __future__ import annotations

import json
import shlex
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import typer

from simkit.cli import app

BALL = """<sdf version="1.9"><world name="w"><model name="ball"><pose>0 0 5 0 0 0</pose><link name="body">
  <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
  <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry>
    <surface><friction><ode><mu>100</mu><mu2>100</mu2></ode></friction></surface></collision></link></model></world></sdf>"""


def leaves(command: Any, context: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield each command with its full name."""
    command = getattr(command, "real", command)
    if not hasattr(command, "commands"):
        yield name.strip(), command
        return
    for each in command.list_commands(context):
        yield from leaves(command.get_command(context, each), context, f"{name} {each}")


ROOT = typer.main.get_command(app)
CONTEXT = ROOT.make_context("simkit", [], resilient_parsing=True)
LEAVES = dict(leaves(ROOT, CONTEXT))

STREAMS = {"topic echo", "topic hz", "topic bw", "topic delay", "log", "tf echo", "topic pub"}
"""Commands whose values come over time: each line is one JSON value."""


@pytest.mark.parametrize("name", LEAVES)
def test_every_command_has_the_common_options(name: str) -> None:
    context = LEAVES[name].make_context(name, ["--help"], resilient_parsing=True)
    given = {word for each in LEAVES[name].get_params(context) for word in each.opts}
    assert {"-q", "--quiet", "-v", "--verbose", "--json"} <= given


@pytest.mark.parametrize("name", LEAVES)
def test_a_usage_error_of_every_command_is_one_json_object(
    name: str, tmp_path: Path, simkit_line: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("NO_COLOR", "1")
    result = simkit_line(*name.split(), "--json", "--no-such-option-at-all")
    assert "\x1b" not in result.stdout + result.stderr
    report = json.loads(result.stdout)
    assert report["exit_code"] == result.exit_code == 2


FLOATS = [
    (name, option.opts[0])
    for name, command in LEAVES.items()
    for option in command.get_params(command.make_context(name, ["--help"], resilient_parsing=True))
    if option.type.name in ("float", "float range") and option.opts[0].startswith("--")
]


@pytest.mark.parametrize(("name", "option"), FLOATS)
def test_no_number_of_an_option_is_nan(name: str, option: str, simkit_line: Callable[..., Any]) -> None:
    result = simkit_line(*name.split(), option, "nan")
    assert result.exit_code == 2
    assert "found nan; expected" in result.stdout + result.stderr or "'nan' is not a" in result.stdout + result.stderr


@pytest.mark.parametrize("line", ["golden record empty -o out", "plot empty /clock.clock"])
def test_a_run_that_must_end_has_a_finite_duration(line: str, simkit_line: Callable[..., Any]) -> None:
    result = simkit_line(*line.split(), "--duration", "inf")
    assert result.exit_code == 2
    assert "SK-INPUT-003 duration must be a finite number [s]" in result.stderr


LINES = """
check w.sdf
check w.sdf --score
convert w.sdf -o new/w.xml
explain SK-SDF-004
golden record w.sdf --duration 0.1 -o golden
golden check golden
graph w.sdf -o graph.svg
inspect w.sdf
run w.sdf --duration 0.1
run w.sdf --duration 0.1 --record a.mcap --force
bag info a.mcap
bag recover a.mcap b.mcap
plot a.mcap /clock.clock -o plot.svg
bag export a.mcap -o csv
run no_such_world --duration 0.1
inspect no_such.sdf
check no_such.sdf
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("common")
    (made / "w.sdf").write_text(BALL)
    return made


@pytest.mark.parametrize("line", LINES.strip().splitlines())
def test_json_is_one_value_and_nothing_else(
    line: str, folder: Path, simkit_line: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    result = simkit_line(*shlex.split(line), "--json", "-q")
    json.loads(result.stdout)
    assert "note" not in result.stderr


LINES_OF_PACKS = """
vendor w.sdf vendored
fetch w.sdf
pkg list
pkg known
pkg executables
pkg create own; pkg find own; pkg prefix own; pkg depends own
new pack own
plugin new wheel_brake --folder plugins
bundle w.sdf --duration 0.1 -o w.bundle; replay w.bundle
lab list
lab start 01_turtlesim lab
view w.sdf --no-open --duration 0
"""
"""Commands of packs; `simkit ros` succeeds only where ROS is installed."""


@pytest.mark.needs_packs
@pytest.mark.parametrize("lines", LINES_OF_PACKS.strip().splitlines())
def test_a_command_of_a_pack_that_succeeds_prints_one_json_document(
    lines: str, tmp_path: Path, simkit_line: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("w.sdf").write_text(BALL)
    for line in lines.split(";"):
        result = simkit_line(*shlex.split(line), "--json", "-q")
        assert result.exit_code == 0, result
        json.loads(result.stdout)


@pytest.mark.needs_packs
@pytest.mark.parametrize("line", ["list", "info /yard", "ping /yard --count 1"])
def test_json_of_nodes_is_one_document(line: str, yard: Any, simkit_line: Callable[..., Any]) -> None:
    result = simkit_line("node", *shlex.split(line), "--json", "-q")
    assert result.exit_code == 0, result
    json.loads(result.stdout)


def test_the_report_of_a_conversion_has_its_warnings(folder: Path, simkit_line: Callable[..., Any]) -> None:
    (folder / "odd.sdf").write_text(BALL.replace("</world>", '<plugin filename="none.so" name="n"/></world>'))
    for output in ("odd.xml", "odd_copy.sdf"):
        result = simkit_line("convert", str(folder / "odd.sdf"), "-o", str(folder / output), "--json")
        report = json.loads(result.stdout)
        assert {each["code"] for each in report["diagnostics"]} >= ({"SK-PLUGIN-001"} if "xml" in output else set())
        assert ("SK-PLUGIN-001" in result.stderr) == ("SK-PLUGIN-001" in result.stdout)


@pytest.mark.needs_packs
@pytest.mark.parametrize(
    "name",
    [
        "list",
        "info /clock",
        "type /clock",
        "find rosgraph_msgs/msg/Clock",
        "echo /clock --once",
        "pub --once /cmd_vel geometry_msgs/msg/Twist",
    ],
)
def test_json_of_topics_is_one_value_or_one_for_each_line(
    name: str, yard: Any, simkit_line: Callable[..., Any]
) -> None:
    result = simkit_line("topic", *name.split(), "--json", "-q")
    assert result.exit_code == 0
    for text in result.stdout.splitlines() if f"topic {name.split()[0]}" in STREAMS else [result.stdout]:
        json.loads(text)


@pytest.mark.needs_packs
def test_without_a_simulation_the_error_is_a_json_object(place: Path, simkit_line: Callable[..., Any]) -> None:
    for line in ("topic list", "topic echo /a", "service list", "node info /a", "tf tree", "model list", "ros"):
        result = simkit_line(*line.split(), "--json")
        report = json.loads(result.stdout)
        assert report["exit_code"] == result.exit_code != 0
        assert report["diagnostics"][0]["code"].startswith("SK-LIVE-")


def test_notes_are_counted_for_own_files_listed_with_v_and_left_out_with_q(
    folder: Path, simkit_line: Callable[..., Any]
) -> None:
    line = ("run", str(folder / "w.sdf"), "--duration", "0")
    assert "1 note (SK-PHYS-002); show with --verbose" in simkit_line(*line).stderr
    assert "w.sdf:4: note SK-PHYS-002" in simkit_line(*line, "-v").stderr
    assert simkit_line(*line, "-q").stderr == ""
    graph = ("graph", str(folder / "w.sdf"), "-o", str(folder / "g.svg"))  # a command without an own option -v
    assert "note SK-PHYS-002" in simkit_line(*graph, "-v").stderr


def test_notes_about_files_of_simkit_are_for_those_who_ask(simkit_line: Callable[..., Any]) -> None:
    line = ("run", "empty", "--duration", "0")
    assert simkit_line(*line).stderr == ""
    assert "model://ground_plane:3: note SK-PHYS-002" in simkit_line(*line, "-v").stderr
