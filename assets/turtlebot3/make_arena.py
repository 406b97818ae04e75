"""Writes the arena of `worlds/turtlebot3_world.sdf` as the model `turtlebot3_world`, which worlds include by its URI.

python assets/turtlebot3/make_arena.py
"""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).parent
WORLD = FOLDER.parents[1] / "worlds" / "turtlebot3_world.sdf"
HEAD = """<?xml version="1.0"?>
<!--
  The arena of the world turtlebot3_world as a model: a hexagon of walls around nine pillars. make_arena.py writes this
  file. Lengths m, angles rad unless the element says deg.
-->
<sdf version="1.12">
"""


def files() -> dict[str, str]:
    """Return the model's file: the element `arena` of the world under another name, indented less."""
    pattern = r'^    <model name="arena">\n.*?^    </model>\n'
    found = re.search(pattern, WORLD.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    assert found is not None
    element = found[0].replace('name="arena"', 'name="turtlebot3_world"', 1)
    return {"turtlebot3_world/model.sdf": HEAD + re.sub(r"^  ", "", element, flags=re.MULTILINE) + "</sdf>\n"}


if __name__ == "__main__":
    for path, text in files().items():
        (FOLDER / path).write_text(text, encoding="utf-8")
