"""Worker threads: as many as are busy at once, kept, never waited for at the end."""

import subprocess
import sys
import threading
from collections.abc import Callable
from queue import SimpleQueue

from ravestate.runtime.workers import Workers

LIMIT = 20.0


def finished(workers: Workers, job: Callable[[], None] = lambda: None) -> threading.Thread:
    """Have a job done and return the thread that did it."""
    done: SimpleQueue[threading.Thread] = SimpleQueue()

    def work() -> None:
        job()
        done.put(threading.current_thread())

    workers.submit(work)
    return done.get(timeout=LIMIT)


def names() -> set[str]:
    return {thread.name for thread in threading.enumerate()}


def test_jobs_run_in_daemon_threads_that_say_whose_they_are() -> None:
    workers = Workers()
    thread = finished(workers)
    assert thread is not threading.current_thread()
    assert thread.daemon and thread.name == "ravestate-1"
    workers.close()
    thread.join(LIMIT)
    assert not thread.is_alive()


def test_busy_threads_are_joined_by_new_ones() -> None:
    workers = Workers()
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
    workers = Workers()
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
    thread.join(LIMIT)
    assert not thread.is_alive()
    release.set()


def test_an_idle_thread_is_used_again() -> None:
    workers = Workers()
    seen: set[threading.Thread] = set()
    for _ in range(200):
        seen.add(finished(workers))
    assert len(seen) <= 2  # a thread may be met in the instant between its work and its rest
    workers.close()
    for thread in seen:
        thread.join(LIMIT)
        assert not thread.is_alive()


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
        ended = subprocess.run(
            [sys.executable, "-c", program.format(seconds=seconds)],
            capture_output=True, text=True, timeout=20, check=True,
        )  # fmt: skip
        assert ended.stdout == expected
