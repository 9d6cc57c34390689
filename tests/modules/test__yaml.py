"""YAML nodes know their kind and line, so that errors can name the file and the line."""

from pathlib import Path

import pytest

from ravestate.errors import DeclarationError, PlatformError
from ravestate.modules._yaml import fault, kind_of, read_nodes


def test_a_node_has_its_kind_and_its_line(tmp_path: Path) -> None:
    file = tmp_path / "a.yaml"
    file.write_text("a: 1\nb: [2]")
    root = read_nodes(file, "file of tests")
    assert root is not None and kind_of(root) == "mapping"
    (_, (_, items)) = root.value
    assert kind_of(items) == "sequence" and str(fault("a.yaml", items, "wrong")) == "a.yaml:2: wrong"


def test_an_empty_file_has_no_node(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").write_text("# nothing")
    assert read_nodes(tmp_path / "a.yaml", "file of tests") is None


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"a: b: c", r"a\.yaml:1: not valid YAML .*[Pp]ut quotes"),
        (b"a: 1\nb: \x07", r"a\.yaml:2: not valid YAML \(a control character\)"),
        (b"a: \xff", r"a\.yaml: this is not UTF-8 text .* at byte 3"),
        (b"[" * 5000, r"a\.yaml:1: nested more than 50 levels deep"),
    ],
)
def test_a_file_that_is_not_yaml_is_refused_with_the_line(tmp_path: Path, content: bytes, message: str) -> None:
    (tmp_path / "a.yaml").write_bytes(content)
    with pytest.raises(DeclarationError, match=message):
        read_nodes(tmp_path / "a.yaml", "file of tests")


def test_the_error_names_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "a.yaml").touch()
    with pytest.raises(PlatformError, match=r"the file of tests .*/b\.yaml' does not exist; did you mean 'a\.yaml'"):
        read_nodes(tmp_path / "b.yaml", "file of tests")
    with pytest.raises(PlatformError, match="cannot be read"):
        read_nodes(tmp_path, "file of tests")
