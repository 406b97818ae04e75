"""A pickled snapshot continues with the same bits in another simulation, for every plugin and sensor of simkit."""

from __future__ import annotations

import pickle
from pathlib import Path

import contract_worlds
import proof
import proof_worlds
import pytest
from test_proof_of_plugins import CLASSES
from test_proof_of_sensors import KINDS, thrown

import simkit

pytestmark = pytest.mark.slow  # slow: many worlds


def check_transfer(one: simkit.Simulation, other: simkit.Simulation, steps: int) -> None:
    runner, second = proof.Runner(one, steps), proof.Runner(other, steps)
    runner.run(1)
    if {
        "/play_motion2",
        "/navigate_to_pose",
    } & one.communication.actions.names().keys():  # a goal is being carried out: the snapshot says so
        with pytest.raises(TypeError, match="GoalHandle cannot be pickled"):
            pickle.dumps(one.snapshot())
        return
    content = pickle.dumps(one.snapshot())
    other.restore(pickle.loads(content))
    assert not proof.differences(runner.run(2), second.run(2))


@pytest.mark.parametrize("cls", CLASSES, ids=[cls.__name__ for cls in CLASSES])
def test_a_plugin_continues_in_another_simulation(cls: type, tmp_path: Path) -> None:
    with proof_worlds.open_world(cls.__name__, tmp_path) as one, proof_worlds.open_world(cls.__name__, tmp_path) as two:
        check_transfer(one, two, 60)


@pytest.mark.parametrize("kind", KINDS)
def test_a_sensor_continues_in_another_simulation(kind: str) -> None:
    world = contract_worlds.source(kind, noisy=True)
    with simkit.load(world, seed=5) as one, simkit.load(world, seed=5) as other:
        thrown(one)
        check_transfer(one, other, 90)
