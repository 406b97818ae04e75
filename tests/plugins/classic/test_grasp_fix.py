"""Grasp fix: an object between two fingers is attached to the palm and released when the fingers open."""

from __future__ import annotations

import pytest

import simkit

SOLID = "<mass>0.2</mass><inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia>"


def box(size: str, more: str = "") -> str:
    return f'<collision name="c"><geometry><box><size>{size}</size></box></geometry>{more}</collision>'


SLIPPERY = "<surface><friction><ode><mu>0</mu><mu2>0</mu2></ode></friction></surface>"


def finger(name: str, y: float) -> str:
    way = -1 if y > 0 else 1
    return f"""<link name="{name}"><pose>0 {y} 1 0 0 0</pose><inertial>{SOLID}</inertial>
      {box("0.1 0.02 0.1", SLIPPERY)}</link>
      <joint name="{name}_joint" type="prismatic"><parent>palm</parent><child>{name}</child><axis><xyz>0 {way} 0</xyz>
      <limit><lower>-0.05</lower><upper>0.1</upper></limit><dynamics><damping>5</damping></dynamics></axis></joint>"""


def world(parameters: str = "", links: str = "") -> str:
    links = links or (
        "<arm><arm_name>hand</arm_name><palm_link>palm</palm_link><gripper_link>left</gripper_link>"
        "<gripper_link>right</gripper_link></arm>"
    )
    return f"""<sdf version="1.6"><world name="w"><model name="hand">
      <link name="palm"><pose>0 0 1.2 0 0 0</pose><inertial><mass>2</mass></inertial></link>
      <joint name="lift" type="prismatic"><parent>world</parent><child>palm</child><axis><xyz>0 0 1</xyz>
      <limit><lower>0</lower><upper>1</upper></limit></axis></joint>{finger("left", 0.08)}{finger("right", -0.08)}
      <plugin filename="libgazebo_grasp_fix.so" name="grasp">{links}<update_rate>50</update_rate>{parameters}</plugin>
      </model>
      <model name="table"><static>true</static><pose>0 0 0.45 0 0 0</pose><link name="l">{box("1 1 0.9")}</link></model>
      <model name="cube"><pose>0 0 0.95 0 0 0</pose><link name="l"><inertial>{SOLID}</inertial>
      {box("0.1 0.1 0.1", SLIPPERY)}</link></model></world></sdf>"""


def hold(sim: simkit.Simulation, time: float, grip: float, lift: float = 0.0) -> None:
    """Push the fingers together [N] and the palm up [N]."""
    for _ in range(round(time / sim.timestep)):
        for name in ("left_joint", "right_joint"):
            sim.joint(f"hand::{name}").set_effort(grip)
        sim.joint("hand::lift").set_effort(lift)
        sim.step()


def plugin(sim: simkit.Simulation):
    return next(p for p in sim.engine.structure.all_plugins() if type(p).__name__ == "GraspFix")


def test_a_slippery_cube_is_lifted_and_falls_when_the_fingers_open() -> None:
    with simkit.load(world()) as sim:
        hold(sim, 0.5, 5)
        assert plugin(sim).held == "cube::l"
        hold(sim, 0.6, 5, lift=(2 + 3 * 0.2) * 9.8 + 2)
        height = sim.model("cube").pose.position[2]
        assert height > 1.0
        hold(sim, 1.0, -5, lift=(2 + 2 * 0.2) * 9.8)
        assert plugin(sim).held is None
        assert sim.model("cube").pose.position[2] == pytest.approx(0.95, abs=0.01)


def test_without_the_plugin_the_cube_stays_on_the_table() -> None:
    with simkit.load(world().replace("libgazebo_grasp_fix.so", "libnone.so")) as sim:
        hold(sim, 0.5, 5)
        hold(sim, 0.6, 5, lift=(2 + 2 * 0.2) * 9.8 + 2)
        assert sim.model("cube").pose.position[2] == pytest.approx(0.95, abs=0.01)


def test_the_grip_must_last_for_the_threshold() -> None:
    with simkit.load(
        world("<max_grip_count>40</max_grip_count><grip_count_threshold>20</grip_count_threshold>")
    ) as sim:
        hold(sim, 0.35, 5)
        assert plugin(sim).held is None
        hold(sim, 0.4, 5)
        assert plugin(sim).held == "cube::l"


def test_a_push_from_one_side_is_no_grip() -> None:
    with simkit.load(world("<max_grip_count>1</max_grip_count>")) as sim:
        for _ in range(90):  # until the cube reaches the other finger
            sim.joint("hand::left_joint").set_effort(5)
            sim.joint("hand::right_joint").set_effort(-5)
            sim.step()
        assert plugin(sim).held is None
        assert any("left" in contact.first + contact.second for contact in sim.contacts("cube"))


def test_an_attached_object_can_be_without_collisions() -> None:
    with simkit.load(world("<disable_collisions_on_attach>true</disable_collisions_on_attach>")) as sim:
        hold(sim, 0.5, 5)
        assert plugin(sim).held == "cube::l" and not sim.link("cube::l").collisions_enabled
        sim.restore(sim.snapshot())
        for _ in range(20):
            hold(sim, 0.1, 5)  # the fingers close through the cube
            assert plugin(sim).held == "cube::l"
        hold(sim, 1.5, -5)
        assert plugin(sim).held is None and sim.link("cube::l").collisions_enabled


def test_links_may_stand_outside_an_arm_block() -> None:
    links = "<palm_link>palm</palm_link><gripper_link>left</gripper_link><gripper_link>right</gripper_link>"
    with simkit.load(world(links=links)) as sim:
        hold(sim, 0.5, 5)
        assert plugin(sim).held == "cube::l"


@pytest.mark.parametrize(
    ("links", "code"),
    [
        ("<arm><palm_link>none</palm_link><gripper_link>left</gripper_link></arm>", "SK-PLUGIN-003"),
        ("<arm><palm_link>palm</palm_link></arm>", "SK-PARAM-001"),
    ],
)
def test_wrong_links_are_errors(links: str, code: str) -> None:
    with pytest.raises(simkit.InputError, match=code):
        simkit.load(world(links=links))
