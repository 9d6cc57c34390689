"""Files of all supported kinds become documents. The error about an unreadable file says why."""

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from pypdf import PdfReader, PdfWriter

from ravestate.modules.skill.genqa.reading import Unreadable, kind_of, read


def passages(path: Path) -> dict[str, list[str]]:
    """Return the passages of a file, by title."""
    found: dict[str, list[str]] = {}
    for document in read(path, "a source"):
        said = [passage.text for passage in document.passages]
        if said:
            found.setdefault(document.title, []).extend(said)
    return found


def write(path: Path, content: str | bytes) -> Path:
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def write_pdf(path: Path, *pages: str, title: str = "") -> Path:
    """Write a PDF with one line on each page."""
    kids = " ".join(f"{5 + 2 * number} 0 R" for number in range(len(pages)))
    objects = [
        "<< /Type /Catalog /Pages 2 0 R >>",
        f"<< /Type /Pages /Kids [{kids}] /Count {len(pages)} >>",
        "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
        f"<< /Title ({title}) >>",
    ]
    for number, text in enumerate(pages):
        shown = f"BT /F 12 Tf 72 700 Td ({text}) Tj ET"
        objects += [
            f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 595 842] /Contents {6 + 2 * number} 0 R "
            "/Resources << /Font << /F 3 0 R >> >> >>",
            f"<< /Length {len(shown)} >>\nstream\n{shown}\nendstream",
        ]
    content, places = "%PDF-1.4\n", list[int]()
    for number, body in enumerate(objects, start=1):
        places.append(len(content))
        content += f"{number} 0 obj\n{body}\nendobj\n"
    rows = "".join(f"{place:010} 00000 n \n" for place in places)
    size = len(objects) + 1
    trailer = f"trailer\n<< /Size {size} /Root 1 0 R /Info 4 0 R >>\nstartxref\n{len(content)}\n%%EOF\n"
    return write(path, f"{content}xref\n0 {size}\n0000000000 65535 f \n{rows}{trailer}")


# ----------------------------------------------------------------------------------- readable files


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "utf-32"])
def test_text_is_read_if_its_encoding_can_be_recognised(tmp_path: Path, encoding: str) -> None:
    path = write(tmp_path / "my_notes.txt", "Das Haus ist grün.\r\n\r\nEs hat ein Tor.".encode(encoding))
    assert passages(path) == {"my notes": ["Das Haus ist grün.", "Es hat ein Tor."]}


MARKDOWN = """\
---
layout: page
---
Welcome to the *old* house.

# Machines <!-- a comment -->

## The **pump**

- Grease it [every month](http://example.com/a).
- Use `lithium` grease, not \\*oil\\*.

| Part | Costs |
| --- | --- |
| Filter | 12 euros |

```python
no_text = "of this is read"
```

> The kettle leaks, they say.
"""


def test_markdown_is_read_as_a_reader_sees_it(tmp_path: Path) -> None:
    assert passages(write(tmp_path / "house.md", MARKDOWN)) == {
        "house": ["Welcome to the old house."],
        "Machines – The pump": [
            "Grease it every month.",
            "Use lithium grease, not *oil*.",
            "Filter 12 euros",
            "The kettle leaks, they say.",
        ],
    }


def test_headings_and_html_in_markdown_are_read_as_a_reader_sees_them(tmp_path: Path) -> None:
    text = "Pumps\n=====\n\n<div>\nIt runs &amp; runs.\n</div>\n<script>no_text()</script>\n\n<!-- hidden\nlines -->\nA ![red lamp](lamp.png) is lit.\n"
    assert passages(write(tmp_path / "a.md", text)) == {"Pumps": ["It runs & runs.", "A red lamp is lit."]}


HTML = """<!DOCTYPE html><html><head><title>Tram  lines</title><style>p {}</style></head><body>
<nav>Home | About us and so on</nav><h1>Line 7</h1><p>It runs to the <b>beach</b>,
every ten minutes.</p><!-- nobody sees this --><script>alert("nor this here")</script>
<p hidden>And this is hidden as well.</p><ul><li>The first tram is at five.</li><li>The last one is at noon.</li></ul>
<h2>Fares</h2><table><tr><td>Children</td><td>go for free</td></tr></table></body></html>"""


def test_html_is_read_as_a_reader_sees_it(tmp_path: Path) -> None:
    assert passages(write(tmp_path / "tram.html", HTML)) == {
        "Tram lines – Line 7": [
            "It runs to the beach, every ten minutes.",
            "The first tram is at five.",
            "The last one is at noon.",
        ],
        "Tram lines – Line 7 – Fares": ["Children go for free"],
    }


def test_html_in_a_declared_encoding_is_read(tmp_path: Path) -> None:
    page = '<meta charset="iso-8859-1"><p>Das Café ist geschlossen.</p>'.encode("latin-1")
    assert passages(write(tmp_path / "cafe.htm", page)) == {"cafe": ["Das Café ist geschlossen."]}


def test_an_empty_page_causes_no_warning(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    assert passages(write(tmp_path / "empty.html", b"")) == {}
    assert caplog.text == ""


def test_each_page_of_a_pdf_is_a_separate_source(tmp_path: Path) -> None:
    path = write_pdf(tmp_path / "manual.pdf", "Grease the pump each month.", "The warranty is two years.", title="Pump")
    said = [(d.title, d.source, [p.text for p in d.passages]) for d in read(path, "manual.pdf")]
    assert said == [
        ("Pump", "manual.pdf, page 1", ["Grease the pump each month."]),
        ("Pump", "manual.pdf, page 2", ["The warranty is two years."]),
    ]


def test_a_line_of_json_can_give_a_title_and_a_source(tmp_path: Path) -> None:
    lines = '{"title": "Zorbex", "text": "It needs no fuel at all.", "source": "the archive"}\n\n{"text": "It rains a lot."}\n'
    said = [(d.title, d.source) for d in read(write(tmp_path / "facts.jsonl", lines), "facts.jsonl")]
    assert said == [("Zorbex", "the archive"), ("facts", "facts.jsonl, facts")]


def test_a_file_extension_can_be_in_capitals() -> None:
    assert kind_of(Path("README.MD")) == ".md"
    assert kind_of(Path("photo.jpg")) is None


# --------------------------------------------------------------------------------- unreadable files


def why(path: Path) -> str:
    with pytest.raises(Unreadable) as refused:
        passages(path)
    return str(refused.value)


def test_text_in_an_undeclared_encoding_is_refused(tmp_path: Path) -> None:
    assert why(write(tmp_path / "a.txt", "Café".encode("latin-1"))).startswith("it is not UTF-8 (byte 3): convert it")


@pytest.mark.parametrize("name", ["a.txt", "a.md", "a.html"])
def test_a_binary_file_is_refused(tmp_path: Path, name: str) -> None:
    assert why(write(tmp_path / name, b"\x7fELF\0\0\0\1")).startswith("it is binary")


def test_an_encrypted_pdf_is_refused(tmp_path: Path) -> None:
    writer = PdfWriter(clone_from=PdfReader(write_pdf(tmp_path / "plain.pdf", "Nobody may read this.")))
    writer.encrypt("secret", algorithm="RC4-128")
    writer.write(tmp_path / "locked.pdf")
    assert why(tmp_path / "locked.pdf") == "it is encrypted: remove its password first"


@pytest.mark.parametrize("content", [b"", b"%PDF-1.4\ngarbage", b"no PDF at all"])
def test_a_damaged_pdf_is_refused(tmp_path: Path, content: bytes) -> None:
    assert why(write(tmp_path / "a.pdf", content)).startswith("it is not a PDF, or damaged")


def test_a_pdf_that_is_cut_off_is_refused(tmp_path: Path) -> None:
    whole = write_pdf(tmp_path / "whole.pdf", "Grease the pump each month.").read_bytes()
    assert "damaged" in why(write(tmp_path / "half.pdf", whole[: len(whole) // 3]))


def test_a_pdf_without_text_is_refused(tmp_path: Path) -> None:
    assert "only pictures" in why(write_pdf(tmp_path / "scan.pdf", ""))


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("{", "line 2 is not JSON"),
        ('{"title": "x"}', "line 2 has no text"),
        ('["text"]', "line 2 has no text"),
        ('{"text": 3}', "line 2 has no text"),
        ("\udce9".encode("utf-8", "surrogateescape"), "line 2 is not JSON"),
    ],
)
def test_a_line_of_json_that_is_not_a_document_is_refused(tmp_path: Path, line: str | bytes, said: str) -> None:
    line = line.encode() if isinstance(line, str) else line
    assert why(write(tmp_path / "a.jsonl", b'{"text": "The first line is fine."}\n' + line)).startswith(said)


def test_deep_nesting_does_not_crash_the_reader(tmp_path: Path) -> None:
    assert "deeply" in why(write(tmp_path / "a.jsonl", "[" * 100_000))
    assert passages(write(tmp_path / "a.html", "<div>" * 5_000 + "There is a bottom.")) == {"a": ["There is a bottom."]}


@pytest.mark.parametrize("text", ["**a " * 20_000, "[" * 20_000, "<!-- " * 10_000, "```\n" * 20_001, "# a\n" * 5_000])
def test_a_file_of_many_opening_marks_is_read_quickly(tmp_path: Path, text: str) -> None:
    assert sum(map(len, passages(write(tmp_path / "a.md", text)).values())) < 1000


def test_a_folder_and_a_missing_file_are_refused(tmp_path: Path) -> None:
    (tmp_path / "folder.txt").mkdir()
    assert why(tmp_path / "folder.txt") == "Is a directory"
    assert why(tmp_path / "gone.txt") == "No such file or directory"


def test_a_file_with_an_unknown_extension_is_refused(tmp_path: Path) -> None:
    assert "'.docx'" in why(write(tmp_path / "a.docx", "x"))


@pytest.mark.parametrize(
    ("name", "library"),
    [("a.html", "bs4"), ("a.md", "markdown_it"), ("a.pdf", "pypdf"), ("a.zim", "libzim.reader")],
)
def test_the_error_about_a_missing_library_says_what_to_install(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, library: str
) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    assert "pip install" in why(write(tmp_path / name, "x"))


# ---------------------------------------------------------------------------------------------- ZIM


def entry(title: str, content: str, mimetype: str = "text/html", redirect: bool = False) -> SimpleNamespace:
    item = SimpleNamespace(mimetype=mimetype, content=memoryview(content.encode()))
    return SimpleNamespace(title=title, is_redirect=redirect, get_item=lambda: item)


@pytest.fixture
def archive(monkeypatch: pytest.MonkeyPatch) -> list[SimpleNamespace]:
    """The entries of each archive that the stand-in for libzim opens. libzim is not installed, because it is under the GPL."""
    entries: list[SimpleNamespace] = []

    class Archive:
        def __init__(self, path: Path) -> None:
            if path.read_bytes()[:4] != b"ZIM\x04":
                raise RuntimeError("Invalid magic number")
            self.all_entry_count = len(entries)

        def _get_entry_by_id(self, number: int) -> SimpleNamespace:
            return entries[number]

    library = ModuleType("libzim.reader")
    library.__dict__["Archive"] = Archive
    monkeypatch.setitem(sys.modules, "libzim", ModuleType("libzim"))
    monkeypatch.setitem(sys.modules, "libzim.reader", library)
    return entries


def test_the_articles_of_a_zim_file_are_read(tmp_path: Path, archive: list[SimpleNamespace]) -> None:
    archive += [
        entry("Delft", "<html><body><p>Delft is a town in Holland.</p></body></html>"),
        entry("delft", "", redirect=True),
        entry("style", "p { color: red }", mimetype="text/css"),
        entry("Leiden", "<p>Leiden has a botanical garden.</p>"),
    ]
    path = write(tmp_path / "towns.zim", b"ZIM\x04")
    assert [(d.title, d.source, [p.text for p in d.passages]) for d in read(path, "towns.zim")] == [
        ("Delft", "towns.zim, Delft", ["Delft is a town in Holland."]),
        ("Leiden", "towns.zim, Leiden", ["Leiden has a botanical garden."]),
    ]


def test_a_file_that_is_not_a_zim_archive_is_refused(tmp_path: Path, archive: list[SimpleNamespace]) -> None:
    assert archive == []
    assert why(write(tmp_path / "a.zim", b"PK\x03\x04")) == "it is not a ZIM file, or damaged (Invalid magic number)"
