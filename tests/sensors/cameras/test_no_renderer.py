"""A world requests OpenGL on a machine without it: all sensors except cameras work, and a report gives the remedy."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from sensor_worlds import sensor, world

ROOT = Path(__file__).resolve().parents[3]
CAMERA = "<camera><image><width>32</width><height>24</height></image></camera>"
GL = "<scene><simkit:renderer>gl</simkit:renderer></scene>"
WORLD = world(sensor("camera", CAMERA, name="c") + sensor("imu", "<imu/>", name="i"), top=GL)
# a vendor list that names no file leaves the EGL library without drivers
BROKEN = {
    "MUJOCO_GL": "egl",
    "__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json",
    "__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent",
}


def run(script: str, broken: bool, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    kept = {k: v for k, v in os.environ.items() if k not in BROKEN and k != "PYOPENGL_PLATFORM"}
    environment = {**kept, "PYTHONPATH": str(ROOT), "SIMKIT_TEST_WORLD": WORLD, **(BROKEN if broken else {})}
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env=environment,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


def test_other_sensors_continue_and_the_camera_reports_the_missing_renderer() -> None:
    done = run(
        """
        import os, time, simkit
        sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"])
        infos = sim.subscribe("/world/w/model/m/link/l/sensor/c/camera_info")
        start = time.process_time()
        sim.run(0.1)
        assert time.process_time() - start < 3, "too slow"
        assert len(infos.messages) == 11
        assert sim.sensor("m::l::i").latest is not None
        try:
            sim.sensor("m::l::c").latest
        except simkit.RenderError as error:
            print(error)
        print(*[d.code for d in sim.diagnostics])
        sim.spawn('<sdf version="1.9"><model name="n"><static>true</static><link name="l"/></model></sdf>')
        snapshot = sim.snapshot()
        sim.run(0.1)
        sim.restore(snapshot)
        sim.close()
        """,
        broken=True,
    )
    assert done.returncode == 0, done.stderr
    assert "SK-RENDER-001" in done.stdout
    assert "libegl1 libopengl0 libgl1-mesa-dri" in done.stdout
    assert "libosmesa6" in done.stdout
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_an_egl_without_a_library_of_functions_is_reported_with_the_name_of_the_library() -> None:
    done = run(
        """
        import ctypes
        class OnlyEgl(ctypes.CDLL):
            def __init__(self, name, *more, **options):
                if str(name).startswith(("libOpenGL", "libGL")):
                    raise OSError(name)
                super().__init__(name, *more, **options)
        ctypes.CDLL = OnlyEgl
        from simkit.sensors.cameras.rendering import gl_context
        print(gl_context._egl_problem())
        """,
        broken=False,
    )
    if "libEGL.so.1" in done.stdout:
        pytest.skip("there is no EGL; apt install libegl1")
    assert done.stdout == "libOpenGL.so.0 not found\n", done.stderr


def test_opengl_can_be_switched_off() -> None:
    done = run(
        """
        import os
        os.environ["MUJOCO_GL"] = "disabled"
        import simkit
        sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"])
        sim.run(0.02)
        try:
            sim.sensor("m::l::c").latest
        except simkit.RenderError as error:
            print(error)
        """,
        broken=False,
    )
    assert done.returncode == 0, done.stderr
    assert "MUJOCO_GL=disabled" in done.stdout


@pytest.mark.slow
def test_nothing_is_printed_at_the_end_of_the_process() -> None:
    done = run(
        """
        import os, simkit
        kept = [simkit.load(os.environ["SIMKIT_TEST_WORLD"]) for _ in range(2)]
        for sim in kept:
            sim.run(0.02)
            try:
                sim.sensor("m::l::c").latest
            except simkit.RenderError:
                pass
        """,
        broken=False,
    )
    assert done.returncode == 0, done.stderr
    said = [line for line in done.stderr.splitlines() if "SK-RENDER-001" not in line]
    assert not said


def test_nothing_touches_opengl_before_the_first_image() -> None:
    done = run(
        """
        import os, sys, simkit
        sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"])
        sim.run(0.1)
        assert sim.sensor("m::l::i").latest is not None
        assert not [m for m in sys.modules if m == "OpenGL" or m.startswith("OpenGL.")], "OpenGL was imported"
        """,
        broken=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("value", ["foo", "osmesa"])
def test_a_missing_renderer_stops_only_cameras(value: str) -> None:
    done = run(
        f"""
        import ctypes.util, os
        os.environ["MUJOCO_GL"] = {value!r}
        import simkit
        sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"])
        sim.run(0.1)
        assert sim.sensor("m::l::i").latest is not None
        try:
            sim.sensor("m::l::c").latest
        except simkit.RenderError as error:
            print(error)
        print("OSMesa", ctypes.util.find_library("OSMesa"))
        """,
        broken=False,
    )
    assert done.returncode == 0, done.stderr
    assert "SK-RENDER-001" in done.stdout or (value == "osmesa" and "OSMesa None" not in done.stdout)


def test_a_subscription_to_images_is_refused_at_once_with_the_place_of_the_camera(tmp_path: Path) -> None:
    topic = "/world/w/model/m/link/l/sensor/c/image"
    done = run(
        f"""
        import os, pathlib, simkit
        pathlib.Path("w.sdf").write_text(os.environ["SIMKIT_TEST_WORLD"])
        def is_refused(call):
            try:
                call()
            except simkit.RenderError as error:
                return error.code == "SK-RENDER-001" and error.exit_code == 2 and "(w.sdf:3)" in str(error)
        sim = simkit.load("w.sdf")
        assert is_refused(lambda: sim.subscribe({topic!r}))
        assert is_refused(lambda: sim.subscribe({topic!r}, print))
        sim.run(0.1)
        assert sim.diagnostics == []
        class Viewer(simkit.WorldPlugin):
            def load(self, parent, params):
                self.images = self.subscribe({topic!r})
        assert is_refused(lambda: simkit.load("w.sdf", plugins=[Viewer()]))
        empty = simkit.load('<sdf version="1.9"><world name="w">{GL}</world></sdf>')
        images = empty.subscribe({topic!r})
        model = os.environ["SIMKIT_TEST_WORLD"].replace('<world name="w">{GL}', "").replace("</world>", "")
        pathlib.Path("w.sdf").write_text(model)
        assert is_refused(lambda: empty.spawn("w.sdf"))
        assert not empty.models
        try:
            simkit.load(os.environ["SIMKIT_TEST_WORLD"], strict=True)
        except simkit.LoadError as error:
            print([(d.code, d.line) for d in error.diagnostics])
        """,
        broken=True,
        folder=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout == "[('SK-RENDER-001', 3)]\n"


COMMANDS = """
run w.sdf --duration 0.02 --record a.mcap
run w.sdf --duration 0.02 --record a.mcap --topic */image
run w.sdf --duration 0.02 --topic */image
run w.sdf --duration 0.02 --strict
run w.sdf --duration 0.02 --picture a.png
run w.sdf --duration 0.02 --until count('/world/w/model/m/link/l/sensor/c/image')>0
golden record w.sdf --duration 0.02 -o a
bundle w.sdf --duration 0.02 --topic */image -o a.bundle
plot w.sdf /world/w/model/m/link/l/sensor/c/image.width --duration 0.02 -o a.svg
"""


@pytest.mark.needs_packs
@pytest.mark.slow
def test_every_command_that_asks_for_images_ends_before_the_run(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(WORLD)
    done = run(
        f"""
        import contextlib, io, os
        os.environ["MUJOCO_GL"], before = "disable", sorted(os.listdir())
        from simkit.cli import app
        for line in {COMMANDS.split(chr(10))[1:-1]!r}:
            err = io.StringIO()
            with contextlib.redirect_stderr(err), contextlib.redirect_stdout(io.StringIO()) as out:
                code = app(args=line.split(), standalone_mode=False)
            assert "simulated" not in out.getvalue()
            print(code, err.getvalue().count("SK-RENDER-001"), sorted(os.listdir()) == before, line)
        """,
        broken=False,
        folder=tmp_path,
    )
    assert done.returncode == 0, done.stderr
    lines = COMMANDS.split("\n")[1:-1]
    notes = [2 if "--until" in line else 1 for line in lines]
    assert done.stdout.splitlines() == [f"2 {n} True {line}" for n, line in zip(notes, lines, strict=True)]


@pytest.mark.parametrize("command", ["run", "convert"])
def test_no_command_fails_for_a_renderer_that_it_does_not_need(command: str, tmp_path: Path) -> None:
    (tmp_path / "world.sdf").write_text(WORLD.replace(GL, ""))
    record = ["--duration", "0.02", "--record", "bag.mcap", "--skip", "*/c/image"]
    more = {"run": record, "convert": ["-o", "other.sdf"]}
    done = subprocess.run(
        [sys.executable, "-m", "simkit", command, "world.sdf", *more.get(command, [])],
        env={**os.environ, "PYTHONPATH": str(ROOT), "MUJOCO_GL": "foo"},
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.count("MUJOCO_GL=foo: unknown renderer") == (command == "run")


@pytest.mark.slow
def test_an_error_of_all_cameras_is_logged_once_and_reported_for_each() -> None:
    cameras = "".join(sensor("camera", CAMERA, name=f"c{n}") for n in range(3))
    done = run(
        f"""
        import simkit
        with simkit.load({world(cameras, top=GL)!r}) as sim:
            sim.run(0.02)
            for sensor in sim.contents.sensors.values():
                try:
                    sensor.latest
                except simkit.RenderError:
                    pass
            print(sum(d.code == "SK-RENDER-001" for d in sim.diagnostics))
        """,
        broken=True,
    )
    assert done.stdout.split() == ["3"], done.stderr
    assert done.stderr.count("SK-RENDER-001") == 1
    assert "libegl1 libopengl0 libgl1-mesa-dri" in done.stderr
