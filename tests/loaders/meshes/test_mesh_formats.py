"""Mesh files: what each format says arrives as it says it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import trimesh

from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.loaders.meshes.mesh_part import MeshFileError, join_parts
from simkit.loaders.meshes.mesh_reader import convert_file, load_file, load_mesh
from simkit.scene import Mesh
from tests.loaders.meshes.mesh_makers import (
    PLACED,
    QUAD,
    TETRAHEDRON,
    TETRAHEDRON_FACES,
    binary_stl,
    collada,
    gltf,
    picture,
    write_glb,
    write_gltf,
)

TRIANGLES = np.array(TETRAHEDRON)[np.array(TETRAHEDRON_FACES)]
EXTENT = (1.0, 2.0, 3.0)
RED = (1.0, 0.0, 0.0, 1.0)


def extent(parts):
    return np.ptp(join_parts(parts)[0], axis=0)


def volume(parts):
    return trimesh.Trimesh(*join_parts(parts), process=False).volume


def written(tmp_path, name, text):
    file = tmp_path / name
    file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return file


# ---------------------------------------------------------------------- STL


def ascii_stl(name="part"):
    facets = "".join(
        "facet normal 0 0 0\n outer loop\n"
        + "".join(f"  vertex {x:g} {y:g} {z:g}\n" for x, y, z in t)
        + " endloop\nendfacet\n"
        for t in TRIANGLES
    )
    return f"solid {name}\n{facets}endsolid {name}\n"


@pytest.mark.parametrize(
    "content",
    [
        binary_stl(TRIANGLES),
        binary_stl(TRIANGLES, b"solid made by a program that does not know better"),
        binary_stl(TRIANGLES) + b"left behind",
        ascii_stl().encode(),
        ascii_stl().upper().replace("SOLID PART", "solid part").encode(),
        ascii_stl().replace("\n", "\r\n").encode(),
    ],
    ids=["binary", "binary that begins with solid", "with a tail", "ascii", "in capitals", "of windows"],
)
def test_stl_is_known_by_its_content_and_its_corners_are_joined(tmp_path, content):
    parts = load_file(written(tmp_path, "t.stl", content))
    assert [len(p.faces) for p in parts] == [4]
    assert len(parts[0].vertices) == 4
    np.testing.assert_allclose(extent(parts), EXTENT)
    assert volume(parts) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("content", "says"),
    [
        (binary_stl(TRIANGLES, promised=10**9), "declares 1000000000 triangles, it has 4"),
        (binary_stl(TRIANGLES)[:-30], "declares 4 triangles, it has 3"),
        (binary_stl(TRIANGLES)[:60], "has no triangles"),
        (b"", "has no triangles"),
        (b"solid x\nfacet\nvertex 0 0 0\nvertex 1 0 0\nendsolid", "2 corners"),
        (b"solid x\nfacet\nvertex a b c\nendsolid", "not a number"),
        (binary_stl([[(0, 0, 0), (1, 0, math.nan), (0, 1, 0)]]), "NaN or infinite"),
        (binary_stl([[(0, 0, 0), (1, 0, 1e38), (0, 1, 0)]]), "beyond"),
    ],
)
def test_a_broken_stl_says_what_is_wrong_with_it(tmp_path, content, says):
    with pytest.raises(MeshFileError, match=says):
        load_file(written(tmp_path, "t.stl", content))


# ---------------------------------------------------------------------- OBJ

OBJ = """mtllib m.mtl
o body
v 0 0 0
v 1 0 0
v 0 2 0
v 0 0 3
usemtl red
f 1 3 2
f 1 2 4
g lid
usemtl glass
f 2 3 4
f 1 4 3
"""


def test_obj_groups_and_materials_become_parts(tmp_path):
    written(tmp_path, "m.mtl", "newmtl red\nKd 1 0 0\nKs .4 .5 .1\nKe .5 .5 .5\n\nnewmtl glass\nKd 0 0 1\nd 0.25\n")
    body, lid = load_file(written(tmp_path, "t.obj", OBJ))
    assert (body.name, lid.name) == ("body", "lid")
    assert body.colour == RED
    assert (body.specular, body.emission) == (0.5, pytest.approx(0.5))
    assert lid.colour == (0.0, 0.0, 1.0, 0.25)
    assert volume([body, lid]) == pytest.approx(1.0)
    assert [len(p.faces) for p in load_file(tmp_path / "t.obj", "lid")] == [2]


def test_obj_counts_from_the_end_fans_polygons_and_reads_past_what_it_does_not_use(tmp_path):
    text = """# a comment
v 0 0 0 1.0 0.5 0.5
v 1 0 0 1.0 0.5 0.5
v 1 1 0 1.0 0.5 0.5
v 0 1 0 1.0 0.5 0.5
vn 0 0 1
vt 0 0 0
vt 1 0
s 1
l 1 2
f -4//1 -3//1 \\
 -2//1 -1//1
"""
    (part,) = load_file(written(tmp_path, "t.obj", text))
    assert part.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert part.uv is None


def test_an_obj_corner_with_two_texture_coordinates_becomes_two(tmp_path):
    text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt .5 .5\nf 1/1 2/2 3/3\nf 1/4 3/3 4/2\n"
    (part,) = load_file(written(tmp_path, "t.obj", text))
    assert len(part.vertices) == 5
    np.testing.assert_allclose(part.uv[part.faces], [[(0, 0), (1, 0), (1, 1)], [(0.5, 0.5), (1, 1), (1, 0)]])


def test_an_obj_library_that_is_missing_is_said_once_and_the_shape_is_kept(tmp_path):
    found = Diagnostics()
    mesh = Mesh(written(tmp_path, "t.obj", OBJ), "t.obj")
    for _ in range(3):
        assert len(load_mesh(mesh, found, NOWHERE)) == 2
    assert [d.code for d in found] == ["SK-MESH-012"]
    assert "m.mtl is not found" in next(iter(found)).message


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("f 1 2 9", "vertex 9; there are 4"),
        ("f 0 1 2", "vertex 0"),
        ("f 1 2 x", "not a number"),
        ("f 1// 2// /3/", "corner"),
    ],
)
def test_an_obj_face_without_its_vertices_is_an_error(tmp_path, line, says):
    with pytest.raises(MeshFileError, match=says):
        load_file(written(tmp_path, "t.obj", OBJ + line + "\n"))


# ---------------------------------------------------------------------- COLLADA


def test_collada_nodes_place_turn_and_stretch(tmp_path):
    inner = f'<node name="inner"><rotate>0 0 1 90</rotate><scale>2 1 1</scale>{PLACED}</node>'
    text = collada(f'<node name="outer"><translate>10 0 0</translate>{inner}</node>', unit="0.01")
    (part,) = load_file(written(tmp_path, "t.dae", text))
    assert (part.name, part.colour) == ("inner", RED)
    low, high = part.vertices.min(axis=0), part.vertices.max(axis=0)
    np.testing.assert_allclose(low, np.array((10 - 2, 0, 0)) * 0.01, atol=1e-12)
    np.testing.assert_allclose(high, np.array((10, 2, 3)) * 0.01, atol=1e-12)


def test_a_collada_matrix_that_mirrors_keeps_the_outside_outside(tmp_path):
    text = collada(f'<node name="n"><matrix>-1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</matrix>{PLACED}</node>')
    parts = load_file(written(tmp_path, "t.dae", text))
    assert volume(parts) == pytest.approx(1.0)


def test_collada_nodes_in_a_library_and_skins_are_placed(tmp_path):
    library = (
        f'<library_nodes><node id="L" name="shared">{PLACED}</node></library_nodes>'
        '<library_controllers><controller id="C"><skin source="#G"/></controller></library_controllers>'
    )
    scene = (
        '<node name="a"><instance_node url="#L"/></node>'
        '<node name="b"><translate>0 5 0</translate><instance_node url="#L"/></node>'
        '<node name="c"><instance_controller url="#C"/></node>'
    )
    parts = load_file(written(tmp_path, "t.dae", collada(scene, library=library)))
    assert [p.name for p in parts] == ["shared", "shared", "c"]
    np.testing.assert_allclose(extent(parts), (1, 7, 3))


QUADS = """<geometry id="Q"><mesh><source id="QP"><float_array count="12">0 0 0 1 0 0 1 1 0 0 1 0</float_array>
<technique_common><accessor count="4" stride="3"/></technique_common></source>
<vertices id="QV"><input semantic="POSITION" source="#QP"/></vertices>{primitives}</mesh></geometry>"""


@pytest.mark.parametrize(
    "primitives",
    [
        '<polylist count="1"><input semantic="VERTEX" source="#QV" offset="0"/><vcount>4</vcount><p>0 1 2 3</p>'
        "</polylist>",
        '<polygons count="1"><input semantic="VERTEX" source="#QV" offset="0"/><p>0 1 2 3</p></polygons>',
        '<tristrips count="1"><input semantic="VERTEX" source="#QV" offset="0"/><p>0 1 3 2</p></tristrips>',
        '<trifans count="1"><input semantic="VERTEX" source="#QV" offset="0"/><p>0 1 2 3</p></trifans>',
        '<triangles count="2"><input semantic="VERTEX" source="#QV" offset="1"/>'
        '<input semantic="NORMAL" source="#QP" offset="0"/><p>0 0 1 1 2 2 0 0 2 2 3 3</p></triangles>',
    ],
    ids=["polylist", "polygons", "tristrips", "trifans", "two offsets"],
)
def test_every_kind_of_collada_primitive_becomes_triangles(tmp_path, primitives):
    text = collada('<node><instance_geometry url="#Q"/></node>', geometry=QUADS.format(primitives=primitives))
    (part,) = load_file(written(tmp_path, "t.dae", text))
    a, b, c = (part.vertices[part.faces[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    assert normals[:, 2].sum() == pytest.approx(2.0)
    assert (normals[:, 2] > 0).all()


@pytest.mark.parametrize(
    ("transparency", "alpha"),
    [
        ("<transparency><float>0.25</float></transparency>", 0.25),
        (
            '<transparent opaque="RGB_ZERO"><color>0 0 0 1</color></transparent>'
            "<transparency><float>1</float></transparency>",
            1.0,
        ),
        ('<transparent opaque="RGB_ZERO"><color>.4 .4 .4 1</color></transparent>', 0.6),
        ('<transparent opaque="A_ONE"><color>1 1 1 0.5</color></transparent>', 0.5),
        ("<transparency><float>0</float></transparency>", 1.0),
    ],
)
def test_collada_opacity_is_read_and_what_would_vanish_is_drawn(tmp_path, transparency, alpha):
    text = collada(f"<node>{PLACED}</node>").replace("</diffuse>", "</diffuse>" + transparency)
    (part,) = load_file(written(tmp_path, "t.dae", text))
    assert part.colour == pytest.approx((1, 0, 0, alpha))


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("<COLLADA", "has no triangles|not readable as XML"),
        ("", "not readable as XML"),
        ("<sdf/>", "begins with <sdf>"),
        (collada("<node><translate>1 2</translate></node>"), "<translate> with 2 numbers"),
        (collada(f"<node>{PLACED}</node>").replace("<p>0 2 1", "<p>0 2 77"), "vertex 77; there are 4"),
        (collada(f"<node>{PLACED}</node>").replace('stride="3"', 'stride="0"'), "stride"),
        (collada(f"<node>{PLACED}</node>").replace("0 0 0 1", "0 zero 0 1"), "not a number"),
        (collada(""), "has no triangles"),
    ],
)
def test_a_broken_collada_file_says_what_is_wrong_with_it(tmp_path, text, says):
    with pytest.raises(MeshFileError, match=says):
        load_file(written(tmp_path, "t.dae", text))


# ---------------------------------------------------------------------- glTF


@pytest.mark.parametrize("write", [write_gltf, write_glb])
def test_gltf_nodes_place_the_mesh_and_its_axes_stay(tmp_path, write):
    half = math.sqrt(0.5)
    nodes = [
        {"children": [1], "translation": [0.0, 5.0, 0.0]},
        {"name": "panel", "mesh": 0, "rotation": [half, 0.0, 0.0, half], "scale": [2.0, 1.0, 1.0]},
    ]
    (part,) = load_file(write(tmp_path / ("t.glb" if write is write_glb else "t.gltf"), gltf(nodes)))
    assert part.name == "panel"
    assert part.colour == pytest.approx((0.2, 0.4, 0.6, 1.0))
    # turned by 90 degrees about x: what stood along z lies along -y
    np.testing.assert_allclose(part.vertices, np.array([(2 * x, 5 - z, y) for x, y, z in QUAD]), atol=1e-6)
    assert load_file(tmp_path / ("t.glb" if write is write_glb else "t.gltf"), "quad")[0].name == "panel"


def test_gltf_strips_fans_and_files_beside_it(tmp_path):
    import base64

    for mode, order in ((5, [0, 1, 3, 2]), (6, [0, 1, 2, 3])):
        document = gltf([{"mesh": 0}])
        content = bytearray(base64.b64decode(document["buffers"][0]["uri"].partition(",")[2]))
        content[80:88] = np.array(order, "<u2").tobytes()
        (tmp_path / "b.bin").write_bytes(bytes(content))
        document["buffers"][0]["uri"] = "b.bin"
        document["accessors"][2]["count"] = 4
        document["meshes"][0]["primitives"][0]["mode"] = mode
        (part,) = load_file(write_gltf(tmp_path / f"m{mode}.gltf", document))
        a, b, c = (part.vertices[part.faces[:, i]] for i in range(3))
        np.testing.assert_allclose(np.cross(b - a, c - a), [(0, -1, 0)] * 2, atol=1e-7)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"buffers": [{"byteLength": 92, "uri": "gone.bin"}]}, "gone.bin is not found"),
        ({"buffers": [{"byteLength": 92, "uri": "data:;base64,AAAA"}]}, "outside of its buffer"),
        ({"bufferViews": [{"buffer": 0, "byteOffset": 10**15, "byteLength": 48}] * 3}, "outside of its buffer"),
        ({"bufferViews": [{"buffer": 0, "byteOffset": -8, "byteLength": 48}] * 3}, "outside of its buffer"),
        ({"accessors": [{"bufferView": 0, "componentType": 5126, "count": 10**12, "type": "VEC3"}] * 3}, "accessor of"),
        ({"nodes": [{"children": [0]}]}, "nested deeper"),
        ({"nodes": [{"mesh": 7}]}, "entry 7"),
        ({"nodes": [{"mesh": 0, "scale": ["x", 1, 1]}]}, "valid glTF"),
        ({"asset": {"version": "1.0"}}, "glTF 1.0"),
        ({"extensionsRequired": ["KHR_draco_mesh_compression"]}, "without compression"),
        ({"meshes": []}, "entry 0"),
    ],
)
def test_a_broken_gltf_says_what_is_wrong_with_it(tmp_path, change, says):
    document = {**gltf([{"mesh": 0}]), **change}
    with pytest.raises(MeshFileError, match=says):
        load_file(write_gltf(tmp_path / "t.gltf", document))


# ---------------------------------------------------------------------- the others


def test_ply_and_off_are_read_and_others_are_named(tmp_path):
    made = trimesh.Trimesh(TETRAHEDRON, TETRAHEDRON_FACES)
    for suffix in ("ply", "off"):
        made.export(tmp_path / f"t.{suffix}")
        assert volume(load_file(tmp_path / f"t.{suffix}")) == pytest.approx(1.0)
    with pytest.raises(MeshFileError, match=r"supported: \.dae, \.stl"):
        load_file(written(tmp_path, "t.fbx", b"x"))


# ---------------------------------------------------------------------- textures

UPPER, LOWER = (250, 10, 10), (10, 10, 250)


def textured_files(folder):
    """The same picture on the same upright quad in each format that can carry one."""
    picture(folder / "p.png", UPPER, LOWER)
    written(folder, "m.mtl", "newmtl m\nmap_Kd -s 1 1 1 p.png\n")
    lines = ["v {:g} {:g} {:g}".format(*p) for p in QUAD] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    yield written(folder, "t.obj", "mtllib m.mtl\nusemtl m\n" + "\n".join(lines) + "\nf 1/1 2/2 3/3 4/4\n")
    quad = QUADS.replace("0 0 0 1 0 0 1 1 0 0 1 0", "0 0 0 1 0 0 1 0 1 0 0 1").format(
        primitives='<polylist count="1" material="S"><input semantic="VERTEX" source="#QV" offset="0"/>'
        '<input semantic="TEXCOORD" source="#QT" offset="1"/><vcount>4</vcount><p>0 0 1 1 2 2 3 3</p></polylist>'
    )
    quad = quad.replace(
        "<vertices",
        '<source id="QT"><float_array count="8">0 0 1 0 1 1 0 1</float_array><technique_common>'
        '<accessor count="4" stride="2"/></technique_common></source><vertices',
    )
    text = collada(
        "<node>" + PLACED.replace("#G", "#Q") + "</node>",
        geometry=quad,
        images='<library_images><image id="I"><init_from>p.png</init_from></image></library_images>',
    )
    sampled = (
        '<profile_COMMON><newparam sid="f"><surface><init_from>I</init_from></surface></newparam>'
        '<newparam sid="s"><sampler2D><source>f</source></sampler2D></newparam>'
    )
    text = text.replace("<profile_COMMON>", sampled).replace("<color>1 0 0 1</color>", '<texture texture="s"/>')
    yield written(folder, "t.dae", text)
    look = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    yield write_gltf(
        folder / "t.gltf",
        gltf([{"mesh": 0}], materials=look, textures=[{"source": 0}], images=[{"uri": "p.png"}]),
    )


def test_a_picture_stands_upright_in_every_format(tmp_path):
    for file in textured_files(tmp_path):
        (part,) = convert_file(file).parts
        assert part.texture is not None, file
        upper = part.vertices[:, 2] > 0.5
        np.testing.assert_allclose(part.uv[upper, 1], 1.0)
        np.testing.assert_allclose(part.uv[~upper, 1], 0.0)
        np.testing.assert_array_equal(part.texture[0, 0], UPPER)
        np.testing.assert_array_equal(part.texture[-1, 0], LOWER)


def test_a_picture_within_a_gltf_container_is_read(tmp_path):
    import base64

    content = picture(tmp_path / "p.png", UPPER, LOWER).read_bytes()
    inside = "data:image/png;base64," + base64.b64encode(content).decode()
    look = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
    document = gltf([{"mesh": 0}], materials=look, textures=[{"source": 0}], images=[{"uri": inside}])
    (part,) = load_file(write_glb(tmp_path / "t.glb", document))
    np.testing.assert_array_equal(part.texture[0, 0], UPPER)


def test_a_sub_mesh_is_found_by_node_then_by_geometry(tmp_path):
    scene = f'<node name="left">{PLACED}</node><node name="right"><translate>5 0 0</translate>{PLACED}</node>'
    file = written(tmp_path, "t.dae", collada(scene))
    assert len(load_file(file, "right")) == 1
    assert len(load_file(file, "tetra")) == 2
    found = Diagnostics()
    centred = load_mesh(Mesh(file, "t.dae", (2.0, 1.0, 1.0), "right", True), found, NOWHERE)
    np.testing.assert_allclose(centred[0].vertices.max(axis=0), (1, 1, 1.5))
    assert not list(found)
