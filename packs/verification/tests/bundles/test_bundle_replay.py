"""A replay repeats the run of a bundle with all external inputs, and reports differences."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit.errors import InputError, PluginError, SimulationDiverged
from simkit.runtime.engine.snapshot import state_hash
from simkit_verification.testing.bundles import keep, open_bundle, replay, write_bundle

WORLD = """<sdf version="1.9"><world name="yard">
<model name="cart"><pose>0 0 0.5 0 0 0</pose>
 <link name="base"><inertial><mass>2</mass></inertial>
  <collision name="c"><geometry><box><size>0.4 0.3 0.2</size></box></geometry></collision>
  <sensor name="imu" type="imu"><topic>/imu</topic><update_rate>100</update_rate>
   <imu><linear_acceleration><x><noise type="gaussian"><stddev>0.1</stddev></noise></x></linear_acceleration></imu>
  </sensor></link>
 <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"><topic>/go</topic></plugin>
</model>
<model name="box"><pose>2 0 1 0 0 0</pose><link name="l"><inertial><mass>1</mass></inertial>
 <collision name="c"><geometry><sphere><radius>0.2</radius></sphere></geometry></collision></link></model>
<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
</world></sdf>"""
BALL = '<sdf version="1.9"><model name="ball"><pose>0 3 2 0 0 0</pose><link name="l"/></model></sdf>'


def packed(sim: Any, folder: Path, **options: Any) -> Path:
    """Write a bundle of a run in its present state."""
    return write_bundle(sim, folder / "run.zip", **options)


def go(speed: float) -> dict[str, Any]:
    return {"linear": {"x": speed}}


def test_a_run_with_commands_is_repeated(tmp_path: Path) -> None:
    with simkit.load(WORLD, seed=7) as sim, keep(sim):
        sim.run(0.2)
        sim.publish("/go", go(0.3))
        sim.run(0.5)
        sim.publish("/go", go(-0.1))
        sim.run(0.3)
        found = replay(packed(sim, tmp_path))
        assert found.is_same
        assert found.state == state_hash(sim)
        assert found.messages >= 100, "a second of a 100 Hz IMU is among them"
        assert not found.refused


def test_the_same_run_gives_the_same_bytes(tmp_path: Path) -> None:
    files = []
    for name in ("a", "b"):
        with simkit.load(WORLD, seed=7) as sim, keep(sim):
            sim.publish("/go", go(0.3))
            sim.run(0.3)
            files.append(write_bundle(sim, tmp_path / f"{name}.zip").read_bytes())
    assert files[0] == files[1]


def test_numbers_are_recorded_in_full_precision(tmp_path: Path) -> None:
    heard: list[float] = []

    class Listener(simkit.WorldPlugin):
        def load(self, parent: Any, params: Any) -> None:
            self.listen("/gain", "std_msgs/msg/Float32", lambda message: heard.append(message.data))

    with simkit.load(WORLD, plugins=[Listener()]) as sim, keep(sim):
        sim.publish("/gain", {"data": 0.1})
        sim.run(0.1)
        with open_bundle(packed(sim, tmp_path)) as bundle:
            entry = next(bundle.commands())
    assert heard == [0.1]
    assert entry["message"]["fields"]["data"] == 0.1, "CDR would make 0.10000000149 of it"


def test_messages_sent_by_a_callback_are_repeated_in_the_same_step(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, keep(sim):
        count = 0

        def answer(message: Any) -> None:
            nonlocal count
            count += 1
            sim.publish("/go", go(0.01 * count + message.linear_acceleration.x * 1e-3))

        sim.subscribe("/imu", answer)
        sim.run(0.5)
        found = replay(packed(sim, tmp_path))
        assert count > 40
        assert found.is_same, found.differences
        assert found.manifest.commands == count + 1, "the subscription and each answer"


def test_direct_changes_are_repeated(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, keep(sim):
        sim.run(0.1)
        sim.model("box").set_pose(simkit.Pose((1.0, 2.0, 3.0)))
        sim.run(0.1)
        sim.link("box::l").apply_wrench((5.0, 0.0, 1.0))
        sim.step(3)
        sim.gravity = (0.0, 0.1, -5.0)
        sim.run(0.1)
        sim.mj_data.qvel[0] += 0.25
        sim.run(0.1)
        found = replay(packed(sim, tmp_path))
        assert found.is_same, found.differences


@pytest.mark.slow
def test_changed_masses_and_dynamics_are_repeated(tmp_path: Path) -> None:
    """The start of a robot repeats bit for bit although its mass and its wheels change, also after a kept reset."""
    with simkit.load("turtlebot3_world") as sim, keep(sim):
        drive = sim.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        sim.run(0.2)
        sim.link("turtlebot3::base_link").mass = 4.0
        sim.joint("turtlebot3::wheel_left_joint").damping = 0.1
        sim.link("turtlebot3::wheel_right_link").collisions["tread"].friction = 0.3
        drive.publish({"linear": {"x": 0.2}})
        sim.run(0.5)
        sim.reset(keep_changes=True)
        drive.publish({"linear": {"x": 0.2}})
        sim.run(0.5)
        path = packed(sim, tmp_path)
    assert replay(path).is_same


def test_spawn_remove_reset_and_restore_are_repeated(tmp_path: Path) -> None:
    (tmp_path / "ball.sdf").write_text(BALL)
    with simkit.load(WORLD) as sim, keep(sim):
        sim.run(0.1)
        sim.spawn(BALL)
        sim.run(0.1)
        sim.spawn(tmp_path / "ball.sdf", name="second", pose=simkit.Pose((0, 5, 1)))
        before = sim.snapshot()
        sim.run(0.2)
        sim.remove("box")
        sim.restore(before)
        sim.contents.clone("ball", "third", simkit.Pose((4.0, 0.0, 2.0)))
        sim.run(0.1)
        sim.reset(seed=4)
        sim.run(0.2)
        sim.call("/world/yard/control", {"world_control": {"multi_step": 5}})
        sim.run(0.05)
        path = packed(sim, tmp_path)
        (tmp_path / "ball.sdf").unlink()
        found = replay(path)
        assert found.is_same, (found.differences, found.refused)
        assert not found.refused


def test_publishers_that_are_closed_and_opened_are_repeated(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, keep(sim):
        sim.run(0.1)
        publisher = sim.communication.bus.advertise("/chatter", "std_msgs/msg/String")
        publisher.publish({"data": "hello"})
        sim.run(0.1)
        other = sim.communication.bus.advertise("/go", "geometry_msgs/msg/Twist")
        other.publish(simkit.msgs.make("geometry_msgs/msg/Twist", **go(0.4)))
        sim.run(0.1)
        sim.communication.bus.close(other)
        sim.run(0.1)
        found = replay(packed(sim, tmp_path))
        assert found.is_same, found.differences
        assert found.manifest.streams["/chatter"]["count"] == 1


def test_a_run_that_diverges_is_repeated(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim:
        sim_kept = keep(sim, tmp_path)
        sim.run(0.1)
        sim.link("box::l").apply_wrench((1e30, 0.0, 0.0))
        with pytest.raises(SimulationDiverged) as raised, sim_kept as kept:
            sim.run(1.0)
        assert kept.written is not None
        assert "SK-PHYS-001" in kept.written.name
        assert any("simkit replay" in note for note in raised.value.__notes__)
        found = replay(kept.written)
    assert found.is_same, found.differences
    assert found.failure is not None
    assert found.failure.code == "SK-PHYS-001"


PLUGIN = """
import simkit

class Boom(simkit.ModelPlugin):
    def load(self, model, params):
        self.limit = params.number("limit", 0.25)

    def after_step(self):
        if self.sim.time > self.limit:
            raise ValueError(f"no more at {self.sim.time}")
"""
WITH_PLUGIN = WORLD.replace('<model name="box">', '<model name="box"><plugin filename="boom.py" name="Boom"/>')


def failed(tmp_path: Path) -> Path:
    """Write a bundle of a run in which a plugin raised an exception."""
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "boom.py").write_text(PLUGIN)
    with simkit.load(WITH_PLUGIN, plugin_paths=[tmp_path / "code"]) as sim:
        with pytest.raises(PluginError), keep(sim, tmp_path / "bundles") as kept:
            sim.run(1.0)
        assert kept.written is not None
        return kept.written


def test_plugin_code_runs_only_if_allowed(tmp_path: Path) -> None:
    path = failed(tmp_path)
    with open_bundle(path) as bundle:
        assert bundle.manifest.code == ("code/0/boom.py",)
        assert bundle.read("code/0/boom.py").decode() == PLUGIN
    with pytest.raises(InputError, match=r"SK-BUNDLE-005 .*boom\.py"):
        replay(path)
    found = replay(path, allow_code=True)
    assert found.is_same, found.differences
    assert found.failure is not None
    assert "no more at 0.251" in found.failure.text


def test_a_bundle_has_no_folder_of_the_machine_that_made_it(tmp_path: Path) -> None:
    with zipfile.ZipFile(failed(tmp_path)) as archive:
        for name in archive.namelist():
            assert str(tmp_path).encode() not in archive.read(name), name


def test_a_different_replay_reports_second_and_topic(tmp_path: Path) -> None:
    with simkit.load(WORLD, seed=1) as sim, keep(sim):
        sim.run(1.5)
        sim.publish("/go", go(0.2))
        sim.run(1.0)
        path = packed(sim, tmp_path)
    forged = tmp_path / "forged.zip"
    _rewritten(path, forged, lambda line: line.replace(b'"x": 0.2', b'"x": 0.3'))
    found = replay(forged)
    assert not found.is_same
    assert "equal up to 1 s, differs at 2 s" in found.differences[0]
    assert any(text.startswith("/go: content differs from t = 1.5 s on") for text in found.differences)


def _rewritten(path: Path, target: Path, change: Any) -> None:
    """Write a copy of a bundle with a changed journal and the matching hash."""
    import hashlib

    with zipfile.ZipFile(path) as old, zipfile.ZipFile(target, "w") as new:
        page = json.loads(old.read("bundle.json"))
        commands = change(old.read("commands.jsonl"))
        page["files"]["commands.jsonl"] = {"size": len(commands), "sha256": hashlib.sha256(commands).hexdigest()}
        for name in old.namelist():
            data = {"bundle.json": json.dumps(page).encode(), "commands.jsonl": commands}.get(name)
            new.writestr(name, old.read(name) if data is None else data)


def test_a_world_edited_during_the_run_is_reported(tmp_path: Path) -> None:
    world = tmp_path / "world.sdf"
    world.write_text(WORLD)
    with simkit.load(world) as sim, keep(sim):
        sim.run(0.1)
        world.write_text(WORLD.replace("<mass>2</mass>", "<mass>3</mass>"))
        with open_bundle(packed(sim, tmp_path)) as bundle:
            assert any("edited after the run began" in text for text in bundle.manifest.missing)


def test_files_outside_the_world_folder_are_packed(tmp_path: Path) -> None:
    (tmp_path / "models" / "ball").mkdir(parents=True)
    (tmp_path / "models" / "ball" / "model.sdf").write_text(BALL)
    (tmp_path / "models" / "ball" / "model.config").write_text(
        '<model><name>ball</name><sdf version="1.9">model.sdf</sdf></model>'
    )
    (tmp_path / "worlds").mkdir()
    world = tmp_path / "worlds" / "w.sdf"
    world.write_text(WORLD.replace("</world>", "<include><uri>model://ball</uri></include></world>"))
    spawned = [f"{tmp_path / 'models' / 'ball'}:1,1,0:other"]
    options: dict[str, Any] = {"resource_paths": [tmp_path / "models"], "spawn": spawned}
    with simkit.load(world, overrides=["box::l.inertial.mass=3"], **options) as sim, keep(sim):
        assert {"ball", "other"} <= sim.models.keys()
        sim.run(0.2)
        path = packed(sim, tmp_path)
    import shutil

    shutil.rmtree(tmp_path / "models")
    shutil.rmtree(tmp_path / "worlds")
    found = replay(path)
    assert found.is_same, found.differences
    assert not found.manifest.missing


def test_only_the_last_seconds_are_kept(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, keep(sim, seconds=0.5):
        sim.run(2.0)
        found = replay(packed(sim, tmp_path))
    assert found.is_same
    assert found.manifest.streams["/imu"]["count"] in (50, 51)


def test_keeping_changes_no_bit() -> None:
    states = []
    for is_kept in (False, True):
        with simkit.load(WORLD, seed=2) as sim:
            if is_kept:
                keep(sim)
            sim.publish("/go", go(0.2))
            sim.run(0.5)
            states.append((sim.mj_data.qpos.tobytes(), sim.sensor("cart::base::imu").latest.linear_acceleration.x))
    assert states[0] == states[1]


def test_a_run_that_has_begun_cannot_be_recorded() -> None:
    with simkit.load(WORLD) as sim:
        sim.step()
        with pytest.raises(InputError, match="SK-BUNDLE-007"):
            keep(sim)
        with pytest.raises(InputError, match="SK-BUNDLE-007"):
            write_bundle(sim, "nowhere.zip")


def test_an_existing_bundle_is_not_overwritten(tmp_path: Path) -> None:
    with simkit.load(WORLD) as sim, keep(sim):
        packed(sim, tmp_path)
        with pytest.raises(InputError, match="SK-CLI-016"):
            packed(sim, tmp_path)
        packed(sim, tmp_path, overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == ["run.zip"]
