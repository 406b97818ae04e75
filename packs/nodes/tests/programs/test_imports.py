"""Imports of programs: each has its own modules, and nothing of them stays in the process."""

from __future__ import annotations

import builtins
import sys
from collections.abc import Callable

import pytest

import simkit
from simkit import Simulation
from simkit_nodes.programs import NodeProgram

Run = Callable[..., list[str]]


def test_a_program_imports_its_own_modules_early_late_in_threads_and_by_name(run_program: Run) -> None:
    log = run_program(
        """
        import threading, importlib, sys
        import helper
        def late():
            from parts.wheel import radius
            import parts.wheel as wheel
            print(radius, wheel is sys.modules["parts.wheel"])
        thread = threading.Thread(target=late)
        thread.start()
        thread.join()
        print(importlib.import_module("parts.motor").name, __import__("helper").text)
        print(sys.modules[__name__].__name__, importlib.reload(helper) is helper)
        """,
        files={
            "helper.py": "text = 'helper'\n",
            "parts/__init__.py": "",
            "parts/wheel.py": "from .motor import name\nfrom . import motor\nradius = 0.1\n",
            "parts/motor.py": "name = 'motor'\n",
        },
    )
    assert log == ["0.1 True", "motor helper", "__main__ True"]


def test_nothing_of_a_program_stays_in_the_process(sim: Simulation, add_program: Callable[..., NodeProgram]) -> None:
    before = {
        "modules": {name for name in sys.modules if not name.startswith("simkit")},
        "path": list(sys.path),
        "argv": list(sys.argv),
    }
    main = sys.modules["__main__"]
    add_program(
        """
        import sys, time
        import helper_of_a_program
        sys.path.append("/nowhere")
        sys.argv.append("more")
        sys.modules["hardware"] = type(sys)("hardware")
        time.sleep(0.1)
        import hardware, helper_of_a_program.late
        print("here")
        """,
        files={"helper_of_a_program/__init__.py": "import time", "helper_of_a_program/late.py": ""},
    )
    sim.run(0.05)
    for _ in range(2):
        added = {name for name in sys.modules if not name.startswith("simkit")} - before["modules"]
        assert not {name for name in added if "helper" in name or name in ("hardware", "rclpy", "__main__")}
        assert (sys.path, sys.argv) == (before["path"], before["argv"])
        assert sys.modules["__main__"] is main
        sim.run(0.1)
    assert sim.nodes[0].log == ["here"]


def test_built_in_names_that_a_program_replaces_are_its_own(
    sim: Simulation, add_program: Callable[..., NodeProgram]
) -> None:
    before = dict(vars(builtins))
    first = add_program(
        """
        import builtins, importlib, time
        import helper
        original = print
        builtins.print = lambda *words: original("first:", *words)
        __builtins__.len = lambda items: -1
        time.sleep(0.2)
        helper.show([1, 2])
        print(importlib.import_module("builtins") is builtins, builtins.__import__ is __import__)
        """,
        files={"helper.py": "def show(items):\n    print(len(items))\n"},
    )
    second = add_program("import time\ntime.sleep(0.1)\nprint(len([1, 2]))\n", "second.py")
    sim.run(0.15)
    assert vars(builtins) == before
    sim.run(0.15)
    assert first.error is None and first.log == ["first: -1", "first: True True"]
    assert second.log == ["2"] and vars(builtins) == before


def test_two_programs_have_modules_of_the_same_name(sim: Simulation, add_program: Callable[..., NodeProgram]) -> None:
    source = """
        import time, utils
        time.sleep(0.1)
        from utils import name
        import utils.more
        print(name, utils.more.name, __file__.split("/")[-2])
    """
    first = add_program(source, "a/program.py", {"a/utils/__init__.py": "name = 1", "a/utils/more.py": "name = 2"})
    second = add_program(source, "b/program.py", {"b/utils/__init__.py": "name = 3", "b/utils/more.py": "name = 4"})
    sim.run(0.2)
    assert (first.log, second.log) == (["1 2 a"], ["3 4 b"])


def test_a_module_of_the_process_with_the_same_name_is_another_one(
    sim: Simulation, add_program: Callable[..., NodeProgram], monkeypatch: pytest.MonkeyPatch
) -> None:
    outer = type(sys)("config")
    outer.value = "of the process"  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "config", outer)
    node = add_program(
        """
        import time, config
        time.sleep(0.1)
        import config as again
        print(config.value, again is config)
        """,
        files={"config.py": "value = 'of the program'"},
    )
    sim.run(0.2)
    assert node.log == ["of the program True"]
    assert sys.modules["config"] is outer


def test_a_file_of_a_package_has_relative_imports_and_its_main_function_is_called(run_program: Run) -> None:
    log = run_program(
        """
        from . import constants
        from .constants import name
        from robot.constants import name as same
        def main(args=None):
            print(name, same, constants.__name__, __name__)
        """,
        file="robot/node.py",
        files={"robot/__init__.py": "", "robot/constants.py": "name = 'waffle'"},
    )
    assert log == ["waffle waffle robot.constants __main__"]


def test_a_file_that_calls_its_main_function_itself_calls_it_once(run_program: Run) -> None:
    assert run_program("def main():\n    print('main')\nmain()\n") == ["main"]


def test_classes_of_a_program_are_pickled_copied_and_may_be_dataclasses(run_program: Run) -> None:
    log = run_program(
        """
        from __future__ import annotations
        import copy, enum, pickle, typing
        from dataclasses import dataclass, field
        import shapes
        @dataclass
        class Goal:
            name: str
            places: list[float] = field(default_factory=list)
        class Mode(enum.Enum):
            FAST = 1
        for each in (Goal("a"), Mode.FAST, shapes.Box(2)):
            print(pickle.loads(pickle.dumps(each)) == each, copy.deepcopy(each) == each)
        print(typing.get_type_hints(Goal)["places"])
        """,
        files={
            "shapes.py": "from __future__ import annotations\nfrom dataclasses import dataclass\n"
            "@dataclass\nclass Box:\n    size: int\n"
        },
    )
    assert log == ["True True"] * 3 + ["list[float]"]


def test_a_module_is_imported_from_a_file_and_by_runpy_with_the_imports_of_the_program(run_program: Run) -> None:
    log = run_program(
        """
        import importlib.util, os, runpy, time
        file = os.path.join(os.path.dirname(__file__), "other", "loaded.py")
        spec = importlib.util.spec_from_file_location("loaded", file)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        print(module.now())
        print(runpy.run_path(file)["now"]())
        exec("import time; time.sleep(0.1); print(time.time())", {})
        """,
        files={"other/loaded.py": "import time\ndef now():\n    time.sleep(0.1)\n    return time.time()\n"},
    )
    assert log == ["0.1", "0.2", "0.3"]


def test_a_file_with_the_name_of_a_module_of_python_is_the_one_of_the_program(run_program: Run) -> None:
    assert run_program("import queue\nprint(queue.name)", files={"queue.py": "name = 'own'"}) == ["own"]


def test_a_folder_without_init_is_imported_only_if_there_is_no_such_module(run_program: Run) -> None:
    log = run_program(
        """
        import json, nowhere_else.code
        print(json.dumps([1]), nowhere_else.code.value)
        """,
        files={"json/data.txt": "", "nowhere_else/code.py": "value = 1"},
    )
    assert log == ["[1] 1"]


def test_a_missing_module_and_a_missing_name_give_the_errors_of_python(run_program: Run) -> None:
    log = run_program("""
        for line in ("import not_there", "from threading import Nothing", "import asyncio.nothing"):
            try:
                exec(line)
            except ImportError as error:
                print(type(error).__name__, error.msg.split("(")[0])
    """)
    assert log == [
        "ModuleNotFoundError No module named 'not_there'",
        "ImportError cannot import name 'Nothing' from 'threading' ",
        "ModuleNotFoundError No module named 'asyncio.nothing'",
    ]


def test_installed_packages_in_pure_python_that_wait_are_the_program_s_own(
    run_program: Run, tmp_path: object, monkeypatch: pytest.MonkeyPatch
) -> None:
    site = f"{tmp_path}/site-packages"
    monkeypatch.syspath_prepend(site)
    log = run_program(
        """
        import time, waiting_package, using_package, counting_package
        waiting_package.pause(0.1)
        using_package.pause(0.1)
        print(time.time())
        """,
        files={
            "site-packages/waiting_package/__init__.py": "import time\ndef pause(s):\n    time.sleep(s)\n",
            "site-packages/using_package.py": "from waiting_package import pause\n",
            "site-packages/counting_package.py": "import json\n",
        },
    )
    assert log == ["0.2"]
    assert "counting_package" in sys.modules
    assert "waiting_package" not in sys.modules and "using_package" not in sys.modules
    del sys.modules["counting_package"]


def test_compiled_code_that_a_program_calls_imports_the_modules_of_the_process(
    run_program: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delitem(sys.modules, "uuid", raising=False)
    log = run_program(
        """
        import ctypes
        import_module = ctypes.pythonapi.PyImport_Import
        import_module.restype, import_module.argtypes = ctypes.py_object, [ctypes.py_object]
        print(import_module("uuid").__name__)
        """
    )
    assert log == ["uuid"]


def test_a_function_is_a_program_whose_imports_are_its_own(sim: Simulation) -> None:
    def program() -> None:
        import time

        time.sleep(0.1)
        times.append(time.time())

    times: list[float] = []
    node = sim.add_node(program)
    sim.run(0.2)
    assert (node.name, times, node.done) == ("program", [0.1], True)


def test_simkit_itself_is_shared_and_a_file_of_a_program_may_begin_with_its_name(run_program: Run) -> None:
    log = run_program(
        "import simkit, simkit_helper, sys\nprint(simkit.__file__ == sys.modules['simkit'].__file__, simkit_helper.x)",
        files={"simkit_helper.py": "x = 1"},
    )
    assert log == ["True 1"]
    assert "simkit_helper" not in sys.modules and isinstance(simkit.load, type(lambda: None))


def test_a_name_can_be_read_from_each_module_of_rclpy_that_imports_it_there(run_program: Run) -> None:
    log = run_program(
        """
        import rclpy
        from rclpy.clock import Duration
        from rclpy.node import ParameterDescriptor, QoSProfile
        import rclpy.duration
        print(Duration is rclpy.duration.Duration, rclpy.time.Duration is Duration, ParameterDescriptor().type)
        try:
            rclpy.clock.Publisher
        except AttributeError as error:
            print(error)
        """
    )
    assert log == ["True True 0", "module 'rclpy.clock' has no attribute 'Publisher'"]
