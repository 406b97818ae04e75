"""Parameters of a sweep: spaces, and the designs made of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy import stats

from simkit_learning.sweeps.design import Design
from simkit_learning.sweeps.parameter_space import InvalidSpace, parameter_space


def sample(description: Any, names: Any = "x", count: int = 4000) -> np.ndarray[Any, Any]:
    design = Design((parameter_space(names, description),), (0,), count)
    return np.array([list(design.row(run).values.values()) for run in range(design.count)])


@pytest.mark.parametrize(
    ("description", "distribution"),
    [
        ({"uniform": [-1, 3]}, stats.uniform(-1, 4)),
        ({"normal": [2, 0.5]}, stats.norm(2, 0.5)),
        ({"normal": [0, 1], "limits": [-0.5, 2]}, stats.truncnorm(-0.5, 2)),
        ({"log_uniform": [0.001, 10]}, stats.loguniform(0.001, 10)),
        (stats.gamma(2.0), stats.gamma(2.0)),
    ],
)
def test_samples_have_their_distribution(description: Any, distribution: Any) -> None:
    assert stats.kstest(sample(description)[:, 0], distribution.cdf).pvalue > 0.001


def test_choices_and_integers_have_their_weights() -> None:
    chosen = sample({"choice": ["a", "b", "c"], "weights": [1, 0, 3]})[:, 0]
    assert set(chosen) == {"a", "c"} and np.mean(chosen == "c") == pytest.approx(0.75, abs=0.03)
    whole = sample({"integers": [-1, 2]})[:, 0]
    assert set(whole) == {-1, 0, 1, 2} and np.mean(whole == 2) == pytest.approx(0.25, abs=0.03)


def test_correlated_parameters_have_their_correlation() -> None:
    found = sample({"normal": [[1, 2], [0.1, 3]], "correlation": [[1, -0.8], [-0.8, 1]]}, ("a", "b"))
    assert np.corrcoef(found.T)[0, 1] == pytest.approx(-0.8, abs=0.03)
    assert found.mean(axis=0) == pytest.approx([1, 2], abs=0.15) and found.std(axis=0) == pytest.approx([0.1, 3], 0.05)


@pytest.mark.parametrize(
    ("description", "message"),
    [
        ({"unifrm": [0, 1]}, "did you mean 'uniform'"),
        ({"uniform": [1, 0]}, "smaller than the upper bound"),
        ({"uniform": [0, float("nan")]}, "expected two numbers"),
        ({"uniform": [0, 1], "limits": [0, 1]}, "has no key 'limits'"),
        ({"log_uniform": [0, 1]}, "above 0"),
        ({"normal": [0, 0]}, "positive"),
        ({"normal": [0, 1], "limits": [50, 60]}, "almost no part"),
        ({"choice": []}, "list of values"),
        ({"choice": [1, 2], "weights": [1]}, "2 weights"),
        ({"integers": [0, 1.5]}, "whole numbers"),
        ([], "empty"),
        ([None], "expected a number"),
    ],
)
def test_a_wrong_space_is_explained(description: Any, message: str) -> None:
    with pytest.raises(InvalidSpace, match=message):
        parameter_space("x", description)


def test_grids_are_combined_with_samples_and_seeds() -> None:
    spaces = (parameter_space("a", [1, 2]), parameter_space("b", {"uniform": [0, 1]}), parameter_space("c", ["x", "y"]))
    design = Design(spaces, (5, 6), 3)
    rows = list(design.rows(range(design.count)))
    assert design.count == 3 * 2 * 2 * 2 and [row.run for row in rows] == list(range(24))
    assert [list(row.values) for row in rows[:1]] == [["a", "b", "c"]]
    assert len({(row.values["a"], row.values["b"], row.values["c"], row.seed) for row in rows}) == 24
    assert len({row.values["b"] for row in rows}) == 3


def test_each_seed_has_its_own_sample_without_a_number_of_samples() -> None:
    design = Design((parameter_space("a", {"uniform": [0, 1]}),), range(4))
    rows = list(design.rows(range(design.count)))
    assert [row.seed for row in rows] == [0, 1, 2, 3] and len({row.values["a"] for row in rows}) == 4


@pytest.mark.parametrize("sampling", ["sobol", "latin_hypercube"])
def test_low_discrepancy_designs_fill_every_part_of_a_range_once(sampling: Any) -> None:
    spaces = (parameter_space("a", {"uniform": [0, 1]}), parameter_space("b", {"uniform": [0, 1]}))
    design = Design(spaces, (0,), 2048, sampling)
    values = np.array([list(design.row(run).values.values()) for run in range(2048)])
    for column in values.T:
        assert sorted((column * 2048).astype(int)) == list(range(2048))


def test_a_saltelli_design_changes_one_parameter_at_a_time() -> None:
    spaces = tuple(parameter_space(name, {"uniform": [0, 1]}) for name in "abc")
    design = Design(spaces, (0,), 4, "saltelli")
    a, b, *mixed = np.array([list(design.row(run).values.values()) for run in range(design.count)]).reshape(5, 4, 3)
    assert design.count == 20
    for number, matrix in enumerate(mixed):
        assert (matrix[:, number] == b[:, number]).all()
        assert (np.delete(matrix, number, 1) == np.delete(a, number, 1)).all()
