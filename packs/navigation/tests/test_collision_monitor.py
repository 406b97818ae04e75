"""Collision monitor: zones around the robot, and the node that changes velocities."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from point_clouds import place_camera, send

import simkit
from simkit import Simulation
from simkit_navigation.plugins.navigation.collision_zones import CollisionZone, VelocityRange, allowed_velocity

SQUARE = np.array([[0.5, 0.3], [0.5, -0.3], [-0.3, -0.3], [-0.3, 0.3]])
AHEAD = np.array([[0.4, 0.0], [0.4, 0.1], [0.4, -0.1], [0.45, 0.0]])
WALL_AHEAD = np.column_stack((np.full(9, 1.0), np.linspace(-0.4, 0.4, 9)))
FORWARD = (0.4, 0.0, 0.2)


def test_points_count_in_a_polygon_and_in_a_circle() -> None:
    polygon, circle = CollisionZone("p", "stop", SQUARE), CollisionZone("c", "stop", None, radius=0.42)
    assert polygon.is_hit(AHEAD) and not polygon.is_hit(AHEAD + np.array((0.2, 0.0))) and not polygon.is_hit(AHEAD[:3])
    assert not circle.is_hit(AHEAD) and circle.is_hit(AHEAD * 0.9)
    assert CollisionZone("one", "stop", SQUARE, min_points=1).is_hit(AHEAD[:1])


@pytest.mark.parametrize(
    ("zone", "expected"),
    [
        (CollisionZone("z", "stop", SQUARE), (0.0, 0.0, 0.0)),
        (CollisionZone("z", "slowdown", SQUARE, ratio=0.25), (0.1, 0.0, 0.05)),
        (CollisionZone("z", "limit", SQUARE, linear_limit=0.2, angular_limit=1.0), (0.2, 0.0, 0.1)),
        (CollisionZone("z", "limit", SQUARE, linear_limit=1.0, angular_limit=1.0), FORWARD),
        (CollisionZone("z", "none", SQUARE), FORWARD),
    ],
)
def test_each_action_changes_the_velocity(zone: CollisionZone, expected: tuple[float, float, float]) -> None:
    assert zone.change(FORWARD, AHEAD) == pytest.approx(expected)
    assert zone.change(FORWARD, AHEAD + 5.0) == FORWARD


def test_approaching_an_obstacle_slows_the_robot_down_by_the_time_to_the_collision() -> None:
    zone = CollisionZone("z", "approach", SQUARE, horizon=2.0, step=0.05)
    assert zone.change((0.2, 0.0, 0.0), WALL_AHEAD) == (0.2, 0.0, 0.0)  # 0.5 m away: 2.5 s
    assert zone.change((0.5, 0.0, 0.0), WALL_AHEAD)[0] == pytest.approx(0.25, abs=0.02)  # 1 s of 2 s
    assert zone.change((-0.5, 0.0, 0.0), WALL_AHEAD) == (-0.5, 0.0, 0.0)
    assert zone.change((0.5, 0.0, 0.0), AHEAD) == (0.0, 0.0, 0.0)


def test_the_zone_that_allows_the_least_decides() -> None:
    slow, stop = CollisionZone("slow", "slowdown", SQUARE), CollisionZone("stop", "stop", SQUARE)
    velocity, zone = allowed_velocity([slow, stop], FORWARD, {"scan": AHEAD})
    assert velocity == (0.0, 0.0, 0.0) and zone is stop
    assert allowed_velocity([slow, stop], FORWARD, {"scan": AHEAD + 5.0}) == (FORWARD, None)
    half = {"left": AHEAD[:2], "right": AHEAD[2:]}
    assert allowed_velocity([stop], FORWARD, half)[1] is stop
    assert allowed_velocity([replace(stop, sources=("left",))], FORWARD, half) == (FORWARD, None)


def test_a_zone_has_the_polygon_of_the_velocity() -> None:
    """The first polygon whose ranges contain the velocity is used; a range of directions may contain 180°."""
    slow = VelocityRange(SQUARE, (0.0, 0.3), (-1.0, 1.0))
    fast = VelocityRange(SQUARE * 2.0, (0.0, 1.0), (-1.0, 1.0))
    zone = CollisionZone("z", "stop", None, ranges=(slow, fast))
    assert zone.at_velocity((0.2, 0.0, 0.0)).corners is slow.corners
    assert zone.at_velocity((0.5, 0.0, 0.0)).corners is fast.corners
    assert zone.at_velocity((0.5, 0.0, 2.0)) is zone
    backward = VelocityRange(SQUARE, (0.0, 1.0), (-1.0, 1.0), (2.5, -2.5))
    assert backward.contains((-0.5, 0.0, 0.0)) and not backward.contains((0.5, 0.0, 0.0))


PARAMETERS = {
    "base_frame_id": "base",
    "state_topic": "state",
    "polygons": ["Stop", "Slow"],
    "Stop": {"type": "circle", "radius": 0.3, "action_type": "stop", "min_points": 3},
    "Slow": {
        "type": "polygon",
        "points": "[[1, 1], [1, -1], [-1, -1], [-1, 1]]",
        "action_type": "slowdown",
        "slowdown_ratio": 0.5,
        "max_points": 2,
    },
    "observation_sources": ["scan"],
    "scan": {"type": "scan", "topic": "/scan"},
}


def command(sim: Simulation, reach: float, stamped: bool = False) -> float:
    """Send a scan whose rays all have one range, and a velocity; return the forward speed that the monitor sends."""
    kind = "geometry_msgs/msg/TwistStamped" if stamped else "geometry_msgs/msg/Twist"
    scan = {"angle_min": -0.2, "angle_increment": 0.1, "range_min": 0.05, "range_max": 5.0, "ranges": [reach] * 5}
    header = {"frame_id": "base", "stamp": {"sec": int(sim.time), "nanosec": round(sim.time % 1 * 1e9)}}
    sim.advertise("/scan", "sensor_msgs/msg/LaserScan").publish({"header": header, **scan})
    sim.run(0.05)
    sent = sim.subscribe("/cmd_vel", keep=1)
    twist = {"linear": {"x": 0.4}}
    sim.advertise("/cmd_vel_smoothed", kind).publish({"twist": twist} if stamped else twist)
    sim.run(0.05)
    return float((sent.latest.twist if stamped else sent.latest).linear.x)


@pytest.mark.parametrize("stamped", [False, True])
def test_the_node_slows_down_and_stops_by_the_points_of_a_scan(stamped: bool) -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        params = {**PARAMETERS, "enable_stamped_cmd_vel": stamped}
        node = sim.add_node("nav2_collision_monitor/collision_monitor", params=params)
        manager = {"autostart": True, "node_names": ["collision_monitor"]}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=manager)
        sim.run(0.2)
        states = sim.subscribe("/state", keep=5)
        speeds = [command(sim, reach, stamped) for reach in (3.0, 0.8, 0.2, 3.0)]
        assert speeds == pytest.approx([0.4, 0.2, 0.0, 0.4])
        assert [message.polygon_name for message in states.messages][:2] == ["Slow", "Stop"]
        assert any("Robot to stop due to points in Stop" in line for line in node.log)


def test_the_robot_stops_without_scans() -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        sim.add_node("nav2_collision_monitor/collision_monitor", params=PARAMETERS)
        manager = {"autostart": True, "node_names": ["collision_monitor"]}
        sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=manager)
        sim.run(0.2)
        assert command(sim, 3.0) == pytest.approx(0.4)
        sim.run(3.0)
        sent = sim.subscribe("/cmd_vel", keep=1)
        sim.publish("/cmd_vel_smoothed", {"linear": {"x": 0.4}})
        sim.run(0.05)
        assert sent.latest.linear.x == 0.0


def send_source(sim: Simulation, kind: str, reach: float) -> None:
    """Publish an obstacle ahead of the robot as a message of a kind of source."""
    header = {"frame_id": "base_footprint", "stamp": simkit.msgs.time(sim.time_ns)}
    if kind == "pointcloud":
        place_camera(sim)
        send(sim, [[reach, 0.02 * number, height] for number in range(5) for height in (-0.3, 1.0)])
    elif kind == "range":
        values = {"field_of_view": 0.2, "min_range": 0.05, "max_range": 5.0, "range": reach}
        sim.advertise("/points", "sensor_msgs/msg/Range").publish({"header": header, **values})
    else:
        corners = [{"x": reach, "y": -0.2}, {"x": reach, "y": 0.2}, {"x": reach + 1.0, "y": 0.0}]
        polygon = {"id": 7, "polygon": {"points": corners}}
        publisher = sim.advertise("/points", "geometry_msgs/msg/PolygonInstanceStamped")
        publisher.publish({"header": header, "polygon": polygon})


def monitor(sim: Simulation, executable: str, params: dict[str, Any]) -> None:
    """Add a node with a zone of a circle of 0.6 m, and activate it."""
    zone = {"Circle": {"type": "circle", "radius": 0.6, "min_points": 4, "action_type": "none", "visualize": True}}
    zone["Circle"].update(params.pop("Circle", {}))
    params = {"base_frame_id": "base_footprint", "polygons": ["Circle"], **zone, **params}
    sim.add_node(f"nav2_collision_monitor/{executable}", params=params)
    manager = {"autostart": True, "node_names": [executable]}
    sim.add_node("nav2_lifecycle_manager/lifecycle_manager", params=manager)
    sim.run(0.2)


@pytest.mark.parametrize("kind", ["pointcloud", "range", "polygon"])
def test_each_kind_of_source_stops_the_robot(kind: str) -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        source = {"type": kind, "topic": "/points", "min_height": 0.1, "max_height": 0.5}
        monitor(
            sim, "collision_monitor", {"Circle": {"action_type": "stop"}, "observation_sources": ["s"], "s": source}
        )
        drawn = sim.subscribe("/Circle", keep=1)
        speeds = []
        for reach in (1.5, 0.5):
            send_source(sim, kind, reach)
            sim.run(0.05)
            sent = sim.subscribe("/cmd_vel", keep=1)
            sim.publish("/cmd_vel_smoothed", {"linear": {"x": 0.4}})
            sim.run(0.05)
            speeds.append(sent.latest.linear.x)
        assert speeds == pytest.approx([0.4, 0.0]) and len(drawn.latest.polygon.points) == 16
        sim.check_nodes()


def test_points_above_the_heights_of_a_cloud_do_not_count() -> None:
    """Of the ten points of the cloud, the five at the height of 0.25 m count."""
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        source = {"type": "pointcloud", "topic": "/points", "min_height": 0.1, "max_height": 0.5}
        zones = {"Circle": {"min_points": 6}, "observation_sources": ["s"], "s": source}
        monitor(sim, "collision_detector", zones)
        states = sim.subscribe("/collision_detector_state", keep=1)
        send_source(sim, "pointcloud", 0.4)
        sim.run(0.25)
        assert (states.latest.polygons, list(states.latest.detections)) == (["Circle"], [False])


def test_the_collision_detector_says_which_zones_are_hit() -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        source = {"type": "range", "topic": "/points"}
        monitor(sim, "collision_detector", {"observation_sources": ["s"], "s": source})
        states = sim.subscribe("/collision_detector_state", keep=1)
        markers = sim.subscribe("/collision_detector/collision_points_marker", keep=1)
        for reach, expected in ((1.5, False), (0.5, True)):
            send_source(sim, "range", reach)
            sim.run(0.25)
            assert list(states.latest.detections) == [expected]
            (marker,) = markers.latest.markers
            assert marker.ns == "collision_points_s" and max(p.x for p in marker.points) == pytest.approx(
                reach, abs=0.01
            )
        sim.check_nodes()


def test_a_robot_that_stands_gets_no_more_commands_after_the_timeout() -> None:
    with simkit.load('<sdf version="1.9"><world name="w"/></sdf>') as sim:
        monitor(sim, "collision_monitor", {"stop_pub_timeout": 0.5})
        sent = sim.subscribe("/cmd_vel")
        for _ in range(20):
            sim.publish("/cmd_vel_smoothed", {"linear": {"x": 0.0}})
            sim.run(0.1)
        assert 5 <= len(sent.messages) <= 7
