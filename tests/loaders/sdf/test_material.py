"""Materials: values of the element, values of its script, and the search for textures."""

from __future__ import annotations

import pytest

from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, load_scene

OGRE = """
// a comment with a } in it
/* material Own/Hidden { } */
import * from "base.material"

vertex_program Own/Shader glsl
{
  source own.vert
}
abstract material Own/Base
{
  technique
  {
    pass
    {
      ambient 0.1 0.2 0.3
      diffuse 0.4 0.5 0.6 0.5
      specular 0.7 0.6 0.5 12.5
      emissive 0 0.25 0
      texture_unit
      {
        texture "paint.png"
      }
    }
    pass second
    {
      diffuse 1 1 1 1
    }
  }
}
material Own/Child : Own/Base
{
  technique { pass { diffuse 1 0 0 1
    scene_blend alpha_blend } }
}
material Own/Red : Gazebo/RedGlow { technique { pass { ambient 0 0 0 } } }
material "Own/Two words" { technique { pass { cull_hardware none
 diffuse 0 1 0 } } }
material Own/Loop : Own/Pool { }
material Own/Pool : Own/Loop { }
material Own/Bad { technique { pass { diffuse red green blue
 ambient 1 } } }
material Own/Open { technique { pass { diffuse 0 0 1
"""


@pytest.fixture
def read(tmp_path):
    """Return a function read(material) that loads a model with one visual, and returns material and diagnostics."""
    scripts = tmp_path / "paints" / "materials" / "scripts"
    scripts.mkdir(parents=True)
    (scripts / "own.material").write_text(OGRE)
    textures = tmp_path / "paints" / "materials" / "textures"
    textures.mkdir()
    (textures / "paint.png").write_bytes(b"any picture")
    (tmp_path / "secret.png").write_bytes(b"another")

    def run(material):
        text = f"""<sdf version="1.9"><model name="m"><static>true</static><link name="l"><visual name="v">
        <geometry><box><size>1 1 1</size></box></geometry>{material}</visual></link></model></sdf>"""
        file = tmp_path / "model.sdf"
        file.write_text(text)
        found = Diagnostics()
        scene = load_scene(file, resolver=Resolver([tmp_path]), diagnostics=found, xacro_args={})
        return scene.model.links[0].visuals[0].material, [(d.code, d.message, d.hint) for d in found]

    return run


def script(name, uris=("model://paints/materials/scripts", "model://paints/materials/textures"), more=""):
    listed = "".join(f"<uri>{u}</uri>" for u in uris)
    return f"<material><script>{listed}<name>{name}</name></script>{more}</material>"


def test_a_project_may_have_its_own_folder_media_materials(read, tmp_path):
    """Gazebo's own scripts are in a folder of this name too, and are not needed."""
    folder = tmp_path / "media/materials/scripts"
    folder.mkdir(parents=True)
    (folder / "road.material").write_text("material Own/Road { technique { pass { diffuse 0.2 0.3 0.4 } } }")
    material, diagnostics = read(script("Own/Road", ["file://media/materials/scripts/road.material"]))
    assert material.diffuse == (0.2, 0.3, 0.4, 1.0)
    assert not diagnostics


@pytest.mark.parametrize(
    ("name", "ambient", "diffuse", "emissive"),
    [
        ("Grey", (0.3, 0.3, 0.3, 1), (0.7, 0.7, 0.7, 1), (0, 0, 0, 1)),
        ("SkyBlue", (0.13, 0.44, 0.7, 1), (0, 0, 1, 1), (0, 0, 0, 1)),
        ("Orange", (1, 0.5088, 0.0468, 1), (1, 0.5088, 0.0468, 1), (0, 0, 0, 1)),
        ("YellowGlow", (1, 1, 0, 1), (1, 1, 0, 1), (1, 1, 0, 1)),
        ("RedTransparent", (1, 0, 0, 1), (1, 0, 0, 0.5), (0, 0, 0, 1)),
    ],
)
def test_material_names_of_gazebo_have_their_colours(read, name, ambient, diffuse, emissive):
    for spelt in (
        script(f"Gazebo/{name}", ["file://media/materials/scripts/gazebo.material"]),
        script(f"Gazebo/{name}", []),
    ):
        material, diagnostics = read(spelt)
        assert (material.ambient, material.diffuse, material.emissive) == (ambient, diffuse, emissive)
        assert not diagnostics


def test_an_unknown_material_name_causes_a_note_with_the_closest_name(read):
    material, diagnostics = read(script("Gazebo/Oragne", []))
    assert material.diffuse == (1, 1, 1, 1)
    assert [(code, hint) for code, _, hint in diagnostics] == [("SK-SDF-021", "did you mean 'Gazebo/Orange'?")]


def test_a_material_script_of_a_model_gives_colours_and_texture(read, tmp_path):
    material, diagnostics = read(script("Own/Base"))
    assert material.ambient == (0.1, 0.2, 0.3, 1)
    assert material.diffuse == (0.4, 0.5, 0.6, 1)  # opaque: it does not blend
    assert material.specular == (0.7, 0.6, 0.5, 1)
    assert material.emissive == (0, 0.25, 0, 1)
    assert material.texture == tmp_path / "paints" / "materials" / "textures" / "paint.png"
    assert not diagnostics


def test_a_script_inherits_from_its_own_file_and_from_gazebo(read):
    child, _ = read(script("Own/Child"))
    assert (child.diffuse, child.ambient) == ((1, 0, 0, 1), (0.1, 0.2, 0.3, 1))
    assert child.texture is not None
    red, _ = read(script("Own/Red"))
    assert (red.diffuse, red.emissive, red.ambient) == ((1, 0, 0, 1), (1, 0, 0, 1), (0, 0, 0, 1))


@pytest.mark.parametrize(
    ("name", "diffuse"),
    [
        ("Own/Two words", (0, 1, 0, 1)),
        ("Own/Loop", (1, 1, 1, 1)),
        ("Own/Bad", (1, 1, 1, 1)),
        ("Own/Open", (0, 0, 1, 1)),
    ],
)
def test_incomplete_scripts_are_read_as_far_as_possible(read, name, diffuse):
    material, diagnostics = read(script(name))
    assert material.diffuse == diffuse
    assert material.double_sided is (name == "Own/Two words")
    assert not diagnostics


def test_the_default_text_of_sdf_is_no_material(read):
    material, diagnostics = read(script("__default__", []))
    assert material.diffuse == (1, 1, 1, 1) and not diagnostics


def test_a_hidden_or_missing_script_causes_a_note(read):
    assert [c for c, *_ in read(script("Own/Hidden"))[1]] == ["SK-SDF-021"]
    assert [c for c, *_ in read(script("Own/Base", ["model://nowhere/scripts"]))[1]] == ["SK-SDF-021"]


def test_values_of_the_element_override_its_script(read):
    material, _ = read(script("Own/Base", more="<diffuse>0 0 1 1</diffuse><double_sided>true</double_sided>"))
    assert (material.diffuse, material.ambient) == ((0, 0, 1, 1), (0.1, 0.2, 0.3, 1))
    assert material.double_sided


def test_a_texture_outside_the_script_folders_is_refused(read, tmp_path):
    file = tmp_path / "paints" / "materials" / "scripts" / "own.material"
    file.write_text(OGRE.replace("paint.png", "../../../secret.png"))
    material, diagnostics = read(script("Own/Base"))
    assert material.texture is None
    assert [code for code, *_ in diagnostics] == ["SK-URI-006"]


@pytest.mark.parametrize(
    "content", ["{" * 100_000, "material a " * 20_000, "/*" * 50_000, "material x {" + "pass {" * 50_000, '"' * 9999]
)
def test_a_malicious_script_is_read_quickly(read, tmp_path, content):
    (tmp_path / "paints" / "materials" / "scripts" / "own.material").write_text(content)
    assert read(script("Own/Base"))[0].diffuse == (1, 1, 1, 1)


def test_physically_based_materials_give_a_texture_and_roughness(read, tmp_path):
    (tmp_path / "albedo.png").write_bytes(b"any")
    text = """<material><diffuse>.5 .5 .5</diffuse><specular>.2 .2 .2</specular><pbr>
    <specular><albedo_map>other.png</albedo_map></specular>
    <metal><albedo_map>albedo.png</albedo_map><roughness>0.3</roughness><metalness>0.9</metalness></metal></pbr></material>"""
    material, _ = read(text)
    assert material.texture == tmp_path / "albedo.png"
    assert material.roughness == pytest.approx(0.3)
    assert material.diffuse == (0.5, 0.5, 0.5, 1)


def test_a_missing_texture_is_reported_once(read):
    text = "<material><pbr><metal><albedo_map>gone.png</albedo_map></metal></pbr></material>"
    two = f'{text}</visual><visual name="w"><geometry><sphere><radius>1</radius></sphere></geometry>{text}'
    _, diagnostics = read(two)
    assert [code for code, *_ in diagnostics] == ["SK-URI-006"]


def test_a_missing_mesh_is_reported_once_even_if_used_repeatedly(tmp_path):
    shape = "<geometry><mesh><uri>model://gone/a.stl</uri></mesh></geometry>"
    parts = "".join(f'<visual name="v{i}">{shape}</visual><collision name="c{i}">{shape}</collision>' for i in range(3))
    found = Diagnostics()
    text = f'<sdf version="1.9"><model name="m"><static>true</static><link name="l">{parts}</link></model></sdf>'
    load_scene(text, resolver=Resolver([tmp_path]), diagnostics=found, xacro_args={})
    assert [d.code for d in found] == ["SK-URI-001"]


def test_a_transparency_outside_its_range_is_limited_with_a_warning(load):
    visual = "<visual name='v'><transparency>{}</transparency><geometry><sphere/></geometry></visual>"
    for written, used in ((100, 1.0), (-0.5, 0.0)):
        text = f'<sdf version="1.9"><model name="m"><link name="l">{visual.format(written)}</link></model></sdf>'
        scene, found = load(text)
        assert scene.model.links[0].visuals[0].transparency == used
        assert [d.code for d in found if d.severity != "note"] == ["SK-PARAM-008"]
