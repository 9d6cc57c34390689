"""The pipeline: its trees, and how it deals with odd texts, threads and missing packages."""

import builtins
import subprocess
import sys
import threading
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, contextmanager
from contextvars import Context
from pathlib import Path
from typing import Any

import pytest
from spacy.language import Language

from ravestate.errors import PlatformError
from ravestate.modules.meta.nlp import pipeline as pipeline_module
from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import LONGEST, Pipeline, pipeline


def test_words_keep_their_spelling_and_position(reader: Pipeline) -> None:
    text = "I’d LIKE  to\tvisit München, wouldn't you?"
    tree, _ = reader.read(text)
    assert all(text[word.start : word.end] == word.text for word in tree.words)
    assert "".join(word.text for word in tree.words) == "".join(text.split())
    assert [word.index for word in tree.words] == list(range(len(tree.words)))


def test_entities_have_the_right_positions_in_the_text(reader: Pipeline) -> None:
    text = "Tom Miller has lived in Berlin since 1999."
    _, entities = reader.read(text)
    assert {(text[e.start : e.end], e.label) for e in entities} >= {("Berlin", "GPE"), ("1999", "DATE")}
    assert all(text[e.start : e.end] == e.text for e in entities)


def test_entities_of_careless_english_have_their_positions_in_the_input(reader: Pipeline) -> None:
    text = "im tom miller n ive lived in berlin since 1999"
    seen = analyse(text, reader)
    assert {(text[e.start : e.end], e.label) for e in seen.entities} >= {("berlin", "GPE"), ("1999", "DATE")}
    assert [word.text for word in seen.tree.words][:3] == ["I", "'m", "tom"]


def test_a_pipeline_of_another_language_reads_the_text_as_typed(tmp_path: Path) -> None:
    import spacy

    spacy.blank("de").to_disk(tmp_path / "blank")
    assert Pipeline(str(tmp_path / "blank")).normalise("im haus").text == "im haus"


def test_the_word_like_is_a_verb_and_keeps_its_lemma(reader: Pipeline) -> None:
    tree, _ = reader.read("Tom and Anna like games.")
    (like,) = [word for word in tree.words if word.text == "like"]
    assert (like.lemma, like.pos) == ("like", "VERB")


@pytest.mark.parametrize(
    "text",
    ["", " ", "\n\n", "\x00\x1b[31mred\x07", "😀👍🏽👨‍👩‍👧", "שלום, מה שלומך?", "مرحبا كيف حالك", "Wo wohnst du denn?", "你好，你叫什么名字？",
     "a\udcffb", "?" * 500, "and " * 500, "((((((((((", "\u202ehello\u202c", "http://example.org/?q=1&r=2", "'s 's 's n't n't", "-" * 3000,
     "who who who is is is", "what", "not not not", "that that that that is is that"],
)  # fmt: skip
def test_any_text_is_analysed_without_an_error(reader: Pipeline, text: str) -> None:
    seen = analyse(text, reader, ["Ravestate", "", "(?"])
    assert [word.text for word in seen.tree.words] == [seen.tree.text[w.start : w.end] for w in seen.tree.words]
    assert seen.normal.original == text[:LONGEST]


def test_the_beginning_of_a_long_text_is_analysed(reader: Pipeline, caplog: pytest.LogCaptureFixture) -> None:
    seen = analyse("where do you live " * 6000, reader)
    assert seen.about_agent and seen.question is not None
    assert len(seen.tree.text) <= LONGEST and seen.normal.original.endswith(("where", "do", "you", "live"))
    assert f"analysed only the first {LONGEST} of 108000 characters" in caplog.text
    assert len(reader.shorten("x" * 100_000)) == LONGEST


def test_the_vocabulary_does_not_grow(reader: Pipeline, monkeypatch: pytest.MonkeyPatch) -> None:
    languages: set[Language] = set()
    parse = Language.__call__

    def note(language: Language, text: Any, **options: Any) -> Any:
        languages.add(language)
        return parse(language, text, **options)

    monkeypatch.setattr(Language, "__call__", note)
    reader.read("warm up")
    [language] = languages
    before = len(language.vocab.strings)
    for number in range(20):
        reader.read(f"unheardof{number} word{number}")
    assert len(language.vocab.strings) == before


def test_many_threads_can_read_at_the_same_time(reader: Pipeline) -> None:
    found: list[list[str]] = []

    def read() -> None:
        for _ in range(5):
            tree, _ = reader.read("Where do you live?")
            found.append([word.text for word in tree.words])

    threads = [threading.Thread(target=read) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [["Where", "do", "you", "live", "?"]] * 20


def test_readers_in_new_contexts_do_not_look_for_a_backend_again(
    reader: Pipeline, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each rule runs in its own `contextvars.Context`, and spaCy would look for its backend in each of them."""
    reader.read("The kettle is on.")
    looked: list[str] = []
    import thinc.backends

    monkeypatch.setattr(thinc.backends, "get_ops", lambda name: looked.append(name))
    tree, _ = Context().run(reader.read, "The kettle is off.")
    assert len(tree.words) == 5
    assert not looked


@pytest.fixture
def busy(monkeypatch: pytest.MonkeyPatch) -> Callable[[Pipeline], AbstractContextManager[None]]:
    """A function that returns a context manager: in its ``with`` block, the given pipeline is parsing a text."""
    parse = Language.__call__

    @contextmanager
    def parsing(reader: Pipeline) -> Generator[None]:
        begun, go_on = threading.Event(), threading.Event()

        def wait(language: Language, text: str, **options: Any) -> Any:
            if text == "Please wait":
                begun.set()
                assert go_on.wait(60)
            return parse(language, text, **options)

        monkeypatch.setattr(Language, "__call__", wait)
        thread = threading.Thread(target=reader.read, args=("please wait",))
        thread.start()
        assert begun.wait(60)
        yield
        go_on.set()
        thread.join(60)

    return parsing


def test_load_does_not_wait_for_readers_of_a_loaded_pipeline(
    new_reader: Callable[[], Pipeline], busy: Callable[[Pipeline], AbstractContextManager[None]]
) -> None:
    reader = new_reader()
    asking = threading.Thread(target=reader.load, daemon=True)
    with busy(reader):
        asking.start()
        asking.join(10)
        assert not asking.is_alive()


SAID = (
    "I like tea",
    "My bicycle has 7 spokes",
    "Who painted the girl with the pearl?",
    "",
    "no",
    "Ada lives in Lima",
)


@pytest.fixture
def new_reader() -> Callable[[], Pipeline]:
    """A function that returns a loaded pipeline, which remembers no text."""

    def make() -> Pipeline:
        made = Pipeline("")
        made.load()
        return made

    return make


@pytest.fixture
def crowd(
    new_reader: Callable[[], Pipeline], busy: Callable[[Pipeline], AbstractContextManager[None]]
) -> Callable[[], list[Any]]:
    """A function that reads each text of `SAID` in a separate thread, and returns their results and errors.

    All threads wait while a new pipeline parses another text.
    """

    def ask() -> list[Any]:
        reader = new_reader()
        found: list[Any] = [None] * len(SAID)
        asking = threading.Semaphore(0)

        def read(number: int) -> None:
            asking.release()
            try:
                found[number] = reader.read(SAID[number])
            except ArithmeticError as error:
                found[number] = error

        threads = [threading.Thread(target=read, args=(number,)) for number in range(len(SAID))]
        with busy(reader):
            for thread in threads:
                thread.start()
            for _ in threads:
                assert asking.acquire(timeout=60)
        for thread in threads:
            thread.join(30)
        return found

    return ask


def test_waiting_texts_are_read_in_one_batch_with_equal_results(
    reader: Pipeline, crowd: Callable[[], list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    alone = [reader.read(text) for text in SAID]
    rounds: list[int] = []
    pipe = Language.pipe

    def note(language: Language, texts: list[str]) -> Any:
        rounds.append(len(texts))
        return pipe(language, texts)

    monkeypatch.setattr(Language, "pipe", note)
    for _ in range(5):  # in a bad moment, a thread may come too late for the batch
        together = crowd()
        if rounds[-1:] == [len(SAID)]:
            break
    assert rounds[-1:] == [len(SAID)]
    for (tree, entities), (other_tree, other_entities) in zip(together, alone, strict=True):
        assert (tree.text, tree.words, entities) == (other_tree.text, other_tree.words, other_entities)


def test_a_text_that_fails_does_not_affect_other_texts_in_its_batch(
    reader: Pipeline, crowd: Callable[[], list[Any]], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stumble(text: str) -> str:
        if text == "No":
            raise ArithmeticError("this text fails")
        return text

    monkeypatch.setattr(pipeline_module, "preprocess", stumble)
    found = crowd()
    assert [isinstance(one, ArithmeticError) for one in found] == [text == "no" for text in SAID]
    assert reader.read("I like tea")[0].text == "I like tea."


def test_contexts_share_a_pipeline() -> None:
    assert pipeline("") is pipeline("")
    assert pipeline("another") is not pipeline("") and not pipeline("another").loaded


def test_the_error_names_an_unknown_pipeline() -> None:
    with pytest.raises(
        PlatformError,
        match=r"no spaCy pipeline 'de_core_nonsense': python -m spacy download de_core_nonsense",
    ):
        Pipeline("de_core_nonsense").read("Hallo")


def test_a_broken_pipeline_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "config.cfg").write_text("nonsense", encoding="utf-8")
    with pytest.raises(PlatformError, match="cannot be loaded"):
        Pipeline(str(tmp_path)).load()


def test_without_spacy_the_error_names_the_extra_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "spacy", raising=False)
    importing = builtins.__import__

    def without_spacy(name: str, *arguments: Any, **named: Any) -> Any:
        if name.partition(".")[0] == "spacy":
            raise ImportError(name)
        return importing(name, *arguments, **named)

    monkeypatch.setattr(builtins, "__import__", without_spacy)
    with pytest.raises(PlatformError, match=r"nlp needs spacy: pip install 'ravestate\[nlp\]'"):
        Pipeline().read("hello")


def test_optional_libraries_are_not_imported() -> None:
    code = (
        "import sys; from ravestate.modules.meta.nlp.pipeline import pipeline; pipeline('').read('hello'); "
        "print({'torch', 'tensorflow', 'mxnet', 'cupy', 'spacy.cli'} & set(sys.modules)); "
        "import spacy.cli; spacy.cli.validate"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "set()\n"


def test_a_pipeline_without_a_parser_reads_the_words(tmp_path: Path) -> None:
    import spacy

    spacy.blank("de").to_disk(tmp_path / "blank")
    seen = analyse("Wo wohnst du? Ja.", Pipeline(str(tmp_path / "blank")))
    assert [word.text for word in seen.tree.words] == ["Wo", "wohnst", "du", "?", "Ja", "."]
    assert seen.triples == ()
