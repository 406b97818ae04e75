"""ROS packages of a workspace are found, and their Python executables are read without running or building anything."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import simkit
from simkit.errors import InputError
from simkit_nodes.packages import compiled_executables_of, executables_of, python_folders
from simkit_nodes.setup_file import setup_arguments
from simkit_nodes.workspace import Workspace


def write(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def manifest(name: str) -> str:
    return f'<package format="3"><name>{name}</name><version>0.1.0</version></package>'


EMPTY = '<sdf version="1.9"><world name="w"/></sdf>'

SETUP = """
from glob import glob
import os
from setuptools import find_packages, setup

raise SystemExit("this file must not be run")
package_name = 'follow'
setup(
    name=package_name,
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/' + package_name, ['package.xml']),
        (os.path.join('share', package_name, 'launch'), glob('launch/*')),
    ],
    entry_points={'console_scripts': [
        'follower = follow.wall:main',
        f'other = {package_name}.wall:begin',
        'third = %s.sub.deep:main' % package_name,
        'missing = follow.nowhere:main',
    ] + ['copy_{0} = follow.wall:main'.format(n) for n in (1, 2)]},
)
"""

WALL = """
import sys
print("imported as", __name__)

def main():
    print("main of", sys.argv[0].rpartition("/")[2])

def begin():
    print("begin")
    return 3

if __name__ == "__main__":
    main()
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Path:
    return write(
        tmp_path / "ws",
        {
            "src/follow/package.xml": manifest("follow"),
            "src/follow/setup.py": SETUP,
            "src/follow/follow/__init__.py": "",
            "src/follow/follow/wall.py": WALL,
            "src/follow/follow/sub/__init__.py": "",
            "src/follow/follow/sub/deep.py": "def main(): pass\n",
            "src/follow/config/a.yaml": "a: 1\n",
            "src/mixed/package.xml": manifest("mixed"),
            "src/mixed/CMakeLists.txt": """
project(mixed)
# install(PROGRAMS scripts/commented.py DESTINATION lib/${PROJECT_NAME})
set(SCRIPTS scripts/one.py)
list(APPEND SCRIPTS "scripts/two")
add_executable(fast src/fast.cpp)
install(PROGRAMS ${SCRIPTS} scripts/tool.sh DESTINATION lib/${PROJECT_NAME})
install(PROGRAMS scripts/three.py DESTINATION lib/${PROJECT_NAME} RENAME renamed)
install(DIRECTORY nodes/ DESTINATION lib/mixed USE_SOURCE_PERMISSIONS)
install(DIRECTORY launch DESTINATION share/${PROJECT_NAME})
install(PROGRAMS ../outside.py DESTINATION lib/${PROJECT_NAME})
ament_python_install_package(helpers PACKAGE_DIR python/helpers)
""",
            "src/mixed/scripts/one.py": "print('one')\n",
            "src/mixed/scripts/two": "#!/usr/bin/env python3\nprint('two')\n",
            "src/mixed/scripts/three.py": "",
            "src/mixed/scripts/commented.py": "",
            "src/mixed/scripts/tool.sh": "#!/bin/sh\n",
            "src/mixed/nodes/four.py": "",
            "src/mixed/python/helpers/__init__.py": "",
            "src/outside.py": "",
            "src/old/package.xml": manifest("old"),
            "src/old/CMakeLists.txt": "catkin_package()\n",
            "src/old/nodes/talker.py": "#!/usr/bin/env python3\n",
        },
    )


def test_entry_points_of_setup_py_are_computed_without_running_it(workspace: Path) -> None:
    executables = executables_of(workspace / "src/follow")
    assert list(executables) == ["copy_1", "copy_2", "follower", "other", "third"]
    assert executables["other"].module == "follow.wall"
    assert executables["other"].function == "begin"
    assert executables["third"].file == workspace / "src/follow/follow/sub/deep.py"


def test_arguments_that_only_python_can_compute_are_left_out(workspace: Path) -> None:
    arguments = setup_arguments(workspace / "src/follow")
    assert arguments["name"] == "follow"
    assert "packages" not in arguments
    assert arguments["data_files"][0] == ["share/follow", ["package.xml"]]


def test_entry_points_may_be_in_setup_cfg_and_modules_in_src(tmp_path: Path) -> None:
    package = write(
        tmp_path / "pkg",
        {
            "package.xml": manifest("pkg"),
            "setup.py": "from setuptools import setup\nsetup(package_dir={'': 'source'}, scripts=['scripts/run.py'])\n",
            "setup.cfg": "[options.entry_points]\nconsole_scripts =\n    go = pkg.go:main\n",
            "source/pkg/go.py": "def main(): pass\n",
            "scripts/run.py": "",
        },
    )
    assert {name: executable.file for name, executable in executables_of(package).items()} == {
        "go": package / "source/pkg/go.py",
        "run.py": package / "scripts/run.py",
    }


def test_programs_that_cmake_installs_are_executables(workspace: Path) -> None:
    package = workspace / "src/mixed"
    files = {
        name: executable.file.relative_to(package).as_posix() for name, executable in executables_of(package).items()
    }
    assert files == {
        "four.py": "nodes/four.py",
        "one.py": "scripts/one.py",
        "renamed": "scripts/three.py",
        "two": "scripts/two",
    }
    assert compiled_executables_of(package) == ["fast"]
    assert package / "python" in python_folders(package)


def test_rosrun_starts_executable_files_that_nothing_installs(workspace: Path) -> None:
    file = workspace / "src/old/nodes/talker.py"
    assert executables_of(workspace / "src/old") == {}
    file.chmod(0o755)
    if os.access(file, os.X_OK):
        assert list(executables_of(workspace / "src/old")) == ["talker.py"]


def test_an_installed_package_has_the_executables_in_its_lib(tmp_path: Path) -> None:
    prefix = write(
        tmp_path / "install/pkg",
        {
            "share/pkg/package.xml": manifest("pkg"),
            "lib/pkg/script.py": "",
            "lib/python3.12/site-packages/pkg/node.py": "def main(): pass\n",
            "lib/python3.12/site-packages/pkg-0.1.egg-info/entry_points.txt": "[console_scripts]\nnode=pkg.node:main",
        },
    )
    assert list(executables_of(prefix / "share/pkg")) == ["node", "script.py"]


def test_a_workspace_has_the_packages_around_a_folder_and_those_of_simkit(workspace: Path) -> None:
    packages = Workspace(workspace / "src/follow/follow").packages()
    assert {"follow", "mixed", "old"} <= set(packages)
    assert Workspace(workspace).package("mixed") == workspace / "src/mixed"


def test_a_program_sees_the_folder_in_which_its_package_would_be_installed(
    workspace: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    file = workspace / "src/mixed/scripts/one.py"
    file.write_text("import os\nprint(os.environ['AMENT_PREFIX_PATH'])\n")
    with simkit.load(EMPTY) as sim:
        node = sim.add_node(file)
        sim.step(1)
    assert node.log == [str(workspace / "install/mixed")]
    assert "AMENT_PREFIX_PATH" not in os.environ


def test_package_paths_and_environment_variables_add_packages(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    assert Workspace(elsewhere).package("follow") is None
    assert Workspace(elsewhere, [workspace]).package("follow") == workspace / "src/follow"
    assert Workspace(elsewhere, {"follow": workspace / "src/follow"}).package("follow") == workspace / "src/follow"
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(workspace / "src"))
    assert Workspace(elsewhere).package("follow") == workspace / "src/follow"
    monkeypatch.delenv("ROS_PACKAGE_PATH")
    write(tmp_path / "prefix", {"share/installed/package.xml": manifest("installed")})
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    assert Workspace(elsewhere).package("installed") == tmp_path / "prefix/share/installed"


@pytest.mark.parametrize(
    ("program", "code", "text"),
    [
        ("folow/follower", "SK-NODE-060", "no ROS package 'folow'; did you mean 'follow'\\?"),
        ("follow/folower", "SK-NODE-061", "package 'follow' has no executable 'folower'; did you mean 'follower'\\?"),
        ("mixed/fast", "SK-NODE-061", "mixed/fast is written in C\\+\\+"),
        ("src/nothing.py", "SK-NODE-001", "no program 'src/nothing.py'"),
    ],
)
def test_a_program_that_does_not_exist_is_an_error(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, program: str, code: str, text: str
) -> None:
    monkeypatch.chdir(workspace)
    with (
        simkit.load(
            EMPTY,
        ) as sim,
        pytest.raises(InputError, match=text) as caught,
    ):
        sim.add_node(program)
    assert caught.value.code == code


def test_add_node_starts_an_executable_as_its_entry_point_does(
    workspace: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(workspace / "src")
    with simkit.load(EMPTY) as sim:
        node = sim.add_node("follow/follower")
        other = sim.add_node("follow/other")
        script = sim.add_node("mixed/one.py")
        sim.step(5)
    output = capfd.readouterr().out
    assert (node.name, other.name, script.name) == ("follower", "other", "one")
    assert (node.error, script.error) == (None, None)
    assert repr(other.error) == "SystemExit(3)"
    assert output.count("imported as follow.wall") == 2
    assert output.count("main of") == 1
    assert "begin" in output
    assert "one" in output


def test_package_paths_of_the_run_are_searched(
    workspace: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with simkit.load(EMPTY, package_paths=[workspace]) as sim:
        assert sim.add_node("mixed/one.py").file == workspace / "src/mixed/scripts/one.py"
