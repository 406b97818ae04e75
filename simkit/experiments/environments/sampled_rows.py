"""Values that plugins sample at their own rates, in all environments of a batch."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from simkit.experiments.environments.array_view import ArrayView
from simkit.experiments.environments.cannot_batch import CannotBatchError
from simkit.experiments.environments.due_ticks import NEVER, next_due
from simkit.experiments.environments.message_arrays import odometry_numbers
from simkit.plugins.drives.odometry import MEAN_STEPS
from simkit.plugins.drives.odometry_messages import odometry_message
from simkit.plugins.gz.odometry_publisher import OdometryPublisher

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]
Ticks = npt.NDArray[np.int64]


class SampledRows:
    """Values that a plugin samples at its own rate, in all environments.

    Args:
        read: function that returns the present values of some environments.
        grid: ticks at which the plugin samples; None for every step.
        observed: function that returns the values that the environment that resets all others observes now.
        count: number of environments.
    """

    def __init__(self, read: Callable[[Ids], Floats], grid: Any, observed: Callable[[], Any], count: int) -> None:
        self._read, self.grid, self._observed = read, grid, observed
        self.values = np.zeros((count, *np.shape(observed())))

    def take(self, row: int) -> None:
        self.values[row] = self._observed()

    def next_stop(self, tick: int) -> int:
        """Return the first tick after a tick at which `note` must be called."""
        return NEVER

    def sample(self, ids: Ids, ticks: Ticks) -> None:
        """Store the present values of some environments, at the present tick of each."""
        self.values[ids] = self._read(ids)

    def note(self, ids: Ids, ticks: Ticks) -> None:
        """Store what later samples of some environments need, at the present tick of each."""


class MeanMotionRows(SampledRows):
    """Odometry of `OdometryPublisher`: the true pose of a model, and its mean twist over the last steps.

    Args:
        plugin: publisher of the environment that resets all others.
        view: state of all environments.
        observed: function that returns the values that this environment observes now.

    Raises:
        CannotBatchError: the odometry has noise, or the model is static.
    """

    def __init__(self, plugin: OdometryPublisher, view: ArrayView, observed: Callable[[], Any]) -> None:
        name = plugin._true._frame.scoped
        try:
            view.place(name)
        except (KeyError, AttributeError):
            raise CannotBatchError(f"the pose of the static model {name!r}") from None
        if plugin._stream is not None:
            raise CannotBatchError(f"topic {plugin._odom.topic} with <gaussian_noise>")
        grid = plugin.sim.engine.clock.grid(plugin.after_step_rate or 0.0)
        super().__init__(self._poses, grid, observed, view.count)
        self._plugin, self._view, self._name = plugin, view, name
        # a free link's state has its pose without rounding errors
        state = plugin._true._link._binding.root_joint_qpos if plugin._true._frame is plugin._true._link else -1
        self._state = slice(state, state + 7) if state >= 0 else None
        # poses before the last steps, at the index of the tick modulo their number
        self._trail, self._first_tick = np.zeros((view.count, MEAN_STEPS, 7)), np.zeros(view.count, np.int64)

    def _poses(self, ids: Ids) -> Floats:
        """Return the present poses of the model (x, y, z, qw, qx, qy, qz), shape (n, 7)."""
        if self._state is not None:
            found: Floats = self._view.qpos[ids, self._state]
            return found
        return np.hstack((self._view.position(self._name)[ids], self._view.quaternion(self._name)[ids]))

    def take(self, row: int) -> None:
        super().take(row)
        trail, tick = self._plugin._trail, self._plugin.sim.tick
        self._first_tick[row] = tick - len(trail)
        for back, pose in enumerate((self._plugin._true.place(), *reversed(trail))):
            if back < MEAN_STEPS:  # the present pose takes the place of the oldest one
                self._trail[row, (tick - back) % MEAN_STEPS] = pose

    def next_stop(self, tick: int) -> int:
        return max(tick + 1, next_due(self.grid, tick) - MEAN_STEPS)

    def sample(self, ids: Ids, ticks: Ticks) -> None:
        for row, tick, pose in zip(ids.tolist(), ticks.tolist(), self._poses(ids), strict=True):
            before = range(max(tick - MEAN_STEPS, int(self._first_tick[row])), tick)
            trail = np.vstack((*(self._trail[row, k % MEAN_STEPS] for k in before), pose))
            message = odometry_message(0, "", "", *self._plugin.reading_of(trail))
            self.values[row] = odometry_numbers(message)

    def note(self, ids: Ids, ticks: Ticks) -> None:
        self._trail[ids, ticks % MEAN_STEPS] = self._poses(ids)
