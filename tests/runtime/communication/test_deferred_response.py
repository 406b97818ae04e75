"""Services that answer in a later step."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest

import simkit
from simkit.errors import MessageError, ServiceError

EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'
TRIGGER = "std_srvs/srv/Trigger"


class Oven(simkit.WorldPlugin):
    """Plugin that answers 5 steps after a request."""

    after_step_rate = 1000.0

    def load(self, parent: Any, params: simkit.Params) -> None:
        self.waiting: list[tuple[int, simkit.DeferredResponse]] = []
        self.offer("bake", TRIGGER, self.bake)

    def bake(self, request: Any) -> simkit.DeferredResponse:
        response = simkit.DeferredResponse()
        self.waiting.append((self.sim.tick + 5, response))
        return response

    def after_step(self) -> None:
        while self.waiting and self.waiting[0][0] <= self.sim.tick:
            self.waiting.pop(0)[1].respond({"message": f"baked at tick {self.sim.tick}"})

    def get_state(self) -> Mapping[str, Any]:
        return {"waiting": list(self.waiting)}

    def set_state(self, state: Mapping[str, Any]) -> None:
        self.waiting = list(state["waiting"])


def test_a_script_answers_a_request_in_a_later_step() -> None:
    with simkit.load(EMPTY) as sim:
        waiting: list[simkit.DeferredResponse] = []

        def handle(request: Any) -> simkit.DeferredResponse:
            waiting.append(simkit.DeferredResponse())
            return waiting[-1]

        sim.offer("/home", TRIGGER, handle)
        done: list[Any] = []
        call = sim.call("/home", on_done=done.append)
        sim.step(10)
        assert not call.is_done and not done
        waiting[0].respond({"success": True, "message": "at home"})
        sim.step()
        assert done == [call] and (call.response.success, call.response.message) == (True, "at home")
        waiting[0].respond({"message": "again"})
        sim.step()
        assert len(done) == 1 and call.response.message == "at home", "only the first response counts"


def test_a_response_may_be_there_before_the_handler_returns() -> None:
    with simkit.load(EMPTY) as sim:

        def handle(request: Any) -> simkit.DeferredResponse:
            response = simkit.DeferredResponse()
            response.respond({"message": "at once"})
            return response

        sim.offer("/home", TRIGGER, handle)
        assert sim.call("/home").message == "at once"


def test_a_call_that_does_not_wait_gets_an_error_for_a_later_response() -> None:
    with simkit.load(EMPTY, plugins=[Oven()]) as sim:
        with pytest.raises(ServiceError, match="answers in a later step") as error:
            sim.call("/bake")
        assert error.value.code == "SK-SERVICE-012"
        assert "on_done" in str(error.value)
        sim.step(10)
        assert sim.communication.services.get_state()[1] == (), "no call waits"


def test_a_service_may_fail_later() -> None:
    with simkit.load(EMPTY) as sim:
        response = simkit.DeferredResponse()
        sim.offer("/home", TRIGGER, lambda request: response)
        call = sim.call("/home", on_done=lambda call: None)
        sim.step()
        response.fail("the way is blocked")
        assert call.is_done and "the way is blocked" in str(call.error)


def test_a_later_response_is_checked_where_it_is_given() -> None:
    with simkit.load(EMPTY) as sim:
        response = simkit.DeferredResponse()
        sim.offer("/home", TRIGGER, lambda request: response)
        call = sim.call("/home", on_done=lambda call: None)
        sim.step()
        with pytest.raises(MessageError, match="did you mean 'message'"):
            response.respond({"mesage": "typo"})
        assert not call.is_done
        response.respond({"message": "right"})
        assert call.response.message == "right"


def test_the_caller_of_a_closed_service_gets_an_error() -> None:
    with simkit.load(EMPTY) as sim:
        response = simkit.DeferredResponse()
        service = sim.offer("/home", TRIGGER, lambda request: response)
        call = sim.call("/home", on_done=lambda call: None)
        sim.step()
        service.close()
        assert "was closed before it answered" in str(call.error)
        response.respond({})
        assert call.response is None


def test_a_restored_run_repeats_the_response_of_a_plugin() -> None:
    with simkit.load(EMPTY, plugins=[Oven()]) as sim:
        messages: list[tuple[int, str]] = []
        sim.call("/bake", on_done=lambda call: messages.append((sim.tick, call.response.message)))
        sim.step(3)
        before = sim.snapshot()
        sim.step(10)
        sim.restore(before)
        sim.step(10)
        assert len(messages) == 2 and messages[0] == messages[1]


def test_a_reset_undoes_a_request() -> None:
    with simkit.load(EMPTY) as sim:
        response = simkit.DeferredResponse()
        sim.offer("/home", TRIGGER, lambda request: response)
        done: list[Any] = []
        sim.call("/home", on_done=done.append)
        sim.step()
        sim.reset()
        response.respond({})
        sim.step()
        assert not done


def test_a_disabled_plugin_answers_its_requests_with_an_error() -> None:
    class Faulty(Oven):
        def after_step(self) -> None:
            if self.sim.tick == 3:
                raise ValueError("no dough")

    with simkit.load(EMPTY, plugins=[Faulty()], on_error="disable") as sim:
        call = sim.call("/bake", on_done=lambda call: None)
        sim.step(5)
        assert "no dough" in str(call.error)
