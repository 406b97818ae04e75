"""Lifts of Open-RMF: a cabin that moves between floors while the doors of the floor are closed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.extend import LARGEST, JointAxis, Options, find_named_joint, number, text
from simkit_open_rmf.plugins.door_motion import CLOSED, MOVING, OPEN, DoorMotion
from simkit_open_rmf.plugins.motion_profile import GuidedJoint, read_limits

if TYPE_CHECKING:
    from simkit import Params, Simulation
    from simkit.compiler import ActuatorRef
    from simkit.extend import SceneModel, SpecBuilder

LIFT_STATE: Final = "rmf_lift_msgs/msg/LiftState"
_END_SESSION: Final = 0  # value of LiftRequest.request_type
_STOPPED, _UP, _DOWN = 0, 1, 2  # values of LiftState.motion_state
_AGV_MODE: Final = 2


class LiftOptions(Options):
    """Options of a lift."""

    v_max_cabin: float = number(0.2, "m/s", minimum=1e-6)
    a_max_cabin: float = number(0.2, "m/s²", minimum=1e-6)
    a_nom_cabin: float = number(0.08, "m/s²", minimum=1e-6)
    dx_min_cabin: float = number(0.01, "m", minimum=1e-4)
    f_max_cabin: float = number(100.0, "N", minimum=0.0)
    cabin_joint_name: str = text(required=True)
    initial_floor: str = text()


@dataclass(frozen=True)
class Floor:
    """Floor of a lift.

    Attributes:
        name: name of the floor in messages.
        elevation: position of the cabin's joint at the floor [m].
        doors: names of the doors of the shaft and of the cabin at the floor.
    """

    name: str
    elevation: float
    doors: tuple[str, ...]


@dataclass(frozen=True)
class LiftDescription:
    """Lift in a file.

    Attributes:
        joint: scoped name of the cabin's joint.
        servo: position servo of the joint.
        floors: floors in the order of the file.
        initial: index of the first floor of the cabin.
    """

    joint: str
    servo: ActuatorRef
    floors: tuple[Floor, ...]
    initial: int


def read_lift(scene: SceneModel, params: Params, builder: SpecBuilder, owner: str) -> LiftDescription | None:
    """Return the lift that a plugin describes, and add the cabin's servo; None after an error."""
    options = LiftOptions(params)
    joint = find_named_joint(scene, "cabin_joint_name", params)
    elements = params.all("floor")
    if not elements:
        params.text("floor", required=True)
    floors = [_read_floor(element) for element in elements]
    names = [floor.name for floor in floors]
    initial = options.initial_floor
    if initial and initial not in names:
        listed = ", ".join(map(repr, names))
        message = f"found <initial_floor>{initial}</initial_floor>; expected a floor of the lift: {listed}"
        params.child_or_self("initial_floor").error("SK-PARAM-002", message)
    if joint is None or not floors:
        return None
    axis = joint.axes[0]
    for floor, element in zip(floors, elements, strict=True):
        if names.count(floor.name) > 1:
            element.error("SK-PARAM-002", f"the floor {floor.name!r} is listed twice; expected a name for each floor")
        if not axis.lower <= floor.elevation <= axis.upper:
            message = f"floor {floor.name!r} is at {floor.elevation:g} m"
            reach = f"joint {joint.name!r} reaches {axis.lower:g} to {axis.upper:g} m"
            element.error("SK-PARAM-002", f"{message}, but {reach}")
    servo = builder.add_position_servo(joint.scoped, max_effort=options.f_max_cabin, owner=owner)
    return LiftDescription(joint.scoped, servo, tuple(floors), names.index(initial) if initial in names else 0)


def _read_floor(element: Params) -> Floor:
    written = element.attribute("elevation")
    try:
        elevation = float(written)
    except ValueError:
        elevation = float("nan")
    if not abs(elevation) <= LARGEST or not element.attribute("name"):
        message = f"found <floor name={element.attribute('name')!r} elevation={written!r}>"
        element.error("SK-PARAM-002", f"{message}; expected a name, and an elevation in m")
    pairs = element.all("door_pair")
    doors = tuple(name for pair in pairs for side in ("shaft_door", "cabin_door") if (name := pair.attribute(side)))
    return Floor(element.attribute("name"), elevation, doors)


class LiftMotion:
    """Motion of the cabin of one lift.

    Args:
        name: name of the lift in messages.
        lift: floors and joint.
        options: options of the lift.
        sim: simulation of the lift.

    Attributes:
        is_active: true while the lift follows a command.
    """

    def __init__(self, name: str, lift: LiftDescription, options: LiftOptions, sim: Simulation) -> None:
        self.name, self._lift = name, lift
        accelerations = options.a_nom_cabin, options.a_max_cabin
        limits = read_limits(options.params, options.v_max_cabin, *accelerations, "a_max_cabin")
        self._cabin = GuidedJoint(JointAxis(sim.joint(lift.joint)), lift.servo, limits, options.dx_min_cabin)
        self._target, self._doors_shall = lift.floors[lift.initial], CLOSED
        self._session = ""
        self.is_active = False

    @property
    def floors(self) -> tuple[Floor, ...]:
        """Floors in the order of the file."""
        return self._lift.floors

    @property
    def floor(self) -> Floor:
        """Floor nearest to the cabin."""
        height = self._cabin.axis.position
        return min(self.floors, key=lambda floor: abs(floor.elevation - height))

    def request(self, message: msgs.LiftRequest) -> str:
        """Accept a request, or return why the request is ignored."""
        floor = next((floor for floor in self.floors if floor.name == message.destination_floor), None)
        if floor is None:
            listed = ", ".join(repr(floor.name) for floor in self.floors)
            return f"lift {self.name!r} has no floor {message.destination_floor!r}; the floors are {listed}"
        session = "" if message.request_type == _END_SESSION else str(message.session_id)
        doors = OPEN if message.door_state == OPEN else CLOSED
        if self.is_active and (floor, doors, session) != (self._target, self._doors_shall, self._session):
            return f"lift {self.name!r} ignores requests while it moves"
        self._target, self._doors_shall, self._session = floor, doors, session
        self.is_active = True
        return ""

    def step(
        self,
        period: float,
        doors_of: Callable[[Floor], list[DoorMotion]],
        command_doors: Callable[[Floor, int], None],
    ) -> None:
        """Advance the reference of the cabin by one step, and command the doors.

        Args:
            period: physics step [s].
            doors_of: function that returns the doors of a floor.
            command_doors: function that opens or closes the doors of a floor.
        """
        if not self.is_active:
            return
        cabin, elevation = self._cabin, self._target.elevation
        is_there = cabin.is_at(elevation) and cabin.speed == 0.0
        shall = self._doors_shall if is_there else CLOSED
        command_doors(self.floor, shall)
        has_doors = all(door.mode == shall and not door.is_active for door in doors_of(self.floor))
        if has_doors or cabin.speed != 0.0:
            cabin.advance(elevation, period)
        self.is_active = not (is_there and has_doors and cabin.speed == 0.0)

    @property
    def references(self) -> list[tuple[ActuatorRef, float]]:
        """Servo of the cabin and its position reference [m]."""
        return [(self._cabin.servo, self._cabin.reference)]

    def state(self, time_ns: int, doors_of: Callable[[Floor], Iterable[DoorMotion]]) -> msgs.LiftState:
        """Return the message of the present state."""
        floor, remaining = self.floor, self._target.elevation - self._cabin.axis.position
        moving = self.is_active and not self._cabin.is_at(self._target.elevation)
        modes = {door.mode for door in doors_of(floor)}
        message: msgs.LiftState = msgs.make(
            LIFT_STATE,
            lift_time=msgs.time(time_ns),
            lift_name=self.name,
            available_floors=[floor.name for floor in self.floors],
            current_floor=floor.name,
            destination_floor=self._target.name if self.is_active else floor.name,
            door_state=modes.pop() if len(modes) == 1 else MOVING if modes else CLOSED,
            motion_state=(_UP if remaining > 0 else _DOWN) if moving else _STOPPED,
            current_mode=_AGV_MODE,
            session_id=self._session,
        )
        return message
