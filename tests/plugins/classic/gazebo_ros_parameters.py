"""Program that writes the table of the parameters that the plugins of gazebo_ros_pkgs read.

The table, `simkit/plugins/classic/gazebo_ros_parameters.toml`, has the names of the elements by library and version of
ROS. The program finds the names in the sources of a clone, in which every access has a literal name, such as
`_sdf->Get<double>("update_rate")`::

    git clone -b ros2 https://github.com/ros-simulation/gazebo_ros_pkgs ros2
    git clone -b noetic-devel https://github.com/ros-simulation/gazebo_ros_pkgs ros1
    python tests/plugins/classic/gazebo_ros_parameters.py ros2 ros1
"""

from __future__ import annotations

import re
import sys
import textwrap
from pathlib import Path

import simkit

TABLE = Path(simkit.__file__).parent / "plugins" / "classic" / "gazebo_ros_parameters.toml"
_HEAD = """\
# Names of the elements that the plugins of gazebo_ros_pkgs read, by library and by version of ROS: branches ros2 and
# noetic-devel. Written by tests/plugins/classic/gazebo_ros_parameters.py; do not edit.
"""
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
_ACCESS = re.compile(r'(?:->|\.)\s*(?:HasElement|GetElement(?:Impl)?|FindElement|Get\s*<[^>]*>)\s*\(\s*"([^"]+)"')
_HELPER = re.compile(r'getParameter\w*\s*(?:<[^>]*>)?\s*\(\s*[^,"()]+,\s*"([^"]+)"')  # of ROS 1's GazeboRos


def parameters_in(text: str) -> list[str]:
    """Return the names of the elements that a source reads, without repetitions, in alphabetical order."""
    code = _COMMENT.sub("", text)
    return sorted({*_ACCESS.findall(code), *_HELPER.findall(code)})


def table_of(clones: dict[str, Path]) -> str:
    """Return the table of the clones by version of ROS."""
    found: dict[str, dict[str, list[str]]] = {}
    for version, clone in clones.items():
        for source in sorted(clone.glob("gazebo_plugins/src/gazebo_ros_*.cpp")):
            names = parameters_in(source.read_text(encoding="utf-8", errors="replace"))
            if names:
                found.setdefault(source.stem, {})[version] = names
    lines = [_HEAD]
    for library, versions in sorted(found.items()):
        lines.append(f"[{library}]")
        for version, names in versions.items():
            lines += [f"{version} = '''", textwrap.fill(" ".join(names), 110), "'''"]
        lines.append("")
    return "\n".join(lines)


if __name__ == "__main__":
    TABLE.write_text(table_of({"ros2": Path(sys.argv[1]), "ros1": Path(sys.argv[2])}), encoding="utf-8")
