"""The tests of docs/testing_with_golden.md: written as they stand there, they pass once their golden runs are there."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOM = """<sdf version="1.9"><world name="room">
  <model name="puck"><pose>0 0 0.1 0 0 0</pose><link name="body">
    <inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
    <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
    <sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor>
    <sensor name="scan" type="gpu_lidar"><update_rate>10</update_rate><topic>scan</topic><lidar>
      <scan><horizontal><samples>60</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
      <range><min>0.2</min><max>10</max></range>
    </lidar></sensor>
  </link><plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/></model>
  <model name="walls"><static>1</static><link name="l">
    <visual name="v"><pose>2 0 1 0 0 0</pose><geometry><box><size>0.1 6 2</size></box></geometry></visual>
    <collision name="ground"><geometry><plane/></geometry></collision>
  </link></model>
</world></sdf>
"""


def pytest_says(folder: Path, *arguments: str) -> str:
    alone = ["-p", "simkit.pytest_plugin", "-p", "no:cacheprovider", "-q", "--rootdir", str(folder), "-c", os.devnull]
    environment = {**os.environ, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1", "PYTHONPATH": str(ROOT), "COLUMNS": "120"}
    command = [sys.executable, "-m", "pytest", *alone, *arguments]
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    return done.stdout + done.stderr


@pytest.mark.slow
def test_every_test_of_the_page_passes_once_its_golden_run_is_written(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "testing_with_golden.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    count = sum(block.count("def test_") for block in blocks)
    (tmp_path / "room.sdf").write_text(ROOM)
    (tmp_path / "test_room.py").write_text("\n\n".join(blocks))
    assert f"{count} failed" in pytest_says(tmp_path)
    assert f"{count} passed" in pytest_says(tmp_path, "--simkit-update-golden")
    assert f"{count} passed" in pytest_says(tmp_path)
    assert (tmp_path / "golden/test_room/test_the_scan_is_as_it_was/golden.json").is_file()


def test_every_option_of_the_page_is_one(tmp_path: Path) -> None:
    text = (ROOT / "docs" / "testing_with_golden.md").read_text(encoding="utf-8")
    options = set(re.findall(r"--simkit-[a-z-]+", text))
    assert options == set(re.findall(r"--simkit-[a-z-]+", pytest_says(tmp_path, "--help")))
