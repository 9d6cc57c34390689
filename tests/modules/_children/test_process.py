"""A model's process: it answers, reports faults, and is replaced when it hangs or dies."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from ravestate.errors import PlatformError
from ravestate.modules._children import process as model_process
from ravestate.modules._children.child import Child
from ravestate.modules._children.process import Backend, ModelProcess

BACKEND = """
import os, threading

def load(config):
    if config.get("broken"):
        raise ValueError("the file is damaged")
    if config.get("stuck"):
        threading.Event().wait(60)
    print("a library prints")

    def handle(header, data):
        if header["do"] == "wait":
            open(header["pipe"]).read()
        if header["do"] == "hang":
            threading.Event().wait(60)
        if header["do"] == "die":
            os._exit(3)
        if header["do"] == "fail":
            raise ValueError("too loud")
        return {"pid": os.getpid(), "said": header["do"]}, data[::-1]

    return handle
"""


@pytest.fixture
def backend(tmp_path: Path) -> Backend:
    """A backend program that does what each request says."""
    (tmp_path / "obedient.py").write_text(BACKEND)
    return Backend(tmp_path / "obedient.py", "voiceio", "obedient", lambda reason: f" ({len(reason)} letters)")


@pytest.fixture
def process(backend: Backend) -> Iterator[ModelProcess]:
    one = ModelProcess(backend, {})
    yield one
    one.close()


def test_requests_and_answers_can_have_data_of_any_size(process: ModelProcess) -> None:
    data = bytes(range(256)) * 4000  # more than a pipe holds
    answer, back = process.request({"do": "turn"}, data, seconds=20)
    assert answer["said"] == "turn" and back == data[::-1]
    assert process.request({"do": "again"}, seconds=20)[0]["pid"] == answer["pid"] == process.pid


def test_an_exception_in_the_model_is_reported_and_its_process_continues(process: ModelProcess) -> None:
    with pytest.raises(PlatformError, match="obedient failed: ValueError: too loud"):
        process.request({"do": "fail"}, seconds=20)
    pid = process.pid
    assert process.request({"do": "go on"}, seconds=20)[0]["pid"] == pid


def test_a_process_that_hangs_is_replaced(process: ModelProcess) -> None:
    process.start()
    hanging = process.pid
    with pytest.raises(PlatformError, match=r"did not answer within 0\.2 s"):
        process.request({"do": "hang"}, seconds=0.2)
    answer, _ = process.request({"do": "go on"}, seconds=20)
    assert answer["pid"] != hanging
    assert hanging is not None
    with pytest.raises(ProcessLookupError):
        os.kill(hanging, 0)


def test_a_stopped_process_that_reads_no_data_is_replaced(process: ModelProcess) -> None:
    process.start()
    assert process.pid is not None
    os.kill(process.pid, signal.SIGSTOP)
    with pytest.raises(PlatformError, match="did not answer"):
        process.request({"do": "turn"}, bytes(1 << 20), seconds=0.2)
    assert process.request({"do": "turn"}, b"ab", seconds=20)[1] == b"ba"


def test_a_process_that_dies_is_replaced(process: ModelProcess) -> None:
    with pytest.raises(PlatformError, match="exit code 3"):
        process.request({"do": "die"}, seconds=20)
    assert process.request({"do": "go on"}, seconds=20)[0]["said"] == "go on"
    pid = process.pid
    assert pid is not None
    os.kill(pid, signal.SIGKILL)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    assert process.request({"do": "and on"}, seconds=20)[0]["said"] == "and on"
    assert process.restarts == 1


def test_the_error_says_why_a_model_cannot_be_loaded(backend: Backend) -> None:
    process = ModelProcess(backend, {"broken": True})
    with pytest.raises(PlatformError, match=r"cannot load obedient: ValueError: the file is damaged \(31 letters\)$"):
        process.start()
    process.close()


def test_the_error_names_a_missing_interpreter(backend: Backend) -> None:
    with pytest.raises(PlatformError, match="cannot start '/none/python'"):
        ModelProcess(backend, {}, "/none/python").start()


def test_a_closed_process_refuses_requests(process: ModelProcess) -> None:
    process.start()
    pid = process.pid
    process.close()
    with pytest.raises(PlatformError, match="is closed"):
        process.start()
    assert pid is not None
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)


def test_a_process_that_is_closed_while_it_starts_does_not_load_its_model(
    backend: Backend, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The caller of `close` may be an event loop, which must not wait for the model."""
    monkeypatch.setattr(model_process, "LOADING", 3.0)
    one = ModelProcess(backend, {"stuck": True})
    closing = threading.Thread(target=one.close)

    def child(*args: Any, **options: Any) -> Child:
        closing.start()
        closing.join(0.1)  # it now waits for the end of the start
        return Child(*args, **options)

    monkeypatch.setattr(model_process, "Child", child)
    with pytest.raises(PlatformError, match="killed by signal 9"):
        one.start()
    closing.join()


def test_users_of_the_same_model_share_its_process(backend: Backend) -> None:
    one, two = model_process.take(backend, {"a": 1}), model_process.take(backend, {"a": 1})
    other = model_process.take(backend, {"a": 2})
    assert one is two is not other
    one.start()
    model_process.drop(one)
    assert one.pid is not None
    model_process.drop(two)
    model_process.drop(other)
    assert one.pid is None


def test_an_unused_process_is_kept_for_the_next_user(backend: Backend, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_process, "LINGER", 3600.0)
    one = model_process.take(backend, {"b": 1})
    one.start()
    pid = one.pid
    model_process.drop(one, linger=True)
    two = model_process.take(backend, {"b": 1})
    assert two is one and two.pid == pid is not None
    model_process.drop(two)
    assert two.pid is None


def test_a_process_that_stays_unused_ends(backend: Backend, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(model_process, "LINGER", 0.0)
    one = model_process.take(backend, {"c": 1})
    one.start()
    before = set(threading.enumerate())
    model_process.drop(one, linger=True)
    for timer in set(threading.enumerate()) - before:
        timer.join()
    assert one.pid is None
    with pytest.raises(PlatformError, match="is closed"):
        one.start()
    other = model_process.take(backend, {"c": 1})
    assert other is not one
    model_process.drop(other)


def test_unused_processes_end_with_the_interpreter(backend: Backend) -> None:
    """They end even if the timer that would end them later is still running."""
    program = (
        "import sys, pathlib\n"
        "from ravestate.modules._children import process\n"
        "backend = process.Backend(pathlib.Path(sys.argv[1]), 'voiceio', 'obedient')\n"
        "one = process.take(backend, {})\n"
        "one.start()\n"
        "print(one.pid)\n"
        "process.drop(one, linger=True)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(backend.program)], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, "")
    with pytest.raises(ProcessLookupError):
        os.kill(int(done.stdout), 0)


def test_a_request_that_nobody_wants_any_more_is_dropped_when_its_turn_comes(
    process: ModelProcess, tmp_path: Path
) -> None:
    """If it were not dropped, the newest request would wait for an answer that nobody needs."""
    unwanted, refused = threading.Event(), list[str]()

    def ask() -> None:
        with pytest.raises(PlatformError, match="was dropped") as caught:
            process.request({"do": "die"}, seconds=20, unwanted=unwanted)
        refused.append(str(caught.value))

    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    running = threading.Thread(
        target=process.request, args=({"do": "wait", "pipe": str(pipe)},), kwargs={"seconds": 20}
    )
    running.start()
    with pipe.open("w"):  # this opens the pipe as soon as the request is running
        waiting = threading.Thread(target=ask)
        waiting.start()
        unwanted.set()
    running.join()
    waiting.join()
    assert refused and process.request({"do": "go on"}, seconds=20, unwanted=threading.Event())[0]["pid"] == process.pid
    assert process.restarts == 0


def test_a_backend_can_be_a_folder_of_files_that_import_each_other(tmp_path: Path) -> None:
    (tmp_path / "__init__.py").write_text("from .work import double\n\ndef load(config):\n    return double\n")
    (tmp_path / "work.py").write_text("def double(header, data):\n    return {}, 2 * data\n")
    process = ModelProcess(Backend(tmp_path, "voiceio", "twice"), {})
    assert process.request({}, b"ab", seconds=20) == ({}, b"abab")
    process.close()
