"""The set for genqa is well-formed, and `measure.py` counts correctly."""

from pathlib import Path

import pytest

from quality import measure, modules
from quality.measure import Fact, Reply


def test_the_set_has_at_least_40_different_questions() -> None:
    sentences = [fact.question.casefold() for fact in measure.facts()]
    assert len(set(sentences)) == len(sentences) >= 40


def test_no_question_about_the_world_is_used_for_the_calibration() -> None:
    calibration = Path(__file__).parents[1] / "modules" / "skill" / "genqa" / "questions.yaml"
    known = set(map(modules.plain, measure.read_yaml(calibration)))
    assert known.isdisjoint(modules.plain(fact.question) for fact in measure.facts())


def test_each_question_has_either_an_answer_or_the_mark_silent() -> None:
    cases = measure.read_yaml(measure.HERE / "genqa.yaml")
    for case in cases:
        assert case.get("silent", False) == (not case.keys() & {"answers", "number"}), case


def test_a_sentence_with_one_triple_too_many_is_not_exact() -> None:
    cases = [("i like tea", frozenset({("i", "like", "tea")}))]
    result = measure.measure_triples(lambda _: [("i", "like", "tea"), ("i", "be", "tea")], cases)
    assert result.shares["exact"] == 0.0
    assert result.shares["F1 of single triples"] == pytest.approx(2 / 3)


def test_a_wrong_label_lowers_precision_and_recall() -> None:
    cases = [("a", "age"), ("b", "name"), ("c", "-"), ("d", "-")]
    seen = {"a": "age", "b": "home", "c": "-", "d": "age"}
    result = measure.measure_labels("agentqa", seen.__getitem__, cases)
    assert result.shares == {"right": 0.5, "F1": pytest.approx(2 * 1 / (3 + 2))}
    assert len(result.misses) == 2


@pytest.mark.parametrize(
    ("fact", "reply", "right"),
    [
        (Fact("", ("eight",), 8), "It has Eight legs.", True),
        (Fact("", ("eight",), 8), "There are 8 of them.", True),
        (Fact("", ("eight",), 8), "It weighs 18 kg, or 8,000 g.", False),
        (Fact("", ("Spain",)), "Spaniards live there.", False),
        (Fact("", ("Buddhis*",)), "Most are buddhists.", True),
        (Fact("", (), 5895, 0.002), "It is 5,895m high.", True),
        (Fact("", (), 244344065, 0.1), "about 236.7 million people", True),
        (Fact("", (), 1957), "on 6 March 1957.", True),
        (Fact("", (), 1957), "in 1958", False),
    ],
)
def test_an_answer_is_recognised_in_a_reply(fact: Fact, reply: str, right: bool) -> None:
    assert fact.answered_by(reply) is right


def test_answers_and_silences_are_counted_separately() -> None:
    cases = [Fact("a", ("x",)), Fact("b", ("x",)), Fact("c", ("x",)), Fact("d"), Fact("e")]
    replies = {"a": Reply("x", True), "b": Reply("y", False), "c": None, "d": None, "e": Reply("x", True)}
    result = measure.measure_facts(replies.__getitem__, cases)
    assert result.shares == {
        "answered right": 0.2,
        "rightly silent": 0.2,
        "wrongly silent": 0.2,
        "wrong, unsure": 0.2,
        "wrong, sure": 0.2,
        "wrong of the sure": 0.5,
    }


def test_the_tool_prints_a_table_of_the_sets_and_a_list_of_the_misses(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    lines = ["from quality.measure import measure_labels", "def results():"]
    lines.append("    return [measure_labels('moods', lambda text: '-', [('hooray', 'happy'), ('well', '-')])]")
    (tmp_path / "nobody.py").write_text("\n".join(lines))
    monkeypatch.syspath_prepend(str(tmp_path))
    assert measure.main(["nobody", "--misses"]) == 0
    printed = capsys.readouterr().out
    assert "moods                2  right                    50.0%" in printed
    assert "moods: 1 wrong\n  'hooray': - instead of happy" in printed
