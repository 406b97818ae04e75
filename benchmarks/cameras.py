"""An RGB-D frame beside one raw colour-and-depth pass of MuJoCo with the same options.

python benchmarks/cameras.py [--world NAME] [--rounds N]
"""

from __future__ import annotations

import os
import sys

from measure import arguments, median_times, report

if sys.platform == "linux":
    os.environ.setdefault("MUJOCO_GL", "egl")

import mujoco
import numpy as np

import simkit

FRAMES = 10


class BarePass:
    """One pass at the camera's size: no shadows, no multisampling, colour and depth read together."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, width: int, height: int) -> None:
        from mujoco.gl_context import GLContext

        self.model, self.data = model, data
        self.gl = GLContext(width, height)
        self.gl.make_current()
        self.scene = mujoco.MjvScene(model, maxgeom=10000)
        self.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
        self.option, self.camera = mujoco.MjvOption(), mujoco.MjvCamera()
        self.context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, self.context)
        self.rect = mujoco.MjrRect(0, 0, width, height)
        self.colour, self.depth = np.zeros((height, width, 3), np.uint8), np.zeros((height, width), np.float32)

    def draw(self) -> None:
        self.gl.make_current()
        everything = mujoco.mjtCatBit.mjCAT_ALL
        mujoco.mjv_updateScene(self.model, self.data, self.option, None, self.camera, everything, self.scene)
        mujoco.mjr_render(self.rect, self.scene, self.context)
        mujoco.mjr_readPixels(self.colour, self.depth, self.rect, self.context)


def main() -> None:
    args = arguments(__doc__, rounds=7)
    with simkit.load(args.world) as read, simkit.load(args.world) as unread:
        camera = next(s for s in read.sensors.values() if s.kind == "rgbd_camera")
        read.subscribe(camera.topic, keep=1)
        for sim in (read, unread):
            sim.run(0.5)
        first = camera.latest
        read.mj_model.vis.quality.offsamples = 0
        read.mj_model.vis.global_.offwidth = max(read.mj_model.vis.global_.offwidth, first.width)
        read.mj_model.vis.global_.offheight = max(read.mj_model.vis.global_.offheight, first.height)
        bare = BarePass(read.mj_model, read.mj_data, first.width, first.height)
        seconds = FRAMES / camera.update_rate

        def draw_all() -> None:
            for _ in range(FRAMES):
                bare.draw()

        sides = {"read": lambda: read.run(seconds), "unread": lambda: unread.run(seconds), "bare": draw_all}
        times = median_times(sides, args.rounds)
    ours = (times["read"] - times["unread"]) / FRAMES
    report(
        f"one RGB-D frame {first.width}x{first.height}, noise included", ours, times["bare"] / FRAMES, None, "ms", 1e3
    )


if __name__ == "__main__":
    main()
