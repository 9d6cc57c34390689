"""The types: each method refuses names that no type or relation has."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from ravestate.errors import RuleError
from ravestate.modules.meta.ontology.types import Relating, Type, Types

TYPES = Types(
    {"Agent": Type("Agent"), "City": Type("City")}, {"lives_in": Relating("lives_in", frozenset({("Agent", "City")}))}
)


@pytest.mark.parametrize(
    "call",
    [
        lambda: TYPES.pairs("lives_inn"),
        lambda: TYPES.relating("lives_inn"),
        lambda: TYPES.check_relation("Agent", "lives_inn", "City"),
        lambda: TYPES.check_end("Agent", "lives_inn"),
    ],
    ids=["pairs", "relating", "check_relation", "check_end"],
)
def test_a_method_that_gets_the_name_of_no_relation_suggests_a_name(call: Callable[[], object]) -> None:
    with pytest.raises(RuleError, match="there is no relation 'lives_inn'; did you mean 'lives_in'"):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda: TYPES.properties("Citty"),
        lambda: TYPES.subtypes("Citty"),
        lambda: TYPES.is_a("Citty", "City"),
        lambda: TYPES.is_a("City", "Citty"),
        lambda: TYPES.stored("Citty", {}),
        lambda: TYPES.loaded("Citty", {}),
        lambda: TYPES.check_relation("Agent", "lives_in", "Citty"),
        lambda: TYPES.check_end("Citty", "lives_in"),
    ],
    ids=["properties", "subtypes", "is_a", "is_a other", "stored", "loaded", "check_relation", "check_end"],
)
def test_a_method_that_gets_the_name_of_no_type_suggests_a_name(call: Callable[[], object]) -> None:
    with pytest.raises(RuleError, match="there is no type 'Citty'; did you mean 'City'"):
        call()
