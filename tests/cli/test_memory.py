"""``ravestate memory`` lists, shows, exports, loads and forgets.

The exit code is 2 for wrong arguments, and 1 if a file or the memory cannot be used.
"""

from __future__ import annotations

import io
import json
import stat
import subprocess
import sys
from datetime import date
from pathlib import Path

import pytest

from cli.examples import call, write
from ravestate.modules import ontology
from ravestate.modules.meta.ontology.opening import open_memory

Capture = pytest.CaptureFixture[str]

HOLD = """
    import sys
    from pathlib import Path
    from ravestate.modules import ontology
    from ravestate.modules.meta.ontology.opening import open_memory

    memory = open_memory(ontology.Settings(path=Path(sys.argv[1])))
    memory.opened().result()
    print("open", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def file(folder: Path) -> Path:
    """A memory with Ada, who lives in London, two people named Bob, and Eve, who likes one of them."""
    path = folder / "memory.lbug"
    memory = open_memory(ontology.Settings(path=path))
    ada = memory.create("Person", name="Ada", born=date(1815, 12, 10)).result()
    memory.relate(ada, "lives_in", memory.create("City", name="London").result()).result()
    bobs = [memory.create("Person", name="Bob", age=age).result() for age in (1, 2)]
    memory.relate(memory.create("Person", name="Eve \x1b[31m\nred").result(), "likes", bobs[0]).result()
    memory.close().result()
    return path


def test_the_action_list_shows_all_nodes(file: Path, capsys: Capture) -> None:
    code, out, errors = call(capsys, "memory", "--path", str(file), "list")
    assert code == 0 and errors == f"5 nodes in {file.resolve()}\n"
    lines = [line.rsplit(maxsplit=1) for line in out.splitlines()]
    assert [line[0].split() for line in lines] == [
        ["City", "London"], ["Person", "Ada"], ["Person", "Bob"], ["Person", "Bob"], ["Person", "Eve", "red"],
    ]  # fmt: skip
    assert all(line[1].startswith(line[0].split()[0] + ":") for line in lines)


def test_the_action_list_shows_the_nodes_of_a_type_or_counts_the_types(file: Path, capsys: Capture) -> None:
    assert call(capsys, "memory", "--path", str(file), "list", "Place")[1].split()[:2] == ["City", "London"]
    _, out, _ = call(capsys, "memory", "--path", str(file), "list", "--types")
    assert [line.split() for line in out.splitlines()] == [["City", "1"], ["Person", "4"]]
    code, _, errors = call(capsys, "memory", "--path", str(file), "list", "Persn")
    assert code == 2 and errors == "ravestate memory: there is no type 'Persn'; did you mean 'Person'?\n"


def test_the_action_show_finds_a_person_by_name_or_id(file: Path, capsys: Capture) -> None:
    code, out, _ = call(capsys, "memory", "--path", str(file), "show", "ada ")
    first, *rest = out.splitlines()
    assert code == 0 and rest == ["  name: Ada", "  born: 1815-12-10", "  lives_in -> City London"]
    kind, name, id = first.split()
    assert (kind, name) == ("Person", "Ada")
    assert call(capsys, "memory", "--path", str(file), "show", id)[1] == out
    assert "  <- lives_in Person Ada" in call(capsys, "memory", "--path", str(file), "show", "London")[1]


def test_a_name_that_no_node_or_several_nodes_have_is_refused(file: Path, capsys: Capture) -> None:
    code, _, errors = call(capsys, "memory", "--path", str(file), "show", "Londn")
    assert code == 2
    assert errors == "ravestate memory: no node is called 'Londn'; did you mean 'London'?\n"
    code, _, errors = call(capsys, "memory", "--path", str(file), "forget", "Bob", "--yes")
    assert code == 2 and "2 nodes are called 'Bob': give the id of one\n  Person:" in errors


def test_the_action_load_restores_an_exported_memory(file: Path, folder: Path, capsys: Capture) -> None:
    _, out, _ = call(capsys, "memory", "--path", str(file), "export")
    document = json.loads(out)
    assert len(document["nodes"]) == 5 and len(document["relations"]) == 2
    code, out, _ = call(capsys, "memory", "--path", str(file), "export", "all.json")
    assert (code, out) == (0, "wrote all.json: 5 nodes\n")
    assert json.loads((folder / "all.json").read_text()) == document
    assert stat.S_IMODE((folder / "all.json").stat().st_mode) == 0o600
    assert call(capsys, "memory", "--path", "other.lbug", "load", "all.json")[:2] == (0, "loaded 5 nodes\n")
    assert json.loads(call(capsys, "memory", "--path", "other.lbug", "export")[1]) == document
    names = ["all.json", "memory.lbug", "memory.lbug.sum", "other.lbug", "other.lbug.sum"]
    assert sorted(path.name for path in folder.iterdir()) == names


def test_messages_name_files_that_cannot_be_written_or_read(file: Path, folder: Path, capsys: Capture) -> None:
    before = sorted(folder.iterdir())
    code, _, errors = call(capsys, "memory", "--path", str(file), "export", "no/where.json")
    assert code == 2 and "cannot write no/where.json: No such file" in errors
    code, _, errors = call(capsys, "memory", "--path", str(file), "load", "nowhere.json")
    assert code == 2 and "cannot read nowhere.json" in errors
    assert sorted(folder.iterdir()) == before
    write(folder / "broken.json", "{")
    assert call(capsys, "memory", "--path", str(file), "load", "broken.json")[0] == 2
    write(folder / "other.json", "[]")
    code, _, errors = call(capsys, "memory", "--path", str(file), "load", "other.json")
    assert code == 1 and "this is not an exported memory" in errors


@pytest.mark.parametrize("answer", ["n\n", "", "\n", "yess\n"])
def test_the_action_forget_asks_first_and_forgets_no_person_without_a_yes(
    file: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, answer: str
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
    code, out, _ = call(capsys, "memory", "--path", str(file), "forget", "Ada")
    assert code == 1 and "nothing was forgotten" in out
    assert "Ada" in out and "London" in out and "Forget these, with all relations?" in out
    assert call(capsys, "memory", "--path", str(file), "show", "Ada")[0] == 0


def test_the_action_forget_removes_a_person_after_a_yes(
    file: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    code, out, _ = call(capsys, "memory", "--path", str(file), "forget", "Ada")
    assert code == 0 and out.endswith("forgot 2 nodes\n")
    assert call(capsys, "memory", "--path", str(file), "forget", "Eve red", "-y")[0] == 2
    [eve] = [line for line in call(capsys, "memory", "--path", str(file), "list")[1].splitlines() if "Eve" in line]
    assert call(capsys, "memory", "--path", str(file), "forget", eve.split()[-1], "-y")[:2] == (
        0,
        "forgot 1 node\n",
    )
    _, out, _ = call(capsys, "memory", "--path", str(file), "list", "--types")
    assert out.split() == ["Person", "2"]


@pytest.mark.parametrize("answer", ["n\n", ""])
def test_the_action_reset_asks_first_and_removes_no_file_without_a_yes(
    file: Path, folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch, answer: str
) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO(answer))
    code, out, _ = call(capsys, "memory", "--path", str(file), "reset")
    assert code == 1 and "nothing was removed" in out
    assert out.startswith(f"{file.resolve()}\n{file.resolve()}.sum\nRemove these files, with the whole memory?")
    assert sorted(folder.iterdir()) == [file, Path(f"{file}.sum")]


def test_the_action_reset_removes_all_files_and_names_them(
    file: Path, folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    file.unlink()  # only the database file is missing, as after a crash
    for name in ("memory.lbug.wal", "memory.lbug.wal.orphaned-1", "memory.lbug.new.wal"):
        (folder / name).write_bytes(b"Ada")
    (folder / "memory.lbug.mine").touch()
    before = sorted(str(path.resolve()) for path in folder.glob("*") if path.suffix != ".mine")
    monkeypatch.setattr(sys, "stdin", io.StringIO("y\n"))
    code, out, _ = call(capsys, "memory", "--path", str(file), "reset")
    assert code == 0 and [line for line in out.splitlines() if "removed /" in line][-1] == f"removed {before[-1]}"
    assert all(f"removed {name}\n" in out for name in before)
    assert [path.name for path in folder.iterdir()] == ["memory.lbug.mine"]
    code, _, errors = call(capsys, "memory", "--path", str(file), "reset", "--yes")
    assert code == 1 and f"there is no memory at {file.resolve()}" in errors


def test_the_message_for_a_deleted_memory_names_the_files_that_remain(
    file: Path, folder: Path, capsys: Capture
) -> None:
    file.unlink()
    (folder / "memory.lbug.wal").write_bytes(b"Ada")
    code, _, errors = call(capsys, "memory", "--path", str(file), "list")
    assert code == 1 and f"there is no memory yet: {file.resolve()} does not exist" in errors
    assert "has left memory.lbug.sum, memory.lbug.wal, which may contain personal data" in errors
    assert f"to remove them, run ravestate memory reset --path {file.resolve()}" in errors


def test_an_export_is_readable_only_by_the_user_even_if_a_temporary_file_was_readable(
    file: Path, folder: Path, capsys: Capture
) -> None:
    left = folder / "all.json.new"
    left.touch()
    left.chmod(0o644)
    assert call(capsys, "memory", "--path", str(file), "export", "all.json")[0] == 0
    assert stat.S_IMODE((folder / "all.json").stat().st_mode) == 0o600


def test_the_action_reset_removes_a_broken_memory(file: Path, capsys: Capture) -> None:
    file.write_bytes(b"no database at all " * 300)
    code, _, errors = call(capsys, "memory", "--path", str(file), "list")
    assert code == 1 and f"ravestate memory reset --path {file.resolve()}" in errors
    assert call(capsys, "memory", "reset", "--path", str(file), "-y")[0] == 0
    assert not file.exists()


def test_the_action_reset_refuses_a_memory_on_a_server(capsys: Capture) -> None:
    code, _, errors = call(capsys, "memory", "--set", "ontology.url=bolt://localhost:1", "reset", "-y")
    assert code == 2 and "this memory is on a server" in errors


def test_memory_uses_the_settings_of_an_agent_file(file: Path, folder: Path, capsys: Capture) -> None:
    write(folder / "types.yaml", "Boat: {is: Thing}")
    write(
        folder / "agent.yaml",
        f"""
        modules: [ontology]
        settings:
          ontology: {{path: {file}, types: [types.yaml]}}
        """,
    )
    assert call(capsys, "memory", "-f", "agent.yaml", "list", "Boat")[0] == 0
    memory = open_memory(ontology.Settings(path=file, types=(folder / "types.yaml",)))
    memory.create("Boat", name="Lady").result()
    memory.close().result()
    assert "Lady" in call(capsys, "memory", "-f", "agent.yaml", "list")[1]
    code, out, errors = call(capsys, "memory", "--set", f"ontology.path={file}", "list")
    assert code == 0 and "Lady" not in out
    assert "also has Boat, but no file declares these types" in errors


def test_the_options_for_the_file_can_also_follow_the_action(file: Path, folder: Path, capsys: Capture) -> None:
    before = call(capsys, "memory", "--path", str(file), "list")
    assert before[0] == 0
    assert call(capsys, "memory", "list", "--path", str(file)) == before
    assert call(capsys, "memory", "--path", "none.lbug", "list", "--path", str(file)) == before
    write(folder / "agent.yaml", f"modules: [ontology]\nsettings: {{ontology: {{path: {file}}}}}")
    assert call(capsys, "memory", "list", "-f", "agent.yaml") == before
    assert call(capsys, "memory", "--set", "ontology.agent=a", "list", "--set", f"ontology.path={file}") == before
    for action in (["show", "Ada"], ["export"], ["load", "gone.json"], ["forget", "Zed", "-y"]):
        assert "there is no memory yet" not in call(capsys, "memory", *action, "--path", str(file))[2]


def test_settings_of_other_modules_and_unknown_settings_are_refused(file: Path, capsys: Capture) -> None:
    code, out, errors = call(capsys, "memory", "--path", str(file), "--set", "foo.pth=x", "list")
    assert (code, out) == (2, "") and "--set foo.pth=x: module 'foo' is not part of this agent" in errors
    code, _, errors = call(capsys, "memory", "list", "--set", "ontology.pth=x")
    assert code == 2 and "no such setting; did you mean 'path'? (it has: types, path, " in errors


def test_the_default_file_is_in_the_data_folder_of_the_user(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_DATA_HOME", str(folder))
    monkeypatch.setattr(sys, "platform", "linux")
    code, _, errors = call(capsys, "memory", "list")
    assert code == 1 and f"there is no memory yet: {folder.resolve()}/ravestate/default/memory.lbug" in errors
    assert list(folder.iterdir()) == []
    write(folder / "empty.json", '{"format": 1, "nodes": [], "relations": []}')
    assert call(capsys, "memory", "--set", "ontology.agent=rosie", "load", "empty.json")[0] == 0
    assert (folder / "ravestate" / "rosie" / "memory.lbug").is_file()


def test_a_file_that_an_agent_has_open_is_refused(file: Path, folder: Path, capsys: Capture) -> None:
    agent = write(folder / "hold.py", HOLD)
    with subprocess.Popen(
        [sys.executable, agent, file], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None and process.stdout.readline() == "open\n"
        code, out, errors = call(capsys, "memory", "--path", str(file), "list")
        assert (code, out) == (1, "")
        assert f"is in use by process {process.pid}: only one process may have it open" in errors
        assert "name another file with --path FILE" in errors and "--set" not in errors
        code, _, errors = call(capsys, "memory", "--path", str(file), "reset", "-y")
        assert code == 1 and "is in use by another process: end that agent first" in errors and file.exists()
        assert process.stdin is not None
        process.stdin.close()


def test_wrong_use_and_a_missing_package_have_messages(
    file: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert call(capsys, "memory")[0] == 2
    assert call(capsys, "memory", "lst")[0] == 2
    code, _, errors = call(capsys, "memory", "--set", "ontology.pth=x", "list")
    assert code in (1, 2) and "no such setting; did you mean 'path'?" in errors
    assert call(capsys, "memory", "-f", "nowhere.yaml", "list")[0] == 2
    monkeypatch.setitem(sys.modules, "ladybug", None)
    code, _, errors = call(capsys, "memory", "--path", str(file), "list")
    assert code == 1
    assert errors == "ravestate memory: ontology needs ladybug: pip install 'ravestate[ontology]'\n"
