"""`<physics>` of a world, and gravity."""

from __future__ import annotations

from simkit.diagnostics import Diagnostics
from simkit.params import Params
from simkit.scene import Physics
from simkit.scene.geometry import Vec3
from simkit.scene.world import CONTACT_LAWS

_GRAVITY: Vec3 = (0.0, 0.0, -9.8)
_SHORTEST = 1e-9  # seconds of one step
_LONGEST = 100.0  # seconds of one step; nobody means more


def read_physics(world: Params, diagnostics: Diagnostics) -> tuple[Physics, Vec3]:
    """The default physics profile, and gravity [m/s²] from the world or (before 1.6) from that profile."""
    profiles = world.all("physics")
    chosen = next((p for p in profiles if p.attribute("default", "false").lower() in ("true", "1")), None)
    if chosen is None and profiles:
        chosen = profiles[0]
    for other in profiles:
        name = other.attribute("name")
        if other is not chosen:
            other.mark_all_read()
            message = f"physics profile {name!r} is not the default and not used"
            diagnostics.note("SK-SDF-023", message, other.where)
    block = chosen or Params("physics", where=world.where, diagnostics=diagnostics)
    inside = block.vector3("gravity", _GRAVITY)
    gravity = world.vector3("gravity", inside)
    step = block.number("max_step_size", _old_step(block), maximum=_LONGEST)
    if step < _SHORTEST:
        allowed = "it must be positive" if step <= 0 else f"time is counted in nanoseconds: at least {_SHORTEST:g} s"
        diagnostics.error("SK-PARAM-002", f"found <max_step_size>{step:g}</max_step_size>, {allowed}", block.where)
        step = 0.001
    law = block.choice("contact_law", CONTACT_LAWS, "simkit")
    factor = max(0.0, _real_time_factor(block, step))
    return Physics(step, factor, block.where, _contacts(block), contact_law=law), gravity


def _contacts(block: Params) -> int:
    """Contacts of one pair: 20, as Gazebo has it; -1 in a file means no limit of its own."""
    count = block.integer("max_contacts", 20, minimum=-1)
    return 20 if count < 0 else count


def _real_time_factor(block: Params, step: float) -> float:
    """The factor asked for; a file that has only the steps per second of wall time says it with those."""
    rate = block.number("real_time_update_rate", block.number("update_rate", 0.0, minimum=0.0), minimum=0.0)
    said = block.has("real_time_update_rate") or block.has("update_rate")
    return block.number("real_time_factor", rate * step if said else 1.0)


def _old_step(block: Params) -> float:
    """The step as it was written before 1.4."""
    for engine in block.children:
        for holder in (engine, *engine.children):
            if engine.name in ("ode", "bullet") and any(c.name == "dt" for c in holder.children):
                return holder.number("dt", 0.001)
    return 0.001
