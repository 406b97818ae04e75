"""What one run of a scenario gave, as arrays: the golden one that was stored, or the one that is compared with it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit.run_spec import JsonMapping, RunSpec
from simkit.testing.run_record.noise_statistics import NoiseStatistics

if TYPE_CHECKING:
    from simkit.testing.conditions.checks import CheckResult

Array = npt.NDArray[Any]


@dataclass
class Column:
    """One field of a topic's messages.

    Attributes:
        values: shape (messages, …); where messages have different numbers of values, (all values,), one message after
            the other.
        lengths: how many values each message has, (messages,); None where all have the same shape.
        step: what the values are rounded to; 0 where they are exact.
    """

    values: Array
    lengths: npt.NDArray[np.int64] | None = None
    step: float = 0.0

    def of(self, index: int) -> Array:
        """The values of one message."""
        if self.lengths is None:
            return np.asarray(self.values[index])
        start = int(self.lengths[:index].sum())
        return self.values[start : start + int(self.lengths[index])]


@dataclass
class Pictures:
    """The pictures of a topic, small.

    Attributes:
        small: shape (messages, height, width, channels), uint8, or float32 for depths [m] (not finite: nothing there).
        shape: height and width as they came [px].
        encoding: of the messages.
        tiles: a hash of each tile of each picture as it came, shape (messages, rows, columns), uint32.
        kept: of which messages `small` and `tiles` are, ascending, (kept,): every second, fourth, … where there are
            many; None for all.
        hashes: of every picture as it came, (messages,), uint32; None where not known.
    """

    small: Array
    shape: tuple[int, int]
    encoding: str
    tiles: npt.NDArray[np.uint32]
    kept: npt.NDArray[np.int64] | None = None
    hashes: npt.NDArray[np.uint32] | None = None

    @property
    def messages(self) -> npt.NDArray[np.int64]:
        """Of which messages `small` and `tiles` are, where all are kept as well."""
        return np.arange(len(self.small)) if self.kept is None else self.kept

    def at(self, messages: npt.NDArray[np.int64]) -> Pictures:
        """Only those of some of the messages that are kept."""
        rows = np.searchsorted(self.messages, messages)
        return replace(self, small=self.small[rows], tiles=self.tiles[rows], kept=messages)

    def first(self, count: int) -> Pictures:
        """Those of the first messages."""
        found = self.at(self.messages[self.messages < count])
        hashes = None if self.hashes is None else self.hashes[:count]
        return replace(found, kept=None if self.kept is None else found.kept, hashes=hashes)


@dataclass
class Stream:
    """What one topic gave.

    Attributes:
        topic: its name.
        type_name: its ROS type.
        times_ns: when each message was published, simulated time [ns].
        columns: numbers, by path of the field (`pose.pose.position.x`, `ranges`).
        words: texts, by path.
        pictures: for images.
        statistics: of the noise, by path of the field, where statistics are compared instead of samples.
        chunks: SHA-256 of the messages as CDR, one a second of simulated time, its first 16 hexadecimal digits.
        digest: SHA-256 of them all.
    """

    topic: str
    type_name: str
    times_ns: npt.NDArray[np.int64]
    columns: dict[str, Column] = field(default_factory=dict)
    words: dict[str, list[str]] = field(default_factory=dict)
    pictures: Pictures | None = None
    statistics: dict[str, NoiseStatistics] = field(default_factory=dict)
    chunks: list[str] = field(default_factory=list)
    digest: str = ""


@dataclass
class States:
    """The physics on its way: a mark of every tick, and the whole state now and then.

    Attributes:
        timestep: length of a step [s].
        marks: one byte of a hash of positions and velocities after each tick, shape (ticks,); what has no name has its
            place by its number, all else by name, so that the order of models in a file does not show.
        inputs: one byte of a hash of what plugins and commands put in (controls, forces) at each tick, (ticks,).
        ticks: at which the state was kept, ascending.
        names: of the quantities: `robot::wheel_joint position`, `crate velocity z`, … .
        values: shape (kept, quantities), exact.
        input_names, input_values: the same of controls and forces.
        digest: the state hash at the end, as `simkit run` prints it.
        named_digest: SHA-256 of all marks and of the state at the end by name, which the order of models in a file does
            not change; hexadecimal.
    """

    timestep: float
    marks: npt.NDArray[np.uint8]
    inputs: npt.NDArray[np.uint8]
    ticks: npt.NDArray[np.int64]
    names: list[str]
    values: npt.NDArray[np.float64]
    input_names: list[str]
    input_values: npt.NDArray[np.float64]
    digest: str
    named_digest: str = ""


@dataclass
class RunRecord:
    """What one run of a scenario gave.

    Attributes:
        scenario: what was run.
        fingerprint: versions, processor, renderer: `simkit.testing.run_record.fingerprint`.
        streams: by topic.
        states: the physics.
        leaves: what the world means once resolved, flat: path -> value (number, text, or list of numbers); paths are
            made of names, so that the order in the file does not show.
        leaf_places: `file:line` of those that have one; of the run only.
        fields: the compiled model's fields by name of the part (`geom robot::wheel::collision size`), for saying what
            the engine saw.
        sources: SHA-256 of the files that the run was made from, by name: meshes, pictures, parameter files and the
            code of plugins.
        diagnostics: codes of what loading reported, with how many of each.
        end: why the run ended: "duration", "until", …, or the error's text.
        simulation: the run's own, for further questions; None for what was read from a file.
        checks: what became of the scenario's checks (`simkit.testing.conditions.CheckResult`); of the run only.
        error: what the run failed with; of the run only.
        environment: variables of the environment that say what the world is (`TURTLEBOT3_MODEL`); empty where not set.
    """

    scenario: RunSpec
    fingerprint: dict[str, str]
    streams: dict[str, Stream]
    states: States
    leaves: JsonMapping = field(default_factory=dict)
    leaf_places: Mapping[str, str] = field(default_factory=dict)
    fields: Mapping[str, Array] = field(default_factory=dict)
    sources: Mapping[str, str] = field(default_factory=dict)
    diagnostics: Mapping[str, int] = field(default_factory=dict)
    end: str = "duration"
    simulation: Any = None
    checks: tuple[CheckResult, ...] = ()
    error: Exception | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
