"""Functions of `tf.transformations` and `tf_transformations`."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest

from simkit_nodes import transformations as ros1
from simkit_nodes.ros_modules import tf_transformations as ros2

SEQUENCES = [f"{frame}{a}{b}{c}" for frame, a, b, c in product("sr", "xyz", "xyz", "xyz") if b not in (a, c)]
AXES = np.identity(3)


@pytest.fixture
def random() -> np.random.Generator:
    return np.random.default_rng(5)


def test_a_quaternion_is_x_y_z_w_and_a_tuple_in_ros_2_and_an_array_in_ros_1() -> None:
    half = math.sqrt(0.5)
    assert ros2.quaternion_from_euler(0.0, 0.0, math.pi / 2) == pytest.approx((0.0, 0.0, half, half))
    assert isinstance(ros2.quaternion_from_euler(0.1, 0.2, 0.3), tuple)
    assert isinstance(ros1.quaternion_from_euler(0.1, 0.2, 0.3), np.ndarray)


@pytest.mark.parametrize("axes", SEQUENCES)
def test_angles_rotate_about_fixed_axes_or_about_axes_that_rotate_along(axes: str, random: np.random.Generator) -> None:
    angles = random.uniform(-1.5, 1.5, 3)
    order = zip(angles, axes[1:], strict=True)
    turns = [ros1.rotation_matrix(angle, AXES["xyz".index(axis)]) for angle, axis in order]
    expected = ros1.concatenate_matrices(*(turns if axes[0] == "r" else reversed(turns)))
    np.testing.assert_allclose(ros1.euler_matrix(*angles, axes), expected, atol=1e-12)
    np.testing.assert_allclose(ros1.euler_matrix(*ros1.euler_from_matrix(expected, axes), axes), expected, atol=1e-12)


@pytest.mark.parametrize("middle", [0.0, math.pi / 2, -math.pi / 2, math.pi])
@pytest.mark.parametrize("axes", SEQUENCES)
def test_angles_of_parallel_axes_give_the_same_rotation(axes: str, middle: float) -> None:
    matrix = ros1.euler_matrix(0.3, middle, -0.4, axes)
    np.testing.assert_allclose(ros1.euler_matrix(*ros1.euler_from_matrix(matrix, axes), axes), matrix, atol=1e-9)


def test_an_unknown_sequence_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        ros1.euler_matrix(0.1, 0.2, 0.3, "xyz")


def test_a_tuple_names_a_sequence() -> None:
    assert ros1.euler_from_matrix(ros1.euler_matrix(0.1, 0.2, 0.3, "rzyx"), (0, 0, 0, 1)) == pytest.approx(
        (0.1, 0.2, 0.3)
    )


@pytest.mark.parametrize("module", [ros1, ros2])
def test_parts_of_a_matrix_give_the_matrix_again(module: object, random: np.random.Generator) -> None:
    parts = random.uniform(0.5, 2, 3), random.normal(size=3), random.uniform(-1.5, 1.5, 3), random.normal(size=3)
    matrix = module.compose_matrix(*parts)  # type: ignore[attr-defined]
    for part, actual in zip(parts, module.decompose_matrix(matrix), strict=False):  # type: ignore[attr-defined]
        np.testing.assert_allclose(actual, part, atol=1e-9)
    rotation = ros1.euler_matrix(*parts[2])
    np.testing.assert_allclose(ros1.quaternion_matrix(ros2.quaternion_from_matrix(matrix)), rotation, atol=1e-9)


def test_every_matrix_is_made_again_from_what_describes_it(random: np.random.Generator) -> None:
    point, normal, other = random.normal(size=(3, 3))
    across = np.cross(normal, other)
    for matrix, again in (
        (ros1.rotation_matrix(0.7, normal, point), lambda m: ros1.rotation_matrix(*ros1.rotation_from_matrix(m))),
        (ros1.reflection_matrix(point, normal), lambda m: ros1.reflection_matrix(*ros1.reflection_from_matrix(m))),
        (ros1.scale_matrix(1.7, point), lambda m: ros1.scale_matrix(*ros1.scale_from_matrix(m))),
        (ros1.scale_matrix(1.7, point, normal), lambda m: ros1.scale_matrix(*ros1.scale_from_matrix(m))),
        (ros1.shear_matrix(0.4, across, point, normal), lambda m: ros1.shear_matrix(*ros1.shear_from_matrix(m))),
        (ros1.projection_matrix(point, normal), lambda m: ros1.projection_matrix(*ros1.projection_from_matrix(m))),
        (
            ros1.projection_matrix(point, normal, perspective=other),
            lambda m: ros1.projection_matrix(*ros1.projection_from_matrix(m)),
        ),
    ):
        assert ros1.is_same_transform(again(matrix), matrix)


def test_superimposition_finds_the_movement_of_points(random: np.random.Generator) -> None:
    points = random.normal(size=(3, 8))
    matrix = ros1.concatenate_matrices(ros1.translation_matrix((1, 2, 3)), ros1.random_rotation_matrix((0.1, 0.5, 0.9)))
    moved = np.dot(matrix[:3, :3], points) + matrix[:3, 3:]
    np.testing.assert_allclose(ros1.superimposition_matrix(points, moved), matrix, atol=1e-12)
    np.testing.assert_allclose(
        ros1.superimposition_matrix(points, 2 * moved, scaling=True)[:3], 2 * matrix[:3], atol=1e-12
    )


def test_slerp_takes_the_shorter_way() -> None:
    start, end = ros1.quaternion_about_axis(0.0, (0, 0, 1)), -ros1.quaternion_about_axis(1.0, (0, 0, 1))
    assert ros1.euler_from_quaternion(ros1.quaternion_slerp(start, end, 0.25))[2] == pytest.approx(0.25)


def test_results_are_those_of_transforms3d(random: np.random.Generator) -> None:
    euler = pytest.importorskip("transforms3d.euler")
    for axes in SEQUENCES:
        angles = random.uniform(-3, 3, 3)
        w, x, y, z = euler.euler2quat(*angles, axes)
        assert ros2.quaternion_from_euler(*angles, axes) == pytest.approx((x, y, z, w), abs=1e-12)
        assert ros2.euler_from_quaternion((x, y, z, w), axes) == pytest.approx(euler.quat2euler((w, x, y, z), axes))
