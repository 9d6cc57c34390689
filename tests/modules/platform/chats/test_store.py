"""The store keeps messages when a process dies, and forgets messages on request or after some time."""

import sqlite3
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest

from modules.platform.chats.messenger import letter
from ravestate.errors import PlatformError
from ravestate.modules.platform.chats import Outgoing, Person
from ravestate.modules.platform.chats.store import SEEN, TRIES, WROTE, Answer, Entry, Store


def opened(path: Path) -> Store:
    return Store(path / "folder" / "store.db")


def answer(text: str, entry: Entry | None = None, chat: str = "a") -> Answer:
    return Answer(Outgoing(key=text, chat=chat, text=text), None if entry is None else entry.n)


def test_a_message_is_pending_until_it_is_done_and_is_then_not_taken_again(tmp_path: Path) -> None:
    store, message = opened(tmp_path), letter("one")
    entry = store.take(message)
    assert entry is not None
    assert store.pending() == [entry]
    assert store.take(message) is None
    store.commit([answer("yes", entry)], [entry])
    assert store.pending() == []
    store.close()
    again = opened(tmp_path)
    assert again.take(message) is None
    assert again.chats_to_send() == ["a"]
    assert again.knows("a", message.person)
    assert not again.knows("b", message.person)


def test_a_killed_process_leaves_its_stored_messages_and_no_part_of_an_open_batch(tmp_path: Path) -> None:
    code = f"""
import os, signal, sys
sys.path.insert(0, {str(Path(__file__).parents[3])!r})
from pathlib import Path
from modules.platform.chats.messenger import letter
from modules.platform.chats.test_store import answer, opened
store = opened(Path({str(tmp_path)!r}))
entry = store.take(letter("one"))
with store.batch():
    store.take(letter("two"))
    store.commit([answer("never", entry)], [entry])
    os.kill(os.getpid(), signal.SIGKILL)
"""
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == -9
    store = opened(tmp_path)
    assert [entry.message.text for entry in store.pending()] == ["one"]
    assert store.chats_to_send() == []


def test_an_answer_is_queued_and_then_begun_and_then_sent(tmp_path: Path) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("one"))
    assert entry is not None
    store.commit([answer("first", entry), answer("second")])
    item = store.next("a")
    assert item is not None
    assert (item.message.text, item.begun) == ("first", False)
    begun = store.begin(item, "7")
    assert (begun.begun, begun.message.trace) == (True, "7")
    found = store.next("a")
    assert found is not None
    assert (found.begun, found.message.trace) == (True, "7")
    store.undo(found)
    assert not store.next("a").begun  # type: ignore[union-attr]
    store.sent(begun, "id 1")
    assert store.next("a").message.text == "second"  # type: ignore[union-attr]
    # The store keeps the answer, to compare it if the agent hears the message again.
    assert [each.text for each in store.recorded(entry.n)] == ["first"]
    store.commit((), [entry])
    assert store.recorded(entry.n) == []


def test_an_edit_changes_an_answer_only_if_its_message_is_the_newest(tmp_path: Path) -> None:
    store = opened(tmp_path)
    first = store.take(letter("one", id="m1"))
    assert first is not None
    store.commit([answer("yes", first)])
    store.sent(store.next("a"), "a1")  # type: ignore[arg-type]
    edit = store.take(letter("two", id="m1", kind="edit"))
    assert edit is not None
    assert store.answers_to(edit) == ["a1"]
    store.take(letter("three", id="m2"))
    late = store.take(letter("four", id="m1", kind="edit"))
    assert late is not None
    assert store.answers_to(late) is None
    unanswered = store.take(letter("five", id="m2", kind="edit"))
    assert unanswered is not None
    assert store.answers_to(unanswered) is None  # meanwhile, an edit of m1 was the newest message


def test_after_a_reaction_the_last_message_can_still_be_edited(tmp_path: Path) -> None:
    store = opened(tmp_path)
    first = store.take(letter("one", id="m1"))
    assert first is not None
    store.commit([answer("yes", first)])
    store.sent(store.next("a"), "a1")  # type: ignore[arg-type]
    store.take(letter("👍", id="a1", kind="reaction"))
    edit = store.take(letter("two", id="m1", kind="edit"))
    assert edit is not None
    assert store.answers_to(edit) == ["a1"]


def test_the_store_knows_which_messages_the_agent_wrote(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("one", id="m1"))
    orders = [
        Outgoing(key="1", chat="a", kind="text"),
        Outgoing(key="2", chat="a", kind="picture"),
        Outgoing(key="3", chat="a", kind="edit", to="gone"),
        Outgoing(key="4", chat="a", kind="reaction", to="m1"),
        Outgoing(key="5", chat="a", kind="delete", to="a0"),
    ]
    store.commit([Answer(order) for order in orders], [entry] if entry else ())
    for id in ("a1", "a2", "a3", "m1", "a0"):
        store.sent(store.next("a"), id)  # type: ignore[arg-type]
    store.close()
    again = opened(tmp_path)
    assert [id for id in ("a1", "a2", "a3", "m1", "a0", "m0") if again.wrote("a", id)] == ["a1", "a2", "a3"]
    assert not again.wrote("b", "a1")
    later = time.time() + WROTE + 1
    monkeypatch.setattr(time, "time", lambda: later)
    again.take(letter("two"))
    assert not again.wrote("a", "a1")


def test_while_a_message_is_being_delivered_an_unknown_id_may_be_its_id(tmp_path: Path) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("one", id="m1"))
    store.commit([answer("yes", entry)])
    item = store.next("a")
    assert item is not None
    assert not store.wrote("a", "a1")
    begun = store.begin(item, "")
    assert store.wrote("a", "a1")
    assert not store.wrote("a", "m1")
    assert not store.wrote("b", "a1")
    store.sent(begun, "a1")
    assert store.wrote("a", "a1")
    assert not store.wrote("a", "a2")
    store.forget("a")
    assert not store.wrote("a", "a1")


def test_the_answers_to_a_message_are_those_that_were_neither_deleted_nor_replaced(tmp_path: Path) -> None:
    store = opened(tmp_path)

    def deliver(entry: Entry | None, *orders: tuple[str, str, str]) -> None:
        assert entry is not None
        messages = [Outgoing(key=id, chat="a", kind=kind, to=to) for kind, to, id in orders]  # type: ignore[arg-type]
        store.commit([Answer(message, entry.n) for message in messages], [entry])
        for message in messages:
            store.sent(store.next("a"), message.key)  # type: ignore[arg-type]

    deliver(store.take(letter("one", id="m1")), ("text", "", "a1"), ("text", "", "a2"), ("text", "", "a3"))
    changed = [("edit", "a1", "a1"), ("edit", "a2", "b2"), ("delete", "a3", ""), ("text", "", "b3")]
    deliver(store.take(letter("two", id="m1", kind="edit")), *changed)
    last = store.take(letter("three", id="m1", kind="edit"))
    assert last is not None
    assert store.answers_to(last) == ["a1", "b2", "b3"]


def test_a_message_is_dropped_after_several_crashes_but_not_after_clean_ends(tmp_path: Path) -> None:
    store = opened(tmp_path)
    store.take(letter("deadly"))
    store.take(letter("innocent"))
    left: list[list[str]] = []
    for _ in range(TRIES + 2):
        entries = store.pending()
        left.append([entry.message.text for entry in entries])
        store.hear(entries[0])
        if entries[0].message.text == "innocent":
            store.unhear(entries[:1])  # the process ends normally
    assert left == [["deadly", "innocent"]] * TRIES + [["innocent"]] * 2


def test_a_message_that_is_dropped_leaves_no_delivered_answer_in_the_file(tmp_path: Path) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("deadly"))
    assert entry is not None
    store.commit([answer("a secret word", entry), answer("not delivered", entry)])
    store.sent(store.next("a"), "id 1")  # type: ignore[arg-type]
    for _ in range(TRIES):
        store.hear(entry)
    assert store.pending() == []
    assert [each.text for each in store.recorded(entry.n)] == ["not delivered"]
    store.close()
    assert b"secret" not in b"".join(file.read_bytes() for file in (tmp_path / "folder").iterdir())


def test_an_edit_replaces_a_message_that_is_not_heard_yet(tmp_path: Path) -> None:
    store, message = opened(tmp_path), letter("one")
    entry, edit = store.take(message), store.take(letter("two", id=message.id, kind="edit"))
    assert entry is not None
    assert edit is not None
    assert store.hear(entry, [edit]).message.text == "two"
    assert [each.message.text for each in store.pending()] == ["two"]
    assert not store.knows("a", message.person)


def test_hearing_a_forgotten_message_does_not_store_it_again(tmp_path: Path) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("one"))
    assert entry is not None
    store.forget("a")
    store.hear(entry)
    assert store.pending() == []


def test_the_keys_of_old_messages_are_deleted_when_a_new_message_comes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    store, now = opened(tmp_path), time.time()
    one, two = letter("one"), letter("two")
    done, open_ = store.take(one), store.take(two)
    assert done is not None
    store.commit((), [done])
    monkeypatch.setattr("time.time", lambda: now + SEEN + 60.0)
    assert store.take(one) is not None  # its key is forgotten
    assert store.take(two) is None
    assert store.pending()[0] == open_


def test_a_failed_commit_leaves_no_transaction_open(tmp_path: Path, connections: list[sqlite3.Connection]) -> None:
    """SQLite checks a deferred reference only at the commit, so only the commit fails."""
    store = opened(tmp_path)
    [connection] = connections
    connection.execute("PRAGMA foreign_keys=ON")
    connection.execute("CREATE TABLE child (n REFERENCES inbox (n) DEFERRABLE INITIALLY DEFERRED)")
    with pytest.raises(sqlite3.IntegrityError), store.batch():
        connection.execute("INSERT INTO child VALUES (99)")
    store.take(letter("one"))
    store.close()
    assert [entry.message.text for entry in opened(tmp_path).pending()] == ["one"]


def test_a_forgotten_chat_leaves_no_text_in_the_file(tmp_path: Path) -> None:
    store = opened(tmp_path)
    entry = store.take(letter("a very secret word", person=Person("p", "Ada")))
    store.commit([answer("another secret word", entry)])
    store.forget("a")
    assert (store.pending(), store.chats_to_send()) == ([], [])
    store.close()
    whole = b"".join(file.read_bytes() for file in (tmp_path / "folder").iterdir())
    assert b"secret" not in whole


def test_the_method_move_gives_all_messages_of_a_chat_to_another_chat(tmp_path: Path) -> None:
    store = opened(tmp_path)
    store.take(letter("one"))
    store.commit([answer("yes")])
    store.begin(store.next("a"), "7")  # type: ignore[arg-type]
    store.move("a", "b")
    assert [entry.message.chat for entry in store.pending()] == ["b"]
    item = store.next("b")
    assert item is not None
    assert (item.message.chat, item.begun) == ("b", False)


def test_only_one_process_can_open_the_file_and_only_the_user_can_read_it(tmp_path: Path) -> None:
    store = opened(tmp_path)
    with pytest.raises(PlatformError, match="another agent uses it"):
        opened(tmp_path)
    assert stat.S_IMODE(store.path.stat().st_mode) == 0o600


@pytest.mark.parametrize("damage", ["text", "a cut", "pages"])
def test_a_damaged_file_is_refused_at_once_with_the_remedy_and_stays_as_it_was(tmp_path: Path, damage: str) -> None:
    store = opened(tmp_path)
    for n in range(100):
        store.take(letter(f"{n} {'word ' * 60}"))
    store.close()
    whole = store.path.read_bytes()
    broken = {
        "text": b"no database at all, but some text that is long enough" * 100,
        "a cut": whole[: len(whole) // 2],
        "pages": whole[:20_480] + b"\xff" * 20_480 + whole[40_960:],
    }[damage]
    store.path.write_bytes(broken)
    for _ in range(2):  # a refused file does not stay locked
        with pytest.raises(PlatformError, match=r"cannot be opened: .*: name another file .* or move this one away"):
            opened(tmp_path)
    assert store.path.read_bytes() == broken


def test_a_database_of_another_program_is_refused_and_not_changed(tmp_path: Path) -> None:
    path = tmp_path / "other.db"
    other = sqlite3.connect(path)
    other.execute("CREATE TABLE notes (name TEXT)")
    other.close()
    before = path.read_bytes()
    with pytest.raises(PlatformError, match="it belongs to another program"):
        Store(path)
    assert path.read_bytes() == before


def test_a_folder_called_locked_is_not_taken_for_a_file_in_use(tmp_path: Path) -> None:
    (tmp_path / "locked").write_text("a file where the folder should be")
    with pytest.raises(PlatformError, match="File exists: name another file"):
        Store(tmp_path / "locked" / "store.db")
