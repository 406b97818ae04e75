"""Command `xacro`: expands a file, into another file with `-o`."""

from __future__ import annotations

import os
import sys

from rclpy.utilities import remove_ros_args

from simkit_launch.xacro_command import expand_file


def main() -> int:
    """Expand the file of the command line, whose paths are relative to the folder of the process."""
    words = remove_ros_args(sys.argv)[1:]
    words = [word if word.startswith("-") or ":=" in word else os.path.abspath(word) for word in words]
    return expand_file(words, sys.stdout, sys.stderr)


if __name__ == "__main__":
    sys.exit(main())
