"""Includes: names, poses, static, built-in models, merging, and refused includes."""

from __future__ import annotations

import numpy as np
import pytest

BOX = """<sdf version="1.9"><model name="box"><pose>9 9 9 0 0 0</pose>
  <link name="l"><pose>0 0 1 0 0 0</pose></link></model></sdf>"""


def test_an_include_renames_places_and_fixes_a_model(load, write):
    root = write("models/box/model.sdf", BOX).parents[1]
    world = """<sdf version="1.9"><world name="w"><include><uri>model://box</uri><name>b1</name>
      <pose>1 2 3 0 0 0</pose><static>true</static><plugin name="p" filename="libp.so"/></include>
      <include><uri>model://box</uri></include></world></sdf>"""
    scene, found = load(world, (root,))
    first, second = scene.world.models
    assert (first.name, first.static, [p.filename for p in first.plugins]) == ("b1", True, ["libp.so"])
    np.testing.assert_allclose(first.links[0].pose_world.position, (1, 2, 4))
    np.testing.assert_allclose(second.links[0].pose_world.position, (9, 9, 10))
    assert not [d for d in found if d.severity == "error"]


def test_an_include_inside_an_old_model_is_nested_and_static_with_it(load, write):
    root = write("models/box/model.sdf", BOX.replace("1.9", "1.5")).parents[1]
    scene, _ = load(
        '<sdf version="1.6"><world name="w"><model name="outer"><static>1</static>'
        "<include><uri>model://box</uri></include></model></world></sdf>",
        (root,),
    )
    nested = scene.world.models[0].models[0]
    assert (nested.scoped, nested.static, nested.links[0].scoped) == ("outer::box", True, "outer::box::l")


def test_a_merged_model_becomes_part_of_the_including_model(load, write):
    root = write("models/box/model.sdf", BOX).parents[1]
    scene, found = load(
        '<sdf version="1.9"><model name="m"><link name="own"/><include merge="true"><uri>model://box</uri>'
        "<pose>0 5 0 0 0 0</pose></include></model></sdf>",
        (root,),
    )
    assert not [d for d in found if d.severity == "error"]
    assert [link.scoped for link in scene.model.links] == ["m::own", "m::l"]
    np.testing.assert_allclose(scene.model.links[1].pose_world.position, (0, 5, 1))
    assert [f.name for f in scene.model.frames] == ["_merged__box____model__"]


ROBOT = """<robot name="r"><link name="base"><inertial><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
BALL = '<mujoco model="ball"><worldbody><body name="b"><freejoint/><geom size="0.1"/></body></worldbody></mujoco>'


@pytest.mark.parametrize(
    "inside",
    ['<include merge="true"><uri>model://r</uri></include>',
     '<include><uri>model://r</uri><experimental:params><link element_id="base" action="remove"/>'
     "</experimental:params></include>"],
)  # fmt: skip
def test_a_urdf_robot_cannot_be_merged_or_changed_by_an_include(load, write, inside):
    root = write("models/r/r.urdf", ROBOT).parents[1]
    _, found = load(f'<sdf version="1.9"><model name="m"><link name="own"/>{inside}</model></sdf>', (root,))
    errors = [d for d in found if d.severity == "error"]
    assert [d.code for d in errors] == ["SK-URDF-029"]
    assert "simkit convert" in errors[0].hint


@pytest.mark.parametrize(
    ("names", "chosen"),
    [
        (("robot.xml", "scene.xml", "package.xml"), "robot.xml"),
        (("hand.xml", "r.xml"), "r.xml"),
        (("hand.xml", "arm.xml"), None),
    ],
)
def test_a_folder_with_one_model_of_mujocos_own_format_is_that_model(load, write, names, chosen):
    for name in names:
        file = write(f"models/r/{name}", BALL if name == chosen or chosen is None else BALL.replace('"b"', '"other"'))
    world = '<sdf version="1.9"><world name="w"><include><uri>model://r</uri></include></world></sdf>'
    scene, found = load(world, (file.parents[1],))
    if chosen is None:
        assert [d.code for d in found if d.severity == "error"] == ["SK-URI-005"]
        assert "arm.xml, hand.xml" in found[0].message
    else:
        assert [link.name for link in scene.world.models[0].links] == ["b"]


@pytest.mark.parametrize(
    "ground", ["model://ground_plane", "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Ground Plane"]
)
def test_ground_plane_and_sun_are_built_in(load, ground):
    scene, found = load(
        f'<sdf version="1.6"><world name="w"><include><uri>{ground}</uri></include>'
        "<include><uri>model://sun</uri></include></world></sdf>"
    )
    assert not found
    assert scene.world.models[0].static and scene.world.models[0].links[0].collisions[0].surface.mu == 100
    sun = scene.world.lights[0]
    assert (sun.type, sun.cast_shadows, tuple(sun.pose_world.position)) == ("directional", True, (0, 0, 10))


def test_a_missing_fuel_model_is_one_error_with_its_url(load):
    url = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Coke"
    _, found = load(f'<sdf version="1.6"><world name="w"><include><uri>{url}</uri></include></world></sdf>')
    assert [d.code for d in found] == ["SK-URI-002"]
    assert url in found[0].message


def test_fuel_caches_are_read(load, write, monkeypatch):
    cached = write("cache/fuel.gazebosim.org/openrobotics/models/coke/2/model.sdf", BOX)
    monkeypatch.setenv("GZ_FUEL_CACHE_PATH", str(cached.parents[5]))
    url = "https://fuel.gazebosim.org/1.0/OpenRobotics/models/Coke"
    scene, found = load(f'<sdf version="1.6"><world name="w"><include><uri>{url}</uri></include></world></sdf>')
    assert [m.name for m in scene.world.models] == ["box"]
    assert not [d for d in found if d.severity == "error"]


@pytest.mark.parametrize(("version", "severity"), [("1.5", "warning"), ("1.9", "error")])
def test_of_several_lights_in_an_included_file_gazebo_classic_uses_the_first(load, write, version, severity):
    lights = "".join(f'<light name="{n}" type="point"><pose>0 0 {n} 0 0 0</pose></light>' for n in (1, 2, 3))
    path = write("models/lights/model.sdf", f'<sdf version="{version}">{lights}</sdf>')
    world = "<sdf version='1.6'><world name='w'><include><uri>model://lights</uri></include></world></sdf>"
    scene, found = load(world, (path.parents[1],))
    assert [d.severity for d in found if d.code == "SK-SDF-016"] == [severity]
    if severity == "warning":
        assert [light.name for light in scene.world.lights] == ["1"]


def test_a_circle_of_includes_is_an_error(load, write):
    text = '<sdf version="1.9"><model name="a"><link name="l"/><include><uri>model://a</uri></include></model></sdf>'
    path = write("models/a/model.sdf", text)
    _, found = load(path, (path.parents[1],))
    assert "SK-SDF-016" in {d.code for d in found}


def test_model_config_chooses_the_highest_version(load, write):
    write("models/box/old.sdf", BOX.replace('"l"', '"old"'))
    write("models/box/new.sdf", BOX.replace('"l"', '"new"'))
    write("models/box/model.config", '<model><sdf version="1.4">old.sdf</sdf><sdf version="1.5">new.sdf</sdf></model>')
    root = write("models/x", "").parent
    scene, _ = load(
        '<sdf version="1.9"><world name="w"><include><uri>model://box</uri></include></world></sdf>', (root,)
    )
    assert scene.world.models[0].links[0].name == "new"


@pytest.mark.parametrize("uri", ["model://box/../../secret.sdf", "../../../secret.sdf", "/etc/hostname"])
def test_a_uri_outside_its_folders_is_refused(load, write, uri):
    path = write(
        "models/worlds/w.sdf", f'<sdf version="1.9"><world name="w"><include><uri>{uri}</uri></include></world></sdf>'
    )
    _, found = load(path)
    assert [d.code for d in found] == ["SK-URI-003"]


def test_a_missing_mesh_is_a_warning_that_lists_the_searched_paths(load, write):
    path = write(
        "m/model.sdf",
        '<sdf version="1.9"><model name="m"><link name="l"><collision name="c"><geometry><mesh>\n'
        "<uri>meshes/x.dae</uri></mesh></geometry></collision></link></model></sdf>",
    )
    _, found = load(path)
    (missing,) = [d for d in found if d.severity == "warning"]
    assert (missing.code, missing.file, missing.line) == ("SK-URI-001", str(path), 2)
    assert (
        str(path.parent / "meshes" / "x.dae") in missing.message
        and "the shape is left out of drawing and contacts" in missing.message
    )


def test_a_file_of_a_bundled_model_in_a_group_is_found(load):
    mesh = "<mesh><uri>model://aruco_box/meshes/marker.obj</uri></mesh>"
    box = f"""<sdf version="1.9"><model name="m"><link name="l">
      <visual name="v"><geometry>{mesh}</geometry></visual></link></model></sdf>"""
    scene, found = load(box)
    (link,) = scene.model.links
    assert link.visuals[0].geometry.file.parts[-4:] == ("office", "aruco_box", "meshes", "marker.obj")
    assert not [d for d in found if d.code.startswith("SK-URI")]


def test_missing_includes_are_warnings_in_a_world_with_others(load, write):
    root = write("models/box/model.sdf", BOX).parents[1]
    missing = "".join(
        f"<include><uri>{uri}</uri></include>\n"
        for uri in ("model://lamp", "model://tree", "model://tree", "https://fuel.gazebosim.org/1.0/o/models/Nobody")
    )
    world = f'<sdf version="1.9"><world name="w">\n{missing}{{}}</world></sdf>'
    scene, found = load(world.format("<include><uri>model://box</uri></include>"), (root,))
    assert [m.name for m in scene.world.models] == ["box"]
    reported = {d.code: d for d in found}
    assert {d.severity for d in reported.values() if d.code.startswith("SK-URI")} == {"warning"}
    assert "model://lamp (line 2), model://tree (line 3, 4)" in reported["SK-URI-001"].message
    assert "Nobody is not on this machine" in reported["SK-URI-002"].message

    _, found = load(world.format(""), (root,))
    assert [d.line for d in found if d.severity == "error"] == [2, 3, 4, 5]


def test_a_missing_include_of_a_bare_model_is_an_error(load, write):
    root = write("models/box/model.sdf", BOX).parents[1]
    includes = "<include><uri>model://box</uri></include><include><uri>model://lamp</uri></include>"
    _, found = load(f'<sdf version="1.9"><model name="m">{includes}</model></sdf>', (root,))
    assert [d.code for d in found if d.severity == "error"] == ["SK-URI-001"]


def test_a_model_is_found_although_a_package_has_its_name(load, write):
    write("project/robot_lamp/package.xml", "<package><name>robot_lamp</name></package>")
    write("project/.git/HEAD", "")
    write("project/robot_lamp/models/lamp/model.sdf", BOX)
    write("project/world/package.xml", "<package><name>world</name></package>")
    world = "<sdf version='1.9'><world name='w'><include><uri>model://lamp</uri></include></world></sdf>"
    scene, found = load(write("project/world/worlds/w.sdf", world))
    assert [m.name for m in scene.world.models] == ["box"], [str(d) for d in found]


def test_a_model_of_missing_includes_is_left_out_with_them(load, write):
    """The missing includes are reported, and not that the model around them has no link."""
    root = write("models/box/model.sdf", BOX).parents[1]
    course = "<model name='course'><include><uri>model://buoy</uri></include></model>"
    others = "<include><uri>model://box</uri></include>"
    scene, found = load(f"<sdf version='1.9'><world name='w'>{course}{others}</world></sdf>", (root,))
    assert [m.name for m in scene.world.models] == ["box"]
    assert [(d.code, d.severity) for d in found if d.severity != "note"] == [("SK-URI-001", "warning")]

    _, found = load(f"<sdf version='1.9'><world name='w'>{course}</world></sdf>", (root,))
    assert [d.code for d in found if d.severity == "error"] == ["SK-URI-001"]

    _, found = load(f"<sdf version='1.9'>{course}</sdf>", (root,))
    assert [d.code for d in found if d.severity == "error"] == ["SK-URI-001"]


def test_a_name_alone_is_the_model_of_that_name(load, write):
    write("project/models/platform/model.sdf", "<sdf version='1.9'><model name='p'><link name='l'/></model></sdf>")
    write("project/models/platform/model.config", "<model><sdf version='1.9'>model.sdf</sdf></model>")
    world = "<sdf version='1.9'><world name='w'><include><uri>platform</uri></include></world></sdf>"
    scene, found = load(write("project/worlds/w.sdf", world))
    assert [model.name for model in scene.world.models] == ["p"]
    assert not [d for d in found if d.code.startswith("SK-URI")]
