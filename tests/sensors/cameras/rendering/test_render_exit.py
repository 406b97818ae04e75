"""Exit, fork and spawn of a process that has drawn: no output and no hang."""

from __future__ import annotations

import ctypes.util
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from renderer import NEEDS_GL
from sensor_worlds import sensor, world

ROOT = Path(__file__).resolve().parents[4]
CAMERA = "<camera><image><width>32</width><height>24</height></image></camera>"
SENSORS = sensor("camera", CAMERA, name="c") + sensor("imu", "<imu/>", name="i")
WORLD = world(SENSORS)
GL_WORLD = world(SENSORS, top="<scene><simkit:renderer>gl</simkit:renderer></scene>")
START = """
import os, sys, threading
import simkit

def draw():
    sim = simkit.load(os.environ["SIMKIT_TEST_WORLD"])
    sim.run(0.02)
    try:
        return sim, sim.sensor("m::l::c").latest.data.max()
    except simkit.RenderError as error:
        return sim, error.code
"""


def run(script: str, **environment: str) -> subprocess.CompletedProcess[str]:
    kept = {k: v for k, v in os.environ.items() if k not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")}
    return subprocess.run(
        [sys.executable, "-c", START + textwrap.dedent(script)],
        env={**kept, "PYTHONPATH": str(ROOT), "SIMKIT_TEST_WORLD": WORLD, **environment},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )


@pytest.mark.slow
def test_an_interrupt_after_images_from_several_threads_is_the_only_message() -> None:
    done = run(
        """
        kept = [draw()]
        for _ in range(2):
            thread = threading.Thread(target=lambda: kept.append(draw()))
            thread.start()
            thread.join()
        kept[1][0].run(0.02)
        print(*[found for _, found in kept])
        raise KeyboardInterrupt
        """
    )
    assert done.stderr.splitlines()[-1] == "KeyboardInterrupt"
    assert "Error" not in done.stderr and done.stderr.count("Traceback") == 1


@NEEDS_GL
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.slow
def test_a_forked_child_reports_that_opengl_cannot_draw_and_continues() -> None:
    done = run(
        """
        sim, found = draw()
        print(found, flush=True)
        child = os.fork()
        if child == 0:
            forked, code = draw()
            forked.run(0.02)
            print(code, forked.sensor("m::l::i").latest is not None, flush=True)
            sys.exit(0)
        print(os.waitpid(child, 0)[1])
        sim.run(0.02)
        assert sim.sensor("m::l::c").latest is not None
        """,
        SIMKIT_TEST_WORLD=GL_WORLD,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[1:] == ["SK-RENDER-011 True", "0"]


@NEEDS_GL
@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork")
@pytest.mark.slow
def test_in_a_forked_child_a_new_simulation_draws_in_software_and_the_parents_one_not_at_all() -> None:
    done = run(
        """
        parent, found = draw()
        print(parent.engine.renderer.partition(" ")[0] != "software", flush=True)
        child = os.fork()
        if child == 0:
            forked, colour = draw()
            codes = [d.code for d in forked.diagnostics]
            print(forked.engine.renderer.partition(" ")[0], colour > 0, codes, flush=True)
            parent.run(0.02)
            try:
                parent.sensor("m::l::c").latest
            except simkit.RenderError as error:
                print(error.code, flush=True)
            sys.exit(0)
        print(os.waitpid(child, 0)[1])
        """
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["True", "software True ['SK-RENDER-015']", "SK-RENDER-011", "0"]


@NEEDS_GL
@pytest.mark.slow
def test_a_child_forked_before_the_first_image_draws_with_any_pyopengl_platform() -> None:
    done = run(
        """
        child = os.fork()
        sim, found = draw()
        print(found, flush=True)
        if child:
            print("child", os.waitpid(child, 0)[1], os.environ["PYOPENGL_PLATFORM"])
        """,
        PYOPENGL_PLATFORM="glx",
    )
    assert done.returncode == 0, done.stderr
    assert "child 0 glx" in done.stdout and "SK-RENDER" not in done.stdout


@pytest.mark.skipif(not ctypes.util.find_library("OSMesa"), reason="OSMesa is not installed")
def test_without_egl_osmesa_draws() -> None:
    broken = {"__EGL_VENDOR_LIBRARY_FILENAMES": "/nonexistent.json", "__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}
    done = run("print(draw()[1])", **broken)
    assert done.returncode == 0, done.stderr
    assert "SK-RENDER" not in done.stdout


@pytest.mark.parametrize(
    ("environment", "reason"),
    [
        ({"MUJOCO_GL": "glfw", "DISPLAY": "", "WAYLAND_DISPLAY": ""}, "no display"),
        ({"MUJOCO_EGL_DEVICE_ID": "77", "MUJOCO_GL": "egl"}, "egl"),
    ],
)
def test_a_renderer_that_cannot_work_is_one_error_with_its_reason(environment: dict[str, str], reason: str) -> None:
    done = run(
        """
        sim, code = draw()
        print(code, sim.sensor("m::l::i").latest is not None)
        try:
            sim.sensor("m::l::c").latest
        except simkit.RenderError as error:
            print(error)
        """,
        SIMKIT_TEST_WORLD=GL_WORLD,
        **environment,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("SK-RENDER-001 True")
    assert reason in done.stdout
