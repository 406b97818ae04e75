"""Options of `simkit view` that would have no effect, how a browser is opened, and a viewer without a display."""

from __future__ import annotations

import stat
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

import simkit
from simkit.cli.commands import app
from simkit.recording import Recorder
from simkit_view.cli.run_parts.page import show_address


@pytest.mark.parametrize(
    "options, names",
    [
        (["--set", "a=1"], "--set would"),
        (["--spawn", "tiago"], "--spawn would"),
        (["--html", "o.html", "--port", "80", "--host", "0.0.0.0"], "--port, --host would"),
        (["--html", "o.html", "--no-open"], "--no-open would"),
    ],
)
def test_an_option_that_has_no_effect_on_a_bag_is_an_error(tmp_path: Path, options: list[str], names: str) -> None:
    with simkit.load("<sdf version='1.9'><world name='w'/></sdf>") as sim, Recorder(sim, tmp_path / "a.mcap"):
        sim.run(0.01)
    found = CliRunner().invoke(app, ["view", str(tmp_path / "a.mcap"), *options])
    assert found.exit_code == 2
    assert f"{names} have no effect" in " ".join(found.stderr.split())


def test_the_token_is_not_an_argument_of_the_browser(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    monkeypatch.setenv("DISPLAY", ":0")
    show_address("http://127.0.0.1:1/?token=secret", opens=True)
    (address,) = opened
    assert address.startswith("file://") and "secret" not in address
    path = Path(address.removeprefix("file://"))
    assert "url=http://127.0.0.1:1/?token=secret" in path.read_text(encoding="utf-8")
    assert stat.S_IMODE(path.stat().st_mode) == 0o600
    path.unlink()


def test_a_viewer_without_a_display_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if not sys.platform.startswith("linux"):
        pytest.skip("displays are told by a variable on Linux only")
    monkeypatch.delenv("DISPLAY", raising=False)
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    (tmp_path / "w.sdf").write_text("<sdf version='1.9'><world name='w'/></sdf>")
    result = CliRunner().invoke(app, ["run", str(tmp_path / "w.sdf"), "--duration", "1", "--view"])
    assert result.exit_code == 2
    assert "SK-CLI-015" in result.stderr
