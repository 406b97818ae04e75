"""Loading beside bare MuJoCo, which reads and compiles the same model from MJCF text.

python benchmarks/loading.py [WORLD [RESOURCE_PATH ...]]
python benchmarks/loading.py --table MANIFEST

With `--table`: first loads in new processes, without and with simkit's cache, of each world of a corpus and of simkit's
own worlds. The manifest is a table whose columns `kind`, `path` and `roots` name the files and their resource folders.

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
from typing import Any

import measure  # noqa: F401 - finds simkit in the checkout
import mujoco
import numpy as np
import trimesh

import simkit
from worlds import SHAPES, boxes

ROUNDS = 5


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


def terrain(folder: Path, cells: int = 212) -> str:
    """Write a world with a static mesh of hills over 60 m and return its path."""
    at = np.linspace(-30.0, 30.0, cells + 1)
    x, y = np.meshgrid(at, at, indexing="ij")
    vertices = np.stack([x, y, np.sin(0.3 * x) * np.cos(0.2 * y) + 0.3 * np.sin(x + 0.7 * y)], axis=-1).reshape(-1, 3)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(cells), np.arange(cells), indexing="ij"))
    a = i * (cells + 1) + j
    lower, upper = (a, a + cells + 1, a + cells + 2), (a, a + cells + 2, a + 1)
    faces = np.vstack([np.column_stack(lower), np.column_stack(upper)])
    trimesh.Trimesh(vertices, faces, process=False).export(folder / "terrain.stl")
    shape = "<geometry><mesh><uri>terrain.stl</uri></mesh></geometry>"
    world = folder / "terrain.sdf"
    world.write_text(
        '<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">'
        f'<collision name="c">{shape}</collision><visual name="v">{shape}</visual></link></model></world></sdf>'
    )
    return str(world)


FIRST_LOAD = """import sys, time, simkit
try:
    start = time.process_time(); sim = simkit.load(sys.argv[1], resource_paths=sys.argv[2:])
    print(time.process_time() - start, sim.mj_model.ngeom)
except simkit.LoadError: pass"""


def first_load(world: str, paths: list[str], cache: str) -> tuple[float, str] | None:
    """CPU time [s] of a load in a new process and number of shapes; None if the world is refused."""
    root = str(Path(__file__).resolve().parents[1])
    environment = {**os.environ, "SIMKIT_CACHE_DIR": cache, "PYTHONPATH": root}
    command = [sys.executable, "-c", FIRST_LOAD, world, *paths]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    seconds, *rest = done.stdout.split() or ("",)
    return (float(seconds), rest[0]) if seconds else None


def table(manifest: Path) -> None:
    """Print the loads without and with the cache, the slowest first."""
    with manifest.open(newline="") as stream:
        listed = [row for row in csv.DictReader(stream, delimiter="\t") if row["kind"] == "sdf-world"]
    folder = manifest.parent
    sources = [(str(folder / r["path"]), [str(folder / p) for p in r["roots"].split(":")]) for r in listed]
    sources += [(file.stem, []) for file in sorted((Path(__file__).parents[1] / "worlds").glob("*.sdf"))]
    found, refused = [], []
    for world, paths in sources:
        with tempfile.TemporaryDirectory() as cache:
            loads = [first_load(world, paths, cache) for _ in range(2)]
        if loads[0] is None or loads[1] is None:
            refused.append(Path(world).name)
        else:
            found.append((loads[0][0], loads[1][0], loads[1][1], Path(world).name))
    print("| world | shapes | first load [s] | later load [s] |\n|---|---|---|---|")
    for cold, cached, shapes, name in sorted(found, reverse=True):
        print(f"| {name} | {shapes} | {cold:.2f} | {cached:.2f} |")
    print(f"{len(found)} worlds; {len(refused)} refused: {' '.join(refused)}")


def main() -> None:
    if sys.argv[1:2] == ["--table"]:
        table(Path(sys.argv[2]))
        return
    if len(sys.argv) > 1:
        print(sys.argv[1], loading(sys.argv[1], sys.argv[2:]))
        return
    print("1000 boxes:", loading(boxes(1000), []), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        world = terrain(Path(folder))
        print(f"terrain: first load {timed(lambda: simkit.load(world)):.1f} s, later", loading(world, []), flush=True)
    if SHAPES.is_file():
        print("3003 shapes:", loading(str(SHAPES), []), "  aim <= 2")


if __name__ == "__main__":
    main()
