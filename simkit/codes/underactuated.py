"""Fingers whose joints follow one motor."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model

_JOINTS = "\n".join(
    f'<link name="{name}">{INERTIAL}</link>\n'
    f'<joint name="j_{name}" type="revolute"><parent>world</parent><child>{name}</child>'
    "<axis><xyz>0 0 1</xyz></axis></joint>"
    for name in ("motor", "finger")
)

CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-047",
        "warning",
        "the loop of a finger joint lacks a gain: a servo moves it, as if there were no loop",
        "`<p>`, `<i>`, `<d>`, `<i_max>` and `<i_min>` are needed, all of them",
        model(
            f'{_JOINTS}\n<plugin filename="libgazebo_underactuated_finger.so" name="finger">\n'
            "  <actuatedJoint>j_motor</actuatedJoint>\n"
            "  <virtualJoint><name>j_finger</name><scale_factor>2</scale_factor>"
            "<pid_gains><p>1</p></pid_gains></virtualJoint>\n</plugin>"
        ),
    ),
)
