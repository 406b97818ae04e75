"""Conversions are kept on disk: the same numbers, made once, and never a reason to fail."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit.compiler.meshes import convex_decomposition as mesh_collision
from simkit.compiler.meshes.convex_decomposition import convex_bodies
from simkit.compiler.shape_geometry import polyline_triangles
from simkit.loaders.meshes import mesh_cache, mesh_reader
from simkit.loaders.meshes.mesh_cache import content_digest
from simkit.loaders.meshes.mesh_reader import convert_file, load_file
from simkit.scene import Polyline
from tests.loaders.meshes.mesh_makers import L_SHAPE, QUAD, binary_stl, picture

TRIANGLES = [[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 0, 0), (0, 1, 0), (0, 0, 1)]]


@pytest.fixture(autouse=True)
def forgotten():
    """Nothing is remembered in the process, so that what is on disk counts."""
    forget()


def forget():
    mesh_reader._converted.cache_clear()
    mesh_collision._memory.clear()


@pytest.fixture
def textured(tmp_path):
    picture(tmp_path / "p.png", (200, 0, 0), (0, 0, 200))
    (tmp_path / "m.mtl").write_text("newmtl m\nKd .5 .5 .5\nmap_Kd p.png\n")
    lines = ["v {:g} {:g} {:g}".format(*p) for p in QUAD] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    file = tmp_path / "t.obj"
    file.write_text("mtllib m.mtl\no board\nusemtl m\n" + "\n".join(lines) + "\nf 1/1 2/2 3/3 4/4\n")
    return file


def entries(cache, kind="meshes"):
    return sorted((cache / kind).glob("*"))


def never(*_):
    pytest.fail("converted again")


def test_what_comes_back_is_what_was_converted(textured, own_mesh_cache, monkeypatch):
    first = convert_file(textured)
    forget()
    monkeypatch.setattr(mesh_reader, "_convert", never)
    second = convert_file(textured)
    for a, b in zip(first.parts, second.parts, strict=True):
        assert (a.name, a.colour, a.specular, a.emission, a.aliases) == (
            b.name,
            b.colour,
            b.specular,
            b.emission,
            b.aliases,
        )
        for field in ("vertices", "faces", "uv", "texture"):
            x, y = getattr(a, field), getattr(b, field)
            assert x.dtype == y.dtype
            np.testing.assert_array_equal(x, y)
    assert first.notes == second.notes


def test_the_cache_knows_the_hash_of_a_texture(textured, own_mesh_cache):
    first = convert_file(textured).parts[0]
    forget()
    second = convert_file(textured).parts[0]
    assert first.texture_digest == ""
    assert second.texture_digest == content_digest(first.texture)


def test_a_changed_texture_or_library_is_converted_again(textured, own_mesh_cache):
    assert convert_file(textured).parts[0].texture[0, 0].tolist() == [200, 0, 0]
    picture(textured.with_name("p.png"), (0, 77, 0), (0, 0, 0), side=16)
    forget()
    assert convert_file(textured).parts[0].texture[0, 0].tolist() == [0, 77, 0]
    textured.with_name("p.png").unlink()
    forget()
    assert convert_file(textured).parts[0].texture is None
    picture(textured.with_name("p.png"), (9, 9, 9), (9, 9, 9))
    forget()
    assert convert_file(textured).parts[0].texture is not None


def test_equal_files_are_converted_once_wherever_they_lie(tmp_path, own_mesh_cache, monkeypatch):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "t.stl").write_bytes(binary_stl(TRIANGLES))
    load_file(tmp_path / "a" / "t.stl")
    monkeypatch.setattr(mesh_reader, "_convert", never)
    load_file(tmp_path / "b" / "t.stl")
    assert len(entries(own_mesh_cache)) == 1


def test_another_version_of_the_conversion_has_another_name(tmp_path, monkeypatch):
    file = tmp_path / "t.stl"
    before = mesh_cache.mesh_key(file, b"x")
    monkeypatch.setattr(mesh_cache, "FORMAT", "another")
    assert mesh_cache.mesh_key(file, b"x") != before


@pytest.mark.parametrize(
    "spoil",
    [
        lambda c: b"",
        lambda c: c[: len(c) // 2],
        lambda c: c[:-1],
        lambda c: c[:60] + b"?" + c[61:],
        lambda c: c[:-9] + b"?" + c[-8:],
        lambda c: b"another program's" + c,
    ],
    ids=["empty", "half", "a byte short", "other header", "other numbers", "foreign"],
)
def test_a_spoilt_entry_is_made_again(tmp_path, own_mesh_cache, spoil):
    file = tmp_path / "t.stl"
    file.write_bytes(binary_stl(TRIANGLES))
    first = load_file(file)[0]
    (entry,) = entries(own_mesh_cache)
    whole = entry.read_bytes()
    entry.write_bytes(spoil(whole))
    forget()
    np.testing.assert_array_equal(load_file(file)[0].vertices, first.vertices)
    assert entry.read_bytes() == whole


def test_the_whole_entry_of_another_mesh_under_this_name_is_made_again(tmp_path, own_mesh_cache):
    for name, scale in (("a", 1), ("b", 2)):
        triangles = [[tuple(scale * x for x in corner) for corner in triangle] for triangle in TRIANGLES]
        (tmp_path / f"{name}.stl").write_bytes(binary_stl(triangles))
    right = load_file(tmp_path / "a.stl")[0].vertices
    (entry,) = entries(own_mesh_cache)
    load_file(tmp_path / "b.stl")
    (other,) = set(entries(own_mesh_cache)) - {entry}
    entry.write_bytes(other.read_bytes())
    forget()
    np.testing.assert_array_equal(load_file(tmp_path / "a.stl")[0].vertices, right)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_or_a_device_in_the_cache_is_not_read(tmp_path, own_mesh_cache):
    file = tmp_path / "t.stl"
    file.write_bytes(binary_stl(TRIANGLES))
    right = load_file(file)[0].vertices
    (entry,) = entries(own_mesh_cache)
    for make in (os.mkfifo, lambda path: path.symlink_to("/dev/zero")):
        entry.unlink()
        make(entry)
        forget()
        np.testing.assert_array_equal(load_file(file)[0].vertices, right)
        assert entry.is_file()


def test_collision_bodies_are_kept_as_well(own_mesh_cache, monkeypatch):
    vertices, faces = polyline_triangles(Polyline((L_SHAPE,), 0.4))
    first = convex_bodies(vertices, faces, fixed=True)
    assert len(entries(own_mesh_cache, "collisions")) == 1
    forget()
    monkeypatch.setattr(mesh_collision, "_compute_bodies", never)
    second = convex_bodies(vertices, faces, fixed=True)
    assert (first.is_exact, first.findings) == (second.is_exact, second.findings)
    assert len(first.shapes) == len(second.shapes) > 4
    for (v, f), (w, g) in zip(first.shapes, second.shapes, strict=True):
        np.testing.assert_array_equal(v, w)
        np.testing.assert_array_equal(f, g)


def test_without_a_place_to_write_it_works_all_the_same(tmp_path, monkeypatch):
    file = tmp_path / "t.stl"
    file.write_bytes(binary_stl(TRIANGLES))
    (tmp_path / "a file").write_text("in the way")
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(tmp_path / "a file" / "cache"))
    assert len(load_file(file)[0].faces) == 2


def test_two_processes_at_once_get_the_same_and_leave_nothing_half_written(tmp_path, own_mesh_cache):
    rng = np.random.default_rng(1)
    file = tmp_path / "t.stl"
    file.write_bytes(binary_stl(rng.normal(size=(20_000, 3, 3))))
    script = tmp_path / "load.py"
    script.write_text(
        textwrap.dedent("""
            import hashlib, sys
            from pathlib import Path
            from simkit.loaders.meshes import mesh_reader
            for _ in range(5):
                mesh_reader._converted.cache_clear()
                part = mesh_reader.load_file(Path(sys.argv[1]))[0]
            print(hashlib.sha256(part.vertices.tobytes() + part.faces.tobytes()).hexdigest())
        """)
    )
    environment = {**os.environ, "PYTHONPATH": str(Path(simkit.__file__).parents[1])}
    runs = [
        subprocess.Popen([sys.executable, str(script), str(file)], stdout=subprocess.PIPE, text=True, env=environment)
        for _ in range(3)
    ]
    said = [run.communicate(timeout=120)[0] for run in runs]
    assert [run.returncode for run in runs] == [0, 0, 0]
    assert len(set(said)) == 1
    assert [e.suffix for e in entries(own_mesh_cache)] == [".bin"]
