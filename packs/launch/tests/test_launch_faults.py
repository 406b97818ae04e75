"""Faults of launch files: each is reported with its place, and what a file prints is shown beside the results."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.errors import LoadError
from simkit_launch.launch_file import read_launch_file
from simkit_launch.launch_plan import MOST_INCLUDES, LaunchPlan
from simkit_launch.run_plan import run_spec_of
from simkit_launch.scenario_text import scenario_text

Read = Callable[[str, str], LaunchPlan]

HEAD = """from launch import LaunchDescription
from launch.actions import ExecuteProcess, LogInfo, TimerAction
from launch_ros.actions import Node


"""


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Function that reads a launch file with a name and a text."""

    def reader(name: str, text: str) -> LaunchPlan:
        (tmp_path / name).write_text(text)
        return read_launch_file(tmp_path / name, {})

    return reader


def fault(read: Read, name: str, text: str) -> str:
    """Return the only error of a launch file."""
    with pytest.raises(LoadError) as caught:
        read(name, text)
    (error,) = [each for each in caught.value.diagnostics if each.severity == "error"]
    return f"{Path(str(error.file)).name}:{error.line}: {error.code} {error.message}"


def body(*lines: str) -> str:
    return HEAD + "def generate_launch_description():\n" + "".join(f"    {line}\n" for line in lines)


def test_a_file_that_describes_no_launch_is_an_error(read: Read) -> None:
    assert "neither a function generate_launch_description()" in fault(read, "a.launch.py", "x = 1\n")
    assert "returned None; expected a LaunchDescription" in fault(read, "b.launch.py", body("return None"))
    assert "found 5 among the actions" in fault(read, "c.launch.py", body("return LaunchDescription([5])"))


@pytest.mark.parametrize("period", ["nan", "inf"])
def test_a_period_that_is_not_finite_is_an_error_at_its_timer(read: Read, period: str) -> None:
    timer = f"return LaunchDescription([TimerAction(period=float('{period}'), actions=[LogInfo(msg='x')])])"
    assert fault(read, "a.launch.py", body(timer)).startswith("a.launch.py:7: SK-LAUNCH-002")


def test_a_node_with_a_bad_name_is_left_out_with_its_place(read: Read) -> None:
    node = "Node(package='topic_tools', executable='relay', arguments=['/a', '/b'], {})"
    lines = [node.format("name='bad name!'"), node.format("remappings=[('a b', 'c!')]"), node.format("name='good'")]
    plan = read("a.launch.py", body("return LaunchDescription([", *(f"    {line}," for line in lines), "])"))
    assert [node["name"] for node in run_spec_of(plan).nodes if isinstance(node, dict)] == ["good"]
    warnings = [each for each in plan.diagnostics if each.code == "SK-LAUNCH-040"]
    assert [each.line for each in warnings] == [8, 9]
    assert "found the name 'bad name!'" in warnings[0].message and "Couldn't parse remap rule" in warnings[1].message


def test_what_a_launch_file_prints_does_not_mix_with_the_results(tmp_path: Path, capfd: pytest.CaptureFixture) -> None:
    prints = ["print('printed')", "subprocess.run(['echo', 'from a process'])"]
    log = "return LaunchDescription([LogInfo(msg='logged \\x1b[31m')])"
    (tmp_path / "a.launch.py").write_text("import subprocess\n" + body(*prints, log))
    done = CliRunner().invoke(app, ["launch", str(tmp_path / "a.launch.py"), "--print"])
    assert done.exit_code == 0 and done.stdout.startswith("world: ")
    assert "printed" in done.stderr and "[launch.user]: logged \\x1b[31m" in done.stderr
    captured = capfd.readouterr()
    assert "from a process" in captured.err and not captured.out


@pytest.mark.parametrize(
    "expression",
    ["__import__(&quot;os&quot;).getcwd()", "().__class__", "open(&quot;/etc/passwd&quot;).read()", "9**9**9**9"],
)
def test_an_expression_of_an_xml_file_runs_no_code(read: Read, expression: str) -> None:
    text = f"""<launch><log message="$(eval '{expression}')"/></launch>"""
    assert fault(read, "a.launch.xml", text).startswith("a.launch.xml:1: SK-LAUNCH-024")


def test_an_expression_of_an_xml_file_computes_with_numbers_and_texts(read: Read) -> None:
    text = """<launch><log message="$(eval 'math.floor(pi) + len(\\'ab\\'.upper())')"/></launch>"""
    assert read("a.launch.xml", text).log == ["[INFO] [launch.user]: 5"]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ending", "node"), [(".launch", '<node pkg="a" type="b" name="$(anon c)"/>'), (".launch.xml", "")]
)
def test_includes_that_multiply_are_an_error(tmp_path: Path, read: Read, ending: str, node: str) -> None:
    for level in range(8):
        include = f'<include file="$(dirname)/level_{level + 1}{ending}"/>'
        (tmp_path / f"level_{level}{ending}").write_text(f"<launch>{node}{include * 9}</launch>")
    (tmp_path / f"level_8{ending}").write_text(f"<launch>{node}</launch>")
    text = (tmp_path / f"level_0{ending}").read_text()
    assert f"more than {MOST_INCLUDES} files" in fault(read, f"level_0{ending}", text)


def test_a_printed_run_leaves_the_start_of_controllers_to_their_spawner(read: Read) -> None:
    spawner = "Node(package='controller_manager', executable='spawner', arguments=['arm_controller'])"
    plan = read("a.launch.py", body(f"return LaunchDescription([{spawner}])"))
    assert "start_controllers: false" in scenario_text(run_spec_of(plan))


@pytest.mark.parametrize("word", ["speed=1", ":=1", "speed"])
def test_a_word_after_a_file_that_is_no_argument_is_an_error(tmp_path: Path, word: str) -> None:
    (tmp_path / "a.launch.xml").write_text("<launch/>")
    done = CliRunner().invoke(app, ["launch", str(tmp_path / "a.launch.xml"), word, "--print"])
    assert done.exit_code == 2 and f"'{word}' is no argument; expected NAME:=VALUE" in done.stderr
