"""Commands `sleep` and `echo`."""

from __future__ import annotations

import math
import sys
import time
from pathlib import PurePath

_UNITS = {"s": 1.0, "m": 60.0, "h": 3600.0}


def main() -> int:
    """Run the command that the name of the executable names."""
    words = sys.argv[1:]
    if PurePath(sys.argv[0]).name == "echo":
        print(" ".join(words))
        return 0
    try:
        time.sleep(math.fsum(float(word.rstrip("smh")) * _UNITS.get(word[-1], 1.0) for word in words))
    except ValueError:
        print(f"sleep: invalid time interval: {' '.join(words)}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
