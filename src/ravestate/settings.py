"""Typed settings of modules, as pydantic models. A declaration may refer to a model's fields.

This file is not in ``declare``, because it needs pydantic, and ``declare`` uses no third-party code. It loads when
``rs.Settings`` or ``rs.Context`` is first used.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from pathlib import PurePath
from typing import Annotated, Any, cast, get_args, get_origin

import pydantic
from pydantic.fields import FieldInfo

from ravestate.declare.module import Module
from ravestate.declare.settings import SettingRef
from ravestate.declare.wording import short
from ravestate.errors import DeclarationError, DeclarationErrors, nearest

TEXT = (str, pydantic.SecretStr)

VALIDATORS: dict[str, Callable[[Any], Any]] = {
    "before": pydantic.BeforeValidator,
    "after": pydantic.AfterValidator,
    "plain": pydantic.PlainValidator,
    "wrap": pydantic.WrapValidator,
}
"""Mode of a ``pydantic.field_validator`` → the annotation with the same effect."""

NameOrPath = Annotated[str, PurePath]
"""The type of a setting that takes a name or a path, such as a microphone's name or a sound file."""


class _SettingsMeta(type(pydantic.BaseModel)):
    """A metaclass that makes ``MySettings.field`` a reference to the setting, for ages and weights in rules."""

    def __getattr__(cls, item: str) -> Any:
        # Before the class is complete, pydantic itself reads its attributes, and must not get references.
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
    - the environment: ``RAVESTATE_<MODULE>_<FIELD>``, as plain text or as JSON (see `value_of`)
    - the agent file
    - the defaults

    In an agent file, a relative path in a field for paths is relative to the folder of the file. In all other sources,
    it is relative to the working folder.

    Example:
        >>> import ravestate as rs
        >>> class Patience(rs.Settings):
        ...     bored_after: float = 5.0
        >>> Patience.bored_after
        Patience.bored_after
        >>> Patience().bored_after
        5.0
    """

    # Files, variables and messages use the names of fields; a field's alias is a second name for it.
    model_config = pydantic.ConfigDict(
        extra="forbid", frozen=True, validate_default=True, populate_by_name=True, loc_by_alias=False
    )


def load_settings(
    modules: Iterable[Module],
    given: Mapping[str, Mapping[str, Any] | pydantic.BaseModel] | None = None,
    environment: Mapping[str, str] | None = None,
) -> dict[str, Any]:
    """Return the settings of each module that has settings, by the module's name.

    Values in `given` override values in the environment, and these override the defaults. For each module, `given` has
    values of fields, or an instance of the module's settings class. `environment` has environment variables; by
    default, those of the process.

    Raises:
        DeclarationErrors: Modules or fields are unknown, or values are missing or invalid. The group has one error for
            each mistake.
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
        }  # YAML reads some names, such as `on`, as values that are not texts
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

    A text field gets the text itself. Any other field gets the result of `parse`, except in three cases, in which the
    field gets the text:

    - `parse` raises a ValueError.
    - The field takes the text, but not the result. So ``12`` is a text for ``str | None`` and for a path, but a number
      for ``str | int``.
    - The field takes the text, the result is a text as well, and `text` does not begin with a quotation mark. Such a
      result may lack a part of `text`: YAML removes ``#5`` from ``Room #5``.
    """
    if cast("Any", model.model_fields[field].annotation) in TEXT:
        return text
    try:
        value = parse(text)
    except ValueError:
        return text
    is_part = isinstance(value, str) and not text.startswith(('"', "'"))
    return text if (is_part or not _takes(model, field, value)) and _takes(model, field, text) else value


def field_of(model: type[pydantic.BaseModel], key: str) -> str:
    """Return the name of the field that has the name or the alias `key`; if there is none, return `key` itself."""
    fields = model.model_fields.items()
    return next((name for name, field in fields if key == name or key in _aliases(field)), key)


def _aliases(field: FieldInfo) -> Collection[Any]:
    alias = field.validation_alias
    return (field.alias, *(alias.choices if isinstance(alias, pydantic.AliasChoices) else (alias,)))


def from_folder(value: Any, model: type[pydantic.BaseModel], field: str, folder: PurePath) -> Any:
    """Return a field's value from a file in `folder`, with the folder in front of each relative path.

    A `NameOrPath` is a path if it begins with ``./`` or ``../``, or names a file in the folder. An empty text stays
    empty.
    """
    info = model.model_fields.get(field)
    return (
        value
        if info is None or folder == PurePath()
        else _located(value, [*_kinds(info.annotation), *info.metadata], folder)
    )


def _located(value: Any, kinds: Collection[Any], folder: PurePath) -> Any:
    classes = [kind for kind in kinds if isinstance(kind, type)]
    if isinstance(value, list):
        return [_located(item, kinds, folder) for item in cast("list[Any]", value)]
    if isinstance(value, dict):
        items = cast("dict[Any, Any]", value).items()
        for model in classes:
            if issubclass(model, pydantic.BaseModel):
                return {key: from_folder(item, model, key, folder) for key, item in items}
        return {key: _located(item, kinds, folder) for key, item in items}
    if not isinstance(value, str) or not value or not any(issubclass(kind, PurePath) for kind in classes):
        return value
    path = os.path.join(folder, os.path.expanduser(value))
    is_name = str in kinds and not value.startswith(("./", "../")) and not os.path.isfile(path)
    return value if is_name else path


def _kinds(annotation: Any) -> Iterator[Any]:
    """Yield the types in an annotation. Leave out the type of a mapping's keys."""
    arguments, origin = get_args(annotation), get_origin(annotation)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        arguments = arguments[1:]
    for argument in arguments:
        yield from _kinds(argument)
    if not arguments:
        yield annotation


def _takes(model: type[pydantic.BaseModel], field: str, value: Any) -> bool:
    """Return whether the field takes the value.

    Validators of the whole model do not run, because the values of other fields may be missing.

    If a validator of the field fails with an exception that is no validation error, the type alone decides.
    """
    validators: list[Any] = [
        VALIDATORS[validator.info.mode](validator.func)
        for validator in model.__pydantic_decorators__.field_validators.values()
        if not {field, "*"}.isdisjoint(validator.info.fields)
    ]
    create: Any = pydantic.create_model
    config = {**model.model_config, "alias_generator": None}
    for used in (validators, []) if validators else ([],):
        kind: Any = model.model_fields[field].rebuild_annotation()
        for validator in used:
            kind = Annotated[kind, validator]
        try:
            create(model.__name__, __config__=config, **{field: (kind, ...)}).model_validate({field: value})
        except pydantic.ValidationError:
            return False
        except Exception:  # such as a KeyError, because the validator reads another field
            continue
        return True
    return True


def _faults(name: str, model: type[pydantic.BaseModel], error: pydantic.ValidationError) -> Iterable[DeclarationError]:
    for detail in error.errors():
        field = ".".join(str(part) for part in detail["loc"])
        top = str(detail["loc"][0]) if detail["loc"] else ""
        where = f"setting {name}.{field}" if field else f"settings of {name}"
        if detail["type"] == "extra_forbidden" and field in model.model_fields:
            yield DeclarationError(f"{where} is given twice, by its name and by its alias: write it once")
        elif detail["type"] == "extra_forbidden":
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
