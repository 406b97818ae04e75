"""Film of a simulation: frames at equal steps of simulated time, from a fixed or a following camera."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import msgs, progress
from simkit.errors import InputError, SimkitError
from simkit.msgs.message_types import Message
from simkit.recording.bags.bag_motion import SCAN, BagMotion
from simkit.recording.pictures.camera import Camera
from simkit.recording.pictures.frames import Look, Render, choose_camera, draw_frame
from simkit.recording.pictures.overlay import Marks, Points
from simkit.recording.pictures.subject import Subject, find_subject, scan_points, scan_traces
from simkit.recording.pictures.video_file import VIDEO_SUFFIXES, FrameFile, check_video_target, open_video
from simkit.recording.run_picture import DrivenPath, is_goal, marks_of

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader
    from simkit.runtime import Simulation

CAMERAS: Final = ("auto", "fixed", "follow")
_PASSES: Final = 4  # 0.3 s for a frame of 1280 × 720 without a graphics card
_AROUND: Final = np.array((4.0, 4.0, 1.0))  # what a following camera shows, in sizes of the robots
_ROOM: Final = 20.0  # size of a room with a fixed camera, in sizes of the robots
_LARGEST: Final = 4096  # [px]
_FASTEST: Final = 120


@dataclass(frozen=True)
class FilmOptions:
    """Options of a film.

    Attributes:
        outputs: files to write: `.gif`, `.mp4` or `.webm`.
        size: width and height of a video [px]; None for 1280 × 720, and 640 × 360 for a film that is only a GIF.
        rate: frames per second of simulated time [Hz]; None for 25, and 10 for a film that is only a GIF.
        camera: `fixed`, `follow`, or `auto`: fixed in a room that fits into the picture, else following the robots.
    """

    outputs: tuple[Path, ...]
    size: tuple[int, int] | None = None
    rate: float | None = None
    camera: str = "auto"

    @property
    def is_small(self) -> bool:
        """True if all outputs are GIF files."""
        return all(path.suffix.lower() == ".gif" for path in self.outputs)

    @property
    def frame_rate(self) -> Fraction:
        """Frames per second of simulated time [Hz]."""
        return Fraction((10 if self.is_small else 25) if self.rate is None else self.rate).limit_denominator(1000)

    @property
    def frame_size(self) -> tuple[int, int]:
        """Width and height [px]."""
        return self.size or ((640, 360) if self.is_small else (1280, 720))


def film_options(
    gif: Path | None, video: Path | None, resolution: str | None, fps: float | None, camera: str
) -> FilmOptions | None:
    """Check the options of a film and return them; None if no file is requested.

    Raises:
        InputError: SK-CLI-018 a value is out of range; SK-CLI-053 a file cannot be written.
    """
    size = None
    if resolution is not None:
        width, _, height = resolution.lower().partition("x")
        size = (int(width), int(height)) if width.isdecimal() and height.isdecimal() else (0, 0)
        if not all(16 <= length <= _LARGEST for length in size):
            text = f"--resolution {resolution}: expected WIDTHxHEIGHT, each from 16 to {_LARGEST} px, such as 1280x720"
            raise InputError("SK-CLI-018", text)
    if fps is not None and not 0.1 <= fps <= _FASTEST:
        raise InputError("SK-CLI-018", f"--fps {fps:g}: expected 0.1 to {_FASTEST} frames per second")
    if camera not in CAMERAS:
        raise InputError("SK-CLI-018", f"--camera {camera}: expected {', '.join(CAMERAS)}")
    for path, option, suffixes in ((gif, "--gif", (".gif",)), (video, "--video", VIDEO_SUFFIXES)):
        if path is not None:
            check_video_target(path, option, suffixes)
    outputs = tuple(path for path in (gif, video) if path is not None)
    return FilmOptions(outputs, size, fps, camera) if outputs else None


class Film:
    """Film of a running simulation, with frames at the ticks at or after k / rate.

    The run loop advances to `next_tick` and calls `send_due`, as it does for commands.

    Args:
        sim: simulation to draw.
        options: options of the film.
        render: function that draws a view of a simulation: `render_view` of the cameras' `overview_image`.
        driven: paths and goals, which the film samples.
    """

    def __init__(self, sim: Simulation, options: FilmOptions, render: Render, driven: DrivenPath) -> None:
        self._sim, self._options, self._render, self._driven = sim, options, render, driven
        width, height = options.frame_size
        quality = "high" if sim.world.quality == "high" else "gazebo"
        self._look = Look(width, height, quality, _PASSES)
        self._files: Sequence[FrameFile] = [open_video(path, options.frame_rate) for path in options.outputs]
        self._start, self._last, self.count = sim.tick, sim.tick, 0
        self._drawn_since_start = 0
        self._camera: Camera | None = None
        self._anchor: Points | None = None

    @property
    def next_tick(self) -> int | None:
        """Tick of the next frame."""
        seconds = self._drawn_since_start / self._options.frame_rate
        return self._start + -int(-seconds // Fraction(self._sim.timestep).limit_denominator(10**9))

    def send_due(self) -> None:
        """Draw the frame that is due at the present tick."""
        if self._sim.tick < self._last:  # the world was reset
            self._start, self._drawn_since_start = self._sim.tick, 0
        self._last = self._sim.tick
        due = self.next_tick
        if due is not None and self._sim.tick >= due:
            self.draw()
            self._drawn_since_start += 1

    def draw(self, marks: Marks | None = None) -> None:
        """Draw a frame of the present state, except of a diverged state.

        Args:
            marks: content to draw over the frame; None for paths, scans and goals of the simulation.
        """
        if not np.isfinite(self._sim.mj_data.qpos).all():
            return
        self._driven.sample()
        marks = marks_of(self._sim, self._driven) if marks is None else marks
        subject = find_subject(self._sim, [], scans=scan_traces(self._sim, marks.scans))
        frame = draw_frame(self._sim, self._render, self._aim(subject), self._look, marks, subject)
        for file in self._files:
            file.take(frame)
        self.count += 1

    def close(self) -> None:
        """Complete the files."""
        for file in self._files:
            file.close()

    def _aim(self, subject: Subject) -> Camera:
        """Return the camera of a frame; its direction never changes."""
        middle = subject.robots.mean(axis=0) if len(subject.robots) else None
        if self._camera is None:
            subject_in_view = find_subject(self._sim, [], math.inf if self._options.camera == "fixed" else _ROOM)
            follows = self._options.camera == "follow" or (
                self._options.camera == "auto" and not len(subject_in_view.room)
            )
            if follows and middle is not None:
                self._anchor = middle
                none = np.zeros((0, 3))
                around = middle + _AROUND * (subject.robots - middle)
                subject_in_view = replace(subject, robots=around, traces=none, room=none)
            self._camera = choose_camera(self._sim, self._render, subject_in_view, self._look)
        if self._anchor is None or middle is None:
            return self._camera
        return self._camera.moved(middle - self._anchor)


class _BagMarks:
    """Newest scans and goals of a bag.

    Args:
        types: type of each topic of the bag.

    Attributes:
        topics: topics with scans or goals.
        scans: points of the newest scan by topic in the world frame [m], shape (n, 3).
        goals: position of the newest goal by topic [m], shape (3,).
    """

    def __init__(self, types: Mapping[str, str]) -> None:
        scans = [name for name, type_name in types.items() if type_name == SCAN]
        goals = [name for name, type_name in types.items() if is_goal(name, type_name)]
        self._goal_topics, self.topics = set(goals), [*scans, *goals]
        self.scans: dict[str, Points] = {}
        self.goals: dict[str, Points] = {}

    def take(self, topic: str, message: Message, motion: BagMotion) -> None:
        """Store a scan or a goal; one with NaN or infinite values, or with an unknown frame, is left out."""
        if topic not in self.topics:
            return
        with suppress(SimkitError):
            if topic in self._goal_topics:
                self.goals[topic] = msgs.pose(message).position
            elif (pose := motion.scan_pose(topic, message)) is not None:
                self.scans[topic] = scan_points(message, pose)


def film_bag(
    sim: Simulation,
    bag: BagReader,
    options: FilmOptions,
    render: Render,
    between: tuple[float | None, float | None],
    is_over: Callable[[], bool],
) -> tuple[int, set[str]]:
    """Film a bag in its world.

    Args:
        sim: loaded world, which does not run.
        bag: bag with odometry or poses, joint states and scans.
        options: options of the film.
        render: function that draws a view of a simulation.
        between: first and last time of the film, counted as in the bag's table [s]; None for its ends.
        is_over: function that returns True to end the film early.

    Returns:
        Number of frames, and the names of the models that moved.
    """
    types = {topic.name: topic.type_name for topic in bag.topics}
    motion, marks = BagMotion(sim, types), _BagMarks(types)
    topics = [*motion.topics, *marks.topics]
    driven = DrivenPath(sim)
    film = Film(sim, options, render, driven)
    rate = options.frame_rate
    first = math.floor((bag.start - bag.time_origin) * 1e-9 * float(rate)) / float(rate)  # on the grid of frames
    begin = first if between[0] is None else between[0]
    end = (bag.end - bag.time_origin) * 1e-9
    end = end if between[1] is None else min(end, between[1])

    def draw_until(time: float) -> None:
        while (due := begin + film.count / float(rate)) < time and due <= end + 1e-9 and not is_over():
            title = f"{bag.path.name} · t = {due:.2f} s"
            task.done = due - begin
            film.draw(Marks(title, driven.paths(), marks.scans, marks.goals))

    try:
        with progress.task("filming", max(0.0, end - begin), unit="s") as task:
            for message in bag.messages(topics) if topics else ():
                draw_until((message.time_ns - bag.time_origin) * 1e-9)
                if is_over():
                    break
                decoded = bag.decode(message)
                motion.take(message.topic, decoded)
                marks.take(message.topic, decoded, motion)
                driven.sample()
            draw_until(math.inf)
    finally:
        film.close()
    return film.count, motion.moved
