"""Satellite positions in the frame of the odometry: the projection, and the node of robot_localization."""

from __future__ import annotations

import math

import numpy as np
import pytest

import simkit
from simkit_navigation.plugins.localisation.utm_projection import UtmZone

WORLD = '<sdf version="1.9"><world name="w"/></sdf>'
RADIUS, FLATTENING = 6378137.0, 1 / 298.257223563
LATITUDE, LONGITUDE = 47.3769, 8.5417


def metres_per_degree(latitude: float) -> tuple[float, float]:
    """Return the lengths of a degree to the east and to the north on the ellipsoid [m]."""
    e2, sine = FLATTENING * (2 - FLATTENING), math.sin(math.radians(latitude))
    across = RADIUS / math.sqrt(1 - e2 * sine**2)
    along = RADIUS * (1 - e2) / (1 - e2 * sine**2) ** 1.5
    return math.radians(across * math.cos(math.radians(latitude))), math.radians(along)


@pytest.mark.parametrize("latitude", [0.0, 10.0, 47.0, 80.0, -33.0])
def test_on_the_central_meridian_the_northing_is_the_length_of_the_meridian(latitude: float) -> None:
    zone = UtmZone.around(latitude, 9.0)
    angles = np.linspace(0.0, latitude, 2001)
    lengths = [metres_per_degree(angle)[1] for angle in angles.tolist()]
    arc = float(np.trapezoid(lengths, angles)) * 0.9996
    east, north = zone.project(latitude, 9.0)
    assert (east, north) == (pytest.approx(500_000.0), pytest.approx(arc + 1e7 * (latitude < 0), abs=2e-3))


@pytest.mark.parametrize(
    ("latitude", "longitude"), [(47.3769, 8.5417), (-33.8568, 151.2153), (64.1, -21.9), (0.1, 179.9)]
)
def test_the_inverse_projection_returns_the_point(latitude: float, longitude: float) -> None:
    zone = UtmZone.around(latitude, longitude)
    again = zone.unproject(*zone.project(latitude, longitude))
    assert again == (pytest.approx(latitude, abs=2e-8), pytest.approx(longitude, abs=2e-8))


def test_the_north_of_the_grid_differs_from_true_north_by_the_convergence() -> None:
    zone = UtmZone.around(LATITUDE, LONGITUDE)
    (x0, y0), (x1, y1) = zone.project(LATITUDE, LONGITUDE), zone.project(LATITUDE + 1e-4, LONGITUDE)
    assert math.atan2(x0 - x1, y1 - y0) == pytest.approx(zone.convergence(LATITUDE, LONGITUDE), abs=1e-6)


def quaternion(yaw: float) -> dict[str, float]:
    return {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}


def test_a_way_to_the_east_is_one_along_x_of_the_odometry_if_the_imu_says_so() -> None:
    with simkit.load(WORLD) as sim:
        sim.add_node("robot_localization/navsat_transform_node", params={"zero_altitude": True})
        found = sim.subscribe("/odometry/gps", keep=1)
        pose = {"position": {"x": 1.0, "y": 2.0}, "orientation": quaternion(0.3)}
        odometry = {"header": {"frame_id": "odom"}, "child_frame_id": "base_link", "pose": {"pose": pose}}
        east, _ = metres_per_degree(LATITUDE)
        imu = sim.advertise("/imu", "sensor_msgs/msg/Imu")
        filtered = sim.advertise("/odometry/filtered", "nav_msgs/msg/Odometry")
        receiver = sim.advertise("/gps/fix", "sensor_msgs/msg/NavSatFix")
        for metres in (0.0, 10.0):
            for _ in range(3):
                imu.publish({"orientation": quaternion(0.3)})
                filtered.publish(odometry)
                fix = {"latitude": LATITUDE, "longitude": LONGITUDE + metres / east, "altitude": 400.0}
                covariance = [4.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 9.0]
                receiver.publish({**fix, "position_covariance": covariance})
                sim.run(0.2)
            place = found.latest.pose.pose.position
            assert (place.x, place.y) == (pytest.approx(1.0 + metres, abs=0.01), pytest.approx(2.0, abs=0.01))
            assert place.z == 0.0
        assert found.latest.header.frame_id == "odom"
        assert found.latest.pose.covariance[0] == pytest.approx(4.0, abs=0.01)
        there = sim.call("/fromLL", {"ll_point": {"latitude": LATITUDE, "longitude": LONGITUDE}}).map_point
        back = sim.call("/toLL", {"map_point": {"x": there.x, "y": there.y}}).ll_point
        assert (there.x, there.y) == (pytest.approx(1.0, abs=1e-3), pytest.approx(2.0, abs=1e-3))
        assert (back.latitude, back.longitude) == (
            pytest.approx(LATITUDE, abs=1e-7),
            pytest.approx(LONGITUDE, abs=1e-7),
        )
        sim.check_nodes()
