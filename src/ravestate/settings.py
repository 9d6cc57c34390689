"""Typed settings of modules, as pydantic models. A declaration may refer to a model's fields.

This file is not in ``declare``, because it needs pydantic, and ``declare`` uses no third-party code. It loads when
``rs.Settings`` is first used.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, cast, get_args

import pydantic

from ravestate.declare.module import Module
from ravestate.declare.settings import SettingRef
from ravestate.declare.wording import short
from ravestate.errors import DeclarationError, DeclarationErrors, nearest

TEXT = (str, pydantic.SecretStr)


class _SettingsMeta(type(pydantic.BaseModel)):
    """A metaclass that makes ``MySettings.field`` a reference to the setting, for ages and weights in rules."""

    def __getattr__(cls, item: str) -> Any:
        # Pydantic itself reads attributes of the class before the class is complete.
        if cls.__dict__.get("__pydantic_complete__") and item in cls.__pydantic_fields__:  # type: ignore[attr-defined]  # pydantic's own
            return SettingRef(item, cls)
        try:
            return super().__getattr__(item)  # type: ignore[misc]  # hidden from type checkers by pydantic
        except AttributeError:
            if item.startswith("_"):
                raise
            fields: Iterable[str] = cls.__dict__.get("__pydantic_fields__", ())
            raise AttributeError(f"{cls.__name__} has no setting {item!r}{nearest(item, fields)}", name=item) from None


class Settings(pydantic.BaseModel, metaclass=_SettingsMeta):
    """The base of a module's settings: a pydantic model that refuses unknown names.

    Values come from four sources, the strongest first:

    - code: ``rs.Context(settings={...})`` and ``--set``
    - the environment: ``RAVESTATE_<MODULE>_<FIELD>``, as JSON unless the field is a text
    - the agent file
    - the defaults

    Example:
        >>> import ravestate as rs
        >>> class Patience(rs.Settings):
        ...     bored_after: float = 5.0
        >>> Patience.bored_after
        Patience.bored_after
        >>> Patience().bored_after
        5.0
    """

    model_config = pydantic.ConfigDict(extra="forbid", frozen=True, validate_default=True)


def load_settings(
    modules: Iterable[Module],
    given: Mapping[str, Mapping[str, Any] | pydantic.BaseModel] | None = None,
    environment: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Return the settings of each module, by the module's name.

    Values in `given` override values in the environment, and these override the defaults. For each module, `given` has
    values of fields, or an instance of the module's settings class. Without `environment`, the variables of the
    process count.

    Raises:
        DeclarationErrors: Modules or fields are unknown, or values have wrong types. The group has one error for each
            mistake.
    """
    given = given or {}
    variables = os.environ if environment is None else environment
    faults: list[DeclarationError] = []
    known = {module.name: module.settings for module in modules if module.settings is not None}
    names = {module.name for module in modules}
    for name in given:
        if name not in known:
            why = "has no settings"
            if name not in names:
                why = f"is not part of this agent{nearest(name, names)}"
            faults.append(DeclarationError(f"settings for {name!r}: module {name!r} {why}"))
    found: dict[str, Any] = {}
    for name, model in known.items():
        values = given.get(name, {})
        if isinstance(values, pydantic.BaseModel):
            found[name] = values
            if not isinstance(values, model):
                faults.append(
                    DeclarationError(
                        f"settings for {name!r} must be an instance of {model.__name__}, not of {type(values).__name__}"
                    )
                )
            continue
        if not isinstance(values, Mapping):  # pyright: ignore[reportUnnecessaryIsInstance]  # it may come from a file
            faults.append(
                DeclarationError(f"settings for {name!r} must be a mapping of fields to values, not {short(values)}")
            )
            continue
        named = {
            str(key): value for key, value in values.items()
        }  # YAML reads some names, such as `on`, as other values
        try:
            found[name] = model(**{**_from_environment(name, model, variables), **named})
        except pydantic.ValidationError as error:
            faults.extend(_faults(name, model, error))
    if faults:
        raise DeclarationErrors(faults)
    return found


def variable_of(module: str, field: str) -> str:
    """Return the name of the environment variable of a setting: ``RAVESTATE_<MODULE>_<FIELD>``."""
    return f"RAVESTATE_{module}_{field}".upper().replace("-", "_")


def _from_environment(name: str, model: type[pydantic.BaseModel], variables: Mapping[str, str]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for field in model.model_fields:
        text = variables.get(variable_of(name, field))
        if text is not None:
            found[field] = value_of(text, model, field, json.loads)
    return found


def value_of(text: str, model: type[pydantic.BaseModel], field: str, parse: Callable[[str], Any]) -> Any:
    """Convert a text from the environment or from ``--set`` to a value for `field`.

    A text field gets the text itself, and any other field gets the result of `parse`. If `parse` raises a ValueError,
    the field gets the text.
    """
    annotation = cast("Any", model.model_fields[field].annotation)
    kinds = {annotation, *get_args(annotation)}
    if annotation in TEXT:
        return text
    try:
        value = parse(text)
    except ValueError:
        return text
    # `12` is text for `str | None`, and a number for `str | int`
    is_word = isinstance(value, (bool, int, float)) and not kinds & {bool, int, float}
    return text if is_word and not kinds.isdisjoint(TEXT) else value


def _faults(name: str, model: type[pydantic.BaseModel], error: pydantic.ValidationError) -> Iterable[DeclarationError]:
    for detail in error.errors():
        field = ".".join(str(part) for part in detail["loc"])
        top = str(detail["loc"][0]) if detail["loc"] else ""
        where = f"setting {name}.{field}" if field else f"settings of {name}"
        if detail["type"] == "extra_forbidden":
            yield DeclarationError(f"{where}: module {name!r} has no such setting{nearest(field, model.model_fields)}")
        elif detail["type"] == "missing":
            yield DeclarationError(
                f"{where} is missing: write --set {name}.{field}=... or settings={{{name!r}: {{{field!r}: ...}}}}, or set "
                f"the variable {variable_of(name, top)}"
            )
        else:
            # A message never shows a secret.
            secret = top not in model.model_fields or "Secret" in str(model.model_fields[top].annotation)
            value = "" if secret else f" = {short(detail['input'])}"
            yield DeclarationError(f"{where}{value}: {detail['msg']}")
