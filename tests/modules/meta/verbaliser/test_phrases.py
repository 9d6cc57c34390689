"""A phrase book reads and merges files, and chooses phrases. Its errors name the line of each mistake."""

import random
import re
from importlib.resources import files
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.errors import DeclarationError, PlatformError, RuleError
from ravestate.modules.meta.verbaliser.phrases import Phrase, PhraseBook

BASE = """
# what an agent says
greet:
  en:
    - Hello!
    - Hello {name}!
  de: [Hallo!]
  de-AT: Servus!
farewell: Goodbye!
answer: [no, 1, "{{braces}}", ' trimmed ']
no: {no: nei}
"""


def book(tmp_path: Path, *texts: str, language: str = "en", **options: str) -> PhraseBook:
    paths: list[Path] = []
    for number, text in enumerate(texts):
        paths.append(tmp_path / f"phrases{number}.yaml")
        paths[-1].write_text(text, encoding="utf-8")
    return PhraseBook.load(paths, language, **options)


def texts(found: PhraseBook, intent: str, language: str | None = None) -> list[str]:
    return [template.text for template in found.templates(intent, language)]


def test_a_phrase_file_can_have_all_notations(tmp_path: Path) -> None:
    found = book(tmp_path, BASE)
    assert found.intents == ("greet", "farewell", "answer", "no")
    assert found.languages == ("de", "de-AT", "en", "no")
    assert texts(found, "greet") == ["Hello!", "Hello {name}!"]
    assert [sorted(t.parameters) for t in found.templates("greet")] == [[], ["name"]]
    assert texts(found, "farewell") == ["Goodbye!"]
    assert texts(found, "answer") == ["no", "1", "{{braces}}", "trimmed"]
    assert texts(found, "no", "no") == ["nei"]


def test_a_phrase_book_can_be_loaded_from_strings_and_paths(tmp_path: Path) -> None:
    book(tmp_path, BASE)
    file = tmp_path / "phrases0.yaml"
    assert PhraseBook.load([str(file)]).intents == PhraseBook.load([file]).intents
    with pytest.raises(PlatformError, match=r"nothing.yaml' does not exist"):
        PhraseBook.load([files("ravestate") / "nothing.yaml"])


@pytest.mark.parametrize(
    ("language", "expected"),
    [
        ("en", "Hello!"), ("en-GB", "Hello!"), ("de", "Hallo!"), ("de-CH", "Hallo!"), ("de_at", "Servus!"),
        ("DE-at", "Servus!"), ("de-AT-x", "Servus!"), ("fr", "Hello!"),
    ],
)  # fmt: skip
def test_phrases_come_from_the_nearest_language_that_has_some(tmp_path: Path, language: str, expected: str) -> None:
    """The order is: the language itself, the language without the region, the default language."""
    assert texts(book(tmp_path, BASE, language=language), "greet")[0] == expected
    assert texts(book(tmp_path, BASE), "greet", language)[0] == expected


def test_the_default_language_can_be_chosen(tmp_path: Path) -> None:
    found = book(tmp_path, BASE, language="fr", default_language="de-DE")
    assert texts(found, "greet") == ["Hallo!"]
    assert texts(found, "farewell") == ["Goodbye!"]


def test_a_later_file_replaces_or_adds_phrases(tmp_path: Path) -> None:
    mine = "greet:\n  en: [Ahoy!]\n  de: !add [Moin!]\n  fr: !add Salut !\njoke: Ha."
    found = book(tmp_path, BASE, mine, "", "# nothing\n")
    assert texts(found, "greet") == ["Ahoy!"]
    assert texts(found, "greet", "de") == ["Hallo!", "Moin!"]
    assert texts(found, "greet", "de-AT") == ["Servus!"]
    assert texts(found, "greet", "fr") == ["Salut !"]
    assert texts(found, "farewell") == ["Goodbye!"]
    assert found.intents[-1] == "joke"


def test_a_phrase_book_can_be_made_from_a_dict() -> None:
    found = PhraseBook({"greet": {"de_at": ["Servus {name}!"]}}, language="de-AT")
    assert found.choose("greet", {"name": "Ada"}, random.Random(0)) == Phrase("Servus Ada!", "Servus {name}!")
    with pytest.raises(DeclarationError, match="name no parameter"):
        PhraseBook({"greet": {"en": ["{0}"]}})


# ----------------------------------------------------------------------------------------- choosing


def test_the_same_seed_chooses_the_same_phrase() -> None:
    found = PhraseBook({"x": {"en": list("abcdef")}})
    first, second = (
        [found.choose("x", {}, rng).text for _ in range(9)] for rng in (random.Random(7), random.Random(7))
    )
    assert first == second
    assert len(set(first)) > 1


@given(st.lists(st.sampled_from("abc"), min_size=1), st.integers())
def test_no_phrase_comes_twice_in_a_row_if_there_is_another(phrases: list[str], seed: int) -> None:
    found, rng, last = PhraseBook({"x": {"en": phrases}}), random.Random(seed), None
    for _ in range(10):
        chosen = found.choose("x", {}, rng, last)
        assert chosen.template != last or len(set(phrases)) == 1
        last = chosen.template


def test_a_phrase_without_its_parameters_is_not_chosen() -> None:
    found = PhraseBook({"x": {"en": ["Hi!", "Hi {name}!", "Hi {name} and {other}!"]}})
    rng = random.Random(0)

    def all_of(**given: object) -> set[str]:
        return {found.choose("x", given, rng).text for _ in range(99)}

    assert all_of() == all_of(name=None) == {"Hi!"}
    assert all_of(name=1, more=2) == {"Hi!", "Hi 1!"}
    assert all_of(name="{other}", other=2) == {"Hi!", "Hi {other}!", "Hi {other} and 2!"}


def test_doubled_braces_in_a_phrase_become_single_braces() -> None:
    assert PhraseBook({"x": {"en": ["{{{a}}}"]}}).choose("x", {"a": 1}, random.Random()).text == "{1}"


@pytest.mark.parametrize(
    ("intent", "parameters", "message"),
    [
        ("gret", {}, r"no phrases for the intent 'gret'; did you mean 'greet'\? \(known: greet, only\)"),
        ("greet", {"nam": 1}, r"lacks a parameter; give name \(given: nam; did you mean 'name'\?\), or add"),
        ("greet", {}, r"give name \(given: none\)"),
        (
            "only",
            {},
            r"'only' has no phrases in de-AT or de or en, only in fr. To add them.*\nonly:\n  de-AT:",
        ),
    ],
)
def test_the_error_says_why_no_phrase_can_be_chosen(intent: str, parameters: dict[str, object], message: str) -> None:
    found = PhraseBook({"greet": {"en": ["Hi {name}!"]}, "only": {"fr": ["Oui."]}}, language="de-AT")
    with pytest.raises(RuleError, match=f"(?s){message}"):
        found.choose(intent, parameters, random.Random())
    with pytest.raises(RuleError, match="known: none"):
        PhraseBook({}).choose(intent, parameters, random.Random())


# --------------------------------------------------------------------------------- mistakes in files


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("greet: [Hello", 1, "not valid YAML"),
        ("greet:\n  en: Hello: you", 2, "not valid YAML .*[Pp]ut quotes"),
        ("a: b\n\x07", 2, "a control character"),
        ("a: b\n---\nc: d", 2, "not valid YAML .*another document"),
        ("- Hello!", 1, "maps intents to languages, but this is not a mapping"),
        ("Hello!", 1, "maps intents to languages"),
        ("greet:\n  en:\n  de: Hallo", 2, "a phrase is empty"),
        ("greet:\n  en: ['', x]", 2, "a phrase is empty"),
        ("greet:\n  en: []", 2, "there are no phrases"),
        (
            "greet:\n  en:\n    - {name}, hello",
            3,
            "a phrase is a text, but this is a mapping.*[Pp]ut quotes|not valid YAML",
        ),
        ("greet:\n  en:\n    - {name}", 3, "a phrase is a text, but this is a mapping"),
        ("greet:\n  en:\n    - [a]", 3, "a phrase is a text, but this is a sequence"),
        ("greet:\n  en: {a: b}", 2, "a phrase is a text"),
        ("[a]: b", 1, "an intent is a text"),
        ("a:\n  [b]: c", 2, "a language is a text"),
        ("a: b\nc: d\na: e", 3, "'a' is here twice"),
        ("a:\n  en: b\n  en: c", 3, "'en' is here twice"),
        ("a:\n  en: !ad [b]", 2, r"only tag is !add, not !ad; did you mean '!add'\?"),
        ("a: !add {en: b}", 1, r"goes in front of phrases: write en: !add"),
        ("a: !!python/object/apply:os.getcwd []", 1, "there are no phrases"),
        ("a: hi {", 1, "name no parameter .*write {name}"),
        ("a: hi {}", 1, "{} is not a parameter"),
        ("a: hi {0}", 1, r"\{0\} is not a parameter"),
        ("a: hi {x.y}", 1, "{x.y} is not a parameter"),
        ("a: hi {x!r:>3}", 1, "{x!r:>3} is not a parameter"),
    ],
)
def test_errors_name_the_file_and_the_line(tmp_path: Path, text: str, line: int, message: str) -> None:
    with pytest.raises(DeclarationError, match=f"(?s)phrases1.yaml:{line}: .*(?:{message})"):
        book(tmp_path, BASE, text)


def test_a_file_with_very_deep_nesting_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DeclarationError, match=r"phrases0.yaml"):
        book(tmp_path, "a: " + "[" * 100_000)


def test_the_error_names_a_missing_file(tmp_path: Path) -> None:
    book(tmp_path, BASE)
    with pytest.raises(PlatformError, match=r"phrases\.yaml' does not exist; did you mean 'phrases0.yaml'\?"):
        PhraseBook.load([tmp_path / "phrases.yaml"])
    with pytest.raises(PlatformError, match="does not exist"):
        PhraseBook.load([tmp_path / "no" / "phrases.yaml"])


def test_the_error_names_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(PlatformError, match=f"{re.escape(repr(str(tmp_path)))} cannot be read: "):
        PhraseBook.load([tmp_path])
    (tmp_path / "latin.yaml").write_bytes(b"a: caf\xe9")
    with pytest.raises(DeclarationError, match=r"latin.yaml: this is not UTF-8 text .*at byte 6"):
        PhraseBook.load([tmp_path / "latin.yaml"])


@pytest.mark.parametrize(
    ("template", "value", "text"),
    [
        ("{it}? Show me!", "rock climbing", "Rock climbing? Show me!"),
        ("{it}? Show me!", "eBay", "eBay? Show me!"),
        ("{it}!", "élan", "Élan!"),
        ("{it}", "", ""),
        ("so {it}", "chess", "so chess"),
    ],
)
def test_a_lower_case_value_at_the_beginning_of_a_phrase_gets_a_capital(template: str, value: str, text: str) -> None:
    book = PhraseBook({"x": {"en": [template]}})
    assert book.choose("x", {"it": value}, random.Random(1)).text == text
