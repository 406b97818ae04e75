"""Nodes with one child: those of BehaviorTree.CPP (`src/decorators`) and of Nav2 (`plugins/decorator`)."""

from __future__ import annotations

from typing import Any, ClassVar, Final

from simkit import msgs
from simkit_navigation.behavior_trees.path_geometry import is_same, path_length
from simkit_navigation.behavior_trees.scripts import Script, ScriptError
from simkit_navigation.behavior_trees.tree_node import (
    COMPLETED,
    FAILURE,
    IDLE,
    RUNNING,
    SKIPPED,
    SUCCESS,
    DecoratorNode,
    Ports,
    TreeError,
)
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose

_SECOND: Final = 1_000_000_000


class _Mapped(DecoratorNode):
    """Returns another status when the child has ended."""

    results: ClassVar[dict[str, str]] = {}

    def tick(self) -> str:
        self.set_status(RUNNING)
        status = self.children[0].execute()
        if status in COMPLETED:
            self.halt_child(0)
        return self.results.get(status, status)


class Inverter(_Mapped):
    """Fails when the child succeeds, and succeeds when it fails."""

    results = {SUCCESS: FAILURE, FAILURE: SUCCESS}  # noqa: RUF012 - constant of the class


class ForceSuccess(_Mapped):
    """Succeeds when the child has ended."""

    results = {FAILURE: SUCCESS}  # noqa: RUF012


class ForceFailure(_Mapped):
    """Fails when the child has ended."""

    results = {SUCCESS: FAILURE}  # noqa: RUF012


class KeepRunningUntilFailure(_Mapped):
    """Ticks the child again and again until it fails."""

    results = {SUCCESS: RUNNING}  # noqa: RUF012


class Repeat(DecoratorNode):
    """Ticks the child until it has succeeded `num_cycles` times; -1 repeats without an end."""

    ports: ClassVar[Ports] = ("num_cycles",)
    again: ClassVar[str] = SUCCESS
    port: ClassVar[str] = "num_cycles"

    def prepare(self) -> None:
        self.count = 0

    def clear(self) -> None:
        self.count = 0

    def tick(self) -> str:
        if self.port not in self.inputs:
            raise TreeError(f"<{self.tag}> needs {self.port}")
        most = self.integer(self.port, 1)
        self.set_status(RUNNING)
        while self.count < most or most == -1:
            status = self.children[0].execute()
            if status == RUNNING:
                return RUNNING
            self.halt_child(0)
            if status != self.again:
                self.count = 0 if status in COMPLETED else self.count
                return status
            self.count += 1
            if self.count < most or most == -1:
                return RUNNING  # the next cycle comes with the next tick, so that a child without duration ends no loop
        self.count = 0
        return self.again


class RetryUntilSuccessful(Repeat):
    """Ticks the child until it succeeds, at most `num_attempts` times; -1 for no limit."""

    ports: ClassVar[Ports] = ("num_attempts",)
    again = FAILURE
    port = "num_attempts"


class Delay(DecoratorNode):
    """Ticks the child after `delay_msec` milliseconds."""

    ports: ClassVar[Ports] = ("delay_msec",)

    def prepare(self) -> None:
        self.end_ns: int | None = None

    def clear(self) -> None:
        self.end_ns = None

    def tick(self) -> str:
        if self.end_ns is None:
            self.end_ns = self.tree.time_ns + round(self.number("delay_msec", 0) * 1e6)
            self.set_status(RUNNING)
        if self.tree.time_ns < self.end_ns:
            return RUNNING
        status = self.children[0].execute()
        if status in COMPLETED:
            self.end_ns = None
            self.halt_child(0)
        return status


class Timeout(DecoratorNode):
    """Halts the child and fails after `msec` milliseconds."""

    ports: ClassVar[Ports] = ("msec",)

    def prepare(self) -> None:
        self.end_ns: int | None = None

    def clear(self) -> None:
        self.end_ns = None

    def tick(self) -> str:
        limit = self.number("msec", 0)
        if self.end_ns is None:
            self.end_ns = self.tree.time_ns + round(limit * 1e6)
            self.set_status(RUNNING)
        if limit > 0 and self.tree.time_ns >= self.end_ns and self.children[0].status == RUNNING:
            self.end_ns = None
            self.halt_child(0)
            return FAILURE
        status = self.children[0].execute()
        if status in COMPLETED:
            self.end_ns = None
            self.halt_child(0)
        return status


class RunOnce(DecoratorNode):
    """Ticks the child until it has ended once; then the node is skipped, or returns the same status."""

    ports: ClassVar[Ports] = ("then_skip",)

    def prepare(self) -> None:
        self.result = ""

    def tick(self) -> str:
        if self.result:
            return SKIPPED if self.boolean("then_skip", True) else self.result
        self.set_status(RUNNING)
        status = self.children[0].execute()
        if status in COMPLETED:
            self.result = status
            self.halt_child(0)
        return status


class Precondition(DecoratorNode):
    """Ticks the child if a script is true; returns `else` (SUCCESS, FAILURE, RUNNING) otherwise."""

    ports: ClassVar[Ports] = ("if", "else")

    def prepare(self) -> None:
        try:
            self.condition = Script(self.inputs.get("if", ""))
        except ScriptError as error:
            raise TreeError(f"<Precondition> if: {error}") from None

    def tick(self) -> str:
        if self.children[0].status != RUNNING:
            try:
                is_true = bool(self.condition.run(self.board))
            except ScriptError as error:
                raise TreeError(f"<Precondition> if: {error}") from None
            if not is_true:
                other = self.text("else", FAILURE)
                return other if other in (SUCCESS, FAILURE, RUNNING, SKIPPED) else FAILURE
        self.set_status(RUNNING)
        return self.children[0].execute()


class BlackboardCheck(DecoratorNode):
    """Ticks the child if two values are equal (BehaviorTree.CPP 3)."""

    ports: ClassVar[Ports] = ("value_A", "value_B", "return_on_mismatch")

    def tick(self) -> str:
        first, second = self.input("value_A"), self.input("value_B")
        if first is not None and str(first) == str(second):
            return self.children[0].execute()
        if self.children[0].status == RUNNING:
            self.halt_child(0)
        return SUCCESS if self.text("return_on_mismatch") == SUCCESS else FAILURE


# ---------------------------------------------------------------------- nodes of Nav2


class RateController(DecoratorNode):
    """Ticks the child `hz` times a second, and while it is running."""

    ports: ClassVar[Ports] = ("hz", "rate")

    def prepare(self) -> None:
        self.start_ns, self.is_first, self.period = 0, False, 0.0

    def tick(self) -> str:
        if not self.is_active:
            rate = self.number("hz" if "hz" in self.inputs else "rate", 10.0)
            if rate <= 0:
                raise TreeError(f"<RateController> hz: found {rate:g}; expected more than 0")
            self.period = 1.0 / rate
            self.start_ns, self.is_first = self.tree.time_ns, True
        self.set_status(RUNNING)
        elapsed = (self.tree.time_ns - self.start_ns) / _SECOND
        if not self.is_first and self.children[0].status != RUNNING and elapsed < self.period:
            return RUNNING
        self.is_first = False
        status = self.children[0].execute()
        if status == SUCCESS:
            self.start_ns = self.tree.time_ns
        return status


class DistanceController(DecoratorNode):
    """Ticks the child each time the robot has moved `distance`, and while it is running."""

    ports: ClassVar[Ports] = ("distance", "global_frame", "robot_base_frame")

    def prepare(self) -> None:
        self.start: PlanarPose | None = None
        self.is_first = False

    def tick(self) -> str:
        pose = self.tree.pose_of(self)
        if pose is None:
            return FAILURE
        if not self.is_active or self.start is None:
            self.start, self.is_first = pose, True
        self.set_status(RUNNING)
        is_due = self.is_first or pose.distance(self.start) >= self.number("distance", 1.0)
        if not is_due and self.children[0].status != RUNNING:
            return RUNNING
        self.is_first = False
        status = self.children[0].execute()
        if status == SUCCESS:
            self.start = pose
        return status


class _OfGoal(DecoratorNode):
    """Node that notes a change of the goal."""

    def prepare(self) -> None:
        self.goals: tuple[Any, Any] = (None, None)

    def _has_new_goal(self) -> bool:
        goals = (self.input_or_entry("goal"), self.input_or_entry("goals"))
        is_new = not is_same(goals, self.goals)
        self.goals = goals
        return is_new


class GoalUpdatedController(_OfGoal):
    """Ticks the child for each new goal, and while it is running."""

    ports: ClassVar[Ports] = ("goal", "goals")

    def tick(self) -> str:
        is_new = self._has_new_goal() or not self.is_active
        self.set_status(RUNNING)
        return self.children[0].execute() if is_new or self.children[0].status == RUNNING else RUNNING


class SpeedController(_OfGoal):
    """Ticks the child at a rate between `min_rate` and `max_rate`, in proportion to the robot's speed."""

    ports: ClassVar[Ports] = ("min_rate", "max_rate", "min_speed", "max_speed", "filter_duration", "goal", "goals")

    def prepare(self) -> None:
        super().prepare()
        self.start_ns, self.period, self.is_first = 0, 0.0, False
        self.tree.use_odometry()

    def tick(self) -> str:
        lowest, highest = self.number("min_rate", 0.1), self.number("max_rate", 1.0)
        slow, fast = self.number("min_speed", 0.0), self.number("max_speed", 0.5)
        if lowest <= 0 or highest <= 0 or fast <= slow:
            raise TreeError("<SpeedController> needs rates above 0 and min_speed < max_speed")
        if self._has_new_goal() or not self.is_active:
            self.start_ns, self.period, self.is_first = self.tree.time_ns, 1.0 / highest, True
        self.set_status(RUNNING)
        elapsed = (self.tree.time_ns - self.start_ns) / _SECOND
        if not self.is_first and self.children[0].status != RUNNING and elapsed < self.period:
            return RUNNING
        self.is_first = False
        if elapsed >= self.period:
            part = (self.tree.speed - slow) / (fast - slow)
            self.period = 1.0 / max(min(lowest + part * (highest - lowest), highest), lowest)
            self.start_ns = self.tree.time_ns
        return self.children[0].execute()


class GoalUpdater(DecoratorNode):
    """Ticks the child with the newest goal of the topic `goal_update`."""

    ports: ClassVar[Ports] = ("input_goal", "output_goal", "input_goals", "output_goals")

    def prepare(self) -> None:
        self.topic = self.tree.option("goal_updater_topic", "goal_update")
        self.tree.open_topic(self.topic, "geometry_msgs/msg/PoseStamped")

    def tick(self) -> str:
        goal, update = self.input("input_goal"), self.tree.latest(self.topic)
        if update is not None and (goal is None or _stamp(update) >= _stamp(goal)):
            goal = update
        self.output("output_goal", goal)
        self.output("output_goals", self.input("input_goals", []))
        return self.children[0].execute()


def _stamp(message: msgs.Message) -> tuple[int, int]:
    return message.header.stamp.sec, message.header.stamp.nanosec


class PathLongerOnApproach(DecoratorNode):
    """Ticks the child if a new path near the goal is longer than the old one by `length_factor`."""

    ports: ClassVar[Ports] = ("path", "prox_len", "length_factor")

    def prepare(self) -> None:
        self.path: Any = None
        self.is_first = True

    def tick(self) -> str:
        new, old = self.input("path"), self.path
        is_of_same_goal = _has_poses(old) and _has_poses(new) and old.poses[-1].pose == new.poses[-1].pose
        self.is_first = self.is_first or not is_of_same_goal
        self.set_status(RUNNING)
        if not self.is_first and not is_same(new, old) and self._is_longer(old, new):
            status = self.children[0].execute()
            if status in COMPLETED:
                self.path = new
                self.halt_child(0)
            return status
        self.path, self.is_first = new, False
        return SUCCESS

    def _is_longer(self, old: msgs.Path, new: msgs.Path) -> bool:
        length = path_length(old.poses)
        return (
            length < self.number("prox_len", 3.0)
            and path_length(new.poses) > self.number("length_factor", 2.0) * length
        )


def _has_poses(path: msgs.Path | None) -> bool:
    return path is not None and bool(path.poses)


class SingleTrigger(DecoratorNode):
    """Ticks the child until it has ended once, and fails from then on."""

    def prepare(self) -> None:
        self.has_ended = False

    def tick(self) -> str:
        if not self.is_active:
            self.has_ended = False
        self.set_status(RUNNING)
        if self.has_ended:
            return FAILURE
        status = self.children[0].execute()
        self.has_ended = status in COMPLETED
        return status


class EntryUpdated(DecoratorNode):
    """Ticks the child if an entry of the blackboard has changed since the last tick."""

    ports: ClassVar[Ports] = ("entry",)
    otherwise: ClassVar[str] = SKIPPED

    def prepare(self) -> None:
        self.value: Any = None

    def tick(self) -> str:
        if self.children[0].status == IDLE:
            value = self.input("entry")
            if is_same(value, self.value):
                return self.otherwise
            self.value = value
        return self.children[0].execute()


class WaitValueUpdate(EntryUpdated):
    """Waits for a change of an entry of the blackboard, and ticks the child then."""

    otherwise = RUNNING


DECORATOR_NODES: Final = {
    "Inverter": Inverter,
    "inverter": Inverter,
    "ForceSuccess": ForceSuccess,
    "ForceFailure": ForceFailure,
    "KeepRunningUntilFailure": KeepRunningUntilFailure,
    "Repeat": Repeat,
    "RetryUntilSuccessful": RetryUntilSuccessful,
    "RetryUntilSuccesful": RetryUntilSuccessful,
    "Delay": Delay,
    "Timeout": Timeout,
    "RunOnce": RunOnce,
    "Precondition": Precondition,
    "BlackboardCheckInt": BlackboardCheck,
    "BlackboardCheckDouble": BlackboardCheck,
    "BlackboardCheckString": BlackboardCheck,
    "BlackboardCheckBool": BlackboardCheck,
    "SkipUnlessUpdated": EntryUpdated,
    "WaitValueUpdate": WaitValueUpdate,
    "RateController": RateController,
    "DistanceController": DistanceController,
    "SpeedController": SpeedController,
    "GoalUpdatedController": GoalUpdatedController,
    "GoalUpdater": GoalUpdater,
    "PathLongerOnApproach": PathLongerOnApproach,
    "SingleTrigger": SingleTrigger,
}
"""Classes by their name in a file."""
