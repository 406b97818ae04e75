"""Conditions of nodes: start after a time or after another node, start again, end of the run, environment, folder."""

from __future__ import annotations

import hashlib
import os
import re
import shlex
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from textwrap import dedent
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner, Result

import simkit.gym
from simkit import InputError, RunSpec, Simulation
from simkit.cli import app
from simkit.errors import ArgumentValueError, NodeError
from simkit.run_nodes import Node, node_arguments
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario
from simkit_nodes.programs import NodeProgram

WORLD = """<sdf version="1.9"><world name="w"><model name="floor"><static>true</static><link name="l"/></model>
</world></sdf>"""
STEP = """
import sys
import time

print(sys.argv[1], 'begins at', round(time.time(), 6))
if float(sys.argv[2]):
    time.sleep(float(sys.argv[2]))
"""
SERVER = """
import rclpy
from std_srvs.srv import Trigger


def stop(request, response):
    response.message = "stopped"
    return response


rclpy.init()
node = rclpy.create_node("server")
node.create_service(Trigger, "stop", stop)
rclpy.spin(node)
"""
CART = """<sdf version="1.9"><world name="w"><model name="cart"><link name="body"/>
<joint name="slide" type="prismatic"><parent>world</parent><child>body</child><axis><xyz>1 0 0</xyz></axis></joint>
</model></world></sdf>"""
BOX = """<sdf version="1.9"><model name="box"><link name="l"><collision name="c"><geometry><box><size>1 1 1</size></box>
</geometry></collision></link></model></sdf>"""

Add = Callable[..., NodeProgram]


@pytest.fixture
def sim() -> Iterator[Simulation]:
    with simkit.load(WORLD, seed=1) as simulation:
        yield simulation


@pytest.fixture
def add(sim: Simulation, tmp_path: Path) -> Add:
    """Function that adds a program, which says when it begins, and then sleeps for a time [s]."""
    (tmp_path / "step.py").write_text(STEP)

    def add_step(name: str, sleep: float = 0.0, **options: Any) -> NodeProgram:
        return sim.add_node(tmp_path / "step.py", name=name, args=(name, str(sleep)), **options)

    return add_step


def begins(sim: Simulation) -> list[str]:
    """Return the lines of all programs in the order of their addition."""
    return [line.replace(" begins at ", " ") for program in sim.nodes for line in program.log]


# ---------------------------------------------------------------------- start


def test_a_node_starts_after_a_delay(sim: Simulation, add: Add) -> None:
    add("first", delay=0.25)
    sim.run(0.2)
    assert begins(sim) == []
    sim.run(0.1)
    assert begins(sim) == ["first 0.25"]


def test_a_node_starts_at_the_tick_at_which_another_one_ends(sim: Simulation, add: Add) -> None:
    add("last", after={"exit": "middle"})
    add("middle", sleep=0.1, after={"exit": "first"})
    add("first", sleep=0.2)
    sim.run(1.0)
    assert begins(sim) == ["last 0.3", "middle 0.2", "first 0.0"]


def test_a_chain_of_nodes_that_end_at_once_takes_no_simulated_time(sim: Simulation, add: Add) -> None:
    add("a", delay=0.1)
    for before, label in ("ab", "bc", "cd"):
        add(label, after={"exit": before})
    sim.run(0.2)
    assert begins(sim) == ["a 0.1", "b 0.1", "c 0.1", "d 0.1"]


def test_a_delay_counts_from_the_event(sim: Simulation, add: Add) -> None:
    add("first", sleep=0.2, delay=0.1)
    add("with", after={"start": "first"}, delay=0.05)
    add("then", after={"exit": "first"}, delay=0.05)
    sim.run(1.0)
    assert begins(sim) == ["first 0.1", "with 0.15", "then 0.35"]


def test_nodes_that_start_at_one_time_start_in_the_order_of_their_addition(sim: Simulation, tmp_path: Path) -> None:
    order: list[str] = []

    def program(name: str) -> Callable[[], None]:
        return lambda: order.append(name)

    sim.add_node(program("a"), name="a", after={"exit": "wait"}, delay=0.2)
    sim.add_node(program("b"), name="b", delay=0.3)
    sim.add_node(program("c"), name="c", after={"start": "wait"}, delay=0.2)
    sim.add_node(lambda: order.append("wait"), name="wait", delay=0.1)
    sim.run(1.0)
    assert order == ["wait", "a", "b", "c"]


@pytest.mark.parametrize("part", [1, 7, 1000])
def test_the_order_does_not_depend_on_the_number_of_steps_of_a_call(part: int) -> None:
    order: list[str] = []

    def program(name: str, turns: int) -> Callable[[], None]:
        def run() -> None:
            import time

            for _ in range(turns):
                order.append(f"{name} {time.time():.3f}")
                time.sleep(0.01)

        return run

    with simkit.load(WORLD, seed=1) as sim:
        sim.add_node(program("c", 3), name="c", after={"exit": "b"}, delay=0.02)
        sim.add_node(program("a", 20), name="a")
        sim.add_node(program("b", 4), name="b", delay=0.03)
        sim.add_node(program("d", 2), name="d", after={"start": "c"}, delay=0.01)
        for _ in range(0, 200, part):
            sim.step(min(part, 200))
    times = [float(line.split()[1]) for line in order]
    assert times == sorted(times)
    assert [line for line in order if line.endswith("0.100")] == ["a 0.100", "c 0.100", "d 0.100"]
    assert [line for line in order if line.startswith("b")] == ["b 0.030", "b 0.040", "b 0.050", "b 0.060"]


def test_a_label_is_another_name_than_that_of_the_node(sim: Simulation, add: Add) -> None:
    add("node", label="7")
    add("node", label="8", after={"exit": "7"}, delay=0.1)
    add("other", after={"exit": "8"})
    sim.run(1.0)
    assert begins(sim) == ["node 0.0", "node 0.1", "other 0.1"]


def test_a_call_of_a_script_starts_the_nodes_whose_condition_holds(sim: Simulation, tmp_path: Path) -> None:
    (tmp_path / "server.py").write_text(SERVER)
    sim.add_node(tmp_path / "server.py", after={"start": "first"})
    sim.add_node(tmp_path / "server.py", name="first", namespace="one")
    sim.run(0.1)
    sim.add_node(tmp_path / "server.py", name="second", after={"start": "first"}, delay=1.0)
    assert sim.call("/stop").message == "stopped"


def test_the_exit_of_a_node_in_the_past_is_an_exit(sim: Simulation, add: Add) -> None:
    add("first")
    sim.run(0.5)
    add("second", after={"exit": "first"}, delay=0.1)
    sim.run(0.1)
    assert begins(sim) == ["first 0.0", "second 0.5"]


def test_a_node_may_start_after_one_that_has_failed(sim: Simulation, add: Add, tmp_path: Path) -> None:
    (tmp_path / "fail.py").write_text("raise ValueError('no')\n")
    sim.add_node(tmp_path / "fail.py")
    add("then", after={"exit": "fail"})
    sim.run(0.1)
    assert begins(sim)[-1] == "then 0.0"


def test_a_label_that_no_node_has_is_an_error_at_the_first_step(sim: Simulation, add: Add) -> None:
    add("spawn")
    add("drive", after={"exit": "spwan"})
    with pytest.raises(
        InputError, match="SK-NODE-065 node 'drive' waits for the exit of a node: no node has the label 'spwan'"
    ):
        sim.run(0.1)


def test_a_name_that_two_nodes_have_is_no_label(sim: Simulation, add: Add) -> None:
    add("spawn"), add("spawn"), add("drive", after={"exit": "spawn"})
    with pytest.raises(InputError, match="several nodes have the name 'spawn'"):
        sim.run(0.1)


def test_two_nodes_with_one_label_are_an_error(sim: Simulation, add: Add) -> None:
    add("a", label="x")
    with pytest.raises(InputError, match="SK-NODE-065 two nodes have the label 'x'"):
        add("b", label="x")


@pytest.mark.parametrize("after", [{"end": "a"}, {"exit": "a", "start": "b"}])
def test_an_event_that_does_not_exist_is_an_error(add: Add, after: dict[str, str]) -> None:
    with pytest.raises(ArgumentValueError, match="after must be a mapping such as"):
        add("b", after=after)


def test_a_reset_starts_the_chain_anew(sim: Simulation, add: Add) -> None:
    add("first", sleep=0.2)
    add("then", after={"exit": "first"}, delay=0.1)
    add("never", after={"exit": "then"}, delay=9.0)
    sim.run(1.0)
    sim.reset()
    assert begins(sim) == []
    sim.run(0.25)
    assert begins(sim) == ["first 0.0"]
    sim.run(0.1)
    assert begins(sim) == ["first 0.0", "then 0.3"]


def test_a_restore_moves_the_times_of_conditions(sim: Simulation, add: Add) -> None:
    add("first", sleep=0.2)
    add("then", after={"exit": "first"}, delay=0.3)
    snapshot = sim.snapshot()
    sim.run(0.4)
    sim.restore(snapshot)
    sim.run(0.2)
    assert begins(sim) == ["first 0.0", "then 0.1"]


# ---------------------------------------------------------------------- start again, end of the run


def test_a_node_that_ends_starts_again(sim: Simulation, add: Add) -> None:
    node = add("again", sleep=0.1, respawn=0.05)
    add("then", after={"exit": "again"})
    sim.run(0.5)
    assert begins(sim) == ["again 0.0", "again 0.15", "again 0.3", "again 0.45", "then 0.1"]
    assert node.restarts == 3


def test_a_node_starts_again_at_the_next_step_without_a_delay(sim: Simulation, add: Add) -> None:
    node = add("again", sleep=0.002, respawn=0.0)
    sim.step(9)
    assert begins(sim) == ["again 0.0", "again 0.003", "again 0.006", "again 0.009"]
    assert node.restarts == 3


def test_a_node_that_ends_at_once_starts_again_after_a_second(sim: Simulation, tmp_path: Path) -> None:
    (tmp_path / "broken.py").write_text("import time\nprint(time.time())\nimport a_module_that_nobody_has\n")
    node = sim.add_node(tmp_path / "broken.py", respawn=0.1)
    sim.run(2.5)
    assert node.restarts == 3
    assert [line for line in node.log if line[0].isdigit()] == ["0.0", "1.0", "2.0"]


def test_a_node_ends_the_run_and_all_programs(sim: Simulation, add: Add) -> None:
    add("long", sleep=9.0)
    add("end", sleep=0.2, ends_run=True, respawn=0.1)
    add("late", after={"exit": "end"})
    sim.run(1.0)
    assert sim.ended_by == "end"
    assert all(node.done for node in sim.nodes)
    assert begins(sim) == ["long 0.0", "end 0.0"]
    sim.check_nodes()
    sim.reset()
    sim.run(0.1)
    assert sim.ended_by == ""
    assert begins(sim) == ["long 0.0", "end 0.0"]


def test_a_run_ends_with_its_node(tmp_path: Path) -> None:
    (tmp_path / "step.py").write_text(STEP)
    spec = RunSpec(WORLD, nodes=({"program": "step.py", "args": ["a", "0.5"], "ends_run": True},), folder=tmp_path)
    with open_scenario(spec) as sim:
        assert run_scenario(spec, sim).reason == "duration"
        assert sim.time == 0.5


def test_a_run_that_ends_before_its_condition_has_failed(tmp_path: Path) -> None:
    (tmp_path / "step.py").write_text(STEP)
    nodes = ({"program": "step.py", "args": ["a", "0.5"], "ends_run": True},)
    spec = RunSpec(WORLD, nodes=nodes, folder=tmp_path, until="pose('floor').x > 1", timeout=2.0)
    with open_scenario(spec) as sim:
        assert not run_scenario(spec, sim).passed


def test_an_episode_ends_with_the_node_that_ends_the_run(tmp_path: Path) -> None:
    pytest.importorskip("gymnasium", reason="pip install 'simkit-robotics[experiments]'")
    (tmp_path / "step.py").write_text(STEP)
    nodes = ({"program": str(tmp_path / "step.py"), "args": ["a", "0.3"], "ends_run": True},)
    action = {"cart::slide": (-1.0, 1.0)}
    env = simkit.gym.make(RunSpec(CART, nodes=nodes), observation="cart::slide", action=action, control_period=0.25)
    for _ in range(2):
        env.reset(seed=1)
        assert [env.step([0.0])[2:4] for _ in range(2)] == [(False, False), (False, True)]
    env.close()


# ---------------------------------------------------------------------- environment and folder


def test_a_node_has_variables_and_a_folder_of_its_own(sim: Simulation, tmp_path: Path) -> None:
    (tmp_path / "show.py").write_text("import os\nprint(os.environ['ROBOT'], os.path.basename(os.getcwd()))\n")
    (tmp_path / "inside").mkdir()
    node = sim.add_node(tmp_path / "show.py", env={"ROBOT": "burger"}, cwd=tmp_path / "inside")
    sim.run(0.1)
    assert node.log == ["burger inside"]
    assert "ROBOT" not in os.environ


def test_a_folder_that_does_not_exist_is_an_error(add: Add) -> None:
    with pytest.raises(InputError, match="cwd: there is no folder 'nowhere'"):
        add("a", cwd="nowhere")


# ---------------------------------------------------------------------- models that a node spawns


SPAWN = """
import sys
from simkit_nodes.host import current_host
from simkit import Pose
import rclpy

rclpy.init()
node = rclpy.create_node("spawner")
sim = current_host().simulation
sim.spawn(sys.argv[1], name="added", pose=Pose((0, 0, 3)))
node.get_logger().info(f"has {sorted(sim.models)}")
rclpy.spin_once(node, timeout_sec=0.2)
sim.spawn(sys.argv[1], name="second", pose=Pose((0, 0, 6)))
try:
    sim.spawn("nowhere.sdf")
except Exception as error:
    print(type(error).__name__)
"""


def state_after_spawns(folder: Path) -> tuple[str, list[str]]:
    with simkit.load(WORLD, seed=1) as sim:
        node = sim.add_node(folder / "spawn.py", args=("box.sdf",), delay=0.1)
        sim.run(0.5)
        positions = [tuple(sim.model(name).pose.position) for name in ("added", "second")]
        return hashlib.sha256(repr(positions).encode()).hexdigest(), node.log


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Working directory with a world, a model, a program that spawns it, and one that only waits."""
    for name, text in {"w.sdf": WORLD, "box.sdf": BOX, "spawn.py": SPAWN, "step.py": STEP}.items():
        (tmp_path / name).write_text(text)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_models_that_a_node_spawns_are_there_at_once_with_the_same_bits(folder: Path) -> None:
    first = state_after_spawns(folder)
    assert first[1] == ["[INFO] [0.100000000] [spawner]: has ['added', 'floor']", "LoadError"]
    assert first == state_after_spawns(folder)


def test_a_reset_removes_the_models_of_a_node_and_the_node_spawns_them_again(folder: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim:
        sim.add_node(folder / "spawn.py", args=("box.sdf",))
        sim.run(0.5)
        place = tuple(sim.model("second").pose.position)
        sim.reset()
        assert sorted(sim.models) == ["floor"]
        sim.run(0.5)
        assert tuple(sim.model("second").pose.position) == place


def test_a_node_removes_a_model(sim: Simulation) -> None:
    sim.add_node(lambda: sim.remove("floor"), delay=0.1)
    sim.run(0.2)
    assert sim.models == {}


def test_a_spawn_in_a_node_runs_in_the_thread_of_the_simulation_and_imports_nothing_of_the_program(
    folder: Path,
) -> None:
    """A plugin of the model gets the modules of the process, although the program has others of the same name."""
    (folder / "helper.py").write_text("text = 'of the program'\n")
    (folder / "threads.py").write_text(
        dedent("""
        import threading
        import helper
        from simkit_nodes.host import current_host
        host = current_host()
        def places():
            import sys
            return (threading.current_thread().name, "helper" in sys.modules)
        print(host.call_outside(lambda: "helper" in __import__("sys").modules), helper.text)
        """)
    )
    with simkit.load(WORLD) as sim:
        node = sim.add_node(folder / "threads.py")
        sim.run(0.1)
        assert node.log == ["False of the program"]


# ---------------------------------------------------------------------- programs that a node adds


def test_a_node_that_another_one_adds_is_a_program_of_its_own_and_a_reset_adds_it_again(
    sim: Simulation, tmp_path: Path
) -> None:
    (tmp_path / "first.py").write_text(
        dedent("""
        import os, sys
        from pathlib import Path
        from simkit_nodes.host import current_host
        os.environ["OF_FIRST"] = "1"
        sys.path.append("/nowhere")
        second = Path(__file__).parent / "second.py"
        added = current_host().simulation.add_node(second, after={"exit": "first"}, delay=0.1)
        print("added", added.name)
        """)
    )
    (tmp_path / "second.py").write_text(
        "import os, sys, time\nprint(os.environ.get('OF_FIRST'), '/nowhere' in sys.path, round(time.time(), 6))\n"
    )
    sim.add_node(tmp_path / "first.py")
    for _ in range(2):
        sim.run(0.2)
        assert [node.log for node in sim.nodes] == [["added second"], ["None False 0.1"]]
        sim.reset()
        assert [node.name for node in sim.nodes] == ["first"]


# ---------------------------------------------------------------------- files and commands


def simkit_command(*words: str) -> Result:
    return CliRunner().invoke(app, words)


def test_a_bundle_repeats_the_spawns_of_a_node_without_it(folder: Path) -> None:
    words = shlex.split("bundle w.sdf -o b.zip --duration 0.5 --node 'spawn.py box.sdf'")
    done = simkit_command(*words)
    assert done.exit_code == 0, done.output
    state = re.search(r"state \w+", done.output)
    for name in ("spawn.py", "box.sdf", "w.sdf"):
        (folder / name).unlink()
    again = simkit_command("replay", "b.zip")
    assert again.exit_code == 0 and "identical" in again.output, again.output
    assert state is not None and state[0] in again.output


def test_a_golden_run_has_the_conditions_of_its_scenario(folder: Path) -> None:
    nodes = [
        {"program": "step.py", "args": ["first", "0.2"], "label": "first"},
        {"program": "spawn.py", "args": ["box.sdf"], "after": {"exit": "first"}, "delay": 0.05, "env": {"A": 1}},
        {"program": "step.py", "args": ["end", "0.4"], "name": "end", "ends_run": True, "cwd": ".", "respawn": 1},
    ]
    (folder / "s.yaml").write_text(yaml.safe_dump({"world": "w.sdf", "duration": 1, "nodes": nodes}))
    done = simkit_command("golden", "record", "s.yaml", "-o", "golden", "--allow-code")
    assert done.exit_code == 0, done.output
    done = simkit_command("golden", "check", "golden", "--allow-code")
    assert done.exit_code == 0, done.output


def test_the_conditions_of_a_node_are_stored_and_read() -> None:
    node = {"program": "a.py", "label": "x", "after": {"exit": "y"}, "delay": 1.0, "respawn": 0.0, "ends_run": True,
            "env": {"A": "1"}, "cwd": "folder"}  # fmt: skip
    assert node_arguments(node) == node
    spec = RunSpec("w.sdf", nodes=(node,))
    assert decode_scenario(encode_scenario(spec, Path()), Path()).nodes == (node,)


def test_the_summary_names_what_a_node_has_waited_for(folder: Path) -> None:
    nodes: list[Node] = [
        {"program": "step.py", "args": ["first", 9], "label": "first"},
        {"program": "step.py", "args": ["second", 0], "name": "second", "after": {"exit": "first"}, "delay": 2},
        {"program": "step.py", "args": ["third", 0], "name": "third", "delay": 5},
    ]
    result = run_in_session(RunSpec("w.sdf", duration=0.5, nodes=tuple(nodes)))
    assert "node second: not started (waits for the exit of first and 2 s)" in result
    assert "node third: not started (waits for 5 s of simulated time)" in result


def test_simkit_run_ends_with_a_node_and_has_its_exit_code(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    end = {"program": "step.py", "args": ["end", 0.2], "name": "end", "ends_run": True}
    text = run_in_session(RunSpec("w.sdf", duration=5.0, nodes=(end,)))
    assert "simulated 0.200 s" in text
    assert "node end: ended" in text
    assert "the node end has ended the run at t=0.2 s" in capsys.readouterr().err
    (folder / "fail.py").write_text("import time\ntime.sleep(0.3)\nraise SystemExit(3)\n")
    with pytest.raises(NodeError, match="ended with exit code 3"):
        run_in_session(RunSpec("w.sdf", duration=5.0, nodes=({"program": "fail.py", "ends_run": True},)))


def run_in_session(spec: RunSpec) -> str:
    """Run a specification as `simkit run` does, and return what it prints."""
    from simkit.cli.run import execute

    with redirect_stdout(StringIO()) as output:
        assert execute(spec, (), verbose=False, quiet=True) == 0
    return output.getvalue()
