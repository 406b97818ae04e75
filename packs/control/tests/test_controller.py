"""Base class of controllers: live parameters, state, and endpoints that stay open."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from control_robots import opened, reported_messages

import simkit
from simkit import Params
from simkit.errors import ParameterError
from simkit_control.plugins.ros2_control.controller import Controller


class Tuned(Controller):
    extra: Any
    lock: Any

    def configure(self) -> None:
        self.gain = self.declare("gains.elbow.p", 1.0, minimum=0.0, description="effort per error [N·m/rad]")
        self.heard: list[float] = []
        self.listen("~/in", "std_msgs/msg/Float64", lambda message: self.heard.append(message.data))

    def update(self, now_ns: int, period: float) -> None:
        """Nothing."""


def tuned(sim: simkit.Simulation, values: dict[str, Any] | None = None) -> Tuned:
    host = next(p for p in sim.engine.structure.all_plugins() if hasattr(p, "manager"))
    made = Tuned("tuned", host, Params.from_dict(values or {}, "tuned"), host.hardware)
    made.configure()
    return made


def test_a_live_parameter_starts_with_the_files_value_and_belongs_to_the_controllers_node(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        made = tuned(sim, {"gains": {"elbow": {"p": 3.0}}})
        assert made.gain.value == 3.0
        assert sim.communication.parameters["/tuned"]["gains.elbow.p"].value == 3.0
        sim.set_parameter("/tuned", "gains.elbow.p", 4.0)
        assert made.gain.value == 4.0
        with pytest.raises(ParameterError, match="at least 0"):
            sim.set_parameter("/tuned", "gains.elbow.p", -1.0)
        assert "/tuned/set_parameters" in sim.communication.services.names()


def test_the_attributes_of_a_controller_are_its_state(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        made = tuned(sim)
        made.heard.append(1.0)
        kept = made.get_state()
        made.heard.append(2.0)
        made.extra = 3
        made.set_state(kept)
        assert made.heard == [1.0]
        assert not hasattr(made, "extra")


def test_an_attribute_that_cannot_be_copied_is_reported_once_and_not_changed(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        made = tuned(sim)
        made.lock = threading.Lock()
        lock, kept = made.lock, made.get_state()
        made.get_state()
        made.set_state(kept)
        assert made.lock is lock
        assert len(reported_messages(sim, "SK-PLUGIN-006")) == 1


def test_an_endpoint_opened_again_is_the_same_and_calls_the_newer_controller(tmp_path: Path) -> None:
    with opened(tmp_path) as sim:
        first = tuned(sim)
        second = tuned(sim)
        second.endpoints = first.endpoints
        second.configure()
        sim.publish("/tuned/in", simkit.msgs.make("std_msgs/msg/Float64", data=5.0))
        sim.run(0.01)
        assert first.heard == []
        assert 5.0 in second.heard
