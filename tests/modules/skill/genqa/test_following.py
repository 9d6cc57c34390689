"""An answer fits the qualifiers of its question, and can compare two things. `tests/quality` has more questions."""

from collections.abc import Iterator

import pytest

from ravestate.modules.skill.genqa import Answer, Answerer, Settings, Turn, following
from ravestate.modules.skill.genqa.comparing import aged
from ravestate.modules.skill.genqa.document import Document
from ravestate.modules.skill.genqa.following import answer_in, other_wording
from ravestate.modules.skill.genqa.index import Index, IndexedFile
from ravestate.modules.skill.genqa.passages import passages_of
from ravestate.modules.skill.genqa.question import parse

TEXTS = {
    "The Halcyon": "The Halcyon is a ship. The Halcyon is 120 metres long. The Halcyon was built in 1902. "
    "The captain of the Halcyon is Olga Brand.",
    "The Petrel": "The Petrel is a boat. The Petrel is 40 feet long. The Petrel was built in 1955.",
    "Lake Orm": "Lake Orm is 80 metres deep. The first woman who swam across Lake Orm was Ida Falk. "
    "Outside Norland, the deepest lake is Lake Sill. Lake Orm is not salty.",
    "Ida Falk": "Ida Falk was born on 3 May 1900. Ida Falk died on 9 June 1985.",
}  # fmt: skip


@pytest.fixture(scope="module")
def answerer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Answerer]:
    path = tmp_path_factory.mktemp("following") / "index.sqlite"
    with Index(path) as index:
        documents = [Document(title, "notes", list(passages_of(text))) for title, text in TEXTS.items()]
        index.put(IndexedFile("/notes.txt", 1, 1, "0"), documents)
    answerer = Answerer(path, collection=False)
    yield answerer
    answerer.close()


def ask(answerer: Answerer, *said: str) -> str:
    """Say these texts, and return the reply to the last one, or an empty text if there is no reply."""
    thread: list[Turn] = []
    text = ""
    for heard in said:
        answer, turn = answer_in(answerer, parse(heard), thread, Settings(), 5.0 * len(thread))
        text = answer.text if turn is not None and answer.confidence >= Settings().unsure else ""
        if text and turn is not None:
            thread.append(turn)
    return text


def test_a_question_is_answered_only_if_a_passage_fits_its_qualifier(answerer: Answerer) -> None:
    assert "Ida Falk" in ask(answerer, "Who was the first woman who swam across Lake Orm?")
    for qualifier in ("second woman", "last woman", "first man"):
        assert ask(answerer, f"Who was the {qualifier} who swam across Lake Orm?") == ""


def test_numbers_with_units_are_compared(answerer: Answerer) -> None:
    """The Halcyon is 120 metres long, and the Petrel 40 feet."""
    assert ask(answerer, "Which is longer, the Halcyon or the Petrel?").startswith("The Halcyon.")
    assert ask(answerer, "Which is shorter, the Halcyon or the Petrel?").startswith("The Petrel.")
    assert ask(answerer, "How long is the Halcyon?", "is it longer than the Petrel?").startswith("Yes.")


def test_a_sum_can_refer_to_earlier_answers(answerer: Answerer) -> None:
    assert "394 feet" in ask(answerer, "How long is the Halcyon?", "how much is that in feet?")
    assert "75" in ask(answerer, "what is 12 times 12", "plus 6", "and half of that")


def test_a_yes_no_question_is_reworded_as_a_question_that_asks_for_the_fact() -> None:
    assert other_wording("is Peru in Africa") == "where is Peru?"
    assert other_wording("Is Paris the capital of Germany?") == "what is the capital of Germany?"
    assert other_wording("who is in Africa") == ""


def test_a_follow_up_with_words_that_no_document_has_is_not_completed(
    answerer: Answerer, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard, thread = parse("and of the zorblax?"), [thread_of(answerer, "Who is the captain of the Halcyon?")]
    completed: list[str] = []
    monkeypatch.setattr(following, "parse", completed.append)
    answer, turn = answer_in(answerer, heard, thread, Settings(), 5.0)
    assert (answer.text, turn, completed) == ("", None, [])
    assert answer.reason


def test_a_question_about_the_agents_age_causes_no_search(answerer: Answerer, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    monkeypatch.setattr(following, "begun", lambda name, _: asked.append(name))
    answer, _ = answer_in(answerer, parse("how old are you?"), [], Settings(), 0.0)
    assert not answer.text
    assert not asked


def test_the_age_of_an_unknown_person_causes_no_search() -> None:
    asked: list[str] = []

    def search(question: str) -> Answer:
        asked.append(question)
        return Answer(question)

    assert aged(parse("how old was she when she died?"), [], search) is None
    assert not asked


def thread_of(answerer: Answerer, question: str) -> Turn:
    """Return the turn (a question and its answer) that a question adds to the thread."""
    _, turn = answer_in(answerer, parse(question), [], Settings(), 0.0)
    assert turn is not None
    return turn


@pytest.mark.parametrize(
    "question",
    ["Which is longer, the Halcyon or the Petrel?", "How old was Ida Falk when she died?", "How deep is Lake Orm?"],
)
def test_an_answer_with_too_little_confidence_makes_no_turn(answerer: Answerer, question: str) -> None:
    answer, turn = answer_in(answerer, parse(question), (), Settings(sure=1.0, unsure=1.0), 0.0)
    assert answer.text
    assert answer.confidence < 1.0
    assert turn is None
