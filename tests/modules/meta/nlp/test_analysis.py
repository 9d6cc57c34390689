"""The whole analysis accepts any text, and recognises the agent's name."""

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from quality.measure import labelled
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import Pipeline

said = sorted(
    {word for name in ("triples_rows", "questions_rows") for row in labelled(name) for word in row[0].split()}
)
texts = st.lists(st.sampled_from([*said, "?", ",", ".", "\n"]), max_size=25).map(" ".join) | st.text(max_size=60)


@given(texts)
@settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_words_in_any_order_are_analysed_without_an_error(reader: Pipeline, text: str) -> None:
    seen = analyse(text, reader, ["Ravestate"])
    assert seen.question is None or seen.question.name
    assert all(triple.predicate for triple in seen.triples)
    assert all(seen.tree.text[word.start : word.end] == word.text for word in seen.tree.words)


def test_the_agents_name_counts_only_as_a_whole_word(reader: Pipeline) -> None:
    for text, expected in (
        ("Hi Ravestate!", True),
        ("ravestates are many", False),
        ("I like tea", False),
        ("YOUR hat", True),
    ):
        assert analyse(text, reader, ["Ravestate"]).about_agent is expected, text
