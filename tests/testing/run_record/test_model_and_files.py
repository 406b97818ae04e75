"""Values of the compiled model, and files that meshes refer to."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from simkit.cli import app
from simkit.run_spec import RunSpec
from simkit.testing.golden.compare.runs import compare
from simkit.testing.run_record.record import RunRecord
from simkit.testing.run_record.run_recorder import record_run

ARM = """<mujoco><worldbody><body name="arm"><joint name="j" axis="0 1 0"/><geom name="g" type="box" size=".1 .1 .1"/>
</body></worldbody><actuator><motor name="m" joint="j" gear="{gear}"/></actuator></mujoco>"""
ROOM = """<sdf version="1.9"><world name="w"><model name="nose"><static>true</static><link name="l"><visual name="v">
<geometry><mesh><uri>nose.obj</uri></mesh></geometry></visual></link></model></world></sdf>"""
OBJ = """mtllib nose.mtl
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vt 0 0
usemtl skin
f 1/1 3/1 2/1
f 1/1 2/1 4/1
f 1/1 4/1 3/1
f 2/1 3/1 4/1
"""


def taken(world: Path) -> RunRecord:
    found = record_run(RunSpec(str(world), duration=0.01))
    found.simulation.close()
    return found


def test_a_changed_gear_without_effect_is_a_difference_of_the_model(tmp_path: Path) -> None:
    world = tmp_path / "arm.xml"
    records = []
    for gear in ("10", "20"):
        world.write_text(ARM.format(gear=gear))
        records.append(taken(world))
    (found,) = compare(*records).differences
    assert found.kind == "model" and "gear" in found.words and "10.0" in found.words and "20.0" in found.words
    assert compare(records[0], records[0]).passed
    assert compare(*records, exact=False).passed


@pytest.mark.parametrize("name", ["nose.mtl", "skin.png"])
def test_a_file_that_a_mesh_names_itself_belongs_to_the_run(tmp_path: Path, name: str) -> None:
    from PIL import Image

    (tmp_path / "room.sdf").write_text(ROOM)
    (tmp_path / "nose.obj").write_text(OBJ)
    (tmp_path / "nose.mtl").write_text("newmtl skin\nKd 1 0 0\nmap_Kd skin.png\n")
    Image.new("RGB", (4, 4)).save(tmp_path / "skin.png")
    golden = taken(tmp_path / "room.sdf")
    assert {"nose.obj", "nose.mtl"} <= golden.sources.keys()
    with (tmp_path / name).open("ab") as file:
        file.write(b"\n")
    changed = [d.field for d in compare(golden, taken(tmp_path / "room.sdf")).differences]
    assert changed == [name]


STRAY = """import os
import simkit

class Stray(simkit.WorldPlugin):
    def load(self, sim, params):
        print("loading")

    def before_step(self):
        if self.sim.tick == 3:
            print("stepping")
            os.chdir(os.sep)
            if os.name == "posix":
                child = os.fork()
                if not child:
                    os._exit(0)
                os.waitpid(child, 0)
"""


@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_plugin_that_prints_forks_or_changes_the_folder_is_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / "ü ber"
    folder.mkdir()
    (folder / "stray.py").write_text(STRAY)
    (folder / "w.sdf").write_text(
        '<sdf version="1.9"><world name="w"><plugin filename="stray.py" name="stray::Stray"/></world></sdf>'
    )
    (folder / "s c.yaml").write_text("world: w.sdf\nduration: 0.05\nplugin_paths: [.]\n")
    monkeypatch.chdir(folder)
    done = CliRunner().invoke(app, ["golden", "record", "s c.yaml", "--out", "gold en", "--plugin-path", "."])
    assert done.exit_code == 0, done.output
    assert (folder / "gold en" / "golden.json").is_file() and Path.cwd() == folder
    done = CliRunner().invoke(app, ["golden", "check", "gold en", "--json", "--plugin-path", "."])
    assert done.exit_code == 0 and json.loads(done.stdout)["passed"] and "stepping" in done.stderr
