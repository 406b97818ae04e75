"""What the engine warns of goes to nobody's terminal and into no file of its own."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

BROKEN = """
from simkit.mujoco_import import import_mujoco
import_mujoco()
import mujoco
model = mujoco.MjModel.from_xml_string(
    "<mujoco><worldbody><body><freejoint/><geom size='0.1'/></body></worldbody></mujoco>")
data = mujoco.MjData(model)
data.qpos[0] = float("nan")
mujoco.mj_step(model, data)
print(data.warning.number.sum())
"""


def test_warnings_before_there_is_a_simulation_leave_no_line_and_no_log_file(tmp_path: Path) -> None:
    ran = subprocess.run([sys.executable, "-c", BROKEN], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (ran.stdout, ran.stderr, ran.returncode) == ("1\n", "", 0)
    assert not list(tmp_path.iterdir())


def test_whoever_hears_them_already_goes_on_doing_so(tmp_path: Path) -> None:
    text = BROKEN.replace("from simkit", "import mujoco\nmujoco.set_mju_user_warning(print)\nfrom simkit", 1)
    ran = subprocess.run([sys.executable, "-c", text], cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert ran.stdout.startswith("Nan, Inf or huge value in QPOS") and ran.stdout.endswith("1\n")
