"""Memory: what an hour of simulated time adds to the process, with all but images read; by default from a minute.

python benchmarks/memory.py [--world NAME] [--full]
python benchmarks/memory.py --sizes [ROW ...]

`--sizes` prints the resident memory of new processes, and the size of a bag: `robots` (a world of 100 TurtleBots after
its load and after 10 s, beside MuJoCo with the same compiled model), `environments` (4096 environments of a vector),
`images` (a minute of RGB-D and clouds recorded at 30 Hz, after ten seconds and at the end) and `bag` (nine topics of
the main job).
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import measure

DRIVE = Path(__file__).resolve().parents[1] / "worlds" / "turtlebot3_world_drive.yaml"


def resident() -> float:
    """Return the memory of this process [MB]."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6


def robots() -> str:
    import fleet

    import simkit

    text = fleet.world(100, "gz")
    start = resident()
    with simkit.load(text) as sim, tempfile.TemporaryDirectory() as folder:
        loaded = resident()
        fleet.drive(sim)
        sim.run(10.0)
        driven = resident()
        file = Path(folder, "fleet.mjb")
        import mujoco

        mujoco.mj_saveModel(sim.mj_model, str(file))
        bare = row("bare", str(file))
    return f"imports {start:.0f} MB, loaded {loaded:.0f} MB, after 10 s {driven:.0f} MB; {bare}"


def bare(file: str) -> str:
    import mujoco

    model = mujoco.MjModel.from_binary_path(file)
    data = mujoco.MjData(model)
    mujoco.mj_step(model, data, 1000)
    return f"MuJoCo alone {resident():.0f} MB"


def environments() -> str:
    import numpy as np

    import simkit.gym

    envs = simkit.gym.make_vec("simkit/TurtleBot3Goal-v0", num_envs=1)
    envs.reset(seed=0)
    one = resident()
    envs.close()
    envs = simkit.gym.make_vec("simkit/TurtleBot3Goal-v0", num_envs=4096)
    envs.reset(seed=0)
    reset = resident()
    for _ in range(3):
        envs.step(np.zeros((4096, 2), np.float32))
    many = resident()
    each = 1e3 * (many - one) / 4096
    return f"one {one:.0f} MB, 4096 after reset {reset:.0f} MB, after 3 steps {many:.0f} MB: {each:.0f} kB each"


def images(duration: str = "60") -> str:
    import simkit
    from simkit.recording.bags.recorder import Recorder

    found, seconds = [], float(duration)
    with simkit.load("turtlebot3_world") as sim, tempfile.TemporaryDirectory() as folder:
        with Recorder(sim, Path(folder, "images.mcap"), topics=["/camera/*"]):
            for _ in range(6):
                sim.run(seconds / 6)
                found.append(resident())
        size = Path(folder, "images.mcap").stat().st_size / 1e6
    return f"after {seconds / 6:g} s {found[0]:.0f} MB, after {seconds:g} s {found[-1]:.0f} MB; bag of {size:.0f} MB"


def bag() -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder, "x.mcap")
        command = ["run", "turtlebot3_world", "--script", str(DRIVE), "--duration", "36", "--record", str(file)]
        subprocess.run(
            [sys.executable, "-m", "simkit", *command, "--skip", "/camera/*"], check=True, capture_output=True
        )
        return f"{file.stat().st_size / 1e6:.2f} MB for 36 s of nine topics"


ROWS: dict[str, Callable[..., str]] = {
    "robots": robots, "environments": environments, "images": images, "bag": bag, "bare": bare
}  # fmt: skip


def row(name: str, *arguments: str) -> str:
    """Return what a new process measures."""
    done = subprocess.run([sys.executable, __file__, "--row", name, *arguments], capture_output=True, text=True)
    return (done.stdout.strip() if done.returncode == 0 else done.stderr.strip()).splitlines()[-1]


def main() -> None:
    if sys.argv[1:2] == ["--row"]:
        print(ROWS[sys.argv[2]](*sys.argv[3:]))
        return
    if sys.argv[1:2] == ["--sizes"]:
        for name in sys.argv[2:] or [name for name in ROWS if name != "bare"]:
            print(f"{name:13s} {row(name)}", flush=True)
        return
    import simkit
    from simkit.cli.bench_figures import measure_memory_growth

    args = measure.arguments(__doc__, rounds=1)
    with simkit.load(args.world) as sim:
        growth = measure_memory_growth(sim, 3600.0 if args.full else 60.0)
    print(f"{growth * 3600 / 1e6:+.2f} MB a simulated hour")


if __name__ == "__main__":
    main()
