"""Grouped hooks and sensor batches give the same bits, order and snapshots as separate plugins and sensors."""

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.errors import PluginError, SubscriberError
from simkit.runtime.engine import step_tasks
from simkit.sensors import sensor_batch

COUNT = 5

ROBOT = """
<model name="robot_{i}">
  <pose>{x} {y} 0.1 0 0 {yaw}</pose>
  <link name="base">
    <inertial><mass>2</mass><inertia><ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial>
    <collision name="hull"><geometry><box><size>0.2 0.2 0.1</size></box></geometry></collision>
    <collision name="ball"><pose>-0.08 0 -0.08 0 0 0</pose><geometry><sphere><radius>0.02</radius></sphere></geometry>
      <surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface></collision>
    <sensor name="imu" type="imu"><pose>0.02 0 0.03 0 0 {turn}</pose><topic>imu_{i}</topic>
      <update_rate>200</update_rate>{imu}</sensor>
    <sensor name="lidar" type="lidar"><pose>0 0 0 0 0 0</pose><topic>scan_{i}</topic><update_rate>20</update_rate>
      <lidar><scan><horizontal><samples>40</samples><min_angle>-3.1</min_angle><max_angle>3.1</max_angle></horizontal>
      {layers}</scan><range><min>0.15</min><max>4</max></range>{ray_noise}</lidar></sensor>
  </link>
  {wheels}
  <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
    <left_joint>left</left_joint><right_joint>right</right_joint><wheel_separation>0.24</wheel_separation>
    <wheel_radius>{radius}</wheel_radius><max_linear_acceleration>1</max_linear_acceleration>
    <min_linear_acceleration>-1</min_linear_acceleration><topic>cmd_{i}</topic><odom_topic>odom_{i}</odom_topic>
    <tf_topic>tf</tf_topic>{drive}
  </plugin>
  {more}
</model>
"""
WHEEL = """
<link name="{side}_wheel"><pose>0.03 {y} -0.05 -1.5708 0 0</pose>
  <inertial><mass>0.1</mass><inertia><ixx>1e-4</ixx><iyy>1e-4</iyy><izz>1e-4</izz></inertia></inertial>
  <collision name="tread"><geometry><cylinder><radius>0.05</radius><length>0.02</length></cylinder></geometry>
  </collision></link>
<joint name="{side}" type="revolute"><parent>base</parent><child>{side}_wheel</child><axis><xyz>0 0 1</xyz></axis>
</joint>
"""
NOISE = '<noise type="gaussian"><mean>0.001</mean><stddev>0.01</stddev></noise>'
NOISY_IMU = f"<imu><angular_velocity><x>{NOISE}</x><y>{NOISE}</y></angular_velocity></imu>"
LAYERS = "<vertical><samples>3</samples><min_angle>-0.1</min_angle><max_angle>0.1</max_angle></vertical>"
HEAD = """
<sdf version="1.9"><world name="w"><physics type="ignored"><max_step_size>0.001</max_step_size></physics>
<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry></collision>
</link></model>
"""


def robot(i, **parts):
    """Return the `i`-th robot of a ring, in which the lidars detect the neighbouring robots."""
    given = {"imu": NOISY_IMU, "ray_noise": NOISE, "layers": "", "drive": "", "more": "", "turn": 0.0, "radius": 0.05}
    angle = 2 * np.pi * i / COUNT
    place = {"x": 1.5 * np.cos(angle), "y": 1.5 * np.sin(angle), "yaw": 0.3 * (i + 1)}
    wheels = WHEEL.format(side="left", y=0.12) + WHEEL.format(side="right", y=-0.12)
    return ROBOT.format(i=i, wheels=wheels, **{**place, **given, **parts})


def world(count=COUNT, **parts):
    return HEAD + "".join(robot(i, **parts) for i in range(count)) + "</world></sdf>"


def command_robots(sim):
    for topic in sim.topics():
        if topic.startswith("/cmd_"):
            sim.publish(topic, {"linear": {"x": 0.2}, "angular": {"z": 0.1 * int(topic[-1])}})


def log_messages(sim, log, **how):
    """Log every message of every robot in the order of arrival."""
    for topic in sorted(sim.topics()):
        if topic.startswith(("/imu_", "/scan_", "/odom_", "/tf")) and not topic.endswith("points"):
            sim.subscribe(topic, lambda m, topic=topic: log.append((topic, msgs.serialize(m))), **how)


def run(source, duration=0.12, change=lambda sim: None):
    log = []
    with simkit.load(source, seed=3) as sim:
        log_messages(sim, log)
        command_robots(sim)
        change(sim)
        sim.run(duration)
        truths = [msgs.serialize(s.truth) for s in sim.contents.sensors.values()]
        state = np.concatenate((sim.mj_data.qpos, sim.mj_data.qvel)).tobytes()
    return log, truths, state


@pytest.fixture
def ungrouped(monkeypatch):
    """Return a function that calls another function without groups of plugins or batches of sensors."""

    def call_ungrouped(call, *args, **kwargs):
        with monkeypatch.context() as patch:
            patch.setattr(sensor_batch, "MIN_MEMBERS", 10_000)
            patch.setattr(step_tasks, "MIN_GROUP_SIZE", 10_000)
            return call(*args, **kwargs)

    return call_ungrouped


@pytest.fixture
def by_numpy(monkeypatch):
    """Compute lidar rays with NumPy, as with more than 64 moving bodies."""
    from simkit.sensors.rays import ray_fan

    monkeypatch.setattr(ray_fan, "MAX_MOVING_BODIES", 0)


def batch_sizes(sim):
    return [len(s.batch.members) if s.batch is not None else 0 for s in sim.contents.sensors.values()]


# ---------------------------------------------------------------------- the same bits

KINDS = {
    "noisy": {},
    "silent": {"imu": "<imu/>", "ray_noise": ""},
    "turned": {"turn": 0.4},
    "against_the_start": {"imu": "<imu><orientation_reference_frame><localization>ENU</localization>"
                                 "</orientation_reference_frame></imu>"},
    "layers": {"layers": LAYERS},
    "fast_odometry": {"drive": "<odom_publish_frequency>0</odom_publish_frequency>"},
    "slow_odometry": {"drive": "<odom_publish_frequency>17</odom_publish_frequency>"},
    "noisy_odometry": {"drive": "<odometry_noise><wheel_radius_error>0.01</wheel_radius_error></odometry_noise>"},
    "truth": {"drive": "<publish_ground_truth>true</publish_ground_truth>"},
}  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_grouped_and_single_plugins_give_the_same_messages_in_the_same_order(kind, ungrouped, by_numpy):
    source = world(**KINDS[kind])
    with simkit.load(source) as sim:
        assert batch_sizes(sim) == [COUNT] * (2 * COUNT)
    assert run(source) == ungrouped(run, source)


def test_different_robots_are_grouped_by_kind_and_give_the_same_messages(ungrouped, by_numpy):
    parts = [
        robot(i, radius=0.05 + 0.001 * (i % 3), turn=0.2 * (i % 2), imu="<imu/>" if i % 3 else NOISY_IMU)
        for i in range(COUNT)
    ]
    source = HEAD + "".join(parts) + "</world></sdf>"
    assert run(source) == ungrouped(run, source)


def test_imus_with_a_dynamic_bias_are_not_grouped(ungrouped):
    drift = NOISE.replace("</noise>", "<dynamic_bias_stddev>0.1</dynamic_bias_stddev>"
                          "<dynamic_bias_correlation_time>1</dynamic_bias_correlation_time></noise>")  # fmt: skip
    source = world(imu=f"<imu><angular_velocity><x>{drift}</x></angular_velocity></imu>")
    with simkit.load(source) as sim:
        assert all(s.batch is None for s in sim.contents.sensors.values() if s.kind == "imu")
    assert run(source) == ungrouped(run, source)


def test_the_messages_of_a_robot_do_not_depend_on_other_subscriptions(by_numpy):
    def only(sim_log, sim):
        sim.subscribe("/imu_2", lambda m: sim_log.append(msgs.serialize(m)))
        sim.subscribe("/scan_2", lambda m: sim_log.append(msgs.serialize(m)))

    logs = []
    for others in (False, True):
        log = []
        with simkit.load(world(), seed=3) as sim:
            command_robots(sim)
            if others:
                log_messages(sim, [])
            only(log, sim)
            sim.run(0.12)
        logs.append(log)
    assert logs[0] == logs[1]


# ---------------------------------------------------------------------- changes during the run


def test_sensors_sampled_after_a_subscriber_has_moved_a_robot_measure_the_new_pose(ungrouped, by_numpy):
    def change(sim):
        def push(message):
            if abs(sim.time - 0.05) < 1e-9:
                model = sim.model("robot_4")
                model.set_pose(simkit.Pose((3.0, 0.0, 0.3)))
                model.set_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 1.0))

        sim.subscribe("/imu_1", push)

    source = world()
    assert run(source, change=change) == ungrouped(run, source, change=change)
    assert run(source, change=change) != run(source)


@pytest.mark.slow
def test_rate_changes_spawns_and_removals_give_the_same_messages(ungrouped, by_numpy):
    def change(sim):
        sim.run(0.0503)
        sim.sensor("robot_1::base::imu").set_rate(100)
        sim.run(0.033)
        sim.spawn(f'<sdf version="1.9">{robot(7)}</sdf>')
        sim.run(0.05)
        sim.remove("robot_2")

    source = world()
    assert run(source, change=change) == ungrouped(run, source, change=change)


def test_a_restored_run_repeats_and_a_reset_run_starts_again(by_numpy):
    log = []
    with simkit.load(world(), seed=3) as sim:
        log_messages(sim, log)
        command_robots(sim)
        sim.run(0.1037)
        snapshot, before = sim.snapshot(), len(log)
        sim.run(0.1)
        first = log[before:]
        sim.restore(snapshot)
        del log[:]
        sim.run(0.1)
        assert log == first
        del log[:]
        sim.reset()
        command_robots(sim)
        sim.run(0.2037)
        assert log[-len(first) :] == first


def test_snapshots_of_grouped_and_single_plugins_are_equal(ungrouped):
    def state():
        with simkit.load(world(), seed=3) as sim:
            command_robots(sim)
            sim.run(0.1037)
            sim.snapshot()
            sim.run(0.05)
            drives = [p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "DiffDrive"]
            states = [p.get_state()["_odometry"] for p in drives]
            return [(s.reckoning, s.twist, s._at, s._noted, s._recent) for s in states]

    assert state() == ungrouped(state)


def test_a_reset_within_a_callback_ends_the_tick_for_all_plugins():
    with simkit.load(world()) as sim:
        seen = []

        def reset_at_third_call(message):
            seen.append(sim.tick)
            if len(seen) == 3:
                sim.reset()

        sim.subscribe("/imu_1", reset_at_third_call)
        later = sim.subscribe("/imu_4", lambda m: None)
        sim.step(10)
        stamps = [msgs.stamp_ns(m.header.stamp) // 1_000_000 for m in later.messages]
        assert seen == [1, 5, 10, 1, 5, 10][: len(seen)]
        assert stamps[:2] == [1, 5]


# ---------------------------------------------------------------------- faults


def test_the_error_names_the_plugin_of_the_group_that_raised():
    with simkit.load(world()) as sim:
        drives = [p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "DiffDrive"]
        drives[3]._servos = None  # makes the plugin raise
        command_robots(sim)
        with pytest.raises(PluginError) as found:
            sim.step(3)
        assert found.value.where == str(drives[3].where)


def test_a_subscriber_that_raises_within_a_group_stops_the_run():
    with simkit.load(world()) as sim:
        sim.subscribe("/odom_3", lambda m: {}["speed"])
        with pytest.raises(SubscriberError, match="'/odom_3'.*speed"):
            sim.run(0.1)


def test_a_plugin_class_may_define_a_group_hook_which_a_derived_class_does_not_use():
    class Counter(simkit.WorldPlugin):
        calls, runs = 0, 0

        def load(self, parent, params):
            self.count = 0

        def after_step(self):
            self.count += 1

        @classmethod
        def after_step_together(cls, plugins):
            def all_of_them(rota):
                Counter.runs += 1
                for plugin in rota:
                    plugin.count += 1

            return all_of_them

    class Twice(Counter):
        def after_step(self):
            self.count += 2

    plugins = [Counter() for _ in range(5)] + [Twice() for _ in range(5)] + [Counter()]
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>', plugins=plugins) as sim:
        sim.step(4)
    assert [p.count for p in plugins] == [4] * 5 + [8] * 5 + [4]
    assert Counter.runs == 4


# ---------------------------------------------------------------------- an observer


def test_an_observer_makes_each_call_of_a_plugin_and_changes_no_bit():
    """A group of drives is called one by one; a callback that was opened before the observer came is observed, too."""
    calls = []

    def observe(plugin, hook, call):
        calls.append((plugin.scoped, hook))
        return call()

    observed, plain = run(world(), change=lambda sim: sim.engine.faults.observe(observe)), run(world())
    assert observed == plain
    assert {(f"robot_{i}", "before_step") for i in range(COUNT)} <= set(calls)
    with simkit.load(world()) as sim:
        sim.engine.faults.observe(observe)
        calls.clear()
        command_robots(sim)
        sim.step(1)
        assert any("callback" in hook for _, hook in calls)
        with pytest.raises(ValueError, match="observer already"):
            sim.engine.faults.observe(observe)
