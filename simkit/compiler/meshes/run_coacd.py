"""Script that runs CoACD in a process of its own: `python run_coacd.py IN.npz OUT.npz`.

CoACD's threads make its result depend on the machine's load, and a bad mesh can crash its process. Therefore CoACD gets
its own process with a single thread. MuJoCo is not imported here.
"""

from __future__ import annotations

import sys

import numpy as np

from simkit.child_process import exit_with_parent


def main(source: str, target: str) -> None:
    """Decompose the mesh in `source` and write the pieces to `target`."""
    exit_with_parent()
    import coacd

    coacd.set_log_level("info")  # the parent process reads the progress from the log
    with np.load(source, allow_pickle=False) as task:
        mesh = coacd.Mesh(task["vertices"], task["faces"])
        parts = coacd.run_coacd(
            mesh, threshold=float(task["threshold"]), max_convex_hull=int(task["most"]), seed=int(task["seed"])
        )
    arrays = {f"p{i}": np.asarray(vertices, np.float64) for i, (vertices, _) in enumerate(parts)}
    with open(target, "wb") as stream:
        np.savez(stream, **arrays)  # type: ignore[arg-type]


if __name__ == "__main__":
    main(*sys.argv[1:3])
