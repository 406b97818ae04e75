"""Value of depths without a return, as the driver of a device writes it."""

from __future__ import annotations

from types import MappingProxyType
from typing import Final

import numpy as np

from simkit import Params
from simkit.extend import Sensor
from simkit_realism.depth_images.depth_artefact import DepthArtefact, Depths, Exposure

_VALUES: Final = MappingProxyType({"nan": np.float32(np.nan), "zero": np.float32(0.0), "inf": np.float32(np.inf)})


class LostDepth(DepthArtefact):
    """`<simkit:lost_depth>` of a depth camera: nan, zero or inf for every pixel without a depth in the range.

    Args:
        params: the element, with `value`.
        sensor: the camera.
    """

    elements = ("depth/lost_depth",)
    order = 100.0

    def __init__(self, params: Params, sensor: Sensor) -> None:
        super().__init__(params, sensor)
        self._value = _VALUES[params.choice("value", tuple(_VALUES), required=True)]

    def change(self, depths: Depths, exposure: Exposure) -> Depths:
        changed = depths.copy()
        np.copyto(changed, self._value, where=~np.isfinite(depths))
        return changed
