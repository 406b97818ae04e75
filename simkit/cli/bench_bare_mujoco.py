"""Reference for `simkit bench`: the same compiled model, stepped and measured with MuJoCo alone."""

from __future__ import annotations

import contextlib
import copy
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.sensors.cameras.rendered_camera import RenderedCamera
from simkit.sensors.cameras.renderer_choice import renderer_of
from simkit.sensors.cameras.rendering import gl_context, render_thread
from simkit.sensors.cameras.rendering.appearance import Appearance, Quality
from simkit.sensors.cameras.rendering.scene_composition import visuals_only_options
from simkit.sensors.cameras.rendering.view import aim
from simkit.sensors.rays.lidar import Lidar

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.sensors.base import Sensor

_ALL_GEOMS = int(mujoco.mjtCatBit.mjCAT_ALL)
Numbers = npt.NDArray[np.float64]
_SPARE_GEOMS = 16


class BareCamera:
    """Camera image drawn by MuJoCo alone, with colour and depth as the driver returns them.

    The image starts with the bottom row. The background is black, and depth is not in metres. The camera has its own
    model and context, with the simulation's multisampling and shadow maps.

    Args:
        sim: simulation to draw.
        sensor: camera with one image per sample; source of the view and the pose.
        model, data: model and state to draw; default: those of the simulation.
    """

    def __init__(
        self,
        sim: Simulation,
        sensor: RenderedCamera,
        model: mujoco.MjModel | None = None,
        data: mujoco.MjData | None = None,
    ) -> None:
        render_thread.drain()
        self.model = sim.mj_model if model is None else model
        self.data = sim.engine.physics.fresh() if data is None else data
        self.sensor = sensor
        (shot,) = sensor.shots()
        self.view, self._has_depth = shot.view, shot.depth
        size = self.view.height, self.view.width
        self.colours = np.empty((*size, 3), np.uint8)
        self.depths = np.empty(size, np.float32)
        self._rectangle = mujoco.MjrRect(0, 0, self.view.width, self.view.height)
        self._option, self._aside = visuals_only_options(), mujoco.MjvCamera()
        self._scene = mujoco.MjvScene(self.model, self.model.ngeom + _SPARE_GEOMS)
        composition = renderer_of(sim).composer.compose(self.model, self.data, *sensor._frame_in_world(self.data))
        self._scene.flags[:] = composition.scene.flags
        with self.current():
            self._context = _upload(self.model, Appearance.of(sim.world).quality)
            mujoco.mjr_resizeOffscreen(self.view.width, self.view.height, self._context)

    @contextlib.contextmanager
    def current(self) -> Iterator[None]:
        """Make the graphics context current; `draw` may be called inside the block."""
        with gl_context.current():
            yield

    def draw(self) -> None:
        """Draw the current state of `data`."""
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self._context)
        mujoco.mjv_updateScene(self.model, self.data, self._option, None, self._aside, _ALL_GEOMS, self._scene)
        aim(self._scene, *self.sensor._frame_in_world(self.data), self.view)
        mujoco.mjr_render(self._rectangle, self._scene, self._context)
        depths = self.depths if self._has_depth else None
        mujoco.mjr_readPixels(self.colours, depths, self._rectangle, self._context)

    def draw_many(self, count: int) -> None:
        """Draw several images in one context switch."""
        with self.current():
            for _ in range(count):
                self.draw()

    def reading(self, random: np.random.Generator) -> Callable[[], object]:
        """Return a function that makes a complete reading in new arrays: top row first, depth in metres, with noise."""
        view, noise = self.view, self.sensor.options.noise
        slope = np.float32(view.near * view.far / (view.far - view.near))
        offset = np.float32(view.near / (view.far - view.near))
        far = np.float32(self.sensor.options.depth_far)
        spread, shape = np.float32(noise.stddev), self.depths.shape

        def read() -> object:
            with self.current():
                self.draw()
            colours = self.colours[::-1]
            if noise.stddev:
                added = random.standard_normal(shape, np.float32) * (spread * 255)
                colours = np.clip(colours + added[..., None], 0, 255).astype(np.uint8)
            else:
                colours = colours.copy()
            if not self._has_depth:
                return colours
            depths = self.depths[::-1] + offset
            np.divide(slope, depths, out=depths)
            if noise.stddev:
                depths += random.standard_normal(shape, np.float32) * spread
            depths[depths > far] = np.inf
            return colours, depths

        return read

    def free(self) -> None:
        """Release the graphics memory."""
        with self.current():
            self._context.free()


def _upload(model: mujoco.MjModel, quality: Quality) -> mujoco.MjrContext:
    """Create MuJoCo's context with the multisampling and the shadow map size of the simulation's cameras."""
    settings = model.vis.quality
    original = settings.offsamples, settings.shadowsize
    settings.offsamples, settings.shadowsize = quality.samples, quality.shadow_map
    try:
        context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    finally:
        settings.offsamples, settings.shadowsize = original
    context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
    return context


_EULER = (mujoco.mjtIntegrator.mjINT_EULER,)


class BareEngine:
    """Copy of a simulation's model and state, stepped by MuJoCo alone."""

    def __init__(self, sim: Simulation) -> None:
        self.model = copy.copy(sim.mj_model)
        self.data = copy.copy(sim.mj_data)

    def step(self, count: int) -> None:
        mujoco.mj_step(self.model, self.data, count)


class HandWrittenLoop(BareEngine):
    """Fastest loop with the same readings: MuJoCo calls and plain NumPy, without messages and topics.

    The forward pass of a reading also serves as the first half of the next step.

    Args:
        sim: simulation that provides poses and rates; it is not stepped.
        periods: topic -> steps between its messages, for the topics to read.
    """

    def __init__(self, sim: Simulation, periods: dict[str, int]) -> None:
        super().__init__(sim)
        self._integrate = mujoco.mj_Euler if self.model.opt.integrator in _EULER else mujoco.mj_implicit
        self._random = np.random.default_rng(0)
        self.latest: dict[str, object] = {}
        types = sim.communication.bus.topics()
        sensors = {sensor.topic: sensor for sensor in sim.contents.sensors.values()}
        self._sim = sim
        self._due = [(p, t, self._reader(types[t], sensors.get(t))) for t, p in periods.items()]
        self._plans: dict[int, list[tuple[int, list[tuple[str, Callable[[], object]]]]]] = {}
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

    def _plan(self, count: int) -> list[tuple[int, list[tuple[str, Callable[[], object]]]]]:
        """Plan the numbers of steps between readings, and the readings after them. Each plan is computed once."""
        plan, at = [], 0
        for tick in sorted({count, *(t for period, _, _ in self._due for t in range(period, count + 1, period))}):
            plan.append((tick - at, [(topic, read) for period, topic, read in self._due if tick % period == 0]))
            at = tick
        return plan

    def _reader(self, type_name: str, sensor: Sensor | None) -> Callable[[], object]:
        kind = type_name.rsplit("/", 1)[-1]
        if kind == "Imu" and sensor is not None:
            return self._imu(sensor)
        if isinstance(sensor, Lidar):
            return self._scan(sensor)
        if isinstance(sensor, RenderedCamera):
            return BareCamera(self._sim, sensor, self.model, self.data).reading(self._random)
        if kind == "Odometry":
            return self._odometry
        if kind == "JointState":
            return lambda: (self.data.qpos.copy(), self.data.qvel.copy())
        if kind == "Imu":  # a plugin computes this reading; it has no sensor
            return lambda: self.data.xquat[self._root].copy()
        return lambda: (self.data.time, self.data.xpos[self._root].copy(), self.data.xquat[self._root].copy())

    def _imu(self, sensor: Sensor) -> Callable[[], object]:
        model, data, body = self.model, self.data, int(self._sim.engine.names.link(sensor.scene.parent).body)
        twist, change = np.zeros(6), np.zeros(6)
        object_type = mujoco.mjtObj.mjOBJ_XBODY

        def read() -> object:
            mujoco.mj_rnePostConstraint(model, data)
            mujoco.mj_objectVelocity(model, data, object_type, body, twist, 1)
            mujoco.mj_objectAcceleration(model, data, object_type, body, change, 1)
            noise = self._random.standard_normal(6)
            return data.xquat[body].copy(), twist[:3] + noise[:3] * 1e-3, change[3:] + noise[3:] * 1e-3

        return read

    def _scan(self, sensor: Lidar) -> Callable[[], object]:
        cast = cast_bare_scan(sensor, self.model, self.data)
        options, count = sensor.options, sensor.fan.count

        def read() -> object:
            ranges = cast()
            out = np.where((ranges < 0) | (ranges > options.range_max), np.inf, ranges)
            if options.noise.stddev:
                out += self._random.standard_normal(count) * options.noise.stddev
            return out.astype(np.float32)

        return read

    def _odometry(self) -> object:
        twist = np.zeros(6)
        mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_XBODY, self._root, twist, 1)
        return self.data.xpos[self._root].copy(), self.data.xquat[self._root].copy(), twist


def cast_bare_scan(sensor: Lidar, model: mujoco.MjModel, data: mujoco.MjData) -> Callable[[], Numbers]:
    """Return a function that casts a lidar's rays with MuJoCo alone.

    The rays have the same origin, geom groups and excluded body as the lidar's. The function returns the distances [m],
    shape (n,).
    """
    fan = sensor.fan
    ids, distances, rotated = np.zeros(fan.count, np.int32), np.zeros(fan.count), np.zeros((fan.count, 3))
    origin, rotation = (np.array(part) for part in sensor._frame_in_world(data))
    np.matmul(fan.directions, rotation.T, out=rotated)
    flat, excluded_body = rotated.reshape(-1), fan.body or -1

    def scan() -> Numbers:
        mujoco.mj_multiRay(
            model, data, origin, flat, fan.groups, 1, excluded_body, ids, distances, None, fan.count, fan.reach
        )
        return distances

    return scan
