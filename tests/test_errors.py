"""The tree of exceptions, and the hint "did you mean"."""

import pytest

import ravestate as rs
from ravestate.errors import nearest


@pytest.mark.parametrize(
    ("error", "builtin"),
    [
        (rs.DeclarationError, ValueError),
        (rs.DeclarationErrors, ExceptionGroup),
        (rs.RuleError, RuntimeError),
        (rs.UndeclaredError, LookupError),
        (rs.RuleTimeout, TimeoutError),
        (rs.RunEnded, rs.RuleError),
        (rs.EngineError, RuntimeError),
        (rs.PlatformError, RuntimeError),
        (rs.Resign, rs.RavestateError),
    ],
)
def test_each_error_derives_from_the_root_and_a_builtin(error: type[Exception], builtin: type[Exception]) -> None:
    assert issubclass(error, rs.RavestateError)
    assert issubclass(error, builtin)


def test_the_text_of_the_group_has_all_faults() -> None:
    faults = rs.DeclarationErrors([rs.DeclarationError("one"), rs.DeclarationError("two")])
    assert str(faults) == "2 faults in the declarations:\n  - one\n  - two"
    assert str(rs.DeclarationErrors([rs.DeclarationError("one")])).startswith("1 fault in the declarations:")


def test_except_star_and_split_select_faults_of_the_group() -> None:
    group = rs.DeclarationErrors([rs.DeclarationError("one"), rs.DeclarationError("two")])
    matching, rest = group.split(lambda error: str(error) == "one")
    assert isinstance(matching, rs.DeclarationErrors) and "1 fault" in str(matching)
    assert isinstance(rest, rs.DeclarationErrors) and "two" in str(rest)
    caught: list[Exception] = []
    try:
        raise group
    except* rs.DeclarationError as found:
        caught += found.exceptions
    assert [str(error) for error in caught] == ["one", "two"]


def test_the_text_of_an_undeclared_error_has_no_quotation_marks() -> None:
    assert str(rs.UndeclaredError("add reads=mood")) == "add reads=mood"
    assert str(rs.UndeclaredError()) == ""


@pytest.mark.parametrize(
    ("name", "known", "hint"),
    [
        ("rawio:inptu", ["rawio:input", "rawio:output"], "; did you mean 'rawio:input'?"),
        (
            "x:output_of_the_agent",
            ["rawio:output_of_the_agent"],
            "; did you mean 'rawio:output_of_the_agent'?",
        ),
        ("a_long_module_name:go", ["b:go"], "; did you mean 'b:go'?"),
        ("idel", ["interloc", "idle"], "; did you mean 'idle'?"),
        ("idel", ["interloc", "rawio"], ""),  # only three letters of eight agree
        ("abel", ["ablest", "able"], "; did you mean 'able'?"),  # two exchanged letters count as one mistake
        ("ba", ["ab"], "; did you mean 'ab'?"),
        ("gretting", ["getting_on", "greeting"], "; did you mean 'greeting'?"),
        ("bored", ["board", "bored_after_a_long_while"], "; did you mean 'bored_after_a_long_while'?"),
        ("m:mood", ["m:go", "m:mood:changed"], "; did you mean 'm:mood:changed'?"),
        ("x", ["y", "x_and_y"], ""),
        ("xyz", ["rawio:input"], ""),
        ("anything", [], ""),
    ],
)
def test_the_hint_names_the_nearest_name(name: str, known: list[str], hint: str) -> None:
    assert nearest(name, known) == hint


def test_the_error_about_a_misspelt_public_name_has_a_hint() -> None:
    with pytest.raises(AttributeError, match="ravestate has no 'Modul'; did you mean 'Module'"):
        _ = rs.Modul
