"""Joints that follow other joints by the plugin of the robotics group of Patras."""

from __future__ import annotations

import pytest

import simkit

NAMES = ("libroboticsgroup_upatras_gazebo_mimic_joint_plugin.so", "libroboticsgroup_gazebo_mimic_joint_plugin.so")


def finger(name: str, y: float) -> str:
    return f"""<link name="{name}"><pose>0 {y} 1 0 0 0</pose><inertial><mass>0.1</mass>
      <inertia><ixx>1e-3</ixx><iyy>1e-3</iyy><izz>1e-3</izz></inertia></inertial></link>
      <joint name="{name}_joint" type="revolute"><parent>palm</parent><child>{name}</child>
      <axis><xyz>0 1 0</xyz><limit><lower>-2</lower><upper>2</upper></limit>
      <dynamics><damping>0.1</damping></dynamics></axis>
      </joint>"""


def world(parameters: str, library: str = NAMES[0]) -> str:
    return f"""<sdf version="1.6"><world name="w"><gravity>0 0 0</gravity><model name="hand">
      <link name="palm"><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>
      <joint name="held" type="fixed"><parent>world</parent><child>palm</child></joint>
      {finger("left", 0.1)}{finger("right", -0.1)}<plugin filename="{library}" name="mimic">{parameters}</plugin>
      </model></world></sdf>"""


BOTH = "<joint>left_joint</joint><mimicJoint>right_joint</mimicJoint>"


@pytest.mark.parametrize("library", NAMES)
@pytest.mark.parametrize(
    ("more", "expected"), [("", (1, 0)), ("<multiplier>-0.5</multiplier><offset>0.2</offset>", (-0.5, 0.2))]
)
def test_a_joint_follows_its_leader(library: str, more: str, expected: tuple[float, float]) -> None:
    with simkit.load(world(BOTH + more + "<hasPID/><maxEffort>5</maxEffort>", library)) as sim:
        assert not [found for found in sim.diagnostics if found.severity == "warning"]
        left, right = sim.joint("hand::left_joint"), sim.joint("hand::right_joint")
        for _ in range(400):
            left.set_effort(0.05)
            sim.step()
        assert left.position > 0.09
        multiplier, offset = expected
        assert right.position == pytest.approx(multiplier * left.position + offset, abs=1e-3)


@pytest.mark.parametrize("parameters", ["", "<joint>left_joint</joint>", "<joint>a</joint><mimicJoint>a</mimicJoint>"])
def test_missing_names_are_errors(parameters: str) -> None:
    with pytest.raises(simkit.InputError, match=r"SK-PARAM-00[12]|SK-PLUGIN-003"):
        simkit.load(world(parameters), strict=True)


@pytest.mark.parametrize("name", ["thumb", "held"])
def test_a_joint_that_cannot_follow_is_a_warning_as_in_gazebo(name: str) -> None:
    with simkit.load(world(f"<joint>left_joint</joint><mimicJoint>{name}</mimicJoint>")) as sim:
        (found,) = [found for found in sim.diagnostics if found.severity == "warning"]
        assert found.code == "SK-PLUGIN-003" and name in found.message and "mimics" in found.message


def test_the_first_of_two_plugins_for_a_joint_counts() -> None:
    second = f'</plugin><plugin filename="{NAMES[0]}" name="again">{BOTH}<multiplier>-3</multiplier>'
    with simkit.load(world(BOTH + second)) as sim:
        (found,) = [found for found in sim.diagnostics if found.severity == "warning"]
        assert found.code == "SK-PLUGIN-003" and "'right_joint' follows another joint already" in found.message
        for _ in range(400):
            sim.joint("hand::left_joint").set_effort(0.05)
            sim.step()
        assert sim.joint("hand::right_joint").position == pytest.approx(
            sim.joint("hand::left_joint").position, abs=1e-3
        )


def test_a_joint_does_not_follow_itself() -> None:
    with pytest.raises(simkit.InputError, match="SK-PARAM-002"):
        simkit.load(world("<joint>left_joint</joint><mimicJoint>left_joint</mimicJoint>"))
