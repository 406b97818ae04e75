"""Robot of Open-RMF's simulations: `libslotcar.so` of rmf_simulation."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Final, Literal

from simkit import Params, Pose, msgs
from simkit.extend import (
    LARGEST,
    NEVER,
    Options,
    OptionsOf,
    boolean,
    choice,
    listens,
    number,
    publish_while_subscribed,
    publishes,
    text,
    without_effect,
)
from simkit.plugins.drives.kinematic_motion import KinematicMotion, KinematicMover, KinematicPlugin, VelocityTarget
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit.plugins.publish_on_demand import count_instants
from simkit.pose import quat_from_rpy, wrap_angle
from simkit_open_rmf.plugins.building import RmfBuildingPlugin
from simkit_open_rmf.plugins.motion_profile import MotionLimits, drive_speed, read_limits
from simkit_open_rmf.plugins.path_following import Displacement, Point, lookahead_point, turn_towards
from simkit_open_rmf.plugins.slotcar_battery import BatteryModel

if TYPE_CHECKING:
    from simkit import Model
    from simkit.extend import SceneModel, SpecBuilder

STATE: Final = "rmf_fleet_msgs/msg/RobotState"
PATH: Final = "rmf_fleet_msgs/msg/PathRequest"
MODE: Final = "rmf_fleet_msgs/msg/ModeRequest"
PAUSE: Final = "rmf_fleet_msgs/msg/PauseRequest"

_IDLE, _CHARGING, _MOVING, _PAUSED, _WAITING, _DOCKING, _ADAPTER_ERROR = 0, 1, 2, 3, 4, 7, 8  # values of RobotMode
_PAUSE_NOW, _PAUSE_AT_CHECKPOINT, _RESUME = 0, 1, 2  # values of PauseRequest.type
_STATE_RATE, _TRANSFORM_RATE, _OBSTACLE_RATE = 2.0, 100.0, 20.0  # [Hz]
_ARRIVED, _ARRIVED_TURNING, _ARRIVED_STEERED = 0.02, 0.04, 1.0  # distance from a waypoint [m]
_FARTHEST_START: Final = 1.0  # largest distance from the first waypoint of a path [m]
_STRAIGHT: Final = math.radians(5)  # largest angle at which the robot drives ahead
_ALIGNED: Final = 1e-3  # final error of the heading [rad]
_STILL: Final = 0.01  # [m/s, rad/s]
_AT_CHARGER: Final = 0.3  # [m]


class SlotcarOptions(Options):
    """Options of `Slotcar`."""

    steering: str = choice(("diff_drive", "ackermann"), "diff_drive")
    nominal_drive_speed: float = number(0.5, "m/s", minimum=1e-6)
    nominal_drive_acceleration: float = number(0.05, "m/s²", minimum=1e-6)
    max_drive_acceleration: float = number(0.1, "m/s²", minimum=1e-6)
    nominal_turn_speed: float = number(math.pi / 8, "rad/s", minimum=1e-6)
    nominal_turn_acceleration: float = number(math.pi / 10, "rad/s²", minimum=1e-6)
    max_turn_acceleration: float = number(math.pi, "rad/s²", minimum=1e-6)
    stop_distance: float = number(1.0, "m", minimum=0)
    stop_radius: float = number(1.0, "m", minimum=0)
    reversible: bool = boolean(True)
    lookahead_distance: float = number(8.0, "m", minimum=0.1)
    nominal_voltage: float = number(12.0, "V", minimum=1e-6)
    nominal_capacity: float = number(24.0, "A·h", minimum=1e-6)
    charging_current: float = number(2.0, "A", minimum=0)
    mass: float = number(20.0, "kg", minimum=0)
    inertia: float = number(10.0, "kg·m²", minimum=0)
    friction_coefficient: float = number(0.3, minimum=0)
    nominal_power: float = number(10.0, "W", minimum=0)
    level_name: str = text("L1")
    tire_radius: bool = without_effect()
    base_width: bool = without_effect()
    min_turning_radius: bool = without_effect()
    turning_right_angle_mul_offset: bool = without_effect()
    display_markers: bool = without_effect()


class Slotcar(KinematicPlugin):
    """Follows paths on `/robot_path_requests`, and publishes its state on `/robot_state` twice a second.

    The robot turns on the spot towards the next waypoint, drives there, and turns to the last waypoint's heading at the
    end. With `<steering>` `ackermann` it drives curves towards a point `<lookahead_distance>` ahead. A path must begin
    within 1 m of the robot; otherwise the mode is MODE_ADAPTER_ERROR. The robot stops while the origin of another
    moving model, not a door or a lift, is within `<stop_radius>` of the point `<stop_distance>` ahead. The plugin sets
    the velocity of the model; wheels do not drive it.

    The level in the state is the floor of the world's lifts that is nearest to the robot's height; without lifts it is
    `<simkit:level_name>`. Each `<simkit:charger>` contains x and y of a charger.
    """

    endpoints = (
        listens("/robot_path_requests", PATH),
        listens("/robot_pause_requests", PAUSE),
        listens("/robot_mode_requests", MODE),
        publishes("/robot_state", STATE),
        publishes("/tf", TRANSFORMS),
    )
    options = OptionsOf(SlotcarOptions)
    filenames = ("libslotcar.so",)

    def prepare(self, scene: SceneModel, params: Params, builder: SpecBuilder) -> None:
        options = self.options.read_all()
        self._drive, self._turn = (
            read_limits(
                params,
                getattr(options, f"nominal_{kind}_speed"),
                getattr(options, f"nominal_{kind}_acceleration"),
                getattr(options, f"max_{kind}_acceleration"),
                f"max_{kind}_acceleration",
            )
            for kind in ("drive", "turn")
        )
        self._is_steered = options.steering == "ackermann"
        self._is_reversible = options.reversible and not self._is_steered
        self._battery = BatteryModel(
            options.nominal_voltage,
            options.nominal_capacity,
            options.charging_current,
            options.mass,
            options.inertia,
            options.friction_coefficient,
            options.nominal_power,
        )
        self._chargers = [_point(element) for element in params.all("charger")]
        self._canonical = scene.canonical_link
        self._links = [link.scoped for link in scene.all_links()]
        canonical = next(link for link in scene.all_links() if link.scoped == scene.canonical_link)
        self._in_canonical = canonical.pose_world.inverse() @ scene.pose_world

    def load(self, parent: Model, params: Params) -> None:
        self._robot = parent
        self._path: tuple[msgs.Location, ...] = ()  # waypoints in the state, from the next one on
        self._way: tuple[msgs.Location, ...] = ()  # waypoints to drive to
        self._goal: msgs.Location | None = None
        self._begin: Point = (0.0, 0.0)  # start of the way to the next waypoint
        self._task = ""
        self._has_error = self._docks = self._is_turning = self._is_blocked = False
        self._halt: Literal["", "paused", "waiting"] = ""
        self._pause: tuple[int, int, int] = (_RESUME, 0, 0)  # type, checkpoint and id of the last request
        self._speed = self._turning = 0.0
        self._charge, self._charge_ns = 1.0, self.sim.time_ns
        self._next_look = 0
        self.before_step_rate = NEVER
        self._motion = KinematicMotion(self.sim, self._links, self._canonical, self._in_canonical)
        self._mover = KinematicMover(self.sim)
        if not self._motion:
            message = f"plugin {self.name!r}: model {self.scoped!r} has a joint to the world and cannot move"
            params.diagnostics.warning("SK-PLUGIN-053", message, self.where, "remove the joint to the world")
        self.listen("/robot_path_requests", PATH, self._on_path)
        self.listen("/robot_pause_requests", PAUSE, self._on_pause)
        self.listen("/robot_mode_requests", MODE, self._on_mode)
        self._state = self.advertise("/robot_state", STATE)
        self._tf = self.advertise("/tf", TRANSFORMS)
        publish_while_subscribed(self, self._state, _STATE_RATE, "publish_state")
        publish_while_subscribed(self, self._tf, _TRANSFORM_RATE, "publish_transform")

    # ------------------------------------------------------------------ requests

    def _on_path(self, request: msgs.PathRequest) -> None:
        if request.robot_name != self._robot.name or request.task_id == self._task:
            return
        path = tuple(request.path)
        if not path:
            self._once.left_out("empty", "a path without waypoints is ignored")
            return
        if not all(math.isfinite(value) for place in path for value in (place.x, place.y, place.yaw)):
            self._once.not_finite("a path")
            return
        x, y, _ = self._robot.pose.position.tolist()
        self._task = str(request.task_id)
        self._has_error = not self._is_steered and math.hypot(path[0].x - x, path[0].y - y) > _FARTHEST_START
        self._way = () if self._has_error else path[1:]
        self._goal = None if self._has_error or len(path) < 2 else path[-1]
        self._begin = (x, y)
        if not self._has_error:
            self._path = path[1:]
        self._start()

    def _on_pause(self, request: msgs.PauseRequest) -> None:
        if request.robot_name == self._robot.name:
            self._pause = int(request.type), int(request.at_checkpoint), int(request.mode_request_id)
            self._start()

    def _on_mode(self, request: msgs.ModeRequest) -> None:
        if request.robot_name == self._robot.name:
            self._docks = request.mode.mode == _DOCKING

    def _start(self) -> None:
        """Call `before_step` at every step, until the robot has arrived."""
        if self._motion and self.before_step_rate == NEVER:
            self._charge, self._charge_ns = self._present_charge(), self.sim.time_ns
            self._set_before_step_rate(None)

    # ------------------------------------------------------------------ motion

    def velocity_targets(self) -> list[VelocityTarget]:
        """Return the velocity of the next step; empty if the robot is idle."""
        pose, step, drive, turn = self._motion.frame, self.period, self._drive, self._turn
        heading = float(pose.rpy[2])
        place = (float(pose.position[0]), float(pose.position[1]))
        left = self._steer(place, heading) if self._is_steered else self._plan(place, heading)
        if self._goal is None and left.ahead == left.turn == self._speed == self._turning == 0.0:
            self._set_before_step_rate(NEVER)
            return []
        limits = MotionLimits(min(drive.speed, left.limit), drive.nominal, drive.most)
        speed = drive_speed(left.ahead, self._speed, left.cruise, left.final, limits, step)
        turning = drive_speed(left.turn, self._turning, turn.speed, 0.0, turn, step)
        changes = abs(speed - self._speed) / step, abs(turning - self._turning) / step
        self._speed, self._turning = speed, turning
        if self._is_at_charger():  # paused there, with a goal
            self._charge = min(1.0, self._charge + self._battery.recharge(step))
        else:
            used = self._battery.discharge((abs(speed), abs(turning)), changes, step)
            self._charge = max(0.0, self._charge - used)
        self._charge_ns = self.sim.time_ns + round(step * 1e9)
        level = Pose(pose.position, quat_from_rpy(0.0, 0.0, heading))
        return [VelocityTarget(self._motion, level, (speed, 0.0, 0.0), (0.0, 0.0, turning), falls=True)]

    def _plan(self, place: Point, heading: float) -> Displacement:
        """Return the next motion of a robot that turns on the spot."""
        kind, checkpoint, _ = self._pause
        self._halt = "paused" if kind == _PAUSE_NOW and self._goal is not None else ""
        while self._way:
            there = self._way[0]
            offset = (there.x - place[0], there.y - place[1])
            pauses = kind == _PAUSE_NOW or (kind == _PAUSE_AT_CHECKPOINT and checkpoint <= there.index)
            arrived = math.hypot(*offset) < (_ARRIVED_TURNING if self._is_turning else _ARRIVED)
            self._is_turning = arrived and pauses
            if not arrived:
                return self._towards(there, offset, place, heading)
            if pauses:
                self._halt = "paused"
                if len(self._way) == 1:
                    return Displacement(turn=wrap_angle(there.yaw - heading))
                after = self._way[1]
                ahead = self._direction(after, (after.x - place[0], after.y - place[1]))
                return Displacement(turn=turn_towards(heading, ahead))
            self._way, self._path, self._begin = self._way[1:], self._path[1:], (there.x, there.y)
        if self._goal is None:
            return Displacement()
        turn = wrap_angle(self._goal.yaw - heading)
        if abs(turn) < _ALIGNED and abs(self._turning) <= self._turn.most * self.period:
            self._goal = None
            return Displacement()
        return Displacement(turn=turn)

    def _towards(self, there: msgs.Location, offset: Point, place: Point, heading: float) -> Displacement:
        """Return the motion to a waypoint, forwards or backwards."""
        direction = self._direction(there, offset)
        sign = 1.0 if direction == offset else -1.0
        turn = turn_towards(heading, direction)
        if abs(turn) >= _STRAIGHT:
            return Displacement(turn=turn)
        if self._halt or self._must_stop(place, heading, sign):
            self._halt = self._halt or "waiting"
            return Displacement(turn=turn)
        return Displacement(sign * math.hypot(*offset), turn, self._drive.speed, 0.0, _limit(there))

    def _direction(self, there: msgs.Location, offset: Point) -> Point:
        """Return the heading for the way to a waypoint: backwards if this is nearer to the waypoint's heading."""
        backwards = math.cos(there.yaw) * offset[0] + math.sin(there.yaw) * offset[1] < 0
        return (-offset[0], -offset[1]) if backwards and self._is_reversible else offset

    def _steer(self, place: Point, heading: float) -> Displacement:
        """Return the next motion of a robot with steered wheels."""
        while self._way:
            there, is_last = self._way[0], len(self._way) == 1
            distance = math.hypot(there.x - place[0], there.y - place[1])
            if distance >= (_ARRIVED_STEERED if is_last else self.options.lookahead_distance):
                break
            self._way, self._path, self._begin = self._way[1:], self._path[1:], (there.x, there.y)
        else:
            self._goal, self._task = None, "" if self._goal is not None else self._task
            self._halt = ""
            return Displacement()
        is_paused = self._pause[0] == _PAUSE_NOW
        self._halt = "paused" if is_paused else "waiting" if self._must_stop(place, heading, 1.0) else ""
        if self._halt:
            return Displacement()
        near = is_last and distance < self.options.lookahead_distance
        end = (there.x, there.y)
        target = end if near else lookahead_point(self._begin, end, place, self.options.lookahead_distance)
        offset = (target[0] - place[0], target[1] - place[1])
        turn = turn_towards(heading, offset)
        limit = _limit(there)
        speed = min(limit, self._drive.speed) * (1 - min(0.8, abs(turn) / math.pi))
        return Displacement(math.hypot(*offset), turn, speed, 0.0 if near else speed, limit)

    def _must_stop(self, place: Point, heading: float, sign: float) -> bool:
        """Check whether an obstacle is ahead; the obstacles are looked for 20 times a second."""
        tick = self.sim.tick
        if tick >= self._next_look:
            self._next_look = tick + max(1, round(1.0 / (_OBSTACLE_RATE * self.period)))
            reach = sign * self.options.stop_distance
            x, y = place[0] + reach * math.cos(heading), place[1] + reach * math.sin(heading)
            z = float(self._robot.pose.position[2])
            radius = self.options.stop_radius
            self._is_blocked = any(math.dist(other, (x, y, z)) < radius for other in self._obstacles())
        return self._is_blocked

    def _obstacles(self) -> list[list[float]]:
        """Return the origins of the other moving models [m], without doors and lifts."""
        plugins = self.sim.engine.structure.all_plugins()
        building = {p.scoped.split("::")[0] for p in plugins if isinstance(p, RmfBuildingPlugin)}
        return [
            model.pose.position.tolist()
            for name, model in self.sim.models.items()
            if not model.scene.static
            and name != self._robot.scoped
            and name not in building
            and "dispensable" not in name.lower()
        ]

    # ------------------------------------------------------------------ state

    def _is_still(self) -> bool:
        return abs(self._speed) < _STILL and abs(self._turning) < _STILL

    def _is_at_charger(self) -> bool:
        x, y, _ = self._robot.pose.position.tolist()
        return self._is_still() and any(math.dist((x, y), place) < _AT_CHARGER for place in self._chargers)

    def _present_charge(self) -> float:
        """Return the charge as a fraction; an idle robot uses the power of its devices, or charges."""
        time = max(0, self.sim.time_ns - self._charge_ns) * 1e-9
        if self._is_at_charger():
            return min(1.0, self._charge + self._battery.recharge(time))
        return max(0.0, self._charge - self._battery.discharge((0.0, 0.0), (0.0, 0.0), time))

    def _mode(self) -> int:
        if self._has_error:
            return _ADAPTER_ERROR
        if self._halt:
            return _PAUSED if self._halt == "paused" else _WAITING
        if self._is_at_charger():
            return _CHARGING
        return _DOCKING if self._docks else _IDLE if self._is_still() else _MOVING

    def _level_at(self, height: float) -> str:
        """Return the name of the floor of a lift that is nearest to a height [m], or `<level_name>` without lifts."""
        lifts = (p.lift for p in self.sim.engine.structure.all_plugins() if isinstance(p, RmfBuildingPlugin))
        floors = [floor for lift in lifts if lift is not None for floor in lift.floors]
        near = min(floors, key=lambda floor: abs(floor.elevation - height), default=None)
        return self.options.level_name if near is None else near.name

    def publish_state(self) -> None:
        """Publish place, path, mode and charge."""
        pose, now = self._robot.pose, self.sim.time_ns
        x, y, z = pose.position.tolist()
        place = {"t": msgs.time(now), "x": x, "y": y, "yaw": float(pose.rpy[2]), "level_name": self._level_at(z)}
        self._state.publish(
            msgs.make(
                STATE,
                name=self._robot.name,
                task_id=self._task,
                seq=count_instants(self, _STATE_RATE),
                mode={"mode": self._mode(), "mode_request_id": self._pause[2]},
                battery_percent=math.ceil(100.0 * self._present_charge()),
                location=place,
                path=list(self._path),
            )
        )

    def publish_transform(self) -> None:
        """Publish the transform from `world` to `<model>/base_link`."""
        frames = ("world", f"{self._robot.name}/base_link", self._robot.pose)
        self._tf.publish_later(partial(transforms, self.sim.time_ns, frames))


def _limit(there: msgs.Location) -> float:
    """Return the speed limit of the way to a waypoint [m/s]; infinite without one."""
    limit = float(there.approach_speed_limit)
    return limit if there.obey_approach_speed_limit and limit > 0 else math.inf


def _point(element: Params) -> Point:
    """Return the two numbers of an element."""
    try:
        x, y = (float(word) for word in element.value.split())
    except ValueError:
        x = y = math.nan
    if not max(abs(x), abs(y)) <= LARGEST:
        element.error("SK-PARAM-002", f"found <{element.name}>{element.value}</{element.name}>; expected x and y in m")
    return x, y
