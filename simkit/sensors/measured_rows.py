"""Array rule of sensors that measure the states of many simulations one after another, such as cameras."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.msgs.message_types import Message
from simkit.runtime.array_rules import CannotBatchError, Ids, SensorRule, Ticks

if TYPE_CHECKING:
    from simkit.runtime.state_arrays import StateArrays
    from simkit.sensors.base import Sensor


class MeasuredRows(SensorRule):
    """Readings of a sensor whose own functions measure the state of each simulation.

    Measuring takes as long as in a single simulation. The steps of the simulations are made together all the same.
    The bits are those of a single simulation: the same functions measure the same state, with its noise.

    Args:
        sensor: sensor of the simulation that resets all others. Its measurement depends only on MuJoCo's model and
            data, and on what `memory` returns.
        casts: True if the sensor casts rays on shapes that it keeps beside the model; all simulations then have the
            same shapes.
    """

    def __init__(self, sensor: Sensor, *, casts: bool = False) -> None:
        self._sensor, self._casts = sensor, casts
        self._values: npt.NDArray[Any] | None = None

    def bind(self, states: StateArrays, *, is_truth: bool) -> None:
        self._states, self._is_truth = states, is_truth
        sensor = self._sensor
        self._shapes = _shapes_of(sensor.sim.mj_model)
        self._memories = [(sensor.memory(), sensor.sim.engine.streams.seed)] * states.count

    def take(self, row: int) -> None:
        sensor = self._sensor
        if self._casts and _shapes_of(sensor.sim.mj_model) != self._shapes:
            raise CannotBatchError(f"shapes that differ between the environments, which sensor {sensor.scoped!r} sees")
        self._memories[row] = sensor.memory(), sensor.sim.engine.streams.seed

    def read(self, ids: Ids, index: Ticks) -> npt.NDArray[Any]:
        sensor, streams = self._sensor, self._sensor.sim.engine.streams
        own_memory, own_seed = sensor.memory(), streams.seed
        rows, numbers = ids.tolist(), index[ids].tolist()
        try:
            # all states first: another thread may draw the images of one state while the next one is captured
            captures = [self._capture(row) for row in rows]
            for row, number, captured in zip(rows, numbers, captures, strict=True):
                values = self.convert(self._message(row, number, captured))
                if self._values is None:
                    self._values = np.zeros((self._states.count, *values.shape), values.dtype)
                self._values[row] = values
        finally:
            sensor.remember(own_memory)
            streams.reseed(own_seed)
        assert self._values is not None
        return self._values

    def _capture(self, row: int) -> object:
        """Capture the state of one simulation, from a forward pass."""
        sensor = self._sensor
        model, data = self._states.state_of(row)
        if sensor.needs_acceleration or sensor.reads_contacts:
            mujoco.mj_forward(model, data)
            mujoco.mj_rnePostConstraint(model, data)
        else:
            mujoco.mj_fwdPosition(model, data)
            mujoco.mj_fwdVelocity(model, data)
        sensor.remember(self._memories[row][0])
        return sensor.capture_other(model, data)

    def _message(self, row: int, number: int, captured: object) -> Message:
        """Return the message of a capture, with the noise of a sample."""
        sensor = self._sensor
        memory, seed = self._memories[row]
        sensor.remember(memory)
        sensor.sim.engine.streams.reseed(seed)
        reading = sensor.finish(captured)
        if not self._is_truth:
            reading = sensor.perturb(reading, number)
        return sensor.make_first_message(reading, self._states.time_ns_of(row))


def _shapes_of(model: mujoco.MjModel) -> list[bytes]:
    """Return the sizes of all shapes, and their poses in their bodies."""
    fixed = model.body_pos[model.body_weldid == 0], model.body_quat[model.body_weldid == 0]
    return [field.tobytes() for field in (model.geom_size, model.geom_pos, model.geom_quat, *fixed)]
