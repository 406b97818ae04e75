"""Transforms of frames follow the rules of tf2, with its texts of errors."""

from __future__ import annotations

import math

import pytest

from simkit_nodes.frame_buffer import (
    ConnectivityException,
    ExtrapolationException,
    FrameBuffer,
    InvalidArgumentException,
    LookupException,
    Quaternion,
    TransformException,
)

SECOND = 1_000_000_000
NONE = (0.0, 0.0, 0.0, 1.0)


def turn(yaw: float) -> Quaternion:
    return 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)


@pytest.fixture
def buffer() -> FrameBuffer:
    """Return a robot that moves along x of `odom` at 1 m/s from t=1 s to t=3 s, and turns at 0.1 rad/s."""
    result = FrameBuffer()
    for time in (1, 2, 3):
        result.add("odom", "base", time * SECOND, (float(time), 0.0, 0.0), turn(0.1 * time))
    result.add("base", "laser", 0, (0.5, 0.0, 0.2), NONE, is_static=True)
    result.add("base", "camera", 0, (0.0, 0.3, 0.0), turn(math.pi), is_static=True)
    return result


def test_time_zero_means_the_latest_common_time(buffer: FrameBuffer) -> None:
    buffer.add("map", "odom", 2 * SECOND, (10.0, 0.0, 0.0), NONE)
    position, rotation, stamp = buffer.lookup("map", "base", 0)
    assert stamp == 2 * SECOND
    assert position == pytest.approx((12.0, 0.0, 0.0))
    assert rotation == pytest.approx(turn(0.2))


def test_transforms_that_are_always_valid_have_the_time_zero(buffer: FrameBuffer) -> None:
    position, rotation, stamp = buffer.lookup("camera", "laser", 0)
    assert stamp == 0
    assert position == pytest.approx((-0.5, 0.3, 0.2))
    assert rotation == pytest.approx((0.0, 0.0, -1.0, 0.0)) or rotation == pytest.approx((0.0, 0.0, 1.0, 0.0))


def test_a_time_between_two_transforms_is_interpolated(buffer: FrameBuffer) -> None:
    position, rotation, stamp = buffer.lookup("odom", "base", 1_500_000_000)
    assert stamp == 1_500_000_000
    assert position == pytest.approx((1.5, 0.0, 0.0))
    assert rotation == pytest.approx(turn(0.15))


def test_the_inverse_lookup_is_the_inverse_transform(buffer: FrameBuffer) -> None:
    position, rotation, _ = buffer.lookup("base", "odom", 3 * SECOND)
    assert position == pytest.approx((-3 * math.cos(0.3), 3 * math.sin(0.3), 0.0))
    assert rotation == pytest.approx(turn(-0.3))


def test_a_frame_in_itself_needs_no_transform() -> None:
    assert FrameBuffer().lookup("any", "any", 7) == ((0.0, 0.0, 0.0), NONE, 7)


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        (
            ("nowhere", "base", 0),
            LookupException,
            '"nowhere" passed to lookupTransform argument target_frame does not exist. ',
        ),
        (
            ("base", "/odom", 0),
            InvalidArgumentException,
            'Invalid argument "/odom" passed to lookupTransform argument source_frame - in tf2 frame_ids cannot start '
            "with a '/'",
        ),
        (
            ("", "base", 0),
            InvalidArgumentException,
            'Invalid argument "" passed to lookupTransform argument target_frame - in tf2 frame_ids cannot be empty',
        ),
        (
            ("odom", "laser", 4 * SECOND),
            ExtrapolationException,
            "Lookup would require extrapolation into the future.  Requested time 4.000000 but the latest data is at "
            "time 3.000000, when looking up transform from frame [laser] to frame [odom]",
        ),
        (
            ("laser", "odom", SECOND // 2),
            ExtrapolationException,
            "Lookup would require extrapolation into the past.  Requested time 0.500000 but the earliest data is at "
            "time 1.000000, when looking up transform from frame [odom] to frame [laser]",
        ),
        (
            ("world", "base", 0),
            ConnectivityException,
            "Could not find a connection between 'world' and 'base' because they are not part of the same tree.Tf has "
            "two or more unconnected trees.",
        ),
    ],
)
def test_errors_have_the_texts_of_tf2(
    buffer: FrameBuffer, arguments: tuple[str, str, int], error: type[TransformException], text: str
) -> None:
    buffer.add("world", "tree", 0, (0.0, 0.0, 0.0), NONE, is_static=True)
    with pytest.raises(error) as caught:
        buffer.lookup(*arguments)
    assert str(caught.value) == text
    assert buffer.problem(*arguments) != ""


def test_a_single_transform_is_known_at_its_own_time_only() -> None:
    buffer = FrameBuffer()
    buffer.add("odom", "base", SECOND, (1.0, 0.0, 0.0), NONE)
    assert buffer.problem("odom", "base", SECOND) == ""
    assert "at time 2.000000, but only time 1.000000 is in the buffer" in buffer.problem("odom", "base", 2 * SECOND)


def test_a_way_between_static_frames_is_known_at_all_times(buffer: FrameBuffer) -> None:
    assert buffer.problem("camera", "laser", 1000 * SECOND) == ""


def test_the_history_has_ten_seconds() -> None:
    buffer = FrameBuffer()
    for time in range(1, 20):
        buffer.add("odom", "base", time * SECOND, (float(time), 0.0, 0.0), NONE)
    assert buffer.problem("odom", "base", 9 * SECOND) == ""
    assert "into the past" in buffer.problem("odom", "base", 7 * SECOND)
    assert buffer.add("odom", "base", 5 * SECOND, (0.0, 0.0, 0.0), NONE).startswith(
        "TF_OLD_DATA ignoring data from the past for frame base at time 5.000000"
    )


def test_transforms_may_arrive_in_any_order() -> None:
    buffer = FrameBuffer()
    for time in (3, 1, 2):
        buffer.add("odom", "base", time * SECOND, (float(time), 0.0, 0.0), NONE)
    assert buffer.lookup("odom", "base", 1_500_000_000)[0] == pytest.approx((1.5, 0.0, 0.0))


@pytest.mark.parametrize(
    ("parent", "child", "rotation", "text"),
    [
        ("a", "a", NONE, "TF_SELF_TRANSFORM"),
        ("a", "", NONE, "TF_NO_CHILD_FRAME_ID"),
        ("", "b", NONE, "TF_NO_FRAME_ID"),
        ("a", "b", (math.nan, 0.0, 0.0, 1.0), "TF_NAN_INPUT"),
        ("a", "b", (0.0, 0.0, 0.0, 0.0), "TF_DENORMALIZED_QUATERNION"),
    ],
)
def test_invalid_transforms_are_ignored(parent: str, child: str, rotation: Quaternion, text: str) -> None:
    buffer = FrameBuffer()
    assert buffer.add(parent, child, 0, (0.0, 0.0, 0.0), rotation).startswith(text)
    assert buffer.names() == []


def test_a_fixed_frame_connects_two_times(buffer: FrameBuffer) -> None:
    position, _, stamp = buffer.lookup_full("base", 3 * SECOND, "base", SECOND, "odom")
    assert position == pytest.approx((-2 * math.cos(0.3), 2 * math.sin(0.3), 0.0))
    assert stamp == 3 * SECOND
    assert buffer.problem_full("base", 5 * SECOND, "base", SECOND, "odom").startswith("Lookup would require")


def test_clear_keeps_what_is_always_valid(buffer: FrameBuffer) -> None:
    buffer.clear()
    assert buffer.problem("base", "laser", 0) == ""
    assert buffer.problem("odom", "base", 0) != ""
    assert buffer.has_frame("odom")


def test_a_loop_is_an_error() -> None:
    buffer = FrameBuffer()
    buffer.add("a", "b", SECOND, (0.0, 0.0, 0.0), NONE)
    buffer.add("b", "a", SECOND, (0.0, 0.0, 0.0), NONE)
    buffer.add("c", "d", SECOND, (0.0, 0.0, 0.0), NONE)
    with pytest.raises(LookupException, match="The tf tree is invalid because it contains a loop"):
        buffer.lookup("c", "a", SECOND)
    with pytest.raises(LookupException, match="Frame b exists with parent a"):
        buffer.lookup("c", "a", 0)


def test_frames_are_listed_as_yaml(buffer: FrameBuffer) -> None:
    assert buffer.as_yaml().startswith(
        "base: \n  parent: 'odom'\n  broadcaster: 'default_authority'\n  rate: 1.500\n"
        "  most_recent_transform: 3.000000\n  oldest_transform: 1.000000\n  buffer_length: 2.000\n"
    )
    assert FrameBuffer().as_yaml() == "[]"


def test_w_of_a_quaternion_is_positive_if_the_rotation_is_small() -> None:
    buffer = FrameBuffer()
    buffer.add("a", "b", 0, (0.0, 0.0, 0.0), tuple(-number for number in turn(0.4)), is_static=True)  # type: ignore[arg-type]
    assert buffer.lookup("a", "b", 0)[1] == pytest.approx(turn(0.4))
