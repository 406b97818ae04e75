"""State of the process that each program has for itself: arguments, folder, environment, random numbers, streams."""

from __future__ import annotations

import io
import os
import random
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from rich.live import Live

import simkit
from simkit import Simulation
from simkit_nodes.programs import NodeProgram

Run = Callable[..., list[str]]


def test_two_programs_have_their_own_arguments_folder_and_environment(
    sim: Simulation, add_program: Callable[..., NodeProgram], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("ROBOT", "outer")
    monkeypatch.delenv("ADDED", raising=False)
    source = """
        import os, subprocess, sys, time
        name = sys.argv[1]
        os.makedirs(name, exist_ok=True)
        os.chdir(name)
        os.environ["ROBOT"] += name
        os.environ["ADDED"] = name
        os.environ.pop("HOME", None)
        time.sleep(0.1)
        shown = subprocess.run("echo $ROBOT $ADDED", shell=True, capture_output=True, text=True).stdout.strip()
        print(sys.argv[1:], os.path.basename(os.getcwd()), os.environ["ROBOT"], shown, "HOME" in os.environ)
    """
    monkeypatch.chdir(tmp_path)
    before = dict(os.environ), Path.cwd()
    nodes = [add_program(source, f"{name}.py", args=(name,)) for name in ("a", "b")]
    for _ in range(2):
        sim.run(0.1)
        assert (dict(os.environ), Path.cwd()) == before
    assert [node.log for node in nodes] == [
        ["['a'] a outera outera a False"],
        ["['b'] b outerb outerb b False"],
    ]


def test_a_program_whose_folder_was_removed_continues_in_that_of_the_process(run_program: Run) -> None:
    folder = Path.cwd()
    log = run_program("""
        import os, shutil, tempfile, time
        folder = tempfile.mkdtemp()
        os.chdir(folder)
        shutil.rmtree(folder)
        time.sleep(0.1)
        print(os.getcwd())
    """)
    assert log == [str(folder)] and Path.cwd() == folder


def test_a_program_whose_folder_another_one_removes_continues_in_that_of_the_process(
    sim: Simulation, add_program: Callable[..., NodeProgram], tmp_path: Path
) -> None:
    folder = Path.cwd()
    (tmp_path / "work").mkdir()
    source = """
        import os, sys, time
        os.chdir(sys.argv[1])
        time.sleep(0.2)
        print(os.getcwd())
    """
    node = add_program(source, args=(str(tmp_path / "work"),))
    sim.run(0.1)
    (tmp_path / "work").rmdir()
    sim.run(0.2)
    assert node.log == [str(folder)] and Path.cwd() == folder


RANDOM = """
    import os, random, secrets, uuid
    import numpy as np
    from numpy.random import default_rng
    print(random.random(), random.Random().random(), random.SystemRandom().random(), os.urandom(2), uuid.uuid4())
    random.seed()
    print(random.random(), uuid.uuid1(), secrets.token_hex(2))
    print(np.random.normal(), np.random.rand(2), default_rng().random(), np.random.default_rng().random())
    random.seed(3), np.random.seed(3)
    print(random.random(), np.random.rand(), np.random.default_rng(3).random())
"""


def test_random_numbers_follow_from_the_seed_of_the_run_and_the_name_of_the_node(
    sim: Simulation, add_program: Callable[..., NodeProgram]
) -> None:
    def log_of(seed: int, name: str) -> list[str]:
        with simkit.load(sim.run_spec.world, seed=seed) as other:
            node = other.add_node(file, name=name)
            other.run(0.01)
            assert node.error is None
            return node.log

    file = add_program(RANDOM).file
    assert file is not None
    first = log_of(1, "a")
    assert log_of(1, "a") == first
    assert all(line not in first for other in ((2, "a"), (1, "b")) for line in log_of(*other)[:3])
    random.seed(3)
    assert first[3] == f"{random.random()} {np.random.RandomState(3).rand()} {np.random.default_rng(3).random()}"


def test_the_generators_of_the_process_are_left_alone(run_program: Run) -> None:
    random.seed(1), np.random.seed(1)
    expected = random.random(), np.random.normal(), np.random.normal()
    random.seed(1), np.random.seed(1)
    first = random.random(), np.random.normal()
    run_program(RANDOM)
    assert (*first, np.random.normal()) == expected


def test_random_bytes_and_identifiers_are_told_with_their_line(
    run_program: Run, reports: Callable[[str], list[str]]
) -> None:
    run_program("""
        import os, uuid
        for _ in range(3):
            os.urandom(1)
        uuid.uuid4()
    """)
    first, second = reports("SK-NODE-050")
    assert "program.py:4: note" in first and "uuid" not in first
    assert "program.py:5: note" in second


def test_dates_follow_simulated_time_in_utc(run_program: Run) -> None:
    log = run_program("""
        import datetime, time
        from datetime import date, datetime as dt, timedelta
        time.sleep(0.5)
        print(dt.now(), dt.utcnow(), dt.today(), date.today(), dt.now(datetime.timezone.utc))
        print(isinstance(dt.now(), dt), isinstance(dt.now(), date), dt(2020, 1, 2) + timedelta(1))
        print(dt.strptime("3 2000", "%d %Y"), dt.fromtimestamp(1.5, datetime.timezone.utc).second)
        print(time.strftime("%H:%M:%S"), time.ctime(), time.localtime().tm_year, time.mktime(time.gmtime(9)))
    """)
    assert log == [
        "1970-01-01 00:00:00.500000 1970-01-01 00:00:00.500000 1970-01-01 00:00:00.500000 1970-01-01 "
        "1970-01-01 00:00:00.500000+00:00",
        "True True 2020-01-03 00:00:00",
        "2000-01-03 00:00:00 1",
        "00:00:00 Thu Jan  1 00:00:00 1970 1970 9.0",
    ]


def test_sockets_processes_and_loops_over_sets_are_told_with_their_line(
    run_program: Run, reports: Callable[[str], list[str]]
) -> None:
    run_program("""
        import os, socket, subprocess, sys
        names = {"left", "right"}
        for name in names:
            pass
        for number in {1, 2}:
            pass
        print(list(set(["a"])), sorted(names), [each for each in sorted({"a", "b"})])
        with socket.socket() as server: server.bind(("127.0.0.1", 0))
        subprocess.run([sys.executable, "-c", ""])
    """)
    assert [report.split(": ")[0].split("/")[-1] for report in reports("SK-NODE-054")] == [
        "program.py:4",
        "program.py:8",
    ]
    assert "program.py:9" in reports("SK-NODE-051")[0]
    assert "program.py:10" in reports("SK-NODE-052")[0]


def test_printed_lines_and_lines_of_logging_are_in_the_log_and_on_the_terminal(
    sim: Simulation, add_program: Callable[..., NodeProgram], capsys: pytest.CaptureFixture[str]
) -> None:
    node = add_program("""
        import logging, sys
        logging.basicConfig(level=logging.INFO, format="%(relativeCreated)d %(message)s")
        logging.getLogger("x").info("logged")
        print("a", "b")
        sys.stdout.write("part"), sys.stdout.flush()
        sys.stdout.buffer.write(b" bytes\\n")
        print("error", file=sys.stderr)
        print("without an end", end="")
    """)
    sim.run(0.01)
    sys.stdout.write("of the process\n")
    assert node.log == ["0 logged", "a b", "part bytes", "error", "without an end"]
    output = capsys.readouterr()
    assert output.out == "a b\npart bytes\nwithout an endof the process\n" and output.err == "0 logged\nerror\n"


def test_the_loggers_of_the_process_are_not_those_of_a_program(run_program: Run) -> None:
    import logging

    before = list(logging.getLogger().handlers), logging.getLogger().level
    run_program("import logging\nlogging.basicConfig(level=logging.DEBUG)")
    assert (list(logging.getLogger().handlers), logging.getLogger().level) == before


def test_a_redirected_output_stays_redirected_over_waits(run_program: Run) -> None:
    log = run_program("""
        import contextlib, io, time
        with contextlib.redirect_stdout(io.StringIO()) as text:
            print("hidden")
            time.sleep(0.1)
            print("too")
        print(text.getvalue().split())
    """)
    assert log == ["['hidden', 'too']"]
    assert not isinstance(sys.stdout, io.StringIO) or "hidden" not in sys.stdout.getvalue()


def test_a_program_sees_variables_that_a_script_changes_later_except_those_that_it_has_changed_itself(
    sim: Simulation, add_program: Callable[..., NodeProgram], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SCRIPT", "1")
    monkeypatch.setenv("PROGRAM", "1")
    source = """
        import os, time
        os.environ["PROGRAM"] = "2"
        while True:
            print(os.environ["SCRIPT"], os.environ["PROGRAM"], os.environb[b"PROGRAM"] if os.name != "nt" else b"2")
            time.sleep(0.1)
        """
    node = add_program(source)
    sim.run(0.05)
    assert os.environ["PROGRAM"] == "1"
    monkeypatch.setenv("SCRIPT", "3")
    monkeypatch.setenv("PROGRAM", "3")
    sim.run(0.1)
    assert node.log == ["1 2 b'2'", "3 2 b'2'"]
    assert os.environ["PROGRAM"] == "3"


def test_environment_of_a_program_begins_with_that_of_the_process(run_program: Run) -> None:
    assert run_program("import os\nprint(os.getenv('PATH') is not None, os.environ.get('NOT_THERE'))") == ["True None"]


def test_variables_of_ros_are_set_for_a_program_alone(run_program: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    assert run_program("import rclpy, os\nprint(os.environ['ROS_DISTRO'])") == ["jazzy"]
    assert "ROS_DISTRO" not in os.environ


def test_a_program_writes_above_the_display_of_a_run_on_a_terminal(
    sim: Simulation, add_program: Callable[..., NodeProgram], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stderr", terminal := io.StringIO())
    node = add_program('import sys\nprint("to stdout")\nprint("to stderr", file=sys.stderr, flush=True)')
    with Live("display", console=Console(stderr=True, force_terminal=True), auto_refresh=False):
        sim.run(0.1)
    assert node.log == ["to stdout", "to stderr"]
    assert terminal.getvalue().count("to stderr") == 1
