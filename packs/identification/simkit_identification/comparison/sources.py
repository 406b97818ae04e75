"""Sources of a comparison: bags, and runs that repeat the commands of a bag."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import RunSpec, progress
from simkit.errors import InputError
from simkit.recording import Recorder, matches_topic, open_bag_to_read
from simkit.recording.bags.reader import LATEST_SIMULATED_TIME
from simkit.testing import open_scenario, run_scenario
from simkit_identification.command_replay import command_topics, repeated_run
from simkit_identification.comparison.stream_reader import StreamReader
from simkit_identification.measures.recording import SignalRecording

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit.recording import BagReader

ASIDE: Final = ("/clock", "/rosout", "/parameter_events", "/stats", "/diagnostics*", "*/transition_event", "/events/*")
"""Topics that are only compared if an option names them."""
_COMMANDS: Final = (
    "geometry_msgs/msg/Twist",
    "geometry_msgs/msg/TwistStamped",
    "ackermann_msgs/msg/AckermannDrive",
    "ackermann_msgs/msg/AckermannDriveStamped",
)
_EMPTY: Final = "SK-COMPARE-001"
_BAGS: Final = (".mcap", ".db3")


@dataclass(frozen=True)
class TopicChoice:
    """Topics to compare.

    Attributes:
        topics: shell patterns; empty for all topics except those in `ASIDE`.
        skip: shell patterns of topics to leave out.
        names: topic of b by topic of a, where they differ.
        commands: topics to play, `TOPIC` or `OLD:=NEW`; empty for every topic that the world subscribes to.
    """

    topics: tuple[str, ...] = ()
    skip: tuple[str, ...] = ()
    names: Mapping[str, str] = field(default_factory=dict)
    commands: tuple[str, ...] = ()

    def takes(self, topic: str) -> bool:
        """Check whether a topic of a is compared."""
        if matches_topic(topic, self.skip):
            return False
        return matches_topic(topic, self.topics) if self.topics else not matches_topic(topic, ASIDE)

    @property
    def old_names(self) -> dict[str, str]:
        """Topic of a by topic of b."""
        return {new: old for old, new in self.names.items()}


def is_bag(path: Path) -> bool:
    """Check whether a path is a bag: a file, or a folder that ROS 2 recorded."""
    if path.suffix.lower() in _BAGS:
        return True
    return path.is_dir() and (path / "metadata.yaml").is_file()


def read_bag(path: Path, choose: Callable[[str], bool], *, name: str = "") -> SignalRecording:
    """Read the messages of a bag as numbers.

    Args:
        path: bag.
        choose: function that returns True for a topic to read. Topics of commands are read, too.
        name: name of the recording; default: the path.

    Raises:
        InputError: SK-CLI-035 the bag cannot be read; SK-COMPARE-001 it has no messages of the topics.
    """
    with open_bag_to_read(path) as bag:
        recording = _read(bag, choose, name or str(path))
    if not any(stream.count for stream in recording.streams.values()):
        known = ", ".join(sorted(topic.name for topic in bag.topics)) or "none"
        cut = f"; {bag.broken}" if bag.broken else ""
        raise InputError(_EMPTY, f"{path} has no messages to compare; its topics: {known}{cut}")
    return recording


def has_simulated_times(path: Path) -> bool:
    """Check whether the times of a bag are simulated times."""
    with open_bag_to_read(path) as bag:
        return bag.start < LATEST_SIMULATED_TIME


def _read(bag: BagReader, choose: Callable[[str], bool], name: str) -> SignalRecording:
    recording = SignalRecording(name, bag.duration, {})
    if bag.broken:
        recording.notes.append(f"{name}: {bag.broken}")
    readers: dict[tuple[str, str], StreamReader] = {}
    commands: list[str] = []
    total = 0
    for topic in bag.topics:
        is_command = topic.type_name in _COMMANDS
        if not topic.count or not (choose(topic.name) or is_command):
            continue
        if any(known == topic.name for known, _ in readers):
            recording.notes.append(
                f"{name}: {topic.name} also has messages of type {topic.type_name}; they are left out"
            )
            continue
        try:
            readers[topic.name, topic.type_name] = StreamReader(
                topic.name, topic.type_name, bag.store_of(topic.type_name)
            )
        except InputError as error:
            recording.notes.append(f"{topic.name} is left out: {error.message}")
            continue
        total += topic.count
        if is_command:
            commands.append(topic.name)
    origin = bag.time_origin
    with progress.task(f"reading {name}", total) as task:
        for message in bag.messages([known for known, _ in readers]) if readers else ():
            reader = readers.get((message.topic, message.type_name))
            if reader is not None:
                reader.take((message.time_ns - origin) * 1e-9, bag.decode(message))
                task.done += 1
    recording.streams = {topic: reader.stream(origin) for (topic, _), reader in readers.items()}
    recording.commands = tuple(commands)
    return recording


# ---------------------------------------------------------------------- runs


def repeat_recording(
    run: RunSpec, bag: Path, a: SignalRecording, choice: TopicChoice, *, allow_code: bool = False
) -> tuple[SignalRecording, SignalRecording]:
    """Run a world with the commands of a recording, and read the run.

    Args:
        run: run of the world.
        bag: recording whose commands are repeated.
        a: the recording as numbers.
        choice: topics to compare.
        allow_code: allow the code that the file of the run names.

    Returns:
        Recording with the played topics as its commands, and the run with topics named as in the recording.

    Raises:
        SimkitError: the world has errors, or the run fails.
    """
    spec = repeated_run(run, bag, choice.commands)
    wanted = {choice.names.get(topic, topic) for topic in a.streams}
    with tempfile.TemporaryDirectory() as folder, open_scenario(spec, allow_code=allow_code) as sim:
        played = command_topics(sim, bag, choice.commands)
        if not played:
            spec = replace(spec, play="")
        path = Path(folder) / "run.mcap"
        with Recorder(sim, path, choose=lambda topic: topic in wanted or topic in played.values()):
            run_scenario(spec, sim, allow_code=allow_code)
        b = read_bag(path, lambda _: True, name=spec.title)
    commands = {new: old for old, new in played.items()}
    a.commands = tuple(played)
    b.commands = tuple(played.values())
    a.notes.append(_played_text(played, sim))
    return a, b.renamed({**choice.old_names, **commands})


def _played_text(played: Mapping[str, str], sim: Simulation) -> str:
    if not played:
        unlisted = sim.communication.bus.unlisted
        inputs = ", ".join(
            sorted({t for t, _, _, role in sim.communication.bus.endpoints() if role == "takes"} - unlisted)
        )
        return f"no topic of the recording is played: the world subscribes to {inputs or 'none'}; see --play-topic"
    return "played: " + ", ".join(old if old == new else f"{old} as {new}" for old, new in played.items())


def world_spec(world: str | Path | RunSpec, seed: int | None = None) -> RunSpec:
    """Return the run specification of a world."""
    spec = world if isinstance(world, RunSpec) else RunSpec(str(world))
    return spec if seed is None else spec.with_values({"seed": seed})


def common_topics(a: SignalRecording, b: SignalRecording) -> Sequence[str]:
    """Return the topics of both recordings."""
    return [topic for topic in a.streams if topic in b.streams]
