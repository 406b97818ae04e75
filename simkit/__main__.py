"""Entry point for `python -m simkit`, which runs the command `simkit`."""

import sys

if __name__ == "__main__" and not sys.flags.safe_path:
    # Python searches the working directory first, so that a file `random.py` of the user would replace the module of
    # the standard library. Plugins in the working directory are still found at the end of the path.
    sys.path.append(sys.path.pop(0))

from simkit.cli import main

if __name__ == "__main__":
    main()
