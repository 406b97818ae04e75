"""Lines in files and pipes have the characters that rich writes, and need no rich."""

from __future__ import annotations

import subprocess
import sys

import pytest

from simkit.cli.terminal.output import _console, print_diagnostics, stderr_console, stdout_console
from simkit.cli.terminal.plain_console import PlainConsole
from simkit.diagnostics import Diagnostic, Diagnostics, Where

TEXTS = (
    "",
    "a line",
    "[bold]no markup[/bold] :smile: 12.5 'text'",
    "two\nlines\n",
    "\n\nlines without text \n ",
    "a\ttab",
    "\x1b[31mcolour\x07\r\n\x9b \u202e",
    "ü × → 部品 " * 60,
    "x" * 70_000,
)


@pytest.fixture(autouse=True)
def _consoles_of_this_test(monkeypatch):
    for name in ("FORCE_COLOR", "TTY_COMPATIBLE", "TTY_INTERACTIVE"):
        monkeypatch.delenv(name, raising=False)
    stdout_console.cache_clear()
    stderr_console.cache_clear()
    yield
    stdout_console.cache_clear()
    stderr_console.cache_clear()


@pytest.mark.parametrize("text", TEXTS)
@pytest.mark.parametrize("options", [{}, {"style": "bold red"}])
def test_a_text_has_the_characters_that_rich_writes(capsys, text, options):
    assert isinstance(stdout_console(), PlainConsole)
    stdout_console().print(text, **options)
    plain = capsys.readouterr().out
    _console(is_error=False).print(text, **options)
    assert plain == capsys.readouterr().out


def test_diagnostics_have_the_characters_that_rich_writes(capsys):
    found = Diagnostics()
    for line in (3, 4):
        found.error("SK-SDF-011", "no element <mas> \x1b[1m", Where("w.sdf", line), "did you mean\r <mass>?")
    found.warning("SK-SDF-016", "a\ttab")
    found.note("SK-PHYS-002", "a note")
    items: list[Diagnostic] = [*found]
    print_diagnostics(items, verbose=False)
    plain = capsys.readouterr().err
    print_diagnostics(items, verbose=False, console=_console(is_error=True))
    assert plain == capsys.readouterr().err
    assert plain.splitlines()[2] == "    also at :4"


def test_a_variable_that_forces_colours_brings_them_to_a_pipe(capsys, monkeypatch):
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    stdout_console().print("red", style="red")
    assert capsys.readouterr().out == "\x1b[31mred\x1b[0m\n"


@pytest.mark.parametrize("world", ["empty", "turtlebot3_world"])
def test_a_run_in_a_pipe_imports_neither_rich_nor_the_types_of_messages(world):
    code = (
        f"import sys; from simkit.cli import main; sys.argv = ['simkit', 'run', '{world}', '--duration', '0.1']\n"
        "try: main()\n"
        "finally: print(sorted({'rich', 'numpy.ma', 'rosbags.typesys.stores.ros2_jazzy'} & set(sys.modules)))"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.splitlines()[-1] == "[]"
