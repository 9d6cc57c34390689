"""Functions that read YAML as nodes, with line numbers for messages. They build no objects, so no code can run."""

from __future__ import annotations

from importlib.resources.abc import Traversable
from pathlib import Path
from typing import TYPE_CHECKING

from ravestate.errors import DeclarationError, PlatformError, nearest
from ravestate.yaml_text import compose_yaml

if TYPE_CHECKING:
    import yaml


def read_nodes(file: Path | Traversable, what: str) -> yaml.Node | None:
    """Return the root node of a YAML file; None if the file is empty.

    For the arguments and errors, see `read_text`. A text that is not valid YAML raises a `DeclarationError`, too.
    """
    return compose_yaml(read_text(file, what), str(file))


def read_text(file: Path | Traversable, what: str) -> str:
    """Return the text of a file.

    Args:
        file: A path, or a file in a package.
        what: The name of the file in messages, for example ``file of types``.

    Raises:
        DeclarationError: The file is not in UTF-8.
        PlatformError: The file is missing or cannot be read.
    """
    try:
        return file.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        near = ""
        if isinstance(file, Path) and file.parent.is_dir():
            near = nearest(file.name, [other.name for other in file.parent.iterdir()])
        raise PlatformError(f"the {what} {str(file)!r} does not exist{near}") from error
    except OSError as error:
        raise PlatformError(f"the {what} {str(file)!r} cannot be read: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise DeclarationError(f"{file}: this is not UTF-8 text ({error.reason} at byte {error.start})") from None


def kind_of(node: yaml.Node) -> str:
    """Return the kind of a node: ``mapping``, ``sequence`` or ``scalar``."""
    return str(getattr(node, "id", ""))


def line_of(file: str, node: yaml.Node) -> str:
    """Return the place of a node as ``file:line``."""
    return f"{file}:{node.start_mark.line + 1}"


def fault(file: str, node: yaml.Node, problem: str) -> DeclarationError:
    """Return the error that reports a problem at the place of a node."""
    return DeclarationError(f"{line_of(file, node)}: {problem}")
