"""The lift of `docs/rmf.md` loads without a diagnostic but notes."""

from __future__ import annotations

import re
from pathlib import Path

import simkit

PAGE = Path(__file__).resolve().parents[1] / "docs" / "rmf.md"
SAMPLES = re.findall(r"^```xml\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
BODY = "<inertial><mass>500</mass><inertia><ixx>90</ixx><iyy>90</iyy><izz>90</izz></inertia></inertial>"
CABIN = f"""<link name="cabin">{BODY}</link><joint name="cabin_joint" type="prismatic"><parent>world</parent>
  <child>cabin</child><axis><xyz>0 0 1</xyz></axis></joint>"""


def test_its_lift_reaches_its_floors() -> None:
    (plugin,) = [text for text in SAMPLES if "liblift.so" in text]
    with simkit.load(
        f'<sdf version="1.9"><world name="w"><model name="lift">{CABIN}{plugin}</model></world></sdf>'
    ) as sim:
        assert {d.severity for d in sim.diagnostics} <= {"note"}
        request = {"lift_name": "lift", "destination_floor": "L2"}
        sim.publish("/lift_requests", simkit.msgs.make("rmf_lift_msgs/msg/LiftRequest", **request))
        sim.run(6.0)
        assert abs(sim.joint("lift::cabin_joint").position - 5) < 0.01
