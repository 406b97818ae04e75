"""The pages that show how a sensor, a plugin and a format are added: their examples work as a package of a user."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ENTRY_POINTS = """[simkit.sensors]
thermometer = my_sensor:Thermometer
height = my_height:Height
[simkit.plugins]
fleet_brake = my_brake:Brake
height_monitor = my_plugin:HeightMonitor
[simkit.loaders]
boxes = my_format:BoxesLoader
"""
PROGRAM = '''from pathlib import Path

import simkit

WORLD = """<sdf version="1.9" xmlns:gz="http://gazebosim.org/schema" xmlns:simkit="simkit">
<world name="w"><model name="tower"><pose>0 0 100 0 0 0</pose><static>true</static>
  <link name="top"><sensor name="t" type="thermometer"><update_rate>10</update_rate><topic>air</topic></sensor>
  SENSOR_FOR_GAZEBO</link>
  <plugin filename="fleet_brake" name="brake"><topic>halt</topic></plugin>
  <plugin filename="gz-sim-height-monitor-system" name="gz::sim::systems::HeightMonitor"><limit>99</limit></plugin>
</model><model name="ball"><pose>0 0 100 0 0 0</pose>
  <link name="l"><sensor name="h" type="height"><update_rate>10</update_rate><topic>high</topic></sensor></link>
</model></world></sdf>"""
with simkit.load(WORLD.replace("SENSOR_FOR_GAZEBO", Path("sensor.xml").read_text()), strict=True) as sim:
    air, is_high, heights = map(sim.subscribe, ("/air", "/model/tower/is_high", "/high"))
    sim.run(1.0)
    assert abs(air.latest.temperature - 14.35) < 1e-9  # 15 °C less 6.5 mK a metre
    assert sim.sensor("tower::top::air").options.noise.stddev == 0.1
    assert len(is_high.messages) == 10 and is_high.latest.data
    assert 0.0 < abs(heights.latest.data - (100.0 - 0.5 * 9.8)) < 0.1, heights.latest
    assert "/halt" in sim.topics()
with simkit.load("<boxes><box><name>crate</name><x>2</x><size>0.4</size></box></boxes>", strict=True) as sim:
    sim.run(0.1)
    assert abs(sim.model("crate").pose.position - (2, 0, 0.2)).max() < 1e-3
'''


def test_the_examples_of_the_pages_are_found_through_entry_points(tmp_path: Path) -> None:
    for name, page, index in (
        ("sensor", "adding_a_sensor", 0),
        ("height", "adding_a_sensor", 1),
        ("plugin", "adding_a_plugin", 0),
        ("brake", "extend", 0),
        ("format", "adding_a_format", 0),
    ):
        text = (ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8")
        examples = re.findall(r"^```python\n(.*?)^```", text, flags=re.DOTALL | re.MULTILINE)
        (tmp_path / f"my_{name}.py").write_text(examples[index], encoding="utf-8")
        if name in ("sensor", "height"):
            assert examples[index].startswith('"""'), "the file needs a docstring, as every module of simkit"
    for_gazebo = re.search(r"```xml\n(.*?)^```", (ROOT / "docs" / "adding_a_sensor.md").read_text("utf-8"), re.S | re.M)
    assert for_gazebo is not None
    (tmp_path / "sensor.xml").write_text(for_gazebo[1], encoding="utf-8")
    info = tmp_path / "my_package-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1.0\n", encoding="utf-8")
    (info / "entry_points.txt").write_text(ENTRY_POINTS, encoding="utf-8")
    paths = os.pathsep.join([str(tmp_path), str(ROOT)])
    environment = {**os.environ, "PYTHONPATH": paths}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=environment, cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
