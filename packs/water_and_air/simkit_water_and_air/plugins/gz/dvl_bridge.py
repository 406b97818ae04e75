"""Bridge of dave from gz's Doppler velocity log to ROS: `DVLBridge`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit import Params, Plugin
from simkit.extend import Options, OptionsOf, without_effect

if TYPE_CHECKING:
    from simkit import Model


class DvlBridgeOptions(Options):
    """Options of `DvlBridge`."""

    topic: bool = without_effect()


class DvlBridge(Plugin):
    """Has no effect: the sensor `dvl` publishes the message of this bridge itself."""

    parent_kind = ("world", "model", "sensor")
    options = OptionsOf(DvlBridgeOptions)
    filenames = ("DVLBridge",)
    names = ("dave_ros_gz_plugins::DVLBridge",)

    def load(self, parent: Model, params: Params) -> None:
        self.options.read_all()
