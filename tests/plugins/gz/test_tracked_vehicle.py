"""Tracked vehicles: gz's, and both of Gazebo Classic."""

from __future__ import annotations

import math
from typing import Any

import pytest
from belt_worlds import GROUND, gz_tank, rubs, tank, world

import simkit

COMMAND = "/model/tank/cmd_vel"
SIMPLE = (
    '<plugin filename="libSimpleTrackedVehiclePlugin.so" name="tracks"><body>base</body>'
    "<left_track>left_track</left_track>"
    "<right_track>right_track</right_track>{inner}</plugin>"
)


def opened(model: str, *others: str, step: float = 0.002) -> simkit.Simulation:
    return simkit.load(world(GROUND, model, *others, step=step))


def drive(sim: simkit.Simulation, ahead: float, turning: float = 0.0, topic: str = COMMAND) -> None:
    sim.publish(topic, {"linear": {"x": ahead}, "angular": {"z": turning}})


def planar(sim: simkit.Simulation) -> tuple[float, float, float]:
    pose = sim.model("tank").pose
    return float(pose.position[0]), float(pose.position[1]), float(pose.rpy[2])


def test_it_accelerates_to_the_commanded_speed_within_friction() -> None:
    """At 1 m/s the vehicle lags by v²/(2 mu g), because the tracks slip until it has reached this speed."""
    with opened(gz_tank()) as sim:
        sim.run(0.3)
        drive(sim, 1.0)
        sim.run(2.0)
        x, y, yaw = planar(sim)
        assert x == pytest.approx(2.0 - 1 / (2 * 0.7 * 9.8), abs=0.01)
        assert (y, yaw) == pytest.approx((0.0, 0.0), abs=2e-3)
        drive(sim, 0.0)
        sim.run(1.0)
        stood = planar(sim)
        sim.run(1.0)
        assert planar(sim) == pytest.approx(stood, abs=1e-4)


def test_it_turns_on_the_spot_and_along_a_circle() -> None:
    """The tracks carry along circles at 0.1 m/s, which touch the ground between 0.29 and 0.35 m from the middle.

    So the vehicle turns by 0.28 to 0.34 rad/s; Gazebo's test of it has 0.1 rad and 0.1 m of room.
    """
    with opened(gz_tank()) as sim:
        sim.run(0.3)
        drive(sim, 0.0, 0.25)
        sim.run(2.0)
        x, y, yaw = planar(sim)
        assert 2.0 * 0.1 / math.hypot(0.25, 0.25) - 0.01 < yaw < 2.0 * 0.1 / math.hypot(0.25, 0.15) + 0.01
        assert math.hypot(x, y) < 0.001
        drive(sim, 0.5, 0.2)
        sim.run(1.0)
        after = planar(sim)
        assert after[2] - yaw == pytest.approx(0.2, abs=0.1)
        assert math.hypot(after[0] - x, after[1] - y) == pytest.approx(0.48, abs=0.1)


def test_it_climbs_a_step() -> None:
    step = (
        '<model name="step"><static>true</static><pose>2 0 0.02 0 0 0</pose><link name="link"><collision name="c">'
        f"<geometry><box><size>2 2 0.04</size></box></geometry>{rubs(1.0)}</collision></link></model>"
    )
    with opened(gz_tank(), step, step=0.001) as sim:
        sim.run(0.3)
        drive(sim, 0.5)
        sim.run(5.0)
        pose = sim.model("tank").pose
        assert pose.position[0] > 1.35
        assert pose.position[2] == pytest.approx(0.04, abs=5e-3)


def test_speeds_and_the_centre_of_rotation_are_published_to_the_tracks() -> None:
    received: dict[str, list[Any]] = {}
    with opened(gz_tank("<steering_efficiency>0.5</steering_efficiency>")) as sim:
        for side in ("left", "right"):
            for name in ("track_cmd_vel", "track_cmd_center_of_rotation"):
                messages = received.setdefault(f"{side} {name}", [])
                sim.subscribe(f"/model/tank/link/{side}_track/{name}", messages.append)
        drive(sim, 0.4, 0.2)
        sim.run(0.01)
        assert received["left track_cmd_vel"][-1].data == pytest.approx(0.4 - 0.2 * 0.4)
        assert received["right track_cmd_vel"][-1].data == pytest.approx(0.4 + 0.2 * 0.4)
        assert received["left track_cmd_center_of_rotation"][-1].y == pytest.approx(2.0, abs=1e-3)
        count = len(received["left track_cmd_vel"])
        sim.run(0.2)
        assert len(received["left track_cmd_vel"]) == count
        sim.publish("/model/tank/steering_efficiency", {"data": 1.0})
        sim.run(0.01)
        assert received["right track_cmd_vel"][-1].data == pytest.approx(0.4 + 0.2 * 0.2)
        drive(sim, 0.4)
        sim.run(0.01)
        assert math.isinf(received["left track_cmd_center_of_rotation"][-1].y)
        assert not sim.engine.scheduler.after.every


def test_its_odometry_is_that_of_wheels_at_the_speeds_of_the_tracks() -> None:
    """Odometry without skidding: the turning rate is divided by the steering efficiency; published at 50 Hz."""
    with opened(gz_tank("<frame_id>map</frame_id>")) as sim:
        odometry, tf = (sim.subscribe(f"/model/tank/{name}") for name in ("odometry", "tf"))
        drive(sim, 0.5, 0.1)
        sim.run(1.0)
        last = odometry.messages[-1]
        assert len(odometry.messages) == len(tf.messages) == 50
        assert last.header.frame_id == "map"
        assert last.child_frame_id == "tank/base"
        assert last.twist.twist.angular.z == pytest.approx(0.2)
        angle = 0.2 * (1.0 - 0.002)
        assert last.pose.pose.position.x == pytest.approx(2.5 * math.sin(angle), abs=1e-3)
        assert last.pose.pose.position.y == pytest.approx(2.5 * (1 - math.cos(angle)), abs=1e-3)


def test_the_limits_apply_to_forward_speed_and_turning_rate() -> None:
    inner = "<linear_velocity><max_velocity>0.3</max_velocity><max_acceleration>1</max_acceleration></linear_velocity>"
    with opened(gz_tank(inner)) as sim:
        speeds: list[Any] = []
        sim.subscribe("/model/tank/link/left_track/track_cmd_vel", speeds.append)
        drive(sim, 1.0)
        sim.run(0.5)
        assert speeds[0].data == pytest.approx(0.002)
        assert speeds[-1].data == pytest.approx(0.3)


def test_missing_elements_are_errors_with_their_line() -> None:
    with pytest.raises(simkit.LoadError, match="right_track"):
        opened(gz_tank().replace("<right_track><link>right_track</link></right_track>", ""))
    with pytest.raises(simkit.LoadError, match="left_track"):
        opened(gz_tank().replace("<left_track><link>left_track</link>", "<left_track><link>left_trac</link>"))
    with pytest.raises(simkit.LoadError, match="body"):
        opened(tank(SIMPLE.format(inner="").replace("<body>base</body>", "")))


@pytest.mark.parametrize("friction", ["", "<track_mu>1.5</track_mu><track_mu2>0.5</track_mu2>"])
def test_classic_tracks_turn_left_for_ros_commands_and_right_for_gazebo_commands(friction: str) -> None:
    with opened(tank(SIMPLE.format(inner=friction))) as sim:
        speeds: list[Any] = []
        sim.subscribe("/tank/tracks_speed", speeds.append)
        sim.run(0.3)
        drive(sim, 0.8, topic="/tank/cmd_vel")
        sim.run(1.0)
        x, _, yaw = planar(sim)
        assert x == pytest.approx(0.75, abs=0.05)
        assert abs(yaw) < 0.01
        for topic, sense in (("/tank/cmd_vel", 1), ("/tank/cmd_vel_twist", -1)):
            yaw = planar(sim)[2]
            drive(sim, 0.0, 0.25, topic)
            sim.run(1.0)
            assert planar(sim)[2] - yaw == pytest.approx(0.25 * sense, abs=0.1)
        assert (speeds[-1].x, speeds[-1].y) == pytest.approx((0.1, -0.1))
        drive(sim, 5.0, topic="/tank/cmd_vel")
        sim.run(0.01)
        assert speeds[-1].x == 1.0


def test_classic_friction_of_the_plugin_overrides_that_of_the_file() -> None:
    """On a slope of 30° the vehicle slides with mu 0.3 of the file, and climbs with 1.5 of the plugin."""
    slope = math.radians(30)
    ground = (
        f'<model name="slope"><static>true</static><pose>0 0 0 0 {-slope} 0</pose><link name="link">'
        '<collision name="c">'
        f"<geometry><box><size>40 4 0.02</size></box></geometry>{rubs(2.0)}</collision></link></model>"
    )
    for friction, climbs in (("", False), ("<track_mu>1.5</track_mu>", True)):
        model = tank(SIMPLE.format(inner=friction), rubs(0.3), pose=f"0 0 0.02 0 {-slope} 0")
        with simkit.load(world(ground, model, step=0.002)) as sim:
            drive(sim, 0.5, topic="/tank/cmd_vel")
            sim.run(2.0)
            assert (planar(sim)[0] > 0.6) is climbs


def wheeled() -> str:
    wheels = "".join(
        f'<link name="{side}{x}"><pose>{x} {y} 0.1 -1.5707963 0 0</pose><inertial><mass>1</mass>'
        "<inertia><ixx>0.005</ixx>"
        "<iyy>0.005</iyy><izz>0.005</izz></inertia></inertial><collision name='c'><geometry><cylinder>"
        "<radius>0.1</radius>"
        f"<length>0.05</length></cylinder></geometry></collision></link><joint name='{side}{x}_axle' type='continuous'>"
        f"<parent>base</parent><child>{side}{x}</child><axis><xyz>0 0 1</xyz></axis></joint>"
        for side, y in (("left", 0.2), ("right", -0.2))
        for x in (-0.25, 0.0, 0.25)
    )
    joints = "".join(
        f"<{side}_joint>{side}{x}_axle</{side}_joint>" for side in ("left", "right") for x in (-0.25, 0.0, 0.25)
    )
    plugin = (
        f'<plugin filename="libWheelTrackedVehiclePlugin.so" name="tracks">{joints}<track_mu>0.8</track_mu>'
        "<steering_efficiency>0.5</steering_efficiency></plugin>"
    )
    return (
        '<model name="tank"><link name="base"><pose>0 0 0.15 0 0 0</pose><inertial><mass>13</mass>'
        "<inertia><ixx>0.1</ixx>"
        f"<iyy>0.35</iyy><izz>0.3</izz></inertia></inertial></link>{wheels}{plugin}</model>"
    )


def test_classic_tracks_of_wheels() -> None:
    with opened(wheeled(), step=0.001) as sim:
        sim.run(0.3)
        drive(sim, 0.8, topic="/tank/cmd_vel")
        sim.run(1.0)
        assert planar(sim)[0] == pytest.approx(0.75, abs=0.06)
        drive(sim, 0.0, 0.5, "/tank/cmd_vel")
        sim.run(1.0)
        assert planar(sim)[2] > 0.1
