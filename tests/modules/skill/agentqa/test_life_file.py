"""A life file: its format, its changes to the built-in life, and the errors about its mistakes."""

from __future__ import annotations

from datetime import date
from pathlib import Path

import pytest

import ravestate as rs
from ravestate.errors import DeclarationError, DeclarationErrors, PlatformError
from ravestate.modules import agentqa
from ravestate.modules.skill.agentqa import Life, read_life
from ravestate.testing import simulate

TOPICS = [
    "identity",
    "gender",
    "inside",
    "laughing",
    "health",
    "name",
    "age",
    "hobbies",
    "likes",
    "origin",
    "home",
    "father",
    "mother",
    "siblings",
    "friends",
    "ambition",
    "membership",
    "abilities",
    "learned",
    "how_are_you",
    "body",
    "senses",
    "hunger",
    "sleeping",
    "slept_well",
    "dreaming",
    "tiredness",
    "boredom",
    "loneliness",
    "romance",
    "liking_me",
    "travelling",
    "would_go",
    "team",
    "exercise",
    "working_hours",
    "pay",
    "voice",
    "accent",
    "flaws",
    "mistakes",
    "cleverness",
    "patience",
    "rudeness",
    "feelings",
    "fears",
    "wishes",
    "star_sign",
    "birthday_party",
    "dying",
    "switched_off",
    "nights",
    "company",
    "listening",
    "thinking",
    "why_asking",
    "remembering",
    "recorded",
    "relatives",
    "other_robots",
    "takeover",
    "languages_spoken",
    "clothes",
    "handwriting",
    "games",
    "cooks",
    "driving",
    "schooling",
    "childhood",
    "religion",
    "politics",
    "hugging",
    "joking",
    "flattery",
    "pets_own",
    "kids_own",
    "hating",
    "purpose",
    "music_making",
    "watching_reading",
    "weather_own",
    "time",
    "date",
    "privacy",
    "distress",
    "insult",
]


def life_of(text: str, tmp_path: Path) -> Life:
    file = tmp_path / "mine.yaml"
    file.write_text(text, encoding="utf-8")
    return read_life(file)


def test_the_built_in_life_is_complete_and_repeats_no_question() -> None:
    life = read_life()
    assert list(life.topics) == TOPICS
    assert life.born is not None and life.name == "Ravestate"
    questions = [q for topic in life.topics.values() for q in topic.questions] + list(life.others)
    assert len(questions) == len(set(questions))


def test_a_life_file_can_add_remarks_to_a_known_topic_or_in_a_new_topic(tmp_path: Path) -> None:
    life = life_of(
        "topics: {distress: {remarks: rain again}, praise: {remarks: [well done], phrases: Thanks.}}", tmp_path
    )
    assert life.topics["distress"].remarks == (*read_life().topics["distress"].remarks, "rain again")
    assert life.topics["praise"].remarks == ("well done",)


def test_a_life_file_can_add_dialogue_acts_that_nlp_knows(tmp_path: Path) -> None:
    life = life_of("topics: {thanks: {acts: [thanks, praise], phrases: Any time.}, insult: {acts: anger}}", tmp_path)
    assert life.topics["thanks"].acts == ("thanks", "praise")
    assert life.topics["insult"].acts == ("insult", "anger")
    with pytest.raises(rs.DeclarationError, match="'thank' is not an act or a feeling; did you mean 'thanks'"):
        life_of("topics: {thanks: {acts: thank, phrases: Any time.}}", tmp_path)


def test_a_life_file_can_replace_add_or_remove_a_fact_and_the_others_stay(tmp_path: Path) -> None:
    life = life_of(
        "facts: {name: Robin, born: 2020-02-29, hobbies: [chess], home: ~, wheels: 3, siblings: []}", tmp_path
    )
    assert life.name == "Robin" and life.born == date(2020, 2, 29)
    assert life.facts["hobbies"] == ("chess",) and life.facts["wheels"] == "3" and life.facts["siblings"] == ()
    assert "home" not in life.facts
    assert life.facts["friends"] == read_life().facts["friends"]
    assert life.topics == read_life().topics


def test_a_topic_in_a_life_file_adds_its_questions_and_replaces_its_phrases(tmp_path: Path) -> None:
    life = life_of(
        """
        topics:
          home: {questions: [which pond do you swim in], phrases: I live in a pond.}
          age: {phrases: ["{age}!"]}
          membership: ~
          wheels: {questions: do you have wheels, phrases: ["No, {name} walks."]}
        others: [do you have a wheelchair]
        """,
        tmp_path,
    )
    before = read_life()
    assert life.topics["home"].questions == (*before.topics["home"].questions, "which pond do you swim in")
    assert life.topics["home"].phrases == ("I live in a pond.",) and life.topics["home"].otherwise == ()
    assert life.topics["age"].questions == before.topics["age"].questions
    assert "membership" not in life.topics
    assert life.topics["wheels"].phrases == ("No, {name} walks.",)
    assert life.others[-1] == "do you have a wheelchair"


@pytest.mark.parametrize("text", ["", "# nothing\n", "facts: {}"])
def test_an_empty_file_changes_nothing(text: str, tmp_path: Path) -> None:
    assert life_of(text, tmp_path) == read_life()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("- a list", "mine.yaml:1: the file has facts, topics and others"),
        ("fcts: {}", "mine.yaml:1: 'fcts' means nothing here; did you mean 'facts'"),
        ("facts: [a]", "mine.yaml:1: facts have names"),
        (
            "facts:\n  born: yesterday",
            "mine.yaml:2: born: 'yesterday' is not a date: write for example 2024-03-01",
        ),
        ("facts:\n  name: ~", "the agent needs a name"),
        ("facts:\n  age: 3", "mine.yaml:2: age is computed, and cannot be written here: write born:"),
        ("facts:\n  name: [a, b]", "name is one text"),
        ("facts:\n  a: 1\n  a: 2", "mine.yaml:3: 'a' is here twice (first in line 2)"),
        ("facts:\n  my thing!: 1", "is not a name"),
        ("facts:\n  likes: [[a]]", "this must be a text, not a sequence"),
        ("facts:\n  likes: [a, ~]", "this must be a text, but it is empty"),
        ("topics:\n  shoes: {phrases: No.}", "mine.yaml:2: the topic shoes has no questions"),
        ("topics:\n  shoes: {questions: do you wear shoes}", "the topic shoes has no phrases"),
        ("topics:\n  shoes: {question: x}", "'question' means nothing here; did you mean 'questions'"),
        (
            "topics:\n  distress: {remarks: [sad, (lonely]}",
            "mine.yaml:2: '(lonely' is not a regular expression (missing )",
        ),
        ("topics:\n  distress: {remarks: [(?i)sad]}", "mine.yaml:2: '(?i)sad' is not a regular expression (global"),
        ("topics:\n  home: {questions: []}", "there are no questions"),
        (
            "topics:\n  home:\n    phrases:\n      - I live.\n      - 'In {hom}.'",
            "mine.yaml:5: {hom} in 'In {hom}.' is not a fact; did you mean 'home'",
        ),
        ("topics:\n  home: {phrases: 'a } b'}", "the braces in 'a } b' name no fact"),
        ("topics:\n  home: {phrases: '{home!r}'}", "is not a fact"),
        ("topics:\n  likes: {named: {shoes: 'Yes, {it}.'}}", "'shoes' means nothing here"),
        ("topics:\n  likes: {named: {likes: 'Yes, {what}.'}}", "{what} in 'Yes, {what}.' is not a fact"),
        ("facts: {a: b", "not valid YAML"),
        ("facts: \x07", "not valid YAML (a control character)"),
        ("[" * 5000, "nested more than 50 levels"),
    ],
)
def test_a_mistake_is_reported_with_its_line(text: str, told: str, tmp_path: Path) -> None:
    with pytest.raises(DeclarationError) as caught:
        life_of(text, tmp_path)
    assert told in str(caught.value)


def test_the_error_says_why_a_life_file_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "robin.yaml").write_bytes(b"facts: {name: \xff}")
    with pytest.raises(DeclarationError, match="not UTF-8 text"):
        read_life(tmp_path / "robin.yaml")
    with pytest.raises(PlatformError, match=r"does not exist; did you mean 'robin\.yaml'"):
        read_life(tmp_path / "robn.yaml")
    with pytest.raises(PlatformError, match="cannot be read"):
        read_life(tmp_path)


def test_a_mistake_in_a_life_file_is_reported_before_anything_runs(tmp_path: Path) -> None:
    file = tmp_path / "robin.yaml"
    file.write_text("facts: {born: soon}")
    with pytest.raises(DeclarationErrors) as caught, simulate(agentqa, settings={"agentqa": {"life": file}}):
        pass
    assert "robin.yaml:1: born: 'soon' is not a date" in str(caught.value.exceptions[0])
    assert isinstance(agentqa.module, rs.Module)
