"""simkit.linear_algebra, matrix_decompositions and elementary_functions give NumPy's results, to rounding."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from simkit import elementary_functions as functions
from simkit import linear_algebra as algebra
from simkit import matrix_decompositions as decompositions

SHAPES = [((3, 3), (3,)), ((3,), (3, 3)), ((3, 3), (3, 3)), ((600, 3), (3, 3)), ((600, 3), (3, 5)), ((4,), (4,))]
STACKS = [((7, 3, 3), (7, 3, 3)), ((7, 3, 3), (3,)), ((5, 2, 4), (4, 3)), ((2, 3), (6, 3, 2)), ((3,), (5, 3, 2))]


def draw(*shape: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=shape)


@pytest.mark.parametrize("first, second", SHAPES + STACKS)
def test_a_product_has_the_shape_and_the_values_of_numpys(first: tuple[int, ...], second: tuple[int, ...]) -> None:
    a, b = draw(*first), draw(*second, seed=1)
    found = algebra.matmul(a, b)
    assert np.shape(found) == np.shape(a @ b)
    np.testing.assert_allclose(found, a @ b, rtol=0, atol=1e-14)


def test_several_factors_are_multiplied_from_left_to_right() -> None:
    a, b, c = draw(3, 4), draw(4, 2, seed=1), draw(2, seed=2)
    assert np.array_equal(algebra.matmul(a, b, c), algebra.matmul(algebra.matmul(a, b), c))


@pytest.mark.parametrize(
    "first, second", [((600, 3), (4, 3)), ((3, 3), (4,)), ((3,), (4, 2)), ((3, 3), (1,)), ((5, 3, 3), (1, 3))]
)
def test_factors_that_do_not_fit_are_an_error(first: tuple[int, ...], second: tuple[int, ...]) -> None:
    with pytest.raises(ValueError, match="cannot be multiplied"):
        algebra.matmul(draw(*first), draw(*second))


@pytest.mark.parametrize("size", [3, 40])
def test_vectors_of_different_lengths_have_no_product(size: int) -> None:
    with pytest.raises(ValueError, match=r"shorter|longer|cannot be multiplied"):
        algebra.dot(draw(size), draw(1))


@pytest.mark.parametrize("size", [1, 3, 16, 17, 1000])
def test_dot_and_norm_are_exact_to_rounding_at_every_length(size: int) -> None:
    a, b = draw(size), draw(size, seed=1)
    assert algebra.dot(a, b) == pytest.approx(float(a @ b), rel=1e-12, abs=1e-12)
    assert algebra.norm(a) == pytest.approx(float(np.linalg.norm(a)), rel=1e-14)


def test_a_squared_length_next_to_its_limit_is_that_of_the_fixed_order() -> None:
    vector = draw(40)
    limit = algebra.dot(vector, vector)
    assert algebra.squared_length(vector, limit) == limit
    assert algebra.squared_length(vector, 2.0 * limit) == pytest.approx(limit, rel=1e-12)
    assert algebra.squared_length(vector * np.inf, 1.0) == math.inf


def test_a_norm_that_overflows_is_infinite_without_a_warning() -> None:
    assert algebra.norm([1e200, 1e200, 0.0]) == math.inf


@pytest.mark.parametrize("size", [1, 2, 3, 6, 8, 9, 20])
def test_linear_systems_of_every_size_are_solved(size: int) -> None:
    a, b = draw(size, size), draw(size, 2, seed=1)
    np.testing.assert_allclose(a @ algebra.solve(a, b), b, rtol=0, atol=1e-11)
    np.testing.assert_allclose(algebra.solve(a, b[:, 0]), algebra.solve(a, b)[:, 0], rtol=1e-12)
    np.testing.assert_allclose(a @ algebra.inverse(a), np.eye(size), rtol=0, atol=1e-11)
    assert algebra.det(a) == pytest.approx(np.linalg.det(a), rel=1e-11)


def test_stacks_of_systems_are_solved_one_by_one() -> None:
    a, b = draw(5, 4, 4), draw(5, 4, 2, seed=1)
    np.testing.assert_allclose(algebra.solve(a, b), np.linalg.solve(a, b), rtol=1e-9)
    np.testing.assert_allclose(algebra.inverse(a), np.linalg.inv(a), rtol=1e-9)
    np.testing.assert_allclose(algebra.det(draw(6, 3, 3)), np.linalg.det(draw(6, 3, 3)), rtol=1e-12)


@pytest.mark.parametrize("matrix", [np.zeros((2, 2)), np.ones((3, 3)), np.zeros((12, 12)), np.zeros((4, 2, 2))])
def test_a_singular_matrix_is_an_error(matrix: np.ndarray) -> None:
    with pytest.raises(np.linalg.LinAlgError, match="Singular"):
        algebra.inverse(matrix)


@pytest.mark.parametrize("size", [1, 2, 3, 6])
def test_eigenvectors_are_orthogonal_and_ascending(size: int) -> None:
    half = draw(size, size)
    matrix = half + half.T
    values, axes = decompositions.eigh(matrix)
    np.testing.assert_allclose(values, np.linalg.eigvalsh(matrix), rtol=0, atol=1e-13)
    np.testing.assert_allclose(axes.T @ axes, np.eye(size), rtol=0, atol=1e-14)
    np.testing.assert_allclose(axes * values @ axes.T, matrix, rtol=0, atol=1e-13)
    assert (axes[np.abs(axes).argmax(axis=0), range(size)] > 0).all()


def test_equal_eigenvalues_and_stacks_have_eigenvectors_too() -> None:
    matrices = np.stack([np.eye(3), np.diag([3.0, 1.0, 2.0]), np.zeros((3, 3))])
    values, axes = decompositions.eigh(matrices)
    assert values.tolist() == [[1, 1, 1], [1, 2, 3], [0, 0, 0]]
    assert np.array_equal(axes[1], np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]))


def test_eigenvalues_of_tiny_inertias_keep_their_digits() -> None:
    matrix = np.array([[2e-12, 1e-13, 0], [1e-13, 3e-12, 1e-14], [0, 1e-14, 1.0]])
    np.testing.assert_allclose(decompositions.eigvalsh(matrix), [1.99009805e-12, 3.00990195e-12, 1.0], rtol=1e-6)


@pytest.mark.parametrize("shape", [(3, 7), (7, 3), (6, 6), (1, 4), (400, 4)])
def test_singular_values_and_least_squares_agree_with_numpys(shape: tuple[int, int]) -> None:
    matrix, right = draw(*shape), draw(shape[0], seed=1)
    u, s, vt = decompositions.svd(matrix)
    np.testing.assert_allclose(u * s @ vt, matrix, rtol=0, atol=1e-13)
    np.testing.assert_allclose(s, np.linalg.svd(matrix)[1], rtol=1e-13)
    np.testing.assert_allclose(decompositions.pinv(matrix), np.linalg.pinv(matrix), rtol=0, atol=1e-12)
    np.testing.assert_allclose(
        decompositions.lstsq(matrix, right), np.linalg.lstsq(matrix, right, rcond=None)[0], rtol=0, atol=1e-12
    )


def test_least_squares_of_a_rank_deficient_matrix_is_the_shortest_solution() -> None:
    matrix = np.outer(draw(5), draw(3, seed=1))
    found = decompositions.lstsq(matrix, np.ones(5))
    np.testing.assert_allclose(found, np.linalg.lstsq(matrix, np.ones(5), rcond=None)[0], rtol=0, atol=1e-13)
    u, _, _ = decompositions.svd(matrix)
    np.testing.assert_allclose(u.T @ u, np.eye(3), rtol=0, atol=1e-14)


def test_the_cholesky_factor_is_that_of_numpy() -> None:
    half = draw(5, 5)
    matrix = half @ half.T + np.eye(5)
    np.testing.assert_allclose(decompositions.cholesky(matrix), np.linalg.cholesky(matrix), rtol=1e-12, atol=1e-14)
    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        decompositions.cholesky(-matrix)


@pytest.mark.parametrize("name", ["exp", "expm1", "tan", "arctan", "sinh"])
def test_functions_of_arrays_are_those_of_math_for_every_number(name: str) -> None:
    values = draw(3, 4)
    reference = getattr(math, {"arctan": "atan"}.get(name, name))
    found = getattr(functions, name)(values)
    assert found.shape == (3, 4)
    assert found.ravel().tolist() == [reference(x) for x in values.ravel().tolist()]
    assert getattr(functions, name)(0.25) == reference(0.25)


def test_functions_at_the_ends_of_their_range_give_infinity_or_nan_without_an_error() -> None:
    assert functions.exp([1000.0, -1000.0]).tolist() == [math.inf, 0.0]
    assert functions.log([0.0, 1.0]).tolist() == [-math.inf, 0.0]
    assert functions.log10([0.0, 100.0]).tolist() == [-math.inf, 2.0] and np.isnan(functions.log2(-1.0))
    assert np.isnan(functions.log(-1.0)) and np.isnan(functions.arcsin(1.5)) and np.isnan(functions.arccos(-1.5))
    assert functions.power([-2.0, 0.0, 1e300], [3.0, -1.0, 2.0]).tolist() == [-8.0, math.inf, math.inf]
    assert np.isnan(functions.power(-2.0, 0.5)) and np.isnan(functions.tan([math.inf])).all()
    assert functions.sinh([1e4, -1e4]).tolist() == [math.inf, -math.inf] and functions.expm1(1e4) == math.inf


def test_arctan2_broadcasts_as_numpys() -> None:
    y, x = draw(4, 1), draw(3, seed=1)
    np.testing.assert_allclose(functions.arctan2(y, x), np.arctan2(y, x), rtol=1e-15)


@pytest.mark.parametrize("value", [-np.inf, -1e308, -1000.0, -1.0, -0.0, 0.0, 1.0, 1000.0, 1e308, np.inf, np.nan])
@pytest.mark.parametrize("name", ["exp", "expm1", "log", "log2", "log10", "tan", "arcsin", "arccos", "arctan", "sinh"])
def test_functions_of_extreme_numbers_are_infinite_or_nan_like_numpys_and_never_errors(name: str, value: float) -> None:
    with np.errstate(all="ignore"):
        np.testing.assert_allclose(getattr(functions, name)(value), getattr(np, name)(value), rtol=1e-14)


@pytest.mark.parametrize("exponent", [-3.0, -2.0, -0.5])
@pytest.mark.parametrize("base", [0.0, -0.0])
def test_a_negative_power_of_zero_is_infinite_with_the_sign_of_an_odd_one(base: float, exponent: float) -> None:
    with np.errstate(all="ignore"):
        assert functions.power(base, exponent) == np.power(base, exponent)


@pytest.mark.parametrize("scale", [1e-300, 1e-200, 1e-155, 1e100, 1e200])
@pytest.mark.parametrize("shape", [(1, 1), (4, 2), (3, 3), (2, 4)])
def test_decompositions_do_not_overflow_or_underflow(shape: tuple[int, int], scale: float) -> None:
    matrix, right = draw(*shape), draw(shape[0], seed=1)
    u, s, vt = decompositions.svd(matrix * scale)
    np.testing.assert_allclose((u * (s / scale)) @ vt, matrix, rtol=0, atol=1e-14)
    np.testing.assert_allclose(decompositions.pinv(matrix * scale) * scale, np.linalg.pinv(matrix), rtol=1e-11)
    found, expected = decompositions.lstsq(matrix * scale, right), np.linalg.lstsq(matrix, right)[0]
    np.testing.assert_allclose(found * scale, expected, rtol=1e-11)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_empty_matrices_have_numpys_shapes(count: int) -> None:
    none = np.zeros((0, 0))
    assert algebra.solve(none, np.zeros((0, count))).shape == (0, count)
    assert algebra.inverse(none).shape == decompositions.cholesky(none).shape == (0, 0)
    for empty in (np.zeros((0, count)), np.zeros((count, 0)), np.zeros((0, 3, count)), np.zeros((2, 0, count))):
        ours, numpys = decompositions.svd(empty), np.linalg.svd(empty, full_matrices=False)
        assert [part.shape for part in ours] == [part.shape for part in numpys]
    assert np.array_equal(decompositions.lstsq(np.zeros((0, count)), np.zeros(0)), np.zeros(count))


@pytest.mark.parametrize("number", [np.nan, np.inf])
@pytest.mark.parametrize("function", [decompositions.svd, decompositions.pinv, decompositions.eigh])
def test_numbers_that_are_not_finite_have_no_decomposition(function: Any, number: float) -> None:
    with pytest.raises(np.linalg.LinAlgError):
        function([[1.0, number], [number, 1.0]])


@pytest.mark.parametrize("kind", [bool, np.uint8, np.int8])
def test_a_long_scalar_product_of_integers_does_not_wrap(kind: type) -> None:
    many = np.full(100, 100).astype(kind)
    assert algebra.dot(many, many) == algebra.norm(many) ** 2 == 100.0 * float(many[0]) ** 2


def test_the_determinant_of_tiny_numbers_keeps_its_sign() -> None:
    assert algebra.det(np.diag([-1e-200, 1e-200])) < 0.0 < algebra.det(np.diag([1e-200, 1e-200]))


def test_eigenvalues_of_the_largest_numbers_do_not_overflow() -> None:
    matrix = np.array([[3.0, 1.0, 0.0], [1.0, -4.0, 2.0], [0.0, 2.0, 1.0]])
    values, axes = decompositions.eigh(matrix * 3e307)
    np.testing.assert_allclose(values / 3e307, np.linalg.eigvalsh(matrix), rtol=1e-13)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-14)
    assert np.isinf(decompositions.svd(np.full((2, 2), 1.7e308))[1][0])
