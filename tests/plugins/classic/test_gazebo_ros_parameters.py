"""Parameters of the plugins of gazebo_ros_pkgs, compared with those that simkit's plugins read."""

from __future__ import annotations

import pytest
from gazebo_ros_parameters import TABLE, parameters_in

import simkit
from simkit.plugins.discovery.find_plugin_class import UNSUPPORTED, plugin_kinds
from simkit.plugins.unread_parameters import gazebo_ros_parameters, names_read

IGNORED = {
    "gazebo_ros_camera": {"rectification_matrix", "P_fx", "P_fy", "P_cx", "P_cy", "Tx", "Ty"},  # CameraInfo of a file
    "gazebo_ros_wheel_slip": {"link_name"},  # an attribute of <wheel>
    "gazebo_ros_ackermann_drive": {"covariance_x", "covariance_y"},  # read in a loop over the axes
}
"""Names that Gazebo reads and that the text of simkit's plugin does not have."""

BASES = {"gazebo_ros_camera_utils", "gazebo_ros_utils"}  # of other plugins, no libraries of their own

IMU = """<sdf version="1.9"><world name="w"><model name="m"><static>1</static><link name="l">
  <sensor name="s" type="imu"><plugin name="p" filename="libgazebo_ros_imu_sensor.so">{}</plugin></sensor>
  </link></model></world></sdf>"""


@pytest.mark.parametrize("library", sorted(gazebo_ros_parameters().keys() - BASES - UNSUPPORTED.keys()))
def test_a_plugin_reads_all_parameters_that_it_has_in_gazebo(library: str) -> None:
    names = gazebo_ros_parameters()[library] - {"robotNamespace"}
    assert names - names_read(plugin_kinds()[library]) == IGNORED.get(library, set())


def test_the_table_is_that_of_the_program() -> None:
    text = """// _sdf->Get<double>("old");
      auto a = _sdf->Get<double>( "rate", 1.0).first; /* GetElement("x") */ if (_sdf->HasElement("frame_name")) {}
      gazebo_ros_->getParameter<std::string> ( frame, "odometryFrame", "odom" );"""
    assert parameters_in(text) == ["frame_name", "odometryFrame", "rate"]
    assert TABLE.is_file()


@pytest.mark.parametrize(
    ("element", "severity", "text"),
    [
        ("<body_name>base</body_name>", "note", "Gazebo's plugin does not read it either"),
        ("<update_rate>100</update_rate>", "note", "Gazebo's plugin does not read it either"),
        ("<frame_nam>base</frame_nam>", "warning", "is not used"),
    ],
)
def test_a_parameter_of_another_plugin_is_a_note_and_a_misspelt_one_a_warning(
    element: str, severity: str, text: str
) -> None:
    with simkit.load(IMU.format(element)) as sim:
        (found,) = (d for d in sim.diagnostics if d.code == "SK-PARAM-003")
        assert found.severity == severity
        assert text in found.message
