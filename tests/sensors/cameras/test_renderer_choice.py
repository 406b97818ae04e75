"""Choice of the renderer: an option has priority over the file, the file over `auto`; `auto` draws on every machine."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from mcap.reader import make_reader
from renderer import NEEDS_GL
from sensor_worlds import box, sensor, world

import simkit
from simkit.run_spec import RunSpec
from simkit.sensors.cameras.renderer_choice import chosen_renderer
from simkit.testing.run_record.run_recorder import record_run

ROOT = Path(__file__).resolve().parents[3]
CAMERA = "<camera><image><width>32</width><height>24</height></image></camera>"
NAMES = {"MUJOCO_GL", "PYOPENGL_PLATFORM"}


def cameras(renderer: str = "", *, place: str = "scene", count: int = 1) -> str:
    """Return a world whose cameras look at a box, with the renderer that the scene or the world requests."""
    request = f"<simkit:renderer>{renderer}</simkit:renderer>" if renderer else ""
    top = f"<scene>{request}</scene>" if place == "scene" else request
    eyes = "".join(sensor("camera", CAMERA, name=f"c{n}") for n in range(count))
    return world(eyes, others=box("wall", "3 0 1 0 0 0", "0.1 4 4"), top=top)


def command(folder: Path, *words: str, gl: str = "disable") -> subprocess.CompletedProcess[str]:
    """Run a command in a process without OpenGL."""
    kept = {name: value for name, value in os.environ.items() if name not in NAMES}
    return subprocess.run(
        [sys.executable, "-m", "simkit", *words],
        env={**kept, "PYTHONPATH": str(ROOT), "MUJOCO_GL": gl},
        cwd=folder, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


def python(script: str, world: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a script in a process without OpenGL."""
    kept = {name: value for name, value in os.environ.items() if name not in NAMES}
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)],
        env={**kept, "PYTHONPATH": str(ROOT), "MUJOCO_GL": "disable", "SIMKIT_TEST_WORLD": world, **environment},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip


# ---------------------------------------------------------------------- priority


@pytest.mark.parametrize("place", ["scene", "world"])
def test_a_file_names_its_renderer(place: str) -> None:
    with simkit.load(cameras("software", place=place)) as sim:
        assert chosen_renderer(sim) == "software"
        sim.run(0.02)
        assert sim.sensor("m::l::c0").latest.data.max() > 0
        assert sim.engine.renderer.startswith("software (simkit, OpenCV ")


def test_an_option_has_priority_over_the_file() -> None:
    with simkit.load(cameras("gl"), renderer="software") as sim:
        assert chosen_renderer(sim) == "software"
    done = python(
        """
        import os, simkit
        with simkit.load(os.environ["SIMKIT_TEST_WORLD"], renderer="auto") as sim:
            sim.run(0.02)
            print(sim.sensor("m::l::c0").latest.data.max() > 0, sim.engine.renderer.partition(" ")[0])
        """,
        cameras("gl"),
    )
    assert done.stdout.split() == ["True", "software"], done.stderr


def test_an_override_sets_the_renderer_of_the_file() -> None:
    with simkit.load(cameras(), overrides=["scene.renderer=software"]) as sim:
        assert chosen_renderer(sim) == "software"


@NEEDS_GL
def test_with_opengl_auto_takes_it() -> None:
    with simkit.load(cameras()) as sim:
        assert chosen_renderer(sim) == "gl"
        assert sim.diagnostics == []


# ---------------------------------------------------------------------- without OpenGL


def test_without_opengl_auto_draws_in_software_and_says_so_once() -> None:
    done = python(
        """
        import os, simkit
        for _ in range(2):
            with simkit.load(os.environ["SIMKIT_TEST_WORLD"]) as sim:
                images = [sim.subscribe(f"/world/w/model/m/link/l/sensor/c{n}/image") for n in range(3)]
                sim.run(0.1)
                print(all(len(each.messages) == 11 for each in images), [(d.code, d.severity) for d in sim.diagnostics])
        """,
        cameras(count=3),
    )
    assert done.stdout.splitlines() == ["True [('SK-RENDER-015', 'note')]"] * 2, done.stderr
    (line,) = done.stderr.splitlines()
    assert "SK-RENDER-015" in line and "software renderer" in line and "MUJOCO_GL=disable" in line


def test_opengl_by_option_ends_the_load_without_it_and_names_the_ways_to_get_it() -> None:
    done = python(
        """
        import os, simkit
        try:
            simkit.load(os.environ["SIMKIT_TEST_WORLD"], renderer="gl")
        except simkit.RenderError as error:
            print(error.code, error.exit_code, error)
        """,
        '<sdf version="1.9"><world name="w"/></sdf>',
        MUJOCO_GL="egl",
        __EGL_VENDOR_LIBRARY_FILENAMES="/nonexistent.json",
        __EGL_VENDOR_LIBRARY_DIRS="/nonexistent",
    )
    assert done.stdout.startswith("SK-RENDER-001 2 "), done.stderr
    assert "libegl1 libopengl0 libgl1-mesa-dri" in done.stdout and "--renderer software" in done.stdout


@pytest.mark.parametrize("words", ["run w.sdf --duration 0.1", "golden record w.sdf --duration 0.1 -o g", "doctor"])
def test_a_command_that_requests_opengl_without_it_fails(words: str, tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(cameras())
    done = command(tmp_path, *words.split(), "--renderer", "gl")
    assert done.returncode == (1 if words == "doctor" else 2)
    assert (done.stdout + done.stderr).count("SK-RENDER-001") == 1
    assert "Traceback" not in done.stderr and not (tmp_path / "g").exists()


@pytest.mark.needs_packs
@pytest.mark.slow
def test_every_command_that_draws_works_without_opengl(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(cameras())
    image = "/world/w/model/m/link/l/sensor/c0/image"
    for words in (
        "run w.sdf --duration 0.05 --record a.mcap --picture a.png --gif a.gif",
        "golden record w.sdf --duration 0.05 -o g",
        "golden check g",
        f"bundle w.sdf --duration 0.05 --topic {image} -o a.zip",
        "replay a.zip",
        f"plot w.sdf {image}.width --duration 0.05 -o a.svg",
    ):
        done = command(tmp_path, *words.split())
        assert done.returncode == 0, f"{words}\n{done.stdout}{done.stderr}"
        assert done.stderr.count("SK-RENDER-015 images") <= 1, words
    with (tmp_path / "a.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    renderers = {one.topic: one.metadata.get("renderer", "") for one in summary.channels.values()}
    assert renderers[image].startswith("software (simkit, OpenCV ") and renderers["/clock"] == ""


# ---------------------------------------------------------------------- unknown names


def test_an_unknown_name_lists_the_allowed_ones(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="'auto', 'gl' or 'software', got 'vulkan'"):
        simkit.load(cameras(), renderer="vulkan")
    with pytest.raises(simkit.LoadError, match="expected one of auto, gl, software"):
        simkit.load(cameras("vulkan"))
    (tmp_path / "w.sdf").write_text(cameras())
    (tmp_path / "s.yaml").write_text("world: w.sdf\nrenderer: vulkan\n")
    for words, place in (
        ("run w.sdf --renderer vulkan", "--renderer"),
        ("bench w.sdf --renderer vulkan", "--renderer"),
        ("golden record s.yaml -o g", "s.yaml:2"),
    ):
        done = command(tmp_path, *words.split())
        assert not done.stdout
        assert done.returncode == 2 and place in done.stderr, done.stderr
        assert all(name in done.stderr for name in ("vulkan", "auto", "gl", "software"))


# ---------------------------------------------------------------------- records


def test_a_record_names_the_renderer_that_was_used_and_its_scenario_the_requested_one(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(cameras())
    record = record_run(RunSpec("w.sdf", duration=0.05, folder=tmp_path, options={"renderer": "software"}))
    assert record.simulation is not None
    record.simulation.close()
    assert record.fingerprint["renderer"].startswith("software (simkit, OpenCV ")
    assert not [path for path in record.leaves if "renderer" in path], "the fingerprint has it"


@NEEDS_GL
@pytest.mark.slow
def test_a_golden_run_in_software_passes_with_and_without_opengl(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(cameras())
    (tmp_path / "s.yaml").write_text("world: w.sdf\nduration: 0.05\nrenderer: software\n")
    assert command(tmp_path, "golden", "record", "s.yaml", "-o", "g", gl="").returncode == 0
    for gl in ("", "disable"):
        done = command(tmp_path, "golden", "check", "g", "--json", gl=gl)
        (found,) = json.loads(done.stdout)["results"]
        assert found["passed"] and found["tier"] == "exact" and not found["machine"], done.stdout


@pytest.mark.needs_packs
@pytest.mark.slow
def test_a_bundle_after_a_fallback_requests_software(tmp_path: Path) -> None:
    (tmp_path / "w.sdf").write_text(cameras())
    image = "/world/w/model/m/link/l/sensor/c0/image"
    done = command(tmp_path, "bundle", "w.sdf", "--duration", "0.05", "--topic", image, "-o", "a.zip")
    assert done.returncode == 0, done.stderr
    done = command(tmp_path, "replay", "a.zip", gl="")
    assert done.returncode == 0 and "identical" in done.stdout, done.stdout
