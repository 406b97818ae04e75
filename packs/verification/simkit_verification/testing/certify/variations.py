"""Environments of the runs of a certificate, which must not change any output."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, replace
from itertools import chain, count, islice
from pathlib import Path
from typing import Final, Literal

from simkit.home_folder import home_folder

Listening = Literal["called", "kept", "none", "late"]
"""Kind of subscription: callbacks, a queue that is read later, no subscribers, or two from half of the run on."""

Detour = Literal["", "restore", "reset"]
"""Detour during the run: a snapshot, further steps and a restore in the middle, or a reset at the beginning."""

_THREADS: Final = (
    *("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"),
    "LP_NUM_THREADS",
)


@dataclass(frozen=True)
class Variation:
    """Environment of one run.

    Attributes:
        name: Name in the table.
        words: Difference from a normal environment, in words.
        hash_seed: Seed of Python's string hashes (`PYTHONHASHSEED`).
        threads: Number of threads for OpenMP, BLAS and software rendering.
        render_thread: True if pictures are rendered in parallel with the physics.
        listening: Kind of subscription.
        elsewhere: True if working directory, home, time zone, language and temporary folder differ.
        detour: Detour during the run.
    """

    name: str
    words: str
    hash_seed: int = 0
    threads: int = 1
    render_thread: bool = False
    listening: Listening = "called"
    elsewhere: bool = False
    detour: Detour = ""

    def environment(self, folder: Path) -> dict[str, str]:
        """Return the environment variables of the process.

        Args:
            folder: Empty folder for this process.
        """
        variables = dict(os.environ)
        variables["PYTHONHASHSEED"] = str(self.hash_seed)
        variables["PYTHONPATH"] = os.pathsep.join(str(Path(place).absolute()) for place in sys.path)
        variables.update(dict.fromkeys(_THREADS, str(self.threads)))
        if self.elsewhere:
            home = folder / "home"
            home.mkdir()
            # models that Gazebo downloaded are found in these folders, although HOME differs
            fetched = (home_folder() / name / "fuel" for name in (".gz", ".ignition"))
            caches = [variables.get("GZ_FUEL_CACHE_PATH", ""), *(str(place) for place in fetched if place.is_dir())]
            variables["GZ_FUEL_CACHE_PATH"] = os.pathsep.join(place for place in caches if place)
            variables.update(HOME=str(home), USERPROFILE=str(home), TZ="Asia/Kathmandu", LANG="C", LC_ALL="C")
            variables.update(XDG_CACHE_HOME=str(home / "cache"), TMPDIR=str(folder), USER="somebody", COLUMNS="61")
            variables.pop("SIMKIT_CACHE_DIR", None)
        return variables

    def working_directory(self, folder: Path) -> Path:
        """Return the working directory of the process."""
        return folder if self.elsewhere else Path.cwd()


VARIATIONS: Final = (
    Variation("as it is", "hash seed 0, one thread, a callback on every topic"),
    Variation(
        "elsewhere",
        "different hash seed, working directory, HOME, TZ, LANG; messages collected",
        4711,
        2,
        True,
        "kept",
        True,
    ),
    Variation(
        "not received", "no subscribers; different hash seed, pictures rendered in parallel", 17, 4, True, "none"
    ),
    Variation("late", "two subscribers on each topic from half time on; different hash seed", 99, 2, False, "late"),
    Variation(
        "restored",
        "half time: snapshot, more steps, spawn, restore; different hash seed",
        5,
        1,
        True,
        "kept",
        detour="restore",
    ),
    Variation("reset", "short run, then reset; different hash seed", 23, 1, False, "called", detour="reset"),
)
"""Environments of the runs; the first one belongs to the reference run."""


def choose_variations(runs: int, *, with_restore: bool = True) -> list[Variation]:
    """Return one variation for each run: `VARIATIONS`, then the same ones with other hash seeds.

    Args:
        runs: number of runs.
        with_restore: False to leave out the run that restores a snapshot.
    """
    chosen = [variation for variation in VARIATIONS if with_restore or variation.detour != "restore"]
    repeated = (
        replace(variation, name=f"{variation.name} {round_}", hash_seed=variation.hash_seed + 7919 * round_)
        for round_ in count(2)
        for variation in chosen[1:]
    )
    return list(islice(chain(chosen, repeated), runs))
