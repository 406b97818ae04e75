"""Inertial measurement units."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import sensor


def _reference(content: str) -> str:
    return f"<imu><orientation_reference_frame>\n  {content}\n</orientation_reference_frame></imu>"


CODES: tuple[Code, ...] = (
    Code(
        "SK-SENSOR-070",
        "error",
        "the `parent_frame` of an IMU's orientation reference is no frame that the sensor's model or the world has",
        "`world`, or the name of a link, joint, frame or model; as in SDF, names beside the sensor's link come first",
        sensor(
            "imu",
            _reference(
                '<localization>CUSTOM</localization>\n  <custom_rpy parent_frame="wrold">0 0 1.57</custom_rpy>',
            ),
        ),
    ),
    Code(
        "SK-SENSOR-071",
        "error",
        "an IMU's reference by gravity has no direction: there is no gravity, or `<grav_dir_x>` is along it",
        "its part orthogonal to gravity is the reference's x axis; without gravity, take ENU, NED, NWU or CUSTOM",
        sensor(
            "imu",
            _reference(
                '<localization>GRAV_UP</localization>\n  <grav_dir_x parent_frame="world">0 0 1</grav_dir_x>',
            ),
        ),
    ),
    Code(
        "SK-SENSOR-072",
        "note",
        "`<xyzOffset>` of the classic IMU plugin changes no reading, as in Gazebo",
        "the sensor's `<pose>` puts it elsewhere on its link",
        sensor(
            "imu",
            '<plugin name="imu" filename="libgazebo_ros_imu_sensor.so"><xyzOffset>0 0 1</xyzOffset></plugin>',
        ),
    ),
)
