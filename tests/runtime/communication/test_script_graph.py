"""Topics, services, actions and parameters that a script opens, as plugins do."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.errors import ActionError, InputError, MessageError, ParameterError, ServiceError, SubscriberError
from simkit.msgs.goal_status import GoalStatus

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"


@pytest.fixture
def sim() -> Iterator[simkit.Simulation]:
    with simkit.load(EMPTY) as sim:
        yield sim


def raising(_: Any) -> None:
    raise ValueError("no bricks left")


def test_a_command_input_of_a_script_receives_messages_between_two_steps(sim: simkit.Simulation) -> None:
    received: list[tuple[int, str]] = []
    publisher = sim.advertise("/chatter", "std_msgs/String")
    listener = sim.listen("chatter", "std_msgs/msg/String", lambda m: received.append((sim.tick, m.data)))
    sim.step(3)
    publisher.publish({"data": "a"})
    sim.publish("/chatter", {"data": "b"})
    assert received == []
    sim.step(2)
    assert received == [(3, "a"), (3, "b")]
    listener.close()
    publisher.publish({"data": "c"})
    sim.step()
    assert len(received) == 2 and publisher.subscribers == 0


def test_a_publisher_counts_subscriptions_and_inputs_and_keeps_a_latched_message(sim: simkit.Simulation) -> None:
    publisher = sim.advertise("/map", "std_msgs/msg/String", latched=True)
    publisher.publish(msgs.make("std_msgs/msg/String", data="house"))
    late = sim.subscribe("/map")
    sim.listen("/map", "std_msgs/msg/String", lambda _: None)
    assert late.latest.data == "house" and publisher.subscribers == 2
    publisher.close()
    late.close()
    assert "/map" in sim.topics()


def test_a_message_object_opens_an_unknown_topic_and_a_dict_does_not(sim: simkit.Simulation) -> None:
    with pytest.raises(MessageError, match="no topic '/level'"):
        sim.publish("/level", {"data": 1.0})
    sim.publish("/level", msgs.make("std_msgs/msg/Float64", data=1.0))
    assert sim.topics()["/level"] == "std_msgs/msg/Float64"
    heard = sim.subscribe("/level")
    sim.publish("/level", {"data": 2})
    assert [m.data for m in heard.messages] == [2.0]


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (None, "'/chatter' needs std_msgs/msg/String, or a dict of its fields; None (NoneType) is not a message"),
        (3, "3 (int) is not a message"),
        (msgs.type_of("std_msgs/msg/String"), "the class std_msgs__msg__String is not a message"),
        ({"dat": "x"}, "'/chatter': std_msgs/msg/String has no field 'dat'; did you mean 'data'"),
        ({"data": 5}, "'/chatter': std_msgs/msg/String.data: found 5"),
        (msgs.make("std_msgs/msg/Bool"), "'/chatter' needs std_msgs/msg/String, got std_msgs/msg/Bool"),
    ],
)
def test_an_invalid_message_names_the_topic(sim: simkit.Simulation, value: Any, text: str) -> None:
    publisher = sim.advertise("/chatter", "std_msgs/msg/String")
    for publish in (publisher.publish, lambda m: sim.publish("/chatter", m)):
        with pytest.raises(MessageError) as error:
            publish(value)
        assert text in str(error.value) and error.value.code == "SK-MSG-001"


def test_a_topic_has_one_type(sim: simkit.Simulation) -> None:
    sim.advertise("/chatter", "std_msgs/msg/String")
    for use in (
        lambda: sim.advertise("/chatter", "std_msgs/msg/Bool"),
        lambda: sim.listen("/chatter", "std_msgs/msg/Bool", print),
    ):
        with pytest.raises(MessageError, match="'/chatter' has type std_msgs/msg/String, got std_msgs/msg/Bool"):
            use()
    with pytest.raises(MessageError, match="did you mean 'std_msgs/msg/String'"):
        sim.advertise("/x", "std_msgs/msg/Strng")


def test_a_service_of_a_script_can_be_closed_and_survives_reset_and_restore(sim: simkit.Simulation) -> None:
    service = sim.offer("/add", ADD, lambda request: {"sum": request.a + request.b})
    before = sim.snapshot()
    sim.reset()
    sim.restore(before)
    assert sim.call("/add", {"a": 2, "b": 3}).sum == 5
    with pytest.raises(ServiceError, match="'/add' exists already"):
        sim.offer("/add", ADD, lambda _: None)
    service.close()
    with pytest.raises(ServiceError, match="no service '/add'"):
        sim.call("/add")


@pytest.mark.parametrize(
    ("handler", "text"),
    [
        (raising, r"'raising' \(.*:\d+\) of service '/add' raised at t=0 s: ValueError\('no bricks left'\)"),
        (lambda _: {"sun": 1}, "AddTwoInts_Response has no field 'sun'; did you mean 'sum'"),
        (
            lambda _: 5,
            "response of '/add' needs .*AddTwoInts_Response, or a dict of its fields; 5 \\(int\\) is not a message",
        ),
    ],
)
def test_an_error_in_a_service_of_a_script_names_service_and_function(
    sim: simkit.Simulation, handler: Any, text: str
) -> None:
    sim.offer("/add", ADD, handler)
    with pytest.raises(SubscriberError, match=text) as error:
        sim.call("/add")
    assert error.value.code == "SK-TOPIC-002"
    assert error.value.__cause__ is not None


def test_a_call_with_on_done_is_answered_before_the_next_step(sim: simkit.Simulation) -> None:
    sim.offer("/add", ADD, lambda request: {"sum": request.a + request.b})
    ended: list[tuple[int, Any]] = []
    call = sim.call("/add", {"a": 1, "b": 1}, on_done=lambda call: ended.append((sim.tick, call.response.sum)))
    before = sim.snapshot()
    assert not call.is_done and ended == []
    sim.step(2)
    sim.restore(before)
    sim.step(2)
    assert ended == [(0, 2), (0, 2)], "a restored run repeats the call"


def test_a_failed_call_with_on_done_has_the_error(sim: simkit.Simulation) -> None:
    service = sim.offer("/add", ADD, lambda _: None)
    calls: list[Any] = []
    sim.call("/add", on_done=calls.append)
    service.close()
    sim.step()
    assert calls[0].response is None and str(calls[0].error) == "the service '/add' was removed"
    sim.offer("/add", ADD, lambda _: None)
    sim.call("/add", on_done=raising)
    with pytest.raises(SubscriberError, match="'raising'.*of service '/add'"):
        sim.step()


def test_an_action_of_a_script_has_feedback_and_results_and_can_be_cancelled(sim: simkit.Simulation) -> None:
    goals: list[Any] = []
    sim.act("/fibonacci", FIBONACCI, goals.append, lambda goal: goal.canceled({"sequence": [7]}))
    heard: list[Any] = []
    first, second = (
        sim.send_goal("/fibonacci", {"order": n}, lambda f: heard.append(list(f.sequence))) for n in (3, 4)
    )
    sim.step()
    assert [g.request.order for g in goals] == [3, 4] and first.status is GoalStatus.EXECUTING
    goals[0].publish_feedback({"sequence": [0, 1]})
    goals[0].succeed({"sequence": [0, 1, 1]})
    second.cancel()
    sim.step()
    assert (list(first.result.sequence), first.status) == ([0, 1, 1], GoalStatus.SUCCEEDED)
    assert (list(second.result.sequence), second.status) == ([7], GoalStatus.CANCELED)
    assert heard == [[0, 1]]


def test_a_goal_callback_may_return_the_result(sim: simkit.Simulation) -> None:
    sim.act("/fibonacci", FIBONACCI, lambda goal: {"sequence": range(goal.request.order)})
    goal = sim.send_goal("/fibonacci", {"order": 3})
    sim.step()
    assert (goal.status, list(goal.result.sequence)) == (GoalStatus.SUCCEEDED, [0, 1, 2])


def test_a_goal_that_a_reset_undid_cannot_be_ended(sim: simkit.Simulation) -> None:
    goals: list[Any] = []
    action = sim.act("/fibonacci", FIBONACCI, goals.append)
    sim.send_goal("/fibonacci")
    sim.step()
    sim.reset()
    goals[0].publish_feedback({"sequence": [1]})
    with pytest.raises(ActionError, match="undone by a reset"):
        goals[0].succeed()
    goal = sim.send_goal("/fibonacci")
    sim.step()
    action.close()
    assert (goal.status, goal.reason) == (GoalStatus.ABORTED, "the action was closed")


def test_an_exception_in_the_goal_callback_of_a_script_names_action_and_function(sim: simkit.Simulation) -> None:
    sim.act("/fibonacci", FIBONACCI, raising)
    sim.send_goal("/fibonacci")
    with pytest.raises(SubscriberError, match=r"'raising' \(.*test_script_graph.*\) of action '/fibonacci' raised"):
        sim.step()


def test_a_parameter_of_a_script_is_bounded_and_returns_to_its_value_with_a_reset(sim: simkit.Simulation) -> None:
    changes: list[float] = []
    gain = sim.declare("gain", 2.0, minimum=0.0, maximum=5.0, on_change=changes.append)
    sim.set_parameter("/script", "gain", 3)
    with pytest.raises(ParameterError, match="a number from 0 to 5"):
        sim.set_parameter("/script", "gain", 9.0)
    before = sim.snapshot()
    assert sim.call("/script/get_parameters", {"names": ["gain"]}).values[0].double_value == 3.0
    sim.reset()
    assert (gain.value, changes) == (2.0, [3.0])
    sim.restore(before)
    assert gain.value == 3.0
    with pytest.raises(ParameterError, match="'/script' has a parameter 'gain' already"):
        sim.declare("gain", 1.0)


@pytest.mark.parametrize(
    ("name", "value", "options"),
    [
        *(("a", value, {}) for value in (None, {}, ("x",), float("nan"))),
        *((name, 1, {}) for name in ("", None)),
        *(("a", 5, options) for options in ({"maximum": 3}, {"minimum": "x"}, {"on_change": 3}, {"node": ""})),
    ],
)
def test_a_parameter_cannot_have_any_value(sim: simkit.Simulation, name: Any, value: Any, options: Any) -> None:
    with pytest.raises(InputError):
        sim.declare(name, value, **options)
    assert "/script" not in sim.communication.parameters


def test_a_parameter_is_closed_and_its_node_ends_with_the_last_one(sim: simkit.Simulation) -> None:
    events = sim.subscribe("/parameter_events")
    gain, offset = sim.declare("gain", 2.0, node="/arm"), sim.declare("offset", 0.5, node="/arm")
    gain.close()
    with pytest.raises(ParameterError, match="'/arm' has no parameter 'gain'"):
        sim.set_parameter("/arm", "gain", 3.0)
    assert [p.name for p in events.latest.deleted_parameters] == ["gain"]
    assert "/arm/get_parameters" in sim.communication.services.names()
    again = sim.declare("gain", 1.0, node="/arm")
    gain.close()  # the first one is closed already
    sim.set_parameter("/arm", "gain", 4.0)
    assert (gain.value, again.value) == (2.0, 4.0)
    again.close()
    offset.close()
    assert not [name for name in sim.communication.services.names() if name.startswith("/arm/")]
