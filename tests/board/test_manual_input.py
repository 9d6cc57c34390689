"""Input on the board passes the same checks as input from platforms and rules."""

import dataclasses
import enum
import json
from collections.abc import Callable, Mapping
from typing import Annotated, Any, Literal

import pytest

import ravestate as rs
from board.looking import Look, board, gossip, in_virtual_time, passing
from modules.platform.webio.visit import Visit, parrot
from ravestate.board.manual_input import check_payload, check_value
from ravestate.board.protocol import Emit
from ravestate.modules import interloc, rawio
from ravestate.modules.platform.webio.fields import LONGEST_TEXT
from ravestate.modules.platform.webio.frames import SERVER, Message
from ravestate.modules.platform.webio.protocol import parse


class Colour(enum.StrEnum):
    RED = "red"


@dataclasses.dataclass
class Point:
    x: int


lab = rs.Module("lab")
plain = lab.signal("plain")
word = lab.signal("word", payload=str)
measure = lab.signal("measure", payload=float)
numbers = lab.signal("numbers", payload=list[int])
pair = lab.signal("pair", payload=tuple[int, int])
anything = lab.signal("anything", payload=object)
unsure: rs.Signal[Any] = lab.signal("unsure", payload=Any)  # type: ignore[arg-type]  # Any is not a type for a checker
point = lab.signal("point", payload=Point)
colour = lab.signal("colour", payload=Colour)
text = lab.slot("text", "", type=str)
perhaps: rs.Slot[str | None] = lab.slot("perhaps", None, type=str)
place: rs.Slot[Point | None] = lab.slot("place", None, type=Point)
free: rs.Slot[Any] = lab.slot("free")
lamp = lab.flag("lamp")
people = lab.collection("people")

SLOTS = {slot.name: slot for slot in (text, perhaps, place, free, lamp, people)}


def emit(signal: rs.Signal[Any], holds: object = None, **payload: Any) -> None:
    """Check a payload as the board does before it raises a signal."""
    slot = SLOTS.get(signal.name.rpartition(":")[0])
    check_payload(signal, Emit(type="emit", signal=signal.name, **payload), slot, holds)


@pytest.mark.parametrize(
    ("signal", "payload"),
    [
        (plain, {}),
        (plain, {"payload": None}),
        (word, {"payload": "yes"}),
        (measure, {"payload": 1}),
        (numbers, {"payload": [1]}),
        (anything, {"payload": {"any": [1]}}),
        (unsure, {"payload": 7}),
        (text.changed, {"payload": "hello"}),
        (perhaps.changed, {"payload": None}),
        (place.changed, {"payload": None}),
        (free.changed, {}),
        (free.changed, {"payload": [1, 2]}),
        (lamp.true, {"payload": True}),
    ],
)
def test_a_payload_that_fits_its_signal_is_accepted(signal: rs.Signal[Any], payload: dict[str, Any]) -> None:
    emit(signal, **payload)


@pytest.mark.parametrize(
    ("signal", "payload", "words"),
    [
        (plain, {"payload": 7}, r"lab:plain carries no payload: send none, or declare its type"),
        (plain, {"payload": False}, r"lab:plain carries no payload"),
        (word, {}, r"lab:word carries a payload of type str: give a payload"),
        (word, {"payload": 7}, r"a payload of type str, not int"),
        (word, {"payload": None}, r"a payload of type str, not NoneType"),
        (measure, {"payload": "1"}, r"a payload of type float, not str"),
        (numbers, {"payload": "1"}, r"a payload of type list\[int\], not str"),
        (pair, {"payload": [1, 2]}, r"tuple\[int, int\], which JSON cannot express: only a rule or a program"),
        (point, {"payload": {"x": 1}}, r"a payload of type Point, which JSON cannot express"),
        (colour, {"payload": "red"}, r"a payload of type Colour, which JSON cannot express"),
        (text.changed, {"payload": 7}, r"lab:text:changed carries a payload of type str, not int"),
        (text.changed, {}, r"lab:text:changed carries a payload of type str: give a payload"),
        (perhaps.changed, {"payload": 7}, r"a payload of type str, not int"),
        (place.changed, {"payload": {"x": 1}}, r"type Point, which JSON cannot express"),
        (lamp.changed, {"payload": 1}, r"a payload of type bool, not int"),
        (people.added, {"payload": ["ada", 1]}, r"a change of the collection lab:people: write the slot"),
        (people.changed, {}, r"write the slot"),
    ],
)  # fmt: skip
def test_a_wrong_payload_is_refused(signal: rs.Signal[Any], payload: dict[str, Any], words: str) -> None:
    with pytest.raises(rs.RavestateError, match=words):
        emit(signal, **payload)


@pytest.mark.parametrize("holds", [None, 7, float("inf"), "x", [1], {"a": {"b": [1, 2]}}, "x" * 10**6])
def test_an_untyped_slot_takes_any_json_only_while_its_value_is_json(holds: object) -> None:
    check_value(free, "new", holds)
    for foreign in (Point(1), [Point(1)], {"a": Point(1)}, {1: 2}, (1, 2), [(1, 2)]):
        with pytest.raises(rs.RavestateError, match=rf"lab:free holds a {type(foreign).__name__}, which JSON"):
            check_value(free, "new", foreign)
        with pytest.raises(rs.RavestateError, match="lab:free holds a"):
            emit(free.changed, foreign, payload="new")


def test_a_collection_can_be_written_even_if_its_items_are_not_json() -> None:
    check_value(people, {"ada": 1}, {"ada": Point(1)})


def test_a_value_of_a_type_that_json_cannot_express_is_refused() -> None:
    with pytest.raises(rs.RavestateError, match="lab:place takes Point, which JSON cannot express"):
        check_value(place, {"x": 1}, None)
    check_value(place, None, Point(1))  # the default of the slot


Strings = Annotated[list[str] | None, "of some kind"]

CONTAINERS: list[tuple[Any, Any, list[Any], list[Any]]] = [
    (list[int], [], [[1], []], ["banana", {}, None]),
    (dict[str, int], {}, [{"a": 1}], ["banana", [], 7]),
    (Mapping[str, int], {}, [{"a": 1}], ["banana", []]),
    (list[int] | str, "", ["banana", [1]], [7, {}, None]),
    (list[int] | None, None, [[1], None], ["banana", {}]),
    (Strings, None, [["a"], None], ["banana", {}]),
    (list[int], None, [[1], None], ["banana", {}]),
]


@pytest.mark.parametrize(("kind", "default", "taken", "refused"), CONTAINERS, ids=lambda one: str(one))
def test_a_container_type_takes_only_containers_of_that_type(
    kind: Any, default: Any, taken: list[Any], refused: list[Any]
) -> None:
    slot = rs.Module("boxes").slot("box", default, type=kind)
    for value in taken:
        check_value(slot, value, default)
        check_payload(slot.changed, Emit(type="emit", signal="boxes:box:changed", payload=value), slot)
    for value in refused:
        with pytest.raises(rs.RavestateError, match=r"boxes:box takes .*, not"):
            check_value(slot, value, default)
        with pytest.raises(rs.RavestateError, match=r"boxes:box:changed carries a payload of type .*, not"):
            check_payload(slot.changed, Emit(type="emit", signal="boxes:box:changed", payload=value), slot)


@pytest.mark.parametrize("kind", [tuple[str, ...], frozenset[str], set[int], Callable[[], None], tuple[int] | set[str]])
def test_containers_that_json_cannot_express_are_refused(kind: Any) -> None:
    slot = rs.Module("boxes").slot("box", 0, type=kind)
    for value in ("banana", ["a"], None):
        with pytest.raises(rs.RavestateError, match=r"boxes:box takes .*, which JSON cannot express"):
            check_value(slot, value, None)


@pytest.mark.parametrize("kind", [Any, Literal["a", "b"], list[int] | Literal["a"]])
def test_a_slot_whose_type_cannot_be_checked_counts_as_untyped(kind: Any) -> None:
    slot = rs.Module("boxes").slot("box", "a", type=kind)
    check_value(slot, "b", "a")
    with pytest.raises(rs.RavestateError, match="boxes:box holds a Point"):
        check_value(slot, "b", Point(1))


@pytest.mark.parametrize("value", [1, 0, "true", None])
def test_a_flag_takes_only_true_and_false(value: Any) -> None:
    check_value(lamp, True, False)
    with pytest.raises(rs.RavestateError, match=rf"lab:lamp is a flag: write true or false, not {value!r}"):
        check_value(lamp, value, False)


async def refusals(look: Look) -> list[str]:
    """Return the error messages for all commands so far."""
    look.tell("ping")
    found: list[str] = []
    while (frame := await look.next())["type"] != "pong":
        if frame["type"] == "error":
            assert frame["code"] == "refused"
            found.append(frame["text"])
    return found


@in_virtual_time
async def test_the_board_cannot_raise_a_slots_signal_with_a_value_that_the_slot_refuses() -> None:
    async with board() as app, Look(app) as look:
        await look.begin()
        look.tell("emit", signal="rawio:input:changed", payload=7)
        look.tell("emit", signal="gossip:question", payload={"any": 1})
        look.tell("emit", signal="interloc:users:added", payload=["ada", None])
        refused = await refusals(look)
        look.tell("emit", signal="rawio:input:changed", payload="Really?")
        await look.until("settled", rule="gossip:answer", outcome="done")
        assert not look.found("settled", outcome="failed")
    assert len(refused) == 3


@in_virtual_time
async def test_the_board_cannot_overwrite_the_page_of_a_visitor() -> None:
    async with board(parrot) as app, Visit(app) as visit:
        await visit.hello()
        await visit.messages(1)
        async with Look(app) as look:
            await look.begin(session=visit.session)
            look.tell("put", slot="webio:page", value="hello")
            look.tell("put", slot="webio:page", value=None)
            look.tell("emit", signal="webio:page:changed", payload=None)
            assert len(await refusals(look)) == 3
            visit.say("hi")
            assert await visit.messages(2) == ["user: hi", "agent: hi"]


@in_virtual_time
async def test_the_command_say_treats_a_text_as_if_the_visitor_had_typed_it() -> None:
    async with board() as app, Visit(app) as visit:
        await visit.hello()
        async with Look(app) as look:
            await look.begin(session=visit.session)
            look.tell("pause")
            for _ in range(3):  # three equal texts, with no record between them
                look.tell("say", text="\x1b[2JHello\x00")
            look.tell("say", text="x" * (LONGEST_TEXT + 1))
            look.tell("say", text=" \x00 ")
            refused = await refusals(look)
            said: list[Message] = []
            while len(said) < 3:
                frame = await visit.next()
                if frame["type"] == "message" and frame["from"] == "user":
                    message = parse(json.dumps(frame), SERVER)
                    assert isinstance(message, Message)
                    said.append(message)
    assert [message.text for message in said] == ["Hello"] * 3
    assert len({message.id for message in said}) == 3
    assert [text.partition(":")[0] for text in refused] == ["say", "say"]
    assert "10,000 characters" in refused[0]


@in_virtual_time
async def test_an_ending_conversation_refuses_all_input_with_a_message() -> None:
    slow = rs.Module("slow", requires=(rawio, interloc))

    @slow.rule(when=interloc.users.removed, writes=rawio.output)
    async def say_farewell(ctx: rs.RuleContext) -> None:
        await ctx.sleep(3)
        ctx[rawio.output] = "Goodbye"

    async with board(gossip, slow) as app, Visit(app) as visit:
        await visit.hello()
        async with Look(app) as look:
            await look.begin(session=visit.session)
            (session,) = app.state.sessions
            visit.tell("bye")
            await passing(1)
            look.tell("say", text="Anybody there?")
            look.tell("put", slot="gossip:secret", value=1)
            look.tell("emit", signal="gossip:question")
            refused = await refusals(look)
            look.tell("look")
            slots = (await look.answer("state"))["slots"]
            await look.answer("ended")
    assert refused == ["this conversation is ending: it takes no more input"] * 3
    assert slots["gossip:secret"] == {"text": "null"}
    assert [message.text for message in session.history.since(0)] == ["Goodbye"]
