"""The workflow for CI that users copy, and the page about it, do what they say in a project as a user would have it."""

from __future__ import annotations

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.testing import CliRunner

from simkit.cli import app

pytestmark = pytest.mark.slow  # processes and whole runs

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "ci.md").read_text(encoding="utf-8")
WORKFLOW = ROOT / "docs" / "ci" / "simkit.yml"

WORLD = """<?xml version="1.0"?>
<sdf version="1.9"><world name="hall">
  <model name="ground"><static>true</static><link name="link"><collision name="c"><geometry><plane>
    <normal>0 0 1</normal><size>20 20</size></plane></geometry></collision></link></model>
  <model name="door"><static>true</static><pose>4 0 0.5 0 0 0</pose><link name="link"><collision name="c"><geometry>
    <box><size>0.1 2 1</size></box></geometry></collision></link></model>
  <model name="robot"><pose>0 0 0.1 0 0 0</pose>
    <link name="base"><inertial><mass>5</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
      <collision name="c"><geometry><box><size>0.4 0.3 0.2</size></box></geometry></collision>
      <sensor name="lidar" type="gpu_lidar"><pose>0 0 0.2 0 0 0</pose><update_rate>5</update_rate><topic>/scan</topic>
        <always_on>1</always_on><lidar><scan><horizontal><samples>36</samples><min_angle>-3.14</min_angle>
        <max_angle>3.14</max_angle></horizontal></scan><range><min>0.1</min><max>8</max></range></lidar></sensor></link>
    <plugin name="gz::sim::systems::VelocityControl" filename="gz-sim-velocity-control-system"><topic>/cmd_vel</topic>
    </plugin></model>
</world></sdf>
"""
FILES = {
    "worlds/my_world.sdf": WORLD,
    "drives/to_the_door.yaml": "- {at: 0.1, topic: /cmd_vel, message: {linear: {x: 0.6}}}\n",
    "test_world.py": "def test_it_opens(simkit_world):\n    simkit_world('worlds/my_world.sdf').run(0.01)\n",
}


def simkit(line: str) -> str:
    """What a line of the shell prints; it ends well."""
    done = CliRunner().invoke(app, shlex.split(line)[1:])
    assert done.exit_code == 0, (line, done.output)
    return done.output


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    for name, text in FILES.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    simkit("simkit golden record worlds/my_world.sdf --duration 0.3 --out golden/hall")
    return tmp_path


def steps() -> list[dict[str, Any]]:
    jobs = yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))["jobs"]
    return [step for job in jobs.values() for step in job["steps"]]


def test_every_step_of_the_workflow_ends_well(project):
    lines = [step["run"].strip() for step in steps() if "run" in step]
    ours = [line for line in lines if line.startswith("simkit ")]
    assert [line.split()[1] for line in ours] == ["doctor", "check", "golden", "run"]
    for line in ours:
        simkit(line)
    (tests,) = (shlex.split(line) for line in lines if line.startswith("pytest "))
    alone = [word for word in tests[1:] if word not in ("-n", "auto")]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
    subprocess.run([sys.executable, "-m", "pytest", *alone], check=True, env=environment, capture_output=True)
    (kept,) = (step["with"]["path"] for step in steps() if "upload" in step.get("uses", ""))
    left = {path.name for path in (project / kept).iterdir()}
    assert left == {"golden.html", "golden.xml", "drive.xml", "tests.xml"}


def test_the_workflow_fails_where_the_world_was_changed_and_leaves_what_repeats_it(project):
    world = project / "worlds" / "my_world.sdf"
    world.write_text(WORLD.replace("<pose>4 0 0.5", "<pose>2.2 0 0.5"))
    codes = {}
    for step in steps():
        words = shlex.split(step.get("run", "").replace("--timeout 30", "--timeout 1"))
        if words[:1] == ["simkit"] and words[1] in ("golden", "run"):
            codes[words[1]] = CliRunner().invoke(app, words[1:]).exit_code
    assert codes == {"golden": 5, "run": 5}
    assert "simkit replay report/….zip" in WORKFLOW.read_text(encoding="utf-8")
    (bundle,) = (project / "report").glob("*.zip")
    simkit(f"simkit replay {bundle}")


def test_the_lines_for_another_ci_work(project):
    _, block = re.findall(r"^```sh\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    *_, line = block.splitlines()
    assert line.startswith(".venv/bin/simkit golden check")
    simkit(line)
    assert (project / "golden.xml").is_file()
