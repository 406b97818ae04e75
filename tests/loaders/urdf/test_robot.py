"""URDF: links, joints, materials, and the reports on mistakes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from urdf_robots import ARM, LIMIT, MASS, errors, joint, link, robot, with_code

import simkit
from simkit.scene import Box, Capsule, Cylinder, Mesh, Sphere


def test_links_and_joints_have_the_poses_of_their_origins(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + joint("ab", "a", "b", f'<origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="2 0 0"/>{LIMIT}')
        + joint("bc", "b", "c", '<origin xyz="1 0 0"/>', "continuous")
    )
    model = load(text)[0].model
    places = {x.name: x.pose_world.position for x in model.links}
    np.testing.assert_allclose(places["c"], (0, 1, 1), atol=1e-15)
    ab, bc = model.joints
    np.testing.assert_allclose(ab.axes[0].xyz_world, (0, 1, 0), atol=1e-15)
    axis = ab.axes[0]
    assert (axis.lower, axis.upper, axis.effort, axis.velocity) == (-1, 2, 3, 4)
    assert (bc.parent_link, bc.child_link) == ("r::b", "r::c")
    assert (bc.axes[0].lower, bc.axes[0].upper, bc.axes[0].xyz_joint) == (-math.inf, math.inf, (1.0, 0.0, 0.0))


def test_name_and_pose_given_by_the_caller_replace_those_of_the_file(load):
    model = load(ARM, name="left", pose=simkit.Pose((1, 2, 3)))[0].model
    assert [x.scoped for x in model.links] == ["left::base", "left::arm"]
    np.testing.assert_allclose(model.links[0].pose_world.position, (1, 2, 3))


def test_the_inertia_is_rotated_from_the_inertial_origin_to_link_axes(load):
    text = robot(
        link(
            "a",
            '<inertial><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/><mass value="2"/>'
            '<inertia ixx="1" iyy="2" izz="3"/></inertial>',
        )
    )
    inertial = load(text)[0].model.links[0].inertial
    assert (inertial.mass, inertial.com) == (2, (1, 0, 0))
    np.testing.assert_allclose(inertial.inertia, (2, 1, 3, 0, 0, 0), atol=1e-15)


def test_a_link_without_inertial_is_a_frame_without_mass(load):
    scene, found = load(robot(link("a") + link("frame", "") + joint("j", "a", "frame", "", "fixed")))
    frame = scene.model.links[1]
    assert (frame.inertial.mass, frame.inertial.given) == (0, False)
    assert "frame" in with_code(found, "SK-URDF-024")[0].message


def test_shapes_have_the_sizes_and_names_that_gazebo_gives_them(load):
    shapes = (
        '<box size="1 2 3"/>',
        '<cylinder radius="1" length="2"/>',
        '<sphere radius="3"/>',
        '<capsule radius="1" length="2"/>',
    )
    content = "".join(f"<collision><geometry>{s}</geometry></collision>" for s in shapes)
    content += '<collision name="lid"><origin xyz="0 0 1"/><geometry><sphere radius="1"/></geometry></collision>'
    found = load(robot(link("l", MASS + content)))[0].model.links[0].collisions
    assert [c.name for c in found] == ["l_collision", "l_collision_1", "l_collision_2", "l_collision_3", "lid"]
    expected = [Box((1, 2, 3)), Cylinder(1, 2), Sphere(3), Capsule(1, 2), Sphere(1)]
    assert [c.geometry for c in found] == expected
    np.testing.assert_allclose(found[-1].pose_link.position, (0, 0, 1))


def test_names_of_collisions_are_always_unique(load):
    sphere = '<geometry><sphere radius="1"/></geometry></collision>'
    content = f'<collision>{sphere}<collision name="l_collision">{sphere}<collision name="l_collision">{sphere}'
    found = load(robot(link("l", MASS + content)))[0].model.links[0].collisions
    assert len({c.scoped for c in found}) == 3
    assert "l_collision" in [c.name for c in found]


def test_a_mesh_keeps_its_positive_or_negative_scale(load, write):
    file = write(
        "pkg/urdf/r.urdf",
        robot(link("l", '<visual><geometry><mesh filename="../meshes/m.stl" scale="1 -1 0.001"/></geometry></visual>')),
    )
    write("pkg/meshes/m.stl", "solid")
    write("pkg/package.xml", "<package><name>pkg</name></package>")
    shape = load(file)[0].model.links[0].visuals[0].geometry
    assert isinstance(shape, Mesh)
    assert (shape.scale, shape.file.name, shape.missing) == ((1, -1, 0.001), "m.stl", False)


def test_materials_are_found_by_name_wherever_they_are_defined(load):
    visual = '<visual><geometry><sphere radius="1"/></geometry>{}</visual>'
    text = robot(
        link("a", visual.format('<material name="red"/>'))
        + link("b", visual.format('<material name="own"><color rgba="0 1 0 0.5"/></material>'))
        + link("c", visual.format('<material name="own"/>'))
        + link("d", visual.format('<material name="Gazebo/Blue"/>'))
        + link("e", visual.format('<material name="rde"/>'))
        + "".join(joint(f"j{n}", "a", n, "", "fixed") for n in "bcde")
        + '<material name="red"><color rgba="1 0 0 1"/></material>'
    )
    scene, found = load(text)
    colours = [x.visuals[0].material and x.visuals[0].material.diffuse for x in scene.model.links]
    assert colours == [(1, 0, 0, 1), (0, 1, 0, 0.5), (0, 1, 0, 0.5), (0, 0, 1, 1), None]
    assert with_code(found, "SK-URDF-026")[0].hint == "did you mean 'red'?"


def test_floating_and_planar_joints_and_data_for_controllers_are_read(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + link("d")
        + joint("free", "a", "b", "", "floating")
        + joint("plane", "a", "c", '<axis xyz="0 0 1"/>', "planar")
        + joint(
            "j",
            "a",
            "d",
            LIMIT + '<safety_controller soft_lower_limit="-0.9" soft_upper_limit="1.9" '
            'k_position="10" k_velocity="20"/><calibration rising="0.1"/>',
        )
    )
    free, plane, j = load(text)[0].model.joints
    assert free.axes == ()
    assert [a.xyz_joint for a in plane.axes] == [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert (j.safety.lower, j.safety.upper, j.safety.k_position, j.safety.k_velocity) == (-0.9, 1.9, 10, 20)
    assert (j.calibration.rising, j.calibration.falling) == (0.1, None)


@pytest.mark.parametrize("normal", [(1, 0, 0), (0, 1, 0), (0, 0, -1), (0.6, 0, 0.8), (-0.5, 0.5, 0.70710678)])
def test_the_axes_of_a_planar_joint_are_a_right_handed_frame(load, normal):
    axis = '<axis xyz="{} {} {}"/>'.format(*normal)
    axes = load(robot(link("a") + link("b") + joint("p", "a", "b", axis, "planar")))[0].model.joints[0].axes
    x, y, z = (np.array(a.xyz_joint) for a in axes)
    np.testing.assert_allclose(np.cross(x, y), z, atol=1e-12)
    np.testing.assert_allclose(z, np.array(normal) / np.linalg.norm(normal), atol=1e-9)


def test_mimic_joints_can_form_chains_but_not_rings(load):
    links = link("a") + "".join(link(n) for n in "bcd")
    chain = (
        joint("b", "a", "b")
        + joint("c", "a", "c", LIMIT + '<mimic joint="b" multiplier="-2" offset="0.5"/>')
        + joint("d", "a", "d", LIMIT + '<mimic joint="c"/>')
    )
    scene, found = load(robot(links + chain))
    mimics = [j.axes[0].mimic for j in scene.model.joints]
    assert (mimics[1].joint, mimics[1].multiplier, mimics[1].offset) == ("r::b", -2, 0.5)
    assert mimics[2].joint == "r::c"
    assert not errors(found)
    ring = chain.replace(
        f'name="b" type="revolute"><parent link="a"/><child link="b"/>{LIMIT}',
        f'name="b" type="revolute"><parent link="a"/><child link="b"/>{LIMIT}<mimic joint="d"/>',
    )
    assert any("mimics itself" in e for e in errors(load(robot(links + ring))[1]))


def test_transmissions_keep_joints_actuators_and_reductions(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + joint("j1", "a", "b")
        + joint("j2", "a", "c")
        + '<transmission name="t"><type>transmission_interface/DifferentialTransmission</type>'
        '<joint name="j1"><hardwareInterface>EffortJointInterface</hardwareInterface><role>joint1</role>'
        "<mechanicalReduction>2</mechanicalReduction><offset>0.1</offset></joint>"
        '<joint name="j2"/><actuator name="m"><mechanicalReduction>-50</mechanicalReduction></actuator></transmission>'
        '<ros2_control name="c" type="system"><joint name="j11"/></ros2_control>'
    )
    scene, found = load(text)
    (t,) = scene.model.transmissions
    assert (t.kind, [j.name for j in t.joints], t.actuators[0].reduction) == ("differential", ["j1", "j2"], -50)
    first = t.joints[0]
    assert (first.reduction, first.offset, first.role, first.interfaces) == (
        2,
        0.1,
        "joint1",
        ("EffortJointInterface",),
    )
    assert [c.attribute("name") for c in scene.model.controls] == ["c"]
    assert with_code(found, "SK-URDF-025")[0].hint.startswith("did you mean 'j")
    assert not with_code(found, "SK-URDF-010")


@pytest.mark.parametrize(
    ("base", "links", "expected", "code"),
    [
        ("auto", "base", "auto", "SK-URDF-017"),
        ("fixed", "base", "fixed", ""),
        ("floating", "base", "floating", ""),
        ("auto", "world", "fixed", "SK-URDF-017"),
        ("floating", "world", "fixed", "SK-URDF-018"),
    ],
)
def test_the_base_floats_unless_the_root_link_is_the_world(load, base, links, expected, code):
    scene, found = load(robot(link(links, "") + link("b") + joint("j", links, "b")), base=base)
    assert scene.model.base == expected
    assert {d.code for d in found} & {"SK-URDF-017", "SK-URDF-018"} == ({code} if code else set())


def test_a_root_link_named_world_keeps_its_name_and_fixes_the_robot():
    with simkit.load(
        robot(link("world", "") + link("b") + joint("j", "world", "b", LIMIT + '<axis xyz="0 1 0"/>'))
    ) as sim:
        assert sim.mj_model.nv == 1
        np.testing.assert_allclose(sim.link("r::world").pose.position, 0)
        sim.joint("r::j").set_position(0.5)
        np.testing.assert_allclose(sim.link("r::b").pose.rpy, (0, 0.5, 0), atol=1e-12)


# ---------------------------------------------------------------------- mistakes


def test_every_mistake_of_a_file_is_reported_in_one_pass_with_its_line(load):
    text = """<robot name="r">
      <link name="a"><inertial><mass value="1,5"/><inertia ixx="nan" iyy="1" izz="1"/></inertial></link>
      <link name="a"/>
      <link name="b"><colision><geometry><sphere radius="1"/></geometry></colision></link>
      <joint name="j" type="revolut"><parent link="a"/><child link="b"/></joint>
      <joint name="k" type="revolute"><parent link="aa"/><child link="b"/><axis xyz="0 0 0"/></joint>
      <joint name="l" type="fixed"><parent link="a"/></joint>
      <gazebo reference="bb"><mu1>1</mu1></gazebo>
    </robot>"""
    found = load(text)[1]
    expected = {
        ("SK-URDF-013", 2),
        ("SK-URDF-002", 3),
        ("SK-URDF-010", 4),
        ("SK-URDF-004", 5),
        ("SK-URDF-003", 6),
        ("SK-URDF-001", 7),
        ("SK-URDF-021", 8),
    }
    assert expected <= {(d.code, d.line) for d in found}
    hints = {d.code: d.hint for d in found}
    assert hints["SK-URDF-004"] == "did you mean 'revolute'?"
    assert hints["SK-URDF-003"] == "did you mean 'a'?"
    assert hints["SK-URDF-010"] == "did you mean 'collision'?"
    assert "line 2" in with_code(found, "SK-URDF-002")[0].message
    assert len(with_code(found, "SK-URDF-013")) == 2


def test_a_second_link_of_the_same_name_causes_only_one_error(load):
    link = '<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
    found = load(f'<robot name="r">{link}{link}</robot>')[1]
    assert [d.code for d in found if d.severity != "note"] == ["SK-URDF-002"]


def test_faults_that_other_readers_ignore_are_warnings(load):
    inertial = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
    scene, found = load(
        f"""<robot name="r"><link name="a">{inertial}<visual><geometry><box size="1 1 1"/></geometry>
        <material name="m"><texture/><color rgba="1 0 0 1"/></material></visual></link>
        <gazebo reference="a"><sensor name="s" type="imu"><update_rate>10</update_rate></sensor>
        <sensor name="s" type="imu"><update_rate>20</update_rate></sensor></gazebo></robot>"""
    )
    assert {d.code: d.severity for d in found if d.severity != "note"} == {
        "SK-URI-006": "warning",
        "SK-URDF-030": "warning",
    }
    link = scene.model.links[0]
    assert link.visuals[0].material.diffuse == (1, 0, 0, 1)
    assert [(s.name, s.rate) for s in link.sensors] == [("s", 10)]


def test_a_robot_that_is_not_a_tree_is_an_error(load):
    two_roots = robot(link("a") + link("b"))
    assert "'a' (line 1), 'b' (line 2)" in errors(load(two_roots)[1])[0]
    ring = robot(link("a") + link("b") + joint("j", "a", "b") + joint("k", "b", "a"))
    assert any(e.startswith("SK-URDF-007") and "joints form a ring" in e for e in errors(load(ring)[1]))
    twice = robot(
        link("a") + link("b") + link("c") + joint("j", "a", "b") + joint("k", "a", "c") + joint("m", "c", "b")
    )
    assert any("is the child of two joints, 'j' (line 4) and 'm'" in e for e in errors(load(twice)[1]))
    assert errors(load(robot(""))[1])[0].startswith("SK-URDF-008")


def test_a_urdf_file_with_expressions_causes_a_hint_about_xacro(load):
    text = robot(link("a", '<inertial><mass value="${mass}"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'))
    (problem,) = with_code(load(text)[1], "SK-URDF-013")
    assert "xacro" in problem.hint


def test_missing_limits_are_reported_and_mean_unlimited(load):
    scene, found = load(robot(link("a") + link("b") + joint("j", "a", "b", "")))
    assert scene.model.joints[0].axes[0].upper == math.inf
    assert with_code(found, "SK-URDF-020")[0].severity == "warning"


def test_a_size_of_zero_becomes_0_1_mm_and_a_negative_size_is_an_error(load):
    shape = '<collision><geometry><box size="1 1 {}"/></geometry></collision>'
    scene, found = load(robot(link("l", MASS + shape.format(0))))
    assert scene.model.links[0].collisions[0].geometry == Box((1, 1, 1e-4))
    assert with_code(found, "SK-URDF-028")
    assert with_code(load(robot(link("l", MASS + shape.format(-1))))[1], "SK-URDF-009")


def test_elements_of_other_tools_cause_one_note_and_prefixed_elements_none(load):
    text = robot(link("l", MASS + '<contact><lateral_friction value="1"/></contact><drake:thing/>'))
    found = load(text)[1]
    assert [d.severity for d in with_code(found, "SK-URDF-011")] == ["note"]
    assert not [d for d in found if "drake" in d.message]


def test_a_sensor_and_a_state_of_the_urdf_specification_are_a_note_with_what_measures(load):
    specified = '<sensor name="c"><parent link="l"/><camera/></sensor><model_state model="r"/>'
    found = load(robot(link("l", MASS) + specified))[1]
    (note,) = with_code(found, "SK-URDF-011")
    assert note.severity == "note" and "<gazebo reference='LINK'><sensor type='camera'>" in note.hint
    assert "<sensor> in <robot>" in note.message and "<model_state> in <robot>" in note.message
    assert not with_code(found, "SK-URDF-010")


def test_loading_a_robot_is_deterministic(load):
    first, second = (load(ARM)[0].model for _ in range(2))
    assert [(x.scoped, x.pose_world) for x in first.links] == [(x.scoped, x.pose_world) for x in second.links]


# ------------------------------------------------------------------ faults that other readers ignore


def test_a_mass_without_moments_is_a_point_mass_and_moments_without_mass_are_ignored(load):
    scene, found = load(
        robot(
            link("a", '<inertial><origin xyz="1 0 0"/><mass value="2"/></inertial>')
            + link("b", '<inertial><inertia ixx="1" iyy="1" izz="1"/></inertial>')
            + joint("ab", "a", "b", "", "fixed")
        )
    )
    a, b = (x.inertial for x in scene.model.links)
    assert (a.mass, a.com, a.inertia) == (2.0, (1.0, 0.0, 0.0), (0.0,) * 6)
    assert (b.mass, b.given) == (0.0, False)
    assert [(d.severity, d.line) for d in with_code(found, "SK-URDF-031")] == [("warning", 1), ("warning", 2)]
    assert not errors(found)


@pytest.mark.parametrize(
    ("written", "meant"), [("0.001", (0.001,) * 3), ("1 2 3 4", (1.0, 2.0, 3.0)), ("1 2 -3", (1.0, 2.0, -3.0))]
)
def test_a_mesh_scale_can_be_one_number_and_a_fourth_number_is_ignored(load, written, meant):
    shape = f'<visual><geometry><mesh filename="m.stl" scale="{written}"/></geometry></visual>'
    scene, found = load(robot(link("l", MASS + shape)))
    assert scene.model.links[0].visuals[0].geometry.scale == meant
    assert len(with_code(found, "SK-URDF-031")) == (written != "1 2 -3")
    assert not errors(found)


def test_a_scale_that_is_not_a_number_is_an_error(load):
    shape = '<visual><geometry><mesh filename="m.stl" scale="1 x 3 4"/></geometry></visual>'
    assert with_code(load(robot(link("l", MASS + shape)))[1], "SK-URDF-013")


def test_colours_outside_their_range_are_limited_and_extra_numbers_ignored(load):
    visual = (
        '<visual><geometry><sphere radius="1"/></geometry><material name="m"><color rgba="{}"/></material></visual>'
    )
    scene, found = load(robot(link("l", MASS + visual.format("0.1 0.2 0.3 0 1") + visual.format("255 0 -1 1"))))
    colours = [v.material.diffuse for v in scene.model.links[0].visuals]
    assert colours == [(0.1, 0.2, 0.3, 0.0), (1.0, 0.0, 0.0, 1.0)]
    assert {d.severity for d in with_code(found, "SK-URDF-031")} == {"warning"}
    assert not errors(found)


def test_a_colour_without_rgba_is_left_out_as_in_urdfdom(load):
    visual = (
        '<visual><geometry><sphere radius="1"/></geometry><material name="m"><color>1 1 1</color></material></visual>'
    )
    scene, found = load(robot(link("l", MASS + visual)))
    assert scene.model.links[0].visuals[0].material is None
    assert len(with_code(found, "SK-URDF-031")) == 1
    assert not errors(found)


def test_a_plane_is_read_as_in_pybullet_and_an_unknown_shape_is_left_out(load):
    text = link(
        "l",
        MASS + '<collision><geometry><plane normal="0 1 0"/></geometry></collision>'
        '<collision><geometry><cdf filename="a.cdf"/></geometry></collision>',
    )
    scene, found = load(robot(text))
    (collision,) = scene.model.links[0].collisions
    assert collision.geometry.normal == (0.0, 1.0, 0.0)
    assert len(with_code(found, "SK-URDF-031")) == 2
    assert not errors(found)
    near = '<collision><geometry><boxx size="1 1 1"/></geometry></collision>'
    assert with_code(load(robot(link("l", MASS + near)))[1], "SK-URDF-009")


def test_the_base_of_a_robot_without_mass_is_fixed_unless_base_is_floating(load):
    text = robot(link("a", "") + link("b", "") + joint("ab", "a", "b", LIMIT))
    with simkit.load(text) as sim:
        sim.joint("r::ab").set_position(0.5)
        sim.step(10)
        assert "SK-URDF-032" in {d.code for d in sim.diagnostics}
        assert sim.link("r::a").pose.position == pytest.approx((0, 0, 0))
        assert sim.joint("r::ab").position == pytest.approx(0.5)
    with pytest.raises(simkit.LoadError, match="SK-JOINT-010"):
        simkit.load(text, base="floating")


def test_a_massless_root_link_with_only_planar_joints_is_fixed(load):
    text = robot(link("footprint", "") + link("base") + joint("drive", "footprint", "base", "", "planar"))
    with simkit.load(text) as sim:
        assert "SK-URDF-032" in {d.code for d in sim.diagnostics}
        sim.step(10)
        assert sim.link("r::footprint").pose.position == pytest.approx((0, 0, 0))


@pytest.mark.parametrize(("right", "wrong"), [('child link="b"', 'child link="bb"'), ("revolute", "revolut")])
def test_a_faulty_joint_is_one_problem_and_its_consequences_are_none(load, right: str, wrong: str) -> None:
    dynamics = '<dynamics damping="1" friction="1"/><safety_controller k_velocity="1"/>'
    text = robot(
        link("a") + link("b") + link("c")
        + joint("ab", "a", "b", f'<axis xyz="0 0 1"/>{LIMIT}{dynamics}')
        + joint("ac", "a", "c", '<axis xyz="0 0 1"/><mimic joint="ab"/>', "continuous")
        + '<transmission name="t"><type>transmission_interface/SimpleTransmission</type><joint name="ab"/>'
        + '<actuator name="x"/></transmission><gazebo reference="ab"><springStiffness>1</springStiffness></gazebo>'
    )  # fmt: skip
    text = text.replace("<child link='b'", '<child link="b"')
    assert right in text
    with pytest.raises(simkit.LoadError) as refused:
        simkit.load(text.replace(right, wrong, 1))
    told = [d for d in refused.value.diagnostics if d.severity != "note"]
    assert [d.code for d in told] == ["SK-URDF-003" if "bb" in wrong else "SK-URDF-004"]


def test_a_joint_that_mimics_a_fixed_joint_moves_freely_with_a_warning(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + joint("ab", "a", "b", "", "fixed")
        + joint("bc", "b", "c", LIMIT + '<mimic joint="ab"/>')
    )
    scene, found = load(text)
    assert not errors(found)
    assert with_code(found, "SK-URDF-015")[0].severity == "warning"
    assert scene.model.joints[1].axes[0].mimic is None


def test_mimic_of_a_fixed_joint_has_no_effect_whatever_it_names(load):
    text = robot(
        link("a")
        + link("b")
        + link("c")
        + link("d")
        + joint("ab", "a", "b", "", "fixed")
        + joint("bc", "b", "c", '<mimic joint="ab"/>', "fixed")
        + joint("cd", "c", "d", '<mimic joint="nowhere"/>', "fixed")
    )
    _, found = load(text)
    told = with_code(found, "SK-URDF-015")
    assert [(d.severity, d.message, d.hint) for d in told] == [
        ("warning", f"fixed joint {name!r}: <mimic> has no effect", "") for name in ("bc", "cd")
    ]


def test_a_gazebo_joint_that_repeats_a_joint_of_the_robot_is_left_out(load):
    extra = """<gazebo><joint name="ab" type="prismatic"><parent>a</parent><child>b</child>
      <axis><xyz>0 1 0</xyz></axis></joint></gazebo>"""
    scene, found = load(robot(link("a") + link("b") + joint("ab", "a", "b") + extra))
    assert [(j.name, j.type) for j in scene.model.joints] == [("ab", "revolute")]
    assert [(d.code, d.severity) for d in found if d.severity != "note"] == [("SK-URDF-002", "warning")]


def test_a_spherical_joint_of_pybullet_is_a_ball_joint(load):
    text = robot(link("a") + link("b") + joint("ab", "a", "b", '<axis xyz="0 0 1"/>' + LIMIT, "spherical"))
    scene, found = load(text)
    assert (scene.model.joints[0].type, scene.model.joints[0].axes) == ("ball", ())
    assert with_code(found, "SK-URDF-004")[0].severity == "warning"
    with simkit.load(text) as sim:
        assert sim.joint("r::ab").dof == 3
