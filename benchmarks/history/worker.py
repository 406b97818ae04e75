"""Process that measures one case of one checkout, a few rounds at each request; `checkouts.Worker` starts it.

Standard input has one JSON object a line; each is answered by one line on standard output.
"""

from __future__ import annotations

import gc
import json
import os
import sys
import tempfile
from pathlib import Path


def forget_other_checkouts() -> None:
    """Remove the folders of installed simkits from the import path, so that an old commit gets none of their packs."""
    mine = os.environ["SIMKIT_MEASURED"]
    sys.path[:] = [
        place
        for place in sys.path
        if place.startswith(mine) or not (any(Path(place).glob("simkit*/__init__.py")) and "site-packages" not in place)
    ]


def main() -> None:
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what simkit prints is no answer
    forget_other_checkouts()
    os.environ.setdefault("MUJOCO_GL", "egl")  # before the import of MuJoCo
    import cases

    import simkit

    if not str(simkit.__file__).startswith(os.environ["SIMKIT_MEASURED"]):
        raise SystemExit(f"another simkit is imported: {simkit.__file__}")
    case = cases.CASES[sys.argv[1]]
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        sides = case.make(Path(folder))
        for part in range(case.parts):
            timed(case, sides, part)  # the first calls fill caches
        gc.collect()
        print(json.dumps("ready"), file=answers, flush=True)
        for line in sys.stdin:
            rounds = json.loads(line)
            found: list[list[list[float]]] = [[[] for _ in range(case.parts)] for _ in sides]
            for _ in range(rounds):
                for part in range(case.parts):
                    for times, value in zip(found, timed(case, sides, part), strict=True):
                        times[part].append(value)
            print(json.dumps(found), file=answers, flush=True)
        os.chdir("/")


def timed(case: object, sides: tuple, part: int) -> list[float]:
    """Return the times of one part of both sides [s], or the values that they return."""
    found = []
    for side in sides:
        if hasattr(side, "before"):
            side.before(part)
        if case.clock is None:
            found.append(side(part))
            continue
        start = case.clock()
        side(part)
        found.append(case.clock() - start)
    return found


if __name__ == "__main__":
    main()
