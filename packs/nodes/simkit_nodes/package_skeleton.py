"""New ROS 2 packages in Python: the files that `simkit pkg create` writes."""

from __future__ import annotations

import re
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Final

from simkit.errors import InputError

_NAME: Final = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
_INVALID_NAME: Final = "SK-NODE-062"
_EXISTS: Final = "SK-NODE-063"

_MANIFEST: Final = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>{description}</description>
  <maintainer email="{email}">{maintainer}</maintainer>
  <license>{license}</license>

  {depends}

  <test_depend>python3-pytest</test_depend>

  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
"""

_SETUP: Final = """from setuptools import find_packages, setup

package_name = {name!r}

setup(
    name=package_name,
    version="0.0.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer={maintainer!r},
    maintainer_email={email!r},
    description={description!r},
    license={license!r},
    entry_points={{"console_scripts": [{scripts}]}},
)
"""

_SETUP_SETTINGS: Final = """[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""

_NODE: Final = """import rclpy
from rclpy.node import Node


class {class_name}(Node):
    def __init__(self):
        super().__init__("{node}")
        self.timer = self.create_timer(1.0, self.on_timer)

    def on_timer(self):
        self.get_logger().info("hello")


def main(args=None):
    rclpy.init(args=args)
    node = {class_name}()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
"""


def write_package(
    name: str,
    folder: Path,
    *,
    node: str | None = None,
    dependencies: tuple[str, ...] = (),
    description: str = "TODO: Package description",
    license_: str = "TODO: License declaration",
    maintainer: str = "user",
    email: str = "user@todo.todo",
) -> list[Path]:
    """Write a ROS 2 package in Python with the build type `ament_python`.

    Args:
        name: name of the package.
        folder: folder in which the folder of the package is made.
        node: name of an executable with a small node; None for a package without nodes.
        dependencies: packages on which the package depends, besides `rclpy` for a node.
        description: description.
        license_: name of the licence.
        maintainer: name of the maintainer.
        email: address of the maintainer.

    Returns:
        Written files, in the order of writing.

    Raises:
        InputError: SK-NODE-062 the name of the package or of the node is invalid; SK-NODE-063 the folder of the package
            exists, or a file cannot be written.
    """
    for what, text in (("a package", name), ("an executable", node)):
        if text is not None and not _NAME.fullmatch(text):
            hint = "use lower-case letters, digits and single _ between them, with a letter first"
            raise InputError(_INVALID_NAME, f"{text!r:.80} cannot be the name of {what}", help=hint)
    place = folder / name
    if place.exists():
        raise InputError(_EXISTS, f"{place} exists already", help="use another name or another folder")
    depends = [*dict.fromkeys((*(["rclpy"] if node else []), *dependencies))]
    manifest = _MANIFEST.format(
        name=name,
        description=escape(description, quote=False),
        email=escape(email),
        maintainer=escape(maintainer),
        license=escape(license_),
        depends="\n  ".join(f"<depend>{escape(depend)}</depend>" for depend in depends),
    )
    scripts = f'"{node} = {name}.{node}:main"' if node else ""
    setup = _SETUP.format(
        name=name, maintainer=maintainer, email=email, description=description, license=license_, scripts=scripts
    )
    files = {
        "package.xml": manifest if depends else manifest.replace("  \n\n", ""),
        "setup.py": setup,
        "setup.cfg": _SETUP_SETTINGS.format(name=name),
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
    }
    if node:
        class_name = "".join(part.capitalize() for part in node.split("_"))
        files[f"{name}/{node}.py"] = _NODE.format(class_name=class_name, node=node)
    return _write(place, files)


def _write(place: Path, files: Mapping[str, str]) -> list[Path]:
    paths = []
    for name, text in files.items():
        path = place / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8")
        except OSError as error:
            raise InputError(_EXISTS, f"cannot write {path}: {error.strerror}") from error
        paths.append(path)
    return paths
