"""Reports on content without effect: unknown and misplaced names and invalid values, each with its line."""

from __future__ import annotations

import re

import pytest

FILE = """<sdf version="1.9">
<world name="w">
<physics type="ode">
<max_step_size>0.001</max_step_size>
<real_time_factor>1</real_time_factor>
</physics>
<gravity>0 0 -9.8</gravity>
<magnetic_field>0 0 0</magnetic_field>
<spherical_coordinates>
<surface_model>EARTH_WGS84</surface_model>
<latitude_deg>10</latitude_deg>
<elevation>1</elevation>
</spherical_coordinates>
<scene>
<shadows>true</shadows>
</scene>
<light name="sun" type="directional">
<pose>0 0 10 0 0 0</pose>
<direction>0 0 -1</direction>
<cast_shadows>true</cast_shadows>
</light>
<model name="m" canonical_link="a">
<static>false</static>
<pose degrees="true">0 0 1 0 0 90</pose>
<link name="a">
<pose>0 0 0 0 0 0</pose>
<inertial>
<mass>1</mass>
<inertia>
<ixx>0.1</ixx>
<iyy>0.1</iyy>
<izz>0.1</izz>
</inertia>
</inertial>
<gravity>true</gravity>
<velocity_decay>
<linear>0.1</linear>
</velocity_decay>
<collision name="c">
<geometry>
<box>
<size>1 1 1</size>
</box>
</geometry>
<surface>
<friction>
<ode>
<mu>1</mu>
<fdir1>1 0 0</fdir1>
</ode>
</friction>
<contact>
<collide_bitmask>0x01</collide_bitmask>
</contact>
</surface>
</collision>
</link>
<link name="b">
<inertial>
<mass>1</mass>
</inertial>
</link>
<joint name="j" type="revolute">
<parent>a</parent>
<child>b</child>
<axis>
<xyz expressed_in="__model__">0 0 1</xyz>
<limit>
<lower>-1</lower>
<upper>1</upper>
</limit>
<dynamics>
<damping>0.1</damping>
</dynamics>
</axis>
</joint>
</model>
</world>
</sdf>"""
LINES = FILE.split("\n")
LEAF = re.compile(r"<(\w+)([^>]*)>([^<]+)</\1>$")
LEAVES = [i for i, line in enumerate(LINES) if LEAF.match(line)]
WRONG = ("1,0 0", "abc", "nan", "1m", "1 2", "1 2 3 4 5", "1_000", "\u0661", "<value>1</value>")


def reported_messages(found, line: int) -> list[str]:
    return [d.message for d in found if d.severity != "note" and d.line == line]


def test_the_unchanged_file_has_no_warnings(load):
    _, found = load(FILE)
    assert not [d for d in found if d.severity != "note"]


@pytest.mark.parametrize("index", LEAVES, ids=lambda i: LINES[i])
def test_every_invalid_value_is_reported_at_its_line(load, index):
    name, attributes, _ = LEAF.match(LINES[index]).groups()
    for value in WRONG:
        changed = [*LINES]
        changed[index] = f"<{name}{attributes}>{value}</{name}>"
        _, found = load("\n".join(changed))
        assert reported_messages(found, index + 1), changed[index]


@pytest.mark.parametrize("index", LEAVES, ids=lambda i: LINES[i])
def test_misspelt_and_repeated_elements_and_unknown_attributes_are_reported_at_their_line(load, index):
    name, attributes, value = LEAF.match(LINES[index]).groups()
    for text in (
        f"<{name}x{attributes}>{value}</{name}x>",
        LINES[index] * 2,
        f'<{name}{attributes} colour="red">{value}</{name}>',
    ):
        changed = [*LINES]
        changed[index] = text
        _, found = load("\n".join(changed))
        assert reported_messages(found, index + 1), text


@pytest.mark.parametrize("name", ["parent", "child", "size", "max_step_size", "uri", "mass"])
def test_an_empty_text_is_reported(load, name):
    changed = [re.sub(rf"<{name}>[^<]*</{name}>", f"<{name}></{name}>", line) for line in LINES]
    if changed != LINES:
        _, found = load("\n".join(changed))
        lines = [i + 1 for i, line in enumerate(LINES) if line.startswith(f"<{name}>")]
        assert all(reported_messages(found, line) for line in lines)


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("<link name='l'><mass>2</mass></link>", "move it inside <inertial>"),
        ("<link name='l'><box><size>1 1 1</size></box></link>", ""),
        ("<link name='l'><visual name='v'><diffuse>1 0 0 1</diffuse><geometry/></visual></link>", "inside <material>"),
        ("<link name='l'/><physics/>", "move it inside <world>"),
        ("<link name='l'><joint name='j' type='fixed'/></link>", "move it inside <model>"),
        ("<link name='l'/><jiont name='j'/>", "did you mean 'joint'?"),
        ("<link name='l'><inertial mass='3'/></link>", "write it as an element: <mass>3</mass>"),
        (
            "<link name='l'><inertial><auto>true</auto></inertial></link>",
            "write it as an attribute: <inertial auto='true'>",
        ),
        ("<link name='l' nmae='x'/>", "did you mean 'name'?"),
        ("<link name='l'>0 0 1 0 0 0</link>", "put it into one of its elements: <pose>"),
    ],
)
def test_the_hint_shows_the_correct_place_or_name(load, text, hint):
    _, found = load(f'<sdf version="1.9"><world name="w"><model name="m">{text}</model></world></sdf>')
    warnings = [d for d in found if d.severity == "warning"]
    assert warnings and hint in warnings[0].hint


def test_a_reference_to_an_unknown_frame_is_reported_at_its_line(load):
    for old, new in (
        ('<xyz expressed_in="__model__">', '<xyz expressed_in="nowhere">'),
        ('<pose degrees="true">', '<pose relative_to="nowhere">'),
        ("<parent>a</parent>", "<parent>nowhere</parent>"),
    ):
        index = next(i for i, line in enumerate(LINES) if old in line)
        changed = [*LINES]
        changed[index] = changed[index].replace(old, new)
        _, found = load("\n".join(changed))
        assert any("nowhere" in message for message in reported_messages(found, index + 1)), new


def test_an_axis_of_a_fixed_joint_causes_only_a_note(load):
    _, found = load(
        '<sdf version="1.9"><model name="m"><link name="a"/><link name="b"/><joint name="j" type="fixed">'
        "<parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis></joint></model></sdf>"
    )
    assert {d.severity for d in found} == {"note"}
    assert any("<axis>" in d.message for d in found)


@pytest.mark.parametrize(
    "pose",
    [
        '<pose rotation_format="quat">0 0 0 0 0 0</pose>',
        '<pose rotation_format="quat_xyzw">0 0 0 0 0 0</pose>',
        '<pose rotation_format="quat_xyzw" degrees="true">0 0 0 0 0 0 1</pose>',
        '<pose degrees="yes">0 0 0 0 0 0</pose>',
    ],
)
def test_an_invalid_rotation_is_an_error(load, pose):
    _, found = load(f'<sdf version="1.9"><model name="m"><link name="l">{pose}</link></model></sdf>')
    assert [d.code for d in found if d.severity == "error"] == ["SK-PARAM-002"]
