"""Picture of a run: the scene at the end, with the driven paths, the last scans and the goals."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from simkit.errors import InputError
from simkit.linear_algebra import matmul
from simkit.pose import Pose
from simkit.recording.pictures.camera import Camera
from simkit.recording.pictures.frames import Look, Render, choose_camera, draw_frame
from simkit.recording.pictures.overlay import Marks
from simkit.recording.pictures.subject import Subject, find_subject, last_scans, scan_points, scan_traces
from simkit.recording.travel import Travel

if TYPE_CHECKING:
    from simkit.msgs import PoseStamped
    from simkit.runtime import Simulation

__all__ = ["DrivenPath", "check_target", "marks_of", "save_picture", "scan_points"]

Points = NDArray[np.float64]

_MOST_NAMED: Final = 2  # models outside of the picture that its title names
_GOALS: Final = "geometry_msgs/msg/PoseStamped"


class DrivenPath:
    """Paths of the models that move, and the newest goals, since the last reset; the run loop calls `sample`.

    Attributes:
        goals: position of the newest goal by topic [m], shape (3,).
    """

    def __init__(self, sim: Simulation) -> None:
        self._sim, self._travel = sim, Travel(sim)
        self.goals: dict[str, Points] = {}
        self._watched: set[str] = set()
        self.sample()
        sim.communication.bus.on_topic(self._watch_goals)

    def sample(self) -> None:
        """Store the present positions."""
        before = self._travel.resets
        self._travel.sample()
        if self._travel.resets > before:
            self.goals.clear()

    @property
    def tracks(self) -> dict[str, list[Points]]:
        """Positions of each model [m]."""
        return self._travel.tracks

    def paths(self) -> dict[str, Points]:
        """Return the path of each model that moved [m], shape (n, 3), the longest first."""
        paths = {name: path for name, path in self._travel.paths().items() if len(path) > 1}
        return dict(sorted(paths.items(), key=lambda item: -len(item[1])))

    def _watch_goals(self, topic: str, type_name: str) -> None:
        if topic in self._watched or not is_goal(topic, type_name):
            return
        self._watched.add(topic)

        def keep(message: PoseStamped) -> None:
            at, frame = message.pose.position, _frame_pose(self._sim, message.header.frame_id)
            position = matmul(frame.matrix, (at.x, at.y, at.z)) + frame.position
            if np.isfinite(position).all():
                self.goals[topic] = position

        self._sim.communication.bus.tap(topic, keep)


def is_goal(topic: str, type_name: str) -> bool:
    """Check whether the messages of a topic are goals for a robot."""
    return type_name == _GOALS and "goal" in topic.rpartition("/")[2]


def marks_of(sim: Simulation, driven: DrivenPath | None) -> Marks:
    """Return what is drawn over a picture of the present state."""
    paths: Mapping[str, Points] = {} if driven is None else driven.paths()
    title = f"{sim.world.name} · t = {sim.time:.2f} s"
    return Marks(title, paths, last_scans(sim), {} if driven is None else driven.goals)


def save_picture(
    sim: Simulation, path: Path, render: Render, driven: DrivenPath | None = None, look: Look | None = None
) -> None:
    """Draw the present state of the simulation to an image file (`.png` or `.jpg`).

    Args:
        sim: simulation to draw.
        path: image file to write.
        render: function that draws a view of a simulation: `render_view` of the cameras' `overview_image`.
        driven: paths and goals to draw.
        look: size and quality of the picture.

    Raises:
        RenderError: SK-RENDER-001 there is no renderer.
        InputError: SK-CLI-013 the file is not writable.
    """
    import cv2

    look = Look(quality=sim.world.quality if sim.world.quality == "high" else "gazebo") if look is None else look
    marks = marks_of(sim, driven)
    goals = (("", goal[None]) for goal in marks.goals.values())
    subject = find_subject(sim, [*marks.paths.items(), *goals], scans=scan_traces(sim, marks.scans))
    camera = choose_camera(sim, render, subject, look)
    marks = replace(marks, title=" · ".join((marks.title, *_notes(subject, camera))))
    colours = draw_frame(sim, render, camera, look, marks, subject)
    try:
        settings = [cv2.IMWRITE_PNG_COMPRESSION, 9] if path.suffix.lower() == ".png" else []
        is_saved = cv2.imwrite(str(path), colours[:, :, ::-1], settings)
    except cv2.error as error:
        raise InputError("SK-CLI-013", f"cannot write {path}: {str(error).strip().splitlines()[-1]}") from None
    if not is_saved:
        raise InputError("SK-CLI-013", f"cannot write {path}")


def _notes(subject: Subject, camera: Camera) -> list[str]:
    """Return what the title says about models and shapes that the picture leaves out."""
    names, notes = subject.left_out, []
    if names:
        listed = ", ".join(names[:_MOST_NAMED]) + (
            f" and {len(names) - _MOST_NAMED} more" if names[_MOST_NAMED:] else ""
        )
        notes.append(f"outside of the picture: {listed}")
    if math.isfinite(camera.ceiling):
        notes.append(f"opened above z = {camera.ceiling:.3g} m")
    return notes


def check_target(path: Path) -> None:
    """Check before a run whether its picture can be written.

    Raises:
        InputError: SK-CLI-013 the suffix is not supported, or the folder does not exist.
    """
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg"):
        raise InputError("SK-CLI-013", f"--picture {path}: found the ending {path.suffix!r}; expected .png or .jpg")
    if not path.absolute().parent.is_dir():
        raise InputError("SK-CLI-013", f"--picture {path}: folder {path.absolute().parent} does not exist")


def _frame_pose(sim: Simulation, frame: str) -> Pose:
    """Return the pose of a frame in the world; an unknown frame, such as `map`, is the frame of the world."""
    name = frame.strip("/")
    for scoped in sim.engine.names.links:
        if name and scoped.endswith(f"::{name}"):
            return sim.link(scoped).pose
    return Pose()
