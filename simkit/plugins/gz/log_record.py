"""Log of a run, written as a bag, for Gazebo's `gz::sim::systems::LogRecord`."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import msgs
from simkit.errors import SimkitError
from simkit.msgs.topic_names import valid_topic
from simkit.params import Params
from simkit.plugins.base import NEVER, WorldPlugin
from simkit.plugins.drives.entity_poses import PoseNumbers, pose_numbers
from simkit.plugins.drives.odometry_messages import TRANSFORMS, transforms
from simkit.plugins.endpoints import publishes
from simkit.plugins.not_deep_copied import SharedByCopies
from simkit.plugins.options import Options, OptionsOf, boolean, number, text, texts
from simkit.save_path import SAVE_PATH_VARIABLE, allowed_folder

if TYPE_CHECKING:
    from simkit.compiler import SpecBuilder
    from simkit.recording.bags.recorder import Recorder
    from simkit.runtime import Simulation

STRING: Final = "std_msgs/msg/String"
FILE: Final = "state.mcap"
_IS_PATTERN: Final = re.compile(r"[*?\[\]().]")


class _Log(SharedByCopies):
    """Recording of a run. Snapshots, resets and restores keep the same object."""

    def __init__(self) -> None:
        self.recorder: Recorder | None = None
        self.was_begun = False


class LogRecordOptions(Options):
    """Options of `LogRecord`."""

    record_path: str = text()
    record_period: float = number(0.0, "s", minimum=0.0)
    record_topic: tuple[str, ...] = texts()
    record_resources: bool = boolean()
    compress: bool = boolean()
    compress_path: str = text()


class LogRecord(WorldPlugin):
    """Records the run to `<record_path>/state.mcap`: the world's SDF, the poses of its links, and `<record_topic>`s.

    The file is created in the first step and replaces an existing one, as in Gazebo.
    """

    endpoints = (
        publishes("/{record_path}/sdf", STRING),
        publishes("/world/{world}/changed_state", TRANSFORMS),
    )
    options = OptionsOf(LogRecordOptions)
    names = ("gz::sim::systems::LogRecord",)  # no filename: Gazebo's library also contains LogPlayback

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        self._path = self._read_path(params)
        self._period = self.options.record_period
        self._plain, self._patterns = self._read_topics(params)
        self._report_unused(params)

    def _read_path(self, params: Params) -> Path | None:
        record_path = self.options.record_path
        if not record_path:
            hint = "set <record_path> to a folder below the working directory, or use `simkit run --record OUT.mcap`"
            params.warning("SK-PLUGIN-127", f"plugin {self.name!r} has no <record_path>; nothing is recorded", hint)
            return None
        path = allowed_folder(record_path)
        if path is None or (path.exists() and not path.is_dir()):
            fault = "is not a folder" if path else "is outside the folders that simkit may write to"
            message = f"plugin {self.name!r}: <record_path> {record_path} {fault}; nothing is recorded"
            variable = f"the environment variable {SAVE_PATH_VARIABLE}"
            hint = f"use a path below the working directory, or allow the folder in {variable}"
            params.diagnostics.warning("SK-PLUGIN-127", message, params.block("record_path").where, hint)
            return None
        return path

    def _read_topics(self, params: Params) -> tuple[frozenset[str], tuple[re.Pattern[str], ...]]:
        """Return the topics by name and by regular expression.

        As in Gazebo, a `<record_topic>` that contains one of the characters `*?[]().` is a regular expression.
        """
        plain, patterns = set(), []
        for element in params.all("record_topic"):
            if not _IS_PATTERN.search(element.value):
                plain.add(valid_topic(element.value))
                continue
            try:
                patterns.append(re.compile(element.value))
            except re.error as error:
                problem = f"found <record_topic>{element.value}</record_topic>"
                element.error("SK-PARAM-002", f"{problem}; expected a topic or a regular expression: {error}")
        return frozenset(plain), tuple(patterns)

    def _report_unused(self, params: Params) -> None:
        unused = []
        if self.options.record_resources:
            unused.append("<record_resources>: meshes are not copied")
        if self.options.compress:
            unused.append("<compress>: a bag is always compressed")
        if self.options.compress_path:
            unused.append("<compress_path>: the only file is in <record_path>")
        if unused:
            params.diagnostics.note("SK-PLUGIN-128", f"plugin {self.name!r} ignores {'; '.join(unused)}", self.where)

    def load(self, parent: Simulation, params: Params) -> None:
        self._log = _Log()
        self.before_step_rate = self.after_step_rate = NEVER
        recorders = [
            p for p in self.sim.engine.structure.all_plugins() if isinstance(p, LogRecord) and p._path is not None
        ]
        if self._path is None:
            return
        if recorders[0] is not self:
            message = f"plugin {self.name!r}: another LogRecord already records; this one does not, as in Gazebo"
            params.diagnostics.warning("SK-PLUGIN-127", message, self.where)
            return
        self.before_step_rate = None
        self.after_step_rate = 1.0 / self._period if self._period else None
        self._sdf = self.advertise(valid_topic(f"/{self._path.name}/sdf"), STRING)
        self._state = self.advertise(valid_topic(f"/world/{parent.world.name}/changed_state"), TRANSFORMS)
        self.sim.communication.bus.aside.update((self._sdf.topic, self._state.topic))
        self._places: dict[str, PoseNumbers] = {}

    # ------------------------------------------------------------------ running

    def before_step(self) -> None:
        """Start the recording in the first step."""
        if not self._log.was_begun:
            self._begin()
        self._set_before_step_rate(NEVER)

    def _begin(self) -> None:
        from simkit.recording.bags.recorder import Recorder

        path, log = self._path, self._log
        assert path is not None
        log.was_begun = True
        try:
            path.mkdir(parents=True, exist_ok=True)
            log.recorder = Recorder(self.sim, path / FILE, overwrite=True, choose=self._is_recorded)
        except (OSError, SimkitError) as error:
            self._once.warn("SK-PLUGIN-127", "begin", f"nothing is recorded: {error}")
            return
        self._sdf.publish(msgs.type_of(STRING)(self.sim.control.to_sdf()))
        self._publish_state()

    def _is_recorded(self, topic: str) -> bool:
        is_listed = topic in (self._sdf.topic, self._state.topic) or topic in self._plain
        return is_listed or any(pattern.fullmatch(topic) for pattern in self._patterns)

    def after_step(self) -> None:
        recorder = self._log.recorder
        if recorder is not None and recorder.failure is not None:
            self._once.warn("SK-PLUGIN-127", "failed", str(recorder.failure))
        if self._state.wanted:
            self._publish_state()

    def _publish_state(self) -> None:
        """Publish the world poses of the links that moved since the last call."""
        sim, moved = self.sim, []
        for scoped, link in sim.contents.handles.tables["link"].items():
            pose = link.pose
            place = pose_numbers(pose)
            if self._places.get(scoped) != place:
                self._places[scoped] = place
                moved.append((sim.world.name, scoped, pose))
        if moved:
            self._state.publish(transforms(sim.time_ns, *moved))

    def close(self) -> None:
        if self._log.recorder is not None:
            self._log.recorder.close()


class LogPlayback(WorldPlugin):
    """Replaces Gazebo's replay of logs, which simkit does not support.

    A replay is not needed: a run with the same seed is identical bit for bit.
    """

    names = ("gz::sim::systems::LogPlayback",)

    def prepare(self, scene: object, params: Params, builder: SpecBuilder) -> None:
        params.mark_all_read()
        message = f"plugin {self.name!r}: playback of Gazebo's logs is not supported; the world is simulated instead"
        hint = "run the world with the same seed, or read a bag with `simkit topic echo --bag`"
        params.diagnostics.warning("SK-PLUGIN-129", message, self.where, hint)

    def load(self, parent: Simulation, params: Params) -> None:
        """Do nothing."""
