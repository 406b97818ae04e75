"""`simkit check --score`, and `simkit check` of a folder: numbers, lines, pages, and files that go wrong."""

from __future__ import annotations

import json
import os
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app
from simkit.cli.diagnostic_catalogue import catalogue, effect_of
from simkit.cli.scores.folder_search import find_files
from simkit.packs import installed_packs

pytestmark = pytest.mark.leaves_out

ROBOT = """<sdf version="1.9"><world name="w">
  <model name="robot">
    <link name="base">
      <visual name="hull">
        <geometry><box><size>.3 .2 .1</size></box></geometry>
      </visual>
      <sensor name="imu" type="imu"/>
    </link>
    <link name="left"/>
    <link name="right"/>
    <joint name="lj" type="revolute"><parent>base</parent><child>left</child><axis><xyz>0 1 0</xyz></axis></joint>
    <joint name="rj" type="revolute"><parent>base</parent><child>right</child><axis><xyz>0 1 0</xyz></axis></joint>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>lj</left_joint><right_joint>rj</right_joint>
    </plugin>
    <plugin filename="gz-sim-joint-state-publisher-system" name="gz::sim::systems::JointStatePublisher"/>
  </model>
</world></sdf>
"""
MODEL = "<sdf version='1.9'><model name='m'><static>1</static><link name='l'/></model></sdf>"
XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["check", *map(str, arguments)], catch_exceptions=False)


def score_of(text: str, *options: str) -> dict:
    Path("robot.sdf").write_text(text)
    return json.loads(run("robot.sdf", "--score", "--json", *options).stdout)


def left_out(score: dict) -> list[tuple[str, int]]:
    return [(part["name"], part["line"]) for part in score["parts"] if part["state"] == "left out"]


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


# ------------------------------------------------------------------ one file


def test_a_file_of_which_everything_is_used_has_100() -> None:
    score = score_of(ROBOT)
    assert (score["score"], score["status"], score["parts"]) == (100, "runs", [])
    totals = {kind["kind"]: kind["used"] for kind in score["kinds"]}
    assert totals == {"drives": 1, "sensors": 1, "plugins": 1, "joints": 2, "models": 2, "shapes": 4}


def test_a_drive_that_is_left_out_costs_the_points_of_its_kind() -> None:
    score = score_of(ROBOT.replace("<left_joint>lj", "<left_joint>ljj"))
    assert left_out(score) == [("gz::sim::systems::DiffDrive", 13)]
    assert score["score"] == 83  # one of six kinds: 100 · 5/6
    assert score["parts"][0]["points"] == pytest.approx(100 / 6, abs=0.01)
    assert score["remedies"][0]["text"] == "did you mean 'lj'?"


def test_a_drive_is_as_visible_in_a_world_with_a_hundred_boxes() -> None:
    box = "<model name='b{}'><static>1</static><link name='l'/></model>"
    world = ROBOT.replace("</world>", "".join(box.format(i) for i in range(100)) + "</world>")
    assert score_of(world)["score"] == 100
    assert score_of(world.replace("<left_joint>lj", "<left_joint>ljj"))["score"] == 83


def test_missing_meshes_includes_plugins_and_sensors_are_left_out_with_their_lines() -> None:
    text = ROBOT.replace("<box><size>.3 .2 .1</size></box>", "<mesh><uri>model://robot/hull.dae</uri></mesh>")
    text = text.replace('type="imu"', 'type="telepathy"').replace("gz-sim-joint-state-publisher-system", "libfoo.so")
    text = text.replace("::JointStatePublisher", "::Foo")
    missing = "\n".join(f"  <include><uri>model://no_table_{i}</uri></include>" for i in range(2))
    ground = "  <include><uri>model://ground_plane</uri></include>"
    score = score_of(text.replace("</world>", f"{ground}\n{missing}\n</world>"))
    assert sorted(left_out(score)) == [
        ("gz::sim::systems::Foo", 16),
        ("model://no_table_0", 19),
        ("model://no_table_1", 20),
        ("robot::base::hull", 4),
        ("robot::base::imu", 7),
    ]


def test_an_approximated_part_counts_half() -> None:
    surface = "<surface><friction><ode><mu>1</mu><mu2>.1</mu2></ode></friction></surface>"
    collision = f"<collision name='c'>\n{surface}<geometry><sphere><radius>1</radius></sphere></geometry></collision>"
    score = score_of(ROBOT.replace('<link name="left"/>', f'<link name="left">\n{collision}</link>'))
    assert [(part["name"], part["state"]) for part in score["parts"]] == [("robot::left::c", "approximated")]
    assert score["parts"][0]["points"] == pytest.approx(100 / 6 / 5 / 2, abs=0.01)  # half of one of five shapes


def test_what_gazebo_adds_to_a_link_of_a_urdf_file_belongs_to_the_link() -> None:
    material = '<gazebo reference="base"><material>Gazebo/NoSuchColour</material></gazebo>'
    inertia = '<mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
    visual = "<visual><geometry><sphere radius='1'/></geometry></visual>"
    link = f'<link name="base"><inertial>{inertia}</inertial>{visual}</link>'
    Path("r.urdf").write_text(f'<robot name="r">{link}\n{material}</robot>')
    score = json.loads(run("r.urdf", "--score", "--json").stdout)
    assert [(part["element"], part["name"]) for part in score["parts"]] == [("link", "r::base")]


def test_a_mistake_with_which_gazebo_does_the_same_costs_nothing() -> None:
    assert score_of(ROBOT.replace("<world name='w'>", "<world name='w'><colour>red</colour>"))["score"] == 100


def test_parts_on_one_line_are_told_apart_by_the_message() -> None:
    text = "".join(ROBOT.replace('"gz-sim-joint-state-publisher-system"', '"libfoo.so"').split("\n"))
    assert left_out(score_of(text.replace("::JointStatePublisher", "::Foo"))) == [("gz::sim::systems::Foo", 1)]


def test_a_refused_file_has_0_and_exit_code_2() -> None:
    Path("bad.sdf").write_text(ROBOT.replace("revolute", "revolut"))
    result = run("bad.sdf", "--score")
    assert result.exit_code == 2
    assert result.stdout.startswith("bad.sdf: score 0 of 100, refused\nwhat would make it whole:\n")
    assert "bad.sdf:11:" in result.stdout


@pytest.mark.parametrize(("strict", "code"), [(False, 0), (True, 2)])
def test_a_warning_is_an_error_only_with_strict(strict: bool, code: int) -> None:
    Path("robot.sdf").write_text(ROBOT.replace("<left_joint>lj", "<left_joint>ljj"))
    assert run("robot.sdf", "--score", *(["--strict"] if strict else [])).exit_code == code


@pytest.mark.slow
def test_the_page_is_valid_xml_without_code_and_with_escaped_names() -> None:
    evil = "&lt;script&gt;alert(1)&lt;/script&gt;&quot;"
    text = ROBOT.replace('name="imu" type="imu"', f'name="{evil}" type="{evil}"')
    Path("robot.sdf").write_text(text)
    assert run("robot.sdf", "--html", "page.html").exit_code == 0
    page = Path("page.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;alert(1)" in page
    root = ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>").lstrip())
    images = [element.get("src", "") for element in root.iter("{http://www.w3.org/1999/xhtml}img")]
    assert len(images) == 1
    assert images[0].startswith("data:image/jpeg;base64,")
    assert "robot.sdf:7" in page
    assert run("robot.sdf", "--html", "page.html").exit_code == 2  # the file exists
    assert run("robot.sdf", "--html", "page.html", "--force").exit_code == 0


@pytest.mark.parametrize(
    "options",
    [
        ("--jobs", "2"),
        ("--limit", "5"),
        ("--score", "--all"),
        ("--score", "--fix-inertia"),
        ("--score", "--against", "yourdfpy"),
        ("--html", "page.html", "--against", "yourdfpy"),
        ("--fix-inertia", "--against", "yourdfpy"),
    ],
)
def test_options_that_do_not_fit_are_refused(options: tuple[str, ...]) -> None:
    Path("robot.sdf").write_text(ROBOT)
    result = run("robot.sdf", *options)
    assert result.exit_code == 2
    assert "SK-CLI-018" in result.output


# ------------------------------------------------------------------ codes


def test_the_effect_of_a_code_is_in_its_table() -> None:
    assert effect_of("SK-LOAD-014", "warning") == "left out"
    assert effect_of("SK-SDF-011", "warning") == "none"
    assert effect_of("SK-PHYS-005", "warning") == "approximated"
    assert effect_of("SK-PHYS-002", "note") == "none"
    assert effect_of("SK-MESH-004", "note") == "none"
    assert effect_of("SK-NOWHERE-001", "warning") == "none"


def test_only_codes_with_warnings_or_notes_have_an_effect() -> None:
    codes = catalogue().values()
    assert not [code.code for code in codes if code.effect and not {"warning", "note"} & {*code.severity.split(", ")}]


def test_explain_says_how_a_code_counts() -> None:
    result = CliRunner().invoke(app, ["explain", "SK-PLUGIN-002"])
    assert "score: left out" in result.stdout


# ------------------------------------------------------------------ a folder


def write(files: dict[str, str]) -> None:
    for name, text in files.items():
        path = Path("repository", name)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


@pytest.mark.slow
def test_a_folder_is_a_table_with_a_summary() -> None:
    write(
        {
            "worlds/robot.sdf": ROBOT,
            "worlds/worse.sdf": ROBOT.replace("<left_joint>lj", "<left_joint>ljj"),
            "urdf/arm.urdf.xacro": f'<robot name="arm" {XACRO}><link name="$(arg prefix)base"/></robot>',
            "urdf/macros.xacro": f'<robot {XACRO}><xacro:macro name="m"><link name="a"/></xacro:macro></robot>',
            "build/copy.sdf": MODEL,
            ".hidden/copy.sdf": MODEL,
            "package.xml": "<package><name>r</name></package>",
            "world.sdf.erb": "<sdf/>",
        }
    )
    result = run("repository", "--jobs", "1")
    assert result.exit_code == 2
    rows = [line.split(maxsplit=2) for line in result.stdout.splitlines()[1:4]]
    assert [row[:2] for row in rows] == [
        ["0", "urdf/arm.urdf.xacro"],
        ["100", "worlds/robot.sdf"],
        ["83", "worlds/worse.sdf"],
    ]
    assert "the argument 'prefix' has no value" in rows[0][2]
    assert rows[2][2] == "left out: drive plugin DiffDrive"
    assert "2 of 3 run as they are, 1 of them with score 100; 1 more is a part of others" in result.stdout
    assert "not checked: 1 template" in result.stdout
    assert result.stdout.splitlines()[-1] == "try first: simkit run repository/worlds/robot.sdf"
    with_argument = run("repository", "--jobs", "1", "--xacro-arg", "prefix=left_")
    assert with_argument.exit_code == 0
    assert "3 of 3 run as they are" in with_argument.stdout


@pytest.mark.slow
def test_the_table_of_a_folder_is_json_and_a_page_and_does_not_depend_on_the_number_of_jobs() -> None:
    write({f"m{i}/{name}.sdf": MODEL for i in range(3) for name in "ab"})
    one = json.loads(run("repository", "--json", "--jobs", "1").stdout)
    two = json.loads(run("repository", "--json", "--jobs", "2", "--html", "page.html").stdout)
    for score in two["files"]:
        score["picture_note"] = ""
    assert one == two
    assert (one["runs"], one["of"]) == (6, 6)
    assert [score["file"] for score in one["files"]] == sorted(score["file"] for score in one["files"])
    page = Path("page.html").read_text(encoding="utf-8")
    root = ElementTree.fromstring(page.removeprefix("<!DOCTYPE html>").lstrip())
    assert len(list(root.iter("{http://www.w3.org/1999/xhtml}section"))) == 6


@pytest.mark.slow
def test_a_file_that_takes_too_long_does_not_end_the_walk() -> None:
    """A world of 3000 different boxes takes seconds to check; the limit of 1 ms is for the second file of a process."""
    box = (
        "<model name='b{0}'><pose>{0} 0 0 0 0 0</pose><link name='l'><collision name='c'>{1}</collision></link></model>"
    )
    shape = "<geometry><box><size>.5 .5 .5</size></box></geometry>"
    boxes = "".join(box.format(i, shape) for i in range(3000))
    write({"a.sdf": MODEL, "b.sdf": f"<sdf version='1.9'><world name='w'>{boxes}</world></sdf>", "c.sdf": MODEL})
    table = json.loads(run("repository", "--json", "--jobs", "1", "--limit", "1ms").stdout)
    assert [score["status"] for score in table["files"]] == ["runs", "refused", "runs"]
    assert table["files"][1]["missing"] == ["SK-CLI-061: the check was stopped after 0.001 s"]


def test_a_refused_file_that_another_one_includes_is_a_part() -> None:
    write(
        {
            "robot.urdf.xacro": f'<robot name="r" {XACRO}><xacro:property name="n" value="base"/>'
            '<xacro:include filename="base.xacro"/></robot>',
            "base.xacro": f'<robot name="b" {XACRO}><link name="${{n}}"/></robot>',
        }
    )
    result = run("repository", "--jobs", "1", "--all")
    assert result.exit_code == 0
    assert " part  base.xacro" in result.stdout
    assert "1 of 1 run as they are" in result.stdout


def test_a_folder_that_is_a_model_is_checked_as_a_model() -> None:
    write({"model.sdf": MODEL, "other.sdf": MODEL})
    assert run("repository").stdout.splitlines()[-1] == "0 errors, 0 warnings, 0 notes"


def test_a_folder_of_worlds_with_one_other_xml_file_is_not_a_model() -> None:
    write({"plugins.xml": "<library path='x'/>", "a.sdf": MODEL})
    assert "1 of 1 run as they are" in run("repository").stdout


def test_a_folder_of_mjcf_is_checked_as_a_model() -> None:
    write({"robot.xml": "<mujoco><worldbody><geom size='1'/></worldbody></mujoco>"})
    assert run("repository").stdout.splitlines()[-1] == "0 errors, 0 warnings, 0 notes"


@pytest.mark.slow
def test_files_named_sdf_and_urdf_without_xml_are_in_the_table_and_a_name_stays_in_its_line() -> None:
    write({"a\nb.sdf": MODEL, "empty.urdf": "", "stage.world": "resolution 0.02"})
    lines = run("repository").stdout.splitlines()
    assert [line.split()[:2] for line in lines[1:3]] == [["100", "a\\nb.sdf"], ["0", "empty.urdf"]]
    assert "stage.world" not in "".join(lines)


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() == 0, reason="this user may read every folder")
def test_folders_that_cannot_be_read_are_told() -> None:
    write({"a.sdf": MODEL, "closed/b.sdf": MODEL})
    Path("repository/closed").chmod(0)
    try:
        assert "not searched: closed, because this user may not read it" in run("repository").stdout
    finally:
        Path("repository/closed").chmod(0o700)


def test_a_folder_without_files_is_an_error() -> None:
    write({"readme.txt": "nothing"})
    result = run("repository")
    assert result.exit_code == 2
    assert "SK-CLI-062" in result.output


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_links_pipes_and_hostile_names_are_harmless() -> None:
    Path("secret.sdf").write_text(MODEL)
    write({"a.sdf": MODEL, "<b>\x1b[31m.sdf": MODEL, "c/c.sdf": MODEL})
    Path("repository/link.sdf").symlink_to(Path("secret.sdf").resolve())
    Path("repository/loop").symlink_to(Path("repository").resolve())
    os.mkfifo("repository/pipe.sdf")
    assert find_files(Path("repository")).files == ["<b>\x1b[31m.sdf", "a.sdf", "c/c.sdf"]
    result = run("repository", "--jobs", "1", "--html", "page.html")
    assert "\x1b" not in result.stdout
    assert "3 of 3 run as they are" in result.stdout  # a name with < is not XML text
    page = Path("page.html").read_text(encoding="utf-8")
    assert "<b><b>" not in page
    assert "<b>&lt;b&gt;" in page


@pytest.mark.needs_packs
def test_a_pack_names_files_that_are_listed_and_not_executed() -> None:
    assert any(pack.name == "launch" for pack in installed_packs())
    write({"a.sdf": MODEL, "launch/start.launch.py": "open('executed', 'w')\n"})
    result = run("repository", "--jobs", "1")
    assert "not checked: 1 launch file: " in result.stdout
    assert "simkit launch repository/launch/start.launch.py" in result.stdout
    assert not Path("executed").exists()
