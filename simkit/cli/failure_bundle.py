"""`simkit run --bundle-on-failure`: write a bundle that repeats a failed run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.terminal.json_report import add_to_report
from simkit.cli.terminal.output import print_status
from simkit.errors import InputError, SimkitError
from simkit.run_spec import RunSpec

if TYPE_CHECKING:
    from simkit.cli.run_verdict import RunVerdict
    from simkit.runtime import Simulation
    from simkit.testing.bundles import BundleRecorder
    from simkit.testing.bundles.manifest import Failure

DEFAULT_FOLDER: Final = "bundles"
"""Default folder of bundles."""
_FAILED: Final = (1, 3, 4, 5)


class FailureBundle:
    """Recorder that writes a bundle if a run fails; a context manager around loading and running.

    Args:
        folder: folder for bundles; None to record nothing.
        verdict: result of the run.
        spec: run specification, for a world that fails while it is loaded.

    Raises:
        InputError: SK-CLI-016 the folder is not writable.
    """

    def __init__(self, folder: Path | None, verdict: RunVerdict, spec: RunSpec) -> None:
        self._folder, self._verdict, self._spec = folder, verdict, spec
        self._recorder: BundleRecorder | None = None
        if folder is not None:
            from simkit.writers.atomic_output import check_folder

            check_folder(folder)

    def keep(self, sim: Simulation) -> None:
        """Start recording the content of a bundle; call this method right after loading."""
        if self._folder is not None:
            from simkit.testing.bundles import BundleRecorder

            self._recorder = BundleRecorder(sim, run=self._spec)

    def __enter__(self) -> FailureBundle:
        return self

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if self._folder is None:
            return
        failure = self._failure(error)
        if failure is not None:
            self._write(self._folder, failure)

    def _failure(self, error: BaseException | None) -> Failure | None:
        from simkit.cli.wall_time_limit import WallTimeExceeded
        from simkit.testing.bundles.manifest import failure_from_checks, failure_from_error

        if isinstance(error, Exception) and not isinstance(error, InputError):
            code = error.exit_code if isinstance(error, SimkitError) else getattr(error, "exit_code", 1)
            return failure_from_error(error) if code in _FAILED else None
        verdict = self._verdict
        if isinstance(error, WallTimeExceeded) or (error is None and verdict.code in _FAILED):
            return failure_from_checks(verdict.results, was_given_up=True)
        return None

    def _write(self, folder: Path, failure: Failure) -> None:
        """Write the bundle and print its path; the exit code of the run stays the same if this fails."""
        from simkit.testing.bundles.bundle_writer import pack_load_failure, write_failed

        try:
            if self._recorder is not None:
                path = write_failed(self._recorder, folder, failure)
            else:
                path = pack_load_failure(self._spec, folder, failure)
        except (SimkitError, OSError) as error:
            print_status(f"no bundle was written: {error}")
        else:
            add_to_report(bundle=str(path))
            print_status(f"bundle {path}; repeat the run with `simkit replay {path}`")
