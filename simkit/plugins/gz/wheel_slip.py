"""gz's wheel slip: `gz::sim::systems::WheelSlip`."""

from __future__ import annotations

from simkit.plugins.drives.slipping_wheels import SlippingWheels


class WheelSlip(SlippingWheels):
    """Lets wheels slip, along their axle and across it; no `<fdir1>` is needed."""

    filenames = ("gz-sim-wheel-slip-system",)
    names = ("gz::sim::systems::WheelSlip",)
