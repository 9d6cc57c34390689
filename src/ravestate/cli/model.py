"""``ravestate model``: list, fetch and remove language models for small talk."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from ravestate.errors import PlatformError

if TYPE_CHECKING:
    from ravestate.modules.skill.wildtalk.model_store import CatalogueModel


def add_arguments(parser: argparse.ArgumentParser) -> None:
    actions = parser.add_subparsers(dest="action", metavar="ACTION", required=True)
    actions.add_parser("list", help="list small chat models to fetch, and those that this machine has")
    getting = actions.add_parser(
        "get",
        help="fetch a model, and make it the default",
        description="Fetch a model from the hub of Hugging Face, verify it, and make it the default for small talk. The same "
        "command continues an interrupted download. HF_ENDPOINT sets a mirror of the hub, and HF_TOKEN sets a token.",
    )
    getting.add_argument(
        "name", nargs="?", metavar="NAME", help="a name from the list; by default the recommended model"
    )
    removing = actions.add_parser("remove", help="remove a fetched model")
    removing.add_argument("name", metavar="NAME", help="a name from the list")


def run(options: argparse.Namespace) -> int:
    """Run the command; return 130 if the user interrupts a download, and 1 if the model to remove is not installed."""
    from ravestate.modules.skill.wildtalk import model_store

    if options.action == "list":
        return _list()
    model = model_store.named(options.name or model_store.RECOMMENDED)
    return _get(model) if options.action == "get" else _remove(model)


def _list() -> int:
    import asyncio

    from ravestate.modules._text import printable
    from ravestate.modules.skill.wildtalk import Settings, model_store, module
    from ravestate.modules.skill.wildtalk.choosing import choose
    from ravestate.modules.skill.wildtalk.download import size_of
    from ravestate.modules.skill.wildtalk.found_models import find_models
    from ravestate.modules.skill.wildtalk.local_servers import find_servers
    from ravestate.settings import load_settings

    rows = [("NAME", "PARAMETERS", "SIZE", "LICENCE", "STATUS", "FOR")]
    for model in model_store.catalogue().values():
        size = f"{model.parameters / 1e9:.1f} billion"
        rows.append((model.name, size, size_of(model.size), model.licence, _status(model), model.purpose))
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
    settings: Settings = load_settings([module])[module.name]
    if settings.search:
        own = {model.path for model in model_store.catalogue().values()}
        lines = [
            f"{found.path}  ({found.parameters / 1e9:.1f} billion, {size_of(found.size)})"
            for found in find_models()
            if found.path not in own
        ]
        lines += [
            f"{server.name} at {server.base_url}: {', '.join(server.models)}" for server in asyncio.run(find_servers())
        ]
        if lines:
            print("\nAlso on this machine:", *map(printable, lines), sep="\n  ")
    try:
        print(f"\nNow: {printable(choose(settings).text)}")
    except PlatformError as error:
        print(f"\nNow: {printable(str(error))}")
    return 0


def _status(model: CatalogueModel) -> str:
    from ravestate.modules.skill.wildtalk import model_store

    if model.installed:
        return "default" if model_store.default() == model else "installed"
    return f"{model.part.stat().st_size / model.size:.0%} fetched" if model.part.exists() else ""


def _get(model: CatalogueModel) -> int:
    from ravestate.modules.skill.wildtalk import model_store
    from ravestate.modules.skill.wildtalk.download import download, interrupted, size_of

    if not model.installed:
        print(f"{model.name}: {size_of(model.size)}, {model.licence}, from {model.repository}", file=sys.stderr)
        try:
            download(model)
        except KeyboardInterrupt:
            print(f"ravestate model: {interrupted(model)}", file=sys.stderr)
            return 130
    model_store.set_default(model.name)
    print(f"{model.name} is installed, and is now the default for small talk: {model.path}")
    return 0


def _remove(model: CatalogueModel) -> int:
    from ravestate.modules.skill.wildtalk import model_store
    from ravestate.modules.skill.wildtalk.download import alone

    files = [file for file in (model.path, model.part) if file.exists()]
    if not files:
        print(f"ravestate model: {model.name} is not installed in {model_store.folder()}", file=sys.stderr)
        return 1
    was_default = model_store.default() == model
    try:
        if model.part.exists():
            with alone(model):
                pass  # this fails if another process fetches the model
        for file in files:
            file.unlink(missing_ok=True)
    except OSError as error:
        raise PlatformError(f"{files[0]} cannot be removed: {error.strerror or error}") from error
    print(f"removed {', '.join(map(str, files))}")
    if was_default:
        left = next((other for other in model_store.catalogue().values() if other.installed), None)
        model_store.set_default(left and left.name)
        print(f"the default is {left.name} now" if left else "there is no longer a default model")
    return 0
