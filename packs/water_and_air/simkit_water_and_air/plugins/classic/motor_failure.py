"""Failure of a motor of PX4's models for Gazebo Classic: `libgazebo_motor_failure_plugin.so`.

Topics are those of `gazebo_motor_failure_plugin.cpp` and `gazebo_motor_model.h` of PX4-SITL_gazebo-classic.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params
from simkit.extend import Options, OptionsOf, listens, text
from simkit_water_and_air.plugins.gz.motor_failure import INTEGER, MotorFailureBase

if TYPE_CHECKING:
    from simkit import Model


class ClassicMotorFailureOptions(Options):
    """Options of `ClassicMotorFailure`."""

    namespace: str = text(element="robotNamespace")
    ros_topic: str = text("/motor_failure/motor_number", element="ROSMotorNumSubTopic")
    gazebo_topic: str = text("/gazebo/motor_failure_num", element="MotorFailureNumPubTopic")


class ClassicMotorFailure(MotorFailureBase):
    """Stops one motor of a multicopter: its number, from 1, is an `Int32` message; 0 repairs it.

    The topic is `<ROSMotorNumSubTopic>` (`/motor_failure/motor_number`) or `<MotorFailureNumPubTopic>`
    (`/gazebo/motor_failure_num`).
    """

    endpoints = (
        listens("/motor_failure/motor_number", INTEGER, named_by=("ROSMotorNumSubTopic",)),
        listens("/gazebo/motor_failure_num", INTEGER, named_by=("MotorFailureNumPubTopic",)),
    )
    options = OptionsOf(ClassicMotorFailureOptions)
    filenames = ("libgazebo_motor_failure_plugin.so",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        self.start(options.ros_topic)
        self.listen(options.gazebo_topic, INTEGER, self._on_number)
