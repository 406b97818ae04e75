"""Run part `--bundle-on-failure`: write a bundle that repeats a failed run."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, ClassVar, Final

from simkit import RunSpec
from simkit.cli.run_part import fill_in_value
from simkit.cli.run_verdict import RunVerdict
from simkit.cli.terminal.json_report import add_to_report
from simkit.cli.terminal.output import print_message
from simkit.errors import InputError, SimkitError
from simkit.extend import RunPart, option

if TYPE_CHECKING:
    from simkit import Simulation
    from simkit_verification.testing.bundles import BundleRecorder
    from simkit_verification.testing.bundles.manifest import Failure

_DEFAULT_FOLDER: Final = "bundles"
_FAILED: Final = (1, 3, 4, 5)
_HELP = "Write a bundle for simkit replay into this folder if the run fails; default: bundles/."


@dataclass
class BundleOnFailure(RunPart):
    """Recorder of a run, which writes a bundle if loading or running fails."""

    place: ClassVar[int] = 35

    bundle_on_failure: Annotated[Path | None, option(_HELP, "[DIR]")] = None
    spec: RunSpec | None = field(init=False, default=None)
    recorder: BundleRecorder | None = field(init=False, default=None)

    @classmethod
    def complete_words(cls, words: list[str]) -> list[str]:
        """Give an option without a folder the default folder.

        The next word is the folder if the folder exists, if the word ends with a slash, or if the world is the first
        argument.
        """
        is_world_first = words[:1] != [] and not words[0].startswith("-")
        is_folder = partial(_is_folder, is_world_first=is_world_first)
        return fill_in_value(words, "--bundle-on-failure", _DEFAULT_FOLDER, is_folder)

    @contextmanager
    def around_run(self, spec: RunSpec, verdict: RunVerdict) -> Iterator[None]:
        """Check the folder, and write the bundle of a failed run.

        Raises:
            InputError: SK-CLI-016 the folder is not writable.
        """
        if self.bundle_on_failure is None:
            yield
            return
        from simkit.writers.atomic_output import check_folder

        check_folder(self.bundle_on_failure)
        self.spec = spec
        try:
            yield
        except BaseException as error:
            self._write(self.bundle_on_failure, spec, _failure(verdict, error))
            raise
        self._write(self.bundle_on_failure, spec, _failure(verdict, None))

    def after_loading(self, sim: Simulation) -> None:
        """Start to record the content of a bundle."""
        if self.spec is not None:
            from simkit_verification.testing.bundles import BundleRecorder

            self.recorder = BundleRecorder(sim, run=self.spec)

    def _write(self, folder: Path, spec: RunSpec, failure: Failure | None) -> None:
        """Write the bundle and print its path; the exit code of the run stays the same if this fails."""
        if failure is None:
            return
        from simkit_verification.testing.bundles.bundle_writer import pack_load_failure, write_failed

        try:
            if self.recorder is not None:
                path = write_failed(self.recorder, folder, failure)
            else:
                path = pack_load_failure(spec, folder, failure)
        except (SimkitError, OSError) as error:
            print_message(f"no bundle was written: {error}")
        else:
            add_to_report(bundle=str(path))
            print_message(f"bundle {path}; repeat the run with `simkit replay {path}`")


def _is_folder(word: str, *, is_world_first: bool) -> bool:
    """Check whether the word after the option is its folder."""
    if not word or word.startswith("-"):
        return False
    return is_world_first or word.endswith("/") or Path(word).is_dir()


def _failure(verdict: RunVerdict, error: BaseException | None) -> Failure | None:
    from simkit.cli.wall_time_limit import WallTimeExceeded
    from simkit_verification.testing.bundles.manifest import failure_from_checks, failure_from_error

    if isinstance(error, Exception) and not isinstance(error, InputError):
        code = error.exit_code if isinstance(error, SimkitError) else getattr(error, "exit_code", 1)
        return failure_from_error(error) if code in _FAILED else None
    if isinstance(error, WallTimeExceeded) or (error is None and verdict.code in _FAILED):
        return failure_from_checks(verdict.results, was_given_up=True)
    return None
