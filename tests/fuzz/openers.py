"""Opens a broken input as a command or a reader would, inside the worker, and judges what became of it."""

from __future__ import annotations

import contextlib
import io
import os
import re
import sys
import traceback
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

EXIT_CODES = (0, 2, 3, 5)  # done, refused, diverged (as the input asks for), a check failed
CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")
LONGEST = 20_000  # characters of an error
SHORTEST_RUN = 0.05  # [s] of simulated time that a scenario runs


class Watch:
    """Audit hook that notes files written outside a folder, network connections and code that comes with an input.

    Args:
        top: folder that may be written to.
    """

    def __init__(self, top: Path) -> None:
        self._top, self._is_on = str(top.resolve()), False
        self.found: list[str] = []
        sys.addaudithook(self._hear)

    @contextlib.contextmanager
    def on(self) -> Any:
        self.found.clear()
        self._is_on = True
        try:
            yield
        finally:
            self._is_on = False

    def _hear(self, event: str, values: tuple[Any, ...]) -> None:
        if not self._is_on:
            return
        if event == "open":
            path, mode, flags = values
            writes = (isinstance(mode, str) and set(mode) & set("wax+")) or (flags or 0) & (
                os.O_WRONLY | os.O_RDWR | os.O_CREAT
            )
            if writes and isinstance(path, (str, bytes)):
                self._written(path)
        elif event in (
            "os.mkdir",
            "os.remove",
            "os.rmdir",
            "os.rename",
            "os.link",
            "os.symlink",
            "os.truncate",
            "shutil.rmtree",
        ):
            self._written(values[0])
        elif event == "socket.connect" and isinstance(values[1], tuple):
            self.found.append(f"connects to {values[1]}")
        elif event in ("os.system", "os.exec", "os.posix_spawn"):
            self.found.append(f"{event} {values[0]!r}")
        elif event == "exec" and getattr(values[0], "co_filename", "").startswith(self._top):
            self.found.append(f"runs {values[0].co_filename}")

    def _written(self, path: Any) -> None:
        # links are not followed: what matters is the path that was given
        place = (
            os.path.abspath(  # noqa: PTH100
                os.fsdecode(path)
            )
            if isinstance(path, (str, bytes, os.PathLike))
            else ""
        )
        if place and not place.startswith((self._top, "/dev/", "/proc/")) and "__pycache__" not in place:
            self.found.append(f"writes {place}")


def opened(arguments: Sequence[str], folder: Path, watch: Watch) -> dict[str, str]:
    """What became of a command line, or of a reader (`*NAME`), in a folder."""
    with contextlib.chdir(folder), watch.on():
        if arguments[0] == "*command":
            answer = _command(given_arguments(folder / arguments[1]))
        elif arguments[0].startswith("*"):
            answer = _read(OPENERS[arguments[0][1:]], Path(arguments[1]))
        else:
            answer = _command(arguments)
    if answer["outcome"] in ("loaded", "refused") and watch.found and arguments[0] != "grade":
        return {"outcome": f"not allowed: {watch.found[0]}"[:300]}
    left = [p.name for p in Path(os.environ["TMPDIR"]).iterdir() if p.name != f"simkit-{os.getuid()}"]
    if answer["outcome"] in ("loaded", "refused") and left:
        return {"outcome": f"left temporary files: {left[:3]}"}
    return answer


def given_arguments(file: Path) -> list[str]:
    """The command line in a file, one argument a line; runs are short and write to the folder."""
    found = [line.replace("\x00", "") for line in file.read_text(errors="replace").split("\n") if line]
    ends = {
        "run": ("--duration", "0.02", "--rtf", "1000"),
        "convert": ("-o", "new.sdf"),
        "bundle": ("-o", "new.zip"),
        "plot": ("-o", "p.svg"),
    }
    found = (
        found
        if found and found[0] in (*ends, "check", "inspect", "bag", "topic", "explain", "interface", "tf")
        else ["check", *found]
    )
    return [*found, *ends.get(found[0], ())]


@cache
def command_line() -> Any:
    """Return the command `simkit`, which Typer takes longer to make than many inputs take to open."""
    from typer.main import get_command

    from simkit.cli import app

    return get_command(app)


def _command(arguments: Sequence[str]) -> dict[str, str]:
    from simkit.cli.terminal.output import stderr_console, stdout_console

    streams = [io.TextIOWrapper(io.BytesIO(), "utf-8", errors="replace", write_through=True) for _ in range(2)]
    kept, code, trace = (sys.stdout, sys.stderr), 0, ""
    for console in (stdout_console, stderr_console):
        console.cache_clear()
    sys.stdout, sys.stderr = streams
    try:
        command_line()(list(arguments), prog_name="simkit")
    except SystemExit as stopped:
        code = stopped.code if isinstance(stopped.code, int) else 0 if stopped.code is None else 1
    except BaseException as error:  # noqa: BLE001 -- whatever it is, it is what is looked for
        code, trace = 1, traceback.format_exc()[-5000:]
        return {"outcome": f"{type(error).__name__}: {error}"[:500], "trace": trace}
    finally:
        sys.stdout, sys.stderr = kept
    out, err = (stream.buffer.getvalue().decode(errors="replace") for stream in streams)
    return _judged(code, out, err)


def _judged(code: int, out: str, err: str) -> dict[str, str]:
    """How a command ended, by its exit code and its output."""
    said = {"said": (err or out)[-3000:]}
    if "Traceback (most recent call last)" in out + err:
        return {"outcome": f"traceback, exit code {code}", "trace": err[-5000:]}
    if code not in EXIT_CODES and not (code == 1 and "SK-MOTION-012" in err):  # a motion that the robot refuses
        return {"outcome": f"exit code {code}", "trace": err[-5000:]}
    is_usage = code == 2 and not re.search(
        r"SK-[A-Z0-9]+-\d{3}", out + err
    )  # of the command line itself, in its own words
    if (found := CONTROL.search(out + err)) and not is_usage:
        return {"outcome": f"control character {found.group()!r} in the output", "trace": (out + err)[-5000:]}
    if code == 2:
        known = re.search(r"(?<=error )SK-[A-Z0-9]+-\d{3}", out + err) or re.search(r"SK-[A-Z0-9]+-\d{3}", out + err)
        if not known and not re.match(r"Usage:|Error:", err):
            return {"outcome": "exit code 2 without a code", "trace": err[-5000:]}
        if len(err) > LONGEST:
            return {"outcome": "an error longer than a screen", "trace": err[:2000]}
        return {"outcome": "refused", "code": known.group() if known else "usage", **said}
    return {"outcome": "loaded", **said}


def _read(reader: Callable[[Path], object], path: Path) -> dict[str, str]:
    import simkit
    from simkit.errors import SimkitError

    try:
        reader(path)
    except simkit.SimulationDiverged:
        return {"outcome": "loaded", "code": "diverged"}
    except SimkitError as error:
        if error.exit_code != 2 or not re.search(r"SK-[A-Z0-9]+-\d{3}", error.code):
            return {
                "outcome": f"{type(error).__name__} {error.code}: {error}"[:300],
                "trace": traceback.format_exc()[-5000:],
            }
        if len(str(error)) > LONGEST:
            return {"outcome": "an error longer than a screen", "trace": str(error)[:2000]}
        return {"outcome": "refused", "code": error.code, "said": str(error)[:300]}
    except BaseException as error:  # noqa: BLE001 -- whatever it is, it is what is looked for
        return {"outcome": f"{type(error).__name__}: {error}"[:500], "trace": traceback.format_exc()[-5000:]}
    return {"outcome": "loaded"}


def _bag(path: Path) -> None:
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.bags.summary import bag_summary, bag_text

    with open_bag_to_read(path) as bag:
        bag_text(bag), bag_summary(bag)
        for message in bag.messages():
            bag.decode(message)


def _script(path: Path) -> None:
    import simkit
    from simkit.recording.command_script import Commands, read_script

    with simkit.load("w.sdf") as sim:
        commands = Commands(sim, read_script(path, sim.topics()))
        for _ in range(15):
            commands.send_due()
            sim.step(1)


def _world(path: Path) -> None:
    import simkit

    with simkit.load(path) as sim:
        sim.step(15)


def _motions(path: Path) -> None:
    from simkit.diagnostics import Diagnostics
    from simkit_motion.plugins.play_motion.motion_files import read_motions

    found = Diagnostics()
    read_motions(path, found)
    found.raise_if_errors()


def _packets(path: Path) -> None:
    """The file is what an autopilot sends: damaged packets give no message, and do not stay in memory."""
    from simkit_water_and_air.plugins.autopilots.mavlink import MavlinkDecoder
    from simkit_water_and_air.plugins.autopilots.servo_packet import ServoPacket, decode_servo_packet

    data, decoder = path.read_bytes(), MavlinkDecoder()
    for size in (1, 40, 72, 997):
        for start in range(0, len(data), size):
            piece = data[start : start + size]
            for message in decoder.feed(piece):
                assert all(isinstance(value, (int, float, tuple)) for value in message.fields.values())
            assert len(decoder._waiting) < 300
            for channels in (16, 32):
                packet = decode_servo_packet(piece, channels)
                assert isinstance(packet, str) or (
                    isinstance(packet, ServoPacket) and len(packet.pulse_widths) == channels
                )


def _scenario(path: Path) -> None:
    from simkit.testing.scenarios.scenario_file import read_scenario

    read_scenario(path)


def _scenario_run(path: Path) -> None:
    from simkit.testing.scenarios.scenario_file import read_scenario

    _run(read_scenario(path))


def _run(scenario: Any) -> None:
    from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

    short = min(scenario.duration, SHORTEST_RUN)
    scenario = replace(scenario, duration=short, timeout=scenario.timeout and min(scenario.timeout, SHORTEST_RUN))
    with open_scenario(scenario) as sim:
        run_scenario(scenario, sim)


def _exercise(path: Path) -> None:
    from simkit_verification.testing.grading.exercise import read_exercise

    read_exercise(path)


def _exercise_run(path: Path) -> None:
    from simkit_verification.testing.grading.exercise import read_exercise

    for run in read_exercise(path).runs[:2]:
        _run(run.scenario)


def _golden(path: Path) -> None:
    from simkit.testing.golden.store import read_golden, read_history

    read_golden(path)
    read_history(path)


def _bundle(path: Path) -> None:
    from simkit_verification.testing.bundles import open_bundle

    with open_bundle(path) as bundle:
        for entry in bundle.commands():
            str(entry)
        Path("new").mkdir()
        bundle.extract(Path("new"))


def _condition(path: Path) -> None:
    """Each line is an expression: bind it to a world and ask for its value at the start and at the end of a run."""
    import simkit
    from simkit.errors import InputError
    from simkit.run_spec import Check
    from simkit.testing.scenarios.scenario_run import run_scenario

    first: InputError | None = None
    with simkit.load("w.sdf") as sim:
        for line in path.read_text(errors="replace").rstrip("\n").split("\n"):
            try:
                checks = (Check("goal", expression=line), Check("final", expression=line))
                run_scenario(simkit.RunSpec("w.sdf", duration=0.0, checks=checks), sim)
            except InputError as error:
                _check_length(error)
                first = first or error
            except Exception as error:
                raise AssertionError(f"{line!r:.300}: {type(error).__name__}: {error}") from error
    if first is not None:
        raise first


def _check_length(error: Exception) -> None:
    if len(str(error)) > LONGEST:
        raise AssertionError(f"an error longer than a screen: {str(error)[:300]}")


def _calls(path: Path) -> None:
    """The file says the seed of a row of calls of the Python interface."""
    from calls import run_calls

    run_calls(path.read_text())


OPENERS: dict[str, Callable[[Path], object]] = {
    "bag": _bag, "script": _script, "world": _world, "motions": _motions, "scenario": _scenario, "exercise": _exercise,
    "scenario_run": _scenario_run, "exercise_run": _exercise_run, "golden": _golden, "bundle": _bundle,
    "condition": _condition, "calls": _calls, "packets": _packets,
}  # fmt: skip
