"""Commands in a process of limited memory."""

from __future__ import annotations

import resource
import subprocess
import sys
from collections.abc import Sequence

MIB = 1 << 20


def run_limited(
    arguments: Sequence[str], mebibytes: int, timeout: float = 120.0, **options: object
) -> subprocess.CompletedProcess[str]:
    """Run `simkit ARGUMENTS` in a process that cannot have more than a number of mebibytes of memory."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (mebibytes * MIB, mebibytes * MIB))

    return subprocess.run(
        [sys.executable, "-m", "simkit", *arguments],
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
        preexec_fn=limit,
        **options,  # type: ignore[call-overload]
    )
