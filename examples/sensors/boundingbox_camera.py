"""Boxes around the things on a table, in the picture and in space: `python boundingbox_camera.py [OUT.png]`."""

from __future__ import annotations

from pathlib import Path

import plots
import segmentation_camera as table

import simkit

KINDS = {"visible_2d": "around what is seen", "full_2d": "around all of it", "3d": "in space"}


def main(out: Path) -> None:
    eyes = "".join(table.eye(f"eye_{k}", "boundingbox_camera", f"<box_type>{k}</box_type>") for k in KINDS)
    with simkit.load(table.world(eyes), seed=1) as sim:
        images = {k: sim.subscribe(f"/eye_{k}_image") for k in KINDS}
        sim.run(0.01)
        boxes = {k: sim.sensor(f"rig::l::eye_{k}").latest.detections for k in KINDS}
    figure, axes = plots.figure("Bounding boxes of labelled things", columns=3, figsize=(8.0, 2.8))
    for ax, (kind, said) in zip(axes, KINDS.items(), strict=True):
        ax.imshow(table.pixels(images[kind].messages[-1]))
        ax.set(title=f"{kind}: {said}", xticks=[], yticks=[])
        ax.grid(False)
        ax.spines[:].set_visible(False)
    for box in boxes["visible_2d"]:
        corner = box.bbox.center.position.x - box.bbox.size_x / 2, box.bbox.center.position.y - box.bbox.size_y / 2
        if box.id != "table":
            axes[0].annotate(box.results[0].hypothesis.class_id, corner, color="white", fontsize=7, va="bottom")
    for box in boxes["3d"]:
        at = box.bbox.center.position
        print(f"{box.id}: {at.x:.2f} m ahead, {at.y:.2f} m to the left, {at.z:.2f} m up")
    plots.save(figure, out)


if __name__ == "__main__":
    plots.run(main, "boundingbox_camera.png")
