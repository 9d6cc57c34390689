"""Questions about facts, which small talk does not answer."""

from __future__ import annotations

from functools import cache
from importlib.resources import files

from ravestate.errors import PlatformError
from ravestate.language import Matcher, read_examples, sentences


@cache
def facts_matcher() -> Matcher:
    """Return the matcher of questions about facts, which all contexts share."""
    examples = read_examples(files(__package__ or "") / "facts.yaml")
    return Matcher(examples.classes, examples.none)


def asks_for_fact(text: str, *, question: bool = True) -> bool:
    """Guess whether `text` asks for a fact, as "Who wrote Hamlet?" does. If the model is missing, return False.

    `question` says whether the parse finds a question in the text. A statement asks for no fact.
    """
    if not (question or text.rstrip().endswith("?")):
        return False
    try:
        facts_matcher().load()
    except PlatformError:
        return False
    return any(facts_matcher().match_all([one for one in sentences(text[:2000]) if len(one.split()) > 1]))
