"""Loading beside bare MuJoCo, which reads and compiles the same model from MJCF text.

python benchmarks/loading.py [WORLD [RESOURCE_PATH ...]]
python benchmarks/loading.py --table MANIFEST
python benchmarks/loading.py --meshes

With `--table`: first loads in new processes, without and with simkit's cache, of each world of a corpus and of simkit's
own worlds. The manifest is a table whose columns `kind`, `path` and `roots` name the files and their resource folders.
With `--meshes`: the same for worlds of large static meshes. Both tables list the CPU time of steps, relative to a world
with one ball. In the worlds of meshes, the same ball falls far above them; other worlds also have moving robots.

Without a world: a thousand boxes, a mesh of 90,000 triangles, and gz-sim's 3003 shapes where they lie beside the
checkout. A first load of each is not counted: it imports what is needed and converts meshes, which later loads find in
the cache.
"""

from __future__ import annotations

import csv
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import large_meshes
import measure  # noqa: F401 - finds simkit in the checkout
import mujoco

import simkit
from worlds import SHAPES, boxes

ROUNDS = 5
TABLE_ROUNDS = 3


def timed(action: Callable[[], Any]) -> float:
    """CPU time [s] of one call; what it returns is let go outside."""
    start = time.process_time()
    kept = action()
    taken = time.process_time() - start
    del kept
    return taken


def loading(source: str, paths: list[str]) -> str:
    """One line: load, bare read and compile, bare compile of a finished specification."""
    with simkit.load(source, resource_paths=paths) as sim:
        spec = sim.engine.structure.builder.spec.copy()

    def compile_only() -> Any:
        model = spec.copy().compile()
        return model, mujoco.MjData(model)

    sides: list[Callable[[], Any]] = [lambda: simkit.load(source, resource_paths=paths), compile_only]
    if not spec.meshes and not spec.textures:  # whose data MJCF text does not hold
        text = spec.to_xml()
        sides.append(lambda: mujoco.MjData(mujoco.MjModel.from_xml_string(text)))
    rows = [[timed(side) for side in sides] for _ in range(ROUNDS)]
    ours, *bare = (statistics.median(column) for column in zip(*rows, strict=True))
    whole = f", MJCF text read and compiled {bare[1]:.3f} s, ratio {ours / bare[1]:.2f}" if len(bare) > 1 else ""
    return f"load {ours:.3f} s, compile alone {bare[0]:.3f} s, ratio {ours / bare[0]:.2f}{whole}"


FIRST_LOAD = """import os, sys, time, simkit
try:
    start = sum(os.times()[:4]); sim = simkit.load(sys.argv[2], resource_paths=sys.argv[3:])
    taken = sum(os.times()[:4]) - start
except simkit.LoadError: sys.exit()
empty = simkit.load(sys.argv[1])
least = [1e9, 1e9]
for _ in range(7):
    for k, one in enumerate((sim, empty)):
        start = time.process_time(); one.run(0.2); least[k] = min(least[k], time.process_time() - start)
print(taken, sim.mj_model.ngeom, least[0] / least[1])"""


class FirstLoad(NamedTuple):
    """Result of a load in a new process.

    Attributes:
        seconds: CPU time of all threads and of the processes that convert meshes [s].
        shapes: number of shapes.
        steps: CPU time of steps, relative to a world with one ball in the same process.
    """

    seconds: float
    shapes: int
    steps: float


def first_load(world: str, paths: list[str], folder: Path, cache: str) -> FirstLoad | None:
    """Load a world in a new process; None if the world is refused.

    Args:
        world: path or name of the world.
        paths: resource folders.
        folder: folder that keeps Python's compiled modules and the world with one ball.
        cache: folder of simkit's cache.
    """
    empty = folder / "alone" / "world.sdf"
    if not empty.is_file():
        large_meshes.write_world(empty.parent, [])
    root = str(Path(__file__).resolve().parents[1])
    environment = {**os.environ, "SIMKIT_CACHE_DIR": cache, "PYTHONPATH": root, "PYTHONPYCACHEPREFIX": str(folder)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    command = [sys.executable, "-c", FIRST_LOAD, str(empty), world, *paths]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    words = done.stdout.split()
    return FirstLoad(float(words[-3]), int(words[-2]), float(words[-1])) if words else None


def table(sources: list[tuple[str, str, list[str]]]) -> None:
    """Print the loads without and with the cache, the slowest first; each is the least of three.

    Args:
        sources: title, path and resource folders of each world.
    """
    found, refused = [], []
    with tempfile.TemporaryDirectory() as kept:
        first_load("empty", [], Path(kept), kept)  # writes the compiled modules
        for title, world, paths in sources:
            rounds: list[tuple[FirstLoad, FirstLoad]] = []
            for _ in range(TABLE_ROUNDS):
                with tempfile.TemporaryDirectory() as cache:
                    first, later = (first_load(world, paths, Path(kept), cache) for _ in range(2))
                if first is not None and later is not None:
                    rounds.append((first, later))
            if not rounds:
                refused.append(title)
                continue
            cold, cached = (min(pair[k].seconds for pair in rounds) for k in (0, 1))
            steps = min(pair[k].steps for pair in rounds for k in (0, 1))
            found.append((cold, cached, rounds[0][1].shapes, steps, title))
            print(f"  {title}: {cold:.2f} s, {cached:.2f} s", file=sys.stderr, flush=True)
    print(
        "| world | shapes | first load [s] | later load [s] | steps, relative to a ball alone |\n|---|---|---|---|---|"
    )
    for cold, cached, shapes, steps, title in sorted(found, reverse=True):
        print(f"| {title} | {shapes} | {cold:.2f} | {cached:.2f} | {steps:.2f} |")
    print(f"{len(found)} worlds; {len(refused)} refused: {' '.join(refused)}")


def corpus(manifest: Path) -> list[tuple[str, str, list[str]]]:
    """Return the worlds of a corpus and of simkit."""
    with manifest.open(newline="") as stream:
        listed = [row for row in csv.DictReader(stream, delimiter="\t") if row["kind"] == "sdf-world"]
    folder = manifest.parent
    sources = [
        (Path(r["path"]).name, str(folder / r["path"]), [str(folder / p) for p in r["roots"].split(":")])
        for r in listed
    ]
    own = sorted((Path(__file__).parents[1] / "worlds").glob("*.sdf"))
    return sources + [(file.name, file.stem, []) for file in own]


def main() -> None:
    if sys.argv[1:2] == ["--table"]:
        table(corpus(Path(sys.argv[2])))
        return
    if sys.argv[1:2] == ["--meshes"]:
        with tempfile.TemporaryDirectory() as folder:
            worlds = large_meshes.write_worlds(Path(folder) / "worlds")
            table([(title, str(world), []) for title, world in worlds.items()])
        return
    if len(sys.argv) > 1:
        print(sys.argv[1], loading(sys.argv[1], sys.argv[2:]))
        return
    print("1000 boxes:", loading(boxes(1000), []), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        world = str(large_meshes.write_world(Path(folder) / "terrain", [large_meshes.terrain()]))
        print(f"terrain: first load {timed(lambda: simkit.load(world)):.1f} s, later", loading(world, []), flush=True)
    if SHAPES.is_file():
        print("3003 shapes:", loading(str(SHAPES), []), "  aim <= 2")


if __name__ == "__main__":
    main()
