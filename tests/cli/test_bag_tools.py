"""`simkit plot`, `simkit bag plot`, `simkit bag export`, `simkit run --play`, and recordings that were cut off."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from simkit import msgs
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.writer import McapBag

STATE = re.compile(r"^state ([0-9a-f]{64})$", re.MULTILINE)
SCRIPT = """
- {at: 0.0, topic: /cmd_vel, message: {linear: {x: 0.4}}}
- {at: 0.301, until: 0.7, rate: 9, topic: /cmd_vel, message: {linear: {x: 0.2}, angular: {z: 1.0}}}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory, yard_world: str, simkit_line: Any) -> Path:
    """A world, a script, and the recording of a run of both."""
    folder = tmp_path_factory.mktemp("tools")
    (folder / "yard.sdf").write_text(yard_world, encoding="utf-8")
    (folder / "drive.yaml").write_text(SCRIPT, encoding="utf-8")
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.chdir(folder)
        words = ("--duration", "1", "--script", "drive.yaml", "--record", "drive.mcap", "--name", "tools", "-q")
        done = simkit_line("run", "yard.sdf", *words)
    (folder / "state").write_text(STATE.search(done.stdout)[1], encoding="utf-8")  # type: ignore[index]
    return folder


@pytest.fixture
def here(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(folder)
    return folder


def test_a_bag_and_the_world_that_it_was_recorded_of_are_one_line(here: Path, simkit_line: Any) -> None:
    words = ("/odom.pose.pose.position.x", "/odom.pose.pose.yaw", "--duration", "1", "--script", "drive.yaml")
    done = simkit_line("plot", "drive.mcap", "yard.sdf", *words, "-o", "both.svg", "--json")
    assert done.exit_code == 0, done.stderr
    rows = json.loads(done.stdout)["curves"]
    assert [r["label"].partition(":")[0] for r in rows] == ["drive", "yard", "drive", "yard"]
    for one, other in (rows[:2], rows[2:]):
        assert {k: v for k, v in one.items() if k != "label"} == {k: v for k, v in other.items() if k != "label"}
        assert one["last"] > 0.2
    ElementTree.parse("both.svg")


def test_a_path_is_drawn_from_above(here: Path, simkit_line: Any) -> None:
    words = ("/odom.pose.pose.position.y", "--against", "/odom.pose.pose.position.x", "--start", "0.2", "-o", "p.png")
    done = simkit_line("bag", "plot", "drive.mcap", *words)
    assert done.exit_code == 0 and "p.png: 1 curve\n" in done.stdout
    assert Path("p.png").read_bytes()[:4] == b"\x89PNG"


def test_expressions_of_conditions_are_curves_beside_fields(here: Path, simkit_line: Any) -> None:
    fields = ("distance('rover', (0, 0, 0))", "/odom.pose.pose.position.x")
    line = ("plot", "yard.sdf", *fields, "topic('/odom').pose.pose.position.x", "not (time > 0.5)")
    done = simkit_line(*line, "--duration", "1", "--script", "drive.yaml", "-o", "e.svg", "--json")
    assert done.exit_code == 0, done.stderr
    distance, field, same, late = json.loads(done.stdout)["curves"]
    assert [row["label"] for row in (distance, field)] == list(fields)
    assert (distance["unit"], field["unit"], same["unit"], late["unit"]) == ("m", "m", "", "")
    assert distance["count"] == 501  # the start, and each step of 2 ms
    assert same["last"] == field["last"] > 0.2
    assert (late["min"], late["max"], late["mean"]) == (0.0, 1.0, pytest.approx(0.5, abs=0.001))


def test_all_expressions_that_cannot_be_plotted_are_named_before_the_run(here: Path, simkit_line: Any) -> None:
    done = simkit_line("plot", "yard.sdf", "pose('rovr').x", "pose('rover')", "--duration", "1")
    assert done.exit_code == 2
    assert "SK-COND-005" in done.stderr and "did you mean 'rover'" in done.stderr
    assert "the plotted value is a pose, but must be a number, or true or false" in done.stderr


def test_expressions_of_a_bag_are_refused_with_its_topics(here: Path, simkit_line: Any) -> None:
    done = simkit_line("plot", "drive.mcap", "pose('rover').x", "distance('rover', 'a')")
    assert done.exit_code == 2
    assert "SK-BAG-010 pose('rover').x, distance('rover', 'a'): " in done.stderr and "/odom" in done.stderr


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (("plot", "drive.mcap"), "SK-BAG-011"),
        (("plot", "drive.mcap", "/odom.pose.pose.position.q"), "SK-CLI-033"),
        (("plot", "drive.mcap", "/odm.pose"), "SK-CLI-030"),
        (("plot", "drive.mcap", "/odom.child_frame_id"), "SK-BAG-010"),
        (("plot", "drive.mcap", "/odom.pose.pose.yaw", "--start", "5"), "SK-BAG-011"),
        (("plot", "drive.mcap", "/odom.pose.pose.yaw", "-o", "x.pdf"), "SK-BAG-012"),
        (("plot", "drive.mcap", "/odom.pose.pose.yaw", "--against", "/odom.pose.pose.position"), "SK-BAG-010"),
        (("plot", "yrd.sdf", "/odom.pose.pose.yaw"), "SK-LOAD-002"),
        (("bag", "plot", "yard.sdf", "/odom.pose.pose.yaw"), "SK-CLI-035"),
        (("bag", "export", "drive.mcap", "--format", "xls"), "SK-CLI-018"),
        (("bag", "export", "nothing.mcap"), "SK-CLI-035"),
        (("bag", "export", "drive.mcap", "-o", "yard.sdf"), "SK-BAG-013"),
        (("run", "yard.sdf", "--play", "nothing.mcap"), "SK-CLI-035"),
        (("run", "yard.sdf", "--play-topic", "/cmd_vel"), "SK-CLI-018"),
        (("run", "yard.sdf", "--play", "drive.mcap", "--play-topic", "/odom"), "SK-CLI-030"),
    ],
)
def test_impossible_requests_are_reported(words: tuple[str, ...], code: str, here: Path, simkit_line: Any) -> None:
    before = sorted(here.iterdir())
    done = simkit_line(*words)
    assert done.exit_code == 2 and code in done.stderr
    assert sorted(here.iterdir()) == before


def test_an_export_prints_the_written_files(here: Path, simkit_line: Any) -> None:
    done = simkit_line("bag", "export", "drive.mcap", "--topic", "/imu", "--topic", "/odom")
    assert done.exit_code == 0 and done.stdout.endswith("drive_export: 101 messages of 2 topics\n")
    assert {p.name for p in (here / "drive_export").iterdir()} == {"imu.csv", "odom.csv", "index.json"}
    again = simkit_line("bag", "export", "drive.mcap", "--topic", "/imu", "--force", "--json", "--format", "npz")
    assert json.loads(again.stdout)["topics"][0]["count"] == 51


def test_a_recording_is_played_to_the_same_hash(here: Path, simkit_line: Any) -> None:
    done = simkit_line("run", "yard.sdf", "--play", "drive.mcap", "--name", "tools")
    assert "playing /cmd_vel of drive.mcap" in done.stderr
    assert STATE.search(done.stdout)[1] == (here / "state").read_text(encoding="utf-8")  # type: ignore[index]


def test_an_empty_bag_is_reported(here: Path, simkit_line: Any) -> None:
    McapBag(here / "empty.mcap").close()
    try:
        for words in (("bag", "plot", "empty.mcap", "/odom.pose.pose.yaw"), ("bag", "export", "empty.mcap")):
            done = simkit_line(*words)
            assert done.exit_code == 2 and re.search(r"SK-(CLI-03[05]|BAG-011)", done.stderr)
        assert simkit_line("bag", "info", "empty.mcap").exit_code == 0
    finally:
        (here / "empty.mcap").unlink()


def test_of_several_types_on_one_topic_the_more_frequent_is_drawn(here: Path, tmp_path: Path, simkit_line: Any) -> None:
    bag = McapBag(tmp_path / "mixed.mcap")
    for k, kind in enumerate(("Float64", "String", "Float64")):
        message = msgs.make(f"std_msgs/msg/{kind}", data=f"{k}" if kind == "String" else float(k))
        channel = bag.channel("/x", msgs.type_name(message), latched=False)
        bag.write_raw(channel, msgs.serialize(message), k)
    bag.close()
    done = simkit_line("plot", str(tmp_path / "mixed.mcap"), "/x", "-o", str(tmp_path / "x.svg"), "--json")
    assert "also has messages of type std_msgs/msg/String" in done.stderr
    assert json.loads(done.stdout)["curves"][0]["max"] == 2.0
    out = str(tmp_path / "out")
    found = json.loads(simkit_line("bag", "export", str(tmp_path / "mixed.mcap"), "-o", out, "--json").stdout)
    assert [(t["file"], t["count"]) for t in found["topics"]] == [("x.csv", 2), ("x_2.csv", 1)]


@pytest.mark.skipif(os.name == "nt", reason="no such signals there")
@pytest.mark.parametrize("name", ["run.mcap", "run"])
def test_a_run_that_is_killed_leaves_a_recording_that_every_tool_reads(
    name: str, here: Path, tmp_path: Path, simkit_line: Any
) -> None:
    target = tmp_path / name
    words = ["run", "yard.sdf", "--record", str(target), "--name", "killed", "--cmd-vel", "0.2,0.1", "-q"]
    main = "from simkit.cli import main; main()"
    with subprocess.Popen([sys.executable, "-c", main, *words], stderr=subprocess.DEVNULL) as running:
        file = target if target.suffix else target / "run_0.mcap"
        give_up = time.monotonic() + 60
        while not (file.is_file() and file.stat().st_size > 60_000):
            assert running.poll() is None and time.monotonic() < give_up
            time.sleep(0.01)
        running.send_signal(signal.SIGKILL)
    with open_bag_to_read(target) as bag:
        times = [m.time_ns for m in bag.messages(["/imu"])]
        assert "simkit bag recover" in bag.broken
        assert len(times) > 40 and all(0 < b - a <= 20_000_000 for a, b in pairwise(times))
    out = tmp_path / "out"
    assert simkit_line("bag", "export", str(target), "-o", str(out)).exit_code == 0
    assert len((out / "imu.csv").read_text(encoding="utf-8").splitlines()) == len(times) + 1
    plotted = simkit_line("plot", str(target), "/odom.pose.pose.position.x", "-o", str(tmp_path / "p.svg"))
    assert plotted.exit_code == 0 and "cut off" in plotted.stderr
    mended = tmp_path / ("mended.mcap" if target.suffix else "mended")
    assert simkit_line("bag", "recover", str(target), "-o", str(mended)).exit_code == 0
    with open_bag_to_read(mended) as bag:
        assert not bag.broken and [m.time_ns for m in bag.messages(["/imu"])] == times
