"""What is other from run to run, and may change nothing."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, replace
from itertools import chain, count, islice
from pathlib import Path
from typing import Final, Literal

Listening = Literal["called", "kept", "none", "late"]
"""How messages are heard: called back with each; kept and looked at later; by nobody; from half of the run, twice."""

Detour = Literal["", "restore", "reset"]
"""What the run does on its way: half of it, a snapshot, a second of something else, and back; or a reset."""

_THREADS: Final = (
    *("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS", "VECLIB_MAXIMUM_THREADS"),
    "LP_NUM_THREADS",
)


@dataclass(frozen=True)
class Variation:
    """The surroundings of one run.

    Attributes:
        name: what the table calls it.
        words: what is other, in words.
        hash_seed: of Python's hashes of texts.
        threads: for whatever computes on several (OpenMP, BLAS, software rendering).
        render_thread: whether pictures are drawn beside the physics.
        listening: how its messages are heard.
        elsewhere: whether working directory, home, time zone, language and temporary folder are others.
        detour: what it does on its way.
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
        """The variables of its process.

        Args:
            folder: an empty one of its own.
        """
        found = dict(os.environ)
        found["PYTHONHASHSEED"] = str(self.hash_seed)
        found["PYTHONPATH"] = os.pathsep.join(str(Path(place).absolute()) for place in sys.path)
        found.update(dict.fromkeys(_THREADS, str(self.threads)))
        if self.elsewhere:
            home = folder / "home"
            home.mkdir()
            # where models that Gazebo fetched lie, so that another HOME does not take a world's parts away
            fetched = (Path.home() / name / "fuel" for name in (".gz", ".ignition"))
            caches = [found.get("GZ_FUEL_CACHE_PATH", ""), *(str(place) for place in fetched if place.is_dir())]
            found["GZ_FUEL_CACHE_PATH"] = os.pathsep.join(place for place in caches if place)
            found.update(HOME=str(home), USERPROFILE=str(home), TZ="Asia/Kathmandu", LANG="C", LC_ALL="C")
            found.update(XDG_CACHE_HOME=str(home / "cache"), TMPDIR=str(folder), USER="somebody", COLUMNS="61")
            found.pop("SIMKIT_CACHE_DIR", None)
        return found

    def working_directory(self, folder: Path) -> Path:
        """Where its process stands."""
        return folder if self.elsewhere else Path.cwd()


VARIATIONS: Final = (
    Variation("as it is", "hash seed 0, one thread, a callback on every topic"),
    Variation(
        "elsewhere", "other hash seed, working directory, HOME, TZ, LANG; messages kept", 4711, 2, True, "kept", True
    ),
    Variation("unheard", "nobody subscribes; other hash seed, pictures drawn beside", 17, 4, True, "none"),
    Variation("late", "two subscribers on each topic from half way; other hash seed", 99, 2, False, "late"),
    Variation(
        "restored", "half way: snapshot, go on, spawn, restore; other hash seed", 5, 1, True, "kept", detour="restore"
    ),
    Variation("reset", "runs a little, then reset; other hash seed", 23, 1, False, "called", detour="reset"),
)
"""The first is what the others are compared with."""


def choose_variations(runs: int) -> list[Variation]:
    """So many variations: the first ones, and from then on repetitions with other hash seeds."""
    repeated = (
        replace(variation, name=f"{variation.name} {round_}", hash_seed=variation.hash_seed + 7919 * round_)
        for round_ in count(2)
        for variation in VARIATIONS[1:]
    )
    return list(islice(chain(VARIATIONS, repeated), runs))
