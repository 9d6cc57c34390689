"""The TypeScript of the web protocols is up to date with the Python records."""

import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Annotated, Any, Literal

import pydantic
import pytest

ROOT = Path(__file__).parents[2]


def test_the_typescript_is_up_to_date() -> None:
    run = subprocess.run(
        [sys.executable, ROOT / "tools" / "protocol.py", "--check"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert (run.stdout, run.stderr, run.returncode) == ("", "", 0)


class Shape(pydantic.BaseModel):
    """A shape.

    It has corners.

    Attributes:
        corners: Places, each as (x, y)
            in pixels.
    """

    type: Literal["shape"]
    corners: list[tuple[float, float]]
    label: str | None
    colours: dict[str, Literal["red", "green"]] = {}
    more: Any = None
    inside: "Shape | None" = None


class Gone(pydantic.BaseModel):
    type: Literal["gone"]


def test_the_tool_accepts_any_module_of_pydantic_models(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    monkeypatch.syspath_prepend(str(tmp_path))
    (tmp_path / "sketch.py").write_text('LIMIT = 5\n"""The most shapes."""\n', encoding="utf-8")
    import protocol
    import sketch  # type: ignore[import-not-found]

    assert isinstance(sketch, ModuleType)
    sketch.FRAMES = pydantic.TypeAdapter(Annotated[Shape | Gone, pydantic.Field(discriminator="type")])
    made = protocol.typescript(
        protocol.Source(("sketch",), types={"Frame": "FRAMES"}, constants=("LIMIT",), checked="Frame")
    )
    assert "/** The most shapes. */\nexport const LIMIT = 5;" in made
    assert '/**\n * A shape.\n *\n * It has corners.\n */\nexport interface Shape {\n  type: "shape";\n' in made
    assert "  /** Places, each as (x, y) in pixels. */\n  corners: [number, number][];\n" in made
    assert "  label: string | null;\n" in made
    assert '  colours?: Record<string, "red" | "green">;\n' in made
    assert "  more?: unknown;\n  inside?: Shape;\n" in made
    assert "export type Frame = Shape | Gone;" in made
    assert '  shape: {\n    corners: "object",\n  },\n  gone: {},\n' in made
