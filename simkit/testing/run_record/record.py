"""Data types for the record of one run, stored or new."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from simkit.run_spec import JsonMapping, RunSpec
from simkit.testing.run_record.noise_statistics import NoiseStatistics

if TYPE_CHECKING:
    from simkit.runtime import Simulation
    from simkit.testing.conditions.checks import CheckResult

Array = npt.NDArray[Any]


@dataclass
class Column:
    """Values of one field in all messages of a topic.

    Attributes:
        values: Values, shape (messages, …). If the number of values varies between messages, the values of all messages
            follow each other, shape (values,).
        lengths: Number of values in each message, shape (messages,); None if all messages have the same shape.
        step: Rounding step of the values; 0 if they are exact.
    """

    values: Array
    lengths: npt.NDArray[np.int64] | None = None
    step: float = 0.0

    def of(self, index: int) -> Array:
        """Return the values of one message."""
        if self.lengths is None:
            return np.asarray(self.values[index])
        start = int(self.lengths[:index].sum())
        return self.values[start : start + int(self.lengths[index])]


@dataclass
class Pictures:
    """Reduced pictures of a topic.

    Attributes:
        small: Reduced pictures, shape (messages, height, width, channels). Colours are uint8. Depths [m] are float32,
            NaN or infinite where a ray has no hit.
        shape: Height and width of the original pictures [px].
        encoding: Encoding of the messages.
        tiles: Hash of each tile of the original pictures, shape (messages, rows, columns), uint32.
        kept: Indices of the messages in `small` and `tiles`, ascending, shape (kept,); None for all messages. If there
            are many messages, only every second, fourth, … is stored.
        hashes: Hash of every original picture, shape (messages,), uint32; None if unknown.
    """

    small: Array
    shape: tuple[int, int]
    encoding: str
    tiles: npt.NDArray[np.uint32]
    kept: npt.NDArray[np.int64] | None = None
    hashes: npt.NDArray[np.uint32] | None = None

    @property
    def messages(self) -> npt.NDArray[np.int64]:
        """Indices of the messages whose pictures are in `small` and `tiles`."""
        return np.arange(len(self.small)) if self.kept is None else self.kept

    def at(self, messages: npt.NDArray[np.int64]) -> Pictures:
        """Return the pictures of some messages, whose pictures must be stored."""
        rows = np.searchsorted(self.messages, messages)
        return replace(self, small=self.small[rows], tiles=self.tiles[rows], kept=messages)

    def first(self, count: int) -> Pictures:
        """Return the pictures of the first messages."""
        pictures = self.at(self.messages[self.messages < count])
        hashes = None if self.hashes is None else self.hashes[:count]
        return replace(pictures, kept=None if self.kept is None else pictures.kept, hashes=hashes)


@dataclass
class Stream:
    """Recorded data of one topic.

    Attributes:
        topic: Name of the topic.
        type_name: ROS type.
        times_ns: Simulated time of publication of each message [ns].
        columns: Numbers by path of the field (`pose.pose.position.x`, `ranges`).
        words: Texts by path of the field.
        pictures: Reduced pictures; None for other types.
        statistics: Noise statistics by path of the field, for fields whose samples are not stored.
        chunks: First 16 hexadecimal digits of the SHA-256 of each simulated second's messages in CDR.
        digest: SHA-256 of all messages.
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
    """Physics of a run: a hash of one byte (mark) for every tick, and some complete states.

    Attributes:
        timestep: Time step [s].
        marks: One byte of a hash of positions and velocities after each tick, shape (ticks,). The hash orders entities
            by name, so it does not depend on their order in the file. Unnamed entities are ordered by number.
        inputs: One byte of a hash of the inputs from plugins and commands (controls, forces) at each tick, shape
            (ticks,).
        ticks: Ticks of the stored states, ascending.
        names: Names of the quantities: `robot::wheel_joint position`, `crate velocity z`, … .
        values: Exact values, shape (kept, quantities).
        input_names, input_values: Names and values of controls and forces.
        digest: State hash at the end, as `simkit run` prints it.
        named_digest: Hexadecimal SHA-256 of all marks and of the final state by name; independent of the order in the
            file.
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
    """Record of one run of a scenario.

    Attributes:
        scenario: Scenario.
        fingerprint: Versions, processor, renderer: `simkit.testing.run_record.fingerprint`.
        streams: Recorded data by topic.
        states: Physics.
        leaves: Values of the resolved world: path -> value (number, text, or list of numbers). Paths consist of names
            and therefore do not depend on the order in the file.
        leaf_places: Path -> `file:line` of the values whose position is known; for a new run only.
        fields: Fields of the compiled model by entity name (`geom robot::wheel::collision size`).
        sources: SHA-256 of the files of the run by name: meshes, pictures, parameter files and the code of plugins.
        diagnostics: Codes reported during loading, with their counts.
        left_out: Names of the sensors, plugins and controllers without which the world ran, with their numbers; None
            for a stored record of an older version.
        end: End of the run: "duration", "until", …, or the text of an error.
        simulation: Simulation of the run, which is still open; None for a stored record.
        checks: Results of the scenario's checks; for a new run only.
        error: Error that ended the run; for a new run only.
        environment: Environment variables that select the world (`TURTLEBOT3_MODEL`); empty if not set.
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
    left_out: Mapping[str, int] | None = field(default_factory=dict, kw_only=True)
    end: str = "duration"
    simulation: Simulation | None = None
    checks: tuple[CheckResult, ...] = ()
    error: Exception | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
