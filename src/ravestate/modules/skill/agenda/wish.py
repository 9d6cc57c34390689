"""A goal that an agent file declares in its settings, without code."""

from __future__ import annotations

import re
from typing import Annotated

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field

Text = Annotated[str, Field(min_length=1)]


def whole_words(pattern: str) -> re.Pattern[str]:
    """Compile an expression that matches whole words, in upper or lower case.

    Raises:
        re.error: The pattern is not a regular expression.
    """
    re.compile(pattern)  # alone: with the brackets of the next line, "yes)|(no" would be valid
    return re.compile(rf"(?<!\w)(?:{pattern})(?!\w)", re.IGNORECASE)


def _expression(pattern: str) -> str:
    try:
        whole_words(pattern)
    except re.error as error:
        raise ValueError(f"{pattern!r} is not a regular expression: {error}") from None
    return pattern


def _no_truth(value: object) -> object:
    if isinstance(value, bool):
        raise ValueError(f'YAML reads yes and no without quotes as {value}: write "{"yes" if value else "no"}"')
    return value


Expression = Annotated[str, Field(min_length=1), AfterValidator(_expression), BeforeValidator(_no_truth)]


class Wish(BaseModel):
    """A goal in the settings. Its fields are arguments of `agenda.goal`.

    Example:
        >>> Wish(name="ice_cream", say="Do you know my ice cream?", done="yes|ice cream").tries
        2
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    name: Annotated[str, Field(pattern=r"^[A-Za-z_][A-Za-z0-9_-]*$")]
    """The goal's name; its rule is ``agenda:<name>``."""
    say: Text | Annotated[tuple[Text, ...], Field(min_length=1)]
    """The agent's words: a text, or several texts, one for each try in turn. The last text is repeated."""
    priority: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 1.0
    """Goals of higher priority come first."""
    cooldown: Annotated[float, Field(gt=0, allow_inf_nan=False)] = 60.0
    """Seconds from one try to the next."""
    tries: Annotated[int, Field(ge=1)] = 2
    """The maximum number of tries."""
    done: Expression | None = None
    """A regular expression for the user's words that mean success. If it is None, the first try is a success."""
    refused: Expression | None = None
    """A regular expression for the user's words that mean a refusal."""


def _no_twins(wishes: tuple[Wish, ...]) -> tuple[Wish, ...]:
    names = [wish.name for wish in wishes]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"two goals are named {name!r}: rename one")
    return wishes


without_twins = AfterValidator(_no_twins)
"""A check that refuses two goals with the same name."""
