"""Comparison of simkit's reading of a URDF file with that of yourdfpy: equal files, and each kind of difference."""

from __future__ import annotations

import math
from importlib import metadata
from itertools import pairwise
from pathlib import Path

import pytest

from simkit.build import read_scene
from simkit.cli.second_reader.reading_differences import reading_differences
from simkit.cli.second_reader.robot_reading import Part, RobotReading, place_of, random_positions, scene_reading
from simkit.scene import SceneModel

pytest.importorskip("yourdfpy")
from simkit.cli.second_reader.yourdfpy_reader import SecondReaderError, yourdfpy_reading

MASS = '<inertial><origin xyz="0.1 0 0" rpy="0 0 0.3"/><mass value="2"/><inertia ixx="1" iyy="2" izz="2.5"/></inertial>'
LIMIT = '<limit lower="-1" upper="2" effort="3" velocity="4"/>'


def joint(name: str, kind: str, parent: str, child: str, content: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><origin xyz="0.1 0.2 0.3" rpy="0.1 0.2 0.3"/>\n'
        f'<parent link="{parent}"/><child link="{child}"/>{content}</joint>\n'
    )


ROBOT = (
    '<?xml version="1.0"?>\n<robot name="r">\n'
    + "".join(f'<link name="{name}">{MASS}</link>\n' for name in "abcdefgh")
    + '<link name="i"><visual><geometry><mesh filename="a.stl" scale="2 2 -2"/></geometry></visual>'
    + '<collision><geometry><cylinder radius="0.1" length="0.2"/></geometry></collision></link>\n'
    + joint("turn", "revolute", "a", "b", f'<axis xyz="1 1 0"/>\n{LIMIT}<dynamics damping="0.5" friction="0.25"/>')
    + joint("slide", "prismatic", "b", "c", f'<axis xyz="0 0 3"/>{LIMIT}')
    + joint("roll", "continuous", "c", "d", '<axis xyz="0 1 0"/>')
    + joint("follow", "revolute", "d", "e", f'{LIMIT}<mimic joint="turn" multiplier="-2" offset="0.5"/>')
    + joint("follow_that", "prismatic", "e", "f", f'{LIMIT}<mimic joint="follow" multiplier="0.5"/>')
    + joint("float", "floating", "f", "g")
    + joint("plane", "planar", "g", "h", '<axis xyz="0 0 1"/>')
    + joint("weld", "fixed", "h", "i")
    + "</robot>"
)


def model_of(text: str) -> SceneModel:
    scene, _ = read_scene(text, missing_meshes=True)
    assert scene.model is not None
    return scene.model


def differences(ours: str, theirs: str) -> list[tuple[str, str, str, str]]:
    """Differences when simkit reads the first text and yourdfpy the second one."""
    found = reading_differences(scene_reading(model_of(ours)), yourdfpy_reading(theirs.encode()))
    return [(str(d.part), d.quantity.partition(" with")[0], d.found, d.expected) for d in found]


def test_a_robot_with_each_type_of_joint_is_read_equally() -> None:
    assert differences(ROBOT, ROBOT) == []


def test_frames_are_compared_at_zero_and_at_random_positions_within_the_limits() -> None:
    reading = scene_reading(model_of(ROBOT))
    every = list(random_positions(reading))
    assert every[0] == {"turn": 0.0, "slide": 0.0, "roll": 0.0}
    assert len({tuple(positions.values()) for positions in every}) == len(every) == 9
    assert all(-1 <= p["turn"] <= 2 and -1 <= p["slide"] <= 2 and abs(p["roll"]) <= math.pi for p in every)
    assert every == list(random_positions(reading))


def test_the_mimicking_joints_move_their_links() -> None:
    """The frame of link `e` turns about the default axis x by -2 · 0.25 + 0.5 = 0, and at zero by 0.5 rad."""
    for reading in (scene_reading(model_of(ROBOT)), yourdfpy_reading(ROBOT.encode())):
        still, moved = (reading.frames({"turn": turn, "slide": 0.0, "roll": 0.0}) for turn in (0.0, 0.25))
        assert len(still) == 9
        assert still["e"] != pytest.approx(moved["e"], abs=0.1)


@pytest.mark.parametrize(
    ("old", "new", "part", "quantity", "found", "expected"),
    [
        ('upper="2" effort="3"', 'upper="1.5" effort="3"', "joint 'turn'", "upper limit", "2", "1.5"),
        ('effort="3"', 'effort="5"', "joint 'turn'", "effort limit", "3", "5"),
        ('damping="0.5"', 'damping="0.75"', "joint 'turn'", "damping", "0.5", "0.75"),
        ('<axis xyz="0 1 0"/>', '<axis xyz="0 -1 0"/>', "joint 'roll'", "axis", "0 1 0", "0 -1 0"),
        ('multiplier="-2"', 'multiplier="2"', "joint 'follow'", "mimic", "-2 · turn + 0.5", "2 · turn + 0.5"),
        ('type="fixed"', 'type="floating"', "joint 'weld'", "type", "fixed", "floating"),
        ('scale="2 2 -2"', 'scale="2 2 2"', "visual 1 of link 'i'", "scale", "2 2 -2", "2 2 2"),
        ('radius="0.1"', 'radius="0.2"', "collision 1 of link 'i'", "size", "0.1 0.2", "0.2 0.2"),
        ('<mass value="2"/>', '<mass value="3"/>', "link 'a'", "mass", "2", "3"),
        ('xyz="0.1 0 0" rpy', 'xyz="0.1 0 1" rpy', "link 'a'", "centre of mass", "0.1 0 0", "0.1 0 1"),
    ],
)
def test_a_different_value_is_the_first_difference(old, new, part, quantity, found, expected) -> None:
    first, *_ = differences(ROBOT, ROBOT.replace(old, new, 1))
    assert first == (part, quantity, found, expected)


def test_a_small_inertia_is_compared_as_well() -> None:
    small = ROBOT.replace('ixx="1"', 'ixx="1e-9"', 1).replace('iyy="2" izz="2.5"', 'iyy="1e-9" izz="1e-9"', 1)
    changed = small.replace('ixx="1e-9"', 'ixx="2e-9"')
    assert [d[:2] for d in differences(small, changed)] == [("link 'a'", "inertia")]


def test_only_the_first_of_the_links_with_a_different_frame_is_reported() -> None:
    ours, theirs = scene_reading(model_of(ROBOT)), yourdfpy_reading(ROBOT.encode())

    def shifted(positions):
        frames = theirs.frames(positions)
        return {k: (v[0] + (k in "defghi" and positions["turn"] != 0), *v[1:]) for k, v in frames.items()}

    (found,) = reading_differences(ours, RobotReading(theirs.root, theirs.parts, shifted))
    assert found.part == Part("link", "d")
    assert found.quantity.startswith("frame with roll at ")


def test_a_link_that_one_reader_lacks_is_a_difference() -> None:
    text = ROBOT.replace("</robot>", f'<link name="z">{MASS}</link>{joint("last", "fixed", "i", "z")}</robot>')
    found = differences(ROBOT, text)
    assert [d[:2] for d in found] == [("link 'z'", "existence"), ("joint 'last'", "existence")]


def test_a_difference_has_the_line_of_the_element_with_the_value(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_text(ROBOT)
    scene, _ = read_scene(file, missing_meshes=True)
    assert scene.model is not None
    lines = ROBOT.splitlines()
    places = {
        place: lines[place_of(scene.model, part, place).line - 1]
        for part, place in ((Part("joint", "turn"), "upper limit"), (Part("joint", "turn"), "axis"))
    }
    assert LIMIT in places["upper limit"]
    assert '<axis xyz="1 1 0"/>' in places["axis"]
    assert place_of(scene.model, Part("link", "nobody"), "mass").line == 2


@pytest.mark.parametrize("text", ["", "<robot>", '<robot name="r"><link/></robot>', '<robot name="r"></robot>'])
def test_a_file_that_the_second_reader_cannot_read_raises_one_error(text: str) -> None:
    with pytest.raises(SecondReaderError):
        yourdfpy_reading(text.encode())


def robots() -> list[Path]:
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return []
    return sorted(Path(str(f.locate())) for f in files if str(f).endswith(".urdf"))


@pytest.mark.skipif(not robots(), reason="example-robot-data is not installed")
@pytest.mark.parametrize("every", [6, pytest.param(1, marks=pytest.mark.slow)])
def test_published_robots_are_read_equally(every: int) -> None:
    """Only values that simkit cannot simulate differ; each has a diagnostic in its line."""
    compared = 0
    for file in robots()[::every]:
        if file.name == "ur3.urdf":  # a robot without a link
            continue
        scene, diagnostics = read_scene(file, missing_meshes=True)
        assert scene.model is not None
        explained = {d.line for d in diagnostics}
        found = reading_differences(scene_reading(scene.model), yourdfpy_reading(file.read_bytes()))
        places = [place_of(scene.model, d.part, d.quantity) for d in found]
        assert [str(d) for d, place in zip(found, places, strict=True) if place.line not in explained] == []
        compared += 1
    assert compared > 50 / every


def test_a_chain_of_300_links_is_compared_in_seconds() -> None:
    names = [f"l{number}" for number in range(300)]
    links = "".join(f'<link name="{name}">{MASS}</link>' for name in names)
    joints = "".join(
        joint(f"j{child}", "revolute", parent, child, f'<axis xyz="0 0 1"/>{LIMIT}')
        for parent, child in pairwise(names)
    )
    text = f'<robot name="r">{links}{joints}</robot>'
    assert differences(text, text) == []
