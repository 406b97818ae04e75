"""Recordings of a fit: bags with commands, and free motions of a model."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Protocol

import numpy as np

from simkit import RunSpec, Simulation
from simkit.errors import InputError
from simkit.recording import matches_topic, open_bag_to_read
from simkit.recording.message_taps import is_available
from simkit_identification.command_replay import command_topics, repeated_run
from simkit_identification.fitting.codes import INVALID_MOTION, INVALID_OPTION, NO_COMMANDS, NOTHING_COMMON
from simkit_identification.fitting.inputs import world_inputs
from simkit_identification.fitting.motion import Motion, motion_of_bag
from simkit_identification.fitting.problem import RepeatedRecording
from simkit_identification.fitting.readings import (
    Readings,
    bag_readings,
    check_topics,
    common_topics,
    has_numbers,
    is_about_run,
    topic_pattern,
)

Bag = str | os.PathLike[str] | Motion
"""Recording: a bag, or the free motion of a model."""


class RecordingOptions(Protocol):
    """Options that say what of the recordings is used."""

    @property
    def compare(self) -> tuple[str, ...]: ...
    @property
    def skip(self) -> float: ...
    @property
    def duration(self) -> float | None: ...
    @property
    def motion(self) -> str: ...
    @property
    def window(self) -> float | None: ...
    @property
    def play_topics(self) -> tuple[str, ...]: ...


def read_recordings(
    sim: Simulation, run: RunSpec, bags: Sequence[Bag], options: RecordingOptions
) -> tuple[list[RepeatedRecording], dict[str, str]]:
    """Return the recordings, and the topics that are not compared with the reason.

    Args:
        sim: loaded world.
        run: run of the world, without random noise.
        bags: bags and motions.
        options: options.

    Raises:
        InputError: SK-FIT-003 a bag has no commands for the world; SK-FIT-004 nothing to compare; SK-FIT-010 an
            invalid option; SK-FIT-011 an invalid motion; or a bag cannot be read.
    """
    recordings: list[RepeatedRecording] = []
    notes: dict[str, str] = {}
    for bag in bags:
        if isinstance(bag, Motion):
            recordings.append(_motion_recording(sim, run, bag, options))
        elif options.motion:
            model, equals, topic = options.motion.partition("=")
            if not equals or not model or not topic:
                raise InputError(INVALID_OPTION, f"motion: found {options.motion!r}; expected MODEL=TOPIC")
            recordings.append(_motion_recording(sim, run, motion_of_bag(Path(bag), model, topic), options))
        else:
            recordings.append(_bag_recording(sim, run, Path(os.fspath(bag)), options, notes))
    if options.window is not None and not any(recording.motion is not None for recording in recordings):
        raise InputError(INVALID_OPTION, "window is for free motions; use it with motion")
    return recordings, notes


def _motion_recording(sim: Simulation, run: RunSpec, motion: Motion, options: RecordingOptions) -> RepeatedRecording:
    model_names = [model.name for model in sim.loaded.world.models]
    if motion.model not in model_names:
        text = f"{motion.name}: the world has no model {motion.model!r}; its models: {', '.join(model_names) or 'none'}"
        raise InputError(INVALID_MOTION, text)
    if sim.model(motion.model).static:
        raise InputError(INVALID_MOTION, f"the model {motion.model!r} is static, so it has no motion to fit")
    if options.duration is not None:
        motion = _shortened(motion, options.duration)
    return RepeatedRecording(motion.name, run, (motion.recorded(),), motion, tuple(motion.windows(options.window)))


def _shortened(motion: Motion, duration: float) -> Motion:
    count = int(np.count_nonzero(motion.times <= duration + 1e-9))
    linear = None if motion.linear is None else motion.linear[:count]
    angular = None if motion.angular is None else motion.angular[:count]
    poses = motion.times[:count], motion.positions[:count], motion.quaternions[:count]
    return Motion(motion.model, *poses, linear, angular, motion.name)


def _bag_recording(
    sim: Simulation, run: RunSpec, path: Path, options: RecordingOptions, notes: dict[str, str]
) -> RepeatedRecording:
    repeated = repeated_run(run, path, options.play_topics, options.duration)
    commands = command_topics(sim, path, options.play_topics)
    if not commands:
        inputs = ", ".join(world_inputs(sim)) or "none"
        text = f"{path}: the world hears no topic of this bag{_cut(path)}; its inputs: {inputs}"
        help_ = "rename topics with --play-topic OLD:=NEW; for a body that moves freely, use --motion MODEL=TOPIC"
        raise InputError(NO_COMMANDS, text, help=help_)
    with open_bag_to_read(path) as bag:
        if bag.broken:
            notes[f"the rest of {path}"] = bag.broken
        available = {t: kind for t, kind in common_topics(sim, bag) if t not in commands and t not in commands.values()}
        numeric = [topic for topic, kind in available.items() if has_numbers(kind)]
        check_topics(options.compare, numeric)
        patterns = [topic_pattern(text) for text in options.compare]
        chosen = [topic for topic in numeric if not patterns or matches_topic(topic, patterns)]
        ready = [topic for topic in chosen if is_available(sim, topic)]
        until = math.inf if options.duration is None else options.duration
        readings = bag_readings(bag, ready, until)
        only_bag = [
            t.name
            for t in bag.topics
            if t.name not in available and t.name not in commands and not is_about_run(t.type_name)
        ]
    for topic in only_bag:
        notes.setdefault(topic, "the world does not publish it")
    for topic, kind in available.items():
        if topic not in chosen and not options.compare and not is_about_run(kind):
            notes.setdefault(topic, f"{kind.rpartition('/')[2]} has no numbers to compare")
    kept = [reading for reading in readings if _has_two(reading)]
    if not kept:
        text = f"{path}: the bag and the world share no topic with numbers to compare"
        listed = ", ".join(sorted(available)) or "none"
        raise InputError(NOTHING_COMMON, f"{text}; topics of both: {listed}", help="record the topics of the sensors")
    return RepeatedRecording(str(path), repeated, tuple(kept))


def _cut(path: Path) -> str:
    """Return the reason why a bag is truncated, in brackets; empty for a complete bag."""
    with open_bag_to_read(path) as bag:
        return f" ({bag.broken})" if bag.broken else ""


def _has_two(readings: Readings) -> bool:
    return len(readings.times) > 1
