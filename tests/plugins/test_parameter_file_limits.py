"""Parameter files of strangers: dotted keys count as levels, and many controllers are looked up in linear time."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.diagnostics import Diagnostics
from simkit.plugins.ros_parameter_files import ParameterFiles, read_parameter_file

ROBOT = (
    '<sdf version="1.9"><model name="m"><link name="l"/><plugin filename="gz_ros2_control-system" '
    'name="gz_ros2_control::GazeboSimROS2ControlPlugin"><parameters>p.yaml</parameters></plugin></model></sdf>'
)


@pytest.mark.parametrize(("levels", "fits"), [(98, True), (99, False), (400, False)])
def test_a_dotted_key_has_as_many_levels_as_names(tmp_path: Path, levels: int, fits: bool) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(f"node:\n  ros__parameters:\n    {'.'.join('a' * levels)}: 1\n")
    diagnostics = Diagnostics()
    assert (read_parameter_file(path, diagnostics) is not None) is fits
    assert [d.code for d in diagnostics] == ([] if fits else ["SK-CONTROL-002"])
    (tmp_path / "m.sdf").write_text(ROBOT)
    assert not [d for d in simkit.check(tmp_path / "m.sdf") if "Error" in d.message]


@pytest.mark.slow
def test_a_thousand_controllers_are_looked_up_once_each(tmp_path: Path) -> None:
    """Without the memory of `ParameterFiles`, the time is cubic: minutes for 500 controllers."""
    types = "".join(f"    c{i}: {{type: pid_controller/PidController}}\n" for i in range(1000))
    nodes = "".join(f"c{i}:\n  ros__parameters:\n    dof_names: [c{i + 1}/x]\n" for i in range(1000))
    (tmp_path / "p.yaml").write_text(f"controller_manager:\n  ros__parameters:\n    update_rate: 100\n{types}{nodes}")
    (tmp_path / "m.sdf").write_text(ROBOT)
    assert len([d for d in simkit.check(tmp_path / "m.sdf") if "c999" in d.message]) == 1
    read = read_parameter_file(tmp_path / "p.yaml", Diagnostics())
    assert read is not None
    files = ParameterFiles([read])
    assert files.of_node("/c1") is files.of_node("/c1") and files.nodes_below("") is files.nodes_below("")
