"""Topics that several sensors publish on, and invalid topic names."""

from __future__ import annotations

import pytest
from sensor_worlds import sensor, world

import simkit

CAMERA = "<camera><image><width>8</width><height>6</height></image>{}</camera>"


def imu(name: str, topic: str = "imu") -> str:
    return sensor("imu", f"<topic>{topic}</topic>", name=name)


def camera(name: str, topic: str, more: str = "") -> str:
    return f'<sensor name="{name}" type="camera"><topic>{topic}</topic>{CAMERA.format(more)}</sensor>'


def test_two_sensors_on_one_topic_are_reported_once() -> None:
    two = imu("a") + imu("b") + imu("c", "other")
    with simkit.load(world(two)) as sim:
        (found,) = [d for d in sim.diagnostics if d.code == "SK-SENSOR-027"]
        assert "'m::l::a' and 'm::l::b'" in found.message and found.severity == "warning"
        sim.sensor("m::l::a").set_rate(3)
        assert [d.code for d in sim.diagnostics] == ["SK-SENSOR-027"]


@pytest.mark.parametrize(
    ("sensors", "expected"),
    [
        (camera("a", "left") + camera("b", "right"), ["note SK-SENSOR-127"]),
        (camera("a", "a/image") + camera("b", "b/image"), []),
        (camera("a", "left") + camera("b", "left"), ["warning SK-SENSOR-027"]),
        (camera("a", "eye", "<camera_info_topic>eye</camera_info_topic>"), ["warning SK-SENSOR-128"]),
        (camera("a", "imu") + imu("b", "imu"), ["warning SK-SENSOR-128"]),
    ],
    ids=["one camera_info", "a topic each", "one topic", "picture and camera_info", "picture and imu"],
)
def test_only_a_shared_camera_info_is_no_warning(sensors: str, expected: list[str]) -> None:
    with simkit.load(world(sensors)) as sim:
        assert [f"{d.severity} {d.code}" for d in sim.diagnostics] == expected


@pytest.mark.parametrize("element", ["topic", "set_rate_topic", "camera><trigger_topic", "camera><camera_info_topic"])
def test_invalid_characters_of_a_topic_are_reported(element: str) -> None:
    parents = element.split("><")
    end = "".join(f"</{parent}>" for parent in reversed(parents))

    def text(topic: str) -> str:
        return world(f'<sensor name="s" type="camera"><{element}>{topic}{end}</sensor>')

    with simkit.load(text("/take one!/")) as sim:
        (found,) = sim.diagnostics
        assert (found.code, found.severity) == ("SK-SENSOR-129", "note")
        assert f"<{parents[-1]}>/take one!/<" in found.message
        assert "'/take_one'" in found.message
    with simkit.load(text("take/one_2")) as sim:
        assert not sim.diagnostics
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(text("!?"))
    assert [d.code for d in caught.value.diagnostics] == ["SK-PARAM-002"]
