"""Reading a trace file gives the records that were written. A message says where a file is wrong."""

import dataclasses
import json
import resource
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from board.looking import Look, board, gossip, in_virtual_time
from modules.platform.webio.visit import parrot
from ravestate.board.description import describe
from ravestate.board.recorder import Gap
from ravestate.board.trace_file import MOST_VALUES, open_trace, read_apart, read_trace, save_trace
from ravestate.board.why_not import why_not
from ravestate.board.wire import checked_record, data_of
from ravestate.engine.trace import Born, Record, Settled
from ravestate.errors import PlatformError
from ravestate.modules import rawio
from ravestate.testing import simulate


def recorded(path: Path) -> tuple[list[Record], rs.Policy]:
    with simulate(gossip, parrot) as sim:
        sim.say("Hello")
        sim.advance(2)
        records, policy = list(sim.trace), sim.context.policy
    save_trace(path, policy, records, title="Elske")
    return records, policy


def test_reading_a_trace_file_gives_the_records_and_policy_that_were_written(tmp_path: Path) -> None:
    records, policy = recorded(tmp_path / "trace.json")
    found = open_trace(tmp_path / "trace.json")
    assert (found.title, found.whole) == ("Elske", True)
    assert found.description == describe(policy)
    assert [data_of(record) for record in found.records] == [data_of(record) for record in records]


def test_a_trace_that_cannot_be_written_leaves_the_earlier_trace(tmp_path: Path) -> None:
    records, policy = recorded(tmp_path / "trace.json")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, hard))  # fails in the middle of the file, like a full disk
    try:
        with pytest.raises(OSError, match="File too large"):
            save_trace(tmp_path / "trace.json", policy, records, title="Later")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert open_trace(tmp_path / "trace.json").title == "Elske"
    assert len(list(tmp_path.iterdir())) == 1


def test_a_trace_file_alone_is_enough_to_answer_why_not(tmp_path: Path) -> None:
    recorded(tmp_path / "trace.json")
    found = open_trace(tmp_path / "trace.json")
    kept = [record for record in found.records if not isinstance(record, Gap)]
    spike = next(r.spike for r in kept if isinstance(r, Born) and r.signal == str(rawio.input.changed))
    assert why_not(kept, found.description, "gossip:answer", spike).verdict == "untouched"


def test_the_board_shows_a_recording_without_an_agent_and_refuses_commands(tmp_path: Path) -> None:
    records, _ = recorded(tmp_path / "trace.json")
    look_at(tmp_path, len(records))


@in_virtual_time
async def look_at(tmp_path: Path, count: int) -> None:
    async with board(recording=open_trace(tmp_path / "trace.json")) as app, Look(app) as look:
        welcome = await look.begin()
        while len(look.records) < count:
            await look.answer("records")
        spike = (await look.until("born", signal="rawio:input:changed"))["spike"]
        look.tell("why", rule="gossip:answer", spike=spike)
        found = await look.answer("why")
        for command in ({"type": "step"}, {"type": "explain", "rule": "gossip:talk"}):
            look.send(json.dumps(command))
            assert "this is a recording" in (await look.answer("error"))["text"]
        assert len(app.state.sessions) == 0
    assert (welcome["live"], welcome["title"], welcome["visitor"]) == (False, "Elske", None)
    assert found["verdict"] == "untouched"


GOOD: dict[str, Any] = {"format": "ravestate-trace", "v": 1, "records": []}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "it is not JSON"),
        ("[" * 100_000, "it is not JSON"),
        ("[]", ": Input should be a valid dictionary"),
        ({**GOOD, "v": 9}, "v: Input should be 1"),
        ({**GOOD, "records": {}}, "records: Input should be a valid list"),
        ({**GOOD, "records": [7]}, "records.0: Input should be a valid dictionary"),
        (
            {**GOOD, "records": [{"kind": "dance"}]},
            "records.0: Input tag 'dance' found using 'kind' does not match any of the expected tags: 'born', ",
        ),
        (
            {**GOOD, "records": [{"kind": "merged", "time": "late", "group": 1, "into": 2}]},
            "records.0.merged.time: ",
        ),
        ({**GOOD, "records": [{"kind": "merged", "time": 1, "group": 1}]}, "records.0.merged.into: "),
        ({**GOOD, "policy": {}}, "policy.modules: Field required"),
        ("[" + "[]," * MOST_VALUES + "[]]", "it has more than 6,000,000 values"),
    ],
)
def test_a_file_that_is_not_a_valid_trace_is_refused(text: Any, words: str) -> None:
    with pytest.raises(ValueError) as caught:
        read_trace(text if isinstance(text, str) else json.dumps(text))
    assert words in str(caught.value)


def test_a_diagram_whose_edge_leads_to_no_node_is_refused(tmp_path: Path) -> None:
    recorded(tmp_path / "trace.json")
    data = json.loads((tmp_path / "trace.json").read_text("utf-8"))
    data["policy"]["diagram"]["edges"][0]["target"] = "nowhere"
    with pytest.raises(ValueError, match="nowhere"):
        read_trace(json.dumps(data))


@pytest.mark.parametrize("spell", [json.dumps, lambda data: json.dumps(data, ensure_ascii=False)])
def test_lone_surrogates_in_a_file_are_replaced(tmp_path: Path, spell: Callable[[Any], str]) -> None:
    recorded(tmp_path / "trace.json")
    data = json.loads((tmp_path / "trace.json").read_text("utf-8"))
    data["title"] = "\ud800x 👋 \\ud800"
    data["records"].append(
        {"kind": "settled", "time": 9, "run": 1, "rule": "\udfff", "outcome": "failed",
         "reason": "no \ud83d", "fired": False}
    )  # fmt: skip
    data["policy"]["rules"][0]["doc"] = "\udc00"
    data["records"][0]["payload"] = {"text": '"\ud800"'}
    text = spell(data)
    for found in (read_trace(text), read_trace(text.encode("utf-8", "surrogatepass"))):
        assert found.title == "?x 👋 \\ud800"
        told = [data_of(record) for record in found.records]
        assert (told[-1]["rule"], told[-1]["reason"], told[0]["payload"]) == ("?", "no ?", {"text": '"?"'})
        json.dumps([dataclasses.asdict(found.description), told], ensure_ascii=False).encode()
        save_trace(tmp_path / "again.json", simulated(), found.records, title="\ud800")
    assert open_trace(tmp_path / "again.json").title == "?"


def simulated() -> rs.Policy:
    with simulate(gossip, parrot) as sim:
        return sim.context.policy


def test_a_trace_file_can_begin_with_a_byte_order_mark(tmp_path: Path) -> None:
    recorded(tmp_path / "trace.json")
    assert read_trace(b"\xef\xbb\xbf" + (tmp_path / "trace.json").read_bytes()).title == "Elske"
    with pytest.raises(ValueError, match="it is not JSON"):
        read_trace(b'{"format": "\xff"}')


def test_the_message_for_a_missing_or_broken_file_names_the_file(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match=r"cannot read .*gone\.json: No such file"):
        open_trace(tmp_path / "gone.json")
    (tmp_path / "bad.json").write_text("no", "utf-8")
    with pytest.raises(PlatformError, match=r"bad\.json is not a trace: it is not JSON"):
        open_trace(tmp_path / "bad.json")


def test_a_gap_is_read_back_as_it_was_written() -> None:
    assert checked_record(data_of(Gap(1.5, 7))) == Gap(1.5, 7)


def test_the_description_of_a_policy_can_be_written_as_json() -> None:
    with simulate(gossip, parrot) as sim:
        json.dumps(dataclasses.asdict(describe(sim.context.policy)))


def test_a_recording_is_parsed_in_a_separate_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    recorded(tmp_path / "trace.json")
    data = (tmp_path / "trace.json").read_bytes()
    whole = read_trace(data)
    monkeypatch.setattr(json, "loads", None)  # parsing in this process would fail
    assert read_apart(data) == whole
    with pytest.raises(ValueError, match="it is not JSON"):
        read_apart(b"{")


def test_the_record_of_a_failure_keeps_its_traceback() -> None:
    try:
        raise ValueError("out of ink")
    except ValueError as error:
        settled = Settled(1.0, 1, "m:draw", "failed", "ValueError('out of ink')", False, error)
    data = data_of(settled)
    assert data["error"].startswith("Traceback (most recent call last):")
    assert data["error"].endswith("ValueError: out of ink\n")
    read = checked_record(data)
    assert data_of(read) == data
    assert "error" not in data_of(Settled(1.0, 1, "m:draw", "done", "", True))


def test_a_list_of_faulty_records_is_refused_at_its_first_fault() -> None:
    file = {"format": "ravestate-trace", "v": 1, "records": [1] * (MOST_VALUES - 100)}
    # A message for each of these records would need more than the memory limit.
    with pytest.raises(ValueError, match=r"records\.0: Input should be a valid dictionary"):
        read_apart(json.dumps(file).encode())


def test_a_file_that_would_fill_the_memory_is_refused(tmp_path: Path) -> None:
    recorded(tmp_path / "trace.json")
    file = json.loads((tmp_path / "trace.json").read_bytes())
    file["policy"]["rules"] = [1] * (MOST_VALUES - 10_000)
    with pytest.raises(ValueError, match="reading it takes more than 2 GB of memory"):
        read_apart(json.dumps(file).encode())
