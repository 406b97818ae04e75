"""`<scene>`: fog and sky as they are read and written, and how gloss is given."""

from __future__ import annotations

import pytest

from simkit.diagnostics import Diagnostics
from simkit.scene.world import Fog
from simkit.writers.sdf_world import sdf_text

FOG = "<fog><type>exp2</type><color>0.1 0.2 0.3 1</color><start>2</start><end>30</end><density>0.05</density></fog>"


def scene(content: str) -> str:
    return f'<sdf version="1.9"><world name="w"><scene>{content}</scene></world></sdf>'


def test_fog_and_sky_are_read_and_come_back_from_what_is_written(load):
    first, said = load(scene(FOG + "<sky/>"))
    again, said_again = load(sdf_text(first, Diagnostics()))
    for found in (first, again):
        around = found.world.surroundings
        assert around.fog == Fog("exp2", (0.1, 0.2, 0.3, 1.0), 2.0, 30.0, 0.05)
        assert around.sky
    assert not said and not said_again


def test_what_a_sky_has_of_its_own_is_told_to_be_left_out(load):
    found, said = load(scene("<sky><time>6</time><clouds><speed>2</speed></clouds></sky>"))
    assert found.world.surroundings.sky
    assert [d.severity for d in said] == ["note"] and "<time>" in said[0].message and "<clouds>" in said[0].message


@pytest.mark.parametrize(("kind", "hint"), [("constant", "Classic"), ("Exp", "exp"), ("quadratic", "Classic")])
def test_a_fog_that_nobody_draws_is_said(load, kind, hint):
    found, said = load(scene(f"<fog><type>{kind}</type></fog>"))
    assert found.world.surroundings.fog is None
    assert [d.code for d in said] == ["SK-RENDER-010"] and hint in said[0].hint


def test_no_fog_is_no_fog(load):
    found, said = load(scene("<fog><type>none</type></fog>"))
    assert found.world.surroundings.fog is None and not said


def test_shininess_is_the_exponent_of_the_gloss(load):
    visual = """<visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry>
      <material><shininess>32</shininess></material></visual>"""
    found, said = load(f'<sdf version="1.9"><model name="m"><link name="l">{visual}</link></model></sdf>')
    assert found.model.links[0].visuals[0].material.shininess == 32.0
    assert "shininess" not in " ".join(d.message for d in said)
