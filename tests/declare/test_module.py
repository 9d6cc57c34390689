"""A module is a value. Each message about a mistake ends with the text to write instead."""

import functools
import inspect
import re
import types
from collections.abc import Callable
from typing import Any

import pytest

import ravestate as rs
from ravestate.declare.module import as_module

HERE = re.escape(__file__)


class Options(rs.Settings):
    late: float = 2.0


def refused(text: str, declare: Callable[[], object]) -> str:
    """Check that a declaration is refused with these words, and return the whole message."""
    with pytest.raises(rs.DeclarationError) as caught:
        declare()
    message = str(caught.value)
    assert text in message, message
    return message


@pytest.fixture
def demo() -> rs.Module:
    return rs.Module("demo")


def do(ctx: object) -> None:
    pass


# ---------------------------------------------------------------------------------------- what a module holds


def test_a_module_holds_its_declarations_and_nothing_else(demo: rs.Module) -> None:
    go, mood, lit, people = demo.signal("go"), demo.slot("mood"), demo.flag("lit"), demo.collection("people")
    rule = demo.rule(when=go)(do)
    assert (demo.signals, demo.slots, demo.rules) == ([go], [mood, lit, people], [rule])
    assert rs.Module("demo").rules == []
    assert repr(demo) == "<module demo>"


def test_a_platform_declares_one_server(demo: rs.Module) -> None:
    async def serve(agent: object) -> None: ...

    assert demo.serve is None
    assert demo.server(serve) is serve and demo.serve is serve
    refused("module demo", lambda: demo.server(serve))
    refused("has a server already", lambda: rs.Module("other", serve=serve).server(serve))


def test_every_declaration_has_the_file_and_line_where_it_was_made(demo: rs.Module) -> None:
    for thing in (demo, demo.signal("a"), demo.slot("b"), demo.flag("c"), demo.collection("d")):
        assert re.fullmatch(f"{HERE}:[0-9]+", thing.origin)
    rule = demo.rule(when=demo.signal("go"))(do)
    assert re.fullmatch(f"{HERE}:[0-9]+", rule.origin)


def test_a_rule_takes_one_or_many_slots_and_signals(demo: rs.Module) -> None:
    a, b, x = demo.slot("a"), demo.slot("b"), demo.signal("x")
    rule = demo.rule(when=x, reads=a, writes=[a, b, a], emits=x)(do)
    assert (rule.reads, rule.writes, rule.emits) == ((a,), (a, b), (x,))


def test_a_rule_can_have_another_name_than_its_function(demo: rs.Module) -> None:
    go = demo.signal("go")
    assert demo.rule(when=go)(do).name == "demo:do"
    assert demo.rule(when=go, name="other")(do).name == "demo:other"
    assert demo.rule(when=go, name="small")(lambda ctx: None).name == "demo:small"


def test_numbers_in_the_options_become_floats_and_references_to_settings_stay(demo: rs.Module) -> None:
    rule = demo.rule(when=demo.signal("go"), weight=2, cooldown=Options.late, patience=0, timeout=1)(do)
    assert (rule.weight, rule.cooldown, rule.patience, rule.timeout) == (2.0, Options.late, 0.0, 1.0)
    assert type(rule.weight) is float and type(rule.timeout) is float


# ---------------------------------------------------------------------------------------- Python modules


def python_module(**contents: object) -> types.ModuleType:
    found = types.ModuleType("pkg")
    vars(found).update(contents)
    return found


def test_a_python_module_can_be_used_in_place_of_the_rs_module_in_it(demo: rs.Module) -> None:
    other = rs.Module("other")
    assert as_module(python_module(module=demo, other=other)) is demo
    assert as_module(python_module(demo=demo, again=demo)) is demo
    assert rs.Module("user", requires=[python_module(module=demo)]).requires == [demo]
    assert rs.Module("user", requires=python_module(module=demo)).requires == [demo]
    assert rs.Module("user", requires=demo).requires == [demo]


def test_a_python_module_without_a_module_or_with_two_is_refused(demo: rs.Module) -> None:
    refused("pkg holds no rs.Module: write module = rs.Module('name')", lambda: as_module(python_module()))
    two = python_module(a=demo, b=rs.Module("b"))
    refused("pkg holds 2 rs.Modules: call one of them `module`", lambda: as_module(two))
    refused("expected an rs.Module (or a Python module that holds one), not 'demo'", lambda: as_module("demo"))


def test_the_message_about_a_wrong_requirement_names_the_module_that_requires_it() -> None:
    message = refused("not 'rawio'", lambda: rs.Module("user", requires="rawio"))
    assert re.match(rf"module user \({HERE}:\d+\): requires: expected an rs.Module", message)
    refused("requires: expected an rs.Module", lambda: rs.Module("user", requires=[None]))


# ---------------------------------------------------------------------------------------- refusals: modules, names


@pytest.mark.parametrize("name", ["", "two words", "a:b", "1st", "a.b", None, 3])
def test_a_name_that_is_not_an_identifier_is_refused(name: Any, demo: rs.Module) -> None:
    for declare in (
        lambda: rs.Module(name),
        lambda: demo.signal(name),
        lambda: demo.slot(name),
        lambda: demo.flag(name),
        lambda: demo.collection(name),
    ):
        refused(f"{name!r} is not a name: use letters, digits, '_' and '-'", declare)


@pytest.mark.parametrize("name", ["a", "my-agent", "_x1", "gefühl"])
def test_identifiers_with_or_without_hyphens_are_names(name: str) -> None:
    assert rs.Module(name).signal(name).name == f"{name}:{name}"


@pytest.mark.parametrize("settings", [Options(), {"late": 1}, dict, "Options"])
def test_settings_that_are_not_a_settings_class_are_refused(settings: Any) -> None:
    refused("write class Settings(rs.Settings): ...", lambda: rs.Module("m", settings=settings))
    assert rs.Module("m", settings=Options).settings is Options


@pytest.mark.parametrize("declare", ["signal", "slot", "flag", "collection"])
def test_wrong_values_of_keep_and_limit_are_refused(declare: str, demo: rs.Module) -> None:
    make = getattr(demo, declare)
    refused("demo:x: keep='last': write keep='all' or keep='latest'", lambda: make("x", keep="last"))
    refused("demo:x: limit=0: write a whole number of at least 1", lambda: make("x", limit=0))
    refused("demo:x: limit=1.5: write a whole number", lambda: make("x", limit=1.5))


# ---------------------------------------------------------------------------------------- refusals: rules


def test_generators_are_refused(demo: rs.Module) -> None:
    def yields(ctx: object) -> Any:
        yield 1

    async def yields_later(ctx: object) -> Any:
        yield 1

    for function in (yields, yields_later):
        message = refused(
            "is a generator, but a rule returns only once: use ctx[slot] = value instead of yield",
            lambda function=function: demo.rule(when=demo.signal("go"))(function),
        )
        assert re.match(rf"rule demo:{function.__name__} \({HERE}:\d+\)", message)


def test_a_function_that_does_not_take_exactly_the_context_is_refused(demo: rs.Module) -> None:
    go = demo.signal("go")

    def forgets() -> None:
        pass

    def wants_more(ctx: rs.RuleContext, text: str) -> None:
        pass

    def wants_a_keyword(ctx: rs.RuleContext, *, text: str) -> None:
        pass

    for function in (forgets, wants_more, wants_a_keyword):
        refused(
            f"gets one argument, the context: write def {function.__name__}(ctx)",
            lambda function=function: demo.rule(when=go)(function),
        )

    class Door:
        def opens(self, ctx: rs.RuleContext, wide: bool = False) -> None:
            pass

    assert demo.rule(when=go)(Door().opens).name == "demo:opens"

    def takes_any(*arguments: object) -> None:
        pass

    assert demo.rule(when=demo.signal("ok"))(takes_any).name == "demo:takes_any"


def test_the_arguments_of_a_decorated_function_are_those_of_the_wrapper(demo: rs.Module) -> None:
    def inner(ctx: object, text: str) -> str:
        return text

    @functools.wraps(inner)
    def fills_in(ctx: object) -> str:
        return inner(ctx, "text")

    @functools.wraps(do)
    def wants_more(ctx: object, text: str) -> None:
        do(ctx)

    go = demo.signal("go")
    assert demo.rule(when=go)(fills_in).name == "demo:inner"
    refused("gets one argument, the context: write def do(ctx)", lambda: demo.rule(when=go)(wants_more))


def test_a_function_whose_annotations_cannot_be_evaluated_can_become_a_rule(demo: rs.Module) -> None:
    class Lazy:
        """A callable object whose signature raises what an annotation raises in Python 3.14."""

        @property
        def __signature__(self) -> inspect.Signature:
            raise NameError("name 'OnlyForTypeCheckers' is not defined")

        def __call__(self, ctx: object) -> None: ...

    assert demo.rule(when=demo.signal("go"), name="lazy")(Lazy()).name == "demo:lazy"


def test_a_value_that_is_not_a_function_cannot_become_a_rule(demo: rs.Module) -> None:
    go = demo.signal("go")
    refused("@demo.rule(...) must decorate a function, not 3", lambda: demo.rule(when=go)(3))
    rule = demo.rule(when=go)(do)
    refused("is a rule already: combine both conditions with |", lambda: demo.rule(when=go)(rule))
    assert demo.rules == [rule]


@pytest.mark.parametrize("function", [lambda ctx: None, functools.partial(do)])
def test_a_rule_whose_function_has_no_name_must_be_given_one(function: Any, demo: rs.Module) -> None:
    refused("has no name of its own: write name='...'", lambda: demo.rule(when=demo.signal("go"))(function))
    assert demo.rule(when=demo.signal("go2"), name="named")(function).name == "demo:named"


@pytest.mark.parametrize("when", [True, None, "go", do, 3])
def test_a_rule_needs_a_condition(when: Any, demo: rs.Module) -> None:
    refused(f"when={when!r} is not a condition: combine signals with & and |", lambda: demo.rule(when=when)(do))
    if when is not None:
        refused(f"until={when!r} is not a condition", lambda: demo.rule(when=demo.signal("go"), until=when)(do))


def test_the_message_about_a_slot_as_condition_names_its_signal(demo: rs.Module) -> None:
    mood = demo.slot("mood")
    refused(
        "when=demo:mood is a slot: write when=mood.changed",
        lambda: demo.rule(when=mood)(do),
    )
    refused(
        "when=rawio:input is a slot: write when=rawio.input.changed",
        lambda: demo.rule(when=rs.Module("rawio").slot("input"))(do),
    )


@pytest.mark.parametrize("what", ["weight", "cooldown", "patience", "timeout"])
@pytest.mark.parametrize("number", ["2", True, [1]])
def test_a_value_that_is_not_a_number_is_refused(what: str, number: Any, demo: rs.Module) -> None:
    options: dict[str, Any] = {what: number}
    refused(
        f"{what}={number!r} is not a number; write {what}=1.0 or a setting",
        lambda: demo.rule(when=demo.signal("go"), **options)(do),
    )


def test_the_arguments_reads_and_writes_take_slots_and_emits_takes_signals(demo: rs.Module) -> None:
    go, mood = demo.signal("go"), demo.slot("mood")
    for what in ("reads", "writes"):
        refused(
            f"{what}=demo:go is not a slot: `reads` and `writes` take slots, `emits` takes signals",
            lambda what=what: demo.rule(when=go, **{what: go})(do),
        )
        refused(f"{what}='mood' is not a slot", lambda what=what: demo.rule(when=go, **{what: ["mood"]})(do))
        refused(f"{what}='mood' is not a slot", lambda what=what: demo.rule(when=go, **{what: "mood"})(do))
        refused(f"{what}=None is not a slot", lambda what=what: demo.rule(when=go, **{what: None})(do))
    refused(
        "emits=demo:mood is not a signal: a rule that writes a slot raises its signals; use writes=mood",
        lambda: demo.rule(when=go, emits=mood)(do),
    )
    message = refused("emits=5 is not a signal", lambda: demo.rule(when=go, emits=5)(do))
    assert re.match(rf"rule demo:do \({HERE}:\d+\): emits=5", message)


@pytest.mark.parametrize(
    ("refusal", "declare"),
    [
        ("demo.rule", lambda m: m.rule(when=m.signal("go"), write=())),
        ("has no argument 'write'; did you mean 'writes'?", lambda m: m.rule(when=None, write=())),
        ("has no argument 'wen'; did you mean 'when'?", lambda m: m.rule(wen=None)),
        ("has no argument 'cooldwon'; did you mean 'cooldown'?", lambda m: m.rule(when=None, cooldwon=3)),
        ("has no argument 'defalt'; did you mean 'default'?", lambda m: m.slot("x", defalt=1)),
        ("has no argument 'alwys'; did you mean 'always'?", lambda m: m.flag("x", alwys=True)),
        ("has no argument 'imput'; did you mean 'input'?", lambda m: m.signal("x", imput=True)),
        ("has no argument 'always'", lambda m: m.collection("x", always=True)),
        ("rs.Module (", lambda m: rs.Module("x", setings=None)),
        ("has no argument 'setings'; did you mean 'settings'?", lambda m: rs.Module("x", setings=None)),
    ],
)
def test_the_message_about_a_misspelt_keyword_names_the_nearest(refusal: str, declare: Any, demo: rs.Module) -> None:
    assert re.search(rf"\({HERE}:\d+\)", refused(refusal, lambda: declare(demo)))
    assert demo.rules == demo.slots == []


def test_the_signature_of_the_decorator_rule_shows_its_arguments() -> None:
    assert list(inspect.signature(rs.Module.rule).parameters)[:4] == ["self", "when", "reads", "writes"]


def test_a_refused_rule_is_not_in_the_module(demo: rs.Module) -> None:
    refused("is not a condition", lambda: demo.rule(when=None)(do))
    assert demo.rules == []
