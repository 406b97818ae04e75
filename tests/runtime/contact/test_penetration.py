"""Bodies that overlap at the start separate slowly and then have normal contacts."""

from __future__ import annotations

import pytest

import simkit
from simkit.runtime.contact.contact_conditions import EXIT_SPEED

GROUND = """<model name="ground"><static>true</static><link name="l"><collision name="c"><geometry><plane>
<normal>0 0 1</normal><size>10 10</size></plane></geometry></collision></link></model>"""


def box(name: str, z: float, mass: float = 1.0) -> str:
    i = mass / 6
    return f"""<model name="{name}"><pose>0 0 {z} 0 0 0</pose><link name="l"><inertial><mass>{mass}</mass><inertia>
<ixx>{i}</ixx><iyy>{i}</iyy><izz>{i}</izz></inertia></inertial>
<collision name="c"><geometry><box><size>1 1 1</size></box></geometry>
</collision></link></model>"""


def world(*models: str) -> str:
    return f'<sdf version="1.9"><world name="w">{"".join(models)}</world></sdf>'


@pytest.mark.parametrize(("depth", "mass"), [(0.02, 1.0), (0.05, 1.0), (0.05, 300.0), (0.2, 1.0)])
def test_a_box_in_the_ground_rises_slowly_and_stays(depth: float, mass: float) -> None:
    sim = simkit.load(world(GROUND, box("b", 0.5 - depth, mass)))
    highest = fastest = 0.0
    for _ in range(8000):
        sim.step()
        highest = max(highest, float(sim.model("b").pose.position[2]))
        fastest = max(fastest, float(sim.link("b::l").linear_velocity[2]))
    assert fastest < 1.002 * EXIT_SPEED
    assert highest < 0.501
    assert sim.model("b").pose.position[2] == pytest.approx(0.5, abs=2e-3)
    assert "SK-PHYS-024" in [d.code for d in sim.diagnostics]


def test_after_the_separation_the_contact_has_normal_parameters() -> None:
    sim = simkit.load(world(GROUND, box("b", 0.45)))
    other = simkit.load(world(GROUND, box("b", 0.5)))
    sim.run(5.0)
    for field in ("geom_solref", "geom_solimp", "geom_priority", "geom_friction", "geom_condim"):
        assert getattr(sim.mj_model, field).tolist() == getattr(other.mj_model, field).tolist(), field


def test_an_overlapping_box_has_the_friction_of_the_file() -> None:
    sim = simkit.load(world(GROUND, box("b", 0.45)))
    sim.run(0.01)
    pair = next(c for c in sim.mj_data.contact)
    assert float(pair.friction[0]) == pytest.approx(1.0)


def test_a_restore_and_a_reset_repeat_the_separation() -> None:
    sim = simkit.load(world(GROUND, box("b", 0.45)))
    sim.run(0.2)
    middle, snapshot = float(sim.model("b").pose.position[2]), sim.snapshot()
    sim.run(3.0)
    end = float(sim.model("b").pose.position[2])
    sim.restore(snapshot)
    assert float(sim.model("b").pose.position[2]) == middle
    sim.run(3.0)
    assert float(sim.model("b").pose.position[2]) == end
    sim.reset()
    sim.run(3.2)
    assert float(sim.model("b").pose.position[2]) == end


def test_a_model_spawned_into_another_model_separates_slowly() -> None:
    sim = simkit.load(world(GROUND, box("a", 0.5)))
    sim.run(0.5)
    sim.spawn(f'<sdf version="1.9">{box("b", 1.45)}</sdf>')
    fastest = 0.0
    for _ in range(2000):
        sim.step()
        fastest = max(fastest, float(sim.link("b::l").linear_velocity[2]))
    assert fastest < 1.002 * EXIT_SPEED
    assert sim.model("b").pose.position[2] == pytest.approx(1.5, abs=3e-3)


def test_a_model_spawned_into_another_model_may_have_a_sensor() -> None:
    sim = simkit.load(world(GROUND, box("a", 0.5)))
    sensor = '<sensor name="s" type="imu"><update_rate>100</update_rate></sensor>'
    sim.spawn(f'<sdf version="1.9">{box("b", 1.45)}</sdf>'.replace("</link>", f"{sensor}</link>"))
    sim.run(0.1)
    assert sim.sensor("b::l::s").latest.header.stamp.nanosec == 100_000_000


def test_touching_bodies_keep_their_contact_parameters() -> None:
    sim = simkit.load(world(GROUND, box("a", 0.499), box("b", 1.497)))
    assert not (sim.mj_model.geom_priority == 2**31 - 1).any()
