"""NumPy in programs: names of NumPy 1, which ROS 2 Humble and Jazzy have."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

TEXT = """
import math, numpy as np
from numpy.core.numeric import Infinity
import numpy.linalg

assert np.Inf == Infinity == np.infty == math.inf and np.NINF == -np.inf
assert np.isnan(np.NaN) and np.float_ is np.float64
assert np.product([2, 3]) == 6 and np.alltrue([True]) and not np.sometrue([False])
assert np.mat is np.asmatrix
assert np.in1d([[1, 2]], [2]).tolist() == [False, True]
assert np.trapz([1.0, 3.0]) == 2.0
assert np.asfarray([1]).dtype == float
assert numpy.linalg.norm(np.array([3.0, 4.0])) == 5.0
assert isinstance(np.testing, type(np.linalg))
np.random.seed(0)
print(type(np.zeros(1)).__module__)
"""


def test_a_program_can_use_names_that_numpy_2_has_left_out(run_program: Callable[..., list[str]]) -> None:
    assert run_program(TEXT)[-1].endswith("numpy")
    assert not hasattr(np, "Inf")  # simkit's own module has not changed


@pytest.mark.slow
def test_the_virtual_environment_may_be_in_the_folder_of_the_program(tmp_path: Path) -> None:
    packages = tmp_path / ".venv" / "site-packages"
    packages.mkdir(parents=True)
    installed = Path(np.__file__).parents[1]
    for folder in [installed / "numpy", *installed.glob("numpy.libs")]:
        (packages / folder.name).symlink_to(folder)
    (tmp_path / "program.py").write_text("import numpy as np\nprint(np.random.rand(2).shape)\n", encoding="utf-8")
    (tmp_path / "empty.sdf").write_text('<sdf version="1.9"><world name="w"/></sdf>', encoding="utf-8")
    words = [sys.executable, "-m", "simkit", "run", "empty.sdf", "--duration", "0.01", "--node", "program.py"]
    path = os.pathsep.join([str(packages), *filter(None, [os.environ.get("PYTHONPATH")])])
    environment = {**os.environ, "PYTHONPATH": path}
    done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert (done.returncode, "(2,)" in done.stdout + done.stderr) == (0, True), done.stderr
