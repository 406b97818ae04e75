"""Without a renderer, all sensors except cameras work, and a report gives the reason and the remedy."""

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
WORLD = world(sensor("camera", CAMERA, name="c") + sensor("imu", "<imu/>", name="i"))
# a vendor list that names no file leaves the EGL library without drivers
BROKEN = {
    "MUJOCO_GL": "egl",
    "__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json",
    "__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent",
}


def run(script: str, broken: bool) -> subprocess.CompletedProcess[str]:
    kept = {k: v for k, v in os.environ.items() if k not in BROKEN and k != "PYOPENGL_PLATFORM"}
    environment = {**kept, "PYTHONPATH": str(ROOT), "SIMKIT_TEST_WORLD": WORLD, **(BROKEN if broken else {})}
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env=environment,
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
        images = sim.subscribe("/world/w/model/m/link/l/sensor/c/image")
        start = time.perf_counter()
        sim.run(0.1)
        assert time.perf_counter() - start < 3, "too slow"
        assert not images.messages
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
    assert "libegl1 libgl1-mesa-dri" in done.stdout
    assert "libosmesa6" in done.stdout
    assert "Traceback" not in done.stderr


def test_rendering_can_be_switched_off() -> None:
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


@pytest.mark.parametrize("command", ["run", "convert"])
def test_no_command_fails_for_a_renderer_that_it_does_not_need(command: str, tmp_path: Path) -> None:
    (tmp_path / "world.sdf").write_text(WORLD)
    more = {"run": ["--duration", "0.02", "--record", "bag.mcap"], "convert": ["-o", "other.sdf"]}
    done = subprocess.run(
        [sys.executable, "-m", "simkit", command, "world.sdf", *more.get(command, [])],
        env={**os.environ, "PYTHONPATH": str(ROOT), "MUJOCO_GL": "foo"},
        cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.count("MUJOCO_GL=foo: unknown renderer") == (command == "run")


def test_an_error_of_all_cameras_is_logged_once_and_reported_for_each() -> None:
    cameras = "".join(sensor("camera", CAMERA, name=f"c{n}") for n in range(3))
    done = run(
        f"""
        import simkit
        with simkit.load({world(cameras)!r}) as sim:
            subs = [sim.subscribe(topic) for topic in sim.topics()]
            sim.run(0.02)
            print(sum(d.code == "SK-RENDER-001" for d in sim.diagnostics))
        """,
        broken=True,
    )
    assert done.stdout.split() == ["3"], done.stderr
    assert done.stderr.count("SK-RENDER-001") == 1
    assert "libegl1 libgl1-mesa-dri" in done.stderr
