"""Calls of the Python interface with odd arguments: whatever is wrong with them is an error of simkit with a code."""

from __future__ import annotations

import inspect
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from targets import INPUTS, intact

CALLS = 200  # of one input
# The documented names.
NAMES = {
    "Simulation": "time time_ns tick timestep step run run_until reset snapshot restore models model link joint sensor "
    "light spawn remove publish subscribe topics diagnostics",
    "Model": "name static pose set_pose links joints models link joint model set_velocity set_joint_positions",
    "Link": "name pose linear_velocity angular_velocity linear_acceleration mass apply_wrench collisions_enabled",
    "Joint": "name type dof position velocity effort set_position set_velocity set_effort transmitted_wrench lower "
    "upper effort_limit velocity_limit",
    "Sensor": "name kind topic update_rate pose latest truth",
    "Light": "name pose set_pose direction",
    "Pose": "position quaternion rpy inverse from_rpy",
}


class Disguised:
    """An object that fails at whatever is asked of it."""

    def __getattr__(self, name: str) -> Any:
        raise RuntimeError(f"no {name}")

    def __repr__(self) -> str:
        return "Disguised()"


def odd_values() -> list[Any]:
    """Values that a call may get where it expects another."""
    import simkit

    numbers = [
        0,
        1,
        -1,
        2,
        0.5,
        -0.0,
        1e-9,
        1e308,
        float("nan"),
        float("inf"),
        -float("inf"),
        2**31,
        2**63,
        10**400,
        True,
        1j,
    ]
    numbers += [
        np.float64(0.1),
        np.float32("nan"),
        np.int64(-3),
        np.array(1.0),
        np.zeros(3),
        np.full(3, np.nan),
        np.zeros((2, 2)),
    ]
    numbers += [
        (0, 0, 1),
        [1, 2],
        (1, 2, "3"),
        (float("inf"), 0, 0),
        (10**400, 0, 0),
        [],
        np.array(["a", "b", "c"]),
        np.array([None] * 3),
    ]
    worlds = [(INPUTS / name).read_text() for name in ("ball.sdf", "w.sdf")]
    texts = [
        "",
        " ",
        "rover",
        "rover::base",
        "rover::a",
        "rover::base::imu",
        "wall",
        "ball",
        "/imu",
        "/cmd_vel",
        "cmd_vel",
        "/odom",
        "a::b",
        "::",
    ]
    texts += [
        "x" * 3000,
        "\x1b[2J",
        "a\nb",
        "\x00",
        "\ud800",
        "ü",
        *worlds,
        "<sdf",
        "ball.sdf",
        "/dev/zero",
        "..",
        "model://x",
        "%s{}",
    ]
    objects = [
        None,
        b"",
        b"\xff",
        object(),
        Disguised(),
        repr,  # a condition of the user may raise anything, but this one raises nothing
        lambda *_: True,
        lambda: 1,
        simkit.Pose(),
        type,
        Ellipsis,
        range(3),
        {1, 2},
    ]
    objects += [
        {},
        {"linear": {"x": 1.0}},
        {"linear": {"x": float("nan")}},
        {"linear": 3},
        {"a": 1.0, "b": "x"},
        {"x": None},
        {1: 2},
        {None: 1},
    ]
    objects += [
        Path("ball.sdf"),
        Path(),
        iter([1]),
        (i for i in range(3)),
        "geometry_msgs/msg/Twist",
        "std_srvs/srv/Empty",
        "no/msg/Type",
    ]
    return [*numbers, *texts, *objects, *_messages()]


def _messages() -> list[Any]:
    from simkit import msgs

    good = [
        msgs.make(n)
        for n in ("geometry_msgs/msg/Twist", "std_msgs/msg/Float64", "sensor_msgs/msg/Imu", "std_msgs/msg/String")
    ]
    broken = msgs.make("geometry_msgs/msg/Twist")
    broken.linear = "x"
    return [*good, broken]


def run_calls(seed: str) -> None:
    """Call methods and set attributes of a simulation and what it returns; raise the bare exceptions."""
    import simkit

    for name in ("arm.urdf", "controllers.yaml"):
        Path(name).write_bytes(intact(name))
    chance, values = random.Random(seed), odd_values()
    with simkit.load("w.sdf" if chance.random() < 0.7 else "arm.urdf") as sim:
        snapshots, wrong = [sim.snapshot()], []
        for number in range(CALLS):
            target = chance.choice(_targets(sim, chance))
            try:
                said = _one_call(target, [*values, *snapshots], chance)
            except AssertionError as error:
                wrong.append(str(error))
                continue
            if chance.random() < 0.05:
                snapshots.append(sim.snapshot())
            if chance.random() < 0.2:
                _judged(lambda said=said: sim.step(1), f"step(1) after {said}")
            if number == CALLS - 5 and chance.random() < 0.3:
                sim.close()
    if wrong:
        raise AssertionError("\n".join(wrong[:20]))


def _targets(sim: Any, chance: random.Random) -> list[Any]:
    import simkit

    found = [sim, sim, sim, sim.world, simkit.Pose(), *sim.models.values(), *sim.diagnostics[:1]]
    for names in (("links", "joints"), ("models",)):
        for model in sim.models.values():
            for name in names:
                group = getattr(model, name, {})
                found += [*(group.values() if hasattr(group, "values") else group)]
    for name in ("rover::base::imu", "rover::base::lidar"):
        if "rover" in sim.models and name.startswith("rover"):
            found.append(sim.sensor(name))
    functions = (
        simkit.load,
        simkit.check,
        simkit.describe,
        simkit.RunSpec,
        simkit.Pose,
        simkit.Pose.from_rpy,
        simkit.msgs.make,
    )
    return [*found, *(f for f in functions if chance.random() < 0.3)]


def _one_call(target: Any, values: list[Any], chance: random.Random) -> str:
    """Call or set one thing; return what was done."""
    if inspect.isfunction(target) or inspect.isclass(target) or inspect.ismethod(target):
        return _call(target, getattr(target, "__qualname__", str(target)), values, chance)
    kind = next((k for k in NAMES if any(base.__name__ == k for base in type(target).__mro__)), "Sensor")
    name = chance.choice(NAMES[kind].split())
    if not hasattr(type(target), name):
        return _judged(lambda: str(getattr(target, name)), f"{kind}.{name}")
    static, label = inspect.getattr_static(type(target), name), f"{type(target).__name__}.{name}"
    if isinstance(static, property):
        if static.fset is not None and chance.random() < 0.7:
            value = chance.choice(values)
            return _judged(lambda: setattr(target, name, value), f"{label} = {value!r:.80}")
        return _judged(lambda: str(getattr(target, name)), label)
    if not callable(static) and not isinstance(static, (classmethod, staticmethod)):
        return label
    return _call(getattr(target, name), label, values, chance)


def _call(method: Callable[..., Any], label: str, values: list[Any], chance: random.Random) -> str:
    try:
        known = [p for p in inspect.signature(method).parameters.values() if p.kind is not p.VAR_KEYWORD]
    except (TypeError, ValueError):
        return label
    wanted = [p for p in known if p.default is p.empty or chance.random() < 0.3]
    if label.endswith((".run", ".step", ".run_until")):  # long runs are what the caller asks for
        values = [v for v in values if not (isinstance(v, (int, float)) and 2 < v < float("inf"))]
    given = {p: chance.choice(values) for p in wanted}
    positional = [
        v for p, v in given.items() if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD, p.VAR_POSITIONAL)
    ]
    named = {p.name: v for p, v in given.items() if p.kind is p.KEYWORD_ONLY}
    shown = ", ".join([*(f"{v!r:.80}" for v in positional), *(f"{k}={v!r:.80}" for k, v in named.items())])
    return _judged(lambda: _closed(method(*positional, **named)), f"{label}({shown})")


def _closed(found: Any) -> None:
    if hasattr(found, "mj_model") and hasattr(found, "close"):
        found.close()


def _judged(action: Callable[[], Any], said: str) -> str:
    """Do something; pass on what simkit did not raise itself."""
    from simkit.errors import SimkitError

    try:
        action()
    except SimkitError as error:
        if not error.code or not str(error):
            raise AssertionError(f"{said}: an error without a code or a text") from error
    except Exception as error:
        if not isinstance(error, KeyError) and not _is_refused_by_python(error):
            raise AssertionError(f"{said}: {type(error).__name__}: {error}"[:600]) from error
    return said


def _is_refused_by_python(error: Exception) -> bool:
    """True if Python itself refused the call, because an attribute is read-only or an argument has another name."""
    last = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    return last is not None and last.tb_frame.f_code.co_filename == __file__
