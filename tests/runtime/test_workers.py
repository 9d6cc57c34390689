"""Worker threads: as many as are busy at once, kept, never waited for at the end."""

import functools
import subprocess
import sys
import threading
from collections.abc import Callable
from queue import SimpleQueue
from unittest.mock import Mock

import pytest

from ravestate.runtime.workers import SHARE, Crew, Workers

LIMIT = 20.0


def finished(workers: Workers, job: Callable[[], None] = lambda: None) -> threading.Thread:
    """Have a job done and return the thread that did it."""
    done: SimpleQueue[threading.Thread] = SimpleQueue()

    def work() -> None:
        job()
        done.put(threading.current_thread())

    workers.submit(work)
    return done.get(timeout=LIMIT)


def ended(thread: threading.Thread) -> bool:
    thread.join(LIMIT)
    return not thread.is_alive()


def test_jobs_run_in_daemon_threads_that_say_whose_they_are() -> None:
    workers = Workers(Crew())
    thread = finished(workers)
    assert thread is not threading.current_thread()
    assert thread.daemon and thread.name == "ravestate-1"
    workers.close()
    assert ended(thread)


def test_busy_threads_are_joined_by_new_ones() -> None:
    workers = Workers(Crew())
    together = threading.Barrier(4)  # which nobody passes alone
    done: SimpleQueue[str] = SimpleQueue()

    def meet() -> None:
        together.wait(LIMIT)
        done.put(threading.current_thread().name)

    for _ in range(3):
        workers.submit(meet)
    together.wait(LIMIT)
    assert {done.get(timeout=LIMIT) for _ in range(3)} == {"ravestate-1", "ravestate-2", "ravestate-3"}
    workers.close()


def test_a_thread_that_hangs_holds_up_nobody() -> None:
    workers = Workers(Crew())
    release = threading.Event()
    begun = threading.Event()

    def hang() -> None:
        begun.set()
        release.wait(LIMIT)

    workers.submit(hang)
    assert begun.wait(LIMIT)
    thread = finished(workers)
    assert thread.name == "ravestate-2"
    workers.close()
    assert ended(thread)
    release.set()


def test_an_idle_thread_is_used_again_also_by_another_context() -> None:
    crew = Crew()
    several = [Workers(crew), Workers(crew)]
    seen = {finished(several[number % 2]) for number in range(200)}
    assert len(seen) <= 2  # a thread may be met in the instant between its work and its rest
    several[0].close()
    seen.add(finished(several[1]))
    several[1].close()
    assert all(ended(thread) for thread in seen)


def test_no_context_takes_more_than_its_share() -> None:
    crew = Crew()
    greedy, modest = Workers(crew), Workers(crew)
    release = threading.Event()
    begun: SimpleQueue[threading.Thread] = SimpleQueue()

    def hang() -> None:
        begun.put(threading.current_thread())
        release.wait(LIMIT)

    for _ in range(1000):
        greedy.submit(hang)
    threads = {begun.get(timeout=LIMIT) for _ in range(SHARE)}
    assert finished(modest) not in threads
    assert begun.empty()
    release.set()
    threads |= {begun.get(timeout=LIMIT) for _ in range(1000 - SHARE)}
    assert len(threads) <= SHARE + 1
    greedy.close()
    modest.close()


def test_what_hangs_and_is_waited_for_no_more_leaves_its_place_to_others() -> None:
    workers = Workers(Crew())
    release = threading.Event()
    done: SimpleQueue[str] = SimpleQueue()

    def hang() -> None:
        release.wait(LIMIT)
        done.put("hung")

    hanging = [workers.submit(hang) for _ in range(SHARE + 2)]
    workers.submit(lambda: done.put("late"))
    workers.let_go(hanging[-1])  # which has not begun
    workers.let_go(hanging[0])  # whose place the next one takes
    workers.let_go(hanging[1])
    assert done.get(timeout=LIMIT) == "late"
    finished(workers)
    release.set()
    assert [done.get(timeout=LIMIT) for _ in range(SHARE + 1)] == ["hung"] * (SHARE + 1)
    for _ in range(3 * SHARE):
        finished(workers)  # the share is as large as before
    workers.close()


def test_a_forked_process_has_threads_of_its_own() -> None:
    program = """
import os, threading
from queue import SimpleQueue
from ravestate.runtime.workers import Workers

def do(workers):
    done = SimpleQueue()
    workers.submit(lambda: done.put(1))
    return done.get(timeout=20)

do(Workers())
child = os.fork()
if child == 0:
    os._exit(7 * do(Workers()))
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    process = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    assert process.stdout == "7\n"


def test_what_has_not_begun_when_a_context_ends_is_not_done() -> None:
    workers = Workers(Crew())
    release = threading.Event()
    done: SimpleQueue[int] = SimpleQueue()

    def work(number: int) -> None:
        release.wait(LIMIT)
        done.put(number)

    for number in range(SHARE + 10):
        workers.submit(functools.partial(work, number))
    workers.close()
    release.set()
    assert sorted(done.get(timeout=LIMIT) for _ in range(SHARE)) == list(range(SHARE))
    assert done.empty()


def test_a_system_without_threads_is_told_of_and_what_can_wait_waits(monkeypatch: pytest.MonkeyPatch) -> None:
    workers = Workers(Crew())
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", Mock(side_effect=RuntimeError("can't start new thread")))
        with pytest.raises(RuntimeError, match="can't start"):
            workers.submit(lambda: None)
    release = threading.Event()

    def hold() -> None:
        release.wait(LIMIT)

    workers.submit(hold)
    done: SimpleQueue[str] = SimpleQueue()
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", Mock(side_effect=RuntimeError("can't start new thread")))
        workers.submit(lambda: done.put("late"))
    release.set()
    assert done.get(timeout=LIMIT) == "late"
    workers.close()


def test_the_end_of_the_process_waits_for_a_function_at_work_but_not_for_one_that_hangs() -> None:
    program = """
import threading
from ravestate.runtime import workers

workers.LAST_GRACE = 1.0
at_work = threading.Event()

def work():
    at_work.set()
    threading.Event().wait({seconds})
    print("done", flush=True)

workers.Workers().submit(work)
at_work.wait()
"""
    for seconds, expected in ((0.2, "done\n"), (3600, "")):
        process = subprocess.run(
            [sys.executable, "-c", program.format(seconds=seconds)],
            capture_output=True, text=True, timeout=20, check=True,
        )  # fmt: skip
        assert process.stdout == expected
