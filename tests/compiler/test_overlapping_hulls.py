"""Links of one model whose convex hulls overlap at the start: they do not collide, and all others do."""

from __future__ import annotations

from pathlib import Path

import mujoco
import pytest
import trimesh

from simkit.compiler import SpecBuilder
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Box, Mesh


@pytest.fixture
def block(tmp_path: Path) -> Mesh:
    """Mesh of a cube of 0.1 m."""
    trimesh.creation.box((0.1, 0.1, 0.1)).export(tmp_path / "block.stl")
    return Mesh(tmp_path / "block.stl", "block.stl")


def built(make, shape, distances, **options):
    """Return the compiled world with a row of links of one model, and the diagnostics."""
    found = Diagnostics()
    links = [make.link(f"m::{i}", shape, Pose((x, 0, 1))) for i, x in enumerate(distances)]
    builder = SpecBuilder(make.world(make.model("m", *links, self_collide=True), **options), found)
    return builder.compile(), found


def test_overlapping_hulls_of_one_model_do_not_collide_and_the_others_do(make, block):
    compiled, found = built(make, block, (0.0, 0.08, 0.1799))
    mujoco.mj_forward(compiled.model, compiled.data)
    touching = {tuple(compiled.names.geom_owner(g)[0] for g in pair) for pair in compiled.data.contact.geom}
    assert touching == {("m::1", "m::2")}
    (warning,) = (d for d in found if d.code == "SK-PHYS-034")
    assert "model m: the links 0 and 1 do not collide with each other" in warning.message
    assert "by up to 20 mm" in warning.message


def test_overlapping_boxes_of_one_model_collide(make):
    compiled, found = built(make, Box((0.1, 0.1, 0.1)), (0.0, 0.08))
    mujoco.mj_forward(compiled.model, compiled.data)
    assert compiled.data.ncon
    assert "SK-PHYS-034" not in [d.code for d in found]


def test_a_model_that_is_added_later_has_the_same_exclusions(make, block):
    found = Diagnostics()
    builder = SpecBuilder(make.world(), found)
    first = builder.compile()
    later = builder.copy()
    links = [make.link(f"m::{i}", block, Pose((x, 0, 1))) for i, x in enumerate((0.0, 0.08))]
    later.add_model(make.model("m", *links, self_collide=True))
    compiled = later.recompile(first, first.data)
    mujoco.mj_forward(compiled.model, compiled.data)
    assert compiled.data.ncon == 0
    assert compiled.model.nexclude == 1
    later.remove_model("m")
    assert later.recompile(compiled, compiled.data).model.nexclude == 0
