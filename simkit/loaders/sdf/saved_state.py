"""`<state>` of a world: poses that Gazebo Classic saved when the user saved the running world.

The saved poses of models and links are in the world frame. Poses of models and lights are applied, and those of links
in models without joints. A pose that needs another joint position is reported and not applied.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

from simkit.diagnostics import did_you_mean
from simkit.linear_algebra import matmul
from simkit.loaders.sdf.frames import Frame, world_pose
from simkit.loaders.sdf.load_context import ModelDraft
from simkit.params import Params
from simkit.pose import Pose

_CODE = "SK-SDF-034"
_SAME_POSE = 1e-3  # [m] and [rad]; saved numbers have six digits, and bodies at rest have settled slightly
_UNAPPLIED = ("velocity", "acceleration", "wrench")


def saved_states(world: Params, name: str) -> list[Params]:
    """Return the states of this world; a state of another world is reported."""
    states = []
    for state in world.all("state"):
        world_name = state.attribute("world_name").strip()
        for clock in ("sim_time", "wall_time", "real_time", "iterations"):
            state.child(clock)
        if world_name in ("", name):
            states.append(state)
            continue
        state.mark_all_read()
        message = f"the saved state of world {world_name!r} is not applied to {name!r}"
        state.warning(_CODE, message, did_you_mean(world_name, (name,)))
    return states


def _all_saved(block: Params, kind: str) -> list[Params]:
    """Return the entities of a kind in a block, written as `<model>` or as `<model_state>`."""
    return [*block.all(kind), *block.all(f"{kind}_state")]


def deleted_names(states: Iterable[Params]) -> set[str]:
    """Return the names of models and lights that had been deleted when the state was saved."""
    return {name.value for state in states for gone in state.all("deletions") for name in gone.all("name")}


def inserted_blocks(states: Iterable[Params]) -> list[Params]:
    """Return the blocks with models and lights that had been inserted."""
    return [block for state in states for block in state.all("insertions")]


def saved_light_poses(states: Iterable[Params]) -> dict[str, Pose]:
    """Return the poses of lights in the world by name."""
    return {
        light.attribute("name"): light.pose("pose")
        for state in states
        for light in _all_saved(state, "light")
        if light.has("pose")
    }


def apply_saved_poses(states: Iterable[Params], drafts: Iterable[ModelDraft]) -> None:
    """Move models to their saved poses, before any pose is resolved."""
    known = {draft.source.name: draft for draft in drafts}
    for state in states:
        for saved in _all_saved(state, "model"):
            _apply_saved_pose(saved, known, Pose())
        for joint in state.all("joint_state"):
            joint.mark_all_read()
            joint.warning(_CODE, "the saved position of a joint is not applied")


def _apply_saved_pose(saved: Params, known: dict[str, ModelDraft], outer: Pose) -> None:
    name = saved.attribute("name").strip()
    draft = known.get(name)
    if draft is None:
        message = f"the saved state has model {name!r}, which is not in the file"
        saved.warning(_CODE, message, did_you_mean(name, known))
        saved.mark_all_read()
        return
    here = saved.pose("pose")
    if saved.has("pose"):
        draft.frame.pose, draft.frame.relative_to, draft.frame.placement = outer.inverse() @ here, "", ""
    else:
        here = outer @ draft.frame.pose
    scale = saved.vector3("scale", (1.0, 1.0, 1.0))
    if any(abs(s - 1) > 1e-9 for s in scale):
        saved.warning(_CODE, f"the saved scale of model {name!r} is not applied")
    draft.saved_links += _all_saved(saved, "link")
    if not draft.joints and not draft.merged:
        for link, part in _match_elements(draft):
            if link.has("pose"):
                part.pose, part.relative_to = here.inverse() @ link.pose("pose"), ""
    for joint in _all_saved(saved, "joint"):
        joint.mark_all_read()
    saved.child("frame")
    inside = {nested.source.name: nested for nested in draft.models}
    for nested in _all_saved(saved, "model"):
        _apply_saved_pose(nested, inside, here)


def _match_elements(draft: ModelDraft) -> list[tuple[Params, Frame]]:
    frames = {part.name: part.frame for part in draft.links}
    return [(link, frames[n]) for link in draft.saved_links if (n := link.attribute("name")) in frames]


def report_unapplied(draft: ModelDraft) -> None:
    """Report the parts of a placed model's saved state that are not applied: joint positions and velocities."""
    matched, owner = _match_elements(draft), f"model {draft.scoped!r}"
    moved = [e for e, frame in matched if e.has("pose") and _is_different(e.pose("pose"), world_pose(frame))]
    if moved:
        names = ", ".join(link.attribute("name") for link in moved[:5])
        message = f"{owner}: the saved poses of {names} need other joint positions; all joints start at zero"
        moved[0].warning(_CODE, message)
    moving = [link for link, _ in matched if _has_motion(link)]
    if moving:
        moving[0].warning(_CODE, f"{owner}: saved velocities are not applied; the model starts at rest")
    for nested in draft.models:
        report_unapplied(nested)


def _is_different(a: Pose, b: Pose) -> bool:
    cosine = min(1.0, abs(float(matmul(a.quaternion, b.quaternion))))
    return math.dist(a.position, b.position) > _SAME_POSE or 2 * math.acos(cosine) > _SAME_POSE


def _has_motion(link: Params) -> bool:
    for name in _UNAPPLIED:
        link.child(name)
    for collision in _all_saved(link, "collision"):
        collision.mark_all_read()
    return any(abs(v) > 1e-3 for v in link.vector("velocity", 6, (0.0,) * 6))
