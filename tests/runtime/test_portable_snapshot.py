"""Snapshots travel to other processes, and continue there with the same bits."""

from __future__ import annotations

import importlib
import multiprocessing
import pickle
import sys
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.runtime.engine.snapshot import state_hash

BOX = """<sdf version="1.9"><model name="newcomer"><pose>0 0 1 0 0 0</pose><link name="l"><collision name="c">
<geometry>
<box><size>.2 .2 .2</size></box></geometry></collision></link></model></sdf>"""

PLUGIN = """
from simkit.plugins import ModelPlugin


class Memory:
    def __init__(self):
        self.total = 0.0


class Pusher(ModelPlugin):
    def load(self, model, params):
        self.model, self.memory = model, Memory()
        self.heights = self.advertise("/height", "std_msgs/msg/Float64")

    def before_step(self):
        self.memory.total += self.model.pose.position[2]
        self.model.links["l"].apply_wrench((0.1 * self.memory.total, 0.0, 0.0))
        self.heights.publish({"data": self.memory.total})
"""
WORLD = """<sdf version="1.9"><world name="w"><model name="ground"><static>true</static><link name="l"><collision
name="c">
<geometry><plane><normal>0 0 1</normal></plane></geometry></collision></link></model>
<model name="lamp"><static>true</static><link name="l"/></model>
<model name="box"><pose>0 0 .5 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial><collision name="c">
<geometry>
<box><size>.2 .2 .2</size></box></geometry></collision><sensor name="imu" type="imu"><update_rate>100</update_rate>
<imu>
<linear_acceleration><x><noise type="gaussian"><stddev>.1</stddev></noise></x></linear_acceleration></imu></sensor>
</link>
<plugin filename="pusher.py" name="Pusher"/></model></world></sdf>"""


def load(folder: Path, seed: int = 4) -> simkit.Simulation:
    return simkit.load(WORLD, seed=seed, plugin_paths=[folder])


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "pusher.py").write_text(PLUGIN, encoding="utf-8")
    return tmp_path


def changed(sim: simkit.Simulation) -> None:
    """Change a world in every way that its file does not know of."""
    sim.run(0.1)
    sim.spawn(BOX, name="gone")
    sim.spawn(BOX, name="kept")
    sim.remove("gone")
    sim.contents.make_movable("lamp")
    sim.model("lamp").set_pose(simkit.Pose((1, 2, 3)))
    sim.contents.add_sensor("box::l", {"name": "extra", "type": "imu", "update_rate": 50, "imu": {}})
    sim.link("box::l").mass = 2.5
    sim.link("box::l").collisions["c"].friction = 0.3
    sim.sensor("box::l::imu").noise = 0.2
    sim.gravity = (0.5, 0.0, -4.0)
    sim.run(0.1)


def end(sim: simkit.Simulation) -> tuple[Any, ...]:
    """Return everything that a run shows after further steps."""
    heights = sim.subscribe("/height")
    sim.run(0.3)
    readings = [repr(simkit.msgs.serialize(sim.sensor(f"box::l::{name}").latest)) for name in ("imu", "extra")]
    lamp = sim.model("lamp").pose.position.tolist()
    return state_hash(sim), sim.tick, heights.latest.data, sim.link("box::l").mass, lamp, *readings


def continued(arguments: tuple[Path, bytes]) -> tuple[Any, ...]:
    folder, content = arguments
    with load(folder, seed=9) as sim:
        sim.run(0.05)
        sim.restore(pickle.loads(content))
        return end(sim)


METHODS = ["spawn"] if sys.platform in ("win32", "darwin") else ["spawn", "fork"]


@pytest.mark.parametrize("method", METHODS)
def test_a_changed_world_continues_in_another_process(folder: Path, method: str) -> None:
    with load(folder) as sim:
        changed(sim)
        content = pickle.dumps(sim.snapshot())
        with multiprocessing.get_context(method).Pool(1) as pool:
            found = pool.map(continued, [(folder, content)])[0]
        assert found == end(sim)
    assert len(content) < 20_000


def test_a_snapshot_is_pickled_after_the_world_went_on(folder: Path) -> None:
    with load(folder) as sim, load(folder) as other:
        changed(sim)
        snapshot = sim.snapshot()
        expected = end(sim)
        sim.remove("kept")
        portable = pickle.loads(pickle.dumps(snapshot))
        other.restore(portable)
        assert end(other) == expected
        sim.restore(portable)
        assert end(sim) == expected
        assert (portable.tick, portable.time, portable.size) == (200, 0.2, len(portable.content))
        assert (snapshot.time, snapshot.size) == (0.2, portable.size)


def test_another_world_refuses_a_snapshot_and_stays_as_it_is(folder: Path) -> None:
    with load(folder) as sim, simkit.load(WORLD.replace("<mass>1<", "<mass>2<"), plugin_paths=[folder]) as other:
        changed(sim)
        content = pickle.dumps(sim.snapshot())
        before = state_hash(other), list(other.models)
        with pytest.raises(ValueError, match="another world or other overrides"):
            other.restore(pickle.loads(content))
        assert (state_hash(other), list(other.models)) == before


def test_a_snapshot_with_a_class_that_moved_away_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Classes move between versions of simkit, for example to packs."""
    (folder / "notes_of_before.py").write_text("class Note: pass", encoding="utf-8")
    monkeypatch.syspath_prepend(folder)
    with load(folder) as sim:
        sim.plugins["box::Pusher"].note = importlib.import_module("notes_of_before").Note()
        content = pickle.dumps(sim.snapshot())
        (folder / "notes_of_before.py").unlink()
        del sys.modules["notes_of_before"]
        before = state_hash(sim)
        with pytest.raises(ValueError, match="another version of simkit or of a plugin took it: No module named"):
            sim.restore(pickle.loads(content))
        assert state_hash(sim) == before


def test_an_object_of_one_process_is_named(folder: Path) -> None:
    with load(folder) as sim:
        sim.plugins["box::Pusher"].late = sim.subscribe("/height")
        with pytest.raises(TypeError, match="state of plugin 'Pusher': a Subscription cannot be pickled"):
            pickle.dumps(sim.snapshot())


def test_messages_of_all_kinds_of_types_can_be_pickled() -> None:
    for name in ("sensor_msgs/msg/LaserScan", "gps_msgs/msg/GPSFix"):
        message = simkit.msgs.from_dict([name], {})
        assert simkit.msgs.serialize(pickle.loads(pickle.dumps(message))) == simkit.msgs.serialize(message)


def test_a_run_specification_can_be_pickled() -> None:
    with simkit.load(BOX, seed=3, overrides={"newcomer::l.mass": 2}) as sim:
        spec = sim.run_spec
    content = pickle.dumps(spec)
    assert pickle.loads(content) == spec and len(content) < 2000


def test_a_compact_snapshot_repeats_the_run_and_cannot_be_pickled() -> None:
    with simkit.load("turtlebot3_world", seed=3) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.2}, "angular": {"z": 0.7}})
        sim.step(100)
        before, small = sim.snapshot(), sim.snapshot(compact=True)
        found = []
        for snapshot in (before, small):
            sim.restore(snapshot)
            sim.step(150)
            found.append((state_hash(sim), str(sim.sensor("turtlebot3::imu_link::imu").latest)))
        assert found[0] == found[1]
        with pytest.raises(ValueError, match="compact"):
            pickle.dumps(small)
