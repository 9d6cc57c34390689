"""The module `verbaliser` says a phrase for each intent."""

from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from ravestate.errors import PlatformError, RuleError
from ravestate.modules import verbaliser
from ravestate.modules.meta.verbaliser.intents import Intent
from ravestate.modules.meta.verbaliser.rules import as_intent, phrase_book
from ravestate.testing import simulate

me = rs.Module("me", requires=(verbaliser,))
nudge = me.signal("nudge", payload=object)


@me.rule(when=nudge, writes=verbaliser.intent)
async def mean(ctx: rs.RuleContext) -> None:
    ctx[verbaliser.intent] = ctx.payload(nudge)


def said(*meant: object, seed: int = 1, **settings: Any) -> list[str]:
    with simulate(me, settings={"verbaliser": settings}, seed=seed) as sim:
        for intent in meant:
            sim.emit(nudge, intent)
        assert not sim.failures, sim.failures
        return sim.said


def failure(meant: object, **settings: Any) -> BaseException:
    with simulate(me, settings={"verbaliser": settings}) as sim:
        sim.emit(nudge, meant)
        [(rule, error)] = sim.failures
        assert rule == "verbaliser:verbalise"
        assert sim.said == []
        return error


def test_the_verbaliser_says_a_phrase_for_an_intent() -> None:
    [farewell] = said("farewell")
    assert farewell in ("Goodbye!", "See you soon!")
    [greeting] = said(Intent("greet", {"name": "Ada"}))
    assert greeting in ("Hello!", "Hi there!", "Hello Ada!", "Hi Ada, good to see you!")


def test_a_relative_path_starts_from_the_working_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("here", "there"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "my.yaml").write_text(f"place: I am {name}.")
        monkeypatch.chdir(tmp_path / name)
        assert said(Intent("place", file=Path("my.yaml"))) == [f"I am {name}."]
        assert said("place", phrases=["my.yaml"]) == [f"I am {name}."]


def test_no_phrase_comes_twice_in_a_row_and_the_seed_fixes_the_order() -> None:
    first = said(*["think"] * 20)
    assert all(one != next_one for one, next_one in pairwise(first))
    assert len(set(first)) == 3
    assert first == said(*["think"] * 20)
    assert any(first != said(*["think"] * 20, seed=seed) for seed in range(2, 6))


@pytest.mark.parametrize("seed", range(10))
def test_no_phrase_comes_twice_in_a_row_even_for_simultaneous_intents(seed: int) -> None:
    with simulate(verbaliser, seed=seed) as sim:
        for _ in range(4):
            sim.context.put(verbaliser.intent, "think")
        sim.settle()
    assert len(sim.said) == 4
    assert all(one != next_one for one, next_one in pairwise(sim.said))


def test_each_context_can_have_another_language() -> None:
    assert said("farewell", language="de-CH")[0] in ("Auf Wiedersehen!", "Bis bald!")
    assert said("farewell", language="fr")[0] in ("Goodbye!", "See you soon!")


def test_phrases_from_the_settings_replace_built_in_phrases(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text("think: Arr…\njoke: Ha!")
    assert said("think", "joke", phrases=(file,)) == ["Arr…", "Ha!"]


def test_an_intent_can_name_a_file_with_its_phrases(tmp_path: Path) -> None:
    file, mine = tmp_path / "phrases.yaml", tmp_path / "mine.yaml"
    file.write_text("joke: Ho!\npun: Oh!")
    mine.write_text("joke: Ha!")
    assert said(Intent("joke", file=file), Intent("pun", file=file)) == ["Ho!", "Oh!"]
    assert said(Intent("joke", file=file), phrases=(mine,)) == ["Ha!"]


def test_an_intent_can_name_a_package_with_its_phrases(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "rav_test_phrases"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "phrases.yaml").write_text("joke: Ho!")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert said(Intent("joke", package="rav_test_phrases")) == ["Ho!"]
    assert phrase_book("rav_test_phrases", (), "en").intents[0] == "greet"


def test_an_impossible_intent_raises_an_error() -> None:
    assert isinstance(failure("gret"), RuleError)
    assert "did you mean 'greet'?" in str(failure("gret"))
    assert "there is no package 'no.where'" in str(failure(Intent("greet", package="no.where")))
    missing = failure("greet", phrases=(Path("nowhere.yaml"),))
    assert isinstance(missing, PlatformError)


@pytest.mark.parametrize("value", [None, "", 3, ["greet"]])
def test_a_value_that_is_not_an_intent_is_refused(value: object) -> None:
    with pytest.raises(RuleError, match=r"verbaliser.Intent\('greet', "):
        as_intent(value)


def test_each_built_in_intent_has_phrases_in_both_languages() -> None:
    book = phrase_book(None, (), "en")
    for intent in book.intents:
        english, german = book.templates(intent, "en"), book.templates(intent, "de")
        assert english is not german
        assert {t.parameters for t in english} == {t.parameters for t in german}
        assert min(len(english), len(german)) > 1


def test_an_intent_can_contain_its_phrases() -> None:
    own = Intent("greet", {"name": "Ada"}, phrases={"en": ["Ahoy {name}!", "Oh, {name}."], "de": ["Moin!"]})
    assert set(said(own, own)) == {"Ahoy Ada!", "Oh, Ada."}  # only its own phrases, and none twice in a row
    assert said(own, language="de-AT") == ["Moin!"]
