"""Conversion of a world's mesh files in several processes before the world is built, when the cache lacks them.

The processes write to the cache of converted meshes, and the builder finds the results there. They run the same code as
the builder, so the results have the same bits.
"""

from __future__ import annotations

import os
import pickle
import sys
import tempfile
from collections.abc import Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Final

from simkit import progress
from simkit.child_process import ChildProcesses, exit_with_parent
from simkit.diagnostics import Diagnostics, Where
from simkit.input_file import read_input
from simkit.loaders.meshes.mesh_cache import cache_directory, load_converted, mesh_key
from simkit.loaders.meshes.mesh_part import LARGEST_FILE, join_parts
from simkit.scene import Mesh, SceneModel

LEAST_BYTES: Final = 3 << 20
"""Smallest total size of the files: starting a process takes as long as converting about 1 MB."""

_MOST_PROCESSES: Final = 8

MeshUses = dict[Mesh, set[bool]]
"""Shape -> for each kind of its collisions, whether the model is static; empty for a shape that is only drawn."""


def convert_meshes(models: Iterable[SceneModel]) -> int:
    """Convert the mesh files of models that the cache lacks, if they are many or large.

    The cache is asked for the largest file first. If it is there, nothing else is read.

    Returns:
        Number of processes that were started.
    """
    cores, by_file = _core_count(), _uses_by_file(models)
    if cores < 2 or len(by_file) < 2 or not _is_writable(cache_directory()):
        return 0
    sizes = {file: size for file in by_file if 0 < (size := _size(file)) <= LARGEST_FILE}
    ordered = sorted(sizes, key=lambda file: (-sizes[file], str(file)))
    if sum(sizes.values()) < LEAST_BYTES or _is_cached(ordered[0]):
        return 0
    files = [file for file in ordered if not _is_cached(file)]
    if len(files) < 2 or sum(sizes[file] for file in files) < LEAST_BYTES:
        return 0
    shares: list[MeshUses] = [{} for _ in range(min(cores, len(files), _MOST_PROCESSES))]
    loads = [0] * len(shares)
    for file in files:
        least = loads.index(min(loads))
        loads[least] += sizes[file]
        shares[least].update(by_file[file])
    _run_processes(shares)
    return len(shares)


def _core_count() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _uses_by_file(models: Iterable[SceneModel]) -> dict[Path, MeshUses]:
    """Return the shapes of each mesh file."""
    uses: dict[Path, MeshUses] = {}
    for top in models:
        for model in top.all_models():
            for link in model.links if model.mjcf is None else ():
                for shape, kinds in (
                    *((visual.geometry, ()) for visual in link.visuals),
                    *((collision.geometry, (model.static,)) for collision in link.collisions),
                ):
                    if isinstance(shape, Mesh) and not shape.missing and not shape.bone:
                        uses.setdefault(shape.file, {}).setdefault(shape, set()).update(kinds)
    return uses


def _run_processes(shares: list[MeshUses]) -> None:
    """Run one process for each share, and end all of them if this process is interrupted."""
    processes = ChildProcesses()
    with (
        tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder,
        progress.task("converting meshes", len(shares)) as task,
        ThreadPoolExecutor(len(shares)) as pool,
    ):
        try:
            running = []
            for number, share in enumerate(shares):
                job = Path(folder) / f"{number}.pickle"
                job.write_bytes(pickle.dumps(share))
                running.append(pool.submit(processes.run, __name__, [str(job)]))
            for future in running:
                future.result()
                task.advance()
        finally:
            processes.end()


def _size(file: Path) -> int:
    try:
        return file.stat().st_size
    except (OSError, ValueError):
        return 0  # the builder reports the problem


def _is_cached(file: Path) -> bool:
    try:
        return load_converted(mesh_key(file, read_input(file, LARGEST_FILE))) is not None
    except OSError:
        return True  # as above


def _is_writable(folder: Path) -> bool:
    """Check whether files can be made in a folder, or in the nearest folder above that exists."""
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    return folder.is_dir() and os.access(folder, os.W_OK)


def _convert(uses: Mapping[Mesh, set[bool]]) -> None:
    """Convert shapes and their collision bodies, which the cache then has. The builder reports all problems."""
    from simkit.compiler.meshes.convex_decomposition import convex_bodies  # 10 ms, which only these processes need
    from simkit.loaders.meshes.mesh_reader import load_mesh

    for shape, kinds in uses.items():
        parts = load_mesh(shape, Diagnostics(), Where(str(shape.file)))
        for fixed in sorted(kinds) if parts else ():
            vertices, faces = join_parts(parts)
            convex_bodies(vertices, faces, fixed=fixed, optimization=shape.optimization, most=shape.max_hulls)


if __name__ == "__main__":
    exit_with_parent()
    _convert(pickle.loads(Path(sys.argv[1]).read_bytes()))
