"""The arguments that name an agent: names of modules, agent files, settings. Each mistake gives a one-line message."""

import re
from importlib.metadata import EntryPoint
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

import ravestate as rs
from cli.examples import HELLO, call, write
from ravestate.errors import UsageError
from ravestate.loading import modules, spec
from ravestate.loading.modules import load_module
from ravestate.modules import rawio

Capture = pytest.CaptureFixture[str]


def run(capsys: Capture, *arguments: str) -> str:
    """Run an agent that ends by itself, and return its output."""
    code, out, errors = call(capsys, "run", *arguments)
    assert (code, errors) == (0, "")
    return out


def refused(capsys: Capture, *arguments: str, code: int = 2) -> str:
    """Call `run` with arguments that it refuses; return the message."""
    found, out, errors = call(capsys, "run", *arguments)
    assert (found, out) == (code, ""), errors
    assert errors.startswith("ravestate run: ")
    return errors.removeprefix("ravestate run: ").rstrip("\n")


# ---------------------------------------------------------------------------------------- modules


def test_a_module_is_found_by_its_built_in_name() -> None:
    assert load_module("rawio") is rawio.module


def test_a_module_is_found_by_its_file(folder: Path, capsys: Capture) -> None:
    write(folder / "sub" / "hello.py", HELLO)
    write(folder / "sub" / "beside.py", "WORD = 'beside'")
    write(folder / "sub" / "uses.py", "import beside, ravestate as rs\nmodule = rs.Module(beside.WORD)")
    assert run(capsys, "./sub/hello.py").startswith("Hello 1.0")
    assert run(capsys, "sub/hello.py").startswith("Hello 1.0")
    assert run(capsys, str(folder / "sub" / "hello.py")).startswith("Hello 1.0")
    assert load_module("sub/uses.py").name == "beside"


def test_a_module_is_found_by_a_dotted_path(folder: Path, capsys: Capture) -> None:
    write(folder / "pkg" / "__init__.py", "")
    write(folder / "pkg" / "inner.py", HELLO + "\n    other = rs.Module('other')\n    module = hello\n")
    assert run(capsys, "pkg.inner").startswith("Hello")
    assert run(capsys, "pkg.inner:hello").startswith("Hello")
    assert load_module("pkg.inner:other").name == "other"


def test_a_module_is_found_by_its_package_or_file_name_in_the_working_folder(folder: Path, capsys: Capture) -> None:
    write(folder / "pkg" / "__init__.py", HELLO)
    write(folder / "single.py", HELLO)
    assert run(capsys, "pkg").startswith("Hello")
    assert run(capsys, "single").startswith("Hello")


def test_a_module_is_found_by_its_entry_point(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write(folder / "plugin.py", "import ravestate as rs\nweather = rs.Module('weather')\nbroken = 3")
    install(
        monkeypatch,
        weather="plugin:weather",
        bad="plugin:broken",
        gone="plugin:gone",
        lost="no_such_package",
        wrong="two:words",
    )
    write(folder / "two.py", "import ravestate as rs\nwords = rs.Module('two words')")
    monkeypatch.syspath_prepend(folder)
    assert load_module("weather").name == "weather"
    for name, text in {
        "bad": "bad: expected an rs.Module (or a Python module that holds one), not 3",
        "gone": "entry point 'gone' (plugin:gone) fails: ",
        "lost": "entry point 'lost' (no_such_package) fails: ModuleNotFoundError",
        "wrong": "Module: 'two words' is not a name",
        "wether": "there is no module 'wether'; did you mean 'weather'?",
    }.items():
        with pytest.raises(rs.RavestateError) as caught:
            load_module(name)
        assert isinstance(caught.value, UsageError) == (name != "wrong")
        assert text in str(caught.value)


def install(monkeypatch: pytest.MonkeyPatch, **points: str) -> None:
    """Pretend that packages with these entry points are installed."""
    found = [EntryPoint(name, value, "ravestate.modules") for name, value in points.items()]

    def entry_points(*, group: str) -> list[EntryPoint]:
        return [point for point in found if point.group == group]

    monkeypatch.setattr(modules, "entry_points", entry_points)


def test_ravestate_itself_installs_no_entry_points() -> None:
    assert list(modules.entry_points(group="ravestate.modules")) == []  # built-in modules need none


def test_a_module_named_twice_is_loaded_once(folder: Path, capsys: Capture) -> None:
    write(folder / "pkg.py", HELLO)
    assert run(capsys, "pkg", "pkg:hello", "rawio", "rawio").count("Hello") == 1


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("hibie", "there is no module 'hibie'; did you mean 'hibye'? (built in: conio, "),
        ("zzz", "there is no module 'zzz' (built in: conio, "),
        ("no.such.path", "module 'no.such.path': No module named 'no'"),
        ("ravestate.modules:rawi", "ravestate.modules has no 'rawi'; did you mean 'rawio'?"),
        ("ravestate.errors", "ravestate.errors: Python module ravestate.errors holds no rs.Module"),
        ("ravestate.errors:nearest", "ravestate.errors:nearest: expected an rs.Module"),
        ("./missing.py", "there is no file ./missing.py"),
        ("./missing", "'./missing' is not a module: name a file (./hello.py), or a dotted path (pkg.mod)"),
        (".", "'.' is not a module: name a file"),
        ("..x", "'..x' is not a module: name a file (./hello.py), or a dotted path (pkg.mod)"),
        ("", "'' is not a module: name a file"),
        (":module", "module ':module' fails when it is imported: ValueError: Empty module name"),
    ],
)
def test_a_missing_module_is_refused_with_a_message(name: str, text: str, folder: Path, capsys: Capture) -> None:
    assert refused(capsys, name).startswith(text)


@pytest.mark.parametrize("way", ["./bad.py", "bad"])
@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("x = = 1\n", r"\S+bad\.py:1: invalid syntax"),
        ("import os\n\nos.nope\n", r"\S+bad\.py:3: AttributeError: module 'os' has no attribute 'nope'"),
        ("def f():\n    raise KeyError('x')\n\nf()\n", r"\S+bad\.py:2: KeyError: 'x'"),
        ("import sys\nsys.exit(0)\n", r"\S+bad\.py:2: SystemExit: 0 \(it ends the process: .*__main__':\)"),
        ("class Odd(BaseException): ...\nraise Odd('x')\n", r"\S+bad\.py:2: Odd: x"),
    ],
)
def test_the_message_for_a_module_that_fails_on_import_has_the_line(
    way: str, content: str, text: str, folder: Path, capsys: Capture
) -> None:
    write(folder / "bad.py", content)
    assert re.fullmatch(rf"\S+ ?\S* fails when it is (loaded|imported): {text}", refused(capsys, way))


def test_ctrl_c_during_an_import_is_not_reported_as_a_fault_of_the_module(folder: Path, capsys: Capture) -> None:
    write(folder / "slow.py", "raise KeyboardInterrupt")
    for way in ("./slow.py", "slow"):
        assert call(capsys, "run", way) == (130, "", "")


def test_the_message_for_a_module_that_imports_a_missing_package_names_the_package(
    folder: Path, capsys: Capture
) -> None:
    write(folder / "needs.py", "import no_such_package\n")
    assert "No module named 'no_such_package'" in refused(capsys, "./needs.py")
    assert "No module named 'no_such_package'" in refused(capsys, "needs")


def test_a_wrong_declaration_gives_exit_code_1_and_a_message(folder: Path, capsys: Capture) -> None:
    write(folder / "wrong.py", "import ravestate as rs\nm = rs.Module('two words')\n")
    for way in ("./wrong.py", "wrong", "wrong:m"):
        assert refused(capsys, way, code=1).startswith("Module: 'two words' is not a name")


def test_a_file_without_a_module_is_refused(folder: Path, capsys: Capture) -> None:
    write(folder / "empty.py", "")
    write(folder / "two.py", "import ravestate as rs\na, b = rs.Module('a'), rs.Module('b')")
    assert "holds no rs.Module: write module = rs.Module('name')" in refused(capsys, "./empty.py")
    assert "holds 2 rs.Modules: call one of them `module`" in refused(capsys, "./two.py")


# ---------------------------------------------------------------------------------------- agent files


def test_paths_in_an_agent_file_are_relative_to_the_file(folder: Path, capsys: Capture) -> None:
    write(folder / "deep" / "parts" / "hello.py", HELLO)
    write(
        folder / "deep" / "agent.yaml",
        """
        modules: [rawio, ./parts/hello.py]
        settings:
          hello: {greeting: Salut, words: [a, b]}
        seed: 3
        patience: 0.5
        """,
    )
    first = run(capsys, "deep/agent.yaml")
    assert first.startswith("Salut 1.0 ('a', 'b') ")
    assert run(capsys, "-f", "deep/agent.yaml") == first  # the same output, because the file has a seed
    assert run(capsys, "deep/agent.yaml", "--seed", "4") != first


def test_an_agent_file_and_modules_can_be_combined(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    write(folder / "settings.yml", "settings: {hello: {greeting: Ahoy}}")
    assert run(capsys, "./hello.py", "-f", "settings.yml").startswith("Ahoy")
    assert "name a module, or an agent file that names modules" in refused(capsys, "-f", "settings.yml")
    assert "name a module, or an agent file that names modules" in refused(capsys)


def test_an_agent_file_can_take_secrets_from_environment_variables(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(folder / "hello.py", HELLO)
    write(
        folder / "agent.yaml",
        "modules: [./hello.py]\nsettings: {hello: {greeting: 'say ${WORD}', words: ['${WORD}', '${NONE:-none}', '${NONE:-}']}}",
    )
    monkeypatch.setenv("WORD", "friend")
    monkeypatch.delenv("NONE", raising=False)
    assert run(capsys, "agent.yaml").startswith("say friend 1.0 ('friend', 'none', '') ")
    monkeypatch.delenv("WORD")
    assert refused(capsys, "agent.yaml") == (
        "agent.yaml: the environment has no WORD; set it, or write ${WORD:-default}"
    )


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("modules: [", "agent.yaml:1: not valid YAML (while parsing"),
        ("- rawio", "agent.yaml must hold `modules: [...]`, and may hold settings, seed, patience"),
        ("", "agent.yaml must hold `modules: [...]`"),
        ("moduls: [rawio]", "agent.yaml: unknown key 'moduls'; did you mean 'modules'?"),
        ("modules: rawio", "agent.yaml: modules must be a list of names, not 'rawio'"),
        ("modules: [1]", "agent.yaml: modules must be a list of names, not [1]"),
        ("settings: [a]", "agent.yaml: settings must map a module to its settings, not ['a']"),
        ("settings: {rawio: 3}", "agent.yaml: settings of rawio must be keys and values, not 3"),
        ("modules: [rawio]\nseed: x", "agent.yaml: seed must be a whole number, not 'x'"),
        ("modules: [rawio]\nseed: true", "agent.yaml: seed must be a whole number, not True"),
        (
            "modules: [rawio]\npatience: []",
            "agent.yaml: patience must be a finite number of seconds, 0 or more, not []",
        ),
        (
            "modules: [rawio]\npatience: -1",
            "agent.yaml: patience must be a finite number of seconds, 0 or more, not -1",
        ),
        (
            "modules: [rawio]\npatience: .nan",
            "agent.yaml: patience must be a finite number of seconds, 0 or more, not nan",
        ),
        (
            "modules: [rawio]\npatience: .inf",
            "agent.yaml: patience must be a finite number of seconds, 0 or more, not inf",
        ),
        ("modules: [./gone.py]", "there is no file ./gone.py"),
    ],
)
def test_a_wrong_agent_file_is_refused_with_a_message(content: str, text: str, folder: Path, capsys: Capture) -> None:
    write(folder / "agent.yaml", content)
    assert refused(capsys, "agent.yaml").startswith(text)


@pytest.mark.parametrize(
    ("content", "text"),
    [
        (
            "a: &a [x, x, x, x, x, x, x, x, x, x]\n"
            + "".join(f"{b}: &{b} [{', '.join([f'*{a}'] * 10)}]\n" for a, b in pairwise("abcdefghijk")),
            "agent.yaml:5: more than 100,000 values once the aliases are followed",
        ),
        ("modules: " + "[" * 5_000, "agent.yaml:1: nested more than 50 levels deep"),
    ],
    ids=["aliases", "nesting"],
)
@pytest.mark.parametrize("command", ["run", "check", "graph"])
def test_an_agent_file_that_expands_without_limit_is_refused_immediately(
    command: str, content: str, text: str, folder: Path, capsys: Capture
) -> None:
    (folder / "agent.yaml").write_text(content, encoding="utf-8")
    assert call(capsys, command, "agent.yaml") == (2, "", f"ravestate {command}: {text}\n")


def test_a_setting_nested_too_deeply_counts_as_text(capsys: Capture) -> None:
    assert "= '[[[" in refused(capsys, "idle", "--set", f"idle.bored_after={'[' * 5_000}", code=2)


def test_check_and_graph_first_name_the_python_files_that_an_agent_file_runs(folder: Path, capsys: Capture) -> None:
    write(folder / "deep" / "hello.py", HELLO)
    write(folder / "other.py", "print('ran'); import ravestate as rs; module = rs.Module('other')")
    write(folder / "deep" / "agent.yaml", "modules: [rawio, ./hello.py, other]")
    for command in ("check", "graph"):
        code, _, errors = call(capsys, command, "deep/agent.yaml")
        said = f"ravestate {command}: deep/agent.yaml runs Python code: {Path('deep/hello.py')}, other\n"
        assert (code, errors) == (0, said)
    assert run(capsys, "deep/agent.yaml").startswith("Hello")  # `run` also checks that there is no error output


def test_check_names_no_python_files_if_the_agent_file_has_only_built_in_modules(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    write(folder / "agent.yaml", "modules: [rawio]")
    assert call(capsys, "check", "agent.yaml", "./hello.py")[2] == ""


def test_one_message_lists_all_mistakes_of_an_agent_file(folder: Path, capsys: Capture) -> None:
    write(
        folder / "agent.yaml",
        """
        modules: [idle, ./gone.py, rawoi]
        patience: abc
        seed: x
        sead: 1
        settings:
          rawio: 3
          idle: {bored_after: soon, bored: 1}
          fillers: {after: "${NO_SUCH_VARIABLE}"}
        """,
    )
    said = refused(capsys, "agent.yaml", "--set", "idel.bored_after=1", "--set", "idle.boring=1").splitlines()
    assert [line.split("(built in")[0].split("(it has")[0].strip() for line in said] == [
        "agent.yaml: unknown key 'sead'; did you mean 'seed'?",
        "agent.yaml: the environment has no NO_SUCH_VARIABLE; set it, or write ${NO_SUCH_VARIABLE:-default}",
        "agent.yaml: settings of rawio must be keys and values, not 3",
        "agent.yaml: seed must be a whole number, not 'x'",
        "agent.yaml: patience must be a finite number of seconds, 0 or more, not 'abc'",
        "there is no file ./gone.py",
        "there is no module 'rawoi'; did you mean 'rawio'?",
        "--set idel.bored_after=1: module 'idel' is not part of this agent; did you mean 'idle'?",
        "--set idle.boring=1: module 'idle' has no such setting",
        "settings for 'fillers': module 'fillers' is not part of this agent",
        "setting idle.bored_after = 'soon': Input should be a valid number, unable to parse string as a number",
        "setting idle.bored: module 'idle' has no such setting; did you mean 'bored_after'?",
    ]


def test_an_unreadable_agent_file_is_refused_with_a_message(folder: Path, capsys: Capture) -> None:
    assert refused(capsys, "gone.yaml") == "cannot read gone.yaml: No such file or directory"
    (folder / "folder.yaml").mkdir()
    assert refused(capsys, "folder.yaml") == "cannot read folder.yaml: Is a directory"
    (folder / "binary.yaml").write_bytes(b"\xff\xfe\x00")
    assert refused(capsys, "binary.yaml").startswith("binary.yaml: not valid YAML (")


# ---------------------------------------------------------------------------------------- settings


def test_the_option_set_overrides_the_environment_which_overrides_the_file(
    folder: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    write(folder / "hello.py", HELLO)
    write(folder / "agent.yaml", "modules: [./hello.py]\nsettings: {hello: {greeting: file, pause: 2}}")
    assert run(capsys, "agent.yaml").startswith("file 2.0")
    monkeypatch.setenv("RAVESTATE_HELLO_GREETING", "environment")
    assert run(capsys, "agent.yaml").startswith("environment 2.0")
    assert run(capsys, "agent.yaml", "--set", "hello.greeting=set").startswith("set 2.0")
    assert run(capsys, "./hello.py").startswith("environment 1.0")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("hello.greeting=a=b c", "a=b c 1.0 ()"),
        ("hello.greeting=12", "12 1.0 ()"),
        ("hello.greeting=yes", "yes 1.0 ()"),
        ("hello.greeting=", " 1.0 ()"),
        ("hello.pause=2", "Hello 2.0 ()"),
        ("hello.pause=1e3", "Hello 1000.0 ()"),
        ("hello.words=[a, b]", "Hello 1.0 ('a', 'b')"),
    ],
)
def test_the_option_set_reads_text_for_a_text_field_and_yaml_for_other_fields(
    text: str, said: str, folder: Path, capsys: Capture
) -> None:
    write(folder / "hello.py", HELLO)
    assert run(capsys, "./hello.py", "--set", text).startswith(said)


def test_the_last_of_two_values_for_a_setting_wins(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    assert run(capsys, "./hello.py", "--set", "hello.pause=2", "--set", "hello.pause=3").startswith("Hello 3.0")


def test_the_function_with_required_adds_the_required_modules_even_in_a_cycle(folder: Path) -> None:
    write(folder / "user.py", HELLO.replace("    hello = ", "    base = ").replace("@hello", "@base"))
    base = rs.Module("base")
    top = rs.Module("top", requires=[base])
    base.requires = [top]  # only the compiler refuses a cycle
    assert spec.with_required([top]) == [top, base]


@pytest.mark.parametrize("text", ["hello", "hello.greeting", "greeting=x", "=x", ".=x", "hello.=x", ".greeting=x"])
def test_a_malformed_option_set_is_refused_with_a_message(text: str, folder: Path, capsys: Capture) -> None:
    assert refused(capsys, "rawio", "--set", text) == (
        f"--set {text}: write --set module.key=value, e.g. --set idle.bored_after=10"
    )


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        (
            "idle.bored_afer=3",
            "module 'idle' has no such setting; did you mean 'bored_after'? (it has: bored_after, ",
        ),
        ("idel.bored_after=3", "module 'idel' is not part of this agent; did you mean 'idle'?"),
        ("conoi.prompt=x", "module 'conoi' is not part of this agent; did you mean 'conio'?"),
        ("conio.prompt=x", "module 'conio' is not part of this agent: add the module"),
        ("rawio.loud=1", "module 'rawio' has no settings"),
    ],
)
def test_an_unknown_setting_is_wrong_use(text: str, fault: str, capsys: Capture) -> None:
    assert refused(capsys, "idle", "rawio", "--set", text).startswith(f"--set {text}: {fault}")


def test_one_message_lists_all_unknown_settings(capsys: Capture) -> None:
    assert len(refused(capsys, "idle", "--set", "a.b=1", "--set", "idle.c=1", "--set", "d").splitlines()) == 3


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("idle.bored_after=never", "setting idle.bored_after = 'never': Input should be a valid number"),
        ("idle.bored_after=[", "setting idle.bored_after = '[': Input should be a valid number"),
        ("idle.bored_after=-1", "-1"),
    ],
)
def test_a_value_that_does_not_fit_its_setting_is_refused(text: str, fault: str, capsys: Capture) -> None:
    assert fault in refused(capsys, "idle", "rawio", "--set", text, code=2)


def test_the_method_options_returns_the_arguments_for_a_context() -> None:
    options: Any = spec.AgentSpec([], {"a": {}}, 3, 0.5).options()
    assert options == {"settings": {"a": {}}, "seed": 3, "patience": 0.5}
