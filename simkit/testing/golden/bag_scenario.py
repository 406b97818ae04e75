"""Run that a bag was recorded from, by the description in the bag."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.errors import InputError
from simkit.json_reader import parse_json
from simkit.recording.bags.reader import BagReader, open_bag_to_read
from simkit.recording.bags.recorded_run import hash_of_files
from simkit.run_spec import FilePath, RunSpec
from simkit.testing.golden.record_encoding import decode_scenario
from simkit.testing.scenarios.readable_files import ReadableFiles

if TYPE_CHECKING:
    from simkit.runtime import Simulation

_CODE: Final = "SK-CLI-064"


def recorded_scenario(bag: FilePath, *, folders: Sequence[FilePath] = ()) -> RunSpec | None:
    """Return the run that a bag was recorded from, with the commands of the bag; None if a path is not a bag.

    Args:
        bag: bag.
        folders: folders of the user in which the bag may name files, beside its own folder and its project.

    Raises:
        InputError: SK-CLI-064 the bag does not describe its run, or has not all commands of the run; SK-URI-003 it
            names files that it may not name; SK-CLI-035 it cannot be read.
    """
    path = Path(bag)
    if path.suffix not in (".mcap", ".db3") and not (path / "metadata.yaml").is_file():
        return None
    with open_bag_to_read(path) as reader:
        if not reader.run:
            raise InputError(_CODE, f"{path} does not name the world of its recording", help=_help(path))
        spec, commands, left_out = _parse_run(reader)
        played = [topic.name for topic in reader.topics if topic.name in commands]
    if left_out:
        problem = f"{path} was recorded without {', '.join(left_out)}, on which its world receives commands"
        raise InputError(_CODE, problem, help="record the run again without --skip and --topic for these topics")
    ReadableFiles(spec.folder / "bag", folders).check(spec)
    if "<" not in spec.world and Path(spec.world).suffix and spec.beside is None:
        raise InputError(_CODE, f"{path} was recorded in {spec.world}, which does not exist", help=_help(path))
    play = str(path.absolute()) if played else ""
    return replace(spec, duration=reader.duration, play=play, play_topics=tuple(played))


def check_recorded_files(bag: FilePath, sim: Simulation) -> None:
    """Check that the world of a simulation has the files that it had in the recording.

    Raises:
        InputError: SK-CLI-064 they differ.
    """
    with open_bag_to_read(Path(bag)) as reader:
        if reader.run.get("files_sha256") != hash_of_files(sim):
            problem = f"{bag}: the files of {reader.run.get('world')} differ from those of the recording"
            raise InputError(_CODE, problem, help=_help(Path(bag)))


def _help(path: Path) -> str:
    return f"name the world, and play the bag: simkit why WORLD --play {path}"


def _parse_run(bag: BagReader) -> tuple[RunSpec, list[str], list[str]]:
    """Return the specification of the run, the topics of its commands, and those that the bag leaves out."""
    folder = bag.path if bag.path.is_dir() else bag.path.parent
    try:
        spec = decode_scenario(parse_json(bag.run["run"]), folder)
        commands, left_out = (list(map(str, parse_json(bag.run[name]))) for name in ("commands", "left_out"))
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError) as error:
        problem = f"{bag.path}: the description of its run is damaged: {type(error).__name__}: {error!s:.100}"
        raise InputError(_CODE, problem, help=_help(bag.path)) from None
    return spec, commands, left_out
