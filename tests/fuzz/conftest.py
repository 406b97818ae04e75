"""Lets the tests of this folder import its other modules, and the makers of meshes and of wide SDF files."""

import sys
from pathlib import Path

for folder in ("fuzz", "compiler", "loaders"):
    sys.path.insert(0, str(Path(__file__).parents[1] / folder))
