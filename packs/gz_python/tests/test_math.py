"""gz-math's types: what they compute is checked against rotation matrices, bodies and planets worked out otherwise."""

from __future__ import annotations

import copy
import math
from datetime import timedelta

import numpy as np
import numpy.typing as npt
import pytest

from simkit_gz_python import math as gz
from simkit_gz_python.math import (
    PID,
    Angle,
    AxisAlignedBox,
    Color,
    Inertiald,
    MassMatrix3d,
    Matrix3d,
    Pose3d,
    Quaterniond,
    RollingMean,
    SphericalCoordinates,
    Temperature,
    Vector2d,
    Vector3d,
    Vector3i,
)

Array = npt.NDArray[np.float64]


def rotation(roll: float, pitch: float, yaw: float) -> Array:
    """Rz · Ry · Rx, from the definition."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return np.asarray(about_z @ about_y @ about_x)


def array(vector: Vector3d) -> Array:
    return np.array([vector.x(), vector.y(), vector.z()])


RPY = [(0.0, 0.0, 0.0), (0.3, -0.2, 1.1), (-2.9, 1.4, -3.0), (0.1, -1.5, 2.0)]


# ---------------------------------------------------------------------- vectors


def test_vectors_are_added_and_multiplied_by_components() -> None:
    a, b = Vector3d(1, 2, 3), Vector3d(4, -5, 6)
    assert list(a + b) == [5, -3, 9]
    assert list(a - b) == [-3, 7, -3]
    assert list(a * b) == [4, -10, 18]
    assert list(a / b) == pytest.approx([0.25, -0.4, 0.5])
    assert list(a * 2) == list(2 * a) == [2, 4, 6]
    assert list(a + 1) == [2, 3, 4]
    assert list(-a) == [-1, -2, -3]


def test_a_vector_has_products_lengths_and_distances() -> None:
    a, b = Vector3d(1, 2, 3), Vector3d(4, -5, 6)
    assert a.dot(b) == 12
    assert array(a.cross(b)) == pytest.approx(np.cross([1, 2, 3], [4, -5, 6]))
    assert a.length() == pytest.approx(math.sqrt(14))
    assert a.squared_length() == 14
    assert a.distance(b) == a.distance(4, -5, 6) == pytest.approx(math.sqrt(9 + 49 + 9))
    assert a.sum() == 6 and a.max() == 3 and a.min() == 1
    assert a.perpendicular().dot(a) == pytest.approx(0)
    assert Vector3d(2, 0, 0).perpendicular().dot(Vector3d(2, 0, 0)) == 0
    assert Vector3d(0, 1, 0).dist_to_line(Vector3d(-1, 0, 0), Vector3d(5, 0, 0)) == pytest.approx(1)
    assert array(Vector3d.normal(Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 1, 0))) == pytest.approx([0, 0, 1])


def test_vectors_within_a_thousandth_are_equal_as_in_gz_math() -> None:
    assert Vector3d(1, 2, 3) == Vector3d(1.0009, 2, 3)
    assert Vector3d(1, 2, 3) != Vector3d(1.0011, 2, 3)
    assert Vector3d(1, 2, 3).equal(Vector3d(1.09, 2, 3), 0.1)


def test_x_without_an_argument_reads_and_with_one_sets() -> None:
    v = Vector3d(1, 2, 3)
    v.x(7)
    v.z(9)
    v[1] = 8
    assert list(v) == [7, 8, 9] and v[2] == 9
    with pytest.raises(IndexError):
        v[3]


def test_normalize_changes_the_vector_and_a_copy_is_independent() -> None:
    v = Vector3d(0, 3, 4)
    same = v
    other = copy.deepcopy(v)
    v.normalize()
    assert list(same) == pytest.approx([0, 0.6, 0.8])
    assert list(other) == [0, 3, 4]
    assert list(Vector3d(1e-9, 0, 0).normalized()) == [1e-9, 0, 0]  # gz-math leaves what is nearly nothing


def test_adding_in_place_changes_the_same_object() -> None:
    v = Vector3d(1, 1, 1)
    same = v
    v += Vector3d(1, 2, 3)
    assert list(same) == [2, 3, 4]


def test_whole_number_vectors_hold_whole_numbers() -> None:
    assert list(Vector3i(1, 2, 3)) == [1, 2, 3] and isinstance(Vector3i(1.0, 2, 3).x(), int)


def test_vectors_print_as_streams_do() -> None:
    assert str(Vector3d(0, -0.0, -9.8)) == "0 0 -9.8"
    assert str(Vector3d(1 / 3, 1e-7, 1e6)) == "0.333333 1e-07 1e+06"


def test_the_constants_are_there() -> None:
    assert list(Vector3d.UNIT_Z) == [0, 0, 1] and list(Vector2d.ONE) == [1, 1] and not Vector3d.NAN.is_finite()


# ---------------------------------------------------------------------- rotations


@pytest.mark.parametrize("rpy", RPY)
def test_a_quaternion_of_euler_angles_turns_as_their_matrices_do(rpy: tuple[float, float, float]) -> None:
    q = Quaterniond(*rpy)
    assert array(q.rotate_vector(Vector3d(1, -2, 3))) == pytest.approx(rotation(*rpy) @ [1, -2, 3])
    assert array(q * Vector3d(1, -2, 3)) == pytest.approx(rotation(*rpy) @ [1, -2, 3])
    assert array(q.rotate_vector_reverse(Vector3d(1, -2, 3))) == pytest.approx(rotation(*rpy).T @ [1, -2, 3])
    assert Matrix3d(q).array() == pytest.approx(rotation(*rpy))


@pytest.mark.parametrize("rpy", RPY)
def test_euler_angles_come_back(rpy: tuple[float, float, float]) -> None:
    q = Quaterniond(*rpy)
    assert rotation(*q.euler()) == pytest.approx(rotation(*rpy))
    assert [q.roll(), q.pitch(), q.yaw()] == pytest.approx(list(q.euler()))


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
def test_straight_up_or_down_the_yaw_is_zero(pitch: float) -> None:
    q = Quaterniond(0.4, pitch, 0.9)
    if abs(abs(q.pitch()) - math.pi / 2) < 1e-9:  # where rounding leaves it at the pole
        assert rotation(*q.euler()) == pytest.approx(rotation(0.4, pitch, 0.9), abs=1e-6)


def test_the_product_turns_by_the_right_one_first() -> None:
    a, b = Quaterniond(0.3, -0.2, 1.1), Quaterniond(-1.0, 0.4, 0.2)
    assert Matrix3d(a * b).array() == pytest.approx(rotation(0.3, -0.2, 1.1) @ rotation(-1.0, 0.4, 0.2))


def test_four_numbers_are_w_x_y_z_and_axis_and_angle_two_values() -> None:
    q = Quaterniond(math.cos(0.5), 0, 0, math.sin(0.5))
    assert q.yaw() == pytest.approx(1.0)
    assert Quaterniond(Vector3d(0, 0, 2), 1.0) == q
    axis, angle = q.axis_angle()
    assert list(axis) == pytest.approx([0, 0, 1]) and angle == pytest.approx(1.0)
    assert Quaterniond().axis_angle()[1] == 0.0


def test_an_inverse_undoes_a_rotation_of_any_length() -> None:
    q = Quaterniond(2.0, 0.4, -0.6, 0.2)
    assert q * q.inverse() == Quaterniond.IDENTITY
    assert Quaterniond.ZERO.inverse() == Quaterniond.IDENTITY


@pytest.mark.parametrize("rpy", [*RPY, (math.pi, 0.0, 0.0), (0.0, 0.0, 3.1)])
def test_a_matrix_gives_its_quaternion_back(rpy: tuple[float, float, float]) -> None:
    q = Quaterniond(Matrix3d.of(rotation(*rpy)))
    assert Matrix3d(q).array() == pytest.approx(rotation(*rpy), abs=1e-12)


def test_the_rotation_between_two_directions_takes_one_to_the_other() -> None:
    q = Quaterniond()
    for a, b in (((1, 2, 3), (-2, 0, 1)), ((0, 0, 1), (0, 0, -1)), ((1, 0, 0), (1, 0, 0))):
        q.set_from_2_axes(Vector3d(*a), Vector3d(*b))
        found = array(q.rotate_vector(Vector3d(*a).normalized()))
        assert found == pytest.approx(array(Vector3d(*b).normalized()), abs=1e-9)


def test_integrating_a_constant_turning_adds_its_angle() -> None:
    start = Quaterniond(0.2, 0.3, 0.4)
    later = start.integrate(Vector3d(0, 0, 2.0), 0.25)  # in fixed axes
    assert Matrix3d(later).array() == pytest.approx(rotation(0, 0, 0.5) @ rotation(0.2, 0.3, 0.4))


def test_slerp_is_even_and_logarithm_and_exponent_undo_each_other() -> None:
    a, b = Quaterniond(0, 0, 0.2), Quaterniond(0, 0, 1.2)
    assert Quaterniond.slerp(0.3, a, b).yaw() == pytest.approx(0.5)
    q = Quaterniond(0.3, -0.2, 1.1)
    assert q.log().exp() == q


def test_angles_normalise_and_compare() -> None:
    assert Angle(3 * math.pi).normalized() == Angle.PI
    assert Angle.HALF_PI.degree() == pytest.approx(90)
    a = Angle(1.0)
    a.set_degree(30)
    assert a.radian() == pytest.approx(math.pi / 6)
    assert Angle(1) < Angle(2) and Angle(1) == Angle(1.0005) and Angle(1) + Angle(0.5) == Angle(1.5)


# ---------------------------------------------------------------------- poses


def matrix(pose: Pose3d) -> Array:
    found = np.eye(4)
    found[:3, :3] = Matrix3d(pose.rot()).array()
    found[:3, 3] = array(pose.pos())
    return found


A, B = Pose3d(1, 2, 3, 0.1, 0.2, 0.3), Pose3d(-1, 0.4, 2, 0.5, -0.2, 1.3)


def test_the_product_of_poses_is_that_of_their_matrices() -> None:
    assert matrix(A * B) == pytest.approx(matrix(A) @ matrix(B))


def test_the_inverse_pose_is_that_of_the_matrix() -> None:
    assert matrix(A.inverse()) == pytest.approx(np.linalg.inv(matrix(A)))
    assert A * A.inverse() == Pose3d.ZERO


def test_gz_maths_older_sum_and_difference_compose_the_other_way_round() -> None:
    assert matrix(A + B) == pytest.approx(matrix(B) @ matrix(A))
    assert matrix(A - B) == pytest.approx(np.linalg.inv(matrix(B)) @ matrix(A))
    assert (A + B) - B == A


def test_six_numbers_are_euler_angles_and_seven_a_quaternion() -> None:
    assert Pose3d(1, 2, 3, math.cos(0.5), 0, 0, math.sin(0.5)) == Pose3d(1, 2, 3, 0, 0, 1.0)
    assert str(Pose3d(1, 2, 3, 0, 0, 1.0)) == "1 2 3 0 0 1"


def test_a_pose_returns_its_own_components() -> None:
    pose = Pose3d(A)
    pose.pos().x(9)
    pose.set_z(5)
    assert (pose.x(), pose.z()) == (9, 5) and A.x() == 1


def test_a_pose_transforms_a_point() -> None:
    assert array(A.coord_position_add(Vector3d(1, 0, -1))) == pytest.approx((matrix(A) @ [1, 0, -1, 1])[:3])


# ---------------------------------------------------------------------- bodies


def test_moments_of_a_turned_body_are_turned() -> None:
    own = MassMatrix3d(2, Vector3d(1, 2, 2.5), Vector3d(0.1, 0.2, 0.05))
    turn = rotation(0.1, 0.2, 0.3)
    moi = np.array([[1, 0.1, 0.2], [0.1, 2, 0.05], [0.2, 0.05, 2.5]])
    assert Inertiald(own, A).moi().array() == pytest.approx(turn @ moi @ turn.T)


def test_moments_of_solids_are_the_textbook_ones() -> None:
    box, ball, rod = MassMatrix3d(), MassMatrix3d(), MassMatrix3d()
    assert box.set_from_box(12.0, Vector3d(1, 2, 3)) and list(box.diagonal_moments()) == pytest.approx([13, 10, 5])
    assert ball.set_from_sphere(10.0, 0.5) and ball.ixx() == pytest.approx(1.0)
    assert rod.set_from_cylinder_z(12.0, 2.0, 1.0) and list(rod.diagonal_moments()) == pytest.approx([7, 7, 6])


def test_the_equivalent_box_is_the_box_it_came_from() -> None:
    body, size, turn = MassMatrix3d(), Vector3d(), Quaterniond()
    body.set_from_box(12.0, Vector3d(1, 2, 3), Quaterniond(0.3, -0.2, 1.1))
    assert body.equivalent_box(size, turn)
    again = MassMatrix3d()
    again.set_from_box(12.0, size, turn)
    assert again.moi().array() == pytest.approx(body.moi().array())


def test_moments_that_no_body_can_have_are_not_valid() -> None:
    assert MassMatrix3d(1, Vector3d(1, 1, 1.9), Vector3d()).is_valid()
    assert not MassMatrix3d(1, Vector3d(1, 1, 2.1), Vector3d()).is_valid()
    assert not MassMatrix3d(-1, Vector3d(1, 1, 1), Vector3d()).is_valid()


def test_two_bodies_together_have_the_moments_of_the_parallel_axes() -> None:
    point = MassMatrix3d(1, Vector3d(), Vector3d())
    both = Inertiald(point, Pose3d(1, 0, 0, 0, 0, 0)) + Inertiald(point, Pose3d(-1, 0, 0, 0, 0, 0))
    assert both.mass_matrix().mass() == 2
    assert list(both.mass_matrix().diagonal_moments()) == pytest.approx([0, 2, 2])


# ---------------------------------------------------------------------- the rest


def test_a_place_comes_back_from_its_latitude_and_longitude() -> None:
    place = SphericalCoordinates(SphericalCoordinates.EARTH_WGS84, Angle(0.8), Angle(0.2), 450.0, Angle(0.4))
    there = place.spherical_from_local_position(Vector3d(120, -340, 12))
    assert array(place.local_from_spherical_position(there)) == pytest.approx([120, -340, 12], abs=1e-6)


def test_at_the_equator_a_hundred_metres_east_are_a_hundred_metres_along_it() -> None:
    there = SphericalCoordinates().spherical_from_local_position(Vector3d(100, 0, 0))
    assert math.radians(there.y()) * 6378137.0 == pytest.approx(100, rel=1e-6) and there.x() == 0


def test_a_heading_turns_velocities() -> None:
    place = SphericalCoordinates()
    place.set_heading_offset(Angle.HALF_PI)  # x points north
    assert array(place.global_from_local_velocity(Vector3d(1, 0, 0))) == pytest.approx([0, 1, 0], abs=1e-12)


def test_a_degree_of_longitude_at_the_equator_is_as_long_as_the_mean_radius_says() -> None:
    found = SphericalCoordinates.distance_WGS84(Angle(), Angle(), Angle(), Angle(math.radians(1)))
    assert found == pytest.approx(6371000 * math.pi / 180)


def test_the_pid_follows_gz_maths_signs() -> None:
    pid = PID(2.0, 1.0, 0.5, 10, -10, 100, -100)
    step = timedelta(seconds=0.1)
    assert pid.update(1.0, step) == pytest.approx(-(2.0 + 0.1 + 0.5 * 10))
    assert pid.update(1.0, step) == pytest.approx(-(2.0 + 0.2))
    assert pid.errors() == pytest.approx((1.0, 0.2, 0.0))
    assert pid.update(1.0, timedelta(0)) == 0.0
    pid.set_cmd_max(1.0)
    assert pid.update(-100.0, 0.0, step) == 1.0


def test_colours_are_clamped_and_temperatures_are_numbers() -> None:
    assert Color(2, 0.5, -1) == Color(1, 0.5, 0, 1)
    assert 300 == Temperature(300) and Temperature(273.15).celsius() == 0  # noqa: SIM300 - as a test of gz-sim asks
    assert Temperature(300).fahrenheit() == pytest.approx(80.33)


def test_boxes_contain_points_and_merge() -> None:
    box = AxisAlignedBox(Vector3d(1, 1, 1), Vector3d(-1, -1, -1))
    assert box.contains(Vector3d(0, 0.5, 1)) and not box.contains(Vector3d(0, 0, 1.1)) and box.volume() == 8
    assert (box + AxisAlignedBox(2, 2, 2, 3, 3, 3)).size() == Vector3d(4, 4, 4)
    assert AxisAlignedBox().volume() == 0


def test_a_rolling_mean_drops_old_values() -> None:
    mean = RollingMean(2)
    assert math.isnan(mean.mean())
    for value in (1, 2, 4):
        mean.push(value)
    assert mean.mean() == 3 and mean.count() == 2


def test_a_name_missing_from_gz_math_names_a_replacement() -> None:
    with pytest.raises(AttributeError, match=r"no Rand; use random\.Random"):
        gz.Rand  # noqa: B018
    with pytest.raises(AttributeError, match=r"simkit's gz\.math has no Frustum; docs/gazebo_python\.md"):
        gz.Frustum  # noqa: B018


def test_vectors_of_another_library_are_accepted() -> None:
    class Foreign:
        def x(self) -> float:
            return 1.0

        def y(self) -> float:
            return 2.0

        def z(self) -> float:
            return 3.0

    assert list(Vector3d(1, 1, 1) + Foreign()) == [2, 3, 4]
    assert Vector3d(Foreign()).length() == pytest.approx(math.sqrt(14))
