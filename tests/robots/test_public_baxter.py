"""Baxter as others publish it: the file of the package example-robot-data has our numbers, and follows commands."""

from __future__ import annotations

from importlib import metadata
from pathlib import Path

import numpy as np
import pytest

import simkit


def _robot() -> Path | None:
    """The published file, if its package is installed."""
    try:
        files = metadata.files("example-robot-data") or []
    except metadata.PackageNotFoundError:
        return None
    found = [Path(str(f.locate())) for f in files if str(f).endswith("baxter_description/urdf/baxter.urdf")]
    return found[0] if found and found[0].is_file() else None


FILE = _robot()
pytestmark = pytest.mark.skipif(FILE is None, reason="example-robot-data is not installed")
OWN_CENTRE = {"pedestal"}  # its published centre of mass is 0.93 m above the ground
OWN_PLACE = {"left_gripper", "right_gripper"}  # at the tips of other fingers
PLUGIN = """<gazebo><plugin name="baxter_ros_control" filename="libbaxter_gazebo_ros_control.so">
<robotNamespace>/robot</robotNamespace></plugin></gazebo></robot>"""


def test_links_and_joints_have_the_numbers_of_the_published_file() -> None:
    public, ours = (simkit.describe(file)["model"] for file in (FILE, "baxter.urdf"))
    links = {link["name"]: link for link in ours["links"]}
    compared = 0
    for link in public["links"]:
        own = links.get(link["name"])
        if own is None:
            continue
        compared += 1
        assert own["mass"] == pytest.approx(link["mass"], abs=1e-4), link["name"]
        assert np.ravel(own["inertia_com_linkframe"]) == pytest.approx(
            np.ravel(link["inertia_com_linkframe"]), abs=1e-4
        )
        if link["name"] not in OWN_PLACE:
            assert own["pose_world"][:3] == pytest.approx(link["pose_world"][:3], abs=1e-6), link["name"]
        if link["name"] not in OWN_PLACE | OWN_CENTRE:
            assert own["com_world"] == pytest.approx(link["com_world"], abs=1e-5), link["name"]
    assert compared >= 25
    joints = {joint["name"]: joint for joint in ours["joints"]}
    moving = [joint for joint in public["joints"] if joint["type"] != "fixed"]
    assert len(moving) == 19
    for joint in moving:
        for what in ("lower", "upper", "effort", "velocity", "damping"):
            assert joints[joint["name"]]["axes"][0][what] == pytest.approx(joint["axes"][0][what]), joint["name"]


@pytest.mark.slow
def test_with_the_plugin_of_baxter_simulator_the_published_robot_follows_commands(tmp_path: Path) -> None:
    assert FILE is not None
    file = tmp_path / "baxter.urdf"
    file.write_text(FILE.read_text(encoding="utf-8").replace("</robot>", PLUGIN), encoding="utf-8")
    packages = {"example-robot-data": FILE.parents[3]}
    with simkit.load(file, package_paths=packages, overrides=["physics.max_step_size=0.002"]) as sim:
        assert [str(d) for d in sim.diagnostics if d.severity == "error"] == []
        sim.publish("/robot/set_super_enable", {"data": True})
        sim.run(0.01)
        names, values = ["left_s0", "left_e1"], [0.2, 0.8]
        sim.publish("/robot/limb/left/joint_command", {"mode": 1, "names": names, "command": values})
        sim.run(2.5)
        assert [float(sim.joint(f"baxter::{name}").position) for name in names] == pytest.approx(values, abs=5e-3)
