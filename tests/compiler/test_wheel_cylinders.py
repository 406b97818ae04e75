"""Collision meshes that are round about the joint of their link collide as cylinders; all others as they are."""

from __future__ import annotations

import math

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.pose import IDENTITY, Pose
from simkit.scene import Axis, Mesh, SceneJoint, Surface

CYLINDER, MESH = mujoco.mjtGeom.mjGEOM_CYLINDER, mujoco.mjtGeom.mjGEOM_MESH
RADIUS, WIDTH = 0.1, 0.04
PLAIN = Surface()
QUARTER = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)


def prism(sides, radius=RADIUS, width=WIDTH):
    return trimesh.creation.cylinder(radius, width, sections=sides)


def revolved(*profile, sides=64):
    """A solid of revolution about z; radius and height of the corners of its section [m]."""
    return trimesh.creation.revolve(np.array(profile), sections=sides)


def axle(kind="continuous", direction=(0.0, 0.0, 1.0), lower=-math.inf, upper=math.inf):
    axes = () if kind == "fixed" else (Axis(direction, direction, lower, upper),)
    return SceneJoint("axle", "cart::axle", kind, "cart::base", "cart::wheel", IDENTITY, axes)


@pytest.fixture
def wheel(make, compiled, tmp_path):
    """The geom of a mesh on a link that hangs on a joint, with the names and what the user hears about meshes."""

    def build(mesh, joint=None, pose=IDENTITY, scale=(1.0, 1.0, 1.0), surface=PLAIN, **options):
        mesh.export(tmp_path / "wheel.stl")
        shape = Mesh(tmp_path / "wheel.stl", "wheel.stl", scale, **options)
        links = make.link("cart::base"), make.link("cart::wheel", shape, shape_pose=pose, surface=surface)
        c = compiled(make.model("cart", *links, joints=(joint or axle(),)))
        (geom,) = c.names.link("cart::wheel").geoms
        return c, c.model.geom(geom), [d for d in c.builder.diagnostics if d.code.startswith("SK-MESH")]

    return build


@pytest.mark.parametrize("sides", [16, 24, 48, 200])
def test_a_prism_that_turns_about_its_axis_collides_as_the_cylinder_through_its_corners(wheel, sides):
    _, geom, said = wheel(prism(sides))
    assert geom.type == CYLINDER
    assert geom.size[:2] == pytest.approx((RADIUS, WIDTH / 2), rel=1e-6)
    assert geom.pos == pytest.approx((0.0, 0.0, 0.0), abs=1e-7)
    assert [(d.severity, d.code) for d in said] == [("note", "SK-MESH-016")]
    assert "wheel.stl" in said[0].message
    assert "radius 0.1 m and length 0.04 m" in said[0].message


def test_the_cylinder_lies_where_the_mesh_lies(wheel):
    moved = prism(48)
    moved.apply_transform(trimesh.transformations.rotation_matrix(math.pi / 2, (0, 1, 0)))
    moved.apply_translation((0.03, 0.0, 0.0))
    pose = Pose((0.0, 0.01, 0.0), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)))  # x of the mesh is y of the link
    _, geom, _ = wheel(moved, axle(direction=(0.0, 1.0, 0.0)), pose)
    assert geom.type == CYLINDER
    assert geom.pos == pytest.approx((0.0, 0.04, 0.0), abs=1e-7)
    assert abs(Pose((0, 0, 0), geom.quat).rotate((0.0, 0.0, 1.0))[1]) == pytest.approx(1.0, abs=1e-9)


def test_the_scale_counts(wheel):
    _, geom, _ = wheel(prism(48), scale=(2.0, 2.0, -3.0))
    assert geom.size[:2] == pytest.approx((2 * RADIUS, 3 * WIDTH / 2), rel=1e-6)
    assert wheel(prism(48), scale=(1.1, 1.0, 1.0))[1].type == MESH


def test_names_masks_and_friction_are_those_of_the_collision(wheel):
    surface = Surface(mu=0.3, mu2=0.3, collide_bitmask=2)
    round_one, as_cylinder, _ = wheel(prism(48), surface=surface)
    square_one, as_mesh, _ = wheel(prism(4), surface=surface)
    assert (as_cylinder.type, as_mesh.type) == (CYLINDER, MESH)
    assert as_cylinder.name == as_mesh.name
    for field in ("friction", "contype", "conaffinity", "condim", "priority", "solref", "solimp"):
        np.testing.assert_array_equal(getattr(as_cylinder, field), getattr(as_mesh, field))
    for c in (round_one, square_one):
        link = c.names.link("cart::wheel")
        for geom in (*link.geoms, *link.ray_geoms):
            assert c.names.geom_owner(geom) == ("cart::wheel", "cart::wheel::c", False)
            assert c.model.geom_type[geom] == MESH or geom not in link.ray_geoms
    links = [c.names.link("cart::wheel") for c in (round_one, square_one)]
    assert [set(link.geoms) & set(link.ray_geoms) == set() for link in links] == [True, False]


@pytest.mark.parametrize(
    "joint",
    [
        axle("revolute"),
        axle("revolute", lower=-4.0, upper=4.0),
        axle("continuous", direction=(0.0, 0.0, -1.0)),
        axle("continuous", direction=(0.0, math.sin(0.01), math.cos(0.01))),
    ],
)
def test_any_joint_that_lets_it_turn_right_round_will_do(wheel, joint):
    assert wheel(prism(48), joint)[1].type == CYLINDER


@pytest.mark.parametrize(
    "joint",
    [
        axle("fixed"),
        axle("prismatic"),
        axle("revolute", lower=-3.0, upper=3.0),
        axle(direction=(1.0, 0.0, 0.0)),
        axle(direction=(0.0, math.sin(0.05), math.cos(0.05))),
    ],
    ids=["fixed", "slides", "has limits", "across", "cambered by 3 degrees"],
)
def test_a_mesh_that_does_not_turn_about_its_own_axis_stays_a_mesh(wheel, joint):
    _, geom, said = wheel(prism(48), joint)
    assert geom.type == MESH
    assert not said


def test_a_mesh_beside_the_axis_is_a_cam_and_stays_a_mesh(wheel):
    assert wheel(prism(48), pose=Pose((0.005 * RADIUS, 0.0, 0.0)))[1].type == CYLINDER
    assert wheel(prism(48), pose=Pose((0.03 * RADIUS, 0.0, 0.0)))[1].type == MESH


@pytest.mark.parametrize(
    "mesh",
    [
        prism(4),
        prism(6),
        prism(12),
        trimesh.creation.icosphere(4, RADIUS),
        trimesh.creation.capsule(WIDTH, RADIUS),
        revolved((0, -0.02), (0.1, -0.02), (0.09, 0.02), (0, 0.02)),
        revolved((0, -0.02), (0.09, -0.02), (0.1, 0.0), (0.09, 0.02), (0, 0.02)),
        revolved((0, -0.02), (0.1, -0.02), (0.1, 0.02), (0.03, 0.02), (0.03, 0.04), (0, 0.04)),
    ],
    ids=["square", "hexagon", "12 sides", "ball", "capsule", "cone", "crowned", "with a hub"],
)
def test_a_mesh_that_is_not_a_cylinder_stays_a_mesh(wheel, mesh):
    _, geom, said = wheel(mesh)
    assert geom.type == MESH
    assert "SK-MESH-016" not in [d.code for d in said]


def test_bevelled_rims_and_an_open_middle_make_no_difference(wheel):
    bevel = 0.003
    rim = (0.1 - bevel, -0.02), (0.1, bevel - 0.02), (0.1, 0.02 - bevel), (0.1 - bevel, 0.02)
    tyre = revolved((0.06, -0.02), *rim, (0.06, 0.02), (0.06, -0.02))
    _, geom, said = wheel(tyre)
    assert geom.type == CYLINDER
    assert geom.size[:2] == pytest.approx((RADIUS, WIDTH / 2), rel=1e-6)
    assert [d.code for d in said] == ["SK-MESH-016"]


def test_a_rim_within_the_tyre_belongs_to_it_and_a_stub_axle_beside_it_does_not(wheel, make, compiled, tmp_path):
    tyre = trimesh.creation.annulus(0.06, RADIUS, WIDTH, sections=48)
    rim = prism(24, 0.05, 0.03)
    assert wheel(trimesh.util.concatenate([tyre, rim]))[1].type == CYLINDER
    stub = prism(24, 0.01, 0.02)
    stub.apply_translation((0.0, 0.0, 0.05))
    trimesh.util.concatenate([tyre, stub]).export(tmp_path / "wheel.stl")
    links = make.link("cart::base"), make.link("cart::wheel", Mesh(tmp_path / "wheel.stl", "wheel.stl"))
    c = compiled(make.model("cart", *links, joints=(axle(),)))
    assert [c.model.geom(g).type for g in c.names.link("cart::wheel").geoms] == [MESH, MESH]


def test_a_tyre_that_is_fixed_on_a_hub_turns_with_it(make, compiled, tmp_path):
    prism(48).export(tmp_path / "tyre.stl")
    turned = Pose((0.2, 0.3, 0.0), QUARTER)  # z of the tyre is -y of the hub
    links = (
        make.link("cart::base"),
        make.link("cart::hub", pose=Pose((0.2, 0.3, 0.0))),
        make.link("cart::tyre", Mesh(tmp_path / "tyre.stl", "tyre.stl"), turned),
    )
    y = (0.0, 1.0, 0.0)
    joints = (
        SceneJoint("axle", "cart::axle", "continuous", "cart::base", "cart::hub", links[1].pose_world, (Axis(y, y),)),
        SceneJoint("bead", "cart::bead", "fixed", "cart::hub", "cart::tyre", turned),
    )
    c = compiled(make.model("cart", *links, joints=joints))
    (geom,) = c.names.link("cart::tyre").geoms
    assert c.model.geom(geom).type == CYLINDER


def test_a_free_or_static_mesh_stays_a_mesh(make, compiled, tmp_path):
    prism(48).export(tmp_path / "wheel.stl")
    shape = Mesh(tmp_path / "wheel.stl", "wheel.stl")
    arena = make.model("arena", make.link("arena::link", shape, Pose((1.0, 0.0, 0.0))), static=True)
    c = compiled(make.solid("coin", shape), arena)
    kinds = [c.model.geom(g).type for name in ("coin::link", "arena::link") for g in c.names.link(name).geoms]
    assert kinds == [MESH, MESH]
