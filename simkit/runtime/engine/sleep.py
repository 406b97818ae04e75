"""Sleep of bodies at rest: the physics skips their kinematic trees until something reaches them.

MuJoCo can freeze a tree. It wakes the tree when an awake body touches it, or when its position, velocity or applied
force is set. MuJoCo's own rule for falling asleep is ten steps below a speed. That rule would also stop a ball at the
top of a slow throw, a slow roller and a drifting satellite. Therefore that rule is off (its tolerance is negative), and
this module decides. A tree may sleep under these conditions, which make sleep indistinguishable from rest:

- The tree is in contact, or held by another constraint, and nothing drives or measures it.
- The tree has stayed within 1 nm (1 nrad) for 0.1 s, twice, and moved no more the second time than the first. A tree
  that has stayed within 10 µm for 0.5 s, twice, also counts, because the solver makes a pile tremble. A free body may
  turn by 0.2 mrad in this time, because logs and balls of a pile roll as they creep. In a heap, the limit is 0.15 mm.
- Every tree that it touches meets the same conditions.

The windows lie on the grid of simulated time, so that chunks of steps, readers and processes make no difference.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.runtime.engine.heap_resistance import HeapResistance

RestState = tuple[Any, ...]
"""State of the observations of `Sleep`."""

RATE: Final = 10.0
"""Rate at which trees are observed [Hz]."""

_STILL, _STILL_FLOOR = 1e-9, 1e-10  # largest motion at rest [m or rad] between two observations
_CALM, _CALM_FLOOR = 1e-5, 1e-6  # largest motion at rest [m or rad] over `_LONG` observations
_HEAP_CALM = 1.5e-4  # the same in a heap, where a creep may also grow
_LONG = 5  # observations in the long window
_TURN_SHARE = 0.1  # weight of quaternions in the long window: 10 µm count as 0.2 mrad, for a radius of 5 cm
_TWICE = 2

_LEAST_SPEED = 1e-3  # [m/s] below this speed the engine puts the selected trees to sleep
_NO_SPEED = -1.0  # with 0 the engine would still put exactly motionless trees to sleep
_AWAKE = -(1 + mujoco.mjMINAWAKE)
_READY = -1
_FREE, _BALL = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_BALL)
_FLAG = int(mujoco.mjtEnableBit.mjENBL_SLEEP)
_NO_ISLANDS = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
_MAY = (int(mujoco.mjtSleepPolicy.mjSLEEP_AUTO_ALLOWED), int(mujoco.mjtSleepPolicy.mjSLEEP_ALLOWED))

Floats = npt.NDArray[np.float64]


class Sleep:
    """State of sleep of a model's trees.

    Args:
        model: MuJoCo's model; its flag for sleeping is set.
        data: MuJoCo's data.
        enabled: True if anything may sleep at all.

    Attributes:
        watches: True if a tree could fall asleep, so that `look` must be called at `RATE`.
        counts: True if a tree can sleep or the world can rest; otherwise this class has nothing to check.
        heaps: rolling resistance in heaps.
        is_drowsy: True if the engine puts the selected trees to sleep in the next step.
        rests: True if every tree sleeps, and nothing has been changed since.
        wants_all_awake: True if the next forward pass wakes everything.
    """

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, enabled: bool) -> None:
        self._model, self._data = model, data
        self.enabled = enabled
        self.is_drowsy = self.rests = self.wants_all_awake = self.watches = self._can_rest = self.counts = False
        self._gravity_now = model.opt.gravity  # a view, compared before every call of `advance`
        self._gravity = self._gravity_now.tolist()
        self._places = [data.qpos, *((data.mocap_pos, data.mocap_quat) if model.nmocap else ())]
        self._pushes = [data.qvel, data.qfrc_applied, data.xfrc_applied]
        self.heaps = HeapResistance(model)
        if not enabled:
            model.opt.enableflags &= ~_FLAG
            return
        if not model.opt.enableflags & _FLAG:
            # the engine computes static bodies only once, which must happen before the flag is set
            mujoco.mj_forward(model, data)
            model.opt.enableflags |= _FLAG
        model.opt.sleep_tolerance = _NO_SPEED
        self.restrict(())

    def restrict(self, bodies: Iterable[int]) -> None:
        """Always keep the trees of these bodies awake, in addition to the trees that an actuator drives."""
        model = self._model
        self._may = np.isin(model.tree_sleep_policy, _MAY)
        for body in bodies:
            tree = int(model.body_treeid[body])
            if tree >= 0:
                self._may[tree] = False
        has_islands = not model.opt.disableflags & _NO_ISLANDS
        self.watches = self.enabled and bool(self._may.any()) and has_islands
        self._can_rest = self.enabled and bool(self._may.all()) and (self.watches or not model.ntree)
        self.heaps.restrict(self._may)
        first_joint = model.dof_jntid[model.tree_dofadr] if model.ntree else np.zeros(0, int)
        self.counts = self.watches or self._can_rest
        self._weights = np.ones(model.nq)
        for kind, start in zip(model.jnt_type.tolist(), model.jnt_qposadr.tolist(), strict=True):
            if kind in (_FREE, _BALL):
                first = start + (3 if kind == _FREE else 0)
                self._weights[first : first + 4] = _TURN_SHARE
        self._starts = model.jnt_qposadr[first_joint] if model.ntree else first_joint
        self._begin()

    def _begin(self) -> None:
        """Start the observations again."""
        trees = self._model.ntree
        self._looks = 0
        self._last = self._data.qpos.copy()
        self._long_ago = self._last
        self._still, self._calm = np.zeros(trees, int), np.zeros(trees, int)
        self._moved, self._moved_long = np.full(trees, np.inf), np.full(trees, np.inf)
        self._slept = self._data.tree_asleep >= 0

    # ------------------------------------------------------------------ falling asleep

    def look(self, data: mujoco.MjData) -> Floats | None:
        """Compare with the last observation and select resting trees for sleep.

        Args:
            data: engine data with a fresh forward pass.

        Returns:
            New torques of the rolling resistance in heaps, to be set before the next forward pass; None without a
            change.
        """
        qpos = data.qpos.copy()
        asleep = data.tree_asleep >= 0
        self._looks += 1
        moved, calm = self._distance(qpos, self._last), self._distance(self._weights * qpos, self._weights * self._last)
        is_still = (moved <= _STILL) & (moved <= np.maximum(self._moved, _STILL_FLOOR))
        self._still = np.where(is_still, self._still + 1, 0)
        torques, limits, floors = None, np.full(len(asleep), _CALM), np.full(len(asleep), _CALM_FLOOR)
        if self.heaps.acts:
            in_heap, torques = self.heaps.find(data, self._trees_with_forces())
            limits[in_heap] = floors[in_heap] = _HEAP_CALM
        self._calm[calm > limits] = 0
        self._moved, self._last = moved, qpos
        if self._looks % _LONG == 0:
            moved = self._distance(self._weights * qpos, self._weights * self._long_ago)
            is_calm = (moved <= limits) & (moved <= np.maximum(2.0 * self._moved_long, floors))
            self._calm = np.where(is_calm, self._calm + 1, 0)
            self._moved_long, self._long_ago = moved, qpos
        woken = self._slept & ~asleep
        self._still[woken] = self._calm[woken] = 0
        self._slept = asleep
        rests = (self._still >= _TWICE) | (self._calm >= _TWICE)
        ready = self._may & rests & ~asleep & (data.tree_island >= 0)
        if ready.any():
            ready[self._trees_with_forces()] = False
        if ready.any():
            data.tree_asleep[ready] = _READY
            self.is_drowsy = True
        return None if torques is None or (torques == self.heaps.torques).all() else torques

    def _trees_with_forces(self) -> npt.NDArray[np.intp]:
        """Return the trees that a force is applied to."""
        model, data = self._model, self._data
        bodies, dofs = np.flatnonzero(data.xfrc_applied.any(axis=1)), np.flatnonzero(data.qfrc_applied)
        trees = np.concatenate((model.body_treeid[bodies], model.dof_treeid[dofs])).astype(np.intp)
        return trees[trees >= 0]

    def _distance(self, a: Floats, b: Floats) -> Floats:
        return np.maximum.reduceat(np.abs(a - b), self._starts)

    def let_fall_asleep(self) -> None:
        """Prepare the step in which the engine puts the selected trees to sleep."""
        self._model.opt.sleep_tolerance = _LEAST_SPEED

    def keep_awake(self) -> None:
        """Finish the step in which the engine put the selected trees to sleep."""
        self._model.opt.sleep_tolerance = _NO_SPEED
        self.is_drowsy = False

    # ------------------------------------------------------------------ waking

    def wake(self, body: int) -> bool:
        """Wake a body whose state is set; return True if it slept, so that positions must be computed again."""
        tree = int(self._model.body_treeid[body])
        if tree < 0 or not self._may[tree]:
            return False
        self._still[tree] = self._calm[tree] = 0
        asleep = self._data.tree_asleep
        if asleep[tree] >= 0:
            # the engine wakes a tree with a nonzero velocity; its test also accepts negative zero
            dof = int(self._model.tree_dofadr[tree])
            if self._data.qvel[dof] == 0.0:
                self._data.qvel[dof] = -0.0
            return True
        if self.is_drowsy:
            asleep[tree] = _AWAKE
        return False

    def is_asleep(self, body: int, data: mujoco.MjData) -> bool:
        """Check whether a body sleeps, in data with a fresh forward pass."""
        tree = int(self._model.body_treeid[body])
        return tree >= 0 and bool(data.tree_asleep[tree] >= 0)

    def wake_all(self) -> None:
        """Wake everything in the next forward pass, before a change of the model."""
        if self.enabled:
            self.wants_all_awake = True
            self.rests = self.is_drowsy = False

    def forward(self) -> None:
        """Make a forward pass that wakes everything and recomputes static bodies."""
        model, data = self._model, self._data
        model.opt.enableflags &= ~_FLAG
        mujoco.mj_forward(model, data)
        model.opt.enableflags |= _FLAG
        data.tree_asleep[:] = _AWAKE
        self.wants_all_awake = False
        self._begin()

    # ------------------------------------------------------------------ rest of the whole world

    def settle(self) -> None:
        """Check after steps whether all trees sleep."""
        if self._can_rest and self._data.ntree_awake == 0:
            self.rests = True
            self._rest = [(now, now.copy()) for now in self._places]

    def still_rests(self) -> bool:
        """Check that the world still rests: nothing was written directly to the engine's data."""
        for values in self._pushes:
            if values.any():
                self.rests = False
        for now, then in self._rest:
            if not (now == then).all():
                self.rests = False
        return self.rests

    def notice_gravity(self) -> bool:
        """Wake everything if gravity has changed; return whether it did."""
        gravity = self._gravity_now.tolist()
        if gravity == self._gravity:
            return False
        self._gravity = gravity
        self.wake_all()
        return self.enabled

    # ------------------------------------------------------------------ snapshots

    def get_state(self) -> RestState:
        """Return the state that a restored run needs besides the engine's data."""
        if not self.watches:
            return (self.wants_all_awake,)
        return (
            self.wants_all_awake,
            self.is_drowsy,
            self._looks,
            self._last,
            self._long_ago,
            self._moved,
            self._moved_long,
            self._slept,
            self._still.copy(),
            self._calm.copy(),
            self.heaps.torques,
        )

    def set_state(self, state: RestState) -> None:
        """Restore a state from `get_state`; the engine's data must already be restored."""
        self.rests = self.is_drowsy = False
        self.wants_all_awake = state[0]
        self._gravity = self._model.opt.gravity.tolist()
        if len(state) > 1:
            self.is_drowsy, self._looks, self._last, self._long_ago = state[1:5]
            self._moved, self._moved_long, self._slept = state[5:8]
            self._still, self._calm = state[8].copy(), state[9].copy()
            self.heaps.torques = state[10]
