"""Find prose that a reader has to read twice: openings without a noun, awkward passives, overlong sentences.

    python tests/repo/words.py [PATH ...]        # default: all prose of the repository

The finder reads Markdown pages, the docstrings, comments and messages of Python files, and the comments of the web
pages' sources. It knows only the worst faults.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 25
"""The maximum number of words in a sentence, or between its semicolons and colons. A code span counts as one word."""
WHOLE = 40
"""The maximum number of words between two full stops, across semicolons and colons."""

HEADLESS = re.compile(
    r"^(?:(?:And|But|So|Or|Also|Then)[ ,]+)?"
    r"(?:Who|Whoever|Whom|Whomever|Whose|What|Whatever|Whichever|Of|(?:To|From|For|By|With|On|At) (?:who|whom|what|which))\b"
)
INSIDE = re.compile(r"\b(?:whoever|whomever|whosoever)\b", re.IGNORECASE)
PRIVATE = re.compile(
    r"\b(?:is|are|was|were|be|been|being) (?:told(?! (?:apart|to))|had by|said of|asked of)\b"
    r"|\btell(?:s|ing)? of\b|\btold of\b|\bbegins? anew\b|\bnobody but\b",
    re.IGNORECASE,
)
RULES = (
    (HEADLESS, "begins without a noun: subject first"),
    (INSIDE, "a bare 'whoever': name the noun"),
    (PRIVATE, "say it with an active verb"),
)
END = re.compile(r"(?<=[.!?;:…])[\"'”’)*_]*\s+(?=[\"'“‘(*_`\[]*[A-Z0-9`\[<\"“])|(?<=[;:])\s+|\s+[–—]\s+")
STOP = re.compile(r"(?<=[.!?…])[\"'”’)*_]*\s+(?=[\"'“‘(*_`\[]*[A-Z0-9`\[<])")
ABBREVIATION = re.compile(r"\b(?:e\.g|i\.e|etc|cf|vs|Fig|Dr|Mr|Mrs|St|No|U\.S\.A|approx|et al)\.$")
MESSAGES = {"warn", "warning", "error", "info", "debug", "exception", "critical", "fail", "print", "echo"}
TEXT = {"help", "description", "epilog", "message", "title"}


@dataclass(frozen=True, slots=True)
class Fault:
    """A sentence that breaks a rule; `line` counts from 1."""

    file: Path
    line: int
    rule: str
    sentence: str

    def __str__(self) -> str:
        file = self.file.relative_to(ROOT) if self.file.is_relative_to(ROOT) else self.file
        return f"{file}:{self.line}: {self.rule}: {self.sentence}"


# ------------------------------------------------------------------------------------------ sentences


def sentences(prose: str) -> Iterator[str]:
    """Yield the sentences of a paragraph. A colon, a semicolon and a dash also end a sentence."""
    begin = 0
    for gap in END.finditer(prose):
        if ABBREVIATION.search(prose[begin : gap.start()]):
            continue
        yield prose[begin : gap.start()].strip()
        begin = gap.end()
    if rest := prose[begin:].strip():
        yield rest


def words(sentence: str) -> int:
    """Count the words of a sentence."""
    plain = re.sub(r"``.+?``|`[^`]+`|\{[^{}]*\}|https?://\S+", " code ", sentence)
    return sum(re.search(r"\w", word) is not None for word in plain.split())


def faults_of(prose: str) -> Iterator[tuple[str, str]]:
    """Yield each fault of a paragraph: the rule and the sentence."""
    prose = re.sub(r"!?\[([^\]]*)\](?:\([^)]*\)|\[[^\]]*\])", r"\1", " ".join(prose.split()))
    for sentence in sentences(prose):
        bare = re.sub(r"``.+?``|`[^`]+`|[\"“][^\"”]*[\"”]", "`x`", sentence).strip("\"'“‘(*_ ")
        for pattern, rule in RULES:
            if pattern is HEADLESS and re.search(r"\?[\"'”’)*_]*$", sentence):
                continue
            if pattern.search(bare):
                yield rule, sentence
        if (count := words(sentence)) > LONGEST:
            yield f"{count} words, at most {LONGEST}", sentence
    for sentence in STOP.split(prose):
        if (count := words(sentence)) > WHOLE and all(words(x) <= LONGEST for x in sentences(sentence)):
            yield f"{count} words between full stops, at most {WHOLE}", sentence


# --------------------------------------------------------------------------------------- paragraphs


def of_markdown(text: str, first: int = 1) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs, list items and table cells of Markdown, with their lines. Leave out blocks of code."""
    fence, begin, held = "", first, list[str]()
    for number, line in enumerate(text.splitlines(), first):
        bare = line.strip()
        if fence:
            fence = "" if bare.startswith(fence) else fence
            continue
        starts = re.match(r"(?:[-*+]|\d+[.)]|#+|>|!!!|\?\?\?)\s", bare)
        opens = re.match(r"(`{3,}|~{3,})", bare)
        if not bare or starts or opens or bare.startswith(("|", "<", ">>>", "...", "://", "==", "--")):
            if held:
                yield begin, " ".join(held)
            held = []
            if opens:
                fence = opens[1]
            elif bare.startswith("|"):
                yield from ((number, cell.strip()) for cell in bare.strip("|").split("|") if cell.strip(" -:"))
            elif bare.startswith("#"):
                pass  # a heading is a title, not a sentence
            elif starts:
                begin, held = number, [bare[starts.end() :]]
            continue
        if not held:
            begin = number
        held.append(bare)
    if held:
        yield begin, " ".join(held)


def of_docstring(text: str, first: int) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs of a docstring. Each entry of a section such as ``Args:`` is a paragraph."""
    lines = text.expandtabs().splitlines()
    margin = min((len(x) - len(x.lstrip()) for x in lines[1:] if x.strip()), default=0)
    prose: list[str] = []
    section, literal = "", False
    for place, line in enumerate(lines):
        bare = line.strip() if place == 0 else line[margin:]
        depth = len(bare) - len(bare.lstrip())
        if depth == 0 and bare:
            literal = False
            section = bare[:-1] if re.fullmatch(r"[A-Z][a-z]+( [a-z]+)?:", bare) else ""
        if bare and not section and depth >= 4:
            literal = True  # an indented block of code
        if section in ("Example", "Examples") or literal or (section and depth == 0):
            prose.append("")
            continue
        if section and depth == 4:  # an entry begins
            prose.append("")  # an additional line, which the offset below corrects
            bare = re.sub(r"^\s*[\w*.,|\[\] `()]+:\s", "", bare)
            prose[-1] = "\0" + bare.strip()
            continue
        prose.append(bare)
    for line, paragraph in of_markdown("\n".join(x.replace("\0", "- ") for x in prose), first):
        yield line, paragraph


def of_python(text: str) -> Iterator[tuple[int, str]]:
    """Yield the docstrings, the comments and the messages of Python code."""
    for node in nodes(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            yield from of_docstring(node.value.value, node.lineno)
        elif isinstance(node, ast.Raise) and node.exc is not None:
            yield from _strings(node.exc)
        elif isinstance(node, ast.Call):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            if name in MESSAGES:
                for argument in node.args:
                    yield from _strings(argument)
            for keyword in node.keywords:
                if keyword.arg in TEXT:
                    yield from _strings(keyword.value)
    begin, held = 0, list[str]()
    for number, comment, own in comments(text):
        if re.match(r"(?:type|pyright|noqa|fmt|ruff|mypy|pragma)\b|!|[-=]{4}", comment):
            continue
        if own and held and number == begin + len(held):
            held.append(comment)
            continue
        if held:
            yield begin, " ".join(held)
        begin, held = number, [comment]
        if not own:
            yield begin, comment
            held = []
    if held:
        yield begin, " ".join(held)


def nodes(tree: ast.AST) -> Iterator[ast.AST]:
    """Yield the nodes of a tree, twice as fast as ``ast.walk``."""
    found: list[Any] = [tree]
    for node in found:
        yield node
        for name in node._fields:
            inner = getattr(node, name, None)
            if isinstance(inner, list):
                found += [one for one in inner if isinstance(one, ast.AST)]
            elif isinstance(inner, ast.AST) and name != "ctx":
                found.append(inner)


def comments(text: str) -> Iterator[tuple[int, str, bool]]:
    """Yield the comments of Python code: the line, the text, and whether nothing else is on the line."""
    number, place = 1, 0
    for match in TOKEN.finditer(text):
        if match["comment"] is not None:
            number, place = number + text.count("\n", place, match.start()), match.start()
            own = not text[text.rfind("\n", 0, place) + 1 : place].strip()
            yield number, match["comment"].lstrip("#:").strip(), own


def _strings(node: ast.AST) -> Iterator[tuple[int, str]]:
    """Yield the texts in an expression. Each replacement field of an f-string counts as one word."""
    if isinstance(node, ast.Constant):
        if isinstance(node.value, str) and " " in node.value:
            for paragraph in node.value.split("\n"):
                yield node.lineno, paragraph
    elif isinstance(node, ast.JoinedStr):
        text = "".join(str(x.value) if isinstance(x, ast.Constant) else "`x`" for x in node.values)
        for paragraph in text.split("\n"):
            yield node.lineno, paragraph
    elif isinstance(node, (ast.Call, ast.BinOp, ast.IfExp, ast.List, ast.Tuple, ast.Starred)):
        for child in ast.iter_child_nodes(node):
            yield from _strings(child)


TOKEN = re.compile(
    r"""(?P<comment>\#[^\n]*)"""
    r"""|(?:\"{3}(?:[^\\]|\\.)*?\"{3}|'{3}(?:[^\\]|\\.)*?'{3}|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*')""",
    re.DOTALL,
)
"""A comment or a string of Python code. Strings are included because a ``#`` in them begins no comment."""
COMMENT = re.compile(r"/\*\*?(.*?)\*/|<!--(.*?)-->|(?<![:\"'\w])//[ \t](.*?)$", re.DOTALL | re.MULTILINE)


def of_script(text: str) -> Iterator[tuple[int, str]]:
    """Yield the comments of TypeScript, Svelte, CSS or HTML. Consecutive `//` lines are one comment."""
    begin, last, held = 0, -1, list[str]()
    for match in COMMENT.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        body = next(group for group in match.groups() if group is not None)
        body = re.sub(r"^\s*\*( |$)", "", body, flags=re.MULTILINE).strip()
        if match[3] is not None and line == last + 1:
            held.append(body)
        else:
            if held:
                yield begin, " ".join(held)
            begin, held = line, [body]
        last = line + match[0].count("\n")
    if held:
        yield begin, " ".join(held)


# ----------------------------------------------------------------------------------------- the files


def paragraphs(file: Path) -> Iterator[tuple[int, str]]:
    """Yield the paragraphs of a file, each with its line."""
    text = file.read_text(encoding="utf-8")
    match file.suffix:
        case ".md":
            return of_markdown(text)
        case ".py":
            return of_python(text)
        case _:
            return of_script(text)


def files(paths: Iterable[Path] = ()) -> list[Path]:
    """Return the tracked files with prose in `paths` (default: all)."""
    found = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *map(str, paths)],
        cwd=ROOT, capture_output=True, text=True, check=True,
    ).stdout.splitlines()  # fmt: skip
    kept = [ROOT / name for name in found if "/page/" not in name and "licence" not in name]
    return [x for x in kept if x.suffix in (".md", ".py", ".ts", ".svelte", ".css", ".html") and x.is_file()]


def faults(paths: Iterable[Path] = ()) -> Iterator[Fault]:
    """Yield every fault of the files in `paths`."""
    for file in files(paths):
        for line, prose in paragraphs(file):
            for rule, sentence in faults_of(prose):
                yield Fault(file, line, rule, sentence)


if __name__ == "__main__":
    found = list(faults(Path(x).resolve() for x in sys.argv[1:]))
    print(*found, sep="\n")
    print(f"{len(found)} faults", file=sys.stderr)
