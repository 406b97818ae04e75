"""Reads one broken file after another in a process of its own, within bounds of time and memory.

The parent sends one line of JSON, `{"main": name, "arguments": command, "files": [[name, length], ...]}`, followed by
the bytes of the files in that order, and gets one line of JSON for each such set: what became of it, how long it took
and the most memory. A command is run in the folder of the files; without one the main file is loaded as a world.
"""

from __future__ import annotations

import faulthandler
import io
import json
import os
import re
import shutil
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path
from typing import Any

from openers import Watch, opened
from reader import SECONDS

ADDRESSES = 8 << 30  # [bytes] of address space; the engine and its libraries take 2 of it
STEPPING = 0.2  # [s] of wall time that a file that loads is stepped for
STEPS = 250
STAND = """<sdf version="1.9"><world name="w"><model name="m"><link name="l"/><link name="k"/>
<joint name="j" type="revolute"><parent>l</parent><child>k</child><axis/></joint>
<link name="o"/><joint name="i" type="revolute"><parent>l</parent><child>o</child><axis/></joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><topic>cmd_vel</topic>
<left_joint>j</left_joint><right_joint>i</right_joint></plugin>
<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
<joint_name>j</joint_name></plugin></model></world></sdf>"""


def main() -> None:
    bound_memory()
    faulthandler.enable()
    warnings.simplefilter("error", RuntimeWarning)  # what numpy says of bad numbers would be on a user's terminal
    import simkit

    simkit.load("<sdf version='1.9'><world name='w'/></sdf>").close()
    top = Path(tempfile.mkdtemp(dir=sys.argv[1]))
    inside(top)
    watch = Watch(top)
    resources = [Path(p) for p in sys.argv[2:]]
    say({"ready": True})
    while header := sys.stdin.buffer.readline():
        asked = json.loads(header)
        folder = top / "world"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        for name, length in asked["files"]:
            file = folder / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(sys.stdin.buffer.read(length))
        forget_peak()
        faulthandler.dump_traceback_later(0.9 * SECONDS)  # to stderr, which the parent reads when no answer comes
        began, used = time.perf_counter(), time.process_time()
        if asked["arguments"]:
            answer: dict[str, Any] = opened(asked["arguments"], folder, watch)
            if more := {path.name for path in top.iterdir()} - {"world", "home"}:
                answer = {"outcome": f"writes outside its folder: {sorted(more)}"}
        else:
            answer = outcome(folder / asked["main"], [folder, *resources])
        faulthandler.cancel_dump_traceback_later()
        times = {"seconds": round(time.perf_counter() - began, 3), "cpu": round(time.process_time() - used, 3)}
        say({**answer, **times, "peak_mib": peak_mib()})


def say(answer: dict[str, Any]) -> None:
    sys.stdout.write(json.dumps(answer) + "\n")
    sys.stdout.flush()


def inside(top: Path) -> None:
    """Give this process a home and a folder for temporary files of its own, and a fixed width of the terminal."""
    for name, folder in (
        ("HOME", "home"),
        ("TMPDIR", "home/tmp"),
        ("XDG_CACHE_HOME", "home/cache"),
        ("XDG_RUNTIME_DIR", "home/run"),
    ):
        (top / folder).mkdir(parents=True, exist_ok=True, mode=0o700)
        os.environ[name] = str(top / folder)
    tempfile.tempdir = None
    os.environ.update(COLUMNS="120", NO_COLOR="1")


def bound_memory() -> None:
    try:
        import resource
    except ImportError:  # not on Windows
        return
    resource.setrlimit(resource.RLIMIT_AS, (ADDRESSES, ADDRESSES))


def forget_peak() -> None:
    """Linux forgets the largest size that a process ever had when asked to."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return


def peak_mib() -> int:
    try:
        status = Path("/proc/self/status").read_text()
    except OSError:
        return 0
    return int(status.partition("VmHWM:")[2].split()[0]) >> 10


def outcome(file: Path, resources: list[Path]) -> dict[str, str]:
    """How a file was taken: `loaded`, `refused` (with the first code), or what it raised that it should not."""
    import simkit

    try:
        if file.suffix == ".yaml" and file.name != "metadata.yaml":
            return commanded(file)
        if file.suffix in (".mcap", ".db3") or file.name == "metadata.yaml":
            return bag_read(file.parent if file.name == "metadata.yaml" else file)
        simkit.describe(file, resource_paths=resources)
        with simkit.load(file, resource_paths=resources) as sim:
            return loaded(sim)
    except simkit.LoadError as error:
        return refused(list(error.diagnostics))
    except simkit.SimulationDiverged:
        return {"outcome": "loaded", "code": "diverged"}
    except BaseException as error:  # noqa: BLE001 -- whatever it is, it is what is looked for
        return {"outcome": f"{type(error).__name__}: {error}"[:500], "trace": traceback.format_exc()[-5000:]}


def bag_read(path: Path) -> dict[str, str]:
    """Describe, decode, export and recover a bag; each step may refuse it."""
    import simkit
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.bags.recovery import recover_bag
    from simkit.recording.bags.summary import bag_summary, bag_text
    from simkit.recording.export import ExportOptions, export_bag

    def describe() -> None:
        with open_bag_to_read(path) as bag:
            json.dumps(bag_summary(bag))
            bag_text(bag).encode()

    def decode() -> None:
        with open_bag_to_read(path) as bag:
            for message in bag.messages():
                bag.decode(message)

    top = path.parents[1] / "bag_output"
    shutil.rmtree(top, ignore_errors=True)
    top.mkdir()
    steps = (
        *(describe, decode, lambda: export_bag(path, top / "export", ExportOptions())),
        lambda: recover_bag(path, top / "recovered.mcap"),
    )
    codes = []
    for step in steps:
        try:
            step()
        except simkit.InputError as error:
            if not error.code.startswith("SK-") or len(str(error)) > 20_000:
                return {"outcome": f"an error without a code, or longer than a screen: {error}"[:300]}
            codes.append(error.code)
    if any(file.name.startswith(".") for file in top.iterdir()):
        return {"outcome": "a temporary folder is left"}
    return {"outcome": "refused", "code": " ".join(codes)} if codes else {"outcome": "loaded"}


def refused(found: list[Any]) -> dict[str, str]:
    errors = [d for d in found if d.severity == "error"]
    if not errors:
        return {"outcome": "refused without an error"}
    if not all(d.code.startswith("SK-") and d.message for d in found):
        return {"outcome": "a diagnostic without code or text"}
    if max(len(d.message) for d in found) > 20_000:
        return {"outcome": "a message longer than a screen"}
    printed(found)
    return {"outcome": "refused", "code": errors[0].code, "said": str(errors[0])[:300]}


def printed(found: list[Any]) -> None:
    """As `simkit check` prints it."""
    from rich.console import Console

    from simkit.cli.terminal.output import print_diagnostics

    stream = io.TextIOWrapper(io.BytesIO(), "utf-8", errors="replace")
    print_diagnostics(found, verbose=True, console=Console(file=stream, highlight=False, markup=False, emoji=False))
    stream.flush()
    json.dumps([d.as_dict() for d in found])


def loaded(sim: Any) -> dict[str, str]:
    """Looks at what was compiled, says what the physics lint says, and steps."""
    from simkit.compiler.lint import lint_world

    bad = numbers_that_are_none(sim.mj_model)
    if bad:
        return {"outcome": f"not finite in the compiled model: {bad}"}
    printed([*sim.diagnostics, *lint_world(sim.world, sim.engine.compiled)])
    until = time.perf_counter() + STEPPING
    sim.step(3)
    while sim.tick < STEPS and time.perf_counter() < until:
        sim.step(10)
    return {"outcome": unreadable(sim) or "loaded"}


def unreadable(sim: Any) -> str:
    """A sensor, not a drawn one, whose reading has a number that is none; empty where all are fine."""
    from simkit.sensors.cameras.rendered_camera import RenderedCamera

    for sensor in sim.contents.sensors.values():
        if isinstance(sensor, RenderedCamera):
            continue
        for message in (sensor.latest, sensor.truth):
            if re.search(r"\bnan\b", str(message)):
                return f"not a number in what {sensor.kind} reads"
    return ""


def numbers_that_are_none(model: Any) -> str:
    import numpy as np

    names = [n for n in dir(model) if n.split("_")[0] in ("body", "jnt", "dof", "geom", "site", "mesh", "eq", "light")]
    arrays = [(n, getattr(model, n)) for n in names]
    return ", ".join(
        n for n, a in arrays if isinstance(a, np.ndarray) and a.dtype.kind == "f" and not np.isfinite(a).all()
    )


def commanded(file: Path) -> dict[str, str]:
    """A script of commands, sent to a model that listens."""
    import simkit
    from simkit.recording.command_script import Commands, read_script

    try:
        with simkit.load(STAND) as sim:
            commands = Commands(sim, read_script(file, sim.topics()))
            for _ in range(30):
                commands.send_due()
                sim.step(1)
    except simkit.InputError as error:
        if len(str(error)) > 20_000:
            return {"outcome": "a message longer than a screen"}
        return {"outcome": "refused", "code": error.code}
    return {"outcome": "loaded"}


if __name__ == "__main__":
    main()
