"""Certificates of deterministic worlds, and of plugins that depend on their environment."""

from __future__ import annotations

import functools
import json
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit import RunSpec
from simkit.child_process import ProcessResult
from simkit.cli import app
from simkit.errors import InputError
from simkit.memory_error import OutOfMemory
from simkit_verification.testing.certify import Certificate, Difference, certify
from simkit_verification.testing.certify.certificate import conclusion_text, streams_hash
from simkit_verification.testing.certify.certification import _code_at_timeout, _outcome_of_stopped_process
from simkit_verification.testing.certify.outcome import RunOutcome
from simkit_verification.testing.certify.variations import VARIATIONS, choose_variations

WORLD = """<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity><model name="m"><link name="l">
<inertial><mass>1</mass></inertial><sensor name="imu" type="imu"><update_rate>100</update_rate><imu>
<linear_acceleration><x><noise type="gaussian"><stddev>0.1</stddev></noise></x></linear_acceleration></imu></sensor>
</link><plugin filename="mine:Mine" name="mine"/></model></world></sdf>"""
HEAD = """
import os, random, time
from simkit.plugins import ModelPlugin


class Other(ModelPlugin):
    def load(self, parent, params):
        time.time()


class Mine(ModelPlugin):
    count = []

    def load(self, parent, params):
        self.link, self.drawn = parent.link("l"), 0.0
        self.out = self.advertise("told", "std_msgs/msg/String")

    def before_step(self):
"""
COUNTED = "self.sim.told = getattr(self.sim, 'told', 0) + 1\nself.link.apply_wrench((self.sim.told, 0, 0))"
PUSH = "        self.link.apply_wrench((0.1, 0, 0))\n"


@pytest.fixture
def in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """Run the command line without child processes."""
    monkeypatch.setattr("simkit_verification.testing.certify.certify", functools.partial(certify, apart=False))


def certified(folder: Path, body: str, names: str = "elsewhere", *, apart: bool = False, load: str = "") -> Certificate:
    """Certify a plugin with this `before_step` in the reference run and in other variations.

    The lines `load` are added to the plugin's method of this name.
    """
    (folder / "w.sdf").write_text(WORLD)
    head = HEAD.replace("    def before_step", f"{load}    def before_step")
    (folder / "mine.py").write_text(head + PUSH + "".join(f"        {line}\n" for line in body.splitlines()))
    scenario = RunSpec(world=str(folder / "w.sdf"), duration=0.1, options={"plugin_paths": [folder]})
    ways = [way for way in VARIATIONS if way.name in ("as it is", names)]
    return certify(scenario, variations=ways, apart=apart)


@pytest.mark.slow
def test_a_deterministic_world_gives_the_same_bits_in_every_environment(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(WORLD.replace('<plugin filename="mine:Mine" name="mine"/>', ""))
    made = certify(RunSpec(world=str(tmp_path / "w.sdf"), duration=0.1), runs=6, jobs=2)
    assert made.passed and not made.notes
    assert [row.variation.name for row in made.rows] == [v.name for v in VARIATIONS]
    assert len({row.outcome.state for row in made.rows}) == 1
    assert {row.streams for row in made.rows if row.variation.listening in ("called", "kept")} == {made.rows[0].streams}
    (heard,) = (h for t, h in made.rows[0].outcome.heard.items() if t.endswith("imu"))
    assert len(heard.digests) == 11 and heard.owner.startswith("sensor 'm::l::imu' (")
    assert made.rows[2].streams == "" and made.rows[3].outcome.heard_from == 50


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "way", "tick", "how", "hint"),
    [
        (
            "if self.sim.tick >= 40:\n    self.link.apply_wrench((time.time() % 1, 0, 0))",
            *("elsewhere", 40, "writes different inputs", "wall"),
        ),
        (
            "if self.sim.tick == 20:\n    self.drawn = random.random()\n"
            "if self.sim.tick > 60:\n    self.link.apply_wrench((self.drawn, 0, 0))",
            *("elsewhere", 61, "attributes differ: drawn (", "without the simulation's seed"),
        ),
        (
            "if self.sim.tick % 10 == 5:\n    names = {'alpha', 'beta', 'gamma', 'delta', 'epsilon'}\n"
            "    self.out.publish({'data': ' '.join(n for n in names)})",
            *("elsewhere", 5, "its output differs: /told", "sorted()"),
        ),
        (
            "if self.out.wanted and self.sim.tick == 30:\n    self.link.apply_wrench((1, 0, 0))",
            *("not received", 30, "writes different inputs", "depends on the subscribers"),
        ),
        (COUNTED, "restored", 50, "writes different inputs", "snapshots and resets do not restore it"),
        (COUNTED, "reset", 0, "writes different inputs", "snapshots and resets do not restore it"),
    ],
    ids=["clock", "dice", "set", "listener", "restore", "reset"],
)  # fmt: skip
def test_the_plugin_that_caused_a_difference_is_named_with_the_first_tick(
    body: str, way: str, tick: int, how: str, hint: str, tmp_path: Path
) -> None:
    made = certified(tmp_path, body, way, apart="'alpha'" in body)  # each process has its own order of sets
    (found,) = made.differences
    assert not made.passed
    assert found.owner.startswith("plugin 'm::mine' (") and "w.sdf:4)" in found.owner
    assert found.tick in (tick, tick + 1) and how in found.how
    assert any(hint in one.text and "mine.py:" in one.where for one in found.hints)
    assert not any("time.time" in one.text for one in found.hints if hint != "wall"), "that is the other class's"


def test_a_world_change_without_an_effect_on_outputs_is_a_note(tmp_path: Path) -> None:
    made = certified(tmp_path, "self.seen = time.time()")
    assert made.passed
    (note,) = made.notes
    assert "'m::mine'" in note and "(seen)" in note and "no output differs" in note


@pytest.mark.leaves_out
def test_a_certificate_names_the_plugin_that_every_run_leaves_out(tmp_path: Path) -> None:
    drive = "<plugin name='drive' filename='gz-sim-joint-controller-system'><joint_name>axel</joint_name></plugin>"
    (tmp_path / "w.sdf").write_text(WORLD.replace('<plugin filename="mine:Mine" name="mine"/>', drive))
    made = certify(RunSpec(world=str(tmp_path / "w.sdf"), duration=0.01), variations=VARIATIONS[:2], apart=False)
    name = "plugin 'drive' (gz-sim-joint-controller-system) of 'm'"
    assert made.passed and made.to_dict()["left_out"] == {name: 1}
    assert f"not certified, because the world runs without it: {name}" in conclusion_text(made)


@pytest.mark.leaves_out
@pytest.mark.slow
def test_a_plugin_that_only_one_process_leaves_out_fails_the_certificate(tmp_path: Path) -> None:
    fault = (
        "        if os.environ['PYTHONHASHSEED'] != '0':\n            params.error('SK-MINE-001', 'another process')\n"
    )
    made = certified(tmp_path, "pass", apart=True, load=fault)
    (found,) = made.differences
    assert not made.passed and found.words == "only the world of this run is without plugin 'mine' (mine:Mine) of 'm'"


def test_the_same_error_at_the_same_tick_is_no_difference(tmp_path: Path) -> None:
    made = certified(tmp_path, "if self.sim.tick == 30:\n    raise ValueError('at the same time')")
    assert made.passed
    assert "at the same time" in made.rows[0].outcome.end and made.rows[1].outcome.end == made.rows[0].outcome.end


def test_an_error_of_one_run_only_is_a_difference(tmp_path: Path) -> None:
    made = certified(tmp_path, "if not self.out.wanted:\n    raise ValueError('nobody')", "not received")
    (found,) = made.differences
    assert any("nobody" in text for text in (found.words, *found.more))


def test_commands_of_a_scenario_are_sent_in_every_run(tmp_path: Path, in_this_process: None) -> None:
    (tmp_path / "s.yaml").write_text(
        "world: w.sdf\nduration: 0.1\ncommands:\n"
        "  - {at: 0.03, until: 0.08, rate: 100, topic: /cmd, message: {data: 2}}\n"
    )
    plugin = '<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">'
    joint = '<link name="k"/><joint name="j" type="continuous"><parent>l</parent><child>k</child><axis/></joint>'
    mine = '<plugin filename="mine:Mine" name="mine"/>'
    (tmp_path / "w.sdf").write_text(
        WORLD.replace(mine, f"{joint}{plugin}<joint_name>j</joint_name><topic>/cmd</topic></plugin>")
    )
    done = CliRunner().invoke(
        app, ["certify", str(tmp_path / "s.yaml"), "--runs", "2", "--json", "-o", str(tmp_path / "c.json")]
    )
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert said["passed"] and said["topics"]["/cmd"]["count"] == 6 and said["ticks"] == 100
    assert json.loads((tmp_path / "c.json").read_text()) == said
    assert sorted(p.name for p in tmp_path.iterdir()) == ["c.json", "s.yaml", "w.sdf"]


def test_the_command_names_the_plugin_and_exits_with_5(tmp_path: Path, in_this_process: None) -> None:
    (tmp_path / "w.sdf").write_text(WORLD)
    (tmp_path / "mine.py").write_text(HEAD + "        self.link.apply_wrench((time.time() % 1, 0, 0))\n")
    given = ["certify", str(tmp_path / "w.sdf"), "--plugin-path", str(tmp_path), "--duration", "0.05", "--runs", "2"]
    done = CliRunner().invoke(app, given)
    assert done.exit_code == 5
    assert "DIFFERENT" in done.stdout and "caused by plugin 'm::mine'" in done.stdout and "hint:" in done.stdout


def test_all_errors_of_a_world_are_reported(tmp_path: Path, in_this_process: None) -> None:
    broken = WORLD.replace("<mass>1</mass>", "<mass>one</mass>").replace("update_rate>100", "update_rate>often")
    (tmp_path / "w.sdf").write_text(broken)
    certified, run = (CliRunner().invoke(app, [name, str(tmp_path / "w.sdf")]) for name in ("certify", "run"))
    assert certified.exit_code == 2 == run.exit_code
    assert certified.stderr.count(" error SK-") >= 2 and certified.stderr == run.stderr


def test_an_error_in_every_run_does_not_stop_the_steps_before_a_reset(tmp_path: Path) -> None:
    made = certified(tmp_path, "if self.sim.tick == 30:\n    raise ValueError('at the same time')", "reset")
    assert made.passed and made.rows[1].streams == made.rows[0].streams != ""


@pytest.mark.slow
def test_a_process_that_exits_is_a_difference_with_its_code_position(tmp_path: Path) -> None:
    made = certified(tmp_path, "if not self.out.wanted:\n    os._exit(7)", "not received", apart=True)
    (found,) = made.differences
    assert found.words == "the process ended with 7: no output"


@pytest.mark.skipif(sys.platform == "win32", reason="Windows does not have this signal")
@pytest.mark.slow
def test_a_process_that_the_system_kills_is_no_difference(tmp_path: Path) -> None:
    with pytest.raises(OutOfMemory, match="SK-CORE-008 .*killed the process of the run 'not received'"):
        certified(tmp_path, "if not self.out.wanted:\n    os.kill(os.getpid(), 9)", "not received", apart=True)


@pytest.mark.slow
def test_a_run_without_enough_memory_is_no_difference(tmp_path: Path) -> None:
    body = "from simkit.memory_error import OutOfMemory\nif not self.out.wanted:\n    raise OutOfMemory('no map')"
    with pytest.raises(OutOfMemory, match="SK-CORE-008 .*the run 'not received' did not fit"):
        certified(tmp_path, body, "not received", apart=True)


def test_a_run_that_hangs_names_the_running_code(tmp_path: Path) -> None:
    (tmp_path / "stack").write_text(
        'Timeout (0:00:02)!\nThread 0x2 (most recent call first):\n  File "other.py", line 3 in watch\n'
        '\nThread 0x1 (most recent call first):\n  File "a.py", line 7 in inner\n  File "b.py", line 9 in outer\n'
    )
    found = _outcome_of_stopped_process(ProcessResult(1, ""), 2.0, tmp_path / "stack")
    assert found.stopped.startswith("still running after 2 s of wall time")
    assert [str(place) for place in found.stack] == ["a.py:7", "b.py:9"]
    first = RunOutcome(sources={"plugin 'p'": ("b.py", 5, 12)})
    made = _code_at_timeout(Difference(VARIATIONS[1], "it hangs"), found, first)
    assert made.owner == "plugin 'p'" and made.how == "it was running outer at b.py:9"


def test_further_runs_repeat_the_variations_with_other_hash_seeds() -> None:
    assert [way.name for way in choose_variations(6, with_restore=False)][3:] == ["late", "reset", "elsewhere 2"]
    many = choose_variations(12)
    assert len({(v.name, v.hash_seed) for v in many}) == 12
    assert many[6].name == "elsewhere 2" and many[6].hash_seed != many[1].hash_seed


def test_a_hash_of_streams_depends_on_every_message() -> None:
    import numpy as np

    from simkit_verification.testing.certify.outcome import TopicOutcome

    one = TopicOutcome("T", np.zeros(1, np.uint64), np.zeros(1, np.int64), "aa")
    other = TopicOutcome("T", np.zeros(1, np.uint64), np.zeros(1, np.int64), "ab")
    assert streams_hash(RunOutcome(heard={"/a": one})) != streams_hash(RunOutcome(heard={"/a": other}))
    assert streams_hash(RunOutcome()) == ""


def test_one_run_is_not_a_certificate() -> None:
    with pytest.raises(InputError, match="SK-CERT-001"):
        certify(RunSpec(world="empty"), runs=1)
    refused = CliRunner().invoke(app, ["certify", "empty", "--runs", "1"])
    assert (refused.exit_code, refused.stdout) == (2, ""), "an error of an option has no table"


def test_a_scenario_that_does_not_fit_its_world_is_not_certified(tmp_path: Path) -> None:
    """Without an error, every run would end at once with equal, empty results."""
    command = {"at": 0.1, "topic": "/none", "message": {}}
    with pytest.raises(InputError, match="no topic '/none'"):
        certify(RunSpec(world="empty", duration=0.2, commands=(command,)), runs=2)
