"""Golden runs: recorded, checked, blessed."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import command, python

_FALLING = """
from pathlib import Path

from simkit.golden.capture import run_record
from simkit.golden.check import check_golden
from simkit.golden.store import write_golden
from simkit.scenario import Scenario

Path("ball.sdf").write_text(
    '<sdf version="1.9"><world name="w"><model name="ball"><pose>0 0 5 0 0 0</pose><link name="l">'
    '<sensor name="imu" type="imu"><update_rate>50</update_rate></sensor></link></model></world></sdf>'
)
"""
_RECORDED = (
    _FALLING
    + """
record = run_record(Scenario("ball.sdf", duration=0.2))
write_golden("golden/ball", record)
"""
)
_SKELETON = '{"format": 1, "scenario": {"world": "ball.sdf"}}'

CODES: tuple[Code, ...] = (
    Code(
        "SK-GOLDEN-001",
        "stop",
        "outputs differ from the golden ones",
        "the report says what differs first and which change lies behind it; "
        "where the change is wanted, `simkit golden check --bless 'REASON'`",
        python(
            _RECORDED
            + """
Path("ball.sdf").write_text(Path("ball.sdf").read_text().replace("0 0 5", "0 0 5.01"))
from simkit.errors import RegressionError

verdict = check_golden("golden/ball")
if not verdict.passed:
    raise RegressionError(verdict.comparison.differences[0].words)
"""
        ),
    ),
    Code(
        "SK-GOLDEN-002",
        "error",
        "there is no golden run in a folder",
        "`simkit golden record WORLD --out DIR` makes one",
        command("simkit golden check golden/nothing"),
    ),
    Code(
        "SK-GOLDEN-003",
        "error",
        "a golden run is damaged, or is none",
        "take it from version control again, or record it anew",
        command("simkit golden check golden/broken", {"golden/broken/golden.json": _SKELETON}),
    ),
    Code(
        "SK-GOLDEN-004",
        "error",
        "a golden run was written by a newer simkit",
        "upgrade simkit",
        command("simkit golden check golden/newer", {"golden/newer/golden.json": '{"format": 99}'}),
    ),
    Code(
        "SK-GOLDEN-005",
        "error",
        "a golden run is there already, or its folder cannot be written",
        "`simkit golden check --bless 'REASON'` changes one and keeps why; `--force` begins anew",
        command("simkit golden record turtlebot3_burger --out golden/old", {"golden/old/golden.json": _SKELETON}),
    ),
    Code(
        "SK-GOLDEN-006",
        "error",
        "a golden run cannot be run again from here: its scenario is not there, or only a test makes its plugins",
        "put the file back, or check it where it was recorded",
        python(
            _FALLING
            + """
import simkit


class Wind(simkit.WorldPlugin):
    def load(self, sim, params):
        pass


write_golden("golden/ball", run_record(Scenario("ball.sdf", duration=0.1, plugins=(Wind(),))))
check_golden("golden/ball")
"""
        ),
    ),
    Code(
        "SK-GOLDEN-007",
        "error",
        "a run is not made golden: no reason is given, it failed, or another renderer drew its pictures",
        "say why what differs is right; bless pictures where everybody else's are drawn",
        python(_RECORDED + 'check_golden("golden/ball", bless=" ")\n'),
    ),
)
