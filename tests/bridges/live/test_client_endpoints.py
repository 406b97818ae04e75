"""Services, actions, command inputs and parameters that clients offer to a simulation and to each other."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import simkit
from simkit import msgs
from simkit.errors import ServiceError
from simkit.lifecycle import LifecycleNode
from simkit.live import Client, LiveError, LiveServerGoal, Server
from simkit.msgs.goal_status import GoalStatus
from simkit_verification.testing.bundles import keep, replay, write_bundle

ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"
BALL = '<sdf version="1.9"><world name="yard"><model name="ball"><link name="l"/></model></world></sdf>'


@contextmanager
def serving(path: Path, opens: Callable[[Client], Any], node: str = "server") -> Iterator[list[LiveError]]:
    """A client on a thread of its own that opens something and serves it; yields the errors of its callbacks."""
    over, ready = threading.Event(), threading.Event()
    failed: list[LiveError] = []

    def run() -> None:
        with Client(path, node=node) as client:
            try:
                opens(client)
            except LiveError as error:
                failed.append(error)
            ready.set()
            while not over.is_set():
                try:
                    client.spin(0.01)
                except LiveError as error:
                    failed.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        ready.wait(60.0)
        yield failed
    finally:
        over.set()
        thread.join()


def add(request: Any) -> dict[str, int]:
    return {"sum": request.a + request.b}


def raising(_: Any) -> None:
    raise ValueError("no bricks left")


def test_a_client_calls_the_service_of_another_client(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    with run(court) as client, serving(client.path, lambda c: c.offer("/add", ADD, add)):
        assert client.call("/add", {"a": 2, "b": 40}).sum == 42
        assert client.services()["/add"] == ADD
        assert client.ask("nodes")["/server"]["services"] == {"/add": [ADD]}
        with pytest.raises(LiveError, match="'/add' exists already, of another process, '/server'") as error:
            client.offer("/add", ADD, add)
        assert error.value.code == "SK-SERVICE-001"
        with pytest.raises(LiveError, match="did you mean 'a'"):
            client.call("/add", {"aa": 2})
        with pytest.raises(LiveError, match="unknown message type 'example_interfaces/srv/Ad_Request'"):
            client.ask("offer", number=77, name="/x", type="example_interfaces/srv/Ad")


def count(goal: LiveServerGoal[msgs.Fibonacci_Goal]) -> dict[str, list[int]]:
    goal.publish_feedback({"sequence": [1]})
    return {"sequence": [goal.request.order]}


def test_a_client_names_types_by_class(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    def opens(server: Client) -> None:
        server.offer("/add", msgs.AddTwoInts_Request, add)
        server.act("/fibonacci", msgs.Fibonacci_Goal, count)

    with run(court) as client, serving(client.path, opens):
        words = client.subscribe("/words", type=msgs.String)
        heard: list[int] = []
        client.listen("/number", msgs.Int64, lambda message: heard.append(message.data))
        client.advertise("/number", msgs.Int64).publish(msgs.Int64(7))
        client.advertise("/words", msgs.String).publish({"data": "hello"})
        assert next(words).message.data == "hello"
        assert client.wait(lambda: heard == [7], 5.0)
        assert client.call("/add", {"a": 2, "b": 40}, type=msgs.AddTwoInts_Request).sum == 42
        goal = client.send_goal("/fibonacci", {"order": 3}, type=msgs.Fibonacci_Goal)
        assert goal.wait(5.0)
        assert (goal.result.sequence.tolist(), goal.feedback.sequence.tolist()) == ([3], [1])


def test_a_client_that_names_another_type_gets_an_error(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    with run(court) as client, serving(client.path, lambda c: c.offer("/add", ADD, add)):
        early = client.subscribe("/words", type=msgs.Imu)
        words = client.advertise("/words", msgs.String)
        with pytest.raises(LiveError, match="'/words' has type std_msgs/msg/String, got type=sensor_msgs/msg/Imu"):
            client.subscribe("/words", type=msgs.Imu)
        words.publish({"data": "hello"})
        with pytest.raises(LiveError, match="'/words' has type") as error:
            early.get(5.0)
        assert error.value.code == "SK-MSG-001"
        with pytest.raises(
            LiveError, match="needs example_interfaces/srv/AddTwoInts_Request, got std_srvs/srv/Trigger"
        ):
            client.call("/add", type=msgs.Trigger_Request)


def test_a_client_answers_later_and_calls_services_that_answer_later(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    waiting: list[simkit.DeferredResponse] = []

    def build(_: Any) -> simkit.DeferredResponse:
        waiting.append(simkit.DeferredResponse())
        return waiting[-1]

    def open_services(builder: Client) -> None:
        builder.offer("/build", "std_srvs/srv/Trigger", build)
        builder.subscribe("/bricks", lambda message: waiting.pop().respond({"message": message.data}))

    court.listen("/bricks", "std_msgs/msg/String", lambda message: None)
    pending: list[simkit.DeferredResponse] = []

    def open_gate(_: Any) -> simkit.DeferredResponse:
        pending.append(simkit.DeferredResponse())
        return pending[-1]

    court.offer("/open", "std_srvs/srv/Trigger", open_gate)
    court.listen("/key", "std_msgs/msg/String", lambda message: pending.pop().respond({"message": message.data}))
    with run(court) as client, serving(client.path, open_services):
        bricks = client.advertise("/bricks", "std_msgs/msg/String")
        key = client.advertise("/key", "std_msgs/msg/String")
        for publisher, service in ((bricks, "/build"), (key, "/open")):
            with Client(client.path, node="caller") as caller:
                answers: list[str] = []
                thread = threading.Thread(target=lambda: answers.append(caller.call(service).message))  # noqa: B023
                thread.start()
                while not (waiting or pending):
                    client.spin(0.01)
                assert not answers
                publisher.publish({"data": f"{service} is done"})
                while thread.is_alive():
                    client.spin(0.01)
                assert answers == [f"{service} is done"]


def test_functions_of_a_client_may_call_services_and_its_own_service_answers_meanwhile(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    sums: list[int] = []
    with run(court) as client:
        with pytest.raises(LiveError, match="unknown request 'respnd'"):
            client.ask("respnd")
        client.offer("/add", ADD, add)
        client.offer("/twice", ADD, lambda request: {"sum": 2 * client.call("/add", request_of(request)).sum})
        client.listen("/go", "std_msgs/msg/Int64", lambda m: sums.append(client.call("/twice", {"a": m.data}).sum))
        publisher = client.advertise("/go")
        for value in (1, 2, 3):
            publisher.publish({"data": value})
        assert client.call("/twice", {"a": 5, "b": 1}).sum == 12
        assert client.wait(lambda: len(sums) == 3, 5.0)
    assert sums == [2, 4, 6]


def request_of(request: Any) -> dict[str, int]:
    return {"a": request.a, "b": request.b}


@pytest.mark.parametrize(
    ("handler", "text"),
    [
        (raising, r"callback 'raising' \(.*:\d+\) of service '/add' raised: ValueError\('no bricks left'\)"),
        (lambda _: {"sun": 1}, "AddTwoInts_Response has no field 'sun'; did you mean 'sum'"),
        (lambda _: 3, r"3 \(int\) is not a message"),
    ],
)
def test_a_service_that_fails_reports_to_its_caller_and_raises_in_its_own_process(
    court: simkit.Simulation, run: Callable[..., Any], handler: Any, text: str
) -> None:
    with run(court) as client, serving(client.path, lambda c: c.offer("/add", ADD, handler)) as failed:
        with pytest.raises(LiveError, match=text) as error:
            client.call("/add")
        assert error.value.code == "SK-SERVICE-010" and "client '/server'" in str(error.value)
        client.flush()
    assert [e.code for e in failed] == ["SK-TOPIC-002"]


def test_a_caller_gets_an_error_when_the_process_of_the_service_ends_or_is_slow(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    with run(court) as client:
        server = Client(client.path, node="server")
        server.offer("/add", ADD, add)  # never receives
        with pytest.raises(LiveError, match=r"'/add' gave no response within 0.05 s") as error:
            client.call("/add", timeout=0.05)
        assert error.value.code == "SK-SERVICE-010"
        killer = threading.Timer(0.05, server.close)
        killer.start()
        # a busy machine may close the server before the call
        with pytest.raises(LiveError, match="no service '/add'|'/add' of '/server' was closed before it answered"):
            client.call("/add")
        killer.join()
        assert "/add" not in client.services()


def test_a_goal_goes_from_client_to_client_with_feedback_result_rejection_and_cancellation(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    def execute(goal: Any) -> Any:
        if goal.request.order > 100:
            goal.reject("too far")
            return None
        sequence = [0, 1]
        while len(sequence) <= goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled({"sequence": sequence})
                return None
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback({"sequence": sequence[-40:]})
        return {"sequence": sequence}

    heard: list[list[int]] = []
    with run(court) as client, serving(client.path, lambda c: c.act("/fibonacci", FIBONACCI, execute, lambda _: True)):
        goal = client.send_goal("/fibonacci", {"order": 4}, lambda f: heard.append(list(f.sequence)))
        assert goal.wait(60.0)
        assert (goal.status, list(goal.result.sequence)) == (GoalStatus.SUCCEEDED, [0, 1, 1, 2, 3])
        client.flush()
        assert heard == [[0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]
        far = client.send_goal("/fibonacci", {"order": 101})
        assert far.wait(60.0)
        assert (far.status, far.reason) == (GoalStatus.REJECTED, "too far")


def test_a_goal_is_cancelled_or_aborted_with_its_process(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    goals: list[Any] = []

    def on_cancel(goal: Any) -> bool:
        if goal.request.order == 1:
            return False
        goal.canceled({"sequence": [7]})
        return True

    with run(court) as client:
        with serving(client.path, lambda c: c.act("/fibonacci", FIBONACCI, goals.append, on_cancel)):
            kept, cancelled = (client.send_goal("/fibonacci", {"order": order}) for order in (1, 2))
            assert kept.wait_accepted(60.0) and cancelled.wait_accepted(60.0)
            kept.cancel()
            cancelled.cancel()
            assert cancelled.wait(60.0)
            assert (cancelled.status, list(cancelled.result.sequence)) == (GoalStatus.CANCELED, [7])
            assert client.wait(lambda: kept.status is GoalStatus.EXECUTING, 60.0)
        assert kept.wait(60.0)
        assert (kept.status, kept.reason) == (GoalStatus.ABORTED, "the action of '/server' was closed")


def test_a_goal_is_aborted_for_its_sender_when_the_server_of_the_simulation_closes(sockets: Path) -> None:
    with simkit.load(BALL) as sim, Server(sim) as server:
        over = threading.Event()
        found: list[Any] = []

        def send() -> None:
            with Client(server.path) as client:
                waited = client.send_goal("/fibonacci", {"order": 1})
                waited.wait_accepted(10.0)
                over.set()
                waited.wait(60.0)
                found.append((waited.status, waited.reason))

        failed: list[LiveError] = []
        with serving_until_the_end(server.path, failed):
            poll_until(server, lambda: "/fibonacci" in sim.communication.actions.names())
            sender = threading.Thread(target=send)
            sender.start()
            while not over.is_set():
                sim.step()
                server.poll(0.01)
            server.close()
            sender.join(60.0)
        assert found == [(GoalStatus.ABORTED, "the action of '/server' was closed")]
        assert not failed, "a callback that waits ends with the simulation"


def test_a_subscriber_that_waits_for_the_simulation_ends_with_it(sockets: Path) -> None:
    failed: list[LiveError] = []
    waits = threading.Event()

    def run(path: Path) -> None:
        with Client(path) as client:

            def wait(_: Any) -> None:
                waits.set()
                while True:
                    client.receive(0.1)

            client.subscribe("/clock", wait)
            try:
                client.spin()
            except LiveError as error:
                failed.append(error)

    with simkit.load(BALL) as sim, Server(sim) as server:
        thread = threading.Thread(target=run, args=(server.path,))
        thread.start()
        while not waits.is_set():
            sim.step()
            server.poll(0.01)
    thread.join(60.0)
    assert not thread.is_alive() and not failed


@contextmanager
def serving_until_the_end(path: Path, failed: list[LiveError]) -> Iterator[None]:
    """A client whose action waits until the simulation ends."""

    def run() -> None:
        with Client(path, node="server") as client:

            def execute(goal: Any) -> None:
                goal.accept()
                while True:
                    goal.publish_feedback({"sequence": [1]})
                    client.receive(0.1)

            try:
                client.act("/fibonacci", FIBONACCI, execute)  # a goal may come while this waits for its answer
                client.spin()
            except LiveError as error:
                failed.append(error)

    thread = threading.Thread(target=run)
    thread.start()
    yield
    thread.join()


def test_a_client_is_a_lifecycle_node(court: simkit.Simulation, run: Callable[..., Any]) -> None:
    calls: list[tuple[str, str]] = []

    class Driver:
        def on_configure(self, previous: str) -> None:
            calls.append(("configure", previous))

        def on_activate(self, previous: str) -> bool:
            calls.append(("activate", previous))
            return False

    nodes: list[LifecycleNode] = []
    with run(court) as client, serving(client.path, lambda c: nodes.append(LifecycleNode(c, callbacks=Driver()))):
        events = client.subscribe("/server/transition_event")

        def change(label: str) -> bool:
            found: bool = client.call("/server/change_state", {"transition": {"label": label}}).success
            return found

        assert [change("configure"), change("activate"), change("configure")] == [True, False, False]
        assert client.call("/server/get_state").current_state.label == nodes[0].state == "inactive"
        assert calls == [("configure", "unconfigured"), ("activate", "inactive")]
        client.flush()
        assert [r.message.transition.id for r in events.waiting] == [1, 10, 3, 31]


def test_commands_topics_and_parameters_reach_the_functions_of_a_client(
    court: simkit.Simulation, run: Callable[..., Any]
) -> None:
    commands: list[float] = []
    values: list[float] = []
    heard: list[float] = []

    def opens(client: Client) -> None:
        client.listen("/gear", "std_msgs/msg/Float64", lambda m: commands.append(m.data))
        client.subscribe("/gear", lambda m: heard.append(m.data))
        client.declare("gain", 2.0, minimum=0.0, on_change=values.append)

    with run(court) as client, serving(client.path, opens, "robot"):
        publisher = client.advertise("/gear")
        for value in (1.0, 2.0, 3.0):
            publisher.publish({"data": value})
        client.set_parameter("/robot", "gain", 4.0)
        assert client.call("/robot/get_parameters", {"names": ["gain"]}).values[0].double_value == 4.0
        with pytest.raises(LiveError, match="a number of at least 0"):
            client.set_parameter("/robot", "gain", -1.0)
        assert publisher.subscribers == 2
        assert client.parameters()["/robot"]["gain"]["value"] == 4.0
        end = time.monotonic() + 60.0
        while (len(commands) < 3 or len(heard) < 3 or not values) and time.monotonic() < end:
            client.flush()
    assert (commands, heard, values) == ([1.0, 2.0, 3.0], [1.0, 2.0, 3.0], [4.0])
    assert "/gear" not in court.topics() and "/robot" not in court.communication.parameters


def test_a_message_object_opens_a_topic_from_another_process(client: Client) -> None:
    client.publish("/level", simkit.msgs.make("std_msgs/msg/Float64", data=1.0))
    client.publish("/level", {"data": 2.0})
    assert [row["types"] for row in client.topics() if row["name"] == "/level"] == [["std_msgs/msg/Float64"]]


@pytest.fixture
def yard() -> Iterator[tuple[simkit.Simulation, Server]]:
    """A ball, and a server that the test polls."""
    with simkit.load(BALL) as sim, keep(sim), Server(sim) as server:
        yield sim, server


def poll_until(server: Server, condition: Callable[[], bool]) -> None:
    """Poll until a condition holds."""
    end = time.monotonic() + 60.0
    while not condition():
        assert time.monotonic() < end
        server.poll(0.01)


@contextmanager
def adding(yard: tuple[simkit.Simulation, Server], handler: Any = add) -> Iterator[simkit.Simulation]:
    """The yard with a client that offers `/add` and `/fibonacci`."""
    sim, server = yard
    ready = threading.Event()
    over = threading.Event()

    def serve() -> None:
        with Client(server.path, node="adder") as client:
            client.offer("/add", ADD, handler)
            client.act("/fibonacci", FIBONACCI, lambda goal: {"sequence": range(goal.request.order)})
            ready.set()
            while not over.is_set():
                client.spin(0.01)

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        poll_until(server, ready.is_set)
        yield sim
    finally:
        over.set()
        poll_until(server, lambda: not thread.is_alive())
        thread.join()


def test_a_script_waits_for_the_service_of_another_process(yard: tuple[simkit.Simulation, Server]) -> None:
    with adding(yard) as sim:
        assert sim.call("/add", {"a": 1, "b": 2}).sum == 3
        assert sim.tick == 0, "the simulation did not run"
    with pytest.raises(ServiceError, match="no service '/add'|closed before it answered"):
        sim.call("/add")


def test_a_script_gets_an_error_after_its_timeout(yard: tuple[simkit.Simulation, Server]) -> None:
    sim, server = yard
    too_late = threading.Event()

    def answer(_: Any) -> None:
        too_late.wait(60.0)

    with adding(yard, answer):
        with pytest.raises(ServiceError, match=r"'/adder', which did not answer within 0.01 s") as error:
            sim.call("/add", timeout=0.01)
        too_late.set()
        assert error.value.code == "SK-SERVICE-010"
        server.poll()


def test_a_callback_cannot_wait_for_another_process(yard: tuple[simkit.Simulation, Server]) -> None:
    with adding(yard) as sim:
        errors: list[ServiceError] = []

        def ask(_: Any) -> None:
            try:
                sim.call("/add")
            except ServiceError as error:
                errors.append(error)

        sim.listen("/go", "std_msgs/msg/Empty", ask)
        sim.publish("/go", {})
        sim.step()
        sim.offer("/ask", "std_srvs/srv/Trigger", ask)
        sim.call("/ask")
        assert [e.code for e in errors] == ["SK-SERVICE-011"] * 2
        assert "pass on_done=FUNCTION" in str(errors[0])


def test_a_run_with_servers_in_another_process_is_repeated_without_them(
    yard: tuple[simkit.Simulation, Server], sockets: Path
) -> None:
    sim, server = yard
    answers: list[tuple[int, int]] = []
    with adding(yard):

        def ask(_: Any) -> None:
            sim.call("/add", {"a": sim.tick, "b": 1}, on_done=move)

        def move(call: Any) -> None:
            answers.append((sim.tick, call.response.sum))
            sim.model("ball").set_velocity((0.1 * call.response.sum, 0.0, 0.0), (0.0, 0.0, 0.0))

        sim.listen("/go", "std_msgs/msg/Empty", ask)
        sim.publish("/go", {})
        sim.step(5)
        assert answers == [], "the run does not wait for the other process"
        before = sim.snapshot()
        poll_until(server, lambda: sim.communication.services.get_state()[1] == ())
        sim.step(5)
        assert answers == [(5, 1)], "the response acts at the first step after it has arrived"
        sim.restore(before)
        sim.step(5)
        assert answers == [(5, 1), (5, 1)], "a restored run repeats the response"
        assert sim.call("/add", {"a": 3}).sum == 3
        goal = sim.send_goal("/fibonacci", {"order": 3})
        sim.step()
        poll_until(server, lambda: goal.is_done)
        sim.model("ball").set_velocity((0.0, 0.1 * goal.result.sequence[-1], 0.0), (0.0, 0.0, 0.0))
        sim.step(10)
    found = replay(write_bundle(sim, sockets.parent / "run.zip"))
    assert found.is_same, (found.differences, found.refused)
    assert not found.refused and not found.manifest.missing


def test_a_process_that_ends_is_an_error_in_the_next_step(
    yard: tuple[simkit.Simulation, Server], sockets: Path
) -> None:
    sim, server = yard
    calls: list[Any] = []
    ready, over = threading.Event(), threading.Event()

    def serve() -> None:
        with Client(server.path, node="adder") as client:
            client.offer("/add", ADD, add)
            ready.set()
            over.wait(60.0)

    thread = threading.Thread(target=serve)
    thread.start()
    poll_until(server, ready.is_set)
    sim.call("/add", on_done=calls.append)
    server.poll()
    over.set()
    thread.join()
    poll_until(server, lambda: not server.peers)
    assert calls == []
    sim.step()
    assert str(calls[0].error) == "service '/add' of '/adder' was closed before it answered"
    assert calls[0].error.code == "SK-SERVICE-010"
    assert replay(write_bundle(sim, sockets.parent / "run.zip")).is_same
