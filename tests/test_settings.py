"""Settings come from code, the environment and defaults. Messages name every fault, and show no secret."""

from pathlib import Path
from typing import Any, Literal

import pydantic
import pytest

import ravestate as rs
from ravestate.declare.settings import SettingRef
from ravestate.settings import field_of, load_settings, value_of, variable_of
from ravestate.yaml_text import load_yaml


class Voice(rs.Settings):
    name: str = "Ada"
    speed: float = 1.0
    words: tuple[str, ...] = ()
    key: pydantic.SecretStr = pydantic.SecretStr("")


class Mixed(rs.Settings):
    maybe: str | None = None
    either: str | int = ""
    count: int = 0


class Texts(rs.Settings):
    needed: int
    maybe: str | None = None
    where: Path = Path()
    mode: Literal["2", "yes"] = "2"
    on: bool | Literal["auto"] = "auto"
    names: tuple[str, ...] = ()


class Server(rs.Settings):
    address: str
    keys: tuple[pydantic.SecretStr, ...] = ()


voice = rs.Module("voice", settings=Voice)
my_server = rs.Module("my-server", settings=Server)
plain = rs.Module("plain")


def faults(modules: list[rs.Module], given: Any, environment: dict[str, str] | None = None) -> list[str]:
    with pytest.raises(rs.DeclarationErrors) as caught:
        load_settings(modules, given, environment or {})
    return [str(fault) for fault in caught.value.exceptions]


# ---------------------------------------------------------------------------------------- the class


def test_a_field_of_a_settings_class_is_a_reference_to_the_setting() -> None:
    assert Voice.speed == SettingRef("speed", Voice)
    assert Voice().speed == 1.0


def test_an_inherited_field_is_also_a_reference_to_the_setting() -> None:
    class Loud(Voice):
        volume: int = 3

    assert Loud.speed == SettingRef("speed", Loud)
    assert Loud.volume == SettingRef("volume", Loud)
    assert Loud().model_dump()["volume"] == 3


def test_the_error_about_a_misspelt_field_has_a_hint() -> None:
    with pytest.raises(AttributeError, match="Voice has no setting 'sped'; did you mean 'speed'"):
        _ = Voice.sped


def test_settings_are_immutable() -> None:
    with pytest.raises(pydantic.ValidationError):
        Voice().name = "Eve"


# ---------------------------------------------------------------------------------------- sources of values


def test_given_values_override_the_environment_which_overrides_defaults() -> None:
    environment = {"RAVESTATE_VOICE_NAME": "Eve", "RAVESTATE_VOICE_SPEED": "2.5"}
    found = load_settings([voice, plain], {"voice": {"name": "Max"}}, environment)
    assert found["voice"] == Voice(name="Max", speed=2.5)
    assert load_settings([voice, plain], None, {}) == {"voice": Voice()}


def test_by_default_values_come_from_the_environment_of_the_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("RAVESTATE_VOICE_NAME", "Eve")
    assert load_settings([voice])["voice"].name == "Eve"


@pytest.mark.parametrize(
    ("field", "text", "value"),
    [
        ("words", '["a", "b"]', ("a", "b")),
        ("name", "12", "12"),  # a text field takes the text as it is
        ("name", '"quoted"', '"quoted"'),
        ("speed", "0.5", 0.5),
    ],
)
def test_environment_variables_are_read_as_json_except_for_text_fields(field: str, text: str, value: object) -> None:
    found = load_settings([voice], None, {variable_of("voice", field): text})
    assert getattr(found["voice"], field) == value


@pytest.mark.parametrize(
    ("model", "field", "text", "value"),
    [
        (Voice, "name", "12", "12"),
        (Voice, "key", "12", "12"),
        (Mixed, "maybe", "12", "12"),
        (Mixed, "maybe", "true", "true"),
        (Mixed, "maybe", "null", None),
        (Mixed, "either", "12", 12),
        (Mixed, "count", "12", 12),
        (Mixed, "count", "twelve", "twelve"),  # `Mixed` later refuses this value
        (Texts, "maybe", "1970-01-01", "1970-01-01"),
        (Texts, "maybe", "[Room] 5", "[Room] 5"),
        (Texts, "maybe", "Room #5", "Room #5"),
        (Texts, "maybe", "'Room' #5", "Room"),
        (Texts, "maybe", "null", None),
        (Texts, "where", "12", "12"),
        (Texts, "where", "2024-01-01", "2024-01-01"),
        (Texts, "mode", "2", "2"),
        (Texts, "mode", "yes", "yes"),
        (Texts, "mode", "3", 3),
        (Texts, "on", "yes", True),
        (Texts, "on", "auto", "auto"),
        (Texts, "on", " auto", "auto"),
        (Texts, "names", "[1]", [1]),
        (Texts, "needed", "-1", -1),
    ],
)
def test_a_text_is_parsed_only_if_its_field_takes_more_than_text(
    model: type[rs.Settings], field: str, text: str, value: object
) -> None:
    assert value_of(text, model, field, lambda text: load_yaml(text, "--set")) == value


class Checked(rs.Settings):
    low: int = 0
    label: str | None = None
    names: tuple[str, ...] = ()
    after: str | None = None

    @pydantic.model_validator(mode="before")
    @classmethod
    def ordered(cls, values: dict[str, Any]) -> dict[str, Any]:
        if values["low"] > 3:
            raise ValueError("low must be at most 3")
        return values

    @pydantic.field_validator("names", mode="before")
    @classmethod
    def split(cls, value: Any) -> Any:
        return tuple(value.split()) if isinstance(value, str) else value

    @pydantic.field_validator("after")
    @classmethod
    def differs(cls, value: str | None, info: pydantic.ValidationInfo) -> str | None:
        return value if value != info.data["label"] else None


@pytest.mark.parametrize(
    ("field", "text", "value"),
    [
        ("label", "12", "12"),
        ("label", "null", None),
        ("low", "12", 12),
        ("names", "12", "12"),  # its validator takes a text
        ("names", "[a]", ["a"]),
        ("after", "12", "12"),  # its validator reads another field
    ],
)
def test_how_a_text_is_parsed_does_not_depend_on_other_fields(field: str, text: str, value: object) -> None:
    assert value_of(text, Checked, field, lambda text: load_yaml(text, "--set")) == value


def test_an_environment_variable_has_the_name_of_its_module_and_field() -> None:
    assert variable_of("my-server", "address") == "RAVESTATE_MY_SERVER_ADDRESS"
    found = load_settings([my_server], None, {"RAVESTATE_MY_SERVER_ADDRESS": "here"})
    assert found["my-server"].address == "here"


def test_an_instance_of_the_settings_class_is_used_as_it_is() -> None:
    value = Voice(name="Max")
    assert load_settings([voice], {"voice": value}, {"RAVESTATE_VOICE_NAME": "Eve"})["voice"] is value


# ---------------------------------------------------------------------------------------- faults


def test_one_error_has_all_faults_of_the_settings() -> None:
    found = faults(
        [voice, plain],
        {"voice": {"speed": "fast", "sped": 2}, "plain": {"x": 1}, "voise": {"speed": 2}},
    )
    assert len(found) == 4
    text = "\n".join(found)
    assert "settings for 'plain': module 'plain' has no settings" in found  # without a hint
    assert "settings for 'voise': module 'voise' is not part of this agent; did you mean 'voice'?" in text
    assert "setting voice.speed = 'fast': Input should be a valid number" in text
    assert "setting voice.sped: module 'voice' has no such setting; did you mean 'speed'?" in text


def test_a_field_with_an_alias_is_set_and_reported_by_its_own_name() -> None:
    class Aliased(rs.Settings):
        alias_: int = pydantic.Field(0, alias="alias")

    module = rs.Module("m", settings=Aliased)
    for values, environment in (({"alias_": 5}, {}), ({"alias": 5}, {}), ({}, {"RAVESTATE_M_ALIAS_": "5"})):
        assert load_settings([module], {"m": values}, environment)["m"].alias_ == 5
    assert value_of("5", Aliased, "alias_", int) == 5
    (fault,) = faults([module], {"m": {"alias": "five"}})
    assert fault.startswith("setting m.alias_ = 'five'")
    (fault,) = faults([module], {"m": {"alias": 5, "alias_": 6}})
    assert fault == "setting m.alias_ is given twice, by its name and by its alias: write it once"


def test_a_field_is_found_by_each_of_its_aliases() -> None:
    class Aliased(rs.Settings):
        one: int = pydantic.Field(0, alias="eins")
        two: int = pydantic.Field(0, validation_alias=pydantic.AliasChoices("zwei", "deux", pydantic.AliasPath("x", 0)))

    found = {key: field_of(Aliased, key) for key in ("one", "eins", "two", "zwei", "deux", "x")}
    assert found == {"one": "one", "eins": "one", "two": "two", "zwei": "two", "deux": "two", "x": "x"}


def test_a_name_that_is_not_a_text_is_an_unknown_setting() -> None:
    values: Any = {True: 1, 5: 1, "speed": "fast"}  # YAML reads the name `on` as True
    found = faults([voice], {"voice": values})
    assert found[1:] == [f"setting voice.{name}: module 'voice' has no such setting" for name in (True, 5)]
    assert found[0].startswith("setting voice.speed = 'fast'")


def test_faults_in_the_environment_are_reported_together() -> None:
    found = faults([voice], {}, {"RAVESTATE_VOICE_WORDS": "a,b", "RAVESTATE_VOICE_SPEED": "fast"})
    assert "setting voice.words = 'a,b': Input should be a valid tuple" in found
    assert len(found) == 2 and found[0].startswith("setting voice.speed = 'fast': Input should be a valid number")


def test_the_error_about_a_missing_setting_says_how_to_give_it() -> None:
    (fault,) = faults([my_server], {"my-server": {"keys": ["s3cret"]}})
    assert fault.startswith("setting my-server.address is missing: write --set my-server.address=...")
    assert "RAVESTATE_MY_SERVER_ADDRESS" in fault
    assert "s3cret" not in fault


def test_an_error_message_shows_no_secret() -> None:
    for module, values in ((voice, {"key": ["s3cret"]}), (my_server, {"address": "", "keys": [["s3cret"]]})):
        (fault,) = faults([module], {module.name: values})
        assert "s3cret" not in fault and "Input should be" in fault


def test_the_error_of_a_validator_of_several_fields_shows_no_values() -> None:
    class Range(rs.Settings):
        low: int = 0
        secret: str = "s3cret"

        @pydantic.model_validator(mode="after")
        def ordered(self) -> "Range":
            if self.low > 3:
                raise ValueError("low must be at most 3")
            return self

    (fault,) = faults([rs.Module("range", settings=Range)], {"range": {"low": 5}})
    assert fault == "settings of range: Value error, low must be at most 3"


def test_a_huge_value_is_shortened() -> None:
    (fault,) = faults([voice], {"voice": {"speed": "x" * 10_000_000}})
    assert len(fault) < 300


@pytest.mark.parametrize("values", [3, "name=Max", ["name"], None])
def test_values_that_are_not_a_mapping_are_refused(values: Any) -> None:
    (fault,) = faults([voice], {"voice": values})
    assert fault == f"settings for 'voice' must be a mapping of fields to values, not {values!r}"


def test_an_instance_of_another_class_is_refused() -> None:
    (fault,) = faults([voice], {"voice": Server(address="")})
    assert fault == "settings for 'voice' must be an instance of Voice, not of Server"
