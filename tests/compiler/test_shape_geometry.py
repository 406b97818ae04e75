"""Shapes that are no primitives of the engine: height maps, outlines, pictures on primitives."""

from __future__ import annotations

import math
import struct

import mujoco
import numpy as np
import pytest
import trimesh
from PIL import Image

from simkit.compiler import SpecBuilder, geom_groups
from simkit.compiler.shape_geometry import heightmap_rows, polyline_pieces, polyline_triangles, textured_triangles
from simkit.diagnostics import Diagnostics
from simkit.loaders.meshes.mesh_part import MeshFileError
from simkit.pose import Pose
from simkit.scene import (
    Box,
    Capsule,
    Cone,
    Cylinder,
    Ellipsoid,
    Empty,
    Heightmap,
    Material,
    Plane,
    Polyline,
    SceneVisual,
    Sphere,
    Surface,
)
from tests.loaders.meshes.mesh_makers import L_SHAPE, picture

RAMP = np.linspace(0.0, 1.0, 65)
SLOPE = 0.2  # 2 m over 10 m


def ramp(folder, kind="u16", along="x"):
    """A picture that brightens towards +x, or towards its top row."""
    grey = np.tile(RAMP, (65, 1)) if along == "x" else np.tile(RAMP[::-1, None], (1, 65))
    file = folder / ("ramp.tif" if kind == "f32" else "ramp.png")
    if kind == "u16":
        Image.fromarray((grey * 65535).astype(np.uint16)).save(file)
    elif kind == "f32":
        Image.fromarray((grey * 123.0).astype(np.float32)).save(file)
    elif kind == "rgb":
        Image.fromarray((grey * 255).astype(np.uint8)).convert("RGB").save(file)
    else:
        Image.fromarray((grey * 255).astype(np.uint8)).save(file)
    return Heightmap(file, file.name, (10.0, 10.0, 2.0), (0.0, 0.0, 0.25))


def hill(make, shape):
    link = make.link("hill::l", shape, Pose((1.0, 2.0, 0.5)), Surface(mu=0.0, mu2=0.0))
    return make.model("hill", link, static=True)


def height_below(c, x, y):
    mujoco.mj_forward(c.model, c.data)
    mask = np.zeros(6, np.uint8)
    mask[geom_groups.COLLISION] = 1
    hit = np.array([-1], np.int32)
    return 9.0 - mujoco.mj_ray(c.model, c.data, np.array((x, y, 9.0)), np.array((0, 0, -1.0)), mask, 1, -1, hit, None)


@pytest.mark.parametrize(("kind", "tolerance"), [("u16", 1e-4), ("f32", 1e-4), ("u8", 0.008), ("rgb", 0.008)])
def test_rays_meet_a_slope_where_it_is(make, compiled, tmp_path, kind, tolerance):
    c = compiled(hill(make, ramp(tmp_path, kind)))
    for x in (-4.4, -1.3, 2.7, 4.9):
        for y in (-4.4, 0.1, 4.4):
            assert height_below(c, 1 + x, 2 + y) == pytest.approx(0.75 + SLOPE * (x + 5), abs=tolerance)


def test_the_top_row_of_the_picture_lies_at_plus_y(make, compiled, tmp_path):
    c = compiled(hill(make, ramp(tmp_path, along="y")))
    assert height_below(c, 1.0, 2.0 + 4.0) == pytest.approx(0.75 + SLOPE * 9, abs=1e-4)
    assert height_below(c, 1.0, 2.0 - 4.0) == pytest.approx(0.75 + SLOPE * 1, abs=1e-4)


def test_a_ball_slides_down_a_slope_as_the_formula_says(make, compiled, tmp_path):
    ball = make.solid("ball", Sphere(0.2), Pose((1.0, 2.0, 2.2)), surface=Surface(mu=0.0, mu2=0.0))
    c = compiled(hill(make, ramp(tmp_path)), ball)
    mujoco.mj_step(c.model, c.data, 1000)
    before = c.data.qvel[:3].copy()
    mujoco.mj_step(c.model, c.data, 500)
    angle = math.atan(SLOPE)
    expected = 9.8 * math.sin(angle) * np.array((-math.cos(angle), 0.0, -math.sin(angle)))
    np.testing.assert_allclose((c.data.qvel[:3] - before) / 0.5, expected, atol=0.03)
    x, _, z = c.data.qpos[:3]
    assert (z - (0.75 + SLOPE * (x - 1 + 5))) * math.cos(angle) == pytest.approx(0.2, abs=1e-3)


def test_heights_below_zero_keep_their_share(tmp_path):
    Image.fromarray(np.array([[-5.0, 0.0], [5.0, 10.0]], np.float32)).save(tmp_path / "deep.tif")
    rows = heightmap_rows(Heightmap(tmp_path / "deep.tif", "deep.tif"))
    np.testing.assert_allclose(rows, [[0.5, 1.0], [-0.5, 0.0]])


def wide_tiff(rows: np.ndarray) -> bytes:
    """Return a TIFF file of 64-bit floating-point numbers."""
    data, (height, width) = rows.astype("<f8").tobytes(), rows.shape
    tags = [(256, width), (257, height), (258, 64), (259, 1), (262, 1), (273, 8), (277, 1), (278, height)]
    tags += [(279, len(data)), (339, 3)]
    directory = b"".join(struct.pack("<HHII", tag, 4 if tag in (273, 278, 279) else 3, 1, v) for tag, v in tags)
    header = b"II*\0" + struct.pack("<I", 8 + len(data))
    return header + data + struct.pack("<H", len(tags)) + directory + struct.pack("<I", 0)


def test_a_tiff_with_numbers_of_64_bits_is_read(tmp_path, capfd):
    heights = np.array([[0.0, 25.0], [50.0, 100.0]])
    (tmp_path / "h.tif").write_bytes(wide_tiff(heights))
    np.testing.assert_array_equal(heightmap_rows(Heightmap(tmp_path / "h.tif", "h.tif")), [[0.5, 1.0], [0.0, 0.25]])
    (tmp_path / "cut.tif").write_bytes(wide_tiff(heights)[:60])
    with pytest.raises(MeshFileError, match="damaged"):
        heightmap_rows(Heightmap(tmp_path / "cut.tif", "cut.tif"))
    small, large = struct.pack("<HHII", 256, 3, 1, 2), struct.pack("<HHII", 256, 4, 1, 1 << 30)
    (tmp_path / "wide.tif").write_bytes(wide_tiff(heights).replace(small, large))
    with pytest.raises(MeshFileError, match="at most"):
        heightmap_rows(Heightmap(tmp_path / "wide.tif", "wide.tif"))
    assert capfd.readouterr().err == ""


def test_a_heightmap_on_what_moves_is_an_error(make, tmp_path):
    found = Diagnostics()
    SpecBuilder(make.world(make.solid("m", ramp(tmp_path))), found)
    assert [d.code for d in found] == ["SK-MESH-010"]


@pytest.mark.parametrize("content", [b"", b"GIF89a", b"\x89PNG\r\n\x1a\n" + b"\0" * 40, b"ncols 4\nnrows 4\n1 2 3 4"])
def test_a_picture_that_is_none_is_an_error(tmp_path, content):
    (tmp_path / "h.png").write_bytes(content)
    with pytest.raises(MeshFileError, match="cannot be read|smaller"):
        heightmap_rows(Heightmap(tmp_path / "h.png", "h.png"))


def test_a_picture_that_is_too_large_is_refused_by_its_header(tmp_path):
    import struct
    import zlib

    header = b"IHDR" + struct.pack(">IIBBBBB", 50_000, 50_000, 8, 0, 0, 0, 0)
    content = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + header + struct.pack(">I", zlib.crc32(header))
    (tmp_path / "h.png").write_bytes(content + struct.pack(">I", 0) + b"IDAT" + struct.pack(">I", zlib.crc32(b"IDAT")))
    with pytest.raises(MeshFileError, match="4097|cannot be read"):
        heightmap_rows(Heightmap(tmp_path / "h.png", "h.png"))


# ---------------------------------------------------------------------- outlines

RING = (
    ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)),
    ((1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)),
)


@pytest.mark.parametrize(
    ("outlines", "area"),
    [
        ((L_SHAPE,), 0.51),
        ((L_SHAPE[::-1],), 0.51),
        (RING, 12.0),
        ((*RING, ((1.5, 1.5), (2.5, 1.5), (2.5, 2.5), (1.5, 2.5))), 13.0),
        ((((0, 0), (1, 0), (1, 1)), ((5, 5), (7, 5), (7, 7), (5, 7), (5, 5))), 4.5),
    ],
    ids=["L", "the other way round", "a hole", "an island in the hole", "two apart"],
)
def test_an_outline_falls_into_convex_pieces_that_are_all_of_it(outlines, area):
    shape = Polyline(outlines, 2.0)
    vertices, faces = polyline_triangles(shape)
    assert trimesh.Trimesh(vertices, faces).volume == pytest.approx(2 * area)
    pieces = polyline_pieces(shape)
    assert sum(trimesh.convex.convex_hull(p).volume for p in pieces) == pytest.approx(2 * area)


def test_a_hole_in_an_outline_lets_a_ball_through(make, compiled):
    plate = make.model("plate", make.link("plate::l", Polyline(RING, 0.2)), static=True)
    balls = [make.solid(f"b{i}", Sphere(0.2), Pose((x, 2.0, 1.0))) for i, x in enumerate((0.5, 2.0))]
    c = compiled(make.ground(), plate, *balls)
    mujoco.mj_step(c.model, c.data, 2000)
    assert c.data.qpos[2] == pytest.approx(0.4, abs=2e-3)
    assert c.data.qpos[9] == pytest.approx(0.2, abs=2e-3)


def test_outlines_that_enclose_nothing_are_an_error(make):
    found = Diagnostics()
    SpecBuilder(make.world(make.solid("m", Polyline((((0, 0), (1, 0), (2, 0)),), 1.0))), found)
    assert [d.code for d in found] == ["SK-MESH-009"]


# ---------------------------------------------------------------------- primitives


@pytest.mark.parametrize(
    ("shape", "volume", "tolerance"),
    [
        (Box((1, 2, 3)), 6.0, 1e-12),
        (Sphere(0.5), 4 / 3 * math.pi / 8, 3e-3),
        (Ellipsoid((1, 2, 3)), 8 * math.pi, 3e-3),
        (Cylinder(0.5, 2.0), math.pi / 2, 1e-3),
        (Capsule(0.5, 1.0), math.pi / 4 + math.pi / 6, 3e-3),
    ],
)
def test_what_wears_a_picture_has_the_shape_it_had(shape, volume, tolerance):
    part = textured_triangles(shape)
    mesh = trimesh.Trimesh(part.vertices, part.faces, process=True)
    mesh.merge_vertices(merge_tex=True, merge_norm=True)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(volume, rel=tolerance)
    assert part.uv.min() >= -1e-12 and part.uv.max() <= 1 + 1e-12


def test_a_picture_stands_upright_on_every_side_of_a_box():
    part = textured_triangles(Box((2.0, 2.0, 2.0)))
    for side in range(4):
        z, v = part.vertices[4 * side : 4 * side + 4, 2], part.uv[4 * side : 4 * side + 4, 1]
        np.testing.assert_allclose(z, 2 * v - 1)


def test_a_box_with_a_picture_is_drawn_with_it_and_one_without_stays_a_box(make, compiled, tmp_path):
    picture(tmp_path / "p.png", (250, 0, 0), (0, 0, 250))
    worn = SceneVisual("v", "m::l::v", Pose(), Box((1, 1, 1)), Material(texture=tmp_path / "p.png"))
    plain = SceneVisual("w", "m::l::w", Pose(), Box((1, 1, 1)), Material())
    c = compiled(make.model("m", make.link("m::l", visuals=(worn, plain))))
    kinds = [int(c.model.geom_type[g]) for g in c.names.link("m::l").visuals]
    assert kinds == [int(mujoco.mjtGeom.mjGEOM_MESH), int(mujoco.mjtGeom.mjGEOM_BOX)]
    assert c.model.ntex == 1


@pytest.mark.parametrize(
    "shape",
    [Box((0.4, 0.4, 0.4)), Sphere(0.2), Cylinder(0.2, 0.4), Cone(0.2, 0.4), Ellipsoid((0.3, 0.3, 0.2))],
    ids=lambda s: type(s).__name__,
)
def test_every_shape_rests_on_the_ground_at_half_its_height(make, compiled, shape):
    c = compiled(make.ground(), make.solid("m", shape, Pose((0, 0, 0.205))))
    mujoco.mj_step(c.model, c.data, 500)
    assert c.data.qpos[2] == pytest.approx(0.2, abs=1e-3)


def test_nothing_is_made_of_an_empty_shape(make, compiled):
    c = compiled(make.model("m", make.link("m::l", Empty())))
    assert c.model.ngeom == 0


def test_a_drawn_mesh_without_area_is_left_out_with_a_word(make, compiled, tmp_path):
    from simkit.scene import Mesh

    (tmp_path / "line.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    visual = SceneVisual("v", "m::l::v", Pose(), Mesh(tmp_path / "line.obj", "line.obj"))
    c = compiled(
        make.model("m", make.link("m::l", visuals=(visual,))), make.model("n", make.link("n::l", Plane()), static=True)
    )
    assert [d.code for d in c.builder.diagnostics] == ["SK-MESH-013"]
    assert not c.names.link("m::l").visuals
