"""Rotors and sliders whose motion has an answer on paper."""

from __future__ import annotations

from typing import Any

import simkit

INERTIA = 0.2
"""[kg·m²] of a rotor about its axis."""


def rotor(
    name: str,
    *,
    parent: str = "world",
    inertia: float = INERTIA,
    damping: float = 0.0,
    limit: str = "",
    kind: str = "revolute",
) -> str:
    """A link named `name` on a joint `j_<name>` about the vertical (a slider: along it, of 1 kg)."""
    return f"""<link name="{name}"><inertial><mass>1</mass><inertia><ixx>{inertia}</ixx><iyy>{inertia}</iyy>
    <izz>{inertia}</izz></inertia></inertial></link><joint name="j_{name}" type="{kind}"><parent>{parent}</parent>
    <child>{name}</child><axis><xyz>0 0 1</xyz>{limit}<dynamics><damping>{damping}</damping></dynamics></axis>
    </joint>"""


def gz(system: str, cls: str, content: str, name: str = "") -> str:
    return f'<plugin filename="gz-sim-{system}-system" name="{name or "gz::sim::systems::" + cls}">{content}</plugin>'


def position(content: str, name: str = "") -> str:
    return gz("joint-position-controller", "JointPositionController", content, name)


def velocity(content: str, name: str = "") -> str:
    return gz("joint-controller", "JointController", content, name)


def trajectory(content: str, name: str = "") -> str:
    return gz("joint-trajectory-controller", "JointTrajectoryController", content, name)


def force(content: str) -> str:
    return gz("apply-joint-force", "ApplyJointForce", content)


def load(
    *parts: str, gravity: str = "0 0 0", step: float = 0.001, extra: str = "", **options: Any
) -> simkit.Simulation:
    """A world with one model `m` of these parts."""
    return simkit.load(text(*parts, gravity=gravity, step=step, extra=extra), **options)


def text(*parts: str, gravity: str = "0 0 0", step: float = 0.001, extra: str = "") -> str:
    physics = f'<physics type="ode"><max_step_size>{step}</max_step_size></physics><gravity>{gravity}</gravity>'
    return f'<sdf version="1.9"><world name="w">{physics}{extra}<model name="m">{"".join(parts)}</model></world></sdf>'


def codes(diagnostics: Any, code: str) -> list[str]:
    """Messages of a code."""
    return [d.message for d in diagnostics if d.code == code]
