"""Live parameters of trajectory controllers: tolerances, and the gains of their PIDs."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final

from simkit.control.pids import Pids
from simkit.control.trajectory_goals import Tolerances

if TYPE_CHECKING:
    from simkit.control.controller import Controller

_GAINS: Final = {"p": "p", "i": "i", "d": "d", "ff_velocity_scale": "feedforward"}


class Constraints:
    """The `constraints` of a controller's joints, as they are at the moment; a handle on its parameters."""

    def __init__(self, controller: Controller, joints: tuple[str, ...]) -> None:
        def live(name: str, default: float, description: str) -> Any:
            return controller.declare(f"constraints.{name}", default, minimum=0.0, description=description)

        self._stopped = live("stopped_velocity_tolerance", 0.01, "speed of a joint at the end [rad/s or m/s]")
        self._goal_time = live("goal_time", 0.0, "how much later than planned a goal may end [s]; 0 for ever")
        self._path = [live(f"{joint}.trajectory", 0.0, "off its way at most [rad or m]") for joint in joints]
        self._goal = [live(f"{joint}.goal", 0.0, "off its goal at most [rad or m]") for joint in joints]

    def __deepcopy__(self, memo: dict[int, Any]) -> Constraints:
        return self

    def tolerances(self) -> Tolerances:
        """Those of a goal that has none of its own."""
        path, goal = [p.value for p in self._path], [p.value for p in self._goal]
        return Tolerances.of(path, goal, self._stopped.value, self._goal_time.value)


def read_pids(controller: Controller, joints: tuple[str, ...], find: Callable[[], Pids | None]) -> Pids:
    """PIDs of `gains`, which may be changed while they are at work.

    Args:
        controller: whose parameters they are.
        joints: theirs.
        find: gives the PIDs as they are at the moment of a change (restored ones are another object).
    """
    params = controller.params
    pids = Pids.read(params.block("gains"), joints)
    feed = params.block("velocity_ff")  # where ROS 1 has it
    for k, joint in enumerate(joints):
        pids.feedforward[k] = feed.number(joint, float(pids.feedforward[k]))
        for name, attribute in _GAINS.items():

            def take(value: float, attribute: str = attribute, k: int = k) -> None:
                now = find()
                if now is not None:
                    now.set_gain(attribute, k, value)

            controller.declare(f"gains.{joint}.{name}", float(getattr(pids, attribute)[k]), on_change=take)
    return pids
