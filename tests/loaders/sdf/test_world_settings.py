"""`<scene>`: reading and writing of fog and sky, and the shininess of materials."""

from __future__ import annotations

import pytest

from simkit.diagnostics import Diagnostics
from simkit.scene.world import Fog
from simkit.writers.sdf_world import sdf_text

FOG = "<fog><type>exp2</type><color>0.1 0.2 0.3 1</color><start>2</start><end>30</end><density>0.05</density></fog>"


def scene(content: str) -> str:
    return f'<sdf version="1.9"><world name="w"><scene>{content}</scene></world></sdf>'


def test_fog_and_sky_survive_writing_and_reading(load):
    first, diagnostics = load(scene(FOG + "<sky/>"))
    again, said_again = load(sdf_text(first, Diagnostics()))
    for found in (first, again):
        around = found.world.surroundings
        assert around.fog == Fog("exp2", (0.1, 0.2, 0.3, 1.0), 2.0, 30.0, 0.05)
        assert around.sky
    assert not diagnostics and not said_again


def test_unsupported_settings_of_the_sky_are_reported(load):
    found, diagnostics = load(scene("<sky><time>6</time><clouds><speed>2</speed></clouds></sky>"))
    assert found.world.surroundings.sky
    assert (
        [d.severity for d in diagnostics] == ["note"]
        and "<time>" in diagnostics[0].message
        and "<clouds>" in diagnostics[0].message
    )


@pytest.mark.parametrize(("kind", "hint"), [("constant", "Classic"), ("Exp", "exp"), ("quadratic", "Classic")])
def test_an_unsupported_type_of_fog_is_reported(load, kind, hint):
    found, diagnostics = load(scene(f"<fog><type>{kind}</type></fog>"))
    assert found.world.surroundings.fog is None
    assert [d.code for d in diagnostics] == ["SK-RENDER-010"] and hint in diagnostics[0].hint


def test_the_fog_type_none_disables_fog(load):
    found, diagnostics = load(scene("<fog><type>none</type></fog>"))
    assert found.world.surroundings.fog is None and not diagnostics


def test_shininess_is_the_exponent_of_the_specular_highlight(load):
    visual = """<visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry>
      <material><shininess>32</shininess></material></visual>"""
    found, diagnostics = load(f'<sdf version="1.9"><model name="m"><link name="l">{visual}</link></model></sdf>')
    assert found.model.links[0].visuals[0].material.shininess == 32.0
    assert "shininess" not in " ".join(d.message for d in diagnostics)


@pytest.mark.parametrize(
    ("content", "is_bullet"),
    [
        ("", False),
        ("<physics type='ode'/>", False),
        ("<physics type='bullet'/>", True),
        (
            "<plugin filename='gz-sim-physics-system' name='gz::sim::systems::Physics'>"
            "<engine><filename>gz-physics-bullet-featherstone-plugin</filename></engine></plugin>",
            True,
        ),
    ],
)
def test_the_engine_bullet_survives_writing_and_reading(load, content, is_bullet):
    first, _ = load(f"<sdf version='1.9'><world name='w'>{content}</world></sdf>")
    again, _ = load(sdf_text(first, Diagnostics()))
    assert [found.world.physics.engine == "bullet" for found in (first, again)] == [is_bullet, is_bullet]
