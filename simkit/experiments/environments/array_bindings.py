"""Observations and actions of a batch, and the reasons why a world cannot be stepped as a batch."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from simkit.experiments.environments.array_view import ArrayView
from simkit.experiments.environments.cannot_batch import CannotBatchError
from simkit.experiments.environments.drive_arrays import DRIVE_ARRAYS, DriveArrays
from simkit.experiments.environments.expression_arrays import array_expression
from simkit.experiments.environments.sampled_rows import MeanMotionRows, SampledRows
from simkit.experiments.environments.sensor_arrays import ImuArrays, ScanArrays, sensor_obstacle
from simkit.experiments.environments.specification import Batched, Observation
from simkit.msgs.topic_names import absolute_name
from simkit.packs import is_shipped
from simkit.plugins.gz.odometry_publisher import OdometryPublisher
from simkit.plugins.joint_states import JointStates
from simkit.runtime import Simulation
from simkit.sensors.inertial.imu import Imu

if TYPE_CHECKING:
    from simkit.experiments.environments.environment import SimulationEnv
    from simkit.experiments.environments.specification import EnvironmentSpec, Value

Floats = npt.NDArray[np.float64]
Ids = npt.NDArray[np.intp]
Read = Callable[[Ids], Any]

_TWISTS: Final = frozenset(("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"))
_HOOKS: Final = ("before_step", "after_step")


# ---------------------------------------------------------------------- the world


def world_obstacles(sim: Simulation) -> list[str]:
    """Return why the steps of a world cannot be made in one call for all environments; empty if they can."""
    physics, found = sim.engine.physics, []
    if physics.law.is_on or physics.fast_bodies.can_be_fast or physics.free_motion is not None:
        found.append(
            "simkit's contact law needs Python at each step; overrides=['physics.contact_law=mujoco'] selects MuJoCo's"
        )
    if physics.shaper is not None:
        found.append("contacts with directional friction, slip or a moving surface")
    if physics.sleep.watches or physics.sleep.counts:
        found.append("bodies that may sleep")
    if physics.persistent_wrenches.any():
        found.append("persistent wrenches")
    for plugin in sim.engine.structure.all_plugins():
        name = type(plugin).__name__
        drive = DRIVE_ARRAYS.get(type(plugin))
        if drive is not None:
            obstacle = drive.obstacle(plugin)
            if obstacle:
                found.append(f"{obstacle} of plugin {name}")
        elif not vars(type(plugin)).get("only_publishes", False):
            acts = (
                any(map(plugin.has_hook, _HOOKS))
                or hasattr(plugin, "move_scenery")
                or getattr(plugin, "is_gz_system", False)
            )
            if acts or not is_shipped(type(plugin)):
                found.append(f"plugin {name}")
    return found


def spec_obstacles(spec: EnvironmentSpec, render_mode: str | None) -> list[str]:
    """Return which options of an environment need separate environments; empty if none does."""
    found = []
    if render_mode is not None:
        found.append("render_mode")
    if not spec.sync:
        found.append("sync=False")
    return found


# ---------------------------------------------------------------------- values of functions


def array_value(value: Value | None, view: ArrayView, name: str, env: SimulationEnv) -> Callable[[], Any]:
    """Return the function that returns a reward or an end of all environments."""
    if isinstance(value, str):
        try:
            get = _expression(value, view, env)
        except CannotBatchError as error:
            raise CannotBatchError(f"{name}: {error}") from None
        return lambda: np.broadcast_to(get(), (view.count,))
    if isinstance(value, Batched):
        return lambda: value.of_all(view)
    if isinstance(value, (bool, int, float)) or value is None:
        return lambda: np.full(view.count, value or 0.0)
    raise CannotBatchError(f"{name} is a Python function of one environment; simkit.gym.Batched has one for arrays")


def _expression(source: str, view: ArrayView, env: SimulationEnv) -> Callable[[], Any]:
    if env.with_variables(source) != source:
        raise CannotBatchError(f"the expression {source!r} has variables, whose values differ")
    return array_expression(source, view, env.view)


# ---------------------------------------------------------------------- observations


class ObservationArrays:
    """One observation of all environments.

    Args:
        bound: observation of the environment that resets all others.
        read: function that returns the values before they are limited to the space.
    """

    def __init__(self, bound: Any, read: Read) -> None:
        self._bound, self._read = bound, read

    def values(self, ids: Ids) -> npt.NDArray[Any]:
        """Return the present values of all environments within the space."""
        found, bound = np.asarray(self._read(ids)), self._bound
        if bound._given.sectors is not None:
            count = bound._given.sectors
            found = np.minimum.reduceat(found, np.arange(count) * found.shape[1] // count, axis=1)
        with np.errstate(invalid="ignore"):
            values: npt.NDArray[Any] = found.astype(bound.space.dtype).reshape(-1, *bound.space.shape)
        if bound._limits is not None:
            np.maximum(values, bound._limits[0], out=values)
            np.minimum(values, bound._limits[1], out=values)
        return values


class Sources:
    """Sources of observations as arrays.

    Attributes:
        sensors: sensors with their samples.
        sampled: values that plugins sample at their own rates.
        needs_acceleration: True if a source reads accelerations.
    """

    def __init__(self, env: SimulationEnv, view: ArrayView, batch: Any, drives: list[DriveArrays]) -> None:
        self._env, self._view, self._batch, self._drives = env, view, batch, drives
        self.sensors: list[ScanArrays | ImuArrays] = []
        self.sampled: list[SampledRows] = []
        self.needs_acceleration = False

    def bind(self, given: Observation, name: str) -> Read:
        """Return the function that reads the source of a named observation in all environments.

        Raises:
            CannotBatchError: the source needs Python for each environment.
        """
        source, view, sim = given.source, self._view, self._env.sim
        if isinstance(source, Batched):
            return lambda _: source.of_all(view)
        if not isinstance(source, str):
            raise CannotBatchError("a Python function of one environment; simkit.gym.Batched has one for arrays")
        tables = sim.contents.handles.tables
        if source in tables["sensor"]:
            return self._sensor(tables["sensor"][source], given)
        if source in tables["joint"]:
            joint = tables["joint"][source]
            if joint.dof != 1:
                raise CannotBatchError(f"joint {source!r} has {joint.dof} degrees of freedom")
            return lambda _: np.stack((view.joint_position(source), view.joint_velocity(source)), axis=1)
        if source in tables["model"] or source in tables["link"]:
            return self._pose(source)
        if source.startswith("/") and " " not in source:
            return self._topic(absolute_name(source), given, name)
        get = _expression(source, view, self._env)
        return lambda _: np.broadcast_to(value := np.asarray(get()), (view.count, *value.shape[1:]))

    def _pose(self, name: str) -> Read:
        view = self._view
        try:
            view.place(name)
        except (KeyError, AttributeError):
            raise CannotBatchError(f"the pose of the static model {name!r}") from None
        return lambda _: np.hstack((view.position(name), view.quaternion(name)))

    def _sensor(self, sensor: Any, given: Observation) -> Read:
        obstacle = sensor_obstacle(sensor)
        product = next(iter(sensor._topics))
        if not obstacle and product not in ("scan", "imu"):
            obstacle = f"message {product!r} of sensor {sensor.scoped!r}"
        if obstacle:
            raise CannotBatchError(obstacle)
        if isinstance(sensor, Imu):
            self.needs_acceleration = True
            imu = ImuArrays(sensor, self._view, self._batch.bind("qacc"), given.truth)
            self.sensors.append(imu)
            return imu.read
        scan = ScanArrays(sensor, self._view, self._batch.nthread, given.truth)
        self.sensors.append(scan)
        limits = float(sensor.options.range_min), float(sensor.options.range_max)
        return lambda ids: np.clip(scan.read(ids).astype(np.float32), *limits)

    def _topic(self, topic: str, given: Observation, name: str) -> Read:
        for sensor in self._env.sim.contents.sensors.values():
            if sensor.topic == topic:
                return self._sensor(sensor, given)

        def observed() -> Any:
            return self._env._observations._bound[name]._read()  # each reset binds the observations again

        for drive in self._drives:
            read = drive.bind(topic)
            if read is not None:
                return self._sample(read, drive.grid, observed)
        for plugin in self._env.sim.engine.structure.all_plugins():
            if type(plugin) is OdometryPublisher and topic in (plugin._odom.topic, plugin._noisy.topic):
                return self._keep(MeanMotionRows(plugin, self._view, observed))
            if isinstance(plugin, JointStates) and plugin.ros.topic(plugin._topic) == topic:
                grid = self._env.sim.engine.clock.grid(plugin.after_step_rate or 0.0)
                return self._sample(self._joint_states(plugin), grid, observed)
        raise CannotBatchError(f"topic {topic}")

    def _sample(self, read: Callable[[Ids], Floats], grid: Any, observed: Callable[[], Any]) -> Read:
        return self._keep(SampledRows(read, grid, observed, self._view.count))

    def _keep(self, rows: SampledRows) -> Read:
        self.sampled.append(rows)
        return lambda _: rows.values

    def _joint_states(self, plugin: JointStates) -> Callable[[Ids], Floats]:
        view, joints = self._view, plugin._handles
        if any(joint.dof != 1 for joint in joints):
            raise CannotBatchError("joint states of joints with several degrees of freedom")
        places, dofs = (np.array([getattr(j, name) for j in joints], np.intp) for name in ("_one_qpos", "_one_dof"))
        return lambda ids: np.hstack((view.qpos[np.ix_(ids, places)], view.qvel[np.ix_(ids, dofs)]))


# ---------------------------------------------------------------------- actions


class ActionArrays:
    """Actions of all environments.

    Args:
        env: environment that resets all others.
        view: state of all environments.
        applied: forces on degrees of freedom, one row for each environment.
        drives: drives of the world.
    """

    def __init__(self, env: SimulationEnv, view: ArrayView, applied: Floats, drives: list[DriveArrays]) -> None:
        self._applied, self._view = applied, view
        self._twists: list[tuple[DriveArrays, int, int]] = []
        self._efforts: list[tuple[int, int, float]] = []
        action = env.spec_of_env.action
        targets: Mapping[str, Any] = {action: None} if isinstance(action, str) else action
        first = 0
        for target, given in targets.items():
            joint = env.sim.contents.handles.tables["joint"].get(target)
            if joint is not None:
                self._efforts.append((first, joint._one_dof, joint._effort_limit.item(0)))
                first += 1
            else:
                self._bind_topic(env, target, given, drives, first)
                first += len(given)

    def _bind_topic(self, env: SimulationEnv, target: str, given: Any, drives: list[DriveArrays], first: int) -> None:
        topic = absolute_name(target)
        types = env.sim.communication.bus.types_of(topic)
        followers = [drive for drive in drives if drive.plugin.command_topic == topic and types[0] in _TWISTS]
        if not followers:
            raise CannotBatchError(f"action {target!r}: only twists of differential drives and efforts of joints")
        paths = [str(path).removeprefix("twist.") for path in given]
        forward, turn = (first + paths.index(path) if path in paths else -1 for path in ("linear.x", "angular.z"))
        self._twists += [(drive, forward, turn) for drive in followers]

    def send(self, ids: Ids, numbers: Floats) -> None:
        """Send the actions of some environments, which act until the next call."""
        numbers = np.hstack((numbers, np.zeros((len(numbers), 1))))  # the last column is for fields without an action
        for drive, forward, turn in self._twists:
            drive.aim(ids, numbers[:, forward], numbers[:, turn])
        for column, dof, limit in self._efforts:
            self._applied[ids, dof] = np.clip(numbers[:, column], -limit, limit)
