"""Expressions: parsed without Python, validated before the first step, with correct results."""

from __future__ import annotations

import math
from typing import Any

import pytest

from simkit.errors import InputError
from simkit.testing.conditions import parse
from simkit.testing.conditions.binder import bind


def value(text: str, view: Any) -> Any:
    return bind(parse(text), view).get()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("-2 ** 2", -4.0),
        ("2 ** -1", 0.5),
        ("2 ** 3 ** 2", 512.0),
        ("2 ** 3 * 4", 32.0),
        ("7 % 3 - -1", 2.0),
        ("-7 % 3", 2.0),
        ("8 / 4 / 2", 1.0),
        (".5 + 1e-1 + 1.", 1.6),
        ("1 < 2 < 3", True),
        ("1 < 3 < 2", False),
        ("not 1 > 2 and 3 > 2", True),
        ("true or false and false", True),
        ("not true == false", True),
        ("'a' == \"a\"", True),
        ("'a' != 'b'", True),
        ("1 / 0", math.inf),
        ("-1 / 0", -math.inf),
        ("9 ** 9 ** 9 ** 9", math.inf),
        ("(-2) ** 0.5 == nan", False),
        ("isfinite(1 / 0) or isfinite(sqrt(-1)) or isfinite(0 / 0) or isfinite(1 % 0)", False),
        ("log(0)", -math.inf),
        ("exp(1000)", math.inf),
        ("floor(inf)", math.inf),
        ("atan2(1, -1)", 3 * math.pi / 4),
        ("deg(pi)", 180.0),
        ("angle(3, -3)", 6 - 2 * math.pi),
        ("wrap(-pi)", math.pi),
        ("clamp(5, 0, 2)", 2.0),
        ("min(3, 1, 2) + max(3, 1, 2) + mean(1, 2, 3) + sum(1, 2)", 9.0),
        ("norm(3, 4)", 5.0),
        ("abs(-3)", 3.0),
        ("any(1 > 2, 2 > 1) and not all(1 > 2, 2 > 1)", True),
        ("round(2.6) + ceil(0.1)", 4.0),
    ],
)
def test_arithmetic_and_logic_have_the_expected_results(text: str, expected: Any, still: Any) -> None:
    found = value(text, still)
    assert found == pytest.approx(expected) if not isinstance(expected, bool) else found is expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("time", 1.0),
        ("tick", 500.0),
        ("pose('wall').x", 2.0),
        ("pose('wall').position[-1]", 0.5),
        ("pose('wall', 'post').y", 3.0),
        ("pose('post').position.y", -3.0),
        ("norm(pose('wall').position - pose('post').position)", math.sqrt(4 + 9 + 0.01)),
        ("(2 * pose('wall').position).x + (-pose('wall').position / 2).x", 3.0),
        ("distance('wall', 'post')", math.sqrt(4 + 9 + 0.01)),
        ("distance((1, 2, 3), (1, 2, 1 + 1))", 1.0),
        ("(1, 2, 3).y + norm((3, 4))", 7.0),
        ("distance(pose('wall'), topic('/imu').linear_acceleration) > 0", True),
        ("pose('beam').z", 1.0),
        ("pose('arm::beam').orientation.w", 1.0),
        ("joint('hinge').position + joint('arm::hinge').velocity", 0.0),
        ("exists('ball') and not exists('bell')", True),
        ("topic('/imu').linear_acceleration.z", 9.8),
        ("topic('/imu').orientation.yaw", 0.0),
        ("topic('/imu').header.frame_id == 'ball::base::imu'", True),
        ("len(topic('/imu').orientation_covariance)", 9.0),
        ("count('/imu')", 51.0),
        ("age('/scan')", 0.0),
        ("len(scan('/scan').ranges)", 90.0),
        ("max(scan('/scan').ranges)", math.inf),
    ],
)
def test_a_world_is_read_as_its_handles_tell_it(text: str, expected: Any, still: Any) -> None:
    found = value(text, still)
    assert found == pytest.approx(expected, abs=1e-3) if not isinstance(expected, bool) else found is expected


def test_numbers_of_a_scan_are_the_ranges_of_hits(still: Any) -> None:
    import numpy as np

    ranges = np.asarray(still.sim.sensor("post::l::lds").latest.ranges, dtype=float)
    met = ranges[np.isfinite(ranges)]
    assert 0 < len(met) < len(ranges)
    for name in ("min", "max", "mean"):
        assert value(f"{name}(scan('/scan'))", still) == pytest.approx(getattr(np, name)(met))


def test_velocity_can_be_expressed_in_the_axes_of_the_entity(yard: Any) -> None:
    from simkit.testing.conditions.world_view import WorldView

    with yard() as sim:
        sim.model("ball").set_velocity((0.0, 1.0, 0.0), (0.0, 0.0, 0.0))
        pose = sim.model("ball").pose
        sim.model("ball").set_pose(type(pose).from_rpy(0, 0, 0.25, 0, 0, math.pi / 2))
        view = WorldView(sim)
        assert value("velocity('ball').y", view) == pytest.approx(1.0)
        assert value("velocity('ball', 'ball').x", view) == pytest.approx(1.0)
        assert value("twist('ball', 'base').linear.x + norm(twist('ball').angular)", view) == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("text", "code", "place", "says"),
    [
        ("", "SK-COND-001", "", "empty"),
        ("pose('ball).x > 1", "SK-COND-001", "'ball).x > 1", "close it with '"),
        ("time >", "SK-COND-001", "", "missing value"),
        ("time = 1", "SK-COND-001", "=", "=="),
        ("time > 1 && tick > 1", "SK-COND-001", "&&", "write: and"),
        ("time > 30s", "SK-COND-001", "30s", "SI units"),
        ("(time > 1", "SK-COND-001", "(", "is not closed"),
        ("time > 1)", "SK-COND-001", ")", "unexpected"),
        ("1 if time else 2", "SK-COND-001", "if", "not part of this language"),
        ("pose 'ball'", "SK-COND-001", "'ball'", "pose('ball')"),
        ("pose('ball').", "SK-COND-001", "", "after the dot"),
        ("pose('ball')('x')", "SK-COND-001", "pose('ball')", "only functions"),
        ("time > 1; tick", "SK-COND-001", ";", "and"),
        ("__import__('os').system('true')", "SK-COND-001", "__import__('os').system", "only functions"),
        ("__import__('os') == 1", "SK-COND-002", "__import__", "unknown function"),
        ("pos('ball').x > 1", "SK-COND-002", "pos", "'pose'"),
        ("tim > 1", "SK-COND-002", "tim", "'time'"),
        ("ball.x > 1", "SK-COND-002", "ball.x", "pose('ball').x"),
        ("pose > 1", "SK-COND-002", "pose", "is a function"),
        ("time() > 1", "SK-COND-002", "time", "write time alone"),
        ("pose().x > 1", "SK-COND-003", "pose()", "pose('model or link'"),
        ("sin(1, 2) > 1", "SK-COND-003", "sin(1, 2)", "2 arguments"),
        ("pose(ball).x > 1", "SK-COND-004", "ball", "pose('ball')"),
        ("pose('ball') > 1", "SK-COND-004", "pose('ball')", ".yaw"),
        ("pose('ball').position > 1", "SK-COND-004", "pose('ball').position", "norm"),
        ("time and tick > 1", "SK-COND-004", "time", "compare it"),
        ("not time", "SK-COND-004", "time", "compare it"),
        ("'a' > 'b'", "SK-COND-004", "'a'", "== or !="),
        ("'a' == 1", "SK-COND-004", "1", "cannot compare a text with a number"),
        ("scan('/scan') > 1", "SK-COND-004", "scan('/scan')", "ranges"),
        ("scan('/imu').ranges[0] > 1", "SK-COND-004", "'/imu'", "sensor_msgs/msg/Imu"),
        ("pose('ball').position + 1 > 1", "SK-COND-004", "pose('ball').position + 1", "cannot compute"),
        ("distance('ball', 3) > 1", "SK-COND-004", "3", "not a point"),
        ("norm((1, 'a')) > 1", "SK-COND-004", "'a'", "a text"),
        ("(1, 2 > 1", "SK-COND-001", "(", "is not closed"),
        ("pose('bal').x > 1", "SK-COND-005", "'bal'", "'ball'"),
        ("pose('l').x > 1", "SK-COND-005", "'l'", "scoped name"),
        ("joint('hing').position > 1", "SK-COND-005", "'hing'", "'hinge'"),
        ("count('/imus') > 1", "SK-COND-006", "'/imus'", "'/imu'"),
        ("pose('ball').zz > 1", "SK-COND-007", "zz", "'z'"),
        ("topic('/imu').acceleration > 1", "SK-COND-007", "acceleration", "linear_acceleration"),
        ("topic('/imu').orientation_covariance[9] > 1", "SK-COND-007", "9", "9 items"),
        ("scan('/scan').ranges[0.5] > 1", "SK-COND-004", "0.5", "must be an integer"),
        ("1 " * 1200, "SK-COND-008", "", "2000"),
        ("(" * 200, "SK-COND-008", "", "levels"),
        ("1" + " + 1" * 300, "SK-COND-008", "", "levels"),
        ("time" + ".x" * 300, "SK-COND-008", "", "levels"),
    ],
)
def test_an_error_points_at_its_position_and_has_a_hint(
    text: str, code: str, place: str, says: str, still: Any
) -> None:
    with pytest.raises(InputError) as caught:
        bind(parse(text), still)
    message = str(caught.value)
    assert caught.value.code == code and message.startswith(code) and says in message
    if place:
        shown, carets = message.splitlines()[1:3]
        assert shown[carets.index("^") : carets.rindex("^") + 1] == place


def test_a_known_operand_can_decide_despite_unknown_operands(yard: Any) -> None:
    from simkit.testing.conditions.syntax_tree import UndecidedValue
    from simkit.testing.conditions.world_view import WorldView

    with yard() as sim:
        view = WorldView(sim)
        assert value("time < 1 or min(scan('/scan')) > 0.2", view) is True
        assert value("min(scan('/scan')) > 0.2 or time < 1", view) is True
        assert value("min(scan('/scan')) > 0.2 and time > 1", view) is False
        for text in ("min(scan('/scan')) > 0.2", "not min(scan('/scan')) > 0.2", "rate('/imu') > 1", "age('/imu') > 1"):
            with pytest.raises(UndecidedValue, match=r"no message received|fewer than two"):
                value(text, view)


def test_the_value_of_a_removed_model_is_unknown(yard: Any) -> None:
    from simkit.testing.conditions.syntax_tree import UndecidedValue
    from simkit.testing.conditions.world_view import WorldView

    with yard() as sim:
        view = WorldView(sim)
        part, there = bind(parse("pose('ball').x < 1"), view), bind(parse("exists('ball')"), view)
        assert part.get() and there.get()
        sim.remove("ball")
        assert not there.get()
        with pytest.raises(UndecidedValue, match="ball was removed"):
            part.get()


def test_any_invalid_expression_is_an_input_error(still: Any) -> None:
    import random

    from simkit.testing.conditions.syntax_tree import UndecidedValue

    words = [
        "pose",
        "(",
        ")",
        "'ball'",
        ".",
        "x",
        ">",
        "<",
        "==",
        "and",
        "or",
        "not",
        "1",
        "2.5",
        "[",
        "]",
        ",",
        "time",
    ]
    words += ["scan", "'/scan'", "ranges", "min", "-", "+", "*", "**", "/", "%", "nan", "topic", "'/imu'", "contact"]
    rng = random.Random(3)
    codes = set()
    for _ in range(3000):
        text = " ".join(rng.choice(words) for _ in range(rng.randint(1, 12)))
        try:
            bind(parse(text), still).get()
        except InputError as error:
            codes.add(error.code)
        except UndecidedValue:
            continue
    assert len(codes) > 3 and all(code.startswith("SK-COND-") for code in codes)
