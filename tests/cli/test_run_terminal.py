"""`simkit run` on a terminal, with its keys: through a real one, and through a shell that stops and resumes it."""

from __future__ import annotations

import errno
import math
import os
import re
import shutil
import signal
import struct
import sys
from pathlib import Path
from typing import Any

import pytest
import typer
from mcap.reader import make_reader
from typer.main import get_command
from typer.testing import CliRunner

import simkit.live
from simkit.cli import app
from simkit.cli.run import highest_pace
from simkit.cli.terminal.json_report import report_errors

if sys.platform == "win32":
    pytest.skip("its terminals are others", allow_module_level=True)

from tests.cli.terminals import Terminal

pytestmark = pytest.mark.slow  # a process each, some of them a shell's

STYLE = r"\x1b\[[\d;]*m"
SLED = """
<sdf version="1.9"><world name="w"><model name="sled"><pose>0 0 1 0 0 0</pose><link name="base"/>
  <plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/>
</model></world></sdf>
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "sled.sdf").write_text(SLED)
    return tmp_path


def run(folder: Path, *options: object, **more: object) -> Terminal:
    command = (sys.executable, "-m", "simkit", "run", "sled.sdf", *options)
    return Terminal(*command, cwd=folder, **more)  # type: ignore[arg-type]


def shell(folder: Path) -> Terminal:
    """A shell, in which `run` is `simkit run sled.sdf`."""
    if shutil.which("bash") is None:
        pytest.skip("no bash")
    terminal = Terminal("bash", "--norc", "--noprofile", "-i", cwd=folder, environment={"PS1": "$ "})
    terminal.wait_for(r"\$ ")
    terminal.press(f"run() {{ '{sys.executable}' -m simkit run sled.sdf --duration 1000000 \"$@\"; }}; echo rea''dy\n")
    terminal.wait_for("ready")
    return terminal


def moving(terminal: Terminal) -> float:
    """A simulated time that the run shows from now on [s]."""
    terminal.seen = ""
    return float(terminal.wait_for(r"t = ([\d.]+) of")[1])


def state(text: str) -> str:
    found = re.search(r"state ([0-9a-f]{64})", text)
    assert found is not None, text
    return found[1]


# ---------------------------------------------------------------------- driving


def test_a_drive_by_keys_has_the_bits_of_the_same_drive_by_a_script(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with run(folder, "--teleop", "--paused", "--duration", 2, "--rtf", "inf", "--key-timeout", 1.5) as terminal:
        terminal.wait_for("paused at t=0 s: space resumes")
        assert not terminal.shows_keys()
        terminal.press("www\x1b[D")
        terminal.wait_for(r"requested 0\.15 m/s, 0\.00 m/s left, 0\.10 rad/s")
        terminal.press(" ")
        assert terminal.wait() == 0
        assert terminal.shows_keys()
        driven = state(terminal.seen)
        assert re.search(r"/model/sled/cmd_vel +16 ", terminal.seen)  # 15 and the stop after 1.5 s
    monkeypatch.chdir(folder)
    Path("drive.yaml").write_text(
        "- {at: 0.0, until: 1.4, rate: 10, topic: /model/sled/cmd_vel, "
        "message: {linear: {x: 0.15}, angular: {z: 0.1}}}\n- {at: 1.5, topic: /model/sled/cmd_vel, message: {}}\n"
    )
    result = CliRunner().invoke(app, ["run", "sled.sdf", "--duration", "2", "--script", "drive.yaml"])
    assert state(result.stdout) == driven


def test_space_resumes_and_n_steps_a_run_that_its_options_pause(folder: Path) -> None:
    with run(folder, "--step", 7, "--duration", 1) as terminal:
        terminal.wait_for(r"paused at t=0\.007 s: space resumes, n advances one step")
        terminal.press("n.")
        terminal.wait_for(r"t = 0\.009 of 1 s.*paused")
        terminal.press(" ")
        assert terminal.wait() == 0
        assert "simulated 1.000 s" in terminal.seen


def test_keys_typed_during_a_run_do_not_pause_it_and_are_there_after_it(folder: Path) -> None:
    with run(folder, "--duration", 2, "--rtf", 1) as terminal:
        terminal.wait_for("t = ")
        assert terminal.shows_keys()
        terminal.press(" n ls\n")
        assert terminal.wait() == 0
        assert "paused" not in terminal.seen
        assert "simulated 2.000 s" in terminal.seen
        assert os.read(terminal.near, 100) == b" n ls\n"


def test_a_run_that_a_service_paused_has_no_keys_and_says_so(folder: Path, place: Path) -> None:
    with run(folder, "--duration", 1000) as terminal:
        terminal.wait_for("t = ")
        with simkit.live.connect() as client:
            assert client.call("/world/w/control", {"world_control": {"pause": True}}).success
            terminal.wait_for(r"paused at t=[\d.]+ s until a service resumes it \(Ctrl-C ends\)")
            terminal.press("   \n")
            terminal.wait_for("paused")
            assert client.state()["paused"]
            assert client.state()["tick"] == client.state()["tick"]
            assert client.call("/world/w/control", {"world_control": {"pause": False}}).success
        moving(terminal)
        terminal.press("\x03")
        assert terminal.wait() == 130


@pytest.mark.parametrize(
    ("environment", "unwanted"),
    [({"NO_COLOR": "1"}, STYLE), ({"NO_COLOR": "1", "FORCE_COLOR": "1"}, STYLE), ({"TERM": "dumb"}, "\x1b")],
)
def test_no_color_and_a_dumb_terminal_get_no_styles(folder: Path, environment: dict[str, str], unwanted: str) -> None:
    (folder / "bad.sdf").write_text('<sdf version="1.9"><world name="w"><model name="m"><lnk/></model></world></sdf>')
    with run(folder, "--duration", 1, "--rtf", 1, "--assert", "1 > 2", environment=environment) as terminal:
        assert terminal.wait() == 5
        assert "FAILED" in terminal.seen
        assert re.findall(unwanted, terminal.seen) == []
    command = (sys.executable, "-m", "simkit", "check", "bad.sdf")
    with Terminal(*command, cwd=folder, environment=environment) as terminal:
        terminal.wait()
        assert "SK-" in terminal.seen
        assert re.findall(unwanted, terminal.seen) == []


def test_ctrl_c_ends_a_drive_and_leaves_the_terminal_as_it_was(folder: Path) -> None:
    with run(folder, "--teleop", "--record", "out.mcap") as terminal:
        terminal.press("ww")
        terminal.wait_for(r"requested 0\.10 m/s")
        terminal.press("\x03")
        assert terminal.wait() == 130
        assert terminal.shows_keys()
        assert "messages read; " in terminal.seen


def test_ctrl_c_ends_a_run_at_once_however_slow_it_is(folder: Path) -> None:
    with run(folder, "--rtf", 0.001) as terminal:
        terminal.wait_for("running until Ctrl-C")
        terminal.wait_for("t = ")
        terminal.press("\x03")
        assert terminal.wait() == 130


def test_a_narrow_window_cuts_the_line_and_one_that_grows_shows_it_again(folder: Path) -> None:
    with run(folder, "--teleop", "--paused", size=(10, 30)) as terminal:
        terminal.wait_for(r"requested 0\.00 m/s, 0\.00 .{0,6}…")
        terminal.resize(24, 150)
        terminal.wait_for("Ctrl-C ends")
        terminal.press("\x03")
        assert terminal.wait() == 130


def test_without_a_terminal_teleop_is_refused_and_a_run_is_not(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    refused = CliRunner().invoke(app, ["run", "sled.sdf", "--teleop"], input="wwww")
    assert refused.exit_code == 2
    assert "SK-CLI-050" in refused.stderr
    piped = CliRunner().invoke(app, ["run", "sled.sdf", "--duration", "0.1"], input="   nnn")
    assert piped.exit_code == 0
    assert "simulated 0.100 s" in piped.stdout


@pytest.mark.parametrize(
    ("words", "topic"),
    [
        (["--teleop", "sled.sdf"], ""),
        (["sled.sdf", "--teleop"], ""),
        (["sled.sdf", "--teleop", "/model/sled/cmd_vel"], "/model/sled/cmd_vel"),
        (["sled.sdf", "--teleop=model/sled/cmd_vel"], "model/sled/cmd_vel"),
        (["--teleop", "/a/cmd_vel", "sled.sdf"], "/a/cmd_vel"),
        (["--teleop", "FOLDER/sled.sdf"], ""),
    ],
)
def test_the_topic_of_teleop_is_optional_at_every_position(words: list[str], topic: str, folder: Path) -> None:
    command: Any = get_command(app)
    words = [word.replace("FOLDER", str(folder)) for word in words]
    given = command.commands["run"].make_context("run", words).params
    assert given["teleop"] == topic
    assert given["world"].endswith("sled.sdf")


def test_teleop_and_viewer_default_to_real_time() -> None:
    assert highest_pace(None, is_watched=False) is None
    assert highest_pace(None, is_watched=True) == 1.0
    assert highest_pace(3.0, is_watched=True) == 3.0
    assert highest_pace(math.inf, is_watched=True) is None


# ---------------------------------------------------------------------- a shell


def test_ctrl_z_gives_the_terminal_back_and_fg_takes_it_again(folder: Path) -> None:
    with shell(folder) as terminal:
        terminal.press("run --teleop\n")
        terminal.wait_for("requested 0.00")
        terminal.press("w")
        terminal.wait_for(r"requested 0\.05 m/s")
        terminal.press("\x1a")
        terminal.wait_for("Stopped")
        terminal.wait_for(r"\$ ")
        terminal.press("echo still a sh''ell; fg\n")
        terminal.wait_for("still a shell")
        moving(terminal)
        assert not terminal.shows_keys()
        terminal.press("w")
        terminal.wait_for(r"requested 0\.10 m/s")
        terminal.press("\x03")
        terminal.wait_for("simulated ")
        terminal.wait_for(r"\$ ")


def test_a_run_in_the_background_leaves_the_terminal_alone_until_it_is_in_front(folder: Path) -> None:
    with shell(folder) as terminal:
        terminal.press("run --quiet >out.txt 2>&1 &\n")
        terminal.wait_for(r"\[1\] \d+")
        terminal.press("run --teleop --rtf 1 &\n")
        terminal.wait_for(r"\[2\] \d+")
        moving(terminal)
        moving(terminal)
        terminal.press("   echo not st''opped; jobs\n")
        terminal.wait_for("not stopped")
        terminal.wait_for(r"\[1\][ -]+Running")
        terminal.wait_for(r"\[2\][ +]+Running")
        terminal.press("fg %2\n")
        moving(terminal)
        moving(terminal)
        terminal.press("ww")
        terminal.wait_for(r"requested 0\.10 m/s")
        terminal.press("\x03")
        terminal.wait_for("simulated ")
        terminal.wait_for(r"\$ ")  # what is typed before belongs to the drive, and goes with it
        terminal.press("kill %1; wait; echo none is le''ft\n")
        terminal.wait_for("none is left")


def test_after_sigkill_the_shell_restores_its_terminal(folder: Path) -> None:
    with shell(folder) as terminal:
        terminal.press("run --teleop\n")
        terminal.wait_for("requested 0.00")
        terminal.press("w")
        terminal.wait_for("requested 0.05")
        found = os.tcgetpgrp(terminal.far)
        os.kill(found, signal.SIGKILL)
        terminal.wait_for("Killed")
        terminal.press("echo seen a''gain\n")
        terminal.wait_for("seen again")


def test_a_pager_has_the_keys_of_its_terminal_for_itself(folder: Path) -> None:
    with shell(folder) as terminal:
        terminal.press("run --paused | { read -r key </dev/tty; echo go''t $key; }\n")
        terminal.wait_for("paused at t=0 s until a service resumes it")
        terminal.press("   nnn x\n")
        terminal.wait_for("got nnn x")
        terminal.press("\x03")


def test_a_run_that_is_to_outlive_its_terminal_goes_on_with_the_robot_standing(folder: Path) -> None:
    line = f"trap '' HUP; exec '{sys.executable}' -m simkit run sled.sdf --teleop --duration 2 --record out.mcap"
    terminal = Terminal("sh", "-c", line, cwd=folder)
    terminal.press("ww")
    terminal.wait_for(r"requested 0\.10 m/s")
    os.close(terminal.near)
    os.close(terminal.far)
    assert terminal.process.wait(60) == 0
    with (folder / "out.mcap").open("rb") as stream:
        sent = [m.data for _, c, m in make_reader(stream).iter_messages(["/model/sled/cmd_vel"]) if c.topic]
    speeds = [struct.unpack_from("<d", data, 4)[0] for data in sent]
    assert speeds[-1] == 0.0
    assert max(speeds) == 0.1
    assert speeds.count(0.0) <= 2  # the stop, and a command before the first key at most


def test_a_run_whose_terminal_is_closed_ends_with_its_recording_whole(folder: Path) -> None:
    terminal = run(folder, "--teleop", "--record", "out.mcap")
    terminal.press("ww")
    terminal.wait_for(r"requested 0\.10 m/s")
    os.close(terminal.near)
    os.close(terminal.far)
    assert terminal.process.wait(60) == 128 + signal.SIGHUP
    checked = CliRunner().invoke(app, ["bag", "recover", str(folder / "out.mcap"), str(folder / "mended.mcap")])
    assert "the bag was complete" in checked.stdout + checked.stderr


def test_a_terminal_that_is_seen_to_be_gone_before_its_signal_comes_ends_as_by_the_signal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def write() -> None:
        raise OSError(errno.EIO, "no such terminal")

    near, far = os.openpty()
    kept = os.dup(1)
    for handler, code in ((signal.SIG_DFL, 128 + signal.SIGHUP), (signal.SIG_IGN, 0)):
        before = signal.signal(signal.SIGHUP, handler)
        os.dup2(far, 1)
        try:
            with monkeypatch.context() as patch:
                patch.setattr(sys, "stdout", sys.stdout)
                patch.setattr(sys, "stderr", sys.stderr)
                with pytest.raises(typer.Exit) as ended:
                    report_errors(write)()
        finally:
            os.dup2(kept, 1)
            signal.signal(signal.SIGHUP, before)
        assert ended.value.exit_code == code
    for handle in (near, far, kept):
        os.close(handle)


def test_an_error_of_the_disk_is_not_taken_for_a_closed_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    def read() -> None:
        raise OSError(errno.EIO, "Input/output error", "w.sdf")

    with pytest.raises(typer.Exit) as ended:
        report_errors(read)()
    assert ended.value.exit_code == 2
    assert "SK-CLI-016 cannot read or write w.sdf: Input/output error" in capsys.readouterr().err
