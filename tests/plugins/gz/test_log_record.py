"""LogRecord of Gazebo as a bag: its path and its contents."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

import simkit
from simkit import msgs
from simkit.errors import LoadError

BODY = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
FILE = 'filename="gz-sim-log-system" name="gz::sim::systems::{}"'


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def world(inner: str = "<record_path>log</record_path>", more: str = "", kind: str = "LogRecord") -> str:
    return f"""<sdf version="1.9"><world name="w"><plugin {FILE.format(kind)}>{inner}</plugin>{more}
    <model name="floor"><static>true</static><link name="l"/></model>
    <model name="ball"><pose>0 0 9 0 0 0</pose><link name="l">{BODY}</link></model></world></sdf>"""


def read(path: str | Path = "log/state.mcap") -> dict[str, list[tuple[int, Any]]]:
    found: dict[str, list[tuple[int, Any]]] = {}
    with open(path, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            content = msgs.deserialize(message.data, schema.name)
            found.setdefault(channel.topic, []).append((message.log_time, content))
    return found


def codes(text: str) -> list[str]:
    with simkit.load(text) as sim:
        sim.run(0.01)
        return [d.code for d in sim.diagnostics if d.code.startswith("SK-PLUGIN")]


def test_world_and_state_are_recorded_from_the_first_step() -> None:
    with simkit.load(world("<record_path>log</record_path><record_period>0.1</record_period>")) as sim:
        assert not Path("log").exists(), "a world that is only loaded writes nothing"
        sim.run(1.0)
        z = sim.model("ball").pose.position[2]
    found = read()
    assert set(found) == {"/log/sdf", "/world/w/changed_state"}
    ((_, sdf),) = found["/log/sdf"]
    assert '<model name="ball"' in sdf.data
    times, states = zip(*found["/world/w/changed_state"], strict=True)
    assert times == tuple(range(0, 1_000_000_001, 100_000_000))
    assert [t.child_frame_id for t in states[0].transforms] == ["floor::l", "ball::l"]
    (last,) = states[-1].transforms
    assert (last.child_frame_id, last.header.frame_id) == ("ball::l", "w"), "only what moved"
    assert last.transform.translation.z == z


def test_without_a_period_every_step_is_recorded() -> None:
    with simkit.load(world()) as sim:
        sim.run(0.05)
    assert len(read()["/world/w/changed_state"]) == 51


def test_topics_by_name_and_by_regular_expression() -> None:
    more = f"<plugin {FILE.format('LogRecord')}/>"
    assert codes(world(more=more)) == ["SK-PLUGIN-127"]
    with simkit.load(world("<record_path>log</record_path><record_topic>/clock</record_topic>")) as sim:
        sim.run(0.05)
    assert "/clock" in read()
    with simkit.load(world("<record_path>log</record_path><record_topic>/(world/.*|tf_.*)</record_topic>")) as sim:
        sim.run(0.3)
    assert {"/world/w/stats", "/tf_static"} & set(read())
    assert "/clock" not in read()
    with pytest.raises(LoadError, match="regular expression"):
        simkit.load(world("<record_path>log</record_path><record_topic>/a(</record_topic>"))


def test_a_log_replaces_an_older_one_and_continues_after_a_reset() -> None:
    for _ in range(2):
        with simkit.load(world("<record_path>log</record_path><record_period>0.1</record_period>")) as sim:
            sim.run(0.2)
            sim.reset()
            sim.run(0.1)
    assert [time for time, _ in read()["/world/w/changed_state"]] == [0, 100_000_000, 200_000_000, 200_000_000]


def test_recording_changes_no_bit_and_two_logs_are_the_same() -> None:
    ends, logs = [], []
    for text in (world(), world(), world("<record_path/>")):
        with simkit.load(text) as sim:
            sim.run(0.2)
            ends.append(sim.mj_data.qpos.tobytes())
        logs.append(Path("log/state.mcap").read_bytes())
    assert len(set(ends)) == 1
    assert logs[0] == logs[1]


def test_it_writes_only_where_the_user_allows(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    place = tmp_path / "elsewhere"
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    text = world(f"<record_path>{place}</record_path>")
    assert codes(text) == codes(world("<record_path>../elsewhere</record_path>")) == ["SK-PLUGIN-127"]
    assert not place.exists()
    monkeypatch.setenv("SIMKIT_SAVE_PATH", str(place))
    assert codes(text) == []
    assert (place / "state.mcap").exists()


def test_a_blocked_path_and_ignored_options_are_reported() -> None:
    Path("log").write_text("not a folder")
    assert codes(world()) == ["SK-PLUGIN-127"]
    unused = "<record_resources>1</record_resources><compress>1</compress><compress_path>x.zip</compress_path>"
    assert codes(world(f"<record_path>other</record_path>{unused}")) == ["SK-PLUGIN-128"]


def test_a_second_recorder_and_a_playback_have_no_effect() -> None:
    more = f"<plugin {FILE.format('LogRecord')}><record_path>two</record_path></plugin>"
    assert codes(world(more=more)) == ["SK-PLUGIN-127"]
    assert not Path("two").exists()
    assert codes(world("<playback_path>log</playback_path>", kind="LogPlayback")) == ["SK-PLUGIN-129"]
