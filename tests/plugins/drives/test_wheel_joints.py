"""Requirements of a joint that a drive turns as a wheel."""

from __future__ import annotations

import re

import pytest
from plugin_worlds import GROUND, classic_drive, element, gz_drive, rover, world

import simkit


def errors(text: str) -> list[simkit.Diagnostic]:
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text)
    return [d for d in caught.value.diagnostics if d.severity == "error"]


@pytest.mark.parametrize("drive", [gz_drive, classic_drive])
def test_one_joint_cannot_be_two_wheels(drive: object) -> None:
    (found,) = errors(world(GROUND, rover(drive(right_joint="left_wheel"))))  # type: ignore[operator]
    assert found.code == "SK-PLUGIN-050"
    assert "'left_wheel'" in found.message
    assert found.line is not None


@pytest.mark.parametrize("drive", [gz_drive, classic_drive])
def test_a_prismatic_joint_cannot_be_a_wheel(drive: object) -> None:
    text = world(GROUND, rover(drive())).replace("type='revolute'", "type='prismatic'", 1)  # type: ignore[operator]
    (found,) = errors(text)
    assert found.code == "SK-PLUGIN-051"


def test_a_wheel_joint_with_position_limits_is_reported() -> None:
    text = world(GROUND, rover(gz_drive()))
    with simkit.load(re.sub(r"<lower>-1e16</lower><upper>1e16", "<lower>-1</lower><upper>1", text, count=1)) as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-PLUGIN-052")
    assert "-1 and 1 rad" in found.message
    with simkit.load(text) as sim:
        assert "SK-PLUGIN-052" not in [d.code for d in sim.diagnostics]


@pytest.mark.parametrize("value", [0, -0.1, "nan", "wide"])
@pytest.mark.parametrize("name", ["wheel_separation", "wheel_radius"])
def test_gz_wheels_without_size_are_errors(name: str, value: object) -> None:
    (found,) = errors(world(GROUND, rover(gz_drive(**{name: value}))))
    assert (found.code, name in found.message) == ("SK-PARAM-002", True)


@pytest.mark.parametrize("name", ["wheel_separation", "wheel_diameter", "update_rate", "max_wheel_torque"])
def test_classic_wheels_without_size_and_negative_rates_are_errors(name: str) -> None:
    (found,) = errors(world(GROUND, rover(classic_drive(**{name: -1}))))
    assert (found.code, name in found.message) == ("SK-PARAM-002", True)


def test_all_problems_of_a_drive_are_reported_together() -> None:
    values = {"left_joint": "left_weel", "wheel_radius": 0, "odom_publish_frequency": -50}
    found = errors(world(GROUND, rover(gz_drive(**values))))
    assert sorted(d.code for d in found) == ["SK-PARAM-002", "SK-PARAM-002", "SK-PLUGIN-003"]
    assert any("'left_wheel'" in d.hint for d in found)


def test_ros_1_skid_steering_reports_faults_of_its_four_wheels() -> None:
    values = {"leftFrontJoint": "left_wheel", "rightFrontJoint": "right_whel", "wheelDiameter": 0}
    plugin = element("plugin", values, "name='skid' filename='libgazebo_ros_skid_steer_drive.so'")
    found = errors(world(GROUND, rover(plugin)))
    codes = [d.code for d in found]
    # a misspelt joint, and two joints that are missing under their default names
    assert codes.count("SK-PLUGIN-003") == 3
    assert codes.count("SK-PARAM-002") == 1
