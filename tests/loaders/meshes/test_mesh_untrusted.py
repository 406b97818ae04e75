"""Mesh files that mean harm: an error or a clean import, in bounded time and memory, and nothing read elsewhere."""

from __future__ import annotations

import io
import os
import resource
import struct
import time
import zlib

import numpy as np
import pytest
from PIL import Image

from simkit.diagnostics import NOWHERE, Diagnostics
from simkit.loaders.meshes.companion_files import read_pixels
from simkit.loaders.meshes.mesh_part import MeshFileError
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
    write_gltf,
)

QUAD_OBJ = (
    "mtllib m.mtl\nusemtl m\n"
    + "".join("v {:g} {:g} {:g}\n".format(*p) for p in QUAD)
    + "vt 0 0\nvt 1 1\nf 1/1 2/2 3/1 4/2\n"
)


@pytest.fixture
def model(tmp_path):
    """A model folder with a secret outside of it."""
    folder = tmp_path / "world" / "model"
    (folder / "meshes").mkdir(parents=True)
    (folder / "model.config").write_text("<model/>")
    picture(tmp_path / "secret.png", (1, 2, 3), (1, 2, 3))
    (tmp_path / "secret.bin").write_bytes(b"\0" * 200)
    return folder / "meshes"


def textured_obj(folder, picture_name):
    (folder / "m.mtl").write_text(f"newmtl m\nmap_Kd {picture_name}\n")
    file = folder / "t.obj"
    file.write_text(QUAD_OBJ)
    return file


def png_header(width, height, body=b""):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    "name", ["../../../secret.png", "{outside}/secret.png", "file://{outside}/secret.png", "link.png"]
)
def test_a_texture_outside_of_the_model_is_not_read(model, tmp_path, name):
    (model / "link.png").symlink_to(tmp_path / "secret.png")
    converted = convert_file(textured_obj(model, name.format(outside=tmp_path)))
    assert [p.texture for p in converted.parts] == [None]
    assert "outside of the model's folder" in " ".join(converted.notes)


def test_a_texture_elsewhere_in_the_model_is_read(model):
    textures = model.parent / "materials" / "textures"
    textures.mkdir(parents=True)
    picture(textures / "p.png", (9, 8, 7), (9, 8, 7))
    for name in ("../materials/textures/p.png", "p.png", "C:\\Users\\me\\p.png"):
        (part,) = load_file(textured_obj(model, name))
        np.testing.assert_array_equal(part.texture[0, 0], (9, 8, 7))


def test_a_texture_from_a_network_is_not_fetched(model):
    converted = convert_file(textured_obj(model, "http://127.0.0.1:9/p.png"))
    assert "not fetched" in " ".join(converted.notes)


def test_a_model_made_of_links_works(model, tmp_path):
    """An installed workspace may link each file to its source."""
    real = textured_obj(model, "p.png")
    picture(model / "p.png", (5, 5, 5), (5, 5, 5))
    installed = tmp_path / "install" / "meshes"
    installed.mkdir(parents=True)
    for name in ("t.obj", "m.mtl", "p.png"):
        (installed / name).symlink_to(real.with_name(name))
    (part,) = load_file(installed / "t.obj")
    assert part.texture is not None


def test_a_gltf_buffer_outside_of_the_model_is_not_read(model):
    document = gltf([{"mesh": 0}])
    document["buffers"] = [{"byteLength": 92, "uri": "../../../secret.bin"}]
    with pytest.raises(MeshFileError, match="outside of the model's folder"):
        load_file(write_gltf(model / "t.gltf", document))


@pytest.mark.parametrize("size", [(100_000, 100_000), (2**31 - 1, 2**31 - 1), (0, 5)])
def test_a_picture_that_would_unpack_to_gigabytes_is_refused_by_its_header(tmp_path, size):
    with pytest.raises(MeshFileError, match=r"too large|not a readable picture"):
        read_pixels(png_header(*size, zlib.compress(b"\0" * 1000)))
    file = tmp_path / "bomb.png"
    file.write_bytes(png_header(*size))
    converted = convert_file(textured_obj(tmp_path, "bomb.png"))
    assert [p.texture for p in converted.parts] == [None]
    assert len(converted.notes) == 1


def test_a_wrong_checksum_beside_the_pixels_of_a_picture_does_no_harm():
    file = io.BytesIO()
    Image.new("RGB", (2, 1), (10, 20, 30)).save(file, "PNG")
    content = file.getvalue()
    chunk = struct.pack(">I", 3) + b"iCCP" + b"abc" + b"\0\0\0\0"
    assert read_pixels(content[:33] + chunk + content[33:]).tolist() == [[[10, 20, 30]] * 2]


def test_the_message_about_an_unknown_picture_is_the_same_in_each_run():
    with pytest.raises(MeshFileError, match=r"^is not a readable picture \(unknown format\)$"):
        read_pixels(b"no picture")


def test_text_in_a_picture_that_unpacks_to_gigabytes_does_no_harm():
    text = b"zTXt" + b"a\0\0" + zlib.compress(b"x" * (100 << 20), 1)
    chunk = struct.pack(">I", len(text) - 4) + text + struct.pack(">I", zlib.crc32(text))
    content = png_header(4, 4)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    with pytest.raises(MeshFileError):
        read_pixels(content[:33] + chunk + content[33:])
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # kB


LAUGHS = "<!DOCTYPE COLLADA [<!ENTITY a 'ha'>" + "".join(
    f"<!ENTITY {n} '{f'&{m};' * 10}'>" for m, n in zip("abcdefgh", "bcdefghi", strict=True)
)


@pytest.mark.parametrize(
    ("start", "says"),
    [
        (LAUGHS + "]><COLLADA>&i;</COLLADA>", "document type"),
        ("<!DOCTYPE COLLADA [<!ENTITY s SYSTEM 'file:///etc/passwd'>]><COLLADA>&s;</COLLADA>", "document type"),
        ("<!DOCTYPE COLLADA SYSTEM 'http://127.0.0.1:9/x.dtd'><COLLADA/>", "document type"),
        ("<COLLADA>" + "<node>" * 1_000_000, "nested more than 500 deep"),
        ("<COLLADA>" + "<node/>" * 300_000 + "</COLLADA>", "no triangles"),
    ],
    ids=["billion laughs", "external entity", "external definition", "deep", "many"],
)
def test_harmful_xml_in_collada_is_refused(tmp_path, start, says):
    file = tmp_path / "t.dae"
    file.write_text(start)
    began = time.perf_counter()
    with pytest.raises(MeshFileError, match=says):
        load_file(file)
    assert time.perf_counter() - began < 20


def test_collada_nodes_that_multiply_are_bounded(tmp_path):
    """Each of 40 library nodes places the next one ten times."""
    chain = "".join(f'<node id="n{i}">' + f'<instance_node url="#n{i + 1}"/>' * 10 + "</node>" for i in range(40))
    library = f'<library_nodes>{chain}<node id="n40">{PLACED}</node></library_nodes>'
    file = tmp_path / "t.dae"
    file.write_text(collada('<node><instance_node url="#n0"/></node>', library=library))
    with pytest.raises(MeshFileError, match="more than 20000"):
        load_file(file)
    around = '<library_nodes><node id="a"><instance_node url="#a"/></node></library_nodes>'
    file.write_text(collada('<node><instance_node url="#a"/></node>', library=around))
    with pytest.raises(MeshFileError, match="nested deeper"):
        load_file(file)


def test_numbers_of_elements_that_a_collada_file_promises_are_not_believed(tmp_path):
    file = tmp_path / "t.dae"
    file.write_text(collada(f"<node>{PLACED}</node>").replace('count="12"', 'count="999999999999"'))
    assert len(load_file(file)[0].faces) == 4
    lists = '<polylist count="1"><input semantic="VERTEX" source="#V" offset="0"/><vcount>2000000000</vcount>'
    lists += "<p>0 1 2</p></polylist>"
    file.write_text(collada(f"<node>{PLACED}</node>").replace("<triangles", lists + "<triangles"))
    with pytest.raises(MeshFileError, match="more corners than it has"):
        load_file(file)


@pytest.mark.parametrize("count", ["99999999999999999999", "1e400", "nan", "-1"])
def test_a_ply_header_is_not_believed(tmp_path, count):
    file = tmp_path / "t.ply"
    file.write_text(f"ply\nformat ascii 1.0\nelement vertex {count}\nproperty float x\nend_header\n1\n")
    with pytest.raises(MeshFileError):
        load_file(file)


@pytest.mark.parametrize("number", ["nan", "inf", "-inf", "1e308", "1e999"])
def test_numbers_that_no_mesh_has_are_errors(tmp_path, number):
    file = tmp_path / "t.obj"
    file.write_text(f"v 0 0 {number}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    with pytest.raises(MeshFileError, match="NaN or infinite|beyond"):
        load_file(file)


def test_deep_json_is_an_error(tmp_path):
    file = tmp_path / "t.gltf"
    file.write_text("[" * 200_000)
    with pytest.raises(MeshFileError, match="JSON"):
        load_file(file)


def samples(folder):
    (folder / "t.stl").write_bytes(binary_stl(np.array(TETRAHEDRON)[np.array(TETRAHEDRON_FACES)]))
    (folder / "t.dae").write_text(collada(f"<node>{PLACED}</node>"))
    (folder / "t.obj").write_text(QUAD_OBJ)
    write_gltf(folder / "t.gltf", gltf([{"mesh": 0}]))
    return [folder / f"t.{s}" for s in ("stl", "dae", "obj", "gltf")]


def test_whatever_is_cut_off_or_turned_over_nothing_but_an_error_comes_of_it(tmp_path):
    rng = np.random.default_rng(0)
    for file in samples(tmp_path):
        whole = file.read_bytes()
        for trial in range(60):
            content = bytearray(whole[: rng.integers(0, len(whole) + 1)] if trial % 2 else whole)
            for at in rng.integers(0, max(1, len(content)), 4):
                if len(content):
                    content[at] = rng.integers(0, 256)
            file.write_bytes(bytes(content))
            os.utime(file, ns=(trial, trial))
            found = Diagnostics()
            load_mesh(Mesh(file, file.name), found, NOWHERE)
            assert {d.code for d in found} <= {"SK-MESH-001", "SK-MESH-012"}


def test_a_name_that_is_no_file_is_an_error(tmp_path):
    for name in ("gone.stl", ".", "a\0b.stl"):
        with pytest.raises(MeshFileError):
            load_file(tmp_path / name)
