"""The types of messages: make messages from plain data, and convert messages to and from their wire format."""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import threading
from collections.abc import Mapping
from functools import lru_cache
from typing import Any, Literal, cast

from ravestate.errors import PlatformError, nearest

from .definitions import PARTS, Definitions, full_name, messages, part_names

BASE, NAME, ARRAY, SEQUENCE = 1, 2, 3, 4
"""The numbers that the library `rosbags` gives to the kinds of fields."""

DUMMY = "structure_needs_at_least_one_member"
"""The field that ROS 2 gives to a message without fields."""


class Types:
    """The types of ROS 1 or ROS 2 that an agent uses.

    Args:
        version: The version of ROS: 1 or 2. The wire format of ROS 2 is CDR.
        definitions: The definition files for types that the library `rosbags` lacks.
    """

    def __init__(self, version: Literal[1, 2], definitions: Definitions | None = None) -> None:
        self.version = version
        self.definitions = definitions or Definitions()
        self._store: Any = None
        self._loading = threading.Lock()

    @property
    def store(self) -> Any:
        """The store of types from `rosbags`. The first use loads the library, which takes a while."""
        if self._store is None:
            with self._loading:
                if self._store is None:
                    self._store = _store(self.version)
        return self._store

    @property
    def loaded(self) -> bool:
        """Whether the library is loaded."""
        return self._store is not None

    def require(self, name: str, kind: str = "msg") -> str:
        """Load a type and all types of its fields. Return the type's full name.

        Raises:
            PlatformError: The definition of the type is missing or wrong. The message names the remedy.
        """
        name = full_name(name, kind)
        if name.split("/")[1] == "msg":
            self._learn(name)
        else:
            if any(part not in self.store.fielddefs for part in part_names(name, self.version)):
                self._read(name)
        return name

    def _learn(self, name: str) -> None:
        if name not in self.store.fielddefs:
            self._read(name)

    def _read(self, name: str) -> None:
        text = self.definitions.text(name)
        if text is None:
            package, _, short = name.split("/")
            akin = [
                each for each in self.store.fielddefs if each.startswith(f"{package}/") or each.endswith(f"/{short}")
            ]
            raise PlatformError(
                f"there is no definition of {name}: install its package, or name its file in ros{self.version}.definitions"
                f"{nearest(name, akin)}"
            )
        from rosbags.typesys import get_types_from_msg

        parsed: dict[str, Any] = {}
        for full, part in messages(name, text, self.version):
            package, _, short = full.split("/")
            try:
                for fields in get_types_from_msg(part, f"{package}/msg/{short}").values():
                    parsed[full] = fields
            except Exception as error:  # the library's parser raises many kinds of errors
                raise PlatformError(f"the definition of {full} is wrong: {error}") from error
        if self.version == 2:
            for _, fields in parsed.values():
                if not fields:
                    fields.append((DUMMY, (BASE, ("uint8", 0))))
        for _, fields in parsed.values():
            for _, what in fields:
                while what[0] in (ARRAY, SEQUENCE):
                    what = what[1][0]
                if what[0] == NAME and what[1] not in parsed:
                    self._learn(what[1])
        new = {full: fields for full, fields in parsed.items() if full not in self.store.fielddefs}
        self.store.register(new)

    # ------------------------------------------------------------------------------- wire format

    def encode(self, value: Any, name: str) -> memoryview:
        """Return a message in its wire format.

        Args:
            value: A message; a mapping of fields (missing fields are zero or empty); or, if the type has a single field, the
                value of that field.
            name: The type's full name.

        Raises:
            PlatformError: The value does not fit the type; the error's text names the field.
        """
        message = self.message(value, name)
        try:
            return (self.store.serialize_cdr if self.version == 2 else self.store.serialize_ros1)(message, name)
        except Exception as error:  # the library's generated code raises many kinds of errors for wrong values
            raise PlatformError(
                f"{value!r} does not fit {name}: {error}; its fields are {self.describe(name)}"
            ) from error

    def decode(self, data: memoryview | bytes, name: str) -> Any:
        """Return the message that `data` holds in its wire format. Its arrays of numbers are views of `data`.

        Raises:
            PlatformError: The bytes are not a message of this type.
        """
        try:
            return (self.store.deserialize_cdr if self.version == 2 else self.store.deserialize_ros1)(data, name)
        except Exception as error:  # the library's reader raises many kinds of errors
            raise PlatformError(f"a message is not of the type {name}: {error}") from error

    def message(self, value: Any, name: str) -> Any:
        """Return a value as a message of a type; for the arguments and errors, see `encode`.

        A value that is already a message of this type is returned unchanged.
        """
        return self._build(value, name, name)

    def _build(self, value: Any, name: str, path: str) -> Any:
        fields = self.store.fielddefs[name][1]
        cls = self.store.types[name]
        if getattr(cast("object", type(value)), "__msgtype__", None) == name:
            return value
        if value is None:
            value = {}
        if not isinstance(value, Mapping):
            other = getattr(cast("object", type(value)), "__msgtype__", None)
            if other is not None:
                raise PlatformError(f"{path} takes {name}, not {other}")
            own = [field for field, _ in fields if field != DUMMY]
            if len(own) != 1:
                raise PlatformError(f"{path} takes the fields {self.describe(name)}, not {value!r}")
            value = {own[0]: value}
        given = cast("Mapping[str, Any]", value)
        known = dict(fields)
        if unknown := [str(key) for key in given if key not in known]:
            raise PlatformError(
                f"{path} has no field {unknown[0]!r}{nearest(unknown[0], known)}: its fields are {self.describe(name)}"
            )
        return cls(**{field: self._field(given.get(field), what, f"{path}.{field}") for field, what in fields})

    def _field(self, value: Any, what: Any, path: str) -> Any:
        kind, of = what
        if kind == NAME:
            return self._build(value, of, path)
        if kind == BASE:
            return _checked(value, of[0], path)
        (inner, inside), count = of
        if kind == SEQUENCE:
            count = 0
        items: Any = [] if value is None else value
        if isinstance(items, str) or not hasattr(items, "__len__"):
            raise PlatformError(f"{path} takes a list, not {items!r}")
        if inner == BASE and inside[0] != "string":
            return _array([0] * count if value is None else items, inside[0], count, path)
        if count and value is not None and len(items) != count:
            raise PlatformError(f"{path} takes {count} values, not {len(items)}")
        if value is None:
            items = [None] * count
        return [self._field(item, (inner, inside), f"{path}[{n}]") for n, item in enumerate(items)]

    # ------------------------------------------------------------------------------- descriptions

    def describe(self, name: str) -> str:
        """Return the fields of a type as text, such as ``data: string``."""
        fields = self.store.fielddefs[name][1]
        return ", ".join(f"{field}: {_spelt(what)}" for field, what in fields if field != DUMMY) or "none"

    def fields(self, name: str) -> dict[str, Any]:
        """Return the fields of a type, and of all types in it, as data for JSON. The keys are the types' names."""
        found: dict[str, Any] = {}

        def collect(type_: str) -> None:
            if type_ not in found:
                found[type_] = [(field, what) for field, what in self.store.fielddefs[type_][1]]
                for _, what in found[type_]:
                    while what[0] in (ARRAY, SEQUENCE):
                        what = what[1][0]
                    if what[0] == NAME:
                        collect(what[1])

        collect(name)
        return found

    def ros1_definition(self, name: str) -> tuple[str, str]:
        """Return the definition's text (empty for a service) and the MD5 sum. ROS 1 identifies a type by these two."""
        if name.split("/")[1] == "msg":
            return self.store.generate_msgdef(name, ros_version=1)
        text = "".join(self._hashed(f"{name}_{title}") for title in PARTS["srv"])
        return "", hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()

    def _hashed(self, name: str) -> str:
        """Return the text whose MD5 sum identifies a type: its constants, then its fields.

        For a field that holds a message, the MD5 sum of the field's type replaces the name of this type.
        """
        subdefs: dict[str, tuple[str, str]] = {}
        lines = [f"{type_} {field}={value}" for field, type_, value in self.store.fielddefs[name][0]]
        for field, (kind, of) in self.store.fielddefs[name][1]:
            if field == DUMMY:
                continue
            inner, suffix = (kind, of), ""
            if kind in (ARRAY, SEQUENCE):
                inner, suffix = of[0], f"[{of[1] or ''}]"
            if inner[0] == NAME:
                short = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}.get(
                    inner[1]
                )
                lines.append(
                    f"{short}{suffix} {field}" if short else f"{self.store.gendefhash(inner[1], subdefs)[1]} {field}"
                )
            else:
                lines.append(f"{inner[1][0]}{suffix} {field}")
        return "\n".join(lines)


def plain(message: Any) -> Any:
    """Return a message as plain data: mappings, lists, numbers and text."""
    if hasattr(cast("object", type(message)), "__msgtype__"):
        fields = cast("dict[str, Any]", vars(message))
        return {key: plain(value) for key, value in fields.items() if key not in (DUMMY, "__msgtype__")}
    if hasattr(message, "tolist"):
        return message.tolist()
    return [plain(item) for item in message] if isinstance(message, list) else message  # pyright: ignore[reportUnknownVariableType]


def _array(items: Any, base: str, count: int, path: str) -> Any:
    """Return numbers as a flat array.

    An array with several dimensions, such as a picture, is flattened row by row.
    """
    import numpy

    try:
        given = numpy.ravel(memoryview(items) if isinstance(items, bytes) else items)
        with numpy.errstate(invalid="ignore"):  # for infinite numbers and NaN, which the check below refuses
            array = given.astype({"byte": "uint8", "octet": "uint8", "char": "uint8"}.get(base, base), copy=False)
    except (ValueError, TypeError, OverflowError) as error:
        raise PlatformError(f"{path} takes numbers ({base}): {error}") from error
    if count and len(array) != count:
        raise PlatformError(f"{path} takes {count} values, not {len(array)}")
    # numpy cuts off a fraction, and wraps a number that is too large.
    if given.dtype != array.dtype and not base.startswith("float") and (wrong := given[given != array]).size:
        raise PlatformError(f"{path} takes {base}, not {wrong[0]!s}")
    return array


def _checked(value: Any, base: str, path: str) -> Any:
    wanted: Any = str if base == "string" else bool if base == "bool" else float if base.startswith("float") else int
    if value is None:
        return wanted()
    if hasattr(value, "item") and getattr(value, "ndim", 1) == 0:
        value = value.item()
    if wanted is float and isinstance(value, int) and not isinstance(value, bool):
        with contextlib.suppress(OverflowError):  # the number is too large; it is refused below
            value = float(value)
    if not isinstance(value, wanted) or (wanted is not bool and isinstance(value, bool)):
        raise PlatformError(f"{path} takes {base}, not {value!r}")
    return value


def _spelt(what: Any) -> str:
    kind, of = what
    if kind == BASE:
        return of[0]
    if kind == NAME:
        return of.replace("/msg/", "/")
    return f"{_spelt(of[0])}[{of[1] or ''}]"


@lru_cache(2)
def _base_store(version: int) -> Any:
    try:
        typesys = importlib.import_module("rosbags.typesys")
        importlib.import_module("numpy")  # else the first message would wait for this import
    except ImportError as error:
        raise PlatformError(f"ros{version} needs {error.name}: pip install 'ravestate[ros]'") from error
    return typesys.get_typestore(typesys.Stores.ROS1_NOETIC if version == 1 else typesys.Stores.ROS2_KILTED)


def _store(version: int) -> Any:
    """Return a new store of types with the common types in it."""
    base = _base_store(version)
    store = type(base)()
    store.fielddefs.update(base.fielddefs)
    store.types.update(base.types)
    return store
