"""A dense scan of simkit beside MuJoCo-LiDAR's CPU backend: the same rays, the same model, in turn.

python benchmarks/mujoco_lidar_rays.py [--rounds N]   (needs `pip install mujoco-lidar`)

The world and the rays are those of the case `dense_scan` of the history: 16 x 900 rays over 20,000 triangles, among 20
boxes. simkit's side is the complete sample with noise and message.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path

from measure import arguments

from simkit.cli.bench_figures import time_interleaved

sys.path.append(str(Path(__file__).resolve().parent / "history"))


def main() -> None:
    import cases
    import mujoco
    import numpy as np
    from mujoco_lidar import MjLidarWrapper

    rounds = arguments(__doc__, 15).rounds
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # meshes are read from the present folder
        ours, bare = cases.CASES["dense_scan"].make(Path(folder))
        world = Path(folder, "world.sdf")
        world.write_text(cases.lidar_world(900, 16, 1.5, cases.terrain_and_boxes(Path(folder))), encoding="utf-8")
        spec = mujoco.MjSpec.from_file(str(cases.converted(Path(folder), str(world))))
        spec.worldbody.add_site(name="lidar", pos=(0.1, 0.2, 1.5))
        model = spec.compile()
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        lidar = MjLidarWrapper(model, site_name="lidar", backend="cpu", cutoff_dist=60.0)
        turn, tilt = np.meshgrid(np.linspace(-3.1, 3.1, 900), np.linspace(-0.3, 0.3, 16))
        theta, phi = turn.ravel().astype(np.float32), tilt.ravel().astype(np.float32)
        sides = [lambda: ours(0), lambda: lidar.trace_rays(data, theta, phi), lambda: bare(0)]
        mine, theirs, plain = time_interleaved(sides, rounds)
        os.chdir("/")  # Windows does not remove the present folder
    for name, seconds in (("simkit", mine), ("MuJoCo-LiDAR", theirs), ("mj_multiRay", plain)):
        rate = 14.4e-3 / seconds
        print(
            f"{name:13s} {1e3 * seconds:7.2f} ms   {rate:5.2f} million rays/s   {seconds / mine:5.2f} of simkit's time"
        )


if __name__ == "__main__":
    main()
