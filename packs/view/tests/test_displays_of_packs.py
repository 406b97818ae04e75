"""A pack outside the repository brings a display, and the names of the pack view are lazy."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

DISPLAY = '''
"""Display of temperatures."""

from simkit_view.displays.display import NewestMessage


class TemperatureDisplay(NewestMessage):
    """Temperature as a text."""

    types = ("sensor_msgs/msg/Temperature",)
'''
WITHOUT_PACK = """
import sys

class Missing:
    def find_spec(self, name, *_):
        if name.startswith("simkit_"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Missing())
import simkit

with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim:
    try:
        sim.view()
    except simkit.InputError as error:
        print(error)
"""


def python(program: str, folder: Path) -> str:
    environment = {**os.environ, "PYTHONPATH": str(folder)}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout


def test_a_pack_brings_a_display(tmp_path: Path) -> None:
    displays = tmp_path / "simkit_fleet" / "displays"
    displays.mkdir(parents=True)
    for package in (displays.parent, displays):
        (package / "__init__.py").touch()
    (displays / "temperature.py").write_text(DISPLAY)
    info = tmp_path / "simkit_fleet-0.1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: simkit_fleet\nVersion: 0.1.0\n")
    (info / "entry_points.txt").write_text("[simkit.packs]\nfleet = simkit_fleet\n")
    program = (
        "import sys; from simkit_view.displays.kinds import DISPLAYS; path = DISPLAYS['nav_msgs/msg/Path'];"
        "print('simkit_fleet' in sys.modules, DISPLAYS['sensor_msgs/msg/Temperature'].__module__)"
    )
    assert python(program, tmp_path).split() == ["False", "simkit_fleet.displays.temperature"]


def test_a_script_without_the_pack_is_told_which_one_is_missing(tmp_path: Path) -> None:
    text = python(WITHOUT_PACK, tmp_path)
    assert text.startswith("SK-INPUT-004 sim.view needs the pack view, which is not installed\n    help: install")
