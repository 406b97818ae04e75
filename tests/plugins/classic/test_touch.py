"""Classic's TouchPlugin: integer messages, named sensors, and exclusive contact with the target."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

SENSOR = '<sensor name="s" type="contact"><contact><collision>c</collision></contact></sensor>'


def body(name: str, pose: str, more: str = "", sensor: str = "", static: bool = False) -> str:
    shape = '<collision name="c"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>'
    moments = "".join(f"<{axis}>0.01</{axis}>" for axis in ("ixx", "iyy", "izz"))
    return f"""<model name="{name}"><static>{str(static).lower()}</static><pose>{pose}</pose><link name="l">
    <inertial><mass>1</mass><inertia>{moments}</inertia></inertial>{shape}{sensor}</link>{more}</model>"""


def world(*more: str, sensor: str = "s", enabled: int = 1) -> str:
    plugin = f"""<plugin name="touch" filename="libTouchPlugin.so"><sensor>{sensor}</sensor><target>pad</target>
    <time>0.1</time><namespace>probe</namespace><enabled>{enabled}</enabled></plugin>"""
    pad = body("pad", "0 0 0.1 0 0 0", static=True)
    return f"""<sdf version="1.6"><world name="w">{pad}{body("probe", "0 0 0.3 0 0 0", plugin, SENSOR)}{"".join(more)}
    </world></sdf>"""


def touches_published(sim: Any, duration: float) -> list[tuple[int, int]]:
    found: list[tuple[int, int]] = []
    subscription = sim.subscribe("/probe/touched", lambda message: found.append((sim.tick, message.data)))
    sim.run(duration)
    subscription.close()
    return found


def test_a_touch_is_published_once_after_its_duration() -> None:
    with simkit.load(world()) as sim:
        assert sim.topics()["/probe/touched"] == "std_msgs/msg/Int32"
        assert touches_published(sim, 0.5) == [(102, 1)]


def test_the_detection_restarts_on_enable() -> None:
    with simkit.load(world(enabled=0)) as sim:
        assert touches_published(sim, 0.3) == []
        sim.publish("/probe/enable", {"data": 1})
        assert [data for _, data in touches_published(sim, 0.3)] == [1]


def test_touching_another_object_interrupts_the_touch() -> None:
    other = body("stone", "0.15 0 0.1 0 0 0", static=True)
    with simkit.load(world(other)) as sim:
        assert touches_published(sim, 0.5) == []


def test_a_missing_sensor_is_an_error() -> None:
    with pytest.raises(LoadError, match="no contact sensor 'x'; it has: 's'"):
        simkit.load(world(sensor="x"))
