"""Step loop, state and handles of small worlds."""

import math
import subprocess
import sys
from typing import Any

import numpy as np
import pytest

import simkit
from simkit.runtime.engine.physics_state import ENGINE_WARNINGS
from simkit.sensors import Altimeter, Lidar

BALL = """<sdf version="1.9"><world name="w"><gravity>0 0 -9.8</gravity>{extra}
  <model name="ball"><pose>0 0 5 0 0 0</pose><link name="l"><inertial><mass>2</mass></inertial>
    <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link></model>
</world></sdf>"""

SWING = """<sdf version="1.9"><world name="w">
  <model name="m"><link name="base"><inertial><mass>10</mass></inertial></link>
    <link name="arm"><pose>0 0 0 0 0 0</pose><inertial><pose>0 0 -0.5 0 0 0</pose><mass>1</mass>
      <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
    <joint name="fix" type="fixed"><parent>world</parent><child>base</child></joint>
    <joint name="hinge" type="revolute"><parent>base</parent><child>arm</child>
      <axis><xyz>0 1 0</xyz><limit><effort>3</effort></limit></axis></joint></model></world></sdf>"""

BOX = """<sdf version="1.9"><model name="{name}"><pose>{x} 0 3 0 0 0</pose>
  <link name="l"><inertial><mass>1</mass></inertial>
  <collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model></sdf>"""


def load(text, **options):
    return simkit.load(text, **options)


def test_free_fall_is_semi_implicit_euler_to_the_last_digit():
    with load(BALL.format(extra="")) as sim:
        sim.step(500)
        n, dt = 500, 0.001
        assert sim.model("ball").pose.position[2] == pytest.approx(5 - 9.8 * dt * dt * n * (n + 1) / 2, abs=1e-12)
        assert sim.link("ball::l").linear_velocity[2] == pytest.approx(-9.8 * 0.5, abs=1e-12)
        assert sim.time == 0.5 and sim.time_ns == 500_000_000 and sim.tick == 500


def test_acceleration_of_a_falling_link_is_gravity_and_at_rest_zero():
    with load(BALL.format(extra="")) as sim:
        sim.step(3)
        np.testing.assert_allclose(sim.link("ball::l").linear_acceleration, [0, 0, -9.8], atol=1e-9)


@pytest.mark.parametrize("chunks", [[400], [1] * 400, [7] * 57 + [1], [399, 1]])
def test_chunks_of_steps_and_readings_do_not_change_any_bit(chunks):
    with load(SWING) as sim, load(SWING) as reference:
        sim.joint("m::hinge").set_position(1.0)
        reference.joint("m::hinge").set_position(1.0)
        reference.step(400)
        for count in chunks:
            sim.step(count)
            sim.link("m::arm").pose  # noqa: B018 - reading makes the forward pass
        assert sim.joint("m::hinge").position == reference.joint("m::hinge").position
        assert sim.joint("m::hinge").velocity == reference.joint("m::hinge").velocity


def test_a_state_that_is_set_is_read_back_without_a_step():
    with load(SWING) as sim:
        sim.joint("m::hinge").set_position(math.pi / 2)
        assert sim.joint("m::hinge").position == pytest.approx(math.pi / 2)
        np.testing.assert_allclose(sim.link("m::arm").pose.rpy, [0, math.pi / 2, 0], atol=1e-9)


def test_several_joint_positions_are_set_together():
    with load(SWING) as sim:
        sim.model("m").set_joint_positions({"hinge": 0.3})
        assert sim.joint("m::hinge").position == pytest.approx(0.3)


def test_the_twist_of_a_model_is_about_its_origin_in_the_world_frame():
    with load(BALL.format(extra="")) as sim:
        sim.model("ball").set_pose(simkit.Pose.from_rpy(0, 0, 5, 0.4, -0.2, 1.0))
        sim.model("ball").set_velocity((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))
        np.testing.assert_allclose(sim.link("ball::l").linear_velocity, [1, 2, 3], atol=1e-12)
        np.testing.assert_allclose(sim.link("ball::l").angular_velocity, [0.1, 0.2, 0.3], atol=1e-12)


class Accelerometer(simkit.WorldPlugin):
    """Store the acceleration that it reads after every step."""

    def load(self, parent, params):
        self.link, self.read = parent.link("m::arm"), []

    def after_step(self):
        self.read.append(self.link.linear_acceleration)


def test_a_hook_at_every_step_never_reads_nan_or_infinite_numbers():
    plugin = Accelerometer()
    with load(SWING, plugins=[plugin]) as sim:
        sim.step(5)
        sim.mj_data.qvel[:] = np.nan
        with pytest.raises(simkit.SimulationDiverged):
            sim.step(50)
        assert len(plugin.read) == 5
        assert np.isfinite(plugin.read).all()


def test_an_effort_is_clipped_and_lasts_one_step():
    with load(SWING) as sim:
        hinge = sim.joint("m::hinge")
        hinge.set_effort(100.0)
        assert hinge.effort == pytest.approx(3.0)
        sim.step()
        # 3 N m on 0.01 + 1·0.5² kg m², no gravity torque while hanging straight down
        assert hinge.velocity == pytest.approx(3.0 / 0.26 * 0.001, rel=1e-3)
        before = hinge.velocity
        sim.step()
        assert hinge.velocity < before


def test_a_wrench_acts_for_one_step():
    with load(BALL.format(extra="")) as sim:
        sim.link("ball::l").apply_wrench((20.0, 0, 0))
        sim.step(10)
        assert sim.link("ball::l").linear_velocity[0] == pytest.approx(20.0 / 2 * 0.001, rel=1e-9)


def test_a_joint_carries_the_weight_below_it():
    with load(SWING) as sim:
        sim.step(10)
        force, torque = sim.joint("m::hinge").transmitted_wrench
        np.testing.assert_allclose(force, [0, 0, 9.8], atol=1e-3)
        np.testing.assert_allclose(torque, 0, atol=1e-3)


def test_a_velocity_limit_set_on_the_handle_is_enforced_at_every_step():
    with load(SWING) as sim:
        hinge = sim.joint("m::hinge")
        hinge.set_position(1.5)
        hinge.velocity_limit = 0.5
        for _ in range(300):
            sim.step()
            assert abs(hinge.velocity) <= 0.5 + 1e-12


def test_a_restored_run_repeats_and_so_does_a_reset():
    with load(SWING) as sim:
        hinge = sim.joint("m::hinge")
        hinge.set_position(1.0)
        sim.step(100)
        snapshot = sim.snapshot()
        sim.step(200)
        first = hinge.position
        sim.restore(snapshot)
        assert sim.tick == 100
        sim.step(200)
        assert hinge.position == first
        sim.reset()
        assert sim.tick == 0 and hinge.position == 0.0


def test_spawn_and_remove_do_not_change_the_bits_of_other_models():
    with load(BALL.format(extra="")) as sim, load(BALL.format(extra="")) as alone:
        sim.step(50)
        ball = sim.model("ball")
        box = sim.spawn(BOX.format(name="box", x=3.0))
        assert box.pose.position[0] == pytest.approx(3.0)
        sim.step(100)
        sim.remove("box")
        sim.step(50)
        alone.step(200)
        np.testing.assert_array_equal(ball.pose.position, alone.model("ball").pose.position)
        assert "box" not in sim.models
        with pytest.raises(simkit.InputError, match="removed"):
            box.pose  # noqa: B018


def test_a_snapshot_belongs_to_one_simulation():
    with load(BALL.format(extra="")) as sim, load(BALL.format(extra="")) as other:
        with pytest.raises(ValueError, match="another simulation"):
            other.restore(sim.snapshot())
        other.step(3)
        assert other.tick == 3


def test_restore_undoes_removals_and_spawns():
    with load(BALL.format(extra="")) as sim:
        sim.spawn(BOX.format(name="box", x=3.0))
        sim.step(20)
        snapshot = sim.snapshot()
        sim.step(100)
        first = sim.model("box").pose.position.copy()
        sim.restore(snapshot)
        sim.remove("box")
        sim.spawn(BOX.format(name="other", x=-3.0))
        sim.step(5)
        sim.restore(snapshot)
        assert set(sim.models) == {"ball", "box"}
        sim.step(100)
        np.testing.assert_array_equal(sim.model("box").pose.position, first)
        sim.reset()
        assert set(sim.models) == {"ball"}


@pytest.mark.parametrize("place", [(0, 0, 1), "0 0 1", 3])
def test_the_error_for_a_pose_of_another_type_shows_a_pose(place):
    with load(BALL.format(extra="")) as sim:
        for put in (
            lambda: sim.spawn(BOX.format(name="box", x=1.0), pose=place),
            lambda: sim.model("ball").set_pose(place),
        ):
            with pytest.raises(TypeError, match=r"a pose is a simkit.Pose, such as simkit.Pose\(\(0, 0, 1\)\), got"):
                put()
        assert list(sim.models) == ["ball"]


def test_a_spawn_with_an_existing_name_is_an_error():
    with load(BALL.format(extra="")) as sim, pytest.raises(simkit.LoadError, match="SK-LOAD-011"):
        sim.spawn(BOX.format(name="ball", x=1.0))


def test_a_model_whose_plugin_has_an_error_is_not_spawned():
    broken = BOX.format(name="box", x=3.0).replace(
        "</model>", '<plugin name="p" filename="libsolar_sensor.so"><frame_name>nowhere</frame_name></plugin></model>'
    )
    with load(BALL.format(extra="")) as sim:
        sim.step(10)
        with pytest.raises(simkit.LoadError, match="SK-PLUGIN-003"):
            sim.spawn(broken)
        assert set(sim.models) == {"ball"}
        assert sim.tick == 10
        sim.step(10)


def test_a_static_model_can_be_moved_and_still_supports_bodies():
    table = """<model name="table"><static>true</static><link name="l"><collision name="c"><geometry><box>
      <size>1 1 0.2</size></box></geometry></collision></link></model>"""
    with load(BALL.format(extra=table)) as sim:
        sim.model("table").set_pose(simkit.Pose((0, 0, 4.0)))
        np.testing.assert_allclose(sim.link("table::l").pose.position, [0, 0, 4])
        sim.run(2.0)
        assert sim.model("ball").pose.position[2] == pytest.approx(4.2, abs=2e-3)
        sim.reset()
        np.testing.assert_allclose(sim.model("table").pose.position, 0, atol=1e-12)


def test_bodies_pass_through_disabled_collisions():
    ground = """<model name="g"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
      </collision></link></model>"""
    with load(BALL.format(extra=ground)) as sim:
        link = sim.link("ball::l")
        assert link.collisions_enabled
        link.collisions_enabled = False
        sim.run(1.5)
        assert sim.model("ball").pose.position[2] < -1
        sim.reset()
        assert link.collisions_enabled
        sim.run(2.0)
        assert sim.model("ball").pose.position[2] == pytest.approx(0.1, abs=2e-3)


def test_a_divergence_has_no_engine_text_of_an_earlier_simulation():
    texts = []
    for _ in range(2):
        with load(SWING) as sim:
            sim.mj_data.qvel[:] = np.nan
            with pytest.raises(simkit.SimulationDiverged) as caught:
                sim.step(3)
            texts.append(str(caught.value))
            ENGINE_WARNINGS.record("left over")
    assert texts[0] == texts[1] and "left over" not in texts[1]


def test_a_diverged_run_stops_with_the_joint_and_the_time():
    with load(SWING) as sim:
        sim.step(10)
        sim.mj_data.qvel[:] = np.nan
        with pytest.raises(simkit.SimulationDiverged) as caught:
            sim.step(100)
        assert caught.value.joint == "m::hinge"
        assert caught.value.time == pytest.approx(0.010, abs=2e-3)
        assert caught.value.exit_code == 3


def test_the_error_for_an_unknown_name_suggests_the_closest_name():
    with load(SWING) as sim, pytest.raises(KeyError, match="m::hinge"):
        sim.joint("m::hinje")


def test_run_until_stops_when_the_condition_holds():
    with load(BALL.format(extra="")) as sim:
        assert sim.run_until(lambda s: s.model("ball").pose.position[2] < 4.5, timeout=2.0)
        assert sim.time == pytest.approx(math.sqrt(2 * 0.5 / 9.8), abs=2e-3)
        assert not sim.run_until(lambda s: False, timeout=0.01)


def test_run_until_takes_a_condition_as_text():
    with load(BALL.format(extra="")) as sim:
        assert sim.run_until("pose('ball').z < 4.5", timeout=2.0)
        assert sim.time == pytest.approx(math.sqrt(2 * 0.5 / 9.8), abs=2e-3)
        assert not sim.run_until("pose('ball').z > 4.5", timeout=0.01)
        with pytest.raises(simkit.InputError, match="SK-COND-005"):
            sim.run_until("pose('bal').z < 4.5", timeout=1.0)


TWO_WHEELS = """<sdf version="1.9"><model name="m"><link name="left"><sensor name="imu" type="imu"/></link>
<link name="right"><sensor name="imu" type="imu"/><sensor name="height" type="altimeter"/></link></model></sdf>"""


def test_a_last_name_finds_a_sensor_if_only_one_sensor_has_it():
    with load(TWO_WHEELS) as sim:
        assert list(sim.sensors) == ["m::left::imu", "m::right::imu", "m::right::height"]
        assert sim.sensor("height") is sim.sensors["m::right::height"] is sim.sensor("m::right::height")
        with pytest.raises(KeyError, match="2 sensors have the name 'imu': m::left::imu, m::right::imu"):
            sim.sensor("imu")


def test_a_sensor_of_another_class_than_the_given_one_is_an_error():
    with load(TWO_WHEELS) as sim:
        assert sim.sensor("height", type=Altimeter).kind == "altimeter"
        with pytest.raises(simkit.InputError, match="SK-NAME-007"):
            sim.sensor("height", type=Lidar)


def test_completion_of_a_sensor_lists_what_users_need():
    with load(TWO_WHEELS) as sim:
        names = dir(sim.sensor("height"))
        assert {"latest", "truth", "pose", "noise", "set_rate"} <= set(names)
        assert not {"attach", "bind", "sample_only_while", "_sample"} & set(names)
        assert len(names) < 25
        assert all(hasattr(sim.sensor("height"), name) for name in names)


def test_completion_leaves_out_what_only_simkit_calls():
    with load(TWO_WHEELS) as sim:
        model = next(iter(sim.models.values()))
        publisher, subscription = sim.advertise("/text", "std_msgs/msg/String"), sim.subscribe("/text")
        listed = {*dir(sim), *dir(model), *dir(publisher), *dir(subscription), *dir(sim.tf)}
        assert {"run", "models", "pose", "set_pose", "publish", "latest", "lookup", "engine"} - listed == {"engine"}
        assert not {"check_present", "replace_scene", "send_kept", "restore_latest", "set_state"} & listed


def test_completion_of_modules_lists_public_names_and_message_classes():
    assert {*dir(simkit)} == {*simkit.__all__, *simkit._PUBLIC_MODULES}
    assert dir(simkit.testing) == sorted(simkit.testing.__all__)
    assert {"LaserScan", "pose"} <= {*dir(simkit.msgs)}


class Counter(simkit.WorldPlugin):
    """Count the calls of its hooks."""

    before_step_rate = 100.0

    def load(self, parent, params):
        self.before, self.after = [], []

    def before_step(self):
        self.before.append(self.sim.tick)

    def after_step(self):
        self.after.append(self.sim.tick)


def test_hooks_run_at_their_rates_and_none_means_every_step():
    plugin = Counter()
    with load(BALL.format(extra=""), plugins=[plugin]) as sim:
        sim.step(25)
        assert plugin.after == list(range(1, 26))
        assert plugin.before == [10, 20]
        sim.reset()
        assert plugin.after == []
        sim.step(10)
        sim.step(1)
        assert plugin.before == [10]


class Breaks(simkit.WorldPlugin):
    """Raise an exception in the third step."""

    def load(self, parent, params):
        pass

    def after_step(self):
        if self.sim.tick == 3:
            raise RuntimeError("broken on purpose")


def test_a_plugin_that_raises_stops_the_run_with_its_name_and_time():
    with load(BALL.format(extra=""), plugins=[Breaks()]) as sim:
        with pytest.raises(simkit.PluginError, match="Breaks.*0.003") as caught:
            sim.step(10)
        assert isinstance(caught.value.__cause__, RuntimeError)


def test_importing_simkit_does_not_import_mujoco_or_opengl():
    heavy = "{'mujoco', 'OpenGL', 'rosbags', 'cv2', 'trimesh'}"
    code = f"import simkit, sys; bad = {heavy} & set(sys.modules); sys.exit(str(bad) if bad else 0)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_reset_within_a_callback_ends_the_tick() -> None:
    imu = '<sensor name="{}" type="imu"><update_rate>100</update_rate><imu><angular_velocity><x><noise type="gaussian">'
    imu += "<stddev>1</stddev></noise></x></angular_velocity></imu></sensor>"
    text = f"""<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
      {imu.format("a")}{imu.format("b")}</link></model></world></sdf>"""

    def numbers(reset_at: int) -> list[tuple[int, float]]:
        found: list[tuple[int, float]] = []
        with simkit.load(text, seed=3) as sim:
            topics = {name: sim.sensor(f"m::l::{name}").topic for name in "ab"}

            def look(_message: Any) -> None:
                nonlocal reset_at
                if sim.tick == reset_at:
                    reset_at = -1
                    found.clear()
                    sim.reset()

            sim.subscribe(topics["a"], look)
            sim.subscribe(topics["b"], lambda m: found.append((sim.tick, m.angular_velocity.x)))
            sim.step(100)
            assert sim.engine.steps == 100
        return found

    assert numbers(reset_at=50) == [found for found in numbers(reset_at=-1) if found[0] <= 50]


def test_a_plugin_that_resets_repeatedly_does_not_prevent_the_end_of_a_run() -> None:
    class Episodes(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            pass

        def after_step(self) -> None:
            if self.sim.tick == 30:
                self.sim.reset()

    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>', plugins=[Episodes()]) as sim:
        sim.step(100)
        assert (sim.engine.steps, sim.tick) == (100, 10)
        sim.run(0.05)
        assert (sim.engine.steps, sim.tick) == (150, 0)


def test_all_of_several_models_are_spawned_or_none() -> None:
    ball = '<sdf version="1.9"><model name="{}"><pose>0 0 {} 0 0 0</pose><link name="l"/></model></sdf>'
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        sim.step(10)
        models = sim.contents.spawn_all([(ball.format(name, z), None, None) for z, name in enumerate("abc")])
        assert [(m.name, float(m.pose.position[2])) for m in models] == [("a", 0.0), ("b", 1.0), ("c", 2.0)]
        before = sim.snapshot()
        with pytest.raises(simkit.LoadError, match="a model 'd' exists already"):
            sim.contents.spawn_all([(ball.format("d", 3), None, None), (ball.format("e", 3), "d", None)])
        assert list(sim.models) == ["a", "b", "c"]
        sim.step(5)
        sim.restore(before)
        sim.remove("b")
        assert [
            m.name for m in sim.contents.spawn_all([(ball.format("b", 1), "x", None), (ball.format("b", 1), "b", None)])
        ] == [
            "x",
            "b",
        ]
        assert sim.contents.spawn_all([]) == []
