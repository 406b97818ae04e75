"""Geoms of the world body are added in blocks: the compiled model is equal as without blocks."""

from __future__ import annotations

import numpy as np
import pytest

from simkit.compiler import SpecBuilder, geoms
from simkit.diagnostics import Diagnostics
from simkit.pose import Pose
from simkit.scene import Box, Sphere


@pytest.fixture
def world(make, monkeypatch):
    """Return the world of 7 static models with 3 geoms each and one moving model between them."""

    def build(direct, block):
        monkeypatch.setattr(geoms, "DIRECT", direct)
        monkeypatch.setattr(geoms, "BLOCK", block)
        models = []
        for k in range(7):
            links = [
                make.link(f"s{k}::l{i}", Box((0.1, 0.2, 0.3)), Pose.from_rpy(k, i, 0, 0.1 * i, 0, k)) for i in range(3)
            ]
            models.append(make.model(f"s{k}", *links, static=True))
        return SpecBuilder(
            make.world(*models[:4], make.solid("ball", Sphere(0.1), Pose((0, 0, 2))), *models[4:]), Diagnostics()
        )

    return build


def assert_equal(one, other):
    """Compare all numbers and names of two models. A frame writes 0 for -0, which is an equal number."""
    assert one.names == other.names
    arrays = [name for name in dir(one) if isinstance(getattr(one, name), np.ndarray)]
    assert len(arrays) > 300
    for name in arrays:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), name)


@pytest.mark.parametrize("block", [1, 5, 100])
def test_a_world_in_blocks_compiles_to_the_same_model(world, block):
    plain, blocks = world(1000, 1), world(2, block)
    assert_equal(plain.compile().model, blocks.compile().model)
    assert (len(plain.spec.frames), len(blocks.spec.frames)) == (
        0,
        2 * -(-19 // block),
    )  # each attachment adds one more


def test_models_in_blocks_are_removed_added_and_copied(world):
    plain, blocks = world(1000, 1), world(2, 5)
    for builder in (plain, blocks):
        scene = builder.records["s3"].scene
        builder.remove_model("s3")
        builder.remove_model("s5")
        builder.add_model(scene)
    assert_equal(plain.compile().model, blocks.compile().model)
    copy = blocks.copy()
    copy.remove_model("s3")  # its geoms fill whole blocks
    assert (copy.compile().model.ngeom, blocks.compile().model.ngeom) == (16, 19)


def test_a_block_of_one_model_is_removed_as_one_frame(world):
    builder = world(0, 3)
    assert len(builder.spec.frames) == 14  # each attachment adds one more
    builder.remove_model("s2")
    assert len(builder.spec.frames) == 12
    assert builder.compile().model.ngeom == 19
