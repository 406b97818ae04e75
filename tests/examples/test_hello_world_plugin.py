"""The hello example greets once when loaded and once a second."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "hello_world_plugin"


def test_it_greets_at_load_and_once_a_second(capsys: pytest.CaptureFixture[str]) -> None:
    with simkit.load(EXAMPLE / "world.sdf", plugin_paths=[EXAMPLE]) as sim:
        assert capsys.readouterr().out == "hello, robots! (t = 0 s)\n"
        sim.run(2.5)
    assert capsys.readouterr().out == "hello, robots! (t = 1 s)\nhello, robots! (t = 2 s)\n"


def test_a_world_file_alone_does_not_run_it(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PLUGIN-001") as refused:
        simkit.load(EXAMPLE / "world.sdf")
    assert "--plugin-path" in refused.value.diagnostics[-1].hint
    assert capsys.readouterr().out == ""
