"""Description of the recorded run in a bag: its world, the options that load it, and the topics of its commands."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from simkit.input_file import open_input
from simkit.run_spec import run_fields

if TYPE_CHECKING:
    from simkit.runtime import Simulation


def describe_run(sim: Simulation, folder: Path, is_recorded: Callable[[str], bool]) -> dict[str, str]:
    """Return the description of a run for the metadata of its bag; empty if no file can load the run again.

    The description has the texts `world` and `files_sha256`, and as JSON `run` (the fields of a golden run that load
    the world), `commands` (recorded topics that the world subscribes to) and `left_out` (such topics that the
    recording leaves out).

    Args:
        sim: simulation.
        folder: folder of the bag. Names of files are relative to it.
        is_recorded: function that returns True for a topic that the bag will have.
    """
    spec = sim.run_spec
    if spec is None or spec.plugins or spec.change_world is not None or sim.tick:
        return {}

    moved = spec.with_relative_files(folder)
    run: dict[str, Any] = {"world": spec.relative_world(folder)}
    options = {}
    for name, described in run_fields().items():
        if name == "render_thread":
            continue  # it changes no message, and so no byte of a bag
        value = moved.value_of(described)
        if described.is_load_option and value not in (described.default, (), {}):
            options[name] = described.kind.plain(value)
        elif described.is_loaded and not described.is_load_option:
            run[name] = described.kind.plain(value)
    bus = sim.communication.bus
    endpoints = [(topic, role) for topic, endpoint, _, role in bus.endpoints() if endpoint.active]
    published = {topic for topic, role in endpoints if role == "publishes"}
    inputs = dict.fromkeys(topic for topic, role in endpoints if role == "takes" and topic not in published)
    return {
        "world": run["world"].encode(errors="replace").decode(),  # a name of a file may be no UTF-8
        "files_sha256": hash_of_files(sim),
        "run": json.dumps({**run, "options": options}, default=str),
        "commands": json.dumps([topic for topic in inputs if is_recorded(topic)]),
        "left_out": json.dumps([topic for topic in inputs if not is_recorded(topic) and topic not in bus.aside]),
    }


def hash_of_files(sim: Simulation) -> str:
    """Return the SHA-256 of the files that describe a simulation's world and its models, without meshes."""
    digest = hashlib.sha256()
    for file in dict.fromkeys((sim.world.where.file, *(model.where.file for model in sim.world.models))):
        with suppress(OSError, ValueError):
            if file is not None:
                with open_input(file) as opened:
                    digest.update(hashlib.file_digest(opened, "sha256").digest())
    return digest.hexdigest()
