"""Entry point for `python -m simkit`, which runs the command `simkit`."""

import sys

if __name__ == "__main__" and not sys.flags.safe_path:
    # Python searches the working directory first, so that a file `random.py` in it would replace the module of the
    # standard library, and a file `pandas.py` of a stranger would run. The program `simkit` does not search it either.
    del sys.path[0]

from simkit.cli import main

if __name__ == "__main__":
    main()
