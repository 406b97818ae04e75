"""Goals of an action: execution, rejection, cancellation, snapshots and errors."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import ActionError, MessageError, PluginError, SubscriberError
from simkit.msgs.goal_status import GoalStatus

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
FIBONACCI = "example_interfaces/action/Fibonacci"


class Counter(simkit.WorldPlugin):
    """Append a number to the sequence every 0.1 s; a new goal aborts the previous goal."""

    after_step_rate = 10.0

    def load(self, parent: Any, params: simkit.Params) -> None:
        self.goal: Any = None
        self.sequence: list[int] = []
        self.act("fibonacci", FIBONACCI, self.on_goal, self.on_cancel)

    def on_goal(self, goal: Any) -> None:
        if goal.request.order < 0:
            goal.reject("a negative order")
            return
        if self.goal is not None:
            self.goal.abort({"sequence": self.sequence}, "pre-empted")
        self.goal, self.sequence = goal, [0, 1]

    def on_cancel(self, goal: Any) -> bool | None:
        if goal.request.order == 99:
            return False
        goal.canceled({"sequence": self.sequence})
        self.goal = None
        return None

    def after_step(self) -> None:
        if self.goal is None:
            return
        self.sequence.append(self.sequence[-1] + self.sequence[-2])
        self.goal.publish_feedback({"sequence": self.sequence})
        if len(self.sequence) > self.goal.request.order:
            self.goal.succeed({"sequence": self.sequence})
            self.goal = None


@pytest.fixture
def sim() -> Any:
    with simkit.load(EMPTY, plugins=[Counter()]) as sim:
        yield sim


def test_a_goal_is_executed_and_ends_with_its_result(sim: Any) -> None:
    told: list[list[int]] = []
    ended: list[Any] = []
    goal = sim.send_goal("/fibonacci", {"order": 5}, lambda m: told.append(list(m.sequence)), ended.append)
    assert goal.status is GoalStatus.UNKNOWN
    sim.step()
    assert goal.status is GoalStatus.EXECUTING
    sim.run(1.0)
    assert goal.status is GoalStatus.SUCCEEDED
    assert list(goal.result.sequence) == [0, 1, 1, 2, 3, 5]
    assert told == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3], [0, 1, 1, 2, 3, 5]]
    assert ended == [goal]
    assert sim.communication.actions.names()["/fibonacci"] == FIBONACCI


def test_a_goal_is_rejected_with_a_reason(sim: Any) -> None:
    goal = sim.send_goal("/fibonacci", {"order": -1})
    sim.step()
    assert (goal.status, goal.reason, goal.result) == (GoalStatus.REJECTED, "a negative order", None)


def test_a_goal_is_cancelled_half_way(sim: Any) -> None:
    goal = sim.send_goal("/fibonacci", {"order": 50})
    sim.run(0.25)
    goal.cancel()
    assert goal.status is GoalStatus.EXECUTING
    sim.step()
    assert goal.status is GoalStatus.CANCELED
    assert list(goal.result.sequence) == [0, 1, 1, 2]


def test_a_plugin_may_refuse_a_cancel_request(sim: Any) -> None:
    goal = sim.send_goal("/fibonacci", {"order": 99})
    sim.step()
    goal.cancel()
    sim.step()
    assert goal.status is GoalStatus.EXECUTING


def test_a_second_goal_pre_empts_the_first(sim: Any) -> None:
    first = sim.send_goal("/fibonacci", {"order": 50})
    sim.run(0.15)
    second = sim.send_goal("/fibonacci", {"order": 3})
    sim.run(0.5)
    assert (first.status, first.reason) == (GoalStatus.ABORTED, "pre-empted")
    assert second.status is GoalStatus.SUCCEEDED


def test_a_restore_restores_the_status_of_the_goals(sim: Any) -> None:
    first = sim.send_goal("/fibonacci", {"order": 5})
    sim.run(0.15)
    half = sim.snapshot()
    sim.run(1.0)
    late = sim.send_goal("/fibonacci", {"order": 2})
    sim.run(1.0)
    sim.restore(half)
    assert (first.status, first.result) == (GoalStatus.EXECUTING, None)
    assert late.status is GoalStatus.UNKNOWN
    sim.run(1.0)
    assert list(first.result.sequence) == [0, 1, 1, 2, 3, 5]


def test_a_goal_in_the_inbox_is_part_of_a_snapshot(sim: Any) -> None:
    goal = sim.send_goal("/fibonacci", {"order": 3})
    sent = sim.snapshot()
    sim.run(1.0)
    sim.restore(sent)
    assert goal.status is GoalStatus.UNKNOWN
    sim.run(1.0)
    assert goal.status is GoalStatus.SUCCEEDED


def test_errors_name_the_action_and_the_expected_values(sim: Any) -> None:
    with pytest.raises(ActionError, match="did you mean '/fibonacci'"):
        sim.send_goal("/fibonaci")
    with pytest.raises(MessageError, match="did you mean 'order'"):
        sim.send_goal("/fibonacci", {"oder": 3})
    goal = sim.send_goal("/fibonacci", {"order": -1})
    sim.step()
    with pytest.raises(ActionError, match="has ended already"):
        goal.succeed()


def test_an_exception_in_a_goal_callback_names_the_plugin() -> None:
    class Faulty(simkit.WorldPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.act("break", FIBONACCI, lambda goal: 1 / 0)

    with simkit.load(EMPTY, plugins=[Faulty()]) as sim:
        sim.send_goal("/break")
        with pytest.raises(PluginError, match="'Faulty'.*action /break"):
            sim.step()


def test_an_exception_of_the_client_is_not_attributed_to_the_plugin(sim: Any) -> None:
    def on_feedback(message: Any) -> None:
        raise ValueError("too slow")

    sim.send_goal("/fibonacci", {"order": 5}, on_feedback)
    with pytest.raises(
        SubscriberError, match=r"on_feedback.*'/fibonacci/_action/feedback' raised at t=0.1 s.*too slow"
    ):
        sim.run(1.0)
    sim.engine.faults.on_error = "disable"
    goal = sim.send_goal("/fibonacci", {"order": 3}, None, lambda goal: 1 / 0)
    with pytest.raises(SubscriberError, match="get_result.*ZeroDivisionError"):
        sim.run(1.0)
    assert goal.status is GoalStatus.SUCCEEDED and not any(d.code == "SK-PLUGIN-020" for d in sim.diagnostics)


def test_a_goal_is_aborted_with_its_removed_model_and_continues_after_a_restore() -> None:
    class OnModel(simkit.ModelPlugin):
        def load(self, parent: Any, params: simkit.Params) -> None:
            self.act("wait", FIBONACCI, lambda goal: None)

    world = '<sdf version="1.9"><world name="w"><model name="m"><link name="l"/></model></world></sdf>'
    ended: list[Any] = []
    with simkit.load(world, plugins=[OnModel()]) as sim:
        goal = sim.send_goal("/wait", None, None, ended.append)
        sim.step()
        before = sim.snapshot()
        sim.remove("m")
        assert goal.status is GoalStatus.ABORTED and goal.reason == "the action was removed" and ended == [goal]
        sim.restore(before)
        assert goal.status is GoalStatus.EXECUTING and goal.reason == ""


def test_an_accepted_goal_cannot_be_rejected_and_an_ended_goal_sends_no_feedback(sim: Any) -> None:
    goal = sim.send_goal("/fibonacci", {"order": 3})
    sim.step()
    with pytest.raises(ActionError, match="was accepted already; abort it"):
        goal.reject()
    sim.run(1.0)
    goal.publish_feedback({"sequence": [7]})
    assert list(goal.feedback.sequence) == [0, 1, 1, 2]
