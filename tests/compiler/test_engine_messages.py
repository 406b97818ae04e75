"""Messages of the engine name the user's files and elements, never simkit's internal names."""

from __future__ import annotations

from pathlib import Path

import simkit
from simkit.compiler.model_compilation import user_message
from simkit.diagnostics import NOWHERE

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"


def test_a_mesh_is_named_by_its_file_and_its_collision(tmp_path: Path) -> None:
    (tmp_path / "arm.obj").write_text(TETRAHEDRON)
    (tmp_path / "w.sdf").write_text("""<sdf version="1.9"><world name="w"><model name="m"><link name="l">
      <collision name="hull"><geometry><mesh><uri>arm.obj</uri></mesh></geometry></collision>
      </link></model></world></sdf>""")
    with simkit.load(tmp_path / "w.sdf") as sim:
        builder = sim.engine.structure.builder
        spec, records = builder.spec, list(builder.records.values())
        (name,) = {geom.meshname for geom in spec.geoms if geom.meshname}
        assert name.startswith("mesh#")
        text = f"Error: mesh '{name}' has coplanar vertices at id 5734\nElement name '{name}', id 3"
        message, where = user_message(text, spec, records, NOWHERE)
        file = name.replace("#", "_") + ".msh"
        told = user_message(f"cannot read '{file}'", spec, records, NOWHERE)[0]
        number = user_message("geom 'm::l::hull#0' is too small", spec, records, NOWHERE)[0]
    shown = "arm.obj of m::l::hull"
    assert message == f"Error: mesh {shown} has coplanar vertices\nElement name {shown}"
    assert told == f"cannot read {shown}" and where.line == 2
    assert number == "geom 'm::l::hull' is too small"
