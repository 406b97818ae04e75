"""Packs of other distributions with faults: a run that does not need them continues, and a message names the place."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

HEIGHT = """from simkit.extend import Sensor


class Height(Sensor):
    kinds = ("{kind}",)

    def describe(self): return {{}}
    def products(self): return {{}}
    def default_topics(self): return {{}}
    def measure(self, model, data): return 0.0
"""
PLUGIN = """from simkit import Plugin


class Sprinkler(Plugin):
    filenames = ("{name}",)

    def load(self, parent, params): pass
"""
WORLD = """<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
<sensor name="s" type="{kind}"/></link>{plugin}</model></world></sdf>"""
AREA = 'title = "Garden"\n\n[SK-GARDEN-001]\nseverity = "warning"\nmeaning = "dry"\n'


class Packs:
    """Folder with packs, with the metadata that pip would write beside them."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.write("w.sdf", WORLD.format(kind="theremin", plugin=""))

    def write(self, name: str, text: str | bytes) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    def add(self, name: str, files: dict[str, str | bytes]) -> Path:
        """Add a pack, and return the folder of its package."""
        self.write(
            f"simkit_{name}-0.1.dist-info/METADATA", f"Metadata-Version: 2.1\nName: simkit_{name}\nVersion: 0.1\n"
        )
        self.write(f"simkit_{name}-0.1.dist-info/entry_points.txt", f"[simkit.packs]\n{name} = simkit_{name}\n")
        self.write(f"simkit_{name}/__init__.py", "")
        for file, text in files.items():
            self.write(f"simkit_{name}/{file}", text)
        return self.folder / f"simkit_{name}"

    def simkit(self, *words: str) -> tuple[int, str]:
        """Run a command, and return its exit code and its output, which has no traceback."""
        environment = {**os.environ, "PYTHONPATH": str(self.folder), "COLUMNS": "200"}
        command = [sys.executable, "-m", "simkit", *words]
        done = subprocess.run(command, env=environment, cwd=self.folder, capture_output=True, text=True)
        assert "Traceback" not in done.stderr, done.stderr
        return done.returncode, done.stdout + done.stderr


@pytest.fixture
def packs(tmp_path: Path) -> Packs:
    return Packs(tmp_path)


@pytest.mark.slow
def test_a_sensor_with_a_taken_kind_is_left_out_with_a_warning(packs: Packs) -> None:
    first = packs.add("apple", {"sensors/height.py": HEIGHT.format(kind="sap")})
    second = packs.add(
        "berry", {"sensors/imu.py": HEIGHT.format(kind="imu"), "sensors/sap.py": HEIGHT.format(kind="sap")}
    )
    for command in (["check", "w.sdf"], ["run", "w.sdf", "--duration", "0.01"]):
        code, output = packs.simkit(*command)
        assert code == 0 and "SK-SENSOR-001" in output and "or install the pack that has it" in output
        imu = "class Height cannot have the name 'imu' of simkit.sensors.inertial.imu.Imu"
        assert output.count(f"package simkit_berry: {second}/sensors/imu.py:4: {imu}") == 1, output
        sap = "class Height cannot have the name 'sap' of simkit_apple.sensors.height.Height"
        assert output.count(f"package simkit_berry: {second}/sensors/sap.py:4: {sap}") == 1 and str(first) not in output


@pytest.mark.slow
def test_a_plugin_with_a_taken_name_is_left_out_with_a_warning(packs: Packs) -> None:
    folder = packs.add("garden", {"plugins/drive.py": PLUGIN.format(name="gz-sim-diff-drive-system")})
    text = f"package simkit_garden: {folder}/plugins/drive.py:4: class Sprinkler cannot have the name"
    for words, expected in ((["list"], "libgazebo_ros_diff_drive.so"), (["info", "no_such_name"], "no_such_name")):
        _, output = packs.simkit("plugin", *words)
        assert expected in output and output.count(text) == 1, output


def test_names_that_are_no_tuple_of_texts_are_a_warning(packs: Packs) -> None:
    folder = packs.add("garden", {"sensors/height.py": HEIGHT.replace('("{kind}",)', "5").format()})
    code, output = packs.simkit("check", "w.sdf")
    assert code == 0 and f"{folder}/sensors/height.py:4: Height.kinds: found 5; expected a tuple of texts" in output


@pytest.mark.slow
def test_the_import_error_of_a_plugin_and_of_a_sensor_is_the_reason_in_the_diagnostic(packs: Packs) -> None:
    files: dict[str, str | bytes] = {
        "plugins/sprinkler.py": "import no_such_module\n" + PLUGIN.format(name="garden_sprinkler"),
        "sensors/height.py": "import no_such_module\n" + HEIGHT.format(kind="theremin"),
    }
    folder = packs.add("garden", files)
    code, output = packs.simkit("check", "w.sdf")
    cause = f"{folder}/sensors/height.py:1: ModuleNotFoundError: No module named 'no_such_module'"
    assert code == 0 and output.count(f"package simkit_garden: {cause}") == 1, output
    assert f"because its package is broken: simkit_garden: {cause}" in output
    world = WORLD.format(kind="imu", plugin='<plugin filename="garden_sprinkler" name="p"/>')
    packs.write("w.sdf", world)
    code, output = packs.simkit("run", "w.sdf", "--duration", "0.01")
    assert code == 2 and "did you mean" not in output
    assert f"SK-PLUGIN-008: plugin 'garden_sprinkler' (name 'p') cannot be imported: simkit_garden: {folder}" in output


def test_definitions_with_faults_are_left_out_and_those_of_ros_stay(packs: Packs) -> None:
    definitions: dict[str, str | bytes] = {
        "garden_msgs/msg/Good.msg": "std_msgs/Header header\n",
        "garden_msgs/msg/Bad.msg": "float64 a\nflot64 x y z\n",
        "garden_msgs/msg/Unknown.msg": "Nothing nothing\n",
        "garden_msgs/msg/Bytes.msg": b"float64 \xff\n",
        "std_msgs/msg/Bool.msg": "float64 data\n",
        "README.md": "Messages of the garden.\n",
    }
    folder = packs.add("garden", {f"msgs/definitions/{name}": text for name, text in definitions.items()})
    code, output = packs.simkit("interface", "show", "std_msgs/msg/Bool")
    assert code == 0 and "bool data" in output
    for place, text in (
        ("garden_msgs/msg/Bad.msg:2", "SK-INTERFACE-003 unknown type 'flot64'; did you mean 'float64'?"),
        ("garden_msgs/msg/Unknown.msg:1", "SK-INTERFACE-003 unknown type 'garden_msgs/msg/Nothing'"),
        ("garden_msgs/msg/Bytes.msg", "SK-INTERFACE-006 the definition cannot be read"),
        ("std_msgs/msg/Bool.msg", "SK-INTERFACE-004 another definition than that of ROS 2, which is used"),
    ):
        assert output.count(f"package simkit_garden: {folder}/msgs/definitions/{place}: {text}") == 1, output
    code, output = packs.simkit("interface", "package", "garden_msgs")
    assert code == 0 and "garden_msgs/msg/Good\n" in output and "garden_msgs/msg/Bad\n" not in output


@pytest.mark.parametrize(
    ("area", "warning"),
    [
        (AREA.replace('"dry"', "dry"), ": Invalid value (at line 5"),
        (AREA.replace('severity = "warning"\n', ""), ":3: SK-GARDEN-001: 'severity' is missing; it is left out"),
        (AREA.replace("meaning", "meanin"), ":3: SK-GARDEN-001: unknown key 'meanin'; did you mean 'meaning'?"),
        (AREA.replace('title = "Garden"\n', ""), ': the area has no title; write title = "..." in the first line'),
    ],
)
def test_a_fault_in_a_file_of_codes_has_its_place(packs: Packs, area: str, warning: str) -> None:
    folder = packs.add("garden", {"cli/diagnostic_codes/garden.toml": area})
    code, output = packs.simkit("explain", "SK-GARDEN-001")
    assert output.count(f"package simkit_garden: {folder}/cli/diagnostic_codes/garden.toml{warning}") == 1, output
    assert (code == 0) == ("title" in warning)
    assert packs.simkit("explain", "SK-SDF-004")[0] == 0


def test_a_code_without_an_example_has_no_line_for_it(packs: Packs) -> None:
    packs.add("garden", {"cli/diagnostic_codes/garden.toml": AREA})
    text = "SK-GARDEN-001 (warning)\n  dry\n  score: approximated\n"
    assert packs.simkit("explain", "SK-GARDEN-001") == (0, text)


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ('"""Water."""\ndef water(:\n', ":2: SyntaxError: invalid syntax"),
        ('"""Water."""\nimport no_such_module\n', ":2: ModuleNotFoundError: No module named 'no_such_module'"),
        ('"""Water."""\ndef pour(): pass\n', ": the command 'water' cannot be used: AttributeError: module"),
        ('"""Water."""\ndef water() -> None:\n    {}["well"]\n', ":3: KeyError: 'well'"),
    ],
)
def test_a_fault_in_a_command_of_a_pack_is_one_line(packs: Packs, text: str, fault: str) -> None:
    folder = packs.add("garden", {"cli/water.py": text})
    code, output = packs.simkit("water")
    assert code == 4 and output.startswith("error: SK-CLI-058 package simkit_garden: ") and output.count("\n") == 1
    assert f"{folder}/cli/water.py{fault}" in output
    assert "Water." in packs.simkit("--help")[1]


def test_an_exception_of_a_run_part_is_one_line(packs: Packs) -> None:
    part = (
        "from simkit.extend import RunPart\n\nclass Leak(RunPart):\n    def after_loading(self, sim):\n        1 / 0\n"
    )
    folder = packs.add("garden", {"cli/run_parts/leak.py": part})
    code, output = packs.simkit("run", "empty", "--duration", "0.01")
    text = f"{folder}/cli/run_parts/leak.py:5: ZeroDivisionError: division by zero"
    assert code == 4 and f"error: SK-CLI-058 package simkit_garden: {text}" in output, output
