"""Joint and link settings of the format, with their defaults."""

from __future__ import annotations

import math

import pytest


def model(content: str, version: str = "1.11") -> str:
    links = '<link name="a"/><link name="b"/><link name="c"/>'
    return f'<sdf version="{version}"><model name="m">{links}{content}</model></sdf>'


def joint(content: str, kind: str = "revolute", version: str = "1.11") -> str:
    return model(f'<joint name="j" type="{kind}"><parent>a</parent><child>b</child>{content}</joint>', version)


def test_a_limit_has_the_stiffness_that_the_file_gives(load):
    limit = "<limit><lower>-1</lower><upper>1</upper><stiffness>5</stiffness><dissipation>2</dissipation></limit>"
    axis = load(joint(f"<axis>{limit}</axis>"))[0].model.joints[0].axes[0]
    assert (axis.limit_stiffness, axis.limit_dissipation) == (5, 2)
    axis = load(joint("<axis/>"))[0].model.joints[0].axes[0]
    assert (axis.limit_stiffness, axis.limit_dissipation, axis.lower, axis.effort) == (None, None, -math.inf, math.inf)


@pytest.mark.parametrize(
    ("text", "pitch"),
    [
        ("", 1.0),
        ("<screw_thread_pitch>0.5</screw_thread_pitch>", 0.5),
        ("<thread_pitch>4</thread_pitch>", -math.pi / 2),
        ("<thread_pitch>4</thread_pitch><screw_thread_pitch>-0.5</screw_thread_pitch>", -0.5),
    ],
)
def test_a_screw_has_metres_per_turn(load, text, pitch):
    scene, _ = load(joint(f"<axis/>{text}", "screw"))
    assert scene.model.joints[0].thread_pitch == pytest.approx(pitch)


def test_a_thread_pitch_of_zero_is_an_error(load):
    _, found = load(joint("<axis/><thread_pitch>0</thread_pitch>", "screw"))
    assert [d.code for d in found if d.severity == "error"] == ["SK-PARAM-002"]


def test_a_mimic_may_name_a_joint_of_a_nested_model_and_its_second_axis(load):
    scene, found = load(
        model("""<model name="n"><link name="x"/><link name="y"/><joint name="lead" type="universal">
          <parent>x</parent><child>y</child><axis/><axis2><xyz>1 0 0</xyz></axis2></joint></model>
          <joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><mimic joint="n::lead" axis="axis2">
          <multiplier>2</multiplier><offset>3</offset><reference>4</reference></mimic></axis></joint>""")
    )
    assert not [d for d in found if d.severity == "error"]
    mimic = scene.model.joints[0].axes[0].mimic
    assert (mimic.joint, mimic.axis, mimic.multiplier, mimic.offset, mimic.reference) == ("m::n::lead", 1, 2, 3, 4)


@pytest.mark.parametrize(("version", "xyz"), [("1.4", (1, 0, 0)), ("1.5", (0, -1, 0)), ("1.7", (0, -1, 0))])
def test_before_sdf_1_5_an_axis_is_given_in_the_model_frame(load, version, xyz):
    scene, _ = load(
        f'<sdf version="{version}"><model name="m"><link name="a"/><link name="b"><pose>0 0 0 0 0 -1.5707963267948966'
        '</pose></link><joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis>'
        "</joint></model></sdf>"
    )
    assert scene.model.joints[0].axes[0].xyz_world == pytest.approx(xyz, abs=1e-12)


def test_before_sdf_1_7_a_switch_selects_the_frame_of_the_axis(load):
    text = (
        '<sdf version="1.6"><model name="m"><link name="a"/><link name="b"><pose>0 0 0 0 0 -1.5707963267948966'
        '</pose></link><joint name="j" type="revolute"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz>'
        "<use_parent_model_frame>{}</use_parent_model_frame></axis></joint></model></sdf>"
    )
    assert load(text.format(1))[0].model.joints[0].axes[0].xyz_world == pytest.approx((1, 0, 0), abs=1e-12)
    assert load(text.format(0))[0].model.joints[0].axes[0].xyz_world == pytest.approx((0, -1, 0), abs=1e-12)


def test_wind_of_a_model_acts_on_links_without_their_own_setting(load):
    scene, _ = load(
        '<sdf version="1.9"><model name="m"><enable_wind>1</enable_wind><allow_auto_disable>0</allow_auto_disable>'
        '<link name="a"/><link name="b"><enable_wind>0</enable_wind><velocity_decay><linear>0.1</linear>'
        "<angular>0.2</angular></velocity_decay><kinematic>1</kinematic><gravity>0</gravity></link></model></sdf>"
    )
    a, b = scene.model.links
    assert (a.enable_wind, b.enable_wind, scene.model.allow_auto_disable) == (True, False, False)
    assert (a.velocity_decay, b.velocity_decay) == ((0, 0), (0.1, 0.2))
    assert (a.gravity, a.kinematic, b.gravity, b.kinematic) == (True, False, False, True)


def surface(load, text: str):
    scene, _ = load(
        '<sdf version="1.9"><model name="m"><link name="l"><collision name="c"><geometry><box/></geometry>'
        f"{text}</collision></link></model></sdf>"
    )
    return scene.model.links[0].collisions[0].surface


def test_a_surface_has_the_defaults_of_the_format(load):
    for s in (surface(load, ""), surface(load, "<surface><friction><ode/><torsional/></friction></surface>")):
        assert (s.mu, s.mu2, s.torsional, s.rolling, s.kp, s.restitution) == (1, 1, None, None, None, 0)
        assert (s.patch_radius, s.surface_radius, s.use_patch_radius, s.collide_bitmask) == (0, 0, True, 0xFFFF)


def test_a_patch_without_a_coefficient_has_the_coefficient_of_the_format(load):
    s = surface(load, "<surface><friction><torsional><patch_radius>0.1</patch_radius></torsional></friction></surface>")
    assert (s.torsional, s.patch_radius) == (1, 0.1)


def test_torsion_and_rolling_are_read(load):
    s = surface(
        load,
        "<surface><friction><torsional><coefficient>0.5</coefficient><use_patch_radius>0</use_patch_radius>"
        "<patch_radius>0.1</patch_radius><surface_radius>0.2</surface_radius><ode><slip>3</slip></ode></torsional>"
        "<bullet><friction>0.7</friction><friction2>0.6</friction2><rolling_friction>0.01</rolling_friction></bullet>"
        "</friction><contact><collide_bitmask>0x03</collide_bitmask><category_bitmask>4</category_bitmask></contact>"
        "</surface>",
    )
    assert (s.torsional, s.use_patch_radius, s.patch_radius, s.surface_radius) == (0.5, False, 0.1, 0.2)
    assert (s.torsional_slip, s.rolling, s.mu, s.mu2) == (3, 0.01, 0.7, 0.6)
    assert (s.collide_bitmask, s.category_bitmask) == (3, 4)
