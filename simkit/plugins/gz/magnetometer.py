"""The system that a gz world lists for its magnetometers; its two switches are read by the sensors themselves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from simkit.params import Params
from simkit.plugins.base import Plugin
from simkit.plugins.options import Options, OptionsOf, boolean

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder

SWITCHES = ("use_units_gauss", "use_earth_frame_ned")


class MagnetometerSystemOptions(Options):
    """Options of `MagnetometerSystem`."""

    use_units_gauss: bool = boolean(True)
    use_earth_frame_ned: bool = boolean(True)


class MagnetometerSystem(Plugin):
    """Stands for gz's Magnetometer system.

    `<use_units_gauss>` and `<use_earth_frame_ned>`, which Gazebo takes for true where a file does not say, are about
    the Earth's field; here they count where they are written (and in a world with `<gazebo_quirks>`).
    """

    options = OptionsOf(MagnetometerSystemOptions)
    parent_kind = "any"
    filenames = ("gz-sim-magnetometer-system",)
    names = ("gz::sim::systems::Magnetometer",)

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        given = [name for name in SWITCHES if params.has(name)]
        _ = self.options.use_units_gauss, self.options.use_earth_frame_ned
        if not given:
            message = "plugin 'Magnetometer' is not needed: simkit does what it stands for by itself"
            params.diagnostics.note("SK-PLUGIN-005", message, self.where)

    def load(self, parent: object, params: Params) -> None:
        """Nothing to do."""
