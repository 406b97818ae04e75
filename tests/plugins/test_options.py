"""Declared options of a plugin: each is read from the file at its first use, and only once."""

from __future__ import annotations

from simkit.params import Params
from simkit.plugins.options import (
    Options,
    block,
    blocks,
    boolean,
    choice,
    integer,
    number,
    numbers,
    pose,
    text,
    texts,
    vector,
    vector3,
    without_effect,
)
from simkit.pose import Pose


class NoiseOptions(Options):
    kind: str = choice(("none", "gaussian"), "none", element="@type")
    stddev: float = number(0.5, minimum=0.0)


class ArmOptions(Options):
    gain: float = number(2.0, "1/s", minimum=0.0, maximum=10.0)
    weak_gain: float = number(unit="1/s", instead="gain")
    count: int = integer(3, minimum=1)
    is_on: bool = boolean(True, element="enabled")
    frame: str = text("base")
    joints: tuple[str, ...] = texts(element="joint", required=True)
    limits: tuple[float, ...] = numbers("rad", element="limit", minimum=0.0)
    weights: tuple[float, ...] = vector((1.0, 2.0))
    axis: tuple[float, float, float] = vector3((0.0, 0.0, 1.0))
    origin: Pose = pose()
    noise: NoiseOptions = block(NoiseOptions)
    tools: tuple[NoiseOptions, ...] = blocks(NoiseOptions, element="tool")
    debug: bool = without_effect()


def test_an_empty_file_gives_the_defaults() -> None:
    options = ArmOptions(Params("plugin"))
    assert (options.gain, options.weak_gain, options.count, options.is_on) == (2.0, 2.0, 3, True)
    assert (options.frame, options.weights, options.axis, options.debug) == ("base", (1.0, 2.0), (0.0, 0.0, 1.0), False)
    assert (options.limits, options.tools, options.noise.is_given, options.noise.stddev) == ((), (), False, 0.5)
    assert not options.params.diagnostics.has_errors
    assert options.joints == () and options.params.diagnostics.error_count == 1  # required


def test_values_come_from_their_elements() -> None:
    values = {
        "gain": 4.0,
        "enabled": False,
        "joint": ["a", "b"],
        "limit": [1.0, 2.0],
        "weights": (3.0, 4.0),
        "noise": {"stddev": 0.1},
        "tool": [{"stddev": 1.0}, {}],
        "debug": True,
    }
    options = ArmOptions(Params.from_dict(values))
    assert (options.weak_gain, options.is_on, options.joints) == (4.0, False, ("a", "b"))
    assert (options.limits, options.weights, options.debug) == ((1.0, 2.0), (3.0, 4.0), True)
    assert options.noise.is_given and options.noise.stddev == 0.1
    assert [tool.stddev for tool in options.tools] == [1.0, 0.5]


def test_a_value_out_of_bounds_is_reported_once() -> None:
    options = ArmOptions(Params.from_dict({"gain": 11.0}))
    assert (options.gain, options.gain) == (2.0, 2.0)
    (fault,) = options.params.diagnostics
    assert fault.code == "SK-PARAM-002" and "from 0 to 10" in fault.message


def test_an_unused_option_stays_unread() -> None:
    options = ArmOptions(Params.from_dict({"gain": 1.0, "frame": "tip"}))
    assert options.gain == 1.0
    assert [element.name for element, _ in options.params.unread()] == ["frame"]


def test_a_class_lists_its_element_names() -> None:
    assert {"gain", "enabled", "joint", "tool", "stddev", "@type"} <= set(ArmOptions.element_names())
    assert ArmOptions.fields()["gain"].unit == "1/s"
