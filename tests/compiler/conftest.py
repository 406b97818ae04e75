"""Small scenes made of dataclasses, and what the tests do with them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from simkit.compiler import Compiled, SpecBuilder
from simkit.diagnostics import Diagnostics
from simkit.pose import IDENTITY, Pose
from simkit.scene import (
    Geometry,
    Inertial,
    Physics,
    Plane,
    SceneCollision,
    SceneJoint,
    SceneLink,
    SceneModel,
    SceneWorld,
    Surface,
)


@pytest.fixture(autouse=True)
def own_mesh_cache(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Every test converts its own meshes."""
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("SIMKIT_CACHE_DIR", str(folder))
    return folder


PLAIN = Surface()


class Make:
    """Builders of small scenes."""

    @staticmethod
    def link(
        scoped: str,
        shape: Geometry | None = None,
        pose: Pose = IDENTITY,
        surface: Surface = PLAIN,
        mass: float = 1.0,
        inertia: float = 0.01,
        shape_pose: Pose = IDENTITY,
        **more: Any,
    ) -> SceneLink:
        collisions = (SceneCollision("c", f"{scoped}::c", shape_pose, shape, surface),) if shape is not None else ()
        inertial = more.pop("inertial", Inertial(mass, (0.0, 0.0, 0.0), (inertia, inertia, inertia, 0.0, 0.0, 0.0)))
        name = scoped.rpartition("::")[2]
        return SceneLink(name, scoped, pose, inertial=inertial, collisions=collisions, **more)

    @staticmethod
    def model(name: str, *links: SceneLink, joints: tuple[SceneJoint, ...] = (), **more: Any) -> SceneModel:
        pose = links[0].pose_world if links else IDENTITY
        canonical = links[0].scoped if links else ""
        return SceneModel(name, name, pose, links=links, joints=joints, canonical_link=canonical, **more)

    @classmethod
    def solid(cls, name: str, shape: Geometry, pose: Pose = IDENTITY, **more: Any) -> SceneModel:
        """A model of one free link with one shape."""
        return cls.model(name, cls.link(f"{name}::link", shape, pose, **more))

    @classmethod
    def ground(cls, mu: float = 1.0, normal: tuple[float, float, float] = (0.0, 0.0, 1.0), **more: Any) -> SceneModel:
        link = cls.link("ground::link", Plane(normal=normal), surface=Surface(mu=mu, mu2=mu, **more))
        return cls.model("ground", link, static=True)

    @staticmethod
    def world(*models: SceneModel, step: float = 0.001, engine: str | None = None, **more: Any) -> SceneWorld:
        return SceneWorld(models=models, physics=Physics(max_step_size=step, engine=engine), **more)


@pytest.fixture
def make() -> type[Make]:
    return Make


Compile = Callable[..., Compiled]


@pytest.fixture
def compiled() -> Compile:
    """Compiles a world made of models; keeps the diagnostics on the builder."""

    def run(*models: SceneModel, **more: Any) -> Compiled:
        return SpecBuilder(Make.world(*models, **more), Diagnostics()).compile()

    return run
