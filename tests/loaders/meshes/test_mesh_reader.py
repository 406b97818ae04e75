"""Mesh files, non-convex statics, looks."""

from __future__ import annotations

import math
import os
from pathlib import Path

import mujoco
import numpy as np
import pytest
import trimesh

from simkit.compiler import SpecBuilder, geom_groups
from simkit.compiler.shape_geometry import polyline_triangles
from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.loaders.meshes.mesh_part import join_parts
from simkit.loaders.meshes.mesh_reader import load_file, load_mesh
from simkit.pose import IDENTITY, Pose
from simkit.scene import Box, Material, Mesh, Polyline, SceneVisual, Sphere

DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="inch" meter="0.0254"/><up_axis>Y_UP</up_axis></asset>
<library_effects><effect id="E"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>1 0.5 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="M"><instance_effect url="#E"/></material></library_materials>
<library_geometries><geometry id="G"><mesh>
<source id="P"><float_array id="PA" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array><technique_common>
<accessor source="#PA" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="V"><input semantic="POSITION" source="#P"/></vertices>
<triangles count="4" material="S"><input semantic="VERTEX" source="#V" offset="0"/>
<p>0 2 1 0 1 3 1 2 3 0 3 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="W"><node id="N" name="part"><instance_geometry url="#G"><bind_material>
<technique_common><instance_material symbol="S" target="#M"/></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#W"/></scene></COLLADA>"""


@pytest.fixture
def dae(tmp_path):
    file = tmp_path / "t.dae"
    file.write_text(DAE)
    return file


def ring(folder: Path, inner=1.0, outer=1.2, height=0.5) -> Path:
    """A hollow wall around the origin, not convex."""
    file = folder / "ring.stl"
    trimesh.creation.annulus(inner, outer, height, sections=16).export(file)
    return file


def bowl(folder: Path) -> Path:
    """An open box without lid and without thickness: five squares that face up and inwards."""
    box = trimesh.creation.box((1.0, 1.0, 0.4))
    keep = box.face_normals[:, 2] < 0.5
    shell = trimesh.Trimesh(box.vertices, box.faces[keep][:, ::-1], process=False)
    file = folder / "bowl.stl"
    shell.export(file)
    return file


def static_mesh(make, file, pose=IDENTITY, scale=(1.0, 1.0, 1.0)):
    return make.model("arena", make.link("arena::link", Mesh(file, file.name, scale), pose), static=True)


def test_collada_units_count_and_its_up_axis_does_not(dae):
    (part,) = load_file(dae)
    np.testing.assert_allclose(np.ptp(part.vertices, axis=0), np.array([1, 2, 3]) * 0.0254)
    assert part.colour == pytest.approx((1, 0.5, 0, 1), abs=1e-2)


def test_scale_mirrors_without_turning_the_mesh_inside_out(dae):
    parts = load_mesh(Mesh(dae, "t.dae", (-1.0, 2.0, 1.0)), Diagnostics(), NOWHERE)
    vertices, faces = join_parts(parts)
    assert trimesh.Trimesh(vertices, faces).volume == pytest.approx(2.0 * 0.0254**3, rel=1e-6)


def test_a_submesh_is_known_by_its_node_and_a_missing_one_is_left_out(dae):
    assert len(load_mesh(Mesh(dae, "t.dae", submesh="part"), Diagnostics(), NOWHERE)) == 1
    centred = load_mesh(Mesh(dae, "t.dae", submesh="part", center=True), Diagnostics(), NOWHERE)[0].vertices
    np.testing.assert_allclose(centred.min(axis=0), -centred.max(axis=0))
    found = Diagnostics()
    assert load_mesh(Mesh(dae, "t.dae", submesh="prt"), found, NOWHERE) == []
    assert [d.code for d in found] == ["SK-MESH-001"]
    assert "'part'" in next(iter(found)).message


def test_a_broken_file_is_left_out_with_a_warning(tmp_path):
    file = tmp_path / "bad.stl"
    file.write_bytes(b"solid nothing")
    found = Diagnostics()
    assert load_mesh(Mesh(file, "bad.stl"), found, NOWHERE) == []
    assert [(d.code, d.severity) for d in found] == [("SK-MESH-001", "warning")]


@pytest.mark.parametrize("suffix", [".dae", ".obj", ".stl", ".glb"])
def test_a_pointer_of_git_lfs_in_place_of_a_mesh_is_named(tmp_path, suffix):
    file = tmp_path / f"body{suffix}"
    file.write_bytes(b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 141935\n")
    found = Diagnostics()
    assert load_mesh(Mesh(file, file.name), found, NOWHERE) == []
    assert "is a pointer of Git LFS; the content was not fetched (git lfs pull)" in next(iter(found)).message


def test_the_cache_gives_the_same_and_does_without(dae, own_mesh_cache, monkeypatch):
    from simkit.loaders.meshes import mesh_reader

    first = load_file(dae)[0]
    assert len(list((own_mesh_cache / "meshes").glob("*.bin"))) == 1
    mesh_reader._converted.cache_clear()
    monkeypatch.setattr(mesh_reader, "_convert", lambda *_: pytest.fail("converted again"))
    second = load_file(dae)[0]
    np.testing.assert_array_equal(first.vertices, second.vertices)
    assert first.colour == second.colour
    monkeypatch.undo()
    mesh_reader._converted.cache_clear()
    monkeypatch.setenv("SIMKIT_CACHE_DIR", os.devnull)
    assert len(load_file(dae)[0].faces) == 4


def test_a_box_dropped_into_an_open_bowl_is_held(make, compiled, tmp_path):
    box = make.solid("box", Box((0.2, 0.2, 0.2)), Pose((0.05, 0.02, 0.3)))
    c = compiled(static_mesh(make, bowl(tmp_path)), box)
    mujoco.mj_step(c.model, c.data, 2000)
    np.testing.assert_allclose(c.data.qpos[:3], (0.05, 0.02, -0.2 + 0.1), atol=2e-3)
    assert abs(c.data.qvel).max() < 1e-3


def test_a_body_inside_a_ring_is_not_inside_its_hull(make, compiled, tmp_path):
    c = compiled(make.ground(), static_mesh(make, ring(tmp_path)), make.solid("ball", Sphere(0.1), Pose((0, 0, 0.1))))
    mujoco.mj_step(c.model, c.data, 500)
    np.testing.assert_allclose(c.data.qpos[:3], (0, 0, 0.1), atol=1e-3)


@pytest.mark.parametrize("outer_wall", [False, True])
def test_a_closed_room_holds_what_is_inside(make, compiled, tmp_path, outer_wall):
    room = trimesh.creation.icosphere(subdivisions=2, radius=1.0)
    room.invert()
    if outer_wall:
        room = trimesh.util.concatenate([room, trimesh.creation.box((2.4, 2.4, 2.4))])
    file = tmp_path / f"room{outer_wall}.stl"
    room.export(file)
    c = compiled(static_mesh(make, file), make.solid("ball", Sphere(0.1), Pose((0.2, 0.1, 0))))
    mujoco.mj_step(c.model, c.data, 5000)
    assert 0.8 < np.linalg.norm(c.data.qpos[:3]) < 0.91
    assert c.data.qpos[2] < -0.8


@pytest.mark.parametrize("heading", [0.0, 0.2, 1.0])
def test_a_thrown_ball_does_not_pass_a_thin_wall(make, compiled, tmp_path, heading):
    wall = ring(tmp_path, 1.0, 1.02)
    ball = make.solid("ball", Sphere(0.05), gravity=False)
    c = compiled(static_mesh(make, wall), ball)
    c.data.qvel[:3] = 5 * math.cos(heading), 5 * math.sin(heading), 0.0
    far = 0.0
    for _ in range(1500):
        mujoco.mj_step(c.model, c.data)
        far = max(far, float(np.hypot(*c.data.qpos[:2])))
    assert 0.9 < far < 1.0


def test_rays_see_the_exact_mesh_and_contacts_the_pieces(make, compiled, tmp_path):
    c = compiled(static_mesh(make, ring(tmp_path)))
    binding = c.names.link("arena::link")
    assert {int(c.model.geom_group[g]) for g in binding.geoms} == {geom_groups.COLLISION_CONTACT}
    (copy,) = binding.ray_geoms
    assert c.model.geom_group[copy] == geom_groups.COLLISION_RAY
    assert c.model.geom_contype[copy] == 0
    mask = np.zeros(6, np.uint8)
    mask[[geom_groups.COLLISION, geom_groups.COLLISION_RAY]] = 1
    mujoco.mj_forward(c.model, c.data)
    hit = np.array([-1], np.int32)
    heading, half = 0.1, math.pi / 16
    towards = np.array([math.cos(heading), math.sin(heading), 0.05])
    distance = mujoco.mj_ray(c.model, c.data, np.zeros(3), towards, mask, 1, -1, hit, None)
    assert hit[0] == copy
    assert distance == pytest.approx(math.cos(half) / math.cos(heading - half), abs=1e-5)
    assert "SK-MESH-006" in [d.code for d in c.builder.diagnostics]


def test_a_moving_non_convex_mesh_is_reported(make, compiled, tmp_path):
    file = ring(tmp_path)
    c = compiled(make.solid("hoop", Mesh(file, "ring.stl"), Pose((0, 0, 2))))
    assert "SK-MESH-004" in [d.code for d in c.builder.diagnostics]
    assert len(c.names.link("hoop::link").geoms) == 1


def test_a_flat_mesh_is_drawn_and_collides_as_a_plate(make, compiled, tmp_path):
    file = tmp_path / "flat.obj"
    file.write_text("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n")
    visual = SceneVisual("v", "arena::link::v", Pose(), Mesh(file, "flat.obj"), Material(diffuse=(1, 0, 0, 0.5)))
    floor = make.model("arena", make.link("arena::link", Mesh(file, "flat.obj"), visuals=(visual,)), static=True)
    c = compiled(floor, make.solid("ball", Sphere(0.1), Pose((0.3, 0.2, 0.3))))
    mujoco.mj_step(c.model, c.data, 1500)
    assert c.data.qpos[2] == pytest.approx(0.1, abs=1e-3)
    (drawn,) = c.names.link("arena::link").visuals
    np.testing.assert_allclose(c.model.geom_rgba[drawn], (1, 0, 0, 0.5), atol=1e-6)
    assert "SK-MESH-007" in [d.code for d in c.builder.diagnostics]


def test_a_texture_travels_with_its_coordinates(make, compiled, tmp_path):
    from PIL import Image

    Image.new("RGB", (4, 2), (10, 200, 30)).save(tmp_path / "paint.png")
    (tmp_path / "t.mtl").write_text("newmtl m\nmap_Kd paint.png\n")
    (tmp_path / "t.obj").write_text(
        "mtllib t.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n"
    )
    visual = SceneVisual("v", "m::a::v", Pose(), Mesh(tmp_path / "t.obj", "t.obj"))
    c = compiled(make.model("m", make.link("m::a", visuals=(visual,))))
    assert (c.model.ntex, c.model.tex_height[0], c.model.tex_width[0]) == (1, 2, 4)
    np.testing.assert_array_equal(c.model.tex_data[:3], (10, 200, 30))
    np.testing.assert_allclose(c.model.mesh_texcoord[:3], [(0, 1), (1, 1), (1, 0)])


def test_a_mesh_without_coordinates_has_the_mean_colour_of_a_texture(make, compiled, tmp_path):
    from PIL import Image

    Image.fromarray(np.array([[[51, 102, 0], [51, 0, 0]]], np.uint8)).save(tmp_path / "paint.png")
    (tmp_path / "t.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")
    material = Material(diffuse=(1.0, 0.5, 1.0, 0.8), texture=tmp_path / "paint.png")
    visual = SceneVisual("v", "m::a::v", Pose(), Mesh(tmp_path / "t.obj", "t.obj"), material)
    model = compiled(make.model("m", make.link("m::a", visuals=(visual,)))).model
    assert model.ntex == 0
    np.testing.assert_allclose(model.geom_rgba[0], (0.2, 0.1, 0.0, 0.8), atol=1e-6)


def test_a_polyline_is_extruded(make, compiled):
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 0.3), (0.0, 1.0))
    model = make.model("arena", make.link("arena::link", Polyline((outline,), 0.5)), static=True)
    c = compiled(model, make.solid("ball", Sphere(0.05), Pose((0.5, 0.15, 1.0))))
    mujoco.mj_step(c.model, c.data, 1500)
    assert c.data.qpos[2] == pytest.approx(0.55, abs=2e-3)


def test_an_outline_inside_another_is_a_hole():
    square = ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0))
    hole = ((0.5, 0.5), (1.5, 0.5), (1.5, 1.5), (0.5, 1.5), (0.5, 0.5))
    vertices, faces = polyline_triangles(Polyline((hole, square), 0.5))
    mesh = trimesh.Trimesh(vertices, faces)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx((4.0 - 1.0) * 0.5)


def test_equal_meshes_are_stored_once(make, compiled, dae):
    models = [make.solid(f"m{i}", Mesh(dae, "t.dae", (10, 10, 10)), Pose((i, 0, 0))) for i in range(3)]
    assert compiled(*models).model.nmesh == 1


def test_a_collision_with_an_unreadable_mesh_is_left_out_of_a_world_that_compiles(make, tmp_path):
    found = Diagnostics()
    SpecBuilder(make.world(make.solid("m", Mesh(tmp_path / "no.stl", "no.stl"))), found)
    assert not found.has_errors
    assert next(iter(found)).code == "SK-MESH-001"


def test_a_mesh_with_coordinates_beyond_all_reach_is_left_out(make, tmp_path):
    (tmp_path / "far.obj").write_text("v 1e300 0 0\nv 1 0 1e300\nv 0 1 0\nv 0 0 1e38\nf 1 2 3\nf 1 2 4\n")
    diagnostics = Diagnostics()
    load_mesh(Mesh(tmp_path / "far.obj", "far.obj"), diagnostics, NOWHERE)
    assert [d.code for d in diagnostics] == ["SK-MESH-001"]
