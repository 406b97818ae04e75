"""Threads, locks, queues and futures of a program: they wait in simulated time, in the same order in each run."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from simkit import Simulation
from simkit_nodes.programs import NodeProgram

Run = Callable[..., list[str]]


def test_a_thread_runs_beside_its_program_and_is_joined_at_the_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import threading, time
        def work():
            for _ in range(3):
                time.sleep(0.1)
                print("work", time.time())
        thread = threading.Thread(target=work)
        thread.start()
        thread.join(0.15)
        print("alive", thread.is_alive(), time.time())
        thread.join()
        print("ended", thread.is_alive(), time.time())
    """)
    assert log == ["work 0.1", "alive True 0.15", "work 0.2", "work 0.3", "ended False 0.3"]


def test_locks_conditions_events_semaphores_barriers_and_timers_wait_in_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import threading, time
        lock, event, gate = threading.Lock(), threading.Event(), threading.Barrier(2)
        condition, tickets = threading.Condition(), threading.BoundedSemaphore(1)
        def hold():
            with lock:
                time.sleep(0.1)
        threading.Thread(target=hold).start()
        time.sleep(0.01)
        print(lock.acquire(timeout=0.02), time.time())
        with lock:
            print("lock", time.time())
        with condition:
            print(condition.wait(0.1), time.time())
        threading.Timer(0.1, event.set).start()
        print(event.wait(), time.time())
        threading.Thread(target=lambda: (time.sleep(0.1), gate.wait())).start()
        gate.wait()
        print("barrier", time.time())
        tickets.acquire()
        print(tickets.acquire(timeout=0.1), time.time())
        again = threading.RLock()
        with again, again:
            print("again", time.time())
    """)
    assert log == [
        "False 0.03",
        "lock 0.1",
        "False 0.2",
        "True 0.3",
        "barrier 0.4",
        "False 0.5",
        "again 0.5",
    ]


def test_queues_of_all_kinds_wait_in_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import queue, threading, time
        for make in (queue.Queue, queue.LifoQueue, queue.PriorityQueue, queue.SimpleQueue):
            items = make()
            threading.Timer(0.1, items.put, (1,)).start()
            print(items.get(), time.time())
            try:
                items.get(timeout=0.1)
            except queue.Empty:
                print("empty", time.time())
    """)
    assert [line.split()[1][:3] for line in log] == ["0.1", "0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8"]
    assert [line.split()[0] for line in log] == ["1", "empty"] * 4


def test_many_uses_of_a_queue_or_semaphore_take_no_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import queue, threading, time
        items, tickets = queue.Queue(), threading.Semaphore(0)
        for number in range(500):
            items.put(number), tickets.release()
        print(sum(items.get() for _ in range(500)), all(tickets.acquire() for _ in range(500)), time.time())
    """)
    assert log == ["124750 True 0.0"]


def test_the_start_of_many_threads_takes_no_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import threading, time
        threads = [threading.Thread(target=time.sleep, args=(0.2,)) for _ in range(60)]
        for thread in threads:
            thread.start()
        print(time.time())
        for thread in threads:
            thread.join()
        print(time.time())
    """)
    assert log == ["0.0", "0.2"]


def test_the_end_of_the_run_ends_many_threads_in_silence(
    sim: Simulation, add_program: Callable[..., NodeProgram]
) -> None:
    node = add_program("""
        import threading, time
        for _ in range(60):
            threading.Thread(target=time.sleep, args=(100.0,)).start()
        print("started")
    """)
    sim.run(0.1)
    sim.close()
    assert node.log == ["started"] and node.error is None


def test_executors_run_in_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import time
        from concurrent.futures import ThreadPoolExecutor, as_completed
        def work(number):
            time.sleep(0.1 * number)
            return number
        with ThreadPoolExecutor(3) as executor:
            futures = [executor.submit(work, number) for number in (3, 1, 2)]
            for future in as_completed(futures):
                print(future.result(), time.time())
    """)
    assert log == ["1 0.1", "2 0.2", "3 0.3"]


def test_coroutines_and_their_executor_run_in_simulated_time(run_program: Run) -> None:
    log = run_program("""
        import asyncio, time
        async def work(duration):
            await asyncio.sleep(duration)
            return duration
        async def main():
            print(await asyncio.gather(work(0.1), work(0.2)), round(time.time(), 2))
            await asyncio.get_running_loop().run_in_executor(None, time.sleep, 0.1)
            print(round(time.time(), 2))
            try:
                await asyncio.wait_for(work(9.0), 0.1)
            except asyncio.TimeoutError:
                print("late", round(time.time(), 2))
        asyncio.run(main())
    """)
    assert log == ["[0.1, 0.2] 0.2", "0.3", "late 0.4"]


def test_sched_calls_functions_at_simulated_times(run_program: Run) -> None:
    log = run_program("""
        import sched, time
        scheduler = sched.scheduler(time.time, time.sleep)
        for delay in (0.2, 0.1):
            scheduler.enter(delay, 1, lambda: print(time.time()))
        scheduler.run()
    """)
    assert log == ["0.1", "0.2"]


def test_a_program_ends_after_its_threads_that_are_no_daemons(run_program: Run) -> None:
    log = run_program("""
        import atexit, threading, time
        atexit.register(print, "end")
        def work(name, duration):
            time.sleep(duration)
            print(name, time.time())
        threading.Thread(target=work, args=("thread", 0.1)).start()
        threading.Thread(target=work, args=("daemon", 0.5), daemon=True).start()
    """)
    assert log == ["thread 0.1", "end"]


def test_a_thread_that_raises_ends_alone_and_its_traceback_is_in_the_log(
    sim: Simulation, add_program: Callable[..., NodeProgram]
) -> None:
    node = add_program("""
        import threading, time
        def work():
            raise ValueError("of the thread")
        threading.Thread(target=work).start()
        time.sleep(0.1)
        print("main", time.time())
    """)
    sim.run(0.2)
    assert isinstance(node.error, ValueError)
    assert "ValueError: of the thread" in node.log and node.log[-1] == "main 0.1"


def test_processes_of_multiprocessing_run_as_threads_and_this_is_told(
    run_program: Run, reports: Callable[[str], list[str]]
) -> None:
    log = run_program("""
        import time
        from multiprocessing import Process, Queue
        def work(results):
            time.sleep(0.1)
            results.put("done")
        if __name__ == "__main__":
            results = Queue()
            process = Process(target=work, args=(results,))
            process.start()
            print(results.get(), time.time())
            process.join()
    """)
    assert log == ["done 0.1"]
    assert "program.py:10" in reports("SK-NODE-058")[0]


@pytest.mark.parametrize(
    "loop",
    [
        "while time.time() < 0.1: pass",
        "while not event.is_set(): pass",
        "while thread.is_alive(): pass",
        "while items.empty(): pass",
        "while lock.locked(): pass",
        "while not lock.acquire(blocking=False): pass",
        "while not future.done(): pass",
    ],
)
def test_a_loop_that_only_asks_gets_a_step_after_some_questions(run_program: Run, loop: str) -> None:
    log = run_program(f"""
        import queue, threading, time
        from concurrent.futures import ThreadPoolExecutor
        event, items, lock = threading.Event(), queue.Queue(), threading.Lock()
        lock.acquire()
        def work():
            time.sleep(0.1)
            event.set(), items.put(1), lock.release()
        thread = threading.Thread(target=work)
        thread.start()
        future = ThreadPoolExecutor(1).submit(time.sleep, 0.1)
        {loop}
        print(round(time.time(), 2))
    """)
    assert log == ["0.1"]


def test_an_idle_thread_of_an_executor_ends_with_the_program_without_a_traceback(
    sim: Simulation, add_program: Callable[..., NodeProgram]
) -> None:
    node = add_program("""
        import time
        from concurrent.futures import ThreadPoolExecutor
        executor = ThreadPoolExecutor(1)
        print(executor.submit(lambda: "done").result())
        try:
            time.sleep(9)
        except KeyboardInterrupt:
            pass
    """)
    sim.run(0.1)
    sim.close()
    assert node.log == ["done"]


def test_threads_that_wait_for_locks_of_each_other_are_told_and_the_run_goes_on(
    sim: Simulation, add_program: Callable[..., NodeProgram], reports: Callable[[str], list[str]]
) -> None:
    node = add_program("""
        import threading, time
        first, second = threading.Lock(), threading.Lock()
        def work():
            with second:
                time.sleep(0.1)
                first.acquire()
        threading.Thread(target=work, name="worker").start()
        with first:
            time.sleep(0.1)
            second.acquire()
    """)
    sim.run(0.5)
    assert sim.time == pytest.approx(0.5) and not node.done
    (report,) = reports("SK-NODE-055")
    assert "program.py:7" in report and "program.py:11" in report


def test_a_condition_that_nobody_notifies_is_no_deadlock(run_program: Run, reports: Callable[[str], list[str]]) -> None:
    run_program("""
        import threading
        condition = threading.Condition()
        with condition:
            condition.wait()
    """)
    assert reports("SK-NODE-055") == []


def test_the_main_thread_is_interrupted_by_another_thread(run_program: Run) -> None:
    log = run_program("""
        import _thread, threading, time
        threading.Timer(0.1, _thread.interrupt_main).start()
        try:
            time.sleep(9)
        except KeyboardInterrupt:
            print("interrupted", time.time())
    """)
    assert log == ["interrupted 0.1"]
