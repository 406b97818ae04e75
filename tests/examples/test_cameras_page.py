"""What `docs/cameras.md` tells to type works as it stands there."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from PIL import Image
from typer.testing import CliRunner

from simkit.cli import app

PAGE = Path(__file__).resolve().parents[2] / "docs" / "cameras.md"


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def blocks(language: str) -> list[str]:
    return re.findall(rf"```{language}\n(.*?)```", PAGE.read_text(encoding="utf-8"), flags=re.DOTALL)


def test_its_python_runs_from_top_to_bottom(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    names: dict[str, object] = {}
    for text in blocks("python"):
        exec(compile(text, str(PAGE), "exec"), names)
    with Image.open(tmp_path / "camera.png") as image:
        assert image.size == (320, 240)
        blue_ball = np.asarray(image)[110:140, 85:125].reshape(-1, 3).mean(axis=0)
        assert blue_ball[2] > 2 * blue_ball[0], "red and blue are where they belong"
    assert re.search(r"320 240 rgb8", out := capsys.readouterr().out)
    assert re.search(r"0\.\d\d m to \d\.\d\d m", out)


def test_its_second_command_records(tmp_path: Path) -> None:
    """Of the shorter of the two recordings, for less long."""
    _, command = blocks("sh")[0].strip().splitlines()
    words = shlex.split(command)[1:]
    words[words.index("--duration") + 1] = "0.3"
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    with open(tmp_path / "small.mcap", "rb") as file:
        topics = {c.topic for c in make_reader(file).get_summary().channels.values()}
    assert {"/rover/camera/image", "/rover/rgbd/depth_image", "/rover/imu"} <= topics
    assert [t for t in topics if t.startswith("/rail/") or t.endswith("/points")] == []
