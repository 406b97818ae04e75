"""Functions that build an explanation."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from made_up import MACHINE, record

import simkit
from simkit.build import read_scene
from simkit.runtime.engine.snapshot import state_hash
from simkit.scene import SceneWorld
from simkit.testing.golden.cause import explanation
from simkit.testing.golden.cause.edits import find_changes
from simkit.testing.golden.cause.explanation import find_effective_changes
from simkit.testing.golden.cause.first_tick import distinct_digits, first_different_tick
from simkit.testing.golden.cause.world_patch import ABSENT, CannotPatch, files_named_by, patch_world
from simkit.testing.golden.compare.world_edits import model_edits
from simkit.testing.run_record.record import States
from simkit.testing.run_record.world_values import values_of_world


@pytest.mark.parametrize("name", ["turtlebot3_world", "sensor_bench", "simple_office_with_people"])
def test_a_world_can_be_made_of_its_leaves_alone(name: str) -> None:
    world = read_scene(name)[0].world
    leaves, _ = values_of_world(world)
    nothing = SceneWorld()
    empty, _ = values_of_world(nothing)
    made = patch_world(nothing, empty, {**dict.fromkeys(empty, ABSENT), **leaves}, files_named_by(world))
    assert values_of_world(made)[0] == leaves


def test_a_world_made_of_its_leaves_runs_to_the_same_bits() -> None:
    with simkit.load("turtlebot3_world") as sim:
        leaves, _ = values_of_world(sim.world)
        sim.run(0.2)
        wanted = state_hash(sim)
    radius = "models[turtlebot3].links[wheel_left_link].collisions[tread].geometry.radius"
    other = {radius: leaves[radius] * 1.01}
    with simkit.load("turtlebot3_world", change_world=lambda world: patch_world(world, leaves, other)) as sim:
        changed, _ = values_of_world(sim.world)
        assert {path for path in leaves if leaves[path] != changed[path]} == {radius}
        sim.run(0.2)
        assert state_hash(sim) != wanted

    def there_and_back(world: SceneWorld) -> SceneWorld:
        return patch_world(patch_world(world, leaves, other), changed, {radius: leaves[radius]})

    with simkit.load("turtlebot3_world", change_world=there_and_back) as sim:
        sim.run(0.2)
        assert state_hash(sim) == wanted


def test_the_content_of_a_missing_file_cannot_be_restored() -> None:
    world = read_scene("turtlebot3_world")[0].world
    leaves, _ = values_of_world(world)
    path = next(path for path in leaves if path.endswith("geometry.file"))
    with pytest.raises(CannotPatch):
        patch_world(world, leaves, {path: "0123456789abcdef (10 bytes)"})


@pytest.mark.parametrize(
    "path", ["gravity", "models[turtlebot3].pose_world", "models[turtlebot3].links[base_link].inertial.com"]
)
@pytest.mark.parametrize("value", [3.0, "down", [1.0], [], {"a": 1}, [["x"]]])
def test_manipulated_world_values_cause_no_traceback(path: str, value: object) -> None:
    world = read_scene("turtlebot3_world")[0].world
    leaves, _ = values_of_world(world)
    with suppress(CannotPatch):
        patch_world(world, leaves, {path: value})
    golden = {**leaves, path: value}
    changes = find_changes(model_edits(golden, leaves, {}), golden, leaves)
    assert [change.path for change in changes] == [path]


def test_invalid_world_values_cause_no_traceback() -> None:
    leaves, places = values_of_world(read_scene("turtlebot3_world")[0].world)
    odd = [None, "", [], "x", 3.0, [1.0, "a"], [[1.0]], True, {"a": [1]}, [0.0] * 7]
    for start in range(5):
        golden = {p: odd[n % len(odd)] if (n + start) % 5 == 0 else v for n, (p, v) in enumerate(leaves.items())}
        golden.update({"models[": 1.0, "]": 2.0, "models[a]": "x", "": 3.0, ".": 1.0, "links[[": [1.0]})
        assert find_changes(model_edits(golden, leaves, places), golden, leaves)


@pytest.mark.parametrize("needed", [{0}, {3}, {1, 6}, {2, 3, 4}, {0, 7}])
def test_effective_changes_are_found_in_few_runs(needed: set[int]) -> None:
    asked: set[frozenset[int]] = set()

    def same(back: frozenset[int]) -> bool:
        asked.add(back)
        return needed <= back

    found = find_effective_changes(range(8), same)
    assert set(found.needed) == needed
    assert set(found.idle) == set(range(8)) - needed
    assert len(asked) <= 2 + 2 * len(needed) * 4


def test_no_cause_is_named_if_undoing_all_changes_has_no_effect() -> None:
    found = find_effective_changes(range(3), lambda back: False)
    assert (found.needed, found.idle, found.all_back) == ([], [], False)


def states(marks: list[int], inputs: list[int], values: list[list[float]]) -> States:
    ticks = np.linspace(0, len(marks), len(values)).astype(np.int64)
    count = len(values[0])
    return States(
        0.01,
        np.array(marks, np.uint8),
        np.array(inputs, np.uint8),
        ticks,
        [f"q{i}" for i in range(count)],
        np.array(values),
        [],
        np.zeros((len(values), 0)),
        str(marks),
    )


def test_the_first_different_mark_gives_the_first_tick() -> None:
    a = states([1, 2, 3, 4], [0, 0, 0, 0], [[0.0, 1.0], [1.0, 1.0]])
    b = states([1, 2, 9, 9], [0, 0, 0, 0], [[0.0, 1.0], [1.0, 1.5]])
    found = first_different_tick(a, b)
    assert found is not None
    assert (found.tick, found.has_other_input, found.quantity) == (3, False, "q1 1 → 1.5 at t = 0.04 s")
    assert "all inputs are equal" in found.words


def test_a_different_input_is_listed_before_its_effects() -> None:
    a = states([1, 2, 3, 4], [0, 0, 0, 0], [[0.0], [1.0]])
    b = states([1, 2, 9, 9], [0, 0, 7, 7], [[0.0], [2.0]])
    found = first_different_tick(a, b)
    assert found is not None and found.has_other_input
    assert found.words.startswith("the inputs from plugins and commands differ first at tick 3 (t = 0.03 s)")


def test_different_initial_states_are_reported() -> None:
    a = states([1, 2], [0, 0], [[0.0], [1.0]])
    b = states([5, 6], [0, 0], [[0.5], [1.0]])
    found = first_different_tick(a, b)
    assert found is not None and found.tick == 0
    assert found.words == "the initial state differs: q0 0 → 0.5"


def test_equal_runs_have_no_first_different_tick() -> None:
    a = states([1, 2], [0, 0], [[0.0], [1.0]])
    assert first_different_tick(a, replace(a)) is None


@pytest.mark.parametrize(
    ("a", "b", "words"),
    [
        (0.033, 0.0333, "0.033 → 0.0333"),
        (30, 31, "30 → 31"),
        (1 / 3, 1 / 3 * 1.01, "0.33333 → 0.33667"),
        (1e-7, 1.2e-7, "1e-07 → 1.2e-07"),
        (0.1, 0.1 + 1e-13, "0.1 → 0.1000000000001"),
    ],
)
def test_numbers_have_enough_digits_to_differ(a: float, b: float, words: str) -> None:
    assert distinct_digits(a, b) == words


def test_a_run_on_another_processor_is_not_called_nondeterministic() -> None:
    here, there = {**MACHINE, "processor features": "AVX2"}, {**MACHINE, "processor features": "AVX512F"}
    same = explanation._no_cause(record(machine=here), record(machine=here))
    assert "the run is not deterministic" in same
    other = explanation._no_cause(record(machine=here), record(machine=there))
    assert "the processors differ (AVX2 → AVX512F)" in other and "not deterministic" not in other
    versions = explanation._no_cause(record(machine=here), record(machine={**there, "mujoco": "4.0.1"}))
    assert versions == "no input of the run changed; the versions or the machine differ"
