"""`simkit plugin new`: what it writes runs at once, and its test passes."""

from __future__ import annotations

import ast
import importlib.util
import re
from contextlib import ExitStack
from pathlib import Path
from types import ModuleType

import pytest
from typer.testing import CliRunner, Result

from simkit.cli import app
from simkit.pytest_plugin import WorldOpener

WORLD = """<sdf version="1.9"><world name="w">
  <plugin name="acme::Weather" filename="libacme-weather-system.so">
    <windy>true</windy><gusts>0.5</gusts><gusts>1.5</gusts>
  </plugin>
  <model name="crane">
    <link name="base">
      <visual name="skin"><geometry><box><size>1 1 1</size></box></geometry>
        <plugin name="blink" filename="libblink.so"><colour>1 0 0 1</colour></plugin>
      </visual>
      <sensor name="eye" type="imu"><plugin name="watch" filename="libwatcher.so"><topic>eye</topic></plugin></sensor>
    </link>
    <plugin name="hook" filename="libcrane_hook.so">
      <ros><namespace>crane</namespace></ros>
      <maxSpeed>2.5</maxSpeed><count>3</count><label>the hook's "name" &amp; more</label><reach>inf</reach>
      <origin>1 2 3 0 0 0</origin><axis>0 0 1</axis><enabled>0</enabled><name>big</name><empty/>
      <stop>red</stop><stop>amber</stop>
      <noise type="gaussian"><mean>0.1</mean><bias>false</bias></noise>
      <waypoint><time>1</time><at>0 0 1</at></waypoint><waypoint><time>2</time></waypoint>
      <gz:extra>left out</gz:extra>
    </plugin>
    <plugin name="second" filename="libcrane_hook.so"><maxSpeed>7</maxSpeed><enabled>true</enabled></plugin>
    <plugin name="known" filename="libgazebo_ros_joint_state_publisher.so"><joint_name>j</joint_name></plugin>
  </model>
</world></sdf>
"""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def new(*arguments: object) -> Result:
    return CliRunner().invoke(app, ["plugin", "new", *map(str, arguments)], catch_exceptions=False)


def run_test(path: Path) -> None:
    """Runs the only test of a file, as pytest would."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    (test,) = (f for name, f in vars(module).items() if name.startswith("test_"))
    with ExitStack() as stack:
        test(WorldOpener(path.parent, [], stack))


@pytest.mark.parametrize("parent", ["world", "model", "visual", "sensor"])
def test_a_new_plugin_runs_and_its_test_passes(folder: Path, parent: str) -> None:
    result = new("wheel_brake", "--on", parent)
    assert result.exit_code == 0
    assert result.stdout.split() == ["wheel_brake.py", "test_wheel_brake.py"]
    text = (folder / "wheel_brake.py").read_text()
    assert f"class WheelBrake({parent.capitalize()}Plugin):" in text
    assert 'self.gain: float = params.number("gain", 1.0)' in text
    run_test(folder / "test_wheel_brake.py")


@pytest.mark.parametrize(
    ("name", "module", "class_name"),
    [
        ("WheelBrake", "wheel_brake", "WheelBrake"),
        ("libWheelBrake.so", "wheel_brake", "WheelBrake"),
        ("lib3d_scanner.so", "plugin_3_d_scanner", "Plugin3DScanner"),
        ("json", "json_plugin", "JsonPlugin"),
    ],
)
def test_names_become_a_module_and_a_class(folder: Path, name: str, module: str, class_name: str) -> None:
    assert new(name).stdout.split()[0] == f"{module}.py"
    assert f"class {class_name}(" in (folder / f"{module}.py").read_text()


def test_each_unmapped_library_of_a_world_gets_a_plugin_and_a_test_that_passes(folder: Path) -> None:
    (folder / "world.sdf").write_text(WORLD)
    result = new("--from", "world.sdf", "--folder", "plugins")
    assert result.exit_code == 0, result.stderr
    modules = {Path(line).stem for line in result.stdout.split() if not Path(line).stem.startswith("test_")}
    assert modules == {"weather", "crane_hook", "blink", "watcher"}
    for module in modules:
        ast.parse((folder / "plugins" / f"{module}.py").read_text())
        run_test(folder / "plugins" / f"test_{module}.py")


def test_parameters_have_the_types_that_the_world_shows(folder: Path) -> None:
    (folder / "world.sdf").write_text(WORLD)
    new("--from", "world.sdf")
    text = (folder / "crane_hook.py").read_text()
    for line in (
        'self.max_speed: float = params.number("maxSpeed", 2.5)',
        'self.count: float = params.number("count", 3.0)',
        """self.label: str = params.text("label", 'the hook\\'s "name" & more')""",
        'self.reach: float = params.number("reach", float("inf"), finite=False)',
        'self.origin: Pose = params.pose("origin", Pose.from_rpy(1.0, 2.0, 3.0, 0.0, 0.0, 0.0))',
        'self.axis: tuple[float, ...] = params.vector("axis", 3, (0.0, 0.0, 1.0))',
        'self.enabled: bool = params.boolean("enabled", False)',  # 0 here, true there
        'self.name_value: str = params.text("name", "big")',  # a plugin has a name already
        'self.stop: list[str] = [item.text("stop", "red") for item in params.each("stop")]',
        '"@type": params.block("noise").attribute("type", "gaussian"),',
        '"bias": params.block("noise").boolean("bias", False),',
    ):
        assert line in text, line
    assert "namespace" not in text and "extra" not in text
    assert "Named in world.sdf, line " in text
    assert "class Weather(WorldPlugin):" in (folder / "weather.py").read_text()
    assert 'names = ("acme::Weather",)' in (folder / "weather.py").read_text()
    gusts = 'self.gusts: list[float] = [item.number("gusts", 0.5) for item in params.each("gusts")]'
    assert gusts in (folder / "weather.py").read_text()


def test_the_world_itself_finds_them(folder: Path) -> None:
    (folder / "world.sdf").write_text(WORLD)
    new("--from", "world.sdf")
    run = CliRunner().invoke(app, ["run", "world.sdf", "--plugin-path", ".", "--duration", "0.1"])
    assert "SK-PLUGIN-001" not in run.stderr and "SK-PARAM-003" not in run.stderr
    again = new("--from", "world.sdf", "--plugin-path", ".")
    assert again.exit_code == 0 and "nothing to write" in again.stderr


def test_no_line_is_too_long(folder: Path) -> None:
    (folder / "world.sdf").write_text(WORLD)
    new("--from", "world.sdf")
    for path in folder.glob("*.py"):
        assert all(len(line) <= 120 for line in path.read_text().splitlines()), path.name


def test_a_file_and_a_class_that_the_world_names_are_called_so(folder: Path) -> None:
    world = """<sdf version="1.9"><world name="w"><plugin name="Winch" filename="lifting.py"><gain>2</gain></plugin>
    <plugin name="x" filename="robots.arm:Wrist"/></world></sdf>"""
    (folder / "world.sdf").write_text(world)
    assert new("--from", "world.sdf").exit_code == 0
    assert "class Winch(WorldPlugin):" in (folder / "lifting.py").read_text()
    assert "class Wrist(WorldPlugin):" in (folder / "robots" / "arm.py").read_text()
    run = CliRunner().invoke(app, ["check", "world.sdf", "--plugin-path", "."])
    assert run.exit_code == 0 and "SK-PLUGIN" not in run.output


def test_no_file_is_replaced_without_force(folder: Path) -> None:
    (folder / "test_wheel_brake.py").write_text("mine")
    refused = new("wheel_brake")
    assert refused.exit_code == 2 and "SK-PLUGIN-074" in refused.stderr and "test_wheel_brake.py" in refused.stderr
    assert not (folder / "wheel_brake.py").exists(), "all or nothing"
    assert new("wheel_brake", "--force").exit_code == 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["wheel_brake", "--on", "modle"], "did you mean 'model'?"),
        (["libgazebo_ros_diff_drive.so"], "simkit already has a plugin"),
        (["..."], "expected names such as wheel_brake"),
        ([], "SK-PLUGIN-072"),
        (["x", "--from", "y.sdf"], "SK-PLUGIN-072"),
        (["--from", "none.sdf"], "none.sdf"),
    ],
)
def test_impossible_plugins_are_rejected_with_a_message(arguments: list[str], said: str) -> None:
    result = new(*arguments)
    assert result.exit_code == 2
    assert said in result.stderr and re.search(r"SK-[A-Z]+-\d{3}", result.stderr)
