"""Slotcar of Open-RMF: paths, pauses, obstacles, battery and state."""

from __future__ import annotations

import math

import pytest

import simkit
from simkit import msgs

BODY = "<inertial><mass>{m}</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
BOX = '<collision name="c"><geometry><box><size>{}</size></box></geometry></collision>'
SPEEDS = """<nominal_drive_speed>0.5</nominal_drive_speed><nominal_drive_acceleration>0.25</nominal_drive_acceleration>
  <max_drive_acceleration>0.75</max_drive_acceleration><nominal_turn_speed>0.6</nominal_turn_speed>
  <nominal_turn_acceleration>1.5</nominal_turn_acceleration><max_turn_acceleration>2</max_turn_acceleration>
  <stop_distance>0.75</stop_distance><stop_radius>0.75</stop_radius>"""
GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane/></geometry>
  </collision></link></model>"""


def world(more: str = "", models: str = "") -> str:
    robot = f'<link name="base">{BODY.format(m=20)}{BOX.format("0.6 0.4 0.2")}</link>'
    plugin = f'<plugin filename="libslotcar.so" name="slotcar">{SPEEDS}{more}</plugin>'
    return f"""<sdf version="1.9"><world name="w"><physics type="ode"><max_step_size>0.01</max_step_size></physics>
      {GROUND}{models}<model name="robot"><pose>0 0 0.1 0 0 0</pose>{robot}{plugin}</model></world></sdf>"""


def crate(x: float, name: str = "crate") -> str:
    link = f'<link name="l">{BODY.format(m=2)}{BOX.format("0.2 0.2 0.2")}</link>'
    return f'<model name="{name}"><pose>{x} 0 0.1 0 0 0</pose>{link}</model>'


def follow(sim: simkit.Simulation, *places: tuple[float, ...], task: str = "t1", **fields: object) -> None:
    path = [{"x": x, "y": y, "yaw": yaw, "index": k, **fields} for k, (x, y, yaw) in enumerate(places)]
    sim.publish(
        "/robot_path_requests",
        msgs.make("rmf_fleet_msgs/msg/PathRequest", robot_name="robot", task_id=task, path=path),
    )


def pause(sim: simkit.Simulation, kind: int, checkpoint: int = 0) -> None:
    fields = {"robot_name": "robot", "type": kind, "at_checkpoint": checkpoint, "mode_request_id": 7}
    sim.publish("/robot_pause_requests", msgs.make("rmf_fleet_msgs/msg/PauseRequest", **fields))


def place(sim: simkit.Simulation) -> tuple[float, float, float]:
    pose = sim.model("robot").pose
    return float(pose.position[0]), float(pose.position[1]), float(pose.rpy[2])


STOP = 0.02 - 0.01 / 1.5
"""Distance before a waypoint [m]: 2 cm before it, at √(2·0.25·0.02) = 0.1 m/s, the robot brakes with 0.75 m/s²."""


def test_a_straight_way_has_the_time_of_its_speed_and_acceleration() -> None:
    with simkit.load(world()) as sim:
        state = sim.subscribe("/robot_state")
        follow(sim, (0, 0, 0), (3, 0, 0))
        sim.run(1.0)
        assert place(sim)[0] == pytest.approx(0.125, abs=2e-3)  # ½ · 0.25 m/s² · (1 s)²
        sim.run(4.0)
        assert place(sim)[0] == pytest.approx(0.5 + 0.5 * 3, abs=3e-3)  # 0.5 m to reach 0.5 m/s, then 3 s
        assert state.messages[-1].mode.mode == 2 and len(state.messages[-1].path) == 1
        assert sim.run_until(lambda sim: not state.messages[-1].path, timeout=5)
        assert sim.time == pytest.approx(3 / 0.5 + 0.5 / 0.25, abs=0.5)
        sim.run(1.0)
        assert place(sim) == pytest.approx((3 - STOP, 0, 0), abs=2e-3)
        assert state.messages[-1].mode.mode == 0 and state.messages[-1].task_id == "t1"
        before = place(sim)
        sim.run(10.0)
        assert place(sim) == pytest.approx(before, abs=1e-4)  # no drift at rest


@pytest.mark.slow
def test_the_robot_turns_on_the_spot_reverses_and_ends_with_the_heading_of_the_path() -> None:
    with simkit.load(world()) as sim:
        follow(sim, (0, 0, 0), (0, 1, math.pi / 2), (0, 0.2, math.pi / 2), (0, 0.2, 0))
        sim.run(2.0)
        x, y, yaw = place(sim)
        assert (x, y) == pytest.approx((0, 0), abs=1e-3)
        assert yaw == pytest.approx(0.6 * 2 - 0.6**2 / 1.5 / 2, abs=0.01)
        sim.run(20.0)
        x, y, yaw = place(sim)
        assert (x, y) == pytest.approx((0, 0.2 + STOP), abs=0.01) and yaw == pytest.approx(0, abs=2e-3)


@pytest.mark.slow
def test_a_robot_that_is_not_reversible_turns_round() -> None:
    for reversible, expected in (("true", 0.0), ("false", math.pi)):
        with simkit.load(world(f"<reversible>{reversible}</reversible>")) as sim:
            follow(sim, (0, 0, 0), (-2, 0, 0), (-2.5, 0, 0))
            sim.run(11.0)
            assert place(sim)[0] < -1.5
            assert abs(place(sim)[2]) == pytest.approx(expected, abs=0.02)


def test_a_speed_limit_of_a_waypoint_counts() -> None:
    with simkit.load(world()) as sim:
        follow(sim, (0, 0, 0), (3, 0, 0), obey_approach_speed_limit=True, approach_speed_limit=0.2)
        sim.run(5.0)
        assert place(sim)[0] == pytest.approx(0.08 + 0.2 * 4.2, abs=3e-3)


def test_a_path_that_begins_elsewhere_is_an_adapter_error() -> None:
    with simkit.load(world()) as sim:
        state = sim.subscribe("/robot_state")
        follow(sim, (2, 0, 0), (3, 0, 0))
        sim.run(1.0)
        assert state.messages[-1].mode.mode == 8 and place(sim)[0] == pytest.approx(0, abs=1e-6)


def test_pauses_stop_now_or_at_a_checkpoint() -> None:
    with simkit.load(world()) as sim:
        state = sim.subscribe("/robot_state")
        follow(sim, (0, 0, 0), (1, 0, 0), (2, 0, 0))
        pause(sim, 1, 1)
        sim.run(6.0)
        assert place(sim)[0] == pytest.approx(1 - STOP, abs=5e-3)
        assert state.messages[-1].mode.mode == 3 and state.messages[-1].mode.mode_request_id == 7
        pause(sim, 2)
        sim.run(1.0)
        pause(sim, 0)
        sim.run(2.0)
        stopped = place(sim)[0]
        assert 1.05 < stopped < 1.4 and state.messages[-1].mode.mode == 3
        sim.run(2.0)
        assert place(sim)[0] == pytest.approx(stopped, abs=1e-3)


def test_a_robot_waits_in_front_of_a_moving_model() -> None:
    with simkit.load(world(models=crate(3.0))) as sim:
        state = sim.subscribe("/robot_state")
        follow(sim, (0, 0, 0), (4, 0, 0))
        sim.run(8.0)
        assert 1.5 <= place(sim)[0] < 1.5 + 0.5**2 / (2 * 0.75) + 0.03  # 1.5 m away, and the way to brake
        assert state.messages[-1].mode.mode == 4
        sim.model("crate").set_pose(simkit.Pose((3, 5, 0.1)))
        sim.run(8.0)
        assert place(sim)[0] == pytest.approx(4 - STOP, abs=5e-3)


def test_doors_and_dispensable_models_stop_no_robot() -> None:
    with simkit.load(world(models=crate(0.9, "coke_dispensable"))) as sim:
        follow(sim, (0, 0, 0), (0.4, 0, 0))
        sim.run(5.0)
        assert place(sim)[0] == pytest.approx(0.4 - STOP, abs=5e-3)


def test_the_battery_drains_by_motion_and_devices_and_charges_at_a_charger() -> None:
    small = "<nominal_capacity>0.02</nominal_capacity><nominal_power>10</nominal_power>"
    with simkit.load(world(small + "<simkit:charger>3 0</simkit:charger>")) as sim:
        state = sim.subscribe("/robot_state")
        sim.run(10.0)
        capacity = 12 * 0.02 * 3600  # [J]
        assert state.messages[-1].battery_percent == math.ceil(100 * (1 - 10 * 10 / capacity))
        follow(sim, (0, 0, 0), (3, 0, 0))
        sim.run(6.0)  # accelerates in 2 s, then drives with 0.5 m/s
        kinetic, friction = 20 * 0.5**2 / 2, 0.3 * 20 * 9.81 * (0.5 + 0.5 * 4)
        used = 10 * 16 + kinetic + friction
        assert state.messages[-1].battery_percent == pytest.approx(100 * (1 - used / capacity), abs=1.1)
        sim.run(3.0)
        low = state.messages[-1].battery_percent
        sim.run(5.0)
        assert state.messages[-1].mode.mode == 1
        assert state.messages[-1].battery_percent == pytest.approx(min(100, low + 100 * 2 * 5 / 72), abs=2.1)


def test_a_steered_robot_drives_a_curve_through_its_waypoints() -> None:
    with simkit.load(world("<steering>ackermann</steering><lookahead_distance>1</lookahead_distance>")) as sim:
        follow(sim, (0, 0, 0), (3, 0, 0), (5, 2, 1.57), (5, 6, 1.57))
        track = []
        for _ in range(60):
            sim.run(0.5)
            track.append(place(sim))
        assert min(math.dist(p[:2], (3, 0)) for p in track) < 0.5
        assert min(math.dist(p[:2], (5, 3)) for p in track) < 0.3
        assert track[-1][:2] == pytest.approx((5, 5), abs=0.3)  # stops 1 m before the last waypoint


def test_the_transform_and_the_level_of_a_robot() -> None:
    with simkit.load(world("<simkit:level_name>L7</simkit:level_name>")) as sim:
        tf, state = sim.subscribe("/tf"), sim.subscribe("/robot_state")
        sim.run(1.0)
        (transform,) = tf.messages[-1].transforms
        assert (transform.header.frame_id, transform.child_frame_id) == ("world", "robot/base_link")
        assert len(tf.messages) == 100 and state.messages[-1].location.level_name == "L7"
        assert [m.seq for m in state.messages] == [1, 2]


def test_a_restored_snapshot_repeats_the_way() -> None:
    with simkit.load(world()) as sim:
        follow(sim, (0, 0, 0), (1, 0, 0), (1, 1, 0))
        sim.run(3.0)
        snapshot = sim.snapshot()
        sim.run(4.0)
        first = place(sim)
        sim.restore(snapshot)
        sim.run(4.0)
        assert place(sim) == first


def test_bad_requests_are_ignored_with_a_warning() -> None:
    with simkit.load(world()) as sim:
        follow(sim)
        follow(sim, (0, 0, 0), (math.nan, 0, 0))
        sim.run(1.0)
        assert [d.code for d in sim.diagnostics].count("SK-PLUGIN-041") == 2 and place(sim)[0] == pytest.approx(0)


def test_a_charger_needs_two_numbers() -> None:
    with pytest.raises(simkit.InputError, match="SK-PARAM-002.*x and y"):
        simkit.load(world("<simkit:charger>1</simkit:charger>"))


def test_a_robot_brakes_in_time_although_its_largest_deceleration_is_too_small() -> None:
    slow = world().replace("<max_drive_acceleration>0.75<", "<max_drive_acceleration>0.05<")
    with simkit.load(slow) as sim:
        assert [d.code for d in sim.diagnostics if "max_drive_acceleration" in d.message] == ["SK-PLUGIN-111"]
        follow(sim, (0, 0, 0), (3, 0, 0))
        sim.run(12.0)
        assert place(sim)[0] == pytest.approx(3.0, abs=0.05)


def test_a_paused_robot_charges_at_its_charger() -> None:
    small = "<nominal_capacity>0.02</nominal_capacity><nominal_power>10</nominal_power>"
    with simkit.load(world(small + "<simkit:charger>0 0</simkit:charger>")) as sim:
        state = sim.subscribe("/robot_state")
        sim.step()
        follow(sim, (0, 0, 0), (3, 0, 0))
        pause(sim, 0)
        sim.run(10.0)
        assert (state.messages[-1].battery_percent, place(sim)[0]) == (100.0, pytest.approx(0.0, abs=0.01))


def test_a_steered_robot_stops_for_a_pause() -> None:
    with simkit.load(world("<steering>ackermann</steering><lookahead_distance>1</lookahead_distance>")) as sim:
        follow(sim, (0, 0, 0), (5, 0, 0))
        sim.run(3.0)
        pause(sim, 0)
        sim.run(2.0)
        stopped = place(sim)[0]
        sim.run(2.0)
        assert place(sim)[0] == pytest.approx(stopped, abs=1e-6) and stopped < 2.5
        pause(sim, 2)
        sim.run(8.0)
        assert place(sim)[0] > 3.5
