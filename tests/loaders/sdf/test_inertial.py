"""Mass, centre of mass and inertia from collisions, compared with analytic values."""

from __future__ import annotations

import math

import numpy as np
import pytest

from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver, load_scene

BOX_STL = """solid s
{}endsolid s"""


def link(shapes: str, inertial: str = '<inertial auto="true"/>') -> str:
    return f'<sdf version="1.11"><model name="m"><link name="l">{inertial}{shapes}</link></model></sdf>'


def collision(shape: str, pose: str = "0 0 0 0 0 0", name: str = "c", density: str = "") -> str:
    return f'<collision name="{name}"><pose>{pose}</pose>{density}<geometry>{shape}</geometry></collision>'


def mass_of(text: str):
    """Return the inertial of the first link, read with the mesh reader of `simkit.compiler`, and the diagnostics."""
    from simkit.loaders.meshes.mesh_reader import load_mesh

    diagnostics = Diagnostics()
    scene = load_scene(text, resolver=Resolver(), diagnostics=diagnostics, mesh_reader=load_mesh)
    return scene.model.links[0].inertial, list(diagnostics)


def near(inertial, mass, com, moments) -> None:
    assert inertial.mass == pytest.approx(mass, rel=1e-9)
    np.testing.assert_allclose(inertial.com, com, atol=1e-9 * max(1.0, *map(abs, com)))
    np.testing.assert_allclose(inertial.inertia, moments, rtol=1e-9, atol=1e-9 * max(moments))


W = 1000.0
PI = math.pi


@pytest.mark.parametrize(
    ("shape", "mass", "com", "moments"),
    [
        ("<box><size>1 2 3</size></box>", 6 * W, (0, 0, 0), (6500, 5000, 2500)),
        ("<sphere><radius>2</radius></sphere>", 32 / 3 * PI * W, (0, 0, 0), (0.4 * 4 * 32 / 3 * PI * W,) * 3),
        (
            "<cylinder><radius>1</radius><length>2</length></cylinder>",
            2 * PI * W,
            (0, 0, 0),
            (2 * PI * W * 7 / 12, 2 * PI * W * 7 / 12, PI * W),
        ),
        (
            "<ellipsoid><radii>1 2 3</radii></ellipsoid>",
            8 * PI * W,
            (0, 0, 0),
            (8 * PI * W / 5 * 13, 8 * PI * W / 5 * 10, 8 * PI * W / 5 * 5),
        ),
        (
            "<cone><radius>1</radius><length>4</length></cone>",
            4 / 3 * PI * W,
            (0, 0, -1),
            (4 / 3 * PI * W * 0.75, 4 / 3 * PI * W * 0.75, 4 / 3 * PI * W * 0.3),
        ),
        (
            "<polyline><point>0 0</point><point>2 0</point><point>2 1</point><point>0 1</point>"
            "<height>3</height></polyline>",
            6 * W,
            (1, 0.5, 1.5),
            (6 * W * 10 / 12, 6 * W * 13 / 12, 6 * W * 5 / 12),
        ),
    ],
)
def test_solids_have_the_analytic_inertia(shape, mass, com, moments):
    inertial, found = mass_of(link(collision(shape)))
    assert not found
    near(inertial, mass, com, (*moments, 0, 0, 0))


def test_a_capsule_lies_between_its_cylinder_and_the_longer_one():
    inertial, _ = mass_of(link(collision("<capsule><radius>1</radius><length>2</length></capsule>")))
    caps, body = 4 / 3 * PI * W, 2 * PI * W
    # each half ball has its centre of mass 3/8 of the radius above its flat side
    half = caps / 2
    side = body * 7 / 12 + 2 * (half * (0.4 - 9 / 64) + half * (1 + 3 / 8) ** 2)
    near(inertial, caps + body, (0, 0, 0), (side, side, body / 2 + 0.4 * caps, 0, 0, 0))


def test_an_outline_inside_another_is_a_hole_whichever_way_it_runs():
    def square(r: float, back: bool) -> str:
        corners = [(-r, -r), (r, -r), (r, r), (-r, r)]
        points = "".join(f"<point>{x} {y}</point>" for x, y in (corners[::-1] if back else corners))
        return f"<polyline>{points}<height>1</height></polyline>"

    for back in (False, True):
        inertial, _ = mass_of(link(collision(square(2, False) + square(1, back))))
        near(inertial, 12 * W, (0, 0, 0.5), (W * (64 / 3 - 4 / 3 + 1), W * (64 / 3 - 4 / 3 + 1), W * 40, 0, 0, 0))


def test_the_inertias_of_rotated_collisions_add_up_about_their_common_centre():
    box = "<box><size>1 2 3</size></box>"
    turned = collision(box, f"5 0 0 {PI / 2} 0 0", "d", "<density>500</density>")
    inertial, _ = mass_of(link(collision(box) + turned))
    com = 5 / 3
    ixx = 6500 + 3250
    iyy = 5000 + 6000 * com**2 + 1250 + 3000 * (5 - com) ** 2
    izz = 2500 + 6000 * com**2 + 2500 + 3000 * (5 - com) ** 2
    near(inertial, 9000, (com, 0, 0), (ixx, iyy, izz, 0, 0, 0))


def test_the_density_of_the_inertial_is_the_default_and_a_mass_scales_the_result():
    box = collision("<box><size>1 1 1</size></box>")
    assert mass_of(link(box, '<inertial auto="true"><density>30</density></inertial>'))[0].mass == 30
    own = collision("<box><size>1 1 1</size></box>", density="<density>20</density>")
    assert mass_of(link(own, '<inertial auto="true"><density>30</density></inertial>'))[0].mass == 20
    scaled = mass_of(link(box, '<inertial auto="true"><mass>6</mass></inertial>'))[0]
    near(scaled, 6, (0, 0, 0), (1, 1, 1, 0, 0, 0))


@pytest.mark.parametrize("mass", ["0", "-2"])
def test_a_mass_that_is_not_positive_is_an_error(mass):
    box = collision("<box><size>1 1 1</size></box>")
    _, found = mass_of(link(box, f'<inertial auto="true"><mass>{mass}</mass></inertial>'))
    assert [d.code for d in found if d.severity == "error"] == ["SK-SDF-013"]


def test_planes_and_empty_shapes_have_no_volume_and_cause_a_warning():
    _, found = mass_of(link(collision("<plane/>")))
    assert [d.code for d in found] == ["SK-SDF-022", "SK-SDF-022"]
    assert all(d.severity == "warning" for d in found)


@pytest.fixture
def tetrahedron(tmp_path):
    """Write a mesh file with the corners 0, x, y and z at 1: volume 1/6, centre 1/4."""
    corners = {"o": "0 0 0", "x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
    facets = "".join(
        "facet normal 0 0 0\nouter loop\n" + "".join(f"vertex {corners[c]}\n" for c in f) + "endloop\nendfacet\n"
        for f in ("oyx", "oxz", "ozy", "xyz")
    )
    path = tmp_path / "t.stl"
    path.write_text(BOX_STL.format(facets))
    return path


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 3, 4), (-2, 3, 4), (-2, -3, -4)])
def test_a_mesh_is_integrated_with_its_positive_or_negative_scale(tetrahedron, scale):
    mesh = f"<mesh><uri>{tetrahedron}</uri><scale>{' '.join(map(str, scale))}</scale></mesh>"
    text = link(collision(mesh))
    path = tetrahedron.parent / "m.sdf"
    path.write_text(text)
    inertial, found = mass_of(path)
    assert not [d for d in found if d.severity != "note"]
    a, b, c = scale
    volume = abs(a * b * c) / 6
    # about the centre of the tetrahedron 0, a, b, c, the integral of xx is 3 a^2 V / 80, and that of xy is -a b V / 80
    xx, yy, zz = (3 * s * s * volume / 80 * W for s in scale)
    xy, xz, yz = (s * volume / 80 * W for s in (a * b, a * c, b * c))
    near(inertial, volume * W, (a / 4, b / 4, c / 4), (yy + zz, xx + zz, xx + yy, xy, xz, yz))


def test_the_unit_of_a_collada_file_is_applied(tmp_path):
    faces = "0 2 1 0 1 3 0 3 2 1 2 3"
    (tmp_path / "t.dae").write_text(f"""<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset><unit name="dm" meter="0.1"/>
<up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g" name="g"><mesh><source id="p">
<float_array id="pa" count="12">0 0 0 10 0 0 0 10 0 0 0 10</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="4">
<input semantic="VERTEX" source="#v" offset="0"/><p>{faces}</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>""")
    path = tmp_path / "m.sdf"
    path.write_text(link(collision("<mesh><uri>t.dae</uri></mesh>")))
    inertial, _ = mass_of(path)
    assert inertial.mass == pytest.approx(W / 6, rel=1e-6)
    np.testing.assert_allclose(inertial.com, (0.25,) * 3, rtol=1e-6)


def test_an_inertia_that_is_not_a_number_is_a_warning_in_a_static_model_and_else_an_error(tmp_path):
    inertial = "<inertial><mass>0</mass><inertia><ixx>nan</ixx><iyy>nan</iyy><izz>nan</izz></inertia></inertial>"
    shape = collision("<box><size>1 1 1</size></box>")
    model = (
        f'<sdf version="1.9"><model name="m"><static>true</static><link name="l">{inertial}{shape}</link></model></sdf>'
    )
    path = tmp_path / "m.sdf"
    path.write_text(model)
    found = mass_of(path)[1]
    assert {(d.severity, d.code) for d in found if d.line == 1} >= {("warning", "SK-PARAM-002")}
    assert not [d for d in found if d.severity == "error"]
    path.write_text(model.replace("<static>true</static>", ""))
    assert [d for d in mass_of(path)[1] if d.severity == "error" and "<ixx>nan</ixx>" in d.message]
