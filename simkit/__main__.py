"""Entry point for `python -m simkit`, which runs the command `simkit`."""

from simkit.cli import main

if __name__ == "__main__":
    main()
