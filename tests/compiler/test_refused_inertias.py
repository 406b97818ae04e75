"""Inertias that no body has: what is kept, what is repaired, what is said, and where the line is."""

from __future__ import annotations

import numpy as np
import pytest

from simkit.compiler.refused_inertias import inertia_matrix, plan_inertials, repair_inertia, rigid_sum
from simkit.diagnostics import Diagnostics, Where
from simkit.pose import Pose
from simkit.scene import Inertial, SceneLink


def inertial(a: float, b: float, c: float, mass: float = 1.0, turn: Pose | None = None) -> Inertial:
    tensor = np.diag((a, b, c))
    if turn is not None:
        tensor = turn.matrix @ tensor @ turn.matrix.T
    t = tensor
    return Inertial(mass, (0.1, 0.0, 0.0), (t[0, 0], t[1, 1], t[2, 2], t[0, 1], t[0, 2], t[1, 2]))


def link(name: str, properties: Inertial, pose: Pose | None = None) -> SceneLink:
    return SceneLink(name, f"m::{name}", pose or Pose(), properties, where=Where("m.sdf", 7))


TURNED = Pose.from_rpy(0, 0, 0, 0.3, -0.7, 1.1)


@pytest.mark.parametrize("moments", [(1, 1, 1), (0.1, 0.2, 0.25), (1e-9, 1e-9, 1e-9)])
def test_what_a_body_can_have_stays_the_same_object(moments: tuple[float, float, float]) -> None:
    given = inertial(*moments, turn=TURNED)
    found = repair_inertia(given)
    assert found.inertial is given
    assert found.verdict == "sound"
    assert found.why == ""


def test_a_plate_on_the_edge_of_the_inequality_is_moved_by_rounding_only() -> None:
    given = inertial(1, 1, 2, turn=TURNED)
    found = repair_inertia(given)
    assert found.verdict == "sound"
    assert np.allclose(found.inertial.inertia, given.inertia, rtol=0, atol=1e-11)
    assert found.new[0] + found.new[1] >= found.new[2]


def test_the_nearest_tensor_moves_each_moment_by_a_third_of_what_is_missing() -> None:
    found = repair_inertia(inertial(1.0, 2.0, 3.3, turn=TURNED))
    assert found.verdict == "unbalanced"
    assert found.new == pytest.approx((1.1, 2.1, 3.2), abs=1e-9)
    assert found.lack == pytest.approx(0.3 / 3.3)
    assert "9.09 % of C" in found.why
    assert np.linalg.eigvalsh(inertia_matrix(found.inertial.inertia)) == pytest.approx((1.1, 2.1, 3.2), abs=1e-9)


def test_zero_moments_become_those_of_a_small_body_and_the_largest_stays() -> None:
    found = repair_inertia(inertial(0, 0, 0.1, mass=10))
    assert found.verdict == "mended"
    assert found.new == pytest.approx((0.05, 0.05, 0.1))
    assert repair_inertia(inertial(0, 0, 0, mass=2)).new == pytest.approx((2e-8, 2e-8, 2e-8))


@pytest.mark.parametrize(("smallest", "verdict"), [(-0.0009, "mended"), (-0.0011, "beyond"), (-1.0, "beyond")])
def test_a_negative_moment_is_mended_up_to_one_percent_of_the_largest(smallest: float, verdict: str) -> None:
    assert repair_inertia(inertial(smallest, 0.1, 0.1)).verdict == verdict


def test_a_link_that_is_fixed_to_another_hands_over_what_it_cannot_have() -> None:
    """TIAGo's antennas: a negative moment of 1e-8 on a base of 0.5."""
    base = link("base", inertial(0.5, 0.6, 0.7, mass=28))
    antenna = link("antenna", inertial(-3.5e-8, 3.5e-8, 9e-8, 1e-6, TURNED), Pose.from_rpy(0.2, 0, 0.3, 0.5, 0, 0))
    diagnostics = Diagnostics()
    written = plan_inertials([base, antenna], {"m::antenna": "m::base"}, frozenset(), diagnostics)
    assert not list(diagnostics)
    assert written["m::antenna"].inertia == (0,) * 6
    assert written["m::antenna"].mass == 1e-6
    assert written["m::base"].exact is None
    changed = [
        link("base", Inertial(28, base.inertial.com, written["m::base"].inertia)),
        link("antenna", Inertial(1e-6, antenna.inertial.com, (0,) * 6), antenna.pose_world),
    ]
    assert rigid_sum(changed)[1] == pytest.approx(rigid_sum([base, antenna])[1], abs=1e-15)


def test_a_moving_link_that_breaks_the_inequality_is_simulated_as_written_and_said() -> None:
    finger = link("finger", inertial(1.817e-05, 2.226e-4, 2.443e-4, 0.11))
    diagnostics = Diagnostics()
    written = plan_inertials([finger], {}, frozenset(), diagnostics)["m::finger"]
    assert written.exact == finger.inertial.inertia
    assert min(np.linalg.eigvalsh(inertia_matrix(written.inertia))) > 0
    (said,) = diagnostics
    assert (said.code, said.severity, said.file, said.line) == ("SK-INERTIA-001", "warning", "m.sdf", 7)
    for part in ("m::finger", "1.817e-05", "0.0002226", "0.0002443", "1.44 % of C"):
        assert part in said.message


def test_rounding_is_a_note() -> None:
    diagnostics = Diagnostics()
    plan_inertials([link("arm", inertial(1, 1, 2.01))], {}, frozenset(), diagnostics)
    assert [d.severity for d in diagnostics] == ["note"]


def test_beyond_the_bound_is_an_error_with_the_moments_and_a_cause() -> None:
    diagnostics = Diagnostics()
    wrong = Inertial(3.0, (0, 0, 0), (0.01, 0.01, 0.01, 0.05, 0.0, 0.0))
    plan_inertials([link("arm", wrong)], {}, frozenset(), diagnostics)
    (said,) = diagnostics
    assert (said.code, said.severity) == ("SK-INERTIA-002", "error")
    assert "(-0.04, 0.01, 0.06)" in said.message
    assert "products of inertia" in said.message


def test_nothing_is_said_of_what_never_moves() -> None:
    diagnostics = Diagnostics()
    written = plan_inertials([link("base", inertial(-1, 1, 1))], {}, frozenset({"m::base"}), diagnostics)
    assert not list(diagnostics)
    assert repair_inertia(Inertial(1.0, (0, 0, 0), written["m::base"].inertia)).verdict == "sound"


def test_a_number_that_is_none_is_an_error() -> None:
    diagnostics = Diagnostics()
    plan_inertials([link("arm", inertial(float("nan"), 1, 1))], {}, frozenset(), diagnostics)
    assert [d.code for d in diagnostics] == ["SK-PHYS-018"]
