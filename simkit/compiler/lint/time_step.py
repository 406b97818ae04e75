"""Checks of the time step, and of the update rates of sensors against it."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Final

from simkit.compiler.spec_builder import Compiled
from simkit.diagnostics import Diagnostics
from simkit.scene import SceneWorld

LONGEST_STEP: Final = 0.005
"""Longest step [s]; with a longer one a body at 1 m/s penetrates the ground by more than 5 mm before contact."""


def check_time_step(world: SceneWorld, compiled: Compiled, diagnostics: Diagnostics) -> None:
    """Report a step too long for contacts, and sensor rates whose period is not a whole number of steps."""
    step = world.physics.max_step_size
    _check_step(world, compiled, diagnostics)
    for model in world.models:
        for sensor in model.all_sensors():
            text = rate_pattern(sensor.rate, step)
            if text and sensor.rate * step <= 1:  # loading the world already reports a rate above the step rate
                diagnostics.note(
                    "SK-LINT-002", f"sensor {sensor.scoped!r}: {text}", sensor.where, _rate_hint(sensor.rate)
                )


def _check_step(world: SceneWorld, compiled: Compiled, diagnostics: Diagnostics) -> None:
    step = world.physics.max_step_size
    weld = compiled.model.body_weldid  # 0 for a body that cannot move
    moving = [b for b in compiled.names.links.values() if not b.static and b.geoms and weld[b.body] != 0]
    if step > LONGEST_STEP and moving:
        diagnostics.warning(
            "SK-LINT-001",
            f"the step is {step * 1e3:g} ms and {len(moving)} moving links collide: contacts get soft or unstable "
            f"beyond {LONGEST_STEP * 1e3:g} ms",
            world.physics.where,
            "write <max_step_size>0.001</max_step_size>, or try --set physics.max_step_size=0.001",
        )


def rate_pattern(rate: float, step: float) -> str:
    """Describe the time stamps of a rate [Hz] at a step [s]; empty if the period is a whole number of steps.

    Sample k is taken at the first step at or after k / rate.
    """
    if rate <= 0 or step <= 0 or not math.isfinite(rate):
        return ""
    each = Fraction(rate).limit_denominator(10**6) * Fraction(step).limit_denominator(10**9)
    if each == 0:  # the rate is less than one sample in a week, or the step is shorter than a nanosecond
        return ""
    steps = 1 / each
    if steps.denominator == 1:
        return ""
    if steps < 1:
        return f"{rate:g} Hz is more than the {1 / step:g} steps per second: samples come at {1 / step:g} Hz"
    low, high = math.floor(steps), math.ceil(steps)
    return f"{rate:g} Hz at a step of {step * 1e3:g} ms: stamps every {low * step * 1e3:g} or {high * step * 1e3:g} ms"


def _rate_hint(rate: float) -> str:
    return f"the mean rate is still {rate:g} Hz; equal intervals need a step that divides {1e3 / rate:.6g} ms"
