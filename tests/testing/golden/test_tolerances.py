"""Default tolerances, tolerances of scenarios, and rounding of stored numbers."""

from __future__ import annotations

import math

import pytest

from simkit.msgs.field_units import unit_of
from simkit.run_spec import RunSpec, Tolerance
from simkit.testing.golden.compare.tolerances import (
    allowed_text,
    default_tolerance,
    item_name,
    period_of,
    quantity_text,
    storage_step,
    time_text,
    tolerance_of,
)

FIELDS = [
    ("sensor_msgs/msg/LaserScan", "ranges", "m", "rays"),
    ("sensor_msgs/msg/LaserScan", "angle_increment", "rad", "values"),
    ("sensor_msgs/msg/Imu", "linear_acceleration.z", "m/s²", "values"),
    ("sensor_msgs/msg/Imu", "angular_velocity.x", "rad/s", "values"),
    ("sensor_msgs/msg/Imu", "orientation", "rad", "values"),
    ("sensor_msgs/msg/Imu", "linear_acceleration_covariance", "(m/s²)²", "values"),
    ("sensor_msgs/msg/MagneticField", "magnetic_field.y", "T", "values"),
    ("sensor_msgs/msg/FluidPressure", "fluid_pressure", "Pa", "values"),
    ("sensor_msgs/msg/NavSatFix", "latitude", "°", "values"),
    ("sensor_msgs/msg/NavSatFix", "altitude", "m", "values"),
    ("sensor_msgs/msg/PointCloud2", "points.z", "m", "points"),
    ("sensor_msgs/msg/JointState", "effort", "N m or N", "joints"),
    ("nav_msgs/msg/Odometry", "pose.pose.position.x", "m", "values"),
    ("nav_msgs/msg/Odometry", "twist.twist.linear.x", "m/s", "values"),
    ("nav_msgs/msg/Odometry", "twist.twist.angular.z", "rad/s", "values"),
    ("geometry_msgs/msg/Twist", "linear.x", "m/s", "values"),
    ("geometry_msgs/msg/WrenchStamped", "wrench.force.x", "N", "values"),
    ("geometry_msgs/msg/WrenchStamped", "wrench.torque.x", "N m", "values"),
    ("tf2_msgs/msg/TFMessage", "transforms.transform.translation.x", "m", "values"),
    ("tf2_msgs/msg/TFMessage", "transforms.transform.rotation", "rad", "values"),
    ("ros_gz_interfaces/msg/Contacts", "contacts.depths", "m", "contacts"),
    ("ros_gz_interfaces/msg/Altimeter", "vertical_velocity", "m/s", "values"),
    ("std_msgs/msg/Float64", "data", "", "values"),
    ("sensor_msgs/msg/Imu", "header.stamp", "ns", "values"),
]


@pytest.mark.parametrize(("type_name", "field", "unit", "things"), FIELDS)
def test_fields_have_their_units(type_name: str, field: str, unit: str, things: str) -> None:
    assert unit_of(type_name, field) == unit
    assert item_name(type_name, field) == things


@pytest.mark.parametrize(("type_name", "field"), [row[:2] for row in FIELDS])
def test_default_tolerances_have_all_numbers(type_name: str, field: str) -> None:
    found = default_tolerance(type_name, field)
    numbers = (found.absolute, found.relative, found.share, found.image, found.ssim)
    assert all(number is not None and math.isfinite(number) for number in numbers) and found.statistics is False


@pytest.mark.parametrize(("type_name", "field"), [row[:2] for row in FIELDS])
def test_numbers_are_rounded_to_a_power_of_two_of_a_sixteenth_to_an_eighth_of_what_is_allowed(
    type_name: str, field: str
) -> None:
    step, allowed = storage_step(type_name, field), default_tolerance(type_name, field).absolute
    assert allowed is not None
    if allowed == 0.0:
        assert step == 0.0
    else:
        assert allowed / 16 <= step <= allowed / 8 and math.frexp(step)[0] == 0.5


def test_two_millimetres_and_one_degree_are_more_than_any_default_allows() -> None:
    scan = default_tolerance("sensor_msgs/msg/LaserScan", "ranges")
    pose = default_tolerance("nav_msgs/msg/Odometry", "pose.pose.position.x")
    turn = default_tolerance("nav_msgs/msg/Odometry", "pose.pose.orientation")
    assert (scan.absolute or 0) + 3.5 * (scan.relative or 0) < 0.002
    assert (pose.absolute or 0) + 10.0 * (pose.relative or 0) < 0.002
    assert (turn.absolute or 0) < math.radians(1.0)


def test_each_number_of_a_scenario_overrides_its_default() -> None:
    scenario = RunSpec(
        "w.sdf",
        tolerances=(
            Tolerance("/scan", share=0.5),
            Tolerance("/scan.ranges", absolute=0.02),
            Tolerance("/imu*", ignore=True),
        ),
    )
    ranges = tolerance_of(scenario, "/scan", "sensor_msgs/msg/LaserScan", "ranges")
    assert (ranges.absolute, ranges.relative, ranges.share) == (0.02, 0.0, 0.5)
    angle = tolerance_of(scenario, "/scan", "sensor_msgs/msg/LaserScan", "angle_min")
    assert angle.share == 0.5 and angle.relative == 1e-6
    assert tolerance_of(scenario, "/imu/a", "sensor_msgs/msg/Imu", "orientation").ignore
    assert not tolerance_of(scenario, "/odom", "nav_msgs/msg/Odometry", "").ignore


def test_a_wider_tolerance_is_stored_coarser_and_an_exact_one_exactly() -> None:
    scenario = RunSpec("w.sdf", tolerances=(Tolerance("/a", absolute=1.0), Tolerance("/b", exact=True)))
    assert storage_step("std_msgs/msg/Float64", "data", scenario, "/a") == 1 / 8
    assert storage_step("std_msgs/msg/Float64", "data", scenario, "/b") == 0.0
    assert storage_step("sensor_msgs/msg/PointCloud2", "points.rgb") == 0.0  # a colour: four bytes stored as a float


def test_tolerances_are_described_in_words() -> None:
    words = allowed_text(Tolerance("x", absolute=1e-3, relative=0.01, share=0.02), "m")
    assert str(words) == "1 mm + 1 % of the value, 2 % of a message may differ more"
    assert allowed_text(Tolerance("x"), "m") == "nothing"


@pytest.mark.parametrize(
    ("value", "unit", "words"),
    [
        (0.012, "m", "+12 mm"),
        (-1.5, "m", "−1.5 m"),
        (3e-6, "m", "+3 µm"),
        (math.radians(1.0), "rad", "+1°"),
        (0.2, "rad/s", "+0.2 rad/s"),
        (2.5e-5, "T", "+25 µT"),
        (123456.0, "Pa", "+1.23e5 Pa"),
        (1e-7, "", "+1.00e-7"),
        (0.0, "m", "+0 m"),
        (math.inf, "m", "+inf"),
        (math.nan, "m", "nan"),
        (2_000_000, "ns", "+2 ms"),
    ],
)
def test_quantities_have_readable_units(value: float, unit: str, words: str) -> None:
    assert quantity_text(value, unit) == words


def test_digits_below_the_rounding_are_left_out() -> None:
    assert quantity_text(0.0019876, "m", error=1.5e-5) == "+2 mm"
    assert quantity_text(0.0019876, "m") == "+1.99 mm"
    assert quantity_text(1e-4, "rad/s", error=1.0) == "+1.00e-4 rad/s"


def test_headings_are_periodic_and_joint_positions_are_not() -> None:
    assert period_of("gps_msgs/msg/GPSFix", "track") == 360.0
    assert period_of("sensor_msgs/msg/JointState", "position") == 0.0


def test_times_have_two_decimals_or_more() -> None:
    assert (time_text(3.2), time_text(0.001), time_text(1.2345678)) == ("t = 3.20 s", "t = 0.001 s", "t = 1.234568 s")
