"""`docs/teleop.md`: its commands run, its keys are keys, its robots have the limits it says."""

from __future__ import annotations

import re
import shlex
import sys
from pathlib import Path

import pytest

import simkit
from simkit.bridges.teleop import Teleop, find_target
from simkit.cli.run_parts.keyboard import RunKeys
from simkit.cli.terminal.keyboard import DOWN, LEFT, RIGHT, UP
from simkit.cli.terminal.teleop_display import DriverLine

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "teleop.md").read_text(encoding="utf-8")
COMMANDS = re.findall(r"^```sh\n(simkit run .*)\n```$", PAGE, re.MULTILINE)
ARROWS = {"↑": UP, "↓": DOWN, "←": LEFT, "→": RIGHT, "space": " "}


def test_the_page_has_commands() -> None:
    assert len(COMMANDS) == 4
    assert len(re.findall(r"^```sh$", PAGE, re.MULTILINE)) == 4


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="its terminals are others")
@pytest.mark.parametrize("line", COMMANDS)
def test_a_command_of_the_page_runs(line: str, tmp_path: Path) -> None:
    from tests.cli.terminals import Terminal

    words = shlex.split(line)[1:]
    with Terminal(sys.executable, "-m", "simkit", *words, cwd=tmp_path) as terminal:
        if "--teleop" in words:
            terminal.wait_for(r"requested 0\.00 m/s, 0\.00 rad/s")
            terminal.press("wa")
            terminal.wait_for(r"0\.0[15] m/s, 0\.10 rad/s")
        else:
            terminal.wait_for("paused at t=0.2 s: space resumes, n advances one step, Ctrl-C ends")
        terminal.press("\x03")
        assert terminal.wait() == 130
    assert ("--record" not in words) or (tmp_path / "drive.mcap").stat().st_size > 0


def test_every_key_of_the_page_does_something() -> None:
    table = PAGE[PAGE.index("| key |") : PAGE.index("During the run, the terminal")]
    keys = [key for row in table.splitlines()[2:-2] for key in re.findall(r"`(.)`|\b(space)\b", row.split("|")[1])]
    names = [ARROWS.get(one or other, one or other) for one, other in keys]
    assert len(names) == 18
    with simkit.load("turtlebot3_empty") as sim:
        teleop = Teleop(sim, find_target(sim))
        for name in names:
            teleop.speeds = (0.05, 0.0, 0.2)
            if sim.paused:
                sim.paused = False
            RunKeys(sim, _Hands(), teleop).press(name)
            assert teleop.speeds != (0.05, 0.0, 0.2) or sim.control.pausing.until is not None or name in "jl"


def test_the_lines_are_those_of_the_page() -> None:
    shown = re.search(r"```text\nt = .*\n(.*)\n(.*)\n(.*)\n(.*)\n```", PAGE)
    assert shown is not None
    with simkit.load("turtlebot3_world") as sim:
        line = DriverLine(sim, Teleop(sim, find_target(sim)))
        sim.run(0.5)
        found = line.lines()
    numbers = re.compile(r"-?\d+(\.\d+)?")
    assert [re.sub(r"(right|left)$", "side", numbers.sub("0", text)) for text in found] == [
        re.sub(r"(right|left)$", "side", numbers.sub("0", text)) for text in shown.groups()
    ]


@pytest.mark.parametrize(
    ("robot", "row"),
    [
        ("turtlebot3_burger", r"burger \| `/cmd_vel` \| 0\.22 m/s, 2\.84 rad/s \| 0\.01 m/s"),
        ("turtlebot3_waffle", r"waffle_pi \| `/cmd_vel` \| 0\.26 m/s, 1\.82 rad/s \| 0\.01 m/s"),
        ("turtlebot3_waffle_pi", r"waffle_pi \| `/cmd_vel` \| 0\.26 m/s, 1\.82 rad/s \| 0\.01 m/s"),
        ("tiago", r"PMB2 \| `/mobile_base_controller/cmd_vel` \| −0\.2 to 1 m/s, 2\.09 rad/s \| 0\.05 m/s"),
        ("pmb2", r"PMB2 \| `/mobile_base_controller/cmd_vel` \| −0\.2 to 1 m/s, 2\.09 rad/s \| 0\.05 m/s"),
    ],
)
def test_a_robot_has_the_limits_of_the_page(robot: str, row: str) -> None:
    assert re.search(row, PAGE)
    with simkit.load(robot) as sim:
        target = find_target(sim)
        assert f"`{target.topic}`" in row
        assert re.search(rf"{target.linear[1]:g} m/s, {target.angular[1]:g} rad/s".replace(".", r"\\?\."), row)
        assert f"{target.linear_step:g}".replace(".", r"\.") in row


class _Hands:
    """Nobody's."""

    is_lost = False

    def read(self) -> list[str]:
        return []
