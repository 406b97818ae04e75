"""World-wide settings of the engine: step, gravity, integrator, contact softness, memory."""

from __future__ import annotations

import math
from typing import Final

import mujoco
import numpy as np
import numpy.typing as npt

from simkit.diagnostics import Diagnostics
from simkit.linear_algebra import norm
from simkit.scene import SceneWorld

CONTACT_SOLIMP: Final = (0.9, 0.999, 0.0005, 0.5, 2.0)
"""Impedance of rigid contacts: 0.9 at the surface, 0.999 from a penetration of 0.5 mm on.

A body rests on the ground with a penetration of 4 to 10 µm at any mass, where the impedance is still 0.9. A higher
impedance there settles no better and makes a robot rock longer on its casters. Only a heavy body on a light body
reaches 0.999: a body of 1 kg carries 10⁴ kg with 0.8 mm of penetration, instead of 36 mm with an impedance of 0.95.
"""

SOFT_SOLIMP: Final = (0.9, 0.95, 0.001, 0.5, 2.0)
"""Impedance of joint limits, of dry friction in joints and of contacts with a stiffness of their own."""

CONTACT_LAW: Final = "simkit:contact_law"
"""Name of the text in a model whose value "mujoco" selects the engine's own contacts."""

SHORTEST_STEP: Final = 1e-9
"""Shortest step [s]; time is counted in nanoseconds."""

LONGEST_STEP: Final = 100.0
"""Longest step [s] that is plausible."""

_MEMORY_BASE: Final = 32 << 20
_MEMORY_PER_GEOM: Final = 64 << 10
_MEMORY_MOST: Final = 4 << 30
_MEMORY_PER_PAIR: Final = 4


def contact_time_constant(timestep: float) -> float:
    """Return the time constant [s] of the world-wide contact softness.

    With a shorter time constant, contacts oscillate at steps of 2 ms and more; with a longer one, gripped objects
    creep.
    """
    return max(0.004, 2.0 * timestep)


def rigid_time_constant(timestep: float) -> float:
    """Return the time constant [s] that gives a rigid contact the stiffness and damping of the world-wide softness.

    The engine divides stiffness and damping by the largest impedance, which is higher for rigid contacts. The time
    constant must be at least two steps.
    """
    return max(contact_time_constant(timestep) * SOFT_SOLIMP[1] / CONTACT_SOLIMP[1], 2.0 * timestep)


def apply_options(spec: mujoco.MjSpec, world: SceneWorld, diagnostics: Diagnostics) -> None:
    """Set step, gravity, integrator, solver flags, compiler conventions and ambient light."""
    step = world.physics.max_step_size
    if not (math.isfinite(step) and SHORTEST_STEP <= step <= LONGEST_STEP):
        text = f"max_step_size is {step}; it must be from {SHORTEST_STEP:g} to {LONGEST_STEP:g} s"
        diagnostics.error("SK-PHYS-015", text, world.physics.where)
        step = 0.001
    option = spec.option
    option.timestep = step
    option.gravity = world.gravity
    option.magnetic = world.magnetic_field
    option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    # a pyramidal cone has only 0.7 of the friction in diagonal directions; an `impratio` of 100 instead of 1 makes a
    option.cone, option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 100.0
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_AUTORESET)
    if world.physics.contact_law != "simkit":
        spec.add_text(name=CONTACT_LAW, data=world.physics.contact_law)
    compiler = spec.compiler
    compiler.degree = False
    compiler.autolimits = False
    compiler.alignfree = False
    compiler.fusestatic = False
    compiler.inertiafromgeom = mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_FALSE
    head = spec.visual.headlight
    head.ambient = world.surroundings.ambient[:3]
    head.diffuse = head.specular = (0.0, 0.0, 0.0)


def has_engine_contacts(model: mujoco.MjModel) -> bool:
    """Check whether a compiled model uses the engine's own contacts and integration."""
    number = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_TEXT, CONTACT_LAW)
    if number < 0:
        return False
    start = int(model.text_adr[number])
    return bytes(model.text_data[start : start + int(model.text_size[number])]).rstrip(b"\0") == b"mujoco"


def apply_size(spec: mujoco.MjSpec, colliding_geoms: int) -> None:
    """Set the arena memory by the numbers of colliding geoms and of bodies. Memory that is never used costs nothing.

    The geoms need memory for contacts. In each step, MuJoCo reserves 4 bytes for each pair of bodies, and ends the
    process if they do not fit, for example with more than 4096 bodies in 32 MiB.
    """
    memory = min(_MEMORY_MOST, _MEMORY_BASE + _MEMORY_PER_GEOM * colliding_geoms)
    bodies = len(spec.bodies)
    memory += _MEMORY_PER_PAIR * (bodies * (bodies - 1) // 2)
    if int(spec.memory) < memory:
        spec.memory = memory


def choose_islands(spec: mujoco.MjSpec, trees: int) -> None:
    """Enable constraint islands for several moving trees.

    Islands make a world with a single robot 8 % slower; they make it faster only with several trees. Without islands,
    no body can sleep.
    """
    flag = int(mujoco.mjtDisableBit.mjDSBL_ISLAND)
    if trees < 2:
        spec.option.disableflags |= flag
    else:
        spec.option.disableflags &= ~flag


def set_extent(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Set centre and size of the scene from its bounded geoms; planes, distant lights and outliers are ignored.

    Renderers with MuJoCo's defaults scale their clip planes and their shadow map by this size.

    Args:
        model: MuJoCo's model.
        data: first state of the model.
    """
    bounded = model.geom_rbound > 0.0
    if not bounded.any():
        model.stat.center[:] = 0.0
        model.stat.extent = 1.0
        return
    centres, radii = data.geom_xpos[bounded], model.geom_rbound[bounded]
    middle = _median(centres)
    distance = np.linalg.norm(centres - middle, axis=1) + radii
    near = distance <= 20.0 * max(float(_median(distance)), 0.5)
    low = (centres - radii[:, None])[near].min(axis=0)
    high = (centres + radii[:, None])[near].max(axis=0)
    model.stat.center[:] = (low + high) / 2
    model.stat.extent = float(np.clip(norm(high - low) / 2, 0.5, 1000.0))


def _median(values: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Return the median along the first axis without `np.median`, whose import of masked arrays takes 20 ms."""
    ordered, half = np.sort(values, axis=0), len(values) // 2
    middle: npt.NDArray[np.float64] = ordered[half] if len(values) % 2 else (ordered[half - 1] + ordered[half]) / 2
    return middle
