"""Conditions under which two geoms have a contact, and the wrenches of contacts."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

from simkit.runtime.contact.collision_contacts import find_contacts


def two_balls(distance: float, **settings: str) -> tuple[Any, Any]:
    attributes = " ".join(f'{k}="{v}"' for k, v in settings.items())
    ball = f'<geom type="sphere" size="0.1" mass="1" {attributes}/>'
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option gravity="0 0 0"/><worldbody><body>{ball}<freejoint/></body>'
        f'<body pos="{distance} 0 0">{ball}<freejoint/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


EITHER = np.array([True, False, False])


def test_overlapping_balls_touch() -> None:
    found = find_contacts(*two_balls(0.19), EITHER)
    assert found is not None
    assert found.depths == pytest.approx([0.01])
    assert found.geoms.tolist() == [[0, 1]]
    np.testing.assert_allclose(found.frames[0, 0], (1, 0, 0), atol=1e-12)
    assert found.wrenches[0, 0] > 0


def test_a_nearby_ball_has_a_contact_only_if_a_force_acts_on_it() -> None:
    """Within the gap the engine lists a contact without a force; within the margin a force already acts."""
    model, data = two_balls(0.205, gap="0.01")
    assert data.ncon == 1
    assert find_contacts(model, data, EITHER) is None
    model, data = two_balls(0.205, margin="0.01")
    found = find_contacts(model, data, EITHER)
    assert found is not None and found.depths == pytest.approx([-0.005]) and found.wrenches[0, 0] > 0
    data.qvel[6] = 100.0  # the ball moves away: it is within the margin, but no force acts
    mujoco.mj_forward(model, data)
    assert data.ncon == 1
    assert find_contacts(model, data, EITHER) is None


def test_contacts_of_other_geoms_are_ignored() -> None:
    model, data = two_balls(0.19)
    assert find_contacts(model, data, np.zeros(3, bool)) is None


@pytest.mark.parametrize("cone", ["pyramidal", "elliptic"])
def test_contact_wrenches_match_the_accelerations_of_the_bodies(cone: str) -> None:
    model, data = two_balls(0.199, condim="6")
    model.opt.cone = getattr(mujoco.mjtCone, f"mjCONE_{cone.upper()}")
    data.qvel[:] = np.linspace(-0.3, 0.4, 12)
    mujoco.mj_forward(model, data)
    found = find_contacts(model, data, EITHER)
    assert found is not None
    force = found.frames[0].T @ found.wrenches[0, :3]
    torque = found.frames[0].T @ found.wrenches[0, 3:]
    turn = np.cross(found.positions[0] - data.xpos[2], force) + torque
    np.testing.assert_allclose(data.qfrc_constraint[6:9], force, atol=1e-9)
    np.testing.assert_allclose(data.xmat[2].reshape(3, 3) @ data.qfrc_constraint[9:12], turn, atol=1e-9)
