"""Doppler velocity log of ds_sim and dave: `libdsros_ros_dvl.so`.

Parameters and topics are those of `dsros_dvl.cc` and `dsros_dvl_plugin.cc`.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from simkit import Params, SensorPlugin
from simkit.extend import OptionsOf, Vector, publishes
from simkit_water_and_air.plugins.fluids.water_current import CURRENT_TYPES, LAYERS, absolute_topic, current_of
from simkit_water_and_air.sensors.dsros_dvl import CLOUD, DVL, PLUGIN, PROFILE, RANGES, DsrosDvl, DsrosDvlOptions

if TYPE_CHECKING:
    from simkit.msgs import Message

_CURRENT: Final = "hydrodynamics/current_velocity"
_LAYERS: Final = "hydrodynamics/stratified_current_velocity"


class DsrosRosDvl(SensorPlugin):
    """Publishes the readings of its sensor `dsros_dvl`: velocity, ranges, profile of the current, and its beams.

    The velocity of the water comes from the sensor's `<ocean_current_topic>`, and that of each depth from its
    `<stratified_ocean_current_topic>`.
    """

    endpoints = (
        publishes("/{robotNamespace}/dvl", DVL, named_by=("topicName",)),
        publishes("/{robotNamespace}/dvl_ranges", RANGES, named_by=("rangesTopicName",)),
        publishes("/{robotNamespace}/dvl_current", PROFILE, named_by=("topicName",)),
        publishes("/{robotNamespace}/dvl_cloud", CLOUD, named_by=("topicName",)),
    )
    options = OptionsOf(DsrosDvlOptions)
    filenames = (PLUGIN,)

    def load(self, parent: Any, params: Params) -> None:
        options = self.options
        if not isinstance(parent, DsrosDvl):
            self.refuse(parent, "dsros_dvl")
            return
        self._sensor, self._current = parent, np.zeros(3)
        self._layers: tuple[tuple[float, Vector], ...] = ()
        self._has_current = False
        parent.water, parent.frame_id, parent.cloud_frame = self._velocity_at, options.frame, options.cloud_frame
        if 0 < options.rate < (parent.update_rate or math.inf):
            parent.set_rate(options.rate)
        sensor = parent.scene.params
        self.listen(absolute_topic(sensor.text("ocean_current_topic", _CURRENT)), CURRENT_TYPES, self._on_current)
        self.listen(absolute_topic(sensor.text("stratified_ocean_current_topic", _LAYERS)), LAYERS, self._on_layers)
        space = parent.scoped.split("::")[0] if options.namespace is None else options.namespace.strip("/")
        topic, ranges = (
            name if name.startswith("/") else f"/{space}/{name}" for name in (options.topic, options.ranges_topic)
        )
        topics = {"dvl": topic, "ranges": ranges, "cloud": f"{topic}_cloud"}
        if options.tracks_water and options.axes in (0, 1):
            topics["profile"] = f"{topic}_current"
        parent.publish_on(topics)

    def _velocity_at(self, depth: float | None) -> Vector:
        """Return the velocity of the water [m/s] at a depth [m], or that of all depths for None."""
        if depth is None or not self._layers:
            return self._current if depth is None or depth >= 0 else np.zeros(3)
        if depth < 0:
            return np.zeros(3)
        (upper, velocity), layers = self._layers[0], self._layers
        if depth <= upper:
            return velocity
        for (upper, above), (lower, below) in pairwise(layers):
            if upper < depth <= lower:
                return above + (depth - upper) / (lower - upper) * (below - above)
        return layers[-1][1]

    def _on_current(self, message: Message) -> None:
        current = current_of(message)
        if current is not None:
            self._sensor.take_held()  # a pending reading belongs to the old current
            self._current, self._has_current = np.array(current), True

    def _on_layers(self, message: Message) -> None:
        velocities = [np.array((v.x, v.y, v.z)) for v in message.velocities]
        if len(velocities) != len(message.depths) or not np.isfinite([*message.depths, *np.ravel(velocities)]).all():
            return
        self._sensor.take_held()
        self._layers = tuple(zip(map(float, message.depths), velocities, strict=True))
        if velocities and not self._has_current:
            self._current = sum(velocities, np.zeros(3)) / len(velocities)
