"""Nodes of a run: the option `--node` and its words, scenario files, permissions, exit codes and reports."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import simkit.gym
from simkit import InputError, LoadError, RunSpec
from simkit.cli import app
from simkit.errors import NodeError
from simkit.run_nodes import join_node_words, label_of, latency_of, node_arguments
from simkit.testing import record_run
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario
from simkit_verification.testing.grading.exercise import read_exercise
from simkit_verification.testing.grading.exercise_grading import grade

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'
CART = """<sdf version="1.9"><world name="w"><model name="cart"><link name="body"/>
<joint name="slide" type="prismatic"><parent>world</parent><child>body</child><axis><xyz>1 0 0</xyz></axis></joint>
</model></world></sdf>"""
COUNTER = """
import sys
import time


def main():
    print("arguments", *sys.argv[1:])
    for number in range(3):
        time.sleep(0.1)
        print("number", number, "at", round(time.time(), 6))
    if "fail" in sys.argv:
        raise ValueError("three is enough")


if __name__ == "__main__":
    main()
"""


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Working directory with a world and a program."""
    (tmp_path / "w.sdf").write_text(WORLD)
    (tmp_path / "counter.py").write_text(COUNTER)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def run(*words: str) -> Result:
    return CliRunner().invoke(app, ["run", "w.sdf", "--duration", "1", "-q", *words])


# ---------------------------------------------------------------------- words of a command line


@pytest.mark.parametrize(
    ("words", "joined"),
    [
        ("--node a.py --seed 3", ["--node", "a.py", "--seed", "3"]),
        (
            "--node a.py --ros-args -r x:=y -p k:=1 --seed 3",
            ["--node", "a.py --ros-args -r x:=y -p k:=1", "--seed", "3"],
        ),
        (
            "--node a.py --ros-args --params-file f.yaml --node=b/c --ros-args -r __ns:=/r1 -q",
            ["--node", "a.py --ros-args --params-file f.yaml", "--node", "b/c --ros-args -r __ns:=/r1", "-q"],
        ),
        (
            "--node a.py --ros-args --log-level debug --disable-rosout-logs -- --params-file p.yaml",
            ["--node", "a.py --ros-args --log-level debug --disable-rosout-logs", "--params-file", "p.yaml"],
        ),
        ("--node a.py --remap a:=b", ["--node", "a.py", "--remap", "a:=b"]),
        (
            "--node a.py --ros-args --remap a:=b -- --remap c:=d",
            ["--node", "a.py --ros-args --remap a:=b", "--remap", "c:=d"],
        ),
        ("--node", ["--node"]),
    ],
)
def test_the_arguments_of_ros_belong_to_the_node_before_them(words: str, joined: list[str]) -> None:
    assert join_node_words(words.split()) == joined


def test_a_node_is_a_text_with_words_or_a_mapping() -> None:
    assert node_arguments("a.py x 'y z'") == {"program": "a.py", "args": ("x", "y z")}
    assert node_arguments("a.py --ros-args -r __node:=n")["name"] == "n"
    assert node_arguments({"program": "p/exe", "remap": {"a": "b"}, "name": None}) == {
        "program": "p/exe",
        "remap": {"a": "b"},
    }
    assert label_of("folder/a.py --ros-args") == "a" and label_of({"program": "p/exe", "name": "n"}) == "n"
    with pytest.raises(InputError, match="SK-CLI-018 a node has no key 'remaps'"):
        node_arguments({"program": "a.py", "remaps": {}})
    with pytest.raises(InputError, match="SK-CLI-018 a node is empty"):
        node_arguments("")


def test_a_latency_is_a_time_or_a_range() -> None:
    assert latency_of("5ms") == 0.005
    assert latency_of("5ms..0.02s") == (0.005, 0.02)
    assert latency_of(0.1) == 0.1 and latency_of([0.0, 0.1]) == (0.0, 0.1)
    for wrong in ("soon", "5ms..", "20ms..5ms", -1, True, None):
        with pytest.raises(InputError, match="expected a time such as 5ms"):
            latency_of(wrong)


# ---------------------------------------------------------------------- simkit run


def test_a_node_runs_in_simulated_time_and_has_a_line_in_the_summary(folder: Path) -> None:
    result = run("--node", "counter.py", "--ros-args", "-r", "a:=b", "--seed", "3")
    assert result.exit_code == 0, result.output
    assert "arguments --ros-args -r a:=b" in result.output and "number 2 at 0.3" in result.output
    assert "node counter: ended, 4 turns" in result.output


def test_a_node_that_raises_ends_alone_and_the_run_has_exit_code_4(folder: Path) -> None:
    result = run("--node", "counter.py fail", "--json")
    assert result.exit_code == 4
    line = f"node 'counter' raised ValueError at {folder / 'counter.py'}:12: three is enough"
    report = json.loads(result.stdout)
    assert line in result.stderr and result.stderr.count("Traceback") == 1
    assert report["time"] == 1.0 and report["end"] == "error"
    assert report["nodes"][0]["state"] == "failed with ValueError" and report["nodes"][0]["error"] in line


def test_a_node_that_exits_with_another_code_than_0_has_failed(folder: Path) -> None:
    (folder / "exits.py").write_text("import sys\n\nsys.exit(3)\n", encoding="utf-8")
    result = run("--node", "exits.py", "--json")
    assert result.exit_code == 4 and "SK-SCEN-010 node 'exits' ended with exit code 3" in result.stderr
    assert json.loads(result.stdout)["nodes"][0]["state"] == "failed with exit code 3"


def test_a_node_that_raises_starts_anew_if_the_run_says_so(folder: Path) -> None:
    result = run("--node", "counter.py fail", "--node-restart", "0.2")
    assert result.exit_code == 0, result.output
    assert "node counter: running" in result.output and "2 restarts" in result.output


def test_a_node_that_computes_for_too_long_fails_the_run_with_its_line(folder: Path) -> None:
    (folder / "busy.py").write_text("def main():\n    while True:\n        pass\n\n\nmain()\n")
    result = run("--node", "busy.py", "--node-limit", "200ms")
    assert result.exit_code == 4
    assert "busy.py:" in result.stderr and "for more than 0.2 s" in result.stderr


def test_a_program_that_does_not_exist_is_an_error_of_the_user(folder: Path) -> None:
    result = run("--node", "nobody.py")
    assert result.exit_code == 2 and "SK-NODE-001" in result.stderr
    result = run("--node", str(folder))
    assert result.exit_code == 2 and f"{str(folder)!r} is a folder" in result.stderr.replace("\n", " ")
    result = run("--node", "counter.py", "--node-latency", "other=5ms")
    assert result.exit_code == 2 and "the run has no node 'other'" in result.stderr


def test_latencies_are_for_all_nodes_or_for_one(folder: Path) -> None:
    nodes = ("counter.py", {"program": "counter.py", "name": "second", "latency": 0.001}, "counter.py")
    spec = RunSpec("w.sdf", nodes=nodes, node_latency=("5ms", "counter=1ms..2ms"), node_discovery=0.5)
    with open_scenario(spec) as sim:
        assert [node.options.latency for node in sim.nodes] == [(0.001, 0.002), 0.001, (0.001, 0.002)]
        assert {node.options.discovery for node in sim.nodes} == {0.5}


# ---------------------------------------------------------------------- files


SCENARIO = """
world: w.sdf
duration: 1
nodes:
  - counter.py one --ros-args -p a:=1
  - {program: counter.py, name: second, remap: {scan: /scan}, params: {gain: 2.5}, args: [two], latency: 5ms}
node_restart: 0.5
"""


def test_a_scenario_file_names_nodes_that_run_with_a_permission_only(folder: Path) -> None:
    (folder / "place").mkdir()
    for name in ("w.sdf", "counter.py"):
        (folder / name).rename(folder / "place" / name)
    file = folder / "place" / "s.yaml"
    file.write_text(SCENARIO)
    refused = read_scenario(file)
    with pytest.raises(LoadError, match=r"s.yaml:5: error SK-SCEN-008: nodes names the program 'counter.py'"):
        open_scenario(refused)
    for spec in (read_scenario(file, allow_code=True), read_scenario(file, plugin_paths=[folder / "place"])):
        with open_scenario(spec) as sim:
            run_scenario(spec, sim)
            first, second = sim.nodes
            assert first.file == second.file == folder / "place" / "counter.py"
            assert first.options.args == ("one", "--ros-args", "-p", "a:=1")
            assert second.name == "second" and second.options.remap == {"scan": "/scan"}
            assert second.options.params == {"gain": 2.5} and second.options.latency == 0.005
            assert first.options.restart == 0.5


def test_mistakes_in_the_nodes_of_a_scenario_are_told_with_their_lines(folder: Path) -> None:
    text = "world: w.sdf\nnodes:\n  - {program: 3}\n  - {name: n}\n  - {program: a.py, remaps: {}}\n"
    (folder / "s.yaml").write_text(f"{text}  - {{program: a.py, latency: soon}}\n  - {{program: a.py, args: {{}}}}\n")
    with pytest.raises(LoadError) as caught:
        read_scenario(folder / "s.yaml")
    found = {(one.line, one.code) for one in caught.value.diagnostics}
    assert found == {
        (3, "SK-SCEN-003"), (4, "SK-SCEN-003"), (5, "SK-SCEN-002"), (6, "SK-SCEN-003"), (7, "SK-SCEN-003"),
    }  # fmt: skip


def test_a_golden_run_stores_its_nodes_and_needs_a_permission_for_them(folder: Path) -> None:
    runner = CliRunner()
    words = ["golden", "record", "w.sdf", "-o", "golden", "--duration", "0.5", "--node", "counter.py", "--ros-args"]
    done = runner.invoke(app, [*words, "-p", "a:=1", "--node-latency", "5ms"])
    assert done.exit_code == 0, done.output
    stored = json.loads((folder / "golden" / "golden.json").read_text())
    assert stored["scenario"]["nodes"] == ["../counter.py --ros-args -p a:=1"]
    assert stored["scenario"]["node_latency"] == ["5ms"] and "counter.py" in stored["sources"]
    done = runner.invoke(app, ["golden", "check", "golden"])
    assert done.exit_code == 2 and "SK-SCEN-008" in done.output
    for permission in (["--allow-code"], ["--plugin-path", "."]):
        done = runner.invoke(app, ["golden", "check", "golden", *permission])
        assert done.exit_code == 0, done.output


def test_names_of_files_of_nodes_move_with_the_run(folder: Path) -> None:
    (folder / "my folder").mkdir()
    (folder / "counter.py").rename(folder / "my folder" / "counter.py")
    (folder / "p.yaml").write_text("")
    (folder / "golden").mkdir()
    spec = RunSpec("w.sdf", nodes=("'my folder/counter.py' --ros-args --params-file p.yaml", "package/executable"))
    plain = encode_scenario(spec, folder / "golden")
    assert plain["nodes"] == [
        "'../my folder/counter.py' --ros-args --params-file ../p.yaml", "package/executable",
    ]  # fmt: skip
    again = decode_scenario(plain, folder / "golden")
    assert node_arguments(again.nodes[0])["program"] == str(folder / "golden" / ".." / "my folder" / "counter.py")
    assert [request.path is None for request in again.code_requests] == [False, True]


def test_a_run_from_python_names_programs_and_fails_if_one_raises(folder: Path) -> None:
    spec = RunSpec("w.sdf", duration=0.5, nodes=("counter.py fail",))
    with open_scenario(spec) as sim, pytest.raises(NodeError, match="SK-SCEN-010 node 'counter' raised ValueError"):
        run_scenario(spec, sim)
    record = record_run(spec)
    assert isinstance(record.error, NodeError)
    assert record.simulation is not None and record.simulation.time == 0.5
    record.simulation.close()


# ---------------------------------------------------------------------- sweeps, environments, grades


@pytest.mark.slow
def test_a_sweep_runs_the_nodes_of_its_file_in_each_run(folder: Path) -> None:
    (folder / "sweep.yaml").write_text(
        "world: w.sdf\nduration: 0.5\nseeds: 2\nmetrics: {t: time}\nnodes: [counter.py fail]\n"
    )
    done = CliRunner().invoke(app, ["sweep", "run", "sweep.yaml", "-o", "out"])
    assert done.exit_code == 2 and "sweep.yaml:5: error SK-SCEN-008" in done.output
    done = CliRunner().invoke(app, ["sweep", "run", "sweep.yaml", "-o", "out", "--plugin-path", "."])
    assert "2 runs: 0 ok, 2 failed" in done.output, done.output
    assert "node 'counter' raised ValueError" in (folder / "out" / "results.csv").read_text()


def test_an_environment_runs_nodes_and_starts_them_anew_with_each_episode(folder: Path) -> None:
    pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")
    run_spec = RunSpec(CART, nodes=("counter.py fail",))
    env = simkit.gym.make(run_spec, observation="cart::slide", action={"cart::slide": (-1.0, 1.0)}, control_period=0.25)
    for _ in range(2):
        env.reset(seed=1)
        env.step([0.0])
        with pytest.raises(NodeError, match="three is enough"):
            env.step([0.0])
    env.close()


@pytest.mark.slow
def test_an_exercise_runs_its_nodes_with_a_permission(folder: Path) -> None:
    text = "world: w.sdf\nduration: 0.5\nnodes: [counter.py]\nat_end: ['time > 0.4']\nexercise: {title: Count}\n"
    (folder / "exercise.yaml").write_text(text)
    with pytest.raises(LoadError, match="SK-SCEN-008"):
        grade(read_exercise("exercise.yaml"))
    graded = grade(read_exercise("exercise.yaml"), allow_code=True)
    assert graded.passed


@pytest.mark.slow
def test_an_exercise_tells_how_a_program_for_ros_has_failed(folder: Path) -> None:
    text = (
        "world: w.sdf\nduration: 0.5\nat_end: ['time > 0.4']\nexercise: {title: Count, hand_in: counter.py, node: %s}\n"
    )
    (folder / "exercise.yaml").write_text(text % "{args: [fail]}")
    failed = grade(read_exercise("exercise.yaml"), Path("counter.py"))
    assert not failed.passed and "raised ValueError at" in str(failed) and "counter.py:12" in str(failed)
    (folder / "exercise.yaml").write_text(text % "{program: other.py}")
    with pytest.raises(LoadError, match="a node has no key 'program'"):
        read_exercise("exercise.yaml")


@pytest.mark.slow
def test_an_exercise_accepts_a_program_for_ros(folder: Path) -> None:
    text = "world: w.sdf\nduration: 0.5\nat_end: ['time > 0.4']\n"
    (folder / "exercise.yaml").write_text(f"{text}exercise: {{title: Count, hand_in: counter.py, node: true}}\n")
    assert grade(read_exercise("exercise.yaml"), Path("counter.py")).passed


def test_a_constant_velocity_goes_to_a_topic_that_only_a_node_subscribes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "hall.sdf").write_text('<sdf version="1.9"><world name="hall"/></sdf>')
    (tmp_path / "mux.py").write_text(VELOCITY_MUX)
    words = ["run", "hall.sdf", "--duration", "1", "--cmd-vel", "0.5,0"]
    done = CliRunner().invoke(app, [*words, "--node", "mux.py"])
    assert done.output.count("received 0.5") > 5 and "SK-CLI-010" not in done.output, done.output
    (tmp_path / "idle.py").write_text("import rclpy\n\nrclpy.init()\nrclpy.spin(rclpy.create_node('idle'))\n")
    done = CliRunner().invoke(app, [*words, "--node", "idle.py"])
    assert "warning SK-CLI-010: no command was sent: --cmd-vel needs exactly one Twist topic" in done.output


VELOCITY_MUX = """import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node


class Mux(Node):
    def __init__(self):
        super().__init__("mux")
        self.publisher = self.create_publisher(Twist, "base/cmd_vel", 1)
        self.create_subscription(Twist, "cmd_vel", self.forward, 1)

    def forward(self, message):
        print("received", message.linear.x)
        self.publisher.publish(message)


rclpy.init()
rclpy.spin(Mux())
"""
