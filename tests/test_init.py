"""The public names of the package and of the built-in modules. Each loads at its first use."""

import pytest

import ravestate as rs
from ravestate import modules


def test_dir_lists_every_public_name() -> None:
    assert set(rs.__all__) <= set(dir(rs))
    assert {"Context", "compile", "__version__"} <= set(dir(rs))  # some load at the first use, some immediately
    for name in rs.__all__:
        assert getattr(rs, name) is not None


def test_dir_lists_every_built_in_module() -> None:
    assert set(modules.BUILT_IN) | {"BUILT_IN"} == set(modules.__all__) <= set(dir(modules))


def test_the_error_about_a_misspelt_name_has_a_hint() -> None:
    with pytest.raises(AttributeError, match="ravestate has no 'Modul'; did you mean 'Module'"):
        _ = rs.Modul  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="no built-in module 'rawoi'; did you mean 'rawio'"):
        _ = modules.rawoi  # type: ignore[attr-defined]
