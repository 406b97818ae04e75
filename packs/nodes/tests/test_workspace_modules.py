"""Tests: a program imports the modules of its own workspace as if the workspace were built."""

from __future__ import annotations

from pathlib import Path

import simkit
from simkit_nodes.workspace import Workspace

WRITE = "from pathlib import Path\nPath(__file__).with_name('out.txt').write_text({})\n"


def write(folder: Path, files: dict[str, str]) -> None:
    """Write files by their path in a folder.

    A package is in a folder `src`; otherwise the folders of other tests above it would be searched, too.
    """
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def manifest(name: str) -> str:
    """Return a `package.xml`."""
    return f"<package format='3'><name>{name}</name></package>"


def log_of(file: Path) -> list[str]:
    """Run a program for a moment in an empty world and return its log."""
    sim = simkit.load("empty")
    try:
        node = sim.add_node(file)
        sim.run(0.01)
        assert node.error is None
        return (file.parent / "out.txt").read_text().split()
    finally:
        sim.close()


def test_a_script_imports_the_python_package_of_its_own_package(tmp_path: Path) -> None:
    write(
        tmp_path / "src/robot",
        {
            "package.xml": manifest("robot"),
            "src/robot/__init__.py": "",
            "src/robot/speed.py": "MAX = 3",
            "scripts/drive.py": "from robot.speed import MAX\n" + WRITE.format("str(MAX)"),
        },
    )
    assert log_of(tmp_path / "src/robot/scripts/drive.py") == ["3"]


def test_a_script_imports_the_python_package_of_another_package_of_the_workspace(tmp_path: Path) -> None:
    script = "import tools.shapes\n" + WRITE.format("tools.shapes.NAME")
    write(
        tmp_path / "src",
        {
            "robot/package.xml": manifest("robot"),
            "robot/robot/__init__.py": "",
            "robot/robot/drive.py": script,
            "tools/package.xml": manifest("tools"),
            "tools/tools/__init__.py": "",
            "tools/tools/shapes.py": "NAME = __name__",
        },
    )
    assert log_of(tmp_path / "src/robot/robot/drive.py") == ["tools.shapes"]


def test_folders_that_cmake_installs_as_python_modules_are_searched(tmp_path: Path) -> None:
    cmake = """
        # install(DIRECTORY old/ DESTINATION lib/python3/site-packages)
        ament_python_install_package(arm_tools PACKAGE_DIR python/arm_tools)
        install(DIRECTORY imp/ DESTINATION lib/python${VERSION}/site-packages/)
    """
    write(
        tmp_path / "src/arm",
        {
            "package.xml": manifest("arm"),
            "CMakeLists.txt": cmake,
            "python/arm_tools/__init__.py": "",
            "imp/arm_init.py": "",
            "old/arm_old.py": "",
            "setup_helper.py": "",
        },
    )
    workspace = Workspace(tmp_path / "src/arm/scripts/move.py")
    assert workspace.module_folder("arm_tools") == tmp_path / "src/arm/python"
    assert workspace.module_folder("arm_init") == tmp_path / "src/arm/imp"
    assert workspace.module_folder("arm_old") is None
    assert workspace.module_folder("setup_helper") is None, "a file beside package.xml is not installed"


def test_a_name_that_is_in_no_package_is_a_module_not_found_error(tmp_path: Path) -> None:
    write(tmp_path / "src/robot", {"package.xml": manifest("robot"), "drive.py": "import no_such_module"})
    sim = simkit.load("empty")
    node = sim.add_node(tmp_path / "src/robot/drive.py")
    sim.run(0.01)
    assert repr(node.error) == "ModuleNotFoundError(\"No module named 'no_such_module'\")"
    sim.close()


def test_a_program_imports_the_messages_of_another_package_of_the_workspace(tmp_path: Path) -> None:
    script = "from corpus_arm_msgs.msg import Tilt\nimport std_srvs.srv\n" + WRITE.format("repr(Tilt(angle=2.0))")
    write(
        tmp_path / "src",
        {
            "arm/package.xml": manifest("arm"),
            "arm/scripts/tilt.py": script,
            "arm_interfaces/package.xml": manifest("corpus_arm_msgs"),
            "arm_interfaces/msg/Tilt.msg": "float64 angle\n",
        },
    )
    assert log_of(tmp_path / "src/arm/scripts/tilt.py") == ["corpus_arm_msgs.msg.Tilt(angle=2.0)"]


def test_a_package_can_have_python_modules_and_messages(tmp_path: Path) -> None:
    script = "from corpus_lift import speed\nfrom corpus_lift.msg import Level\n" + WRITE.format(
        "repr(Level(number=speed.MAX))"
    )
    write(
        tmp_path / "src/lift",
        {
            "package.xml": manifest("corpus_lift"),
            "src/corpus_lift/__init__.py": "",
            "src/corpus_lift/speed.py": "MAX = 3",
            "msg/Level.msg": "int32 number\n",
            "scripts/lift.py": script,
        },
    )
    assert log_of(tmp_path / "src/lift/scripts/lift.py") == ["corpus_lift.msg.Level(number=3)"]


def test_a_second_program_finds_the_modules_of_a_package_whose_messages_the_first_has_imported(tmp_path: Path) -> None:
    package = tmp_path / "src/corpus_rover"
    files = {
        "package.xml": manifest("corpus_rover"),
        "msg/Wheel.msg": "float64 speed",
        "corpus_rover/__init__.py": "",
        "corpus_rover/speed.py": "MAX = 3",
        "scripts/first.py": "from corpus_rover.msg import Wheel\n" + WRITE.format("str(Wheel().speed)"),
        "scripts/second.py": "from corpus_rover import speed\n"
        + WRITE.replace("out", "second").format("str(speed.MAX)"),
    }
    write(package, files)
    with simkit.load("empty") as sim:
        nodes = [sim.add_node(package / "scripts" / name) for name in ("first.py", "second.py")]
        sim.run(0.01)
        assert [node.error for node in nodes] == [None, None]
    assert (package / "scripts/second.txt").read_text() == "3"


def test_a_ros_1_definition_can_use_a_type_whose_name_has_underscores(tmp_path: Path) -> None:
    script = "from corpus_gripper.msg import Grip\n" + WRITE.format("str(Grip().mode.level)")
    write(
        tmp_path / "src/gripper",
        {
            "package.xml": manifest("corpus_gripper"),
            "msg/generated/Grip.msg": "Grip_mode mode\n",
            "msg/generated/Grip_mode.msg": "int32 level\n",
            "scripts/grip.py": "try:\n    import rospy\nexcept ImportError:\n    pass\n" + script,
        },
    )
    assert log_of(tmp_path / "src/gripper/scripts/grip.py") == ["0"]


def test_a_program_whose_file_has_the_name_of_its_package_imports_other_modules_of_the_package(tmp_path: Path) -> None:
    write(
        tmp_path / "src/follower",
        {
            "package.xml": manifest("follower"),
            "follower/__init__.py": "",
            "follower/tools.py": "GAIN = 5",
            "follower/follower.py": "from follower.tools import GAIN\n" + WRITE.format("str(GAIN)"),
        },
    )
    assert log_of(tmp_path / "src/follower/follower/follower.py") == ["5"]


def test_a_package_in_another_workspace_of_the_same_repository_is_found(tmp_path: Path) -> None:
    write(
        tmp_path / "repository",
        {
            ".git/HEAD": "",
            "robots/arm/src/group/follower/package.xml": manifest("follower"),
            "robots/arm/src/group/follower/follower/follow.py": "from corpus_fleet_msgs.msg import Route\n"
            + WRITE.format("repr(Route())"),
            "fleet/src/interfaces/package.xml": manifest("corpus_fleet_msgs"),
            "fleet/src/interfaces/msg/Route.msg": "int32 length\n",
        },
    )
    assert log_of(tmp_path / "repository/robots/arm/src/group/follower/follower/follow.py") == [
        "corpus_fleet_msgs.msg.Route(length=0)"
    ]


def test_programs_of_one_folder_share_a_workspace_that_is_searched_once(tmp_path: Path) -> None:
    write(tmp_path / "src/robot", {"package.xml": manifest("robot"), "a.py": "import json", "b.py": "import json"})
    with simkit.load("empty") as sim:
        first, second = (sim.add_node(tmp_path / "src/robot" / name) for name in ("a.py", "b.py"))
        assert first.workspace is second.workspace
        sim.reset()
        assert first.workspace is second.workspace


def test_a_file_that_calls_no_function_runs_the_one_that_setup_py_names(tmp_path: Path) -> None:
    scripts = "{'console_scripts': ['wait = waiter.waiter:start_app']}"
    write(
        tmp_path / "waiter",
        {
            "package.xml": manifest("waiter"),
            "setup.py": f"from setuptools import setup\nsetup(name='waiter', entry_points={scripts})\n",
            "waiter/__init__.py": "",
            "waiter/waiter.py": "def start_app():\n    from pathlib import Path\n"
            "    Path(__file__).with_name('out.txt').write_text('started')\n",
        },
    )
    assert log_of(tmp_path / "waiter/waiter/waiter.py") == ["started"]
