"""Runs CoACD in a process of its own: `python run_coacd.py IN.npz OUT.npz`.

CoACD's threads make its result depend on the machine's load, and a bad mesh can bring its process down; so it gets one
with a single thread. Nothing of simkit is imported here.
"""

from __future__ import annotations

import sys

import numpy as np


def main(source: str, target: str) -> None:
    import coacd

    coacd.set_log_level("error")
    with np.load(source, allow_pickle=False) as given:
        mesh = coacd.Mesh(given["vertices"], given["faces"])
        parts = coacd.run_coacd(
            mesh, threshold=float(given["threshold"]), max_convex_hull=int(given["most"]), seed=int(given["seed"])
        )
    arrays = {f"p{i}": np.asarray(vertices, np.float64) for i, (vertices, _) in enumerate(parts)}
    with open(target, "wb") as stream:
        np.savez(stream, **arrays)  # type: ignore[arg-type]


if __name__ == "__main__":
    main(*sys.argv[1:3])
