"""The operating-system process that runs a language model. The tests run small programs in place of llama.cpp."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from ravestate.errors import PlatformError
from ravestate.modules.skill.wildtalk import llama_process
from ravestate.modules.skill.wildtalk.llama_process import LlamaProcess, ModelKey

READY = """
import sys, json
config = json.loads(sys.stdin.readline())
print("http://here/" + config["path"], flush=True)
sys.stdin.read()
"""


def child(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, program: str) -> LlamaProcess:
    """A process that runs `program`."""
    monkeypatch.setattr(llama_process, "__file__", str(tmp_path / "llama_process.py"))
    (tmp_path / "llama_child.py").write_text(program)
    return LlamaProcess(ModelKey(Path("model.gguf"), 512, 1, 1))


def test_the_process_starts_once_and_ends(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    process = child(monkeypatch, tmp_path, READY)
    heard: list[float] = []
    assert process.start(heard.append) == "http://here/model.gguf"
    pid = process.pid
    assert process.start(heard.append) == "http://here/model.gguf"
    assert process.pid == pid is not None
    assert heard == [1.0, 1.0]
    assert process.obituary() == ""
    process.close()
    process.close()
    assert not process.alive
    assert process.obituary() == ""


def test_a_second_caller_waits_for_the_first(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    process = child(monkeypatch, tmp_path, READY)
    pids: list[int | None] = []

    def start() -> None:
        process.start()
        pids.append(process.pid)

    threads = [threading.Thread(target=start) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(pids) == 4
    assert len(set(pids)) == 1
    process.close()


@pytest.mark.parametrize(
    ("program", "message"),
    [
        ("", "exit code 0. Name a chat model"),
        ("import sys; sys.exit(3)", "exit code 3"),
        ("import os; os.abort()", "killed by signal 6"),
        ("import no_such_thing", "No module named 'no_such_thing'. Install it: pip install 'ravestate"),
        ("raise OSError('no')", "OSError: no"),
        ("import sys; sys.stderr.write('0.1 E load: failed to allocate\\n')", "failed to allocate. Take a smaller"),
        (
            "import sys; sys.stderr.write('0.1 E a: b\\n0.2 E c: error loading model: unknown model architecture: x\\n')",
            "unknown model architecture: x. This llama.cpp is too old",
        ),
    ],
)  # fmt: skip
def test_the_cause_of_a_failure_is_reported(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, program: str, message: str
) -> None:
    process = child(monkeypatch, tmp_path, program)
    with pytest.raises(PlatformError, match=f"cannot load the model 'model.gguf': .*{message}"):
        process.start()
    process.close()


def test_closing_ends_a_start_that_is_under_way(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    begun, failures = tmp_path / "begun", list[Exception]()
    os.mkfifo(begun)
    process = child(monkeypatch, tmp_path, f"import sys; open({str(begun)!r}, 'w').close(); sys.stdin.read()")

    def start() -> None:
        try:
            process.start()
        except PlatformError as error:
            failures.append(error)

    thread = threading.Thread(target=start)
    thread.start()
    begun.read_text()  # this ends when the program runs
    process.close()
    thread.join()
    assert "closed while it was loading" in str(failures[0])


def test_an_interpreter_that_cannot_start_is_reported(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    process = child(monkeypatch, tmp_path, READY)
    monkeypatch.setattr("sys.executable", str(tmp_path / "python"))
    with pytest.raises(PlatformError, match="cannot start Python for the model"):
        process.start()
    process.close()


def test_the_process_ends_with_its_last_user(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    key = child(monkeypatch, tmp_path, READY).key
    first = llama_process.take(key)
    assert llama_process.take(key) is first
    first.start()
    llama_process.drop(first)
    assert first.alive
    llama_process.drop(first)
    assert not first.alive
    other = llama_process.take(key)
    assert other is not first
    llama_process.drop(other)


def test_the_process_ends_with_the_interpreter(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    child(monkeypatch, tmp_path, READY)
    program = (
        "import sys, pathlib\n"
        "from ravestate.modules.skill.wildtalk import llama_process\n"
        "llama_process.__file__ = sys.argv[1]\n"
        "process = llama_process.take(llama_process.ModelKey(pathlib.Path('model.gguf'), 512, 1, 1))\n"
        "process.start()\n"
        "print(process.pid)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(tmp_path / "llama_process.py")], capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (0, "")
    with pytest.raises(ProcessLookupError):
        os.kill(int(done.stdout), 0)
