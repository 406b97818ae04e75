"""Input of programs: scripted lines and keys, and windows that show nothing."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from simkit import Simulation
from simkit_nodes.programs import NodeProgram

Run = Callable[..., list[str]]


def test_a_text_is_the_standard_input_of_a_program_and_ends(run_program: Run) -> None:
    log = run_program(
        """
        import sys
        print(input("speed? "), int(input()) + 1)
        print(sys.stdin.readline().strip(), sys.stdin.read(1), list(sys.stdin))
        try:
            input()
        except EOFError:
            print("end")
        """,
        keys="fast\n4\nline\nkeys\nlast",
    )
    assert log == ["speed? fast 5", "line k ['eys\\n', 'last']", "end"]


def test_timed_keys_are_typed_at_their_times(run_program: Run) -> None:
    log = run_program(
        """
        import time
        print(input(), time.time())
        print(input(), time.time())
        print("never", input())
        """,
        keys=[(0.1, "wo"), (0.2, "rd\n"), (0.5, "x\n")],
    )
    assert log == ["word 0.2", "x 0.5"]


def test_a_program_waits_for_ever_if_nobody_types_and_this_is_told(
    sim: Simulation, add_program: Callable[..., NodeProgram], reports: Callable[[str], list[str]]
) -> None:
    node = add_program("\nname = input('name: ')\n")
    sim.run(0.5)
    assert not node.done and node.error is None and sim.time == pytest.approx(0.5)
    assert "program.py:2: warning" in reports("SK-NODE-053")[0]


@pytest.mark.skipif("sys.platform == 'win32'", reason="termios is a module of Unix")
def test_a_teleop_program_reads_single_keys_of_the_terminal(run_program: Run) -> None:
    log = run_program(
        """
        import select, sys, termios, time, tty
        settings = termios.tcgetattr(sys.stdin)
        def get_key(timeout):
            tty.setraw(sys.stdin.fileno())
            ready, _, _ = select.select([sys.stdin], [], [], timeout)
            key = sys.stdin.read(1) if ready else ""
            termios.tcsetattr(sys.stdin, termios.TCSADRAIN, settings)
            return key
        while time.time() < 0.5:
            key = get_key(0.1)
            print(repr(key), round(time.time(), 3))
            if key == "\\x03":
                break
        """,
        keys=[(0.05, "w"), (0.2, "\x03")],
    )
    assert log == ["'w' 0.05", "'' 0.15", "'\\x03' 0.2"]


@pytest.mark.skipif("sys.platform == 'win32'", reason="select knows only sockets there")
def test_a_wait_for_the_terminal_ends_when_a_key_is_typed(run_program: Run) -> None:
    log = run_program(
        """
        import os, select, time
        select.select([0], [], [])
        print(os.read(0, 9), time.time())
        """,
        keys=[(0.3, "ab")],
    )
    assert log == ["b'ab' 0.3"]


def test_listeners_of_pynput_get_the_keys(run_program: Run) -> None:
    log = run_program(
        """
        import time
        from pynput import keyboard
        from pynput.keyboard import Key
        def press(key):
            print(getattr(key, "char", None), key == Key.up, key == Key.esc, time.time())
            return key != Key.esc
        with keyboard.Listener(on_press=press) as listener:
            listener.join()
        """,
        keys=[(0.1, "w"), (0.2, "\x1b[A"), (0.3, "\x1b")],
    )
    assert log == ["w False False 0.1", "None True False 0.2", "None False True 0.3"]


def test_the_module_keyboard_gets_the_keys(run_program: Run) -> None:
    log = run_program(
        """
        import keyboard, time
        while not keyboard.is_pressed("q"):
            time.sleep(0.01)
        print(round(time.time(), 3))
        print(keyboard.read_key())
        """,
        keys=[(0.1, "q"), (0.2, "\x1b[B")],
    )
    assert log == ["0.1", "down"]


def test_windows_of_opencv_show_nothing_and_waits_for_keys_are_simulated_time(run_program: Run) -> None:
    pytest.importorskip("cv2")
    log = run_program(
        """
        import cv2, time
        import numpy as np
        cv2.namedWindow("w")
        cv2.createTrackbar("hue", "w", 30, 180, lambda value: None)
        for _ in range(3):
            cv2.imshow("w", np.zeros((2, 2, 3), np.uint8))
            print(cv2.waitKey(100), time.time(), cv2.getTrackbarPos("hue", "w"))
        print(cv2.waitKey(0) & 0xFF == ord("q"), cv2.cvtColor(np.zeros((1, 1, 3), np.uint8), cv2.COLOR_BGR2GRAY).shape)
        cv2.destroyAllWindows()
        """,
        keys=[(0.25, "q")],
    )
    assert log == ["-1 0.1 30", "-1 0.2 30", "113 0.25 30", "False (1, 1)"]


def test_figures_of_matplotlib_are_drawn_and_pauses_are_simulated_time(
    run_program: Run,
) -> None:
    pytest.importorskip("matplotlib")
    log = run_program(
        """
        import matplotlib
        matplotlib.use("TkAgg")
        import matplotlib.pyplot as plt
        import time
        plt.ion()
        plt.plot([1, 2])
        plt.pause(0.1)
        plt.show()
        print(time.time(), len(plt.gca().lines))
        """
    )
    assert log == ["0.1 1"]
