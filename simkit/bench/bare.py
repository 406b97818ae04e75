"""What the engine alone takes: the same model and state, stepped and read by hand."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from simkit.bench.pictures import BarePass
from simkit.sensors.lidar import Lidar
from simkit.sensors.rendered import RenderedSensor

_EULER = (mujoco.mjtIntegrator.mjINT_EULER,)


class Bare:
    """The same model and state in the engine alone."""

    def __init__(self, sim: Any) -> None:
        self.model = copy.copy(sim.mj_model)
        self.data = copy.copy(sim.mj_data)

    def step(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)


class HandWritten(Bare):
    """The tightest loop that takes the same readings: engine calls and plain NumPy, no messages, no topics.

    A reading's forward pass serves as the next step's first half.

    Args:
        sim: the simulation; read for poses and rates, not stepped.
        periods: topic -> steps between its messages, for the topics that are read.
    """

    def __init__(self, sim: Any, periods: dict[str, int]) -> None:
        super().__init__(sim)
        self._integrate = mujoco.mj_Euler if self.model.opt.integrator in _EULER else mujoco.mj_implicit
        self._random = np.random.default_rng(0)
        self.latest: dict[str, Any] = {}
        types = sim.topics()
        sensors = {sensor.topic: sensor for sensor in sim.sensors.values()}
        self._sim = sim
        self._due = [(p, t, self._reader(types[t], sensors.get(t))) for t, p in periods.items()]
        self._plans: dict[int, list[tuple[int, list[tuple[str, Callable[[], Any]]]]]] = {}
        self._is_fresh = False
        free = np.flatnonzero(self.model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
        self._root = int(self.model.jnt_bodyid[free[0]]) if len(free) else min(1, self.model.nbody - 1)

    def step(self, count: int) -> None:
        model, data, latest, integrate = self.model, self.data, self.latest, self._integrate
        step, forward = mujoco.mj_step, mujoco.mj_forward
        if count not in self._plans:
            self._plans[count] = self._plan(count)
        for steps, readers in self._plans[count]:
            left = steps
            if self._is_fresh:
                integrate(model, data)
                self._is_fresh, left = False, steps - 1
            if left:
                step(model, data, left)
            if readers:
                forward(model, data)
                self._is_fresh = True
                for topic, read in readers:
                    latest[topic] = read()

    def _plan(self, count: int) -> list[tuple[int, list[tuple[str, Callable[[], Any]]]]]:
        """How many steps to go, and what to read then; worked out once."""
        plan, at = [], 0
        for tick in sorted({count, *(t for period, _, _ in self._due for t in range(period, count + 1, period))}):
            plan.append((tick - at, [(topic, read) for period, topic, read in self._due if tick % period == 0]))
            at = tick
        return plan

    def _reader(self, type_name: str, sensor: Any) -> Callable[[], Any]:
        kind = type_name.rsplit("/", 1)[-1]
        if kind == "Imu" and sensor is not None:
            return self._imu(sensor)
        if isinstance(sensor, Lidar):
            return self._scan(sensor)
        if isinstance(sensor, RenderedSensor):
            return BarePass(self._sim, sensor, self.model, self.data).reading(self._random)
        if kind == "Odometry":
            return self._odometry
        if kind == "JointState":
            return lambda: (self.data.qpos.copy(), self.data.qvel.copy())
        if kind == "Imu":  # made up by a plugin
            return lambda: self.data.xquat[self._root].copy()
        return lambda: (self.data.time, self.data.xpos[self._root].copy(), self.data.xquat[self._root].copy())

    def _imu(self, sensor: Any) -> Callable[[], Any]:
        model, data, body = self.model, self.data, sensor._body
        twist, change = np.zeros(6), np.zeros(6)
        object_type = mujoco.mjtObj.mjOBJ_XBODY

        def read() -> Any:
            mujoco.mj_rnePostConstraint(model, data)
            mujoco.mj_objectVelocity(model, data, object_type, body, twist, 1)
            mujoco.mj_objectAcceleration(model, data, object_type, body, change, 1)
            noise = self._random.standard_normal(6)
            return data.xquat[body].copy(), twist[:3] + noise[:3] * 1e-3, change[3:] + noise[3:] * 1e-3

        return read

    def _scan(self, sensor: Lidar) -> Callable[[], Any]:
        cast = bare_scan(sensor, self.model, self.data)
        options, count = sensor.options, sensor._fan.count

        def read() -> Any:
            ranges = cast()
            out = np.where((ranges < 0) | (ranges > options.range_max), np.inf, ranges)
            if options.noise.stddev:
                out += self._random.standard_normal(count) * options.noise.stddev
            return out.astype(np.float32)

        return read

    def _odometry(self) -> Any:
        twist = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, self._root, twist, 1)
        return self.data.xpos[self._root].copy(), self.data.xquat[self._root].copy(), twist


def bare_scan(sensor: Lidar, model: Any, data: Any) -> Callable[[], Any]:
    """The same rays from the same place, groups and excluded body included; gives distances, shape (n,)."""
    fan = sensor._fan
    ids, distances, rotated = np.zeros(fan.count, np.int32), np.zeros(fan.count), np.zeros((fan.count, 3))
    origin, rotation = (np.array(part) for part in sensor._frame_in_world(data))
    np.matmul(fan.directions, rotation.T, out=rotated)
    flat, own = rotated.reshape(-1), fan.body or -1

    def scan() -> Any:
        mujoco.mj_multiRay(model, data, origin, flat, fan.groups, 1, own, ids, distances, None, fan.count, fan.reach)
        return distances

    return scan
