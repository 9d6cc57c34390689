"""``ravestate check``: the exit code is 1 for faults and for findings that make a rule fail, otherwise 0."""

from pathlib import Path

import pytest

from cli.examples import HELLO, call, write
from ravestate.modules import BUILT_IN

Capture = pytest.CaptureFixture[str]


def test_check_reports_an_agent_without_findings(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    assert call(capsys, "check", "./hello.py") == (
        0,
        "1 rule, 10 signals, 3 slots: no faults, no findings\n",
        "",
    )


def test_findings_are_printed_but_are_not_faults(folder: Path, capsys: Capture) -> None:
    write(
        folder / "odd.py",
        """
        import ravestate as rs
        module = rs.Module("odd")
        go, lost, out = module.signal("go", input=True), module.signal("lost"), module.slot("out")

        @module.rule(when=go, writes=out, emits=lost)
        async def first(ctx): ...

        @module.rule(when=go, writes=out)
        async def second(ctx): ...
        """,
    )
    code, out, errors = call(capsys, "check", "./odd.py")
    lines = out.splitlines()
    assert (code, errors) == (0, "")
    assert [line.split(":")[0] for line in lines[:-1]] == ["never-wins", "tie", "unheard"]
    assert lines[-1].endswith("no faults, 3 findings")


def test_an_example_that_fits_two_intents_is_a_finding(folder: Path, capsys: Capture) -> None:
    write(
        folder / "shop.py",
        """
        import ravestate as rs
        from ravestate.modules import nlp, rawio
        module = rs.Module("shop", requires=[rawio, nlp])
        hours = nlp.intent(module, "hours", examples=["when do you open", "are you open on Sundays", "how late are you open"])
        price = nlp.intent(module, "price", examples=["what does it cost", "how much is it", "R u open on Sundays?"])
        late = nlp.intent(module, "late", examples=["until when are you open", "how long are you open"])

        @module.rule(when=hours | price | late, writes=rawio.output)
        async def answer(ctx): ...
        """,
    )
    code, out, _ = call(capsys, "check", "./shop.py")
    examples = [line for line in out.splitlines() if line.startswith("example:")]
    assert code == 0
    assert examples[0] == (
        "example: the example 'R u open on Sundays?' of intent shop:hours fits intent shop:price as well: give it to "
        "only one intent, or write examples that differ more"
    )
    assert any("'until when are you open' of intent shop:late fits intent shop:hours" in line for line in examples)


MISSPELT = """
    import ravestate as rs
    from ravestate.modules import rawio
    module = rs.Module("greeter", requires=[rawio])

    @module.rule(when=rs.startup, writes=rawio.output)
    async def greet(ctx):
        ctx[rawio.outptu] = "Hello!"
"""


@pytest.mark.parametrize(
    ("right", "wrong", "finding"),
    [
        ("outptu", "outptu", "greeter.py:6) names rawio.outptu (line 8), which does not exist; did you mean 'output'?"),
        ("rawio.outptu", "rawio.input", "undeclared: rule greeter:greet"),
        ('rawio.outptu] = "Hello!"', "rawio.output] = ctx.sleep(1)\n        ctx.sleep(1)", "await: rule greeter:greet"),
    ],
)
def test_findings_of_rules_that_do_not_do_what_their_source_says_give_exit_code_1(
    right: str, wrong: str, finding: str, folder: Path, capsys: Capture
) -> None:
    write(folder / "greeter.py", MISSPELT.replace(right, wrong))
    code, out, errors = call(capsys, "check", "./greeter.py")
    assert (code, errors) == (1, "")
    assert finding in out
    assert out.endswith("no faults, 1 finding (1 means that a rule fails, or does not do what its source says)\n")


def test_help_explains_the_exit_code(capsys: Capture) -> None:
    assert "Exit code 1: the agent has faults" in call(capsys, "check", "--help")[1]


def test_check_prints_all_faults_together(folder: Path, capsys: Capture) -> None:
    write(
        folder / "faulty.py",
        """
        import ravestate as rs
        module = rs.Module("faulty", requires=[])
        far = rs.Module("far").signal("far")

        @module.rule(when=far)
        async def first(ctx): ...

        @module.rule(when=module.signal("go"), weight=-1)
        async def second(ctx): ...
        """,
    )
    code, out, errors = call(capsys, "check", "./faulty.py")
    assert (code, out) == (1, "")
    lines = errors.splitlines()
    assert len(lines) == 2 and all(line.startswith("fault: rule faulty:") for line in lines)
    assert "write requires=[far]" in errors and "weight=-1.0 must be above 0" in errors


def test_check_finds_a_setting_that_makes_a_declaration_faulty(folder: Path, capsys: Capture) -> None:
    write(
        folder / "late.py",
        """
        import ravestate as rs

        class Settings(rs.Settings):
            after: float = 1.0

        module = rs.Module("late", settings=Settings)

        @module.rule(when=rs.activity.true.min_age(Settings.after))
        async def come(ctx): ...
        """,
    )
    assert call(capsys, "check", "./late.py", "--set", "late.after=3")[0] == 0
    code, _, errors = call(capsys, "check", "./late.py", "--set", "late.after=-3")
    assert code == 1 and errors.startswith("fault: rule late:come") and "= -3.0 must be 0 s or more" in errors
    code, _, errors = call(capsys, "check", "./late.py", "--set", "late.afer=3")
    assert code == 2 and "--set late.afer=3: module 'late' has no such setting" in errors


def test_a_module_with_a_wrong_declaration_is_a_fault(folder: Path, capsys: Capture) -> None:
    write(folder / "wrong.py", "import ravestate as rs\nmodule = rs.Module('')\n")
    code, _, errors = call(capsys, "check", "./wrong.py")
    assert code == 1 and errors.startswith("fault: Module: '' is not a name")


def test_wrong_use_gives_exit_code_2(capsys: Capture) -> None:
    assert call(capsys, "check")[0] == 2
    assert call(capsys, "check", "hibie")[0] == 2


def test_utilities_are_listed(folder: Path, capsys: Capture) -> None:
    write(folder / "hello.py", HELLO)
    _, out, _ = call(capsys, "check", "./hello.py", "--utilities")
    assert "hello:greet   0.000000 nats" in out


@pytest.mark.parametrize("name", BUILT_IN)
def test_the_built_in_modules_have_no_faults(name: str, capsys: Capture) -> None:
    code, out, _ = call(capsys, "check", name)
    assert code == 0
    kinds = {line.split(":")[0] for line in out.splitlines()[:-1]}
    assert kinds <= {"unheard"}  # such a signal is for rules of other modules
