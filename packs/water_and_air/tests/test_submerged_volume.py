"""Volume of solids below a plane, against formulas and an independent computation."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit.extend import Box, Cylinder, Sphere
from simkit.scene import Capsule, Cone, Ellipsoid, Geometry, Plane
from simkit_water_and_air.plugins.fluids.submerged_volume import Polyhedron, Solid, solid_of

SHAPES: list[Geometry] = [
    Box((1.0, 2.0, 3.0)),
    Sphere(0.7),
    Ellipsoid((0.5, 1.0, 2.0)),
    Cylinder(0.6, 2.0),
    Cylinder(1.0, 0.01),
    Capsule(0.5, 1.2),
    Cone(0.8, 1.5),
]
WAYS = [
    (0, 0, 1),
    (0, 0, -1),
    (1, 0, 0),
    (0, -1, 0),
    (1, 1, 1),
    (0.3, -0.2, 0.9),
    (1e-9, 0, 1),
    (1, 0, 1e-9),
    (-0.6, 0.8, 0),
]


def make_solid(shape: Geometry) -> Solid:
    found = solid_of(shape, lambda _: None)
    assert found is not None
    return found


def below(solid: Solid, normal: np.ndarray, height: float) -> tuple[float, np.ndarray]:
    """Return the volume with normal · x <= height, and that volume times its centre."""
    volume, *moment = solid.cut(*normal.tolist(), float(height))
    return volume, np.array(moment)


def unit(way: tuple[float, ...]) -> np.ndarray:
    return np.array(way, float) / np.linalg.norm(way)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
@pytest.mark.parametrize("way", WAYS)
def test_the_parts_on_both_sides_of_a_plane_add_up(shape: Geometry, way: tuple[float, ...]) -> None:
    solid, normal = make_solid(shape), unit(way)
    for part in np.linspace(-1.05, 1.05, 12):
        height = normal @ solid.centre + part * solid.reach
        wet, moment = below(solid, normal, height)
        dry, other = below(solid, -normal, -height)
        assert wet + dry == pytest.approx(solid.volume, rel=1e-7)
        assert moment + other == pytest.approx(solid.volume * solid.centre, abs=1e-7 * solid.volume * solid.reach)
        assert -1e-9 * solid.volume <= wet <= solid.volume * (1 + 1e-9)


@pytest.mark.parametrize("shape", SHAPES, ids=str)
def test_the_moment_is_the_integral_of_the_height_over_the_volume(shape: Geometry) -> None:
    """The derivative dV/dh is the area A(h) of the cut; the moment along the normal is the integral of h A(h)."""
    solid, normal = make_solid(shape), unit((0.3, -0.5, 0.7))
    heights = np.linspace(-solid.reach, solid.reach, 4001) + normal @ solid.centre
    volumes = np.array([below(solid, normal, h)[0] for h in heights[::10]])
    along = np.interp(heights, heights[::10], volumes)
    expected = heights[-1] * volumes[-1] - np.trapezoid(along, heights)
    assert normal @ below(solid, normal, heights[-1])[1] == pytest.approx(
        expected, abs=2e-4 * solid.volume * solid.reach
    )


def test_known_volumes_and_centres() -> None:
    up = np.array((0, 0, 1.0))
    assert make_solid(Box((1, 2, 3))).volume == pytest.approx(6)
    assert below(make_solid(Sphere(0.5)), up, 0.2)[0] == pytest.approx(math.pi * 0.7**2 * (1.5 - 0.7) / 3)
    assert below(make_solid(Sphere(0.5)), up, 0.0)[1][2] == pytest.approx(-math.pi * 0.5**4 / 4)
    assert make_solid(Cone(0.6, 2)).volume == pytest.approx(math.pi * 0.36 * 2 / 3, rel=1e-9)
    assert make_solid(Cone(0.6, 2)).centre == pytest.approx((0, 0, -0.5), abs=1e-9)
    assert make_solid(Capsule(0.5, 1)).volume == pytest.approx(math.pi * (0.25 + 4 / 3 * 0.125), rel=1e-9)
    lying = below(make_solid(Cylinder(0.5, 2)), np.array((1.0, 0, 0)), 0.2)
    segment = 0.25 * math.acos(-0.4) + 0.2 * math.sqrt(0.25 - 0.04)
    assert lying[0] == pytest.approx(2 * segment, rel=1e-9)
    assert lying[1][0] == pytest.approx(-2 * 2 / 3 * (0.25 - 0.04) ** 1.5, rel=1e-8)


def test_equal_shapes_of_different_types_have_equal_volumes() -> None:
    """A ball is an ellipsoid, a capsule of length zero, and approximately a polyhedron with many faces."""
    normal = unit((0.2, 0.4, 0.7))
    ball, bean = make_solid(Sphere(0.5)), make_solid(Capsule(0.5, 1e-9))
    assert below(bean, normal, 0.13)[0] == pytest.approx(below(ball, normal, 0.13)[0], rel=1e-7)
    assert below(bean, normal, 0.13)[1] == pytest.approx(below(ball, normal, 0.13)[1], rel=1e-6)


def test_a_polyhedron_turned_inside_out_is_the_same() -> None:
    corners = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
    faces = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    right, wrong = Polyhedron(corners[faces]), Polyhedron(corners[faces[:, ::-1]])
    assert right.volume == wrong.volume == pytest.approx(1 / 6)
    assert right.centre == pytest.approx((0.25, 0.25, 0.25)) and wrong.centre == pytest.approx(right.centre)
    # the tip above z = 0.4 is the same shape, 0.6 times as large
    assert below(right, np.array((0, 0, 1.0)), 0.4)[0] == pytest.approx((1 - 0.6**3) / 6)


def test_a_shape_without_a_volume_is_no_solid() -> None:
    assert solid_of(Plane(), lambda _: None) is None


@pytest.mark.parametrize("way", WAYS)
def test_the_scalar_and_the_array_computation_agree(way: tuple[float, ...]) -> None:
    box, normal = make_solid(Box((1.0, 2.0, 3.0))), unit(way)
    assert isinstance(box, Polyhedron)
    for height in np.linspace(-2.0, 2.0, 21).tolist():
        few, many = box._cut_few(*normal.tolist(), height), box._cut_many(*normal.tolist(), height)
        assert few == pytest.approx(many, rel=1e-12, abs=1e-12)
