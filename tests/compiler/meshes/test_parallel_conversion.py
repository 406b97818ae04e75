"""Conversion of mesh files in several processes: same results, and only where it saves time."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

import simkit
from simkit.compiler.meshes import parallel_conversion

WORLD = """<sdf version="1.9"><world name="w">{}</world></sdf>"""
MODEL = """<model name="{0}"><static>{1}</static><link name="l">
  <collision name="c"><geometry><mesh><uri>{0}.stl</uri></mesh></geometry></collision>
  <visual name="v"><geometry><mesh><uri>{0}.stl</uri></mesh></geometry></visual></link></model>"""


@pytest.fixture
def world(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A world of two static rings and a moving one, on a computer of two cores, with an empty cache."""
    monkeypatch.setattr(parallel_conversion, "_core_count", lambda: 2)
    monkeypatch.setattr(parallel_conversion, "LEAST_BYTES", 1000)
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(tmp_path / "cache"))
    models = ""
    for number, name in enumerate(("a", "b", "c")):
        ring = trimesh.creation.torus(0.5 + 0.1 * number, 0.1, major_sections=12, minor_sections=6)
        ring.export(tmp_path / f"{name}.stl")
        models += MODEL.format(name, "false" if name == "c" else "true")
    file = tmp_path / "w.sdf"
    file.write_text(WORLD.format(models), "utf-8")
    return file


@pytest.mark.slow
def test_the_processes_fill_the_cache_and_the_world_has_the_same_bits(
    world: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[int] = []
    convert = parallel_conversion._run_processes
    monkeypatch.setattr(parallel_conversion, "_run_processes", lambda s: (started.append(len(s)), convert(s)))
    compiled = []
    for folder, cores in (("cache", 2), ("cache", 2), ("other", 1)):
        monkeypatch.setattr(parallel_conversion, "_core_count", lambda cores=cores: cores)
        monkeypatch.setenv("SIMKIT_CACHE_DIR", str(world.parent / folder))
        with simkit.load(world) as sim:
            model = sim.mj_model
            compiled.append([np.array(getattr(model, f)) for f in ("mesh_vert", "geom_pos", "geom_size")])
    assert started == [2]  # the second load found the cache filled, and one core starts no process
    assert all(np.array_equal(x, y) for other in compiled[1:] for x, y in zip(compiled[0], other, strict=True))


@pytest.mark.slow
def test_the_processes_write_meshes_and_collision_bodies(world: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with simkit.load(world) as sim:
        cache = world.parent / "new"
        monkeypatch.setenv("SIMKIT_CACHE_DIR", str(cache))
        assert parallel_conversion.convert_meshes(sim.engine.world.models) == 2
    assert [len(list((cache / kind).iterdir())) for kind in ("meshes", "collisions")] == [3, 3]


@pytest.mark.slow
def test_a_broken_file_is_reported_as_without_processes(world: Path) -> None:
    (world.parent / "b.stl").write_bytes(b"solid nothing" * 200)
    with simkit.load(world) as sim:
        assert [d.message.split(":")[0] for d in sim.diagnostics if d.code == "SK-MESH-001"] == ["b.stl"]


def test_a_cache_that_cannot_be_written_starts_no_process(world: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (world.parent / "file").write_text("", "utf-8")
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(world.parent / "file" / "cache"))
    monkeypatch.setattr(parallel_conversion, "_run_processes", lambda _: pytest.fail("a process was started"))
    simkit.load(world).close()
