"""Worker threads start on demand and are kept for a while. They do not keep the process from ending."""

import functools
import subprocess
import sys
import threading
from collections.abc import Callable
from queue import SimpleQueue
from unittest.mock import Mock

import pytest

from ravestate.runtime.workers import SHARE, JobQueue, ThreadPool

LIMIT = 20.0


def finished(jobs: JobQueue, job: Callable[[], None] = lambda: None) -> threading.Thread:
    """Do a job, and return the thread that has done it."""
    done: SimpleQueue[threading.Thread] = SimpleQueue()

    def work() -> None:
        job()
        done.put(threading.current_thread())

    jobs.submit(work)
    return done.get(timeout=LIMIT)


def ended(thread: threading.Thread) -> bool:
    thread.join(LIMIT)
    return not thread.is_alive()


def test_jobs_run_in_named_daemon_threads() -> None:
    jobs = JobQueue(ThreadPool())
    thread = finished(jobs)
    assert thread is not threading.current_thread()
    assert thread.daemon and thread.name == "ravestate-1"
    jobs.close()
    assert ended(thread)


def test_the_pool_starts_a_thread_when_all_threads_are_busy() -> None:
    jobs = JobQueue(ThreadPool())
    together = threading.Barrier(4)  # all threads must arrive before any of them can pass
    done: SimpleQueue[str] = SimpleQueue()

    def meet() -> None:
        together.wait(LIMIT)
        done.put(threading.current_thread().name)

    for _ in range(3):
        jobs.submit(meet)
    together.wait(LIMIT)
    assert {done.get(timeout=LIMIT) for _ in range(3)} == {"ravestate-1", "ravestate-2", "ravestate-3"}
    jobs.close()


def test_a_job_that_hangs_delays_no_other_job() -> None:
    jobs = JobQueue(ThreadPool())
    release = threading.Event()
    begun = threading.Event()

    def hang() -> None:
        begun.set()
        release.wait(LIMIT)

    jobs.submit(hang)
    assert begun.wait(LIMIT)
    thread = finished(jobs)
    assert thread.name == "ravestate-2"
    jobs.close()
    assert ended(thread)
    release.set()


def test_an_idle_thread_is_used_again_even_by_another_context() -> None:
    pool = ThreadPool()
    several = [JobQueue(pool), JobQueue(pool)]
    seen = {finished(several[number % 2]) for number in range(200)}
    assert len(seen) <= 2  # the first thread is perhaps not idle yet when the next job comes
    several[0].close()
    seen.add(finished(several[1]))
    several[1].close()
    assert all(ended(thread) for thread in seen)


def test_no_context_occupies_more_threads_than_its_share() -> None:
    pool = ThreadPool()
    greedy, modest = JobQueue(pool), JobQueue(pool)
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


def test_the_next_job_takes_the_place_of_an_abandoned_job() -> None:
    jobs = JobQueue(ThreadPool())
    release = threading.Event()
    done: SimpleQueue[str] = SimpleQueue()

    def hang() -> None:
        release.wait(LIMIT)
        done.put("hung")

    hanging = [jobs.submit(hang) for _ in range(SHARE + 2)]
    jobs.submit(lambda: done.put("late"))
    jobs.abandon(hanging[-1])  # a job that has not begun
    jobs.abandon(hanging[0])  # the next job takes its place
    jobs.abandon(hanging[1])
    assert done.get(timeout=LIMIT) == "late"
    finished(jobs)
    release.set()
    assert [done.get(timeout=LIMIT) for _ in range(SHARE + 1)] == ["hung"] * (SHARE + 1)
    for _ in range(3 * SHARE):
        finished(jobs)  # the context still gets its full share of threads
    jobs.close()


def test_a_forked_process_starts_its_own_threads() -> None:
    program = """
import os, threading
from queue import SimpleQueue
from ravestate.runtime.workers import JobQueue

def do(jobs):
    done = SimpleQueue()
    jobs.submit(lambda: done.put(1))
    return done.get(timeout=20)

do(JobQueue())
child = os.fork()
if child == 0:
    os._exit(7 * do(JobQueue()))
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
"""
    process = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True)
    assert process.stdout == "7\n"


def test_jobs_that_have_not_begun_are_dropped_when_their_context_ends() -> None:
    jobs = JobQueue(ThreadPool())
    release = threading.Event()
    done: SimpleQueue[int] = SimpleQueue()

    def work(number: int) -> None:
        release.wait(LIMIT)
        done.put(number)

    for number in range(SHARE + 10):
        jobs.submit(functools.partial(work, number))
    jobs.close()
    release.set()
    assert sorted(done.get(timeout=LIMIT) for _ in range(SHARE)) == list(range(SHARE))
    assert done.empty()


def test_if_no_thread_can_be_started_a_job_waits_for_an_existing_thread_or_fails(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    jobs = JobQueue(ThreadPool())
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", Mock(side_effect=RuntimeError("can't start new thread")))
        with pytest.raises(RuntimeError, match="can't start"):
            jobs.submit(lambda: None)
    release = threading.Event()

    def hold() -> None:
        release.wait(LIMIT)

    jobs.submit(hold)
    done: SimpleQueue[str] = SimpleQueue()
    with monkeypatch.context() as patch:
        patch.setattr(threading.Thread, "start", Mock(side_effect=RuntimeError("can't start new thread")))
        jobs.submit(lambda: done.put("late"))
    release.set()
    assert done.get(timeout=LIMIT) == "late"
    jobs.close()


def test_a_process_that_ends_waits_a_limited_time_for_running_functions() -> None:
    program = """
import threading
from ravestate.runtime import workers

workers.LAST_GRACE = 1.0
at_work = threading.Event()

def work():
    at_work.set()
    threading.Event().wait({seconds})
    print("done", flush=True)

workers.JobQueue().submit(work)
at_work.wait()
"""
    for seconds, expected in ((0.2, "done\n"), (3600, "")):
        process = subprocess.run(
            [sys.executable, "-c", program.format(seconds=seconds)],
            capture_output=True, text=True, timeout=20, check=True,
        )  # fmt: skip
        assert process.stdout == expected
