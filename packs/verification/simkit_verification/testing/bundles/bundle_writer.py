"""Writer of bundles: the world with its files, plugin code, recorded inputs and the last messages in one archive."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys
import traceback
import zipfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit import RunSpec
from simkit.errors import InputError
from simkit.run_spec import JsonObject
from simkit.sensors.cameras.renderer_choice import SOFTWARE, fell_back
from simkit.testing.run_record.fingerprint import fingerprint
from simkit.writers.atomic_output import check_file, remove_abandoned, unfinished_folder
from simkit_verification.testing.bundles.archive import MAX_BYTES, name_fault
from simkit_verification.testing.bundles.bundle_recorder import (
    WINDOW_SECONDS,
    BundleRecorder,
    WindowMessage,
    recorder_of,
    topic_digests,
    write_bag,
)
from simkit_verification.testing.bundles.bundle_staging import UNPACKED, StagedWorld, WorldStager, copy_plugin_modules
from simkit_verification.testing.bundles.manifest import (
    BAG,
    COMMANDS,
    PAGE,
    Failure,
    Manifest,
    RunEnd,
    failure_from_error,
    strip_folders,
)

if TYPE_CHECKING:
    from simkit import Simulation

_UNFINISHED: Final = "simkit-bundle"
_EPOCH: Final = (1980, 1, 1, 0, 0, 0)
_PLAIN: Final = 0o100644 << 16
_UNIX: Final = 3

StagedFiles = Callable[[Path], Manifest]
"""Function that copies all files into a folder and returns their manifest."""


def keep(
    sim: Simulation, folder: str | Path | None = None, *, seconds: float = WINDOW_SECONDS, topics: Sequence[str] = ()
) -> BundleRecorder:
    """Record a run for a bundle; call this function right after `simkit.load`.

    Args:
        sim: Simulation.
        folder: Folder in which a bundle is written if the block `with keep(…)` ends with an exception; None for no
            bundle.
        seconds: Length of the message window [s] of simulated time.
        topics: Shell patterns of image topics to include.

    Raises:
        InputError: SK-BUNDLE-007 the run has already begun.
    """
    if folder is None:
        return BundleRecorder(sim, seconds, topics)
    target = Path(folder)
    return BundleRecorder(
        sim, seconds, topics, write_failed=lambda recorder, error: write_failed(recorder, target, error)
    )


def write_bundle(
    kept: BundleRecorder | Simulation,
    path: str | Path,
    failure: BaseException | Failure | None = None,
    *,
    name: str = "",
    overwrite: bool = False,
    with_code: bool = True,
) -> Path:
    """Write the run up to now into one file. If the call is interrupted, no incomplete file remains.

    Args:
        kept: Recorder that `keep` returned, or its simulation. The simulation must be between two steps.
        path: File to write.
        failure: Failure of the run; None if it did not fail.
        name: Name of the run; the name of the world if empty.
        overwrite: Replace an existing file.
        with_code: Include the code of plugins in the user's folders.

    Returns:
        Path of the file.

    Raises:
        InputError: SK-BUNDLE-006 the world cannot be packed; SK-BUNDLE-007 the run is not recorded; SK-CLI-016 the file
            cannot be written.
    """
    keeper = kept if isinstance(kept, BundleRecorder) else recorder_of(kept)
    target = Path(path)
    check_file(target, overwrite=overwrite)
    staged = _files_of_run(keeper, failure, name, with_code)
    with _write_hidden_file(target.absolute().parent, staged) as (file, _):
        os.replace(file, target)  # noqa: PTH105 - atomic on every platform
    return target


def _files_of_run(
    keeper: BundleRecorder, failure: BaseException | Failure | None, name: str, with_code: bool
) -> StagedFiles:
    end = failure_from_error(failure) if isinstance(failure, BaseException) else failure
    return lambda stage: _stage_files(keeper, stage, end, name, with_code)


def write_failed(
    keeper: BundleRecorder, folder: Path, failure: BaseException | Failure, *, with_code: bool = True
) -> Path:
    """Write a bundle of a run that failed. The file name consists of the world, the error and a hash of the content.

    Raises:
        InputError: See `write_bundle`.
    """
    return _write_with_generated_name(folder, _files_of_run(keeper, failure, "", with_code))


def _write_with_generated_name(folder: Path, staged: StagedFiles) -> Path:
    """Write a bundle whose file name consists of the run's name, the failure and a hash."""
    with _write_hidden_file(folder.absolute(), staged) as (file, manifest):
        failure = manifest.end.failure or Failure("run", "", "")
        digest = hashlib.sha256(manifest.text().encode()).hexdigest()[:8]
        stem = "".join(c if c.isalnum() or c in "-_." else "_" for c in manifest.name)[:60] or "run"
        path = folder / f"{stem}-{failure.code or failure.kind}-{digest}.zip"
        os.replace(file, path)  # noqa: PTH105 - atomic on every platform
    return path


@contextmanager
def _write_hidden_file(folder: Path, staged: StagedFiles) -> Iterator[tuple[Path, Manifest]]:
    """Write a complete bundle to a hidden file, which the caller then renames."""
    work: Path | None = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        remove_abandoned(folder, _UNFINISHED)
        work = unfinished_folder(folder, _UNFINISHED)
        stage, file = work / "stage", work / "bundle.zip"
        stage.mkdir()
        manifest = staged(stage)
        _write_zip(stage, manifest, file)
        yield file, manifest
    except OSError as error:
        problem = f"cannot write to {folder}: {error.strerror or error}"
        raise InputError("SK-CLI-016", problem) from None
    finally:
        if work is not None:
            shutil.rmtree(work, ignore_errors=True)


def _stage_files(keeper: BundleRecorder, stage: Path, failure: Failure | None, name: str, with_code: bool) -> Manifest:
    sim, spec, journal = keeper.sim, keeper.run, keeper.journal
    end = keeper.end(failure)
    first = keeper.window.first
    messages = list(_encodable_messages(keeper.window.messages(first), journal.gaps))
    journal.write_to(stage / COMMANDS)
    write_bag(stage / BAG, iter(messages), sim.communication.bus.latched())
    world = WorldStager(spec, stage).world(keeper)
    if with_code:
        copy_plugin_modules(world, stage, spec.options.get("plugin_paths", ()))
    if failure is not None:
        _write_error(stage, failure)
    world_name = sim.world.name if sim.world.name not in ("", "default") else Path(world.run.world).stem
    return Manifest(
        name=name or world_name or "run", **_world_fields(world, sim), missing=(*world.missing, *journal.gaps),
        seconds=keeper.seconds, topics=keeper.topics, first=first, end=end, streams=topic_digests(iter(messages)),
        marks=tuple(keeper.marks.found), commands=journal.count, files=_file_table(stage),
    )  # fmt: skip


def pack_load_failure(spec: RunSpec, folder: Path, failure: Failure) -> Path:
    """Write a bundle of a world that failed while it was loaded.

    Args:
        spec: Specification of the run.
        folder: Folder for the bundle.
        failure: Failure that occurred during loading.

    Returns:
        Path of the bundle.
    """
    spec = replace(spec, folder=spec.folder.absolute())

    def staged(stage: Path) -> Manifest:
        (stage / COMMANDS).touch()
        write_bag(stage / BAG, iter(()), frozenset())
        world = WorldStager(spec, stage).unloaded()
        copy_plugin_modules(world, stage, spec.options.get("plugin_paths", ()))
        _write_error(stage, failure)
        end, name = RunEnd(0, 0, 0, "", failure), Path(world.run.world).stem
        fields = _world_fields(world)
        return Manifest(name=name, **fields, missing=tuple(world.missing), end=end, files=_file_table(stage))

    return _write_with_generated_name(folder, staged)


def _world_fields(world: StagedWorld, sim: Simulation | None = None) -> JsonObject:
    """Return the manifest fields that describe the run and the machine.

    Args:
        world: Files of the world.
        sim: Simulation of the run; None if loading failed.
    """
    fell = sim is not None and fell_back(sim)
    return {
        "run": world.run.with_values({"renderer": SOFTWARE}) if fell else world.run,
        "models": world.models,
        "code": tuple(sorted(world.code)),
        "fingerprint": fingerprint(sim if sim is not None and sim.engine.renderer else None),
    }


def _write_error(stage: Path, failure: Failure) -> None:
    """Write the error message and, during exception handling, the traceback."""
    error = sys.exception()
    text = "".join(traceback.format_exception(error)) if error is not None else failure.text + "\n"
    (stage / "error.txt").write_text(strip_folders(text), encoding="utf-8", errors="replace")


def _encodable_messages(messages: Iterator[WindowMessage], gaps: list[str]) -> Iterator[WindowMessage]:
    """Iterate over messages up to the first that cannot be serialised, so that the bundle is written in any case."""
    try:
        yield from messages
    except Exception as error:  # noqa: BLE001 - the state after a failed run may raise any exception
        gaps.append(f"some messages of the last seconds could not be created: {error!r:.200}")


def _file_table(stage: Path) -> dict[str, JsonObject]:
    table: dict[str, JsonObject] = {}
    for path in sorted(path for path in stage.rglob("*") if path.is_file()):
        name = path.relative_to(stage).as_posix()
        problem = name_fault(name)
        if problem:
            raise InputError(UNPACKED, f"the world cannot be packed: the file {name!r:.100} {problem}")
        with path.open("rb") as file:
            table[name] = {"size": path.stat().st_size, "sha256": hashlib.file_digest(file, "sha256").hexdigest()}
    total = sum(entry["size"] for entry in table.values())
    if total > MAX_BYTES:
        problem = f"the files of the run have {total >> 20} MiB; the limit is {MAX_BYTES >> 20} MiB"
        raise InputError(UNPACKED, problem)
    return table


def _write_zip(stage: Path, manifest: Manifest, target: Path) -> None:
    """Write an archive with sorted names, without times and owners, so that its bytes depend only on the content."""
    with target.open("wb") as raw:
        with zipfile.ZipFile(raw, "w") as archive:
            for name in (PAGE, *sorted(manifest.files)):
                info = zipfile.ZipInfo(name, _EPOCH)
                is_packed = name == BAG or Path(name).suffix.lower() in (".png", ".jpg", ".jpeg", ".webp")
                info.compress_type = zipfile.ZIP_STORED if is_packed else zipfile.ZIP_DEFLATED
                info.external_attr, info.create_system = _PLAIN, _UNIX
                if name == PAGE:
                    archive.writestr(info, manifest.text())
                    continue
                with (stage / name).open("rb") as source, archive.open(info, "w") as file:
                    shutil.copyfileobj(source, file, 1 << 20)
        raw.flush()
        os.fsync(raw.fileno())
