"""World texts that the benchmarks share."""

from __future__ import annotations

from pathlib import Path

SHAPES = Path(__file__).resolve().parents[2] / "shared" / "bench" / "3k_shapes.sdf"
"""gz-sim's own world of 3003 resting shapes (gazebosim/gz-sim, `test/worlds/`), where it lies beside the checkout."""

_WORLD = """<sdf version="1.9"><world name="w"><physics name="p" type="ode">
<max_step_size>0.001</max_step_size></physics><include><uri>model://sun</uri></include><include><uri>model://ground_plane</uri></include>{}</world></sdf>"""
ROBOT = "<include><uri>model://turtlebot3_waffle</uri></include>"


def obstacles(count: int) -> str:
    """A TurtleBot3 before `count` static cylinders in rows."""
    return _WORLD.format(ROBOT + "".join(_cylinder(i, 2.0 * (i % 70) + 3, 2.0 * (i // 70) + 3) for i in range(count)))


def boxes(count: int, robot: bool = False) -> str:
    """`count` boxes of 40 cm side by side on the ground."""
    many = "".join(_box(i, 0.6 * (i % 25) + 3, 0.6 * (i // 25) + 3) for i in range(count))
    return _WORLD.format((ROBOT if robot else "") + many)


def _cylinder(i: int, x: float, y: float) -> str:
    return f"""<model name="o{i}"><static>true</static><pose>{x} {y} 0.5 0 0 0</pose><link name="l"><collision name="c">
<geometry><cylinder><radius>0.3</radius><length>1</length></cylinder></geometry></collision></link></model>"""


def _box(i: int, x: float, y: float) -> str:
    return f"""<model name="b{i}"><pose>{x} {y} 0.2 0 0 0</pose><link name="l"><inertial><mass>1</mass><inertia>
<ixx>0.02</ixx><iyy>0.02</iyy><izz>0.02</izz></inertia></inertial><collision name="c"><geometry><box>
<size>0.4 0.4 0.4</size></box></geometry></collision></link></model>"""
