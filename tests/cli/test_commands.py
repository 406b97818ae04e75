"""The command line: what it prints, what it leaves behind, how it ends."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import mujoco
import pytest
from rosbags.highlevel import AnyReader
from typer.testing import CliRunner, Result

from simkit.cli import app

WORLD = """<?xml version="1.0"?>
<sdf version="1.9"><world name="w">
  <model name="ball"><pose>0 0 5 0 0 0</pose>
    <link name="body">
      <inertial><mass>1</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
      <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor>
    </link>
  </model>
  {extra}
</world></sdf>
"""
RAISER = """
from simkit import WorldPlugin

class Raiser(WorldPlugin):
    filenames = ("raiser",)

    def load(self, sim, params):
        self.count = 0

    def after_step(self):
        self.count += 1
        if self.count == 1500:
            raise ValueError("the wheel fell off")
"""


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "ball.sdf"
    path.write_text(WORLD.format(extra=""))
    return path


def simkit(*arguments: object) -> Result:
    return CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)


def simkit_process(*arguments: object, cwd: Path) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "simkit", *map(str, arguments)]
    return subprocess.Popen(
        command, cwd=cwd, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


# ---------------------------------------------------------------------- run


def test_a_run_prints_topics_rates_time_and_a_repeatable_hash(world: Path) -> None:
    first, second = simkit("run", world, "--duration", 1), simkit("run", world, "--duration", 1)
    assert first.exit_code == 0
    assert re.search(r"^/imu +101 +100\.00 Hz +sensor_msgs/msg/Imu$", first.stdout, re.MULTILINE)
    assert "simulated 1.000 s in " in first.stdout
    assert re.search(r"^state [0-9a-f]{64}$", first.stdout, re.MULTILINE)
    assert first.stdout.splitlines()[-1] == second.stdout.splitlines()[-1]


def test_a_quiet_run_prints_only_the_summary(world: Path) -> None:
    assert len(simkit("run", world, "--duration", 0.1, "--quiet").stdout.splitlines()) == 2


def test_a_run_leaves_no_files_that_were_not_requested(world: Path) -> None:
    simkit("run", world, "--duration", 0.2)
    assert [p.name for p in world.parent.iterdir()] == ["ball.sdf"]


def test_a_run_is_recorded(world: Path) -> None:
    result = simkit("run", world, "--duration", 1.5, "--record", "run.mcap")
    assert result.exit_code == 0
    assert "run.mcap" in result.stdout
    with AnyReader([world.parent / "run.mcap"]) as reader:
        assert {c.topic: c.msgcount for c in reader.connections}["/imu"] == 151


def test_the_same_seed_records_the_same_bytes_whatever_the_pace(world: Path) -> None:
    simkit("run", world, "--duration", 0.3, "--record", "a.mcap")
    simkit("run", world, "--duration", 0.3, "--record", "b.mcap", "--rtf", 5)
    assert (world.parent / "a.mcap").read_bytes() == (world.parent / "b.mcap").read_bytes()


def test_a_real_time_factor_is_held(world: Path) -> None:
    begin = time.perf_counter()
    simkit("run", world, "--duration", 1, "--rtf", 2)
    assert time.perf_counter() - begin >= 0.5


def test_an_existing_recording_is_replaced_only_by_force(world: Path) -> None:
    simkit("run", world, "--duration", 0.1, "--record", "run.mcap")
    refused = simkit("run", world, "--duration", 0.1, "--record", "run.mcap")
    assert refused.exit_code == 2
    assert "SK-BAG-001" in refused.stderr
    assert simkit("run", world, "--duration", 0.1, "--record", "run.mcap", "--force").exit_code == 0


def test_values_are_set(world: Path) -> None:
    result = simkit("run", world, "--duration", 1, "--set", "ball::body::imu.update_rate=20")
    assert re.search(r"^/imu +21 +20\.00 Hz", result.stdout, re.MULTILINE)


def test_a_value_that_cannot_be_set_names_the_closest(world: Path) -> None:
    result = simkit("run", world, "--duration", 1, "--set", "ball::bdy.gravity=false")
    assert result.exit_code == 2
    assert "did you mean 'ball::body'" in result.stderr


def test_a_world_that_is_not_there_is_one_message(world: Path) -> None:
    result = simkit("run", "bal.sdf", "--duration", 1, "--record", "run.mcap")
    assert result.exit_code == 2
    assert "SK-LOAD-002" in result.stderr
    assert "did you mean 'ball.sdf'" in result.stderr
    assert not (world.parent / "run.mcap").exists()
    listed = "give a file, or a world of simkit: "
    assert listed in simkit("run", "nothing_like_it", "--duration", 1).stderr
    assert listed not in simkit("run", "folder/nothing_like_it", "--duration", 1).stderr


@pytest.mark.parametrize(
    ("broken", "code"),
    [("<sdf version='1.9'><world name='w'>", "SK-XML"), ("<sdg/>", "SK-LOAD-003"), ("", "SK-")],
)
def test_a_broken_file_is_a_message_with_file_and_line(world: Path, broken: str, code: str) -> None:
    world.write_text(broken)
    result = simkit("run", world, "--duration", 1)
    assert result.exit_code == 2
    assert code in result.stderr
    assert "ball.sdf" in result.stderr
    assert "Traceback" not in result.stderr


@pytest.mark.parametrize(
    "arguments",
    [("run",), ("run", "x.sdf", "--duration", "soon"), ("run", "x.sdf", "--sped", "2"), ("fly",), ("convert", "x.sdf")],
)
def test_wrong_usage_is_exit_2(arguments: tuple[str, ...], world: Path) -> None:
    assert simkit(*arguments).exit_code == 2


def test_strict_makes_warnings_errors(world: Path) -> None:
    world.write_text(WORLD.format(extra="<plugin name='p' filename='libnobody_knows.so'/>"))
    assert simkit("run", world, "--duration", 0.1).exit_code == 0
    strict = simkit("run", world, "--duration", 0.1, "--strict")
    assert strict.exit_code == 2
    assert "SK-PLUGIN-001" in strict.stderr


def test_a_plugin_that_raises_shows_its_traceback_and_the_recording_up_to_there(world: Path) -> None:
    (world.parent / "plugins").mkdir()
    (world.parent / "plugins" / "raiser.py").write_text(RAISER)
    world.write_text(WORLD.format(extra="<plugin name='wheels' filename='raiser'/>"))
    result = simkit("run", world, "--duration", 5, "--plugin-path", "plugins", "--record", "run.mcap")
    assert result.exit_code == 4
    for part in ("ValueError: the wheel fell off", "raiser.py", "'wheels'", "ball.sdf:", "after_step", "t=1.5 s"):
        assert part in result.stderr
    with AnyReader([world.parent / "run.mcap"]) as reader:
        assert {c.topic: c.msgcount for c in reader.connections}["/imu"] == 151


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="signals are sent otherwise there")
@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_an_interrupt_leaves_everything_readable(world: Path, number: signal.Signals, code: int) -> None:
    words = ("--rtf", 1, "--duration", 1000, "--record", "run.mcap", "--junit", "run.xml")
    with simkit_process("run", world, *words, cwd=world.parent) as process:
        deadline = time.monotonic() + 60
        recording = world.parent / "run.mcap"
        while not (recording.exists() and recording.stat().st_size > 2000) and time.monotonic() < deadline:
            time.sleep(0.05)
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    assert process.returncode == code
    assert "simulated " in out
    assert "Traceback" not in err
    with AnyReader([recording]) as reader:
        assert reader.message_count > 100
    assert '<error message="ended with an interrupt"' in (world.parent / "run.xml").read_text()


def test_a_run_with_a_picture_by_opengl_is_refused_without_it(world: Path) -> None:
    environment = {**os.environ, "MUJOCO_GL": "disable", "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-m", "simkit", "run", str(world), "--duration", "0.1", "--picture", "out.png"]
    command += ["--renderer", "gl"]
    done = subprocess.run(command, cwd=world.parent, env=environment, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and "simulated" not in done.stdout
    assert "SK-RENDER-001" in done.stderr
    assert not (world.parent / "out.png").exists()


def test_a_world_that_comes_with_simkit_runs_by_its_bare_name(world: Path) -> None:
    assert simkit("run", "empty", "--duration", 0.1).exit_code == 0


# ---------------------------------------------------------------------- the others


def test_check_prints_every_problem_and_nothing_runs(world: Path) -> None:
    world.write_text(WORLD.format(extra="<plugin name='p' filename='libnobody_knows.so'/><wnd/>"))
    result = simkit("check", world)
    assert "SK-PLUGIN-001" in result.stdout
    assert "<wnd>" in result.stdout
    listed = json.loads(simkit("check", world, "--json").stdout)
    assert {"code", "severity", "file", "line", "message", "hint"} <= set(listed[0])
    assert all(isinstance(d["line"], int) for d in listed if d["code"] == "SK-PLUGIN-001")


def test_check_of_a_good_file_is_exit_0_and_of_a_bad_one_exit_2(world: Path) -> None:
    assert simkit("check", world).exit_code == 0
    world.write_text("<sdf version='1.9'><world>")
    assert simkit("check", world).exit_code == 2
    assert json.loads(simkit("check", world, "--json").stdout)[0]["severity"] == "error"


def test_inspect_prints_one_json_object_or_a_tree(world: Path) -> None:
    described = json.loads(simkit("inspect", world, "--json").stdout)
    assert described["worlds"][0]["models"][0]["links"][0]["sensors"][0]["update_rate"] == 100
    tree = simkit("inspect", world).stdout
    assert "sensor imu  imu, 100 Hz, imu" in tree
    assert "1 model, 1 link" in tree


def test_convert_writes_files_that_mujoco_opens(world: Path) -> None:
    result = simkit("convert", world, "-o", "ball.xml")
    assert result.exit_code == 0
    model = mujoco.MjModel.from_xml_path(str(world.parent / "ball.xml"))
    assert model.body("ball::body").mass[0] == 1.0
    assert model.nq == 7
    assert simkit("convert", world, "-o", "ball.xml").exit_code == 2
    assert simkit("convert", world, "-o", "new/ball.xml").exit_code == 0


def test_bag_recover_completes_a_bag(world: Path) -> None:
    simkit("run", world, "--duration", 2.5, "--record", "run.mcap")
    whole = (world.parent / "run.mcap").read_bytes()
    (world.parent / "torn.mcap").write_bytes(whole[: len(whole) // 2])
    result = simkit("bag", "recover", "torn.mcap", "-o", "mended.mcap")
    assert result.exit_code == 0
    assert "the bag was cut off" in result.stdout
    with AnyReader([world.parent / "mended.mcap"]) as reader:
        assert reader.message_count > 0
    assert simkit("bag", "recover", "missing.mcap").exit_code == 2


@pytest.mark.slow
def test_doctor_names_versions_and_the_renderer_with_its_speed() -> None:
    result = simkit("doctor")
    assert result.exit_code == 0
    for name in ("simkit", "python", "mujoco", "renderer", "picture"):
        assert re.search(rf"^{name} +\S", result.stdout, re.MULTILINE)
    assert re.search(r"^picture +320 × 240 px in \S+ ms$", result.stdout, re.MULTILINE)
    assert "no problems found" in result.stdout
    assert "ImportError: cannot import name" not in result.stdout, "the drawing process uses the modules of today"


@pytest.mark.slow
def test_doctor_lists_extras_and_the_packages_that_they_miss(monkeypatch: pytest.MonkeyPatch) -> None:
    needed = [
        "numpy>=2.0",
        "pytest; extra == 'tests-of-mine'",
        "no-such-package>=1; (os_name == 'nt') and extra == 'odd'",
    ]
    monkeypatch.setattr("simkit.cli.doctor.requires", lambda _: needed)
    assert json.loads(simkit("doctor", "--json").stdout)["extras"] == {"odd": ["no-such-package"], "tests-of-mine": []}
    assert "odd (no-such-package)" in simkit("doctor").stdout


@pytest.mark.slow
def test_a_missing_opengl_is_a_note_of_doctor_and_a_problem_only_if_it_is_requested(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    result = simkit("doctor")
    assert result.exit_code == 0
    assert re.search(r"^renderer +software \(simkit, OpenCV ", result.stdout, re.MULTILINE)
    assert "note: SK-RENDER-015" in result.stdout and "no problems found" in result.stdout
    result = simkit("doctor", "--renderer", "gl")
    assert result.exit_code == 1
    assert "SK-RENDER-001" in result.stdout and "problems found; see the lines above" in result.stdout


@pytest.mark.slow
def test_doctor_names_the_folders_of_its_variables(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, folder in (("SIMKIT_SAVE_PATH", tmp_path), ("SIMKIT_RESOURCE_PATH", tmp_path / "gone")):
        monkeypatch.setenv(name, str(folder))
    lines = dict(line.split(maxsplit=1) for line in simkit("doctor").stdout.splitlines() if line.startswith("SIMKIT_"))
    assert lines["SIMKIT_SAVE_PATH"].split() == [str(tmp_path)]
    assert lines["SIMKIT_RESOURCE_PATH"].endswith("(missing)")


def test_bench_sets_simkit_beside_the_bare_engine(world: Path) -> None:
    result = simkit("bench", world, "--rounds", 1)
    assert result.exit_code == 0
    for row in ("step, nothing due", "step, all plugins", "imu ball::body::imu", "memory"):
        assert re.search(rf"^{row}", result.stdout, re.MULTILINE)


def test_bench_prints_no_table_before_an_error(world: Path) -> None:
    result = simkit("bench", world, "--set", "nothing=1")
    assert result.exit_code == 2 and result.stderr and not result.stdout


def test_importing_simkit_loads_no_engine() -> None:
    code = (
        "import sys, simkit; print([m for m in ('mujoco', 'rosbags', 'trimesh', 'cv2', 'typer') if m in sys.modules])"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_an_infinite_pace_is_no_pace(world: Path) -> None:
    assert simkit("run", world, "--duration", 0.01, "--rtf", "inf").exit_code == 0


def test_a_terminal_without_our_signs_ends_no_run(world: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "simkit", "run", str(world), "--duration", "0.01"],
        env={**os.environ, "PYTHONIOENCODING": "ascii", "PYTHONPATH": str(Path(__file__).resolve().parents[2])},
        capture_output=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
