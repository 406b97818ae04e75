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
[simkit.plugins]
height_monitor = my_plugin:HeightMonitor
[simkit.loaders]
boxes = my_format:BoxesLoader
"""
PROGRAM = '''import simkit

WORLD = """<sdf version="1.9"><world name="w"><model name="tower"><pose>0 0 100 0 0 0</pose><static>true</static>
  <link name="top"><sensor name="t" type="thermometer"><update_rate>10</update_rate><topic>air</topic></sensor></link>
  <plugin filename="gz-sim-height-monitor-system" name="gz::sim::systems::HeightMonitor"><limit>99</limit></plugin>
</model></world></sdf>"""
with simkit.load(WORLD, strict=True) as sim:
    air, is_high = sim.subscribe("/air"), sim.subscribe("/model/tower/is_high")
    sim.run(1.0)
    assert abs(air.latest.temperature - 14.35) < 1e-9  # 15 °C less 6.5 mK a metre
    assert len(is_high.messages) == 10 and is_high.latest.data
with simkit.load("<boxes><box><name>crate</name><x>2</x><size>0.4</size></box></boxes>", strict=True) as sim:
    sim.run(0.1)
    assert abs(sim.model("crate").pose.position - (2, 0, 0.2)).max() < 1e-3
'''


def test_the_examples_of_the_pages_are_found_through_entry_points(tmp_path: Path) -> None:
    for name in ("sensor", "plugin", "format"):
        page = (ROOT / "docs" / f"adding_a_{name}.md").read_text(encoding="utf-8")
        example = re.search(r"^```python\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)
        assert example is not None
        (tmp_path / f"my_{name}.py").write_text(example[1], encoding="utf-8")
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
