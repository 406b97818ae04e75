"""End of programs: at the end of the run, by an exception, by a loop that never waits, before a reset."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path

import pytest

from simkit import InputError, Simulation
from simkit_nodes.programs import NodeProgram

Add = Callable[..., NodeProgram]
Reports = Callable[[str], list[str]]


def test_the_end_of_the_run_is_ctrl_c_for_the_main_thread_and_finally_blocks_run(
    sim: Simulation, add_program: Add
) -> None:
    node = add_program("""
        import atexit, threading, time
        atexit.register(print, "atexit")
        stop = threading.Event()
        def work():
            try:
                while not stop.is_set():
                    time.sleep(0.1)
            finally:
                print("thread ends")
        thread = threading.Thread(target=work)
        thread.start()
        try:
            while True:
                time.sleep(1.0)
        except KeyboardInterrupt:
            print("interrupted")
        finally:
            stop.set()
            thread.join()
            time.sleep(0.5)
            print("main ends", time.time())
    """)
    sim.run(0.35)
    assert node.log == [] and not node.done
    sim.close()
    assert node.log == ["interrupted", "thread ends", "main ends 0.35", "atexit"]
    assert node.done and node.error is None


def test_a_program_that_catches_everything_is_asked_again_and_then_abandoned(
    sim: Simulation, add_program: Add, reports: Reports
) -> None:
    node = add_program("""
        import time
        count = 0
        while True:
            try:
                time.sleep(1.0)
            except:
                count += 1
                if count == 3:
                    print("asked", count)
    """)
    sim.run(0.1)
    before = threading.active_count()
    sim.close()
    assert node.log == ["asked 3"] and node.done and threading.active_count() <= before
    assert "program.py:6" in reports("SK-NODE-059")[0]


def test_a_handler_of_ctrl_c_is_called_and_the_program_then_goes_on(sim: Simulation, add_program: Add) -> None:
    node = add_program("""
        import signal, time
        is_running = True
        def stop(number, frame):
            global is_running
            is_running = False
            print("signal", number == signal.SIGINT)
        print(signal.signal(signal.SIGINT, stop) is signal.default_int_handler)
        signal.signal(signal.SIGTERM, lambda number, frame: None)
        print(signal.getsignal(signal.SIGINT) is stop)
        while is_running:
            time.sleep(0.1)
        print("stopped")
    """)
    sim.run(0.25)
    sim.close()
    assert node.log == ["True", "True", "signal True", "stopped"]


def test_handlers_of_a_thread_may_exit_the_program(sim: Simulation, add_program: Add) -> None:
    node = add_program("""
        import os, signal, sys, threading, time
        signal.signal(signal.SIGINT, lambda *_: sys.exit(3))
        time.sleep(0.1)
        os.kill(os.getpid(), signal.SIGINT)
    """)
    sim.run(0.2)
    assert node.done and node.exit_code == 3


@pytest.mark.parametrize(
    ("call", "code", "log"),
    [
        ("sys.exit()", 0, ["end"]),
        ("sys.exit(2)", 2, ["end"]),
        ("sys.exit('a reason')", 1, ["a reason", "end"]),
        ("raise SystemExit", 0, ["end"]),
        ("os._exit(5)", 5, []),
    ],
)
def test_a_program_exits_alone(sim: Simulation, add_program: Add, call: str, code: int, log: list[str]) -> None:
    node = add_program(
        f"import atexit, os, sys, time\natexit.register(print, 'end')\ntime.sleep(0.1)\n{call}\nprint('no')"
    )
    other = add_program("import time\ntime.sleep(0.3)\nprint('other')", "other.py")
    sim.run(0.5)
    assert (node.done, node.exit_code, node.log) == (True, code, log)
    assert isinstance(node.error, SystemExit) == bool(code)
    assert node.failure == (f"{node.name!r} ended with exit code {code}" if code else "")
    assert other.log == ["other"] and sim.time == pytest.approx(0.5)


def test_a_program_that_raises_ends_alone_with_its_own_traceback(sim: Simulation, add_program: Add) -> None:
    node = add_program("""
        import time
        def work():
            time.sleep(-1)
        time.sleep(0.1)
        work()
    """)
    other = add_program("import time\ntime.sleep(0.3)\nprint('other')", "other.py")
    sim.run(0.5)
    assert isinstance(node.error, ValueError) and node.done
    assert node.log[0] == "Traceback (most recent call last):" and node.log[-1].startswith("ValueError: sleep length")
    frames = [line.split(", line ")[1] for line in node.log if line.startswith("  File") and "program.py" in line]
    assert frames == ["6, in <module>", "4, in work"]
    assert node.log[1].endswith("line 6, in <module>"), "the first frame is the program's"
    assert other.log == ["other"]


def test_a_program_with_an_error_of_syntax_names_its_line(sim: Simulation, add_program: Add) -> None:
    node = add_program("x = 1\nif x\n    y = 2\n")
    sim.run(0.1)
    assert isinstance(node.error, SyntaxError)
    assert node.log[0].endswith('program.py", line 2') and node.log[1].strip() == "if x"


def test_a_failed_import_has_the_traceback_of_python_without_files_of_simkit(
    sim: Simulation, add_program: Add, tmp_path: Path
) -> None:
    nodes = [
        add_program("import part_of_it\n", files={"part_of_it.py": "from nowhere_msgs.msg import Thing\n"}),
        add_program("from sensor_msgs.msg import LaserScann\n", "second.py"),
    ]
    sim.run(0.1)
    header = "Traceback (most recent call last):"
    assert nodes[0].log == [
        header,
        f'  File "{tmp_path / "program.py"}", line 1, in <module>',
        "    import part_of_it",
        f'  File "{tmp_path / "part_of_it.py"}", line 1, in <module>',
        "    from nowhere_msgs.msg import Thing",
        "ModuleNotFoundError: No module named 'nowhere_msgs'",
    ]
    assert nodes[1].log[0] == header and nodes[1].log[-1].endswith("did you mean 'LaserScan'?")
    assert len(nodes[1].log) == 4


def test_an_exception_without_a_text_has_no_colon_at_its_end(sim: Simulation, add_program: Add) -> None:
    node = add_program("raise MemoryError\n")
    sim.run(0.1)
    assert node.failure.endswith("program.py:1")


def test_a_loop_that_calls_nothing_is_ended_after_a_wall_time_with_its_line(
    sim: Simulation, add_program: Add, reports: Reports
) -> None:
    node = add_program(
        """
        import time
        def compute():
            while True:
                pass
        time.sleep(0.1)
        compute()
        """,
        limit=0.2,
    )
    other = add_program("import time\ntime.sleep(0.3)\nprint('other')", "other.py")
    sim.run(0.5)
    assert node.done and node.error is not None and "program.py:4" in str(node.error).replace(":5", ":4")
    assert "program.py:" in reports("SK-NODE-056")[0] and "0.2 s" in reports("SK-NODE-056")[0]
    assert other.log == ["other"] and sim.time == pytest.approx(0.5)


def test_a_thread_that_never_waits_ends_its_program(sim: Simulation, add_program: Add) -> None:
    node = add_program(
        """
        import threading, time
        def compute():
            while True:
                pass
        threading.Thread(target=compute).start()
        while True:
            time.sleep(0.1)
        """,
        limit=0.2,
    )
    sim.run(0.3)
    assert node.done and "computes for more than 0.2 s" in str(node.error) and sim.time == pytest.approx(0.3)


@pytest.mark.slow
def test_a_loop_that_catches_everything_and_calls_nothing_is_abandoned(sim: Simulation, add_program: Add) -> None:
    node = add_program(
        """
        import time
        ended = False
        begun = None
        while not ended:
            try:
                while not ended:
                    for _ in range(1000): pass
            except BaseException:
                pass
        """,
        limit=0.1,
    )
    sim.run(0.1)
    assert node.done and node.error is not None and sim.time == pytest.approx(0.1)
    vars(node.process.modules["__main__"])["ended"] = True  # lets the thread end, which nobody waits for


def test_a_reset_ends_programs_before_the_time_jumps_and_starts_them_anew(sim: Simulation, add_program: Add) -> None:
    node = add_program("""
        import time
        begun = time.time()
        try:
            while True:
                time.sleep(0.1)
        finally:
            print("end", begun, time.time())
    """)
    lines: list[str] = []
    sim.run(0.25)
    program_log = node.log
    sim.reset()
    assert program_log == [] and not node.done
    sim.run(0.15)
    sim.close()
    lines += node.log
    assert lines == ["end 0.0 0.15"]


def test_snapshots_and_restores_tell_once_that_programs_are_not_in_them(
    sim: Simulation, add_program: Add, reports: Reports
) -> None:
    node = add_program("""
        import time
        for _ in range(4):
            time.sleep(0.1)
            print(round(time.time(), 3))
    """)
    sim.run(0.15)
    snapshot = sim.snapshot()
    sim.run(0.1)
    sim.restore(snapshot)
    sim.run(0.3)
    assert node.log == ["0.1", "0.2", "0.2", "0.3"], "the program waits on for as long as before"
    assert len(reports("SK-NODE-057")) == 1


def test_threads_of_an_ended_simulation_are_gone(sim: Simulation, add_program: Add) -> None:
    before = threading.active_count()
    add_program("""
        import threading, time
        for _ in range(5):
            threading.Thread(target=time.sleep, args=(9,)).start()
        time.sleep(9)
    """)
    sim.run(0.1)
    sim.close()
    assert threading.active_count() <= before


def test_an_exception_after_the_end_of_the_run_is_printed_but_is_no_error(sim: Simulation, add_program: Add) -> None:
    node = add_program("""
        import time
        try:
            time.sleep(9)
        finally:
            raise RuntimeError("shut down twice")
    """)
    sim.run(0.1)
    sim.close()
    assert node.done and node.error is None and node.log[-1] == "RuntimeError: shut down twice"


def test_ctrl_c_during_a_turn_ends_the_run_after_the_turn_and_then_the_programs(
    sim: Simulation, add_program: Add
) -> None:
    node = add_program("""
        import ctypes, time
        try:
            time.sleep(0.1)
            ctypes.pythonapi.PyErr_SetInterrupt()
            time.sleep(9)
        finally:
            print("end", time.time())
    """)
    with pytest.raises(KeyboardInterrupt):
        sim.run(1.0)
    assert sim.time == pytest.approx(0.1) and not node.done
    sim.close()
    assert node.log == ["end 0.1"] and node.error is None


def test_a_node_cannot_step_the_simulation(sim: Simulation) -> None:
    node = sim.add_node(lambda: sim.run(1.0), name="stepper")
    sim.run(0.1)
    assert isinstance(node.error, InputError) and node.error.code == "SK-NODE-002"
