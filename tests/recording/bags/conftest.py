"""Lets the tests of this folder import the maker of damaged bags."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "fuzz"))
