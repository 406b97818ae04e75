"""Imports of the command line leave the garbage collector on, and garbage of a run is still collected."""

from __future__ import annotations

import gc
import subprocess
import sys
from pathlib import Path

from simkit.garbage_collection import no_collection, permanent_imports

ROOT = Path(__file__).resolve().parents[1]
PLUGIN = """
from simkit import WorldPlugin

class Log(WorldPlugin):
    names = ("log",)

    def load(self, parent, params):
        self.file = open("log.txt", "w")
        self.file.write("not flushed")
"""
WORLD = """<sdf version="1.9"><world name="w"><plugin filename="log_plugin.py:Log" name="log"/></world></sdf>"""


def test_the_collector_is_off_inside_and_as_before_afterwards():
    assert gc.isenabled()
    with no_collection():
        with permanent_imports():
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled()


def test_objects_are_kept_for_ever_only_if_a_module_was_imported():
    code = """
import gc
from simkit.garbage_collection import permanent_imports
with permanent_imports():
    import gc
counts = [gc.get_freeze_count()]
with permanent_imports():
    import colorsys
counts.append(gc.get_freeze_count())
print(counts[0], counts[1] > 0, gc.isenabled())
"""
    found = subprocess.run([sys.executable, "-S", "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert found.stdout.split() == ["0", "True", "True"]


def test_a_file_that_a_plugin_leaves_open_is_written_at_the_end_of_the_command(tmp_path):
    (tmp_path / "log_plugin.py").write_text(PLUGIN)
    (tmp_path / "w.sdf").write_text(WORLD)
    words = ("-m", "simkit", "run", "w.sdf", "--duration", "0", "--plugin-path", ".")
    subprocess.run([sys.executable, *words], cwd=tmp_path, check=True, capture_output=True)
    assert (tmp_path / "log.txt").read_text() == "not flushed"
