"""`simkit check`: everything in one pass, readable, and with new numbers for inertias."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

import simkit
from simkit.cli import app
from simkit.diagnostics import Diagnostic, follows_from

TWO_FAULTS = """<sdf version="1.9"><world name="w">
  <light name="lamp" type="spto"/>
  <model name="robot">
    <link name="base"/>
    <link name="left"/>
    <joint name="lj" type="revolute"><parent>base</parent><child>left</child><axis/></joint>
    <joint name="rj" type="revolut"><parent>base</parent><child>left</child><axis/></joint>
    <plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
      <left_joint>ljj</left_joint><right_joint>rj</right_joint>
    </plugin>
    <plugin filename="libsolar_sensor.so" name="solar"><frame_name>sun</frame_name></plugin>
  </model>
</world></sdf>
"""
URDF = """<?xml version="1.0"?>
<robot name="arm">  <!-- kept -->
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin rpy="0 0 0.3"/>
      <mass value="0.5"/>
      <inertia ixx="0.001" iyy='0.002' izz="0.0033" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <link name="sound">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="j" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/></joint>
  <joint name="k" type="fixed"><parent link="upper"/><child link="sound"/></joint>
</robot>
"""


def run(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["check", *map(str, arguments)], catch_exceptions=False)


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_diagnostics_of_plugins_are_printed_with_the_errors_of_the_file(here: Path) -> None:
    """A joint that a plugin misses, and a link that another one misses, beside two faults of the file."""
    found = [d for d in simkit.check(TWO_FAULTS) if d.severity == "error"]
    said = sorted(f"{d.code} {d.line}" for d in found)
    assert said == ["SK-PLUGIN-003 11", "SK-PLUGIN-003 8", "SK-SDF-008 7", "SK-SDF-025 2"]


def test_a_consequence_of_an_error_is_not_reported_again(here: Path) -> None:
    messages = [d.message for d in simkit.check(TWO_FAULTS) if d.code == "SK-PLUGIN-003"]
    assert not [m for m in messages if "no joint 'rj'" in m]
    earlier = [Diagnostic("SK-SDF-008", "error", "joint 'rj' has unknown type 'revolut'; known are revolute")]
    assert follows_from(Diagnostic("SK-PLUGIN-003", "error", "model 'm' has no joint 'rj'; it has: 'lj'"), earlier)
    assert not follows_from(Diagnostic("SK-PLUGIN-003", "error", "model 'm' has no joint 'lj'; it has: 'rj'"), earlier)


def test_load_raises_with_the_same_errors(here: Path) -> None:
    with pytest.raises(simkit.LoadError) as raised:
        simkit.load(TWO_FAULTS)
    assert len([d for d in raised.value.diagnostics if d.severity == "error"]) == 4


@pytest.mark.parametrize(("strict", "code"), [(False, 0), (True, 2)])
def test_warnings_are_errors_only_with_strict(here: Path, strict: bool, code: int) -> None:
    (here / "w.sdf").write_text("<sdf version='1.9'><world name='w'><colour>red</colour></world></sdf>")
    result = run("w.sdf", *(["--strict"] if strict else []))
    assert result.exit_code == code
    assert "w.sdf:1: warning SK-SDF-011" in result.stdout
    assert result.stdout.splitlines()[-1] == "0 errors, 1 warning, 0 notes"


def test_many_equal_notes_are_one_entry_and_all_in_json(here: Path) -> None:
    surface = "<surface><friction><ode><mu>5000</mu><mu2>5000</mu2></ode></friction></surface>"
    box = "<geometry><box><size>1 1 1</size></box></geometry>"
    models = "\n".join(
        f"<model name='m{i}'><static>1</static>"
        f"<link name='l'><collision name='c'>{box}{surface}</collision></link></model>"
        for i in range(300)
    )
    (here / "w.sdf").write_text(f"<sdf version='1.9'><world name='w'>\n{models}\n</world></sdf>")
    text = run("w.sdf").stdout
    assert text.count("SK-PHYS-002") == 1
    assert "also at :3, :4, " in text
    assert "and 291 more" in text
    assert text.splitlines()[-1] == "0 errors, 0 warnings, 300 notes"
    assert len(text.splitlines()) < 8
    assert run("w.sdf", "--all").stdout.count("SK-PHYS-002") == 300
    assert len(json.loads(run("w.sdf", "--json").stdout)) == 300


def test_new_numbers_are_shown_and_written_and_nothing_else_is_changed(here: Path) -> None:
    (here / "arm.urdf").write_text(URDF)
    result = run("arm.urdf", "--fix-inertia", "-o", "new.urdf")
    assert result.exit_code == 0
    assert "arm.urdf:8: link 'upper' (0.5 kg): ixx 0.001 -> 0.0011" in result.stdout
    assert "falls short of C by 9.09 % of C" in result.stdout
    assert "new.urdf: 1 link changed" in result.stdout
    old, new = URDF.splitlines(), (here / "new.urdf").read_text().splitlines()
    assert [i for i, (a, b) in enumerate(zip(old, new, strict=True), 1) if a != b] == [8]
    assert (here / "arm.urdf").read_text() == URDF
    assert "0 impossible inertias" in run("new.urdf", "--fix-inertia").stdout
    assert not [d for d in simkit.check("new.urdf") if d.code.startswith("SK-INERTIA")]


def inertial(mass: float, *moments: object) -> str:
    numbers = " ".join(f'{k}="{v}"' for k, v in zip(("ixx", "iyy", "izz", "ixy"), moments, strict=False))
    return f'<inertial><mass value="{mass}"/><inertia {numbers}/></inertial>'


BROKEN = {  # of a link of 0.1 × 0.1 × 0.2 m: the report of its line, and its help
    "zero": (inertial(1, 0, 0, 0), "SK-PHYS-011", "(0, 0, 0) kg m2: each must be positive", "--fix-inertia"),
    "tiny": (inertial(1, 1e-18, 1e-18, 1e-18), "SK-PHYS-011", "must be larger than 1e-14; (0.001667, 0.00", "--fix"),
    "negative": (inertial(1, -1, 1, 1), "SK-INERTIA-002", "(-1, 1, 1) kg m2: each must be positive", "--fix-inertia"),
    "products": (inertial(1, 1, 1, 1, 2), "SK-INERTIA-002", "(-1, 1, 3) kg m2: each must be positive", "--fix"),
    "triangle": (inertial(1, 0.01, 0.01, 0.05), "SK-INERTIA-001", "A + B falls short of C by 60 % of C", "--fix"),
    "units": (inertial(1, 1e4, 1e4, 1e4), "SK-LINT-008", "666667 times too large", "check the units"),
    "density": (inertial(5000, 10, 10, 10), "SK-LINT-009", "are 2.5e+06 kg/m3", "check the units"),
    "no mass": (inertial(0, 0.01, 0.01, 0.01), "SK-PHYS-011", "0 kg is too light to move", "give the link"),
    "no number": (inertial(1, "nan", 1, 1), "SK-URDF-013", '<inertia ixx="nan">: expected a number', ""),
    "nothing": ("", "SK-JOINT-016", "joint r::j (revolute) of link r::arm moves no mass", "an <inertial>"),
}


@pytest.mark.parametrize("case", BROKEN)
def test_a_broken_inertia_is_reported_with_line_numbers_and_help(case: str, here: Path) -> None:
    text, code, words, remedy = BROKEN[case]
    (here / "r.urdf").write_text(f"""<robot name="r">
<link name="base">{inertial(5, 0.1, 0.1, 0.1)}</link>
<link name="arm">{text}<collision><geometry><box size="0.1 0.1 0.2"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="9" velocity="1"/></joint></robot>""")
    report = next(d for d in simkit.check("r.urdf") if d.severity != "note")
    assert (report.code, report.line) == (code, 4 if case == "nothing" else 3)
    assert words in report.message and remedy in report.hint, report


@pytest.mark.parametrize("number", ["nan", "inf", "abc"])
def test_an_inertia_that_is_not_a_number_cannot_be_corrected(number: str, here: Path) -> None:
    (here / "arm.urdf").write_text(URDF.replace("0.001", number))
    result = run("arm.urdf", "--fix-inertia")
    assert result.exit_code == 2
    assert f'arm.urdf:8: error SK-URDF-013: <inertia ixx="{number}">: expected a number' in result.stderr


def test_a_nan_of_a_static_model_leaves_the_other_inertias_to_be_corrected(here: Path) -> None:
    model = (
        "<model name='{0}'><static>{1}</static><link name='a'><inertial><mass>1</mass>"
        "<inertia><ixx>{2}</ixx><iyy>1</iyy><izz>9</izz></inertia></inertial></link></model>"
    )
    models = model.format("wall", "true", "nan") + model.format("m", "false", "1")
    (here / "m.sdf").write_text(f"<sdf version='1.9'><world name='w'>{models}</world></sdf>")
    assert "1 impossible inertia\n" in run("m.sdf", "--fix-inertia").stdout


def test_a_negative_mass_is_one_error_without_a_warning_about_a_light_link(here: Path) -> None:
    link = "<link name='a'><inertial><mass>-1</mass></inertial></link>"
    (here / "m.sdf").write_text(f"<sdf version='1.9'><world name='w'><model name='m'>{link}</model></world></sdf>")
    assert [d.code for d in simkit.check("m.sdf") if d.severity != "note"] == ["SK-SDF-013"]


def test_missing_inertia_values_of_sdf_are_inserted(here: Path) -> None:
    text = (
        "<sdf version='1.9'><model name='m'><link name='a'><inertial><mass>2</mass>"
        "<inertia><ixx>0</ixx><iyy>0</iyy><izz>0.5</izz></inertia></inertial></link></model></sdf>"
    )
    (here / "m.sdf").write_text(text)
    run("m.sdf", "--fix-inertia", "-o", "n.sdf")
    link = simkit.describe(here / "n.sdf")["model"]["links"][0]
    assert link["inertia_com_linkframe"] == pytest.approx([0.25, 0.25, 0.5, 0, 0, 0], rel=1e-5)
    tilted = text.replace("<ixx>0</ixx>", "<ixx>0.5</ixx>").replace("<izz>0.5</izz>", "<izz>0.5</izz><ixy>0.4</ixy>")
    (here / "m.sdf").write_text(tilted)
    run("m.sdf", "--fix-inertia", "-o", "n.sdf", "--force")
    assert "<iyy>0<" not in (here / "n.sdf").read_text()


@pytest.mark.parametrize("pose", ["", "<pose>0 0 0 0 0 1</pose>"])
def test_zero_moments_become_those_of_the_collisions(here: Path, pose: str) -> None:
    """Numbers in rotated axes are the mean, because all axes have it."""
    (here / "m.sdf").write_text(
        f"<sdf version='1.9'><model name='m'><link name='a'><inertial><mass>6</mass>{pose}"
        "<inertia><ixx>0</ixx><iyy>0</iyy><izz>0</izz></inertia></inertial>"
        "<collision name='c'><geometry><box><size>0.75 0.55 0.35</size></box></geometry></collision>"
        "</link></model></sdf>"
    )
    assert "1 impossible inertia\n" in run("m.sdf", "--fix-inertia", "-o", "n.sdf").stdout
    link = simkit.describe(here / "n.sdf")["model"]["links"][0]
    x, y, z = (0.5 * side**2 for side in (0.75, 0.55, 0.35))
    expected = (y + z, x + z, x + y) if not pose else (2 * (x + y + z) / 3,) * 3
    assert link["inertia_com_linkframe"] == pytest.approx([*expected, 0, 0, 0], rel=1e-5)


def test_a_file_that_is_there_is_replaced_only_by_force(here: Path) -> None:
    (here / "arm.urdf").write_text(URDF)
    assert run("arm.urdf", "--fix-inertia", "-o", "arm.urdf").exit_code == 2
    assert (here / "arm.urdf").read_text() == URDF
    assert run("arm.urdf", "-o", "x.urdf").exit_code == 2


def test_options_say_how_a_file_is_read(here: Path) -> None:
    (here / "arm.xacro").write_text(
        "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'><xacro:arg name='mass' default='1'/>"
        "<link name='a'><inertial><mass value='$(arg mass)'/>"
        "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link></robot>"
    )
    result = CliRunner().invoke(app, ["inspect", "arm.xacro", "--json", "--xacro-arg", "mass=7"])
    assert json.loads(result.stdout)["totals"]["mass"] == 7
    assert run("arm.xacro", "--xacro-arg", "mass").exit_code == 2
    wrong = run("arm.xacro", "--base", "flaoting")
    assert wrong.exit_code == 2
    assert "did you mean 'floating'?" in wrong.stderr


@pytest.mark.needs_packs
@pytest.mark.slow
def test_a_reader_that_ends_does_not_change_the_exit_code(tmp_path: Path) -> None:
    (tmp_path / "bad.sdf").write_text('<sdf version="1.9"><world name="w"><model/></world></sdf>')
    for words, code in ((["plugin", "list"], 0), (["check", str(tmp_path / "bad.sdf")], 2)):
        reader, writer = os.pipe()
        os.close(reader)
        command = [sys.executable, "-m", "simkit", *words]
        done = subprocess.run(command, stdout=writer, stderr=subprocess.PIPE, text=True, check=False)
        os.close(writer)
        assert (done.returncode, done.stderr) == (code, ""), words


@pytest.mark.parametrize("words", [("--resource-path", "mdels"), ("--package-path", "robot=mdels")])
def test_a_search_folder_that_does_not_exist_is_an_error(tmp_path: Path, words: tuple[str, str]) -> None:
    path = tmp_path / "world.sdf"
    path.write_text('<sdf version="1.9"><world name="w"/></sdf>')
    found = CliRunner().invoke(app, ["check", str(path), *words])
    assert found.exit_code == 2
    assert "SK-CLI-018" in found.output and "'mdels'" in found.output
