"""Services and actions of programs, as scripts and the other side of the graph see them."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.errors import ServiceError
from simkit.msgs.goal_status import GoalStatus
from simkit_nodes.host import current_host, current_program
from simkit_verification.testing.bundles import keep, replay, write_bundle

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"


def sum_of(a: int, b: int) -> Any:
    return msgs.make(f"{ADD}_Response", sum=a + b)


def adder() -> None:
    """Program that answers at once."""
    host = current_host()
    service = host.graph.open_node(current_program(), "/adder").offer("/add", ADD)
    while True:
        host.wait(None, lambda: service.has_request)
        request = service.take()
        request.answer(sum_of(request.message.a, request.message.b))


def slow_adder() -> None:
    """Program that answers after 20 ms."""
    host = current_host()
    service = host.graph.open_node(current_program(), "/adder").offer("/add", ADD)
    while True:
        host.wait(None, lambda: service.has_request)
        request = service.take()
        host.wait(host.now_ns() + 20_000_000)
        request.answer(sum_of(request.message.a, request.message.b))


def test_a_script_calls_the_service_of_a_program() -> None:
    with simkit.load(EMPTY) as sim:
        sim.add_node(adder)
        sim.step(2)
        assert sim.communication.services.names()["/add"] == ADD
        assert sim.call("/add", {"a": 2, "b": 40}).sum == 42
        for number in range(300):
            assert sim.call("/add", {"a": number}).sum == number
        assert sim.time == pytest.approx(0.002), "the answers need no step"


def test_a_script_receives_the_response_of_a_program_that_needs_time() -> None:
    with simkit.load(EMPTY) as sim:
        sim.add_node(slow_adder)
        sim.step(2)
        with pytest.raises(ServiceError, match="needs simulated time") as error:
            sim.call("/add", {"a": 2})
        assert error.value.code == "SK-SERVICE-012"
        sim.run(0.1)
        answers: list[tuple[float, int]] = []
        sim.call("/add", {"a": 2, "b": 3}, on_done=lambda call: answers.append((round(sim.time, 3), call.response.sum)))
        sim.run(0.1)
        assert answers == [(0.122, 5)]


def test_the_end_of_a_program_is_an_error_for_the_callers_of_its_service() -> None:
    def ending() -> None:
        host = current_host()
        host.graph.open_node(current_program(), "/brief").offer("/add", ADD)
        host.wait(host.now_ns() + 10_000_000)

    with simkit.load(EMPTY) as sim:
        sim.add_node(ending)
        sim.step(2)
        call = sim.call("/add", on_done=lambda call: None)
        sim.run(0.1)
        assert "was closed before it answered" in str(call.error)
        assert "/add" not in sim.communication.services.names()


def test_a_second_service_of_the_same_name_answers_after_the_end_of_the_first() -> None:
    def offering(node: str, sign: int, end_ns: int) -> None:
        host = current_host()
        service = host.graph.open_node(current_program(), node).offer("/add", ADD)
        while host.now_ns() < end_ns:
            host.wait(end_ns, lambda: service.has_request)
            while (request := service.take()) is not None:
                request.answer(sum_of(sign * request.message.a, 0))

    with simkit.load(EMPTY) as sim:
        sim.add_node(lambda: offering("/first", 1, 50_000_000))
        sim.add_node(lambda: offering("/second", -1, 10_000_000_000))
        sim.run(0.02)
        assert sim.call("/add", {"a": 5}).sum == 5
        sim.run(0.1)
        assert sim.call("/add", {"a": 5}).sum == -5


def client_program(name: str, type_name: str, request: Any, log: list[Any]) -> None:
    host = current_host()
    client = host.graph.open_node(current_program(), "/client").client(name, type_name)
    assert not client.is_ready, "nothing is discovered in the step in which it was opened"
    client.call(request, lambda response: log.append(("lost?", response)))
    host.wait(None, lambda: client.is_ready)
    client.call(request, log.append)
    host.wait(None, lambda: bool(log))


def test_a_program_calls_a_service_of_the_simulation_and_of_another_program() -> None:
    for provider in (adder, slow_adder, lambda request: {"sum": request.a + request.b}):
        with simkit.load(EMPTY) as sim:
            if provider in (adder, slow_adder):
                sim.add_node(provider)
            else:
                sim.offer("/add", ADD, provider)
            log: list[Any] = []
            request = msgs.make(f"{ADD}_Request", a=2, b=40)
            program = sim.add_node(lambda request=request, log=log: client_program("/add", ADD, request, log))
            sim.run(0.1)
            assert [message.sum for message in log] == [42]
            assert program.done and program.error is None


def test_a_client_is_not_ready_for_a_service_of_another_type() -> None:
    ready: list[bool] = []

    def program() -> None:
        host = current_host()
        client = host.graph.open_node(current_program(), "/client").client("/add", "std_srvs/srv/Trigger")
        host.wait(host.now_ns() + 50_000_000)
        ready.append(client.is_ready)

    with simkit.load(EMPTY) as sim:
        sim.add_node(adder)
        sim.add_node(program)
        sim.run(0.1)
        assert ready == [False]


def test_a_bundle_repeats_the_responses_of_a_program_without_it(tmp_path: Any) -> None:
    path = tmp_path / "yard.sdf"
    path.write_text('<sdf version="1.9"><world name="yard"><model name="ball"><link name="l"/></model></world></sdf>')
    with simkit.load(path) as sim, keep(sim):
        sim.add_node(slow_adder)
        sim.add_node(
            lambda: client_program("/add", ADD, msgs.make(f"{ADD}_Request", a=2, b=40), []),
        )
        sim.run(0.01)

        def move(call: Any) -> None:
            sim.model("ball").set_velocity((0.1 * call.response.sum, 0.0, 0.0), (0.0, 0.0, 0.0))

        sim.call("/add", {"a": 2, "b": 3}, on_done=move)
        sim.run(0.1)
        bundle = write_bundle(sim, tmp_path / "run.zip")
    found = replay(bundle)
    assert found.is_same, (found.differences, found.refused)
    assert not found.refused


def counter_action(decisions: dict[str, Any]) -> None:
    """Program with an action that counts to `order`, a number each 10 ms."""
    host = current_host()
    server = host.graph.open_node(current_program(), "/counter").act("/count", FIBONACCI, 1_000_000_000)
    while True:
        host.wait(None, lambda: server.has_request)
        goal = server.take_goal()
        if goal is None:
            server.take_cancel().reject()
            continue
        if goal.request.order < 0:
            goal.reject()
            continue
        goal.accept()
        decisions.setdefault("ids", []).append(goal.id)
        numbers: list[int] = []
        status = 4
        for number in range(goal.request.order):
            host.wait(host.now_ns() + 10_000_000)
            cancel = server.take_cancel()
            if cancel is not None and number >= decisions.get("cancels_from", 0):
                cancel.accept()
                status = 5
                break
            if cancel is not None:
                cancel.reject()
            numbers.append(number)
            goal.publish_feedback(msgs.make(f"{FIBONACCI}_Feedback", sequence=numbers))
        goal.end(status, msgs.make(f"{FIBONACCI}_Result", sequence=numbers))


def test_a_script_sends_goals_to_the_action_of_a_program() -> None:
    with simkit.load(EMPTY) as sim:
        sim.add_node(lambda: counter_action({}))
        sim.step(2)
        events: list[Any] = []
        goal = sim.send_goal("/count", {"order": 3}, lambda f: events.append(list(f.sequence)), events.append)
        sim.run(0.01)
        assert goal.status is GoalStatus.EXECUTING
        sim.run(0.1)
        assert events == [[0], [0, 1], [0, 1, 2], goal]
        assert goal.status is GoalStatus.SUCCEEDED and list(goal.result.sequence) == [0, 1, 2]
        rejected = sim.send_goal("/count", {"order": -1})
        cancelled = sim.send_goal("/count", {"order": 100})
        sim.run(0.035)
        cancelled.cancel()
        sim.run(0.05)
        assert rejected.status is GoalStatus.REJECTED
        assert cancelled.status is GoalStatus.CANCELED and len(cancelled.result.sequence) == 3


def action_client(name: str, order: int, cancel_ns: int | None, log: list[Any]) -> None:
    host = current_host()
    client = host.graph.open_node(current_program(), "/client").action_client(name, FIBONACCI)
    host.wait(None, lambda: client.is_ready)
    goal = client.send(
        msgs.make(f"{FIBONACCI}_Goal", order=order),
        client.new_goal_id(),
        lambda feedback: log.append(("feedback", list(feedback.sequence))),
        lambda accepted, _: log.append(("accepted", accepted)),
        lambda status, result: log.append(("result", status, list(result.sequence))),
    )
    if cancel_ns is not None:
        host.wait(host.now_ns() + cancel_ns)
        goal.cancel(lambda code, is_cancelled: log.append(("cancel", code, is_cancelled)))
    host.wait(None, lambda: any(entry[0] == "result" or entry == ("accepted", False) for entry in log))
    log.append(goal.id)


def run_client(order: int, cancel_ns: int | None = None, decisions: Any = None) -> list[Any]:
    log: list[Any] = []
    with simkit.load(EMPTY) as sim:
        sim.add_node(lambda: counter_action({} if decisions is None else decisions))
        program = sim.add_node(lambda: action_client("/count", order, cancel_ns, log))
        sim.run(0.5)
        assert program.done and program.error is None
    return log


def test_acceptance_feedback_and_result_come_in_this_order() -> None:
    decisions: dict[str, Any] = {}
    log = run_client(2, decisions=decisions)
    assert log[:-1] == [("accepted", True), ("feedback", [0]), ("feedback", [0, 1]), ("result", 4, [0, 1])]
    assert decisions["ids"] == [log[-1]], "the client chooses the identifier of the goal"
    assert run_client(2) == log, "it is the same in each run"


def test_a_program_rejects_a_goal() -> None:
    assert run_client(-1)[:-1] == [("accepted", False)]


def test_a_program_is_told_whether_its_cancel_request_was_accepted() -> None:
    accepted = run_client(50, 25_000_000)[:-1]
    assert ("cancel", 0, True) in accepted and accepted[-1] == ("result", 5, [0, 1])
    rejected = run_client(5, 25_000_000, {"cancels_from": 5})[:-1]
    assert ("cancel", 0, False) in rejected and rejected[-1] == ("result", 4, [0, 1, 2, 3, 4])


def test_a_program_uses_an_action_of_the_simulation() -> None:
    def execute(goal: Any) -> None:
        goals.append(goal)
        goal.publish_feedback({"sequence": [7]})

    def cancel_goal(goal: Any) -> None:
        goal.canceled({"sequence": [8]})

    for can_cancel in (True, False):
        goals: list[Any] = []
        log: list[Any] = []
        with simkit.load(EMPTY) as sim:
            sim.act("/count", FIBONACCI, execute, cancel_goal if can_cancel else None)
            sim.add_node(lambda log=log: action_client("/count", 3, 20_000_000, log))
            sim.run(0.1)
            if not can_cancel:
                goals[0].succeed({"sequence": [9]})
                sim.run(0.1)
        result = ("result", 5, [8]) if can_cancel else ("result", 4, [9])
        cancel = ("cancel", 0, True) if can_cancel else ("cancel", 1, False)
        assert log[:2] == [("accepted", True), ("feedback", [7])]
        assert log[2:-1] == [result, cancel] if can_cancel else [cancel, result]


def test_the_goals_of_a_program_that_ends_are_aborted() -> None:
    def brief() -> None:
        host = current_host()
        server = host.graph.open_node(current_program(), "/brief").act("/count", FIBONACCI, 1_000_000_000)
        host.wait(None, lambda: server.has_request)
        server.take_goal().accept()
        host.wait(host.now_ns() + 10_000_000)

    with simkit.load(EMPTY) as sim:
        sim.add_node(brief)
        sim.step(2)
        goal = sim.send_goal("/count", {"order": 3})
        sim.run(0.1)
        assert goal.status is GoalStatus.ABORTED
        assert "/count" not in sim.communication.actions.names()


def test_latency_delays_requests_and_responses_and_keeps_their_order() -> None:
    times: list[float] = []

    def asking() -> None:
        host = current_host()
        client = host.graph.open_node(current_program(), "/client").client("/add", ADD)
        host.wait(None, lambda: client.is_ready)
        begun = host.now_ns()
        for number in range(3):
            request = msgs.make(f"{ADD}_Request", a=number)
            client.call(request, lambda response: times.append((response.sum, (host.now_ns() - begun) / 1e6)))
        host.wait(None, lambda: len(times) == 3)

    with simkit.load(EMPTY) as sim:
        sim.add_node(adder, latency=0.02)
        sim.add_node(asking, latency=(0.01, 0.03))
        sim.run(0.2)
    assert [number for number, _ in times] == [0, 1, 2]
    assert all(30.0 <= time <= 52.0 for _, time in times)
    assert times[0][1] <= times[1][1] <= times[2][1]


def test_a_reset_repeats_the_identifiers_of_goals() -> None:
    log: list[Any] = []
    with simkit.load(EMPTY) as sim:
        sim.add_node(lambda: counter_action({}))
        sim.add_node(lambda: action_client("/count", 2, None, log))
        sim.run(0.1)
        first = list(log)
        log.clear()
        sim.reset()
        sim.run(0.1)
        assert log == first and len(first[-1]) == 16
