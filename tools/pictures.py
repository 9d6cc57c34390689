"""Draw the pictures of README.md and docs/: most from the code on the page, some from the sketches in this file.

    python tools/pictures.py            write docs/pictures/*.svg
    python tools/pictures.py --check    exit with code 1 if a picture is out of date; the tests check this too

Three kinds:

- Diagrams: the tool runs the page's Python blocks, and `policy.diagram()` draws their module.
- Timelines and causal groups: the tool draws the trace of a page's simulation.
- Sketches: boxes and arrows in this file.

All pictures follow the viewer's light or dark theme, and need no other file.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from functools import cache
from html import escape
from pathlib import Path
from types import ModuleType

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

import ravestate as rs  # noqa: E402
from ravestate.draw.style import NODE_COLOURS, PAPER, TEXT  # noqa: E402
from ravestate.draw.text import width  # noqa: E402
from ravestate.engine import trace as t  # noqa: E402
from repo.snippets import Page  # noqa: E402

FOLDER = ROOT / "docs" / "pictures"
MODEL = "docs/explanation/processing-model.md"


def pictures() -> dict[str, str]:
    """Draw every picture; return file name → text of the SVG."""
    made = {
        "guide.svg": diagram("README.md", "guide"),
        "tutorial.svg": diagram("docs/tutorial/first-agent.md", "guide"),
        "utility.svg": diagram("docs/explanation/utility.md", "games"),
        "loop.svg": diagram(MODEL, "quiz"),
        "life.svg": life(),
        "instant.svg": instant(),
    }
    for name, variable, options in (
        ("waiting.svg", "slow_trace", {"end": 3.0}),
        ("patience.svg", "fusion_trace", {"end": 3.0}),
        ("looping.svg", "quiz_trace", {"end": 26.0}),
        ("barge-in.svg", "story_trace", {"end": 8.0}),
    ):
        made[name] = timeline(_page(MODEL), variable, **options)
    made["groups.svg"] = groups(_page(MODEL), "groups_trace")
    return made


# --------------------------------------------------------------------------------------- from pages


@cache
def _page(file: str) -> ModuleType:
    """Run all blocks of a page; return their namespace."""
    with tempfile.TemporaryDirectory() as folder:
        page = Page(ROOT / file, Path(folder))
        sys.stdout, out = open(Path(folder) / "printed", "w"), sys.stdout  # noqa: SIM115  # closed below
        try:
            for block in page.blocks:
                if block.runs:
                    page.run(block)
        finally:
            sys.stdout.close()
            sys.stdout = out
        return page.module


def diagram(file: str, variable: str) -> str:
    """Draw the Signal-Rule-Slot diagram of a module that a page defines."""
    return rs.compile(vars(_page(file))[variable]).diagram()


# ------------------------------------------------------------------------------------------- sheets


@dataclass
class Sheet:
    """An SVG under construction, in pixels."""

    title: str
    wide: float
    high: float
    parts: list[str] = field(default_factory=list)

    def text(self, x: float, y: float, words: str, kind: str = "", anchor: str = "middle") -> None:
        self.parts.append(
            f'<text class="{kind}" text-anchor="{anchor}" x="{x:.1f}" y="{y:.1f}">{escape(words, quote=False)}</text>'
        )

    def box(self, x: float, y: float, w: float, h: float, kind: str, round_: float = 4) -> None:
        self.parts.append(
            f'<rect class="{kind}" x="{x:.1f}" y="{y:.1f}" width="{w:.1f}" height="{h:.1f}" rx="{round_:g}"/>'
        )

    def state(self, x: float, y: float, w: float, name: str, words: Iterable[str], kind: str) -> None:
        """Draw a box centred at (x, y), with a name and lines of small text."""
        words = list(words)
        h = 34 + 14 * len(words)
        self.box(x - w / 2, y - h / 2, w, h, kind, 8)
        self.text(x, y - h / 2 + 21, name, "name")
        for row, line in enumerate(words):
            self.text(x, y - h / 2 + 38 + 14 * row, line, "small")

    def line(self, path: str, kind: str = "arrow") -> None:
        self.parts.append(f'<path class="{kind}" d="{path}"/>')

    def svg(self) -> str:
        return "\n".join(
            [
                '<?xml version="1.0" encoding="UTF-8"?>',
                f'<svg xmlns="http://www.w3.org/2000/svg" role="img" width="{self.wide:g}" height="{self.high:g}" '
                f'viewBox="0 0 {self.wide:g} {self.high:g}">',
                f"<title>{escape(self.title, quote=False)}</title>",
                f"<style>{_style()}</style>",
                '<defs><marker id="head" viewBox="0 0 10 10" refX="8.5" refY="5" markerWidth="7" markerHeight="7" '
                'orient="auto-start-reverse"><path class="head" d="M1 1L9 5L1 9Z"/></marker></defs>',
                '<rect class="paper" width="100%" height="100%"/>',
                *self.parts,
                "</svg>\n",
            ]
        )


@cache
def _style() -> str:
    slot, signal, rule = (NODE_COLOURS[kind] for kind in ("slot", "signal", "rule"))
    ink, faint, grid = ("#4b535c", "#b4bdc7"), ("#57606a", "#a3adb8"), ("#e3e7eb", "#2a323a")
    wait = ("#fff3cd", "#4a3d12"), ("#a77b00", "#e0b94a")
    font = 'font-family:system-ui,-apple-system,"Segoe UI",Roboto,"Helvetica Neue",Arial,sans-serif'
    fills: list[tuple[str, tuple[str, str] | None, tuple[str, str] | None, str]] = [
        (".paper", (PAPER.light, PAPER.dark), None, ""),
        ("text", (TEXT.light, TEXT.dark), None, f"{font};font-size:13px"),
        ("text.name", None, None, "font-weight:600"),
        ("text.small", faint, None, "font-size:11.5px"),
        ("text.tiny", faint, None, "font-size:10.5px"),
        (".arrow", None, ink, "fill:none;stroke-width:1.6;marker-end:url(#head)"),
        (".dotted", None, ink, "fill:none;stroke-width:1.8;stroke-dasharray:.1 5;stroke-linecap:round;marker-end:url(#head)"),
        (".rail", None, grid, "fill:none;stroke-width:1"),
        (".head", ink, None, ""),
        (".band", grid, None, "opacity:.55"),
        (".plain", (PAPER.light, PAPER.dark), ink, "stroke-width:1.5"),
        (".waits", wait[0], wait[1], "stroke-width:1.5"),
        (".holds", (PAPER.light, PAPER.dark), faint, "stroke-width:1.3;stroke-dasharray:4 3"),
        (".slot", (slot[0].light, slot[0].dark), (slot[1].light, slot[1].dark), "stroke-width:1.5"),
        (".signal", (signal[0].light, signal[0].dark), (signal[1].light, signal[1].dark), "stroke-width:1.5"),
        (".rule", (rule[0].light, rule[0].dark), (rule[1].light, rule[1].dark), "stroke-width:1.5"),
    ]  # fmt: skip
    sheets: list[str] = []
    for tone in (0, 1):
        lines: list[str] = []
        for selector, fill, stroke, more in fills:
            said = ([f"fill:{fill[tone]}"] if fill else []) + ([f"stroke:{stroke[tone]}"] if stroke else [])
            if more and not tone:
                said.append(more)
            if said:
                lines.append(f"{selector}{{{';'.join(said)}}}")
        sheets.append("\n".join(lines))
    return f"{sheets[0]}\n@media (prefers-color-scheme:dark){{\n{sheets[1]}\n}}"


# --------------------------------------------------------------------------------------- from traces


@dataclass(slots=True)
class Bar:
    """A bar of the timeline: the state of an activation between two times."""

    rule: str
    kind: str
    begin: float
    end: float
    words: str = ""


def timeline(page: ModuleType, variable: str, *, end: float) -> str:
    """Draw a timeline: a row for each signal and each rule, time to the right."""
    records = [record for record in vars(page)[variable] if record.time <= end]
    signals = _seen(
        r.signal for r in records if isinstance(r, t.Born) and r.signal.split(":")[0] not in ("core", "idle")
    )
    signals = [name for name in signals if name != "rawio:output:changed"]
    bars = list(_bars(records, end))
    rules = _seen(bar.rule for bar in bars)
    said = [(r.time, r.payload) for r in records if isinstance(r, t.Born) and r.signal == "rawio:output:changed"]
    left = 24 + max(width(name, 13) for name in (*signals, *rules, "said"))
    scale, row, top = (860 - left) / end, 34.0, 20.0
    rows = {name: top + row * (place + 0.5) for place, name in enumerate([*signals, *rules, "said"])}
    bottom = top + row * len(rows)
    sheet = Sheet(f"Timeline: {', '.join(rules)}", 900, bottom + 74)

    def x(time: float) -> float:
        return left + 16 + time * scale

    step = next(s for s in (0.5, 1, 2, 5, 10) if end / s <= 14)
    for number in range(int(end / step) + 1):
        sheet.line(f"M{x(number * step):.1f} {top}V{bottom}", "rail")
        sheet.text(x(number * step), bottom + 16, f"{number * step:g} s", "tiny")
    for name, y in rows.items():
        sheet.text(left, y + 4, name.removesuffix(":changed") if name in signals else name, "", "end")
    for record in records:
        if isinstance(record, t.Born) and record.signal in signals:
            sheet.parts.append(
                f'<circle class="signal" cx="{x(record.time):.1f}" cy="{rows[record.signal]:.1f}" r="6"/>'
            )
    for bar in sorted(bars, key=lambda bar: bar.kind == "rule"):
        begin, wide = x(bar.begin), max((bar.end - bar.begin) * scale, 5)
        if bar.kind != "rule":
            wide = (bar.end - bar.begin) * scale
            if wide < 1:
                continue
        sheet.box(begin, rows[bar.rule] - 9, wide, 18, bar.kind, 3)
        if bar.words:
            followed = any(other.rule == bar.rule and other.begin == bar.end for other in bars)
            sheet.text(begin + wide + (14 if followed else 6), rows[bar.rule] + 4, bar.words, "tiny", "start")
    for time, words in said:
        sheet.box(x(time) - 3, rows["said"] - 9, 6, 18, "slot", 2)
        sheet.text(x(time) + 8, rows["said"] + 4, words if len(words) < 40 else words[:38] + "…", "tiny", "start")
    at = left + 16
    for kind, words in (("signal", "a spike is born"), ("holds", "holds, not yet ready"), ("waits", "ready, and waits"), ("rule", "runs"), ("slot", "output is written")):  # fmt: skip
        if kind == "signal":
            sheet.parts.append(f'<circle class="signal" cx="{at + 6:.1f}" cy="{bottom + 45:.1f}" r="6"/>')
        else:
            sheet.box(at - 4, bottom + 38, 18, 14, kind, 3)
        sheet.text(at + 20, bottom + 49, words, "tiny", "start")
        at += 34 + width(words, 11)
    return sheet.svg()


def _seen(names: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(names))


def _bars(records: list[t.Record], end: float) -> Iterable[Bar]:
    """Return the bars of all activations, in the order in which they begin."""
    open_: dict[int, Bar] = {}
    done: list[Bar] = []

    def change(activation: int, rule: str, time: float, kind: str | None, words: str = "") -> None:
        bar = open_.pop(activation, None)
        if bar is not None:
            bar.end, bar.words = time, words
            done.append(bar)
        if kind is not None:
            open_[activation] = Bar(rule, kind, time, end)
            if bar is not None and bar.kind == kind:  # the same state goes on
                done.remove(bar)
                open_[activation].begin = bar.begin

    for record in records:
        rule = getattr(record, "rule", "")
        if rule.split(":")[0] in ("core", "idle"):
            continue
        match record:
            case t.Held(time, activation):
                change(activation, rule, time, "holds")
            case t.Waits(time, activation):
                change(activation, rule, time, "waits")
            case t.Started(time, run):
                change(run, rule, time, "rule")
            case t.Settled(time, run):
                change(run, rule, time, None, "" if record.outcome == "done" else record.outcome)
            case t.GaveUp(time, activation):
                why = {"consumed": "consumed", "eliminated": "patience over", "age": "too old"}
                change(activation, rule, time, None, why.get(record.reason, ""))
            case _:
                pass
    order = {id(bar): place for place, bar in enumerate([*done, *open_.values()])}
    return sorted([*done, *open_.values()], key=lambda bar: (bar.begin, order[id(bar)]))


def groups(page: ModuleType, variable: str) -> str:
    """Draw causal groups: a band for each, its spikes in order of birth, and arrows from parents to children."""
    records = list(vars(page)[variable])
    spikes = [r for r in records if isinstance(r, t.Born) and not r.signal.startswith(("core:", "idle:"))]
    runs = {r.run: r for r in records if isinstance(r, t.Started)}
    bands = _seen(str(r.group) for r in spikes)
    top, high = 12.0, 68.0
    place: dict[int, tuple[float, float, float]] = {}
    sheet = Sheet("Causal groups", 0, top + high * len(bands) + 12)
    at, lanes = 84.0, []
    for spike in spikes:
        name = spike.signal.removesuffix(":changed")
        wide = max(width(name, 13), width(_short(spike.payload), 11)) + 26
        y = top + high * bands.index(str(spike.group)) + high / 2
        lanes.append((spike, name, wide, y))
        place[spike.spike] = (at, y, wide)
        at += wide + 40
    sheet.wide = at
    for number, _ in enumerate(bands):
        sheet.box(12, top + high * number + 6, at - 24, high - 12, "band", 10)
        sheet.text(24, top + high * number + high / 2 + 4, f"group {number + 1}", "tiny", "start")
    for spike, name, wide, y in lanes:
        x = place[spike.spike][0]
        for parent in spike.parents:
            if parent in place:
                px, py, pw = place[parent]
                if py != y:
                    sheet.line(f"M{px + pw:.1f} {py:.1f}L{x - 2:.1f} {y:.1f}")
                    continue
                near = min((p for p in place if place[p][1] == y and place[p][0] > px), key=lambda p: place[p][0])
                if near == spike.spike:
                    sheet.line(f"M{px + pw:.1f} {py:.1f}H{x - 2:.1f}")
                else:
                    sheet.line(f"M{px + pw / 2 + 10:.1f} {py + 20:.1f}C{px + pw / 2 + 40:.1f} {py + 42:.1f} "
                               f"{x - 40:.1f} {y + 42:.1f} {x + wide / 2:.1f} {y + 22:.1f}")  # fmt: skip
        run = runs.get(spike.source)
        if run is not None and not spike.parents:
            for cause in run.spikes:
                if cause in place:
                    px, py, pw = place[cause]
                    sheet.line(f"M{px + pw / 2 + 20:.1f} {py + 20:.1f}L{x:.1f} {y - 21:.1f}", "dotted")
        sheet.box(x, y - 19, wide, 38, "signal", 17)
        payload = _short(spike.payload)
        sheet.text(x + wide / 2, y - 2 if payload else y + 5, name)
        if payload:
            sheet.text(x + wide / 2, y + 12, payload, "tiny")
    return sheet.svg()


def _short(payload: object) -> str:
    return "" if payload is None else f"“{payload}”"


# ------------------------------------------------------------------------------------------ by hand


def life() -> str:
    """Draw the life of an activation."""
    sheet = Sheet("The life of an activation: from a spike to an outcome", 940, 436)
    y = 120
    sheet.state(90, y, 132, "Stand-by", ["holds nothing;", "there is always one"], "plain")
    sheet.state(300, y, 142, "Gathering", ["holds some spikes,", "lacks others"], "holds")
    sheet.state(500, y, 128, "Ready", ["holds all of them,", "old enough"], "plain")
    sheet.state(690, y, 122, "Running", ["its slots are taken", "in its groups"], "rule")
    sheet.state(862, y, 116, "Ended", ["with an outcome"], "plain")
    sheet.state(500, 275, 160, "Waiting", ["a slot is taken, or", "a better rule may come"], "waits")
    for begin, end, words in ((156, 229, "a spike"), (371, 436, "all met"), (564, 629, "consent"), (751, 804, "returns")):  # fmt: skip
        sheet.line(f"M{begin} {y}H{end - 2}")
        sheet.text((begin + end) / 2 - 1, y - 9, words, "tiny")
    sheet.line("M480 151V242")
    sheet.text(472, 200, "refused", "tiny", "end")
    sheet.line("M520 244V153")
    sheet.text(528, 200, "asked again", "tiny", "start")
    sheet.line("M580 290C660 300 690 240 690 153")
    sheet.text(690, 250, "consent", "tiny", "start")
    sheet.line("M300 90C300 40 90 40 90 87")
    sheet.text(195, 44, "too old · patience over", "tiny")
    sheet.line("M420 290C250 310 110 270 90 153")
    sheet.text(250, 312, "another rule has answered: consumed", "tiny")
    sheet.box(508, 336, 424, 86, "band", 10)
    for row, (name, words) in enumerate((
        ("Done", "its spikes are consumed for its slots: no other rule answers"),
        ("Resign", "its slots are free again: the next best rule may run"),
        ("Error", "as Resign if it has written nothing, else as Done"),
        ("Retire", "as Done, and the rule leaves the context"),
    )):  # fmt: skip
        sheet.text(524, 356 + 19 * row, name, "small name", "start")
        sheet.text(578, 356 + 19 * row, words, "small", "start")
    sheet.line("M862 146V334", "dotted")
    return sheet.svg()


def instant() -> str:
    """Draw the waves in which the engine settles an instant."""
    sheet = Sheet("How an instant is settled: three waves", 900, 236)
    y = 96
    sheet.state(98, y, 172, "Something happens", ["an input, a deadline,", "a rule that ends"], "signal")
    sheet.state(320, y, 176, "1  Free rules start", ["that write nothing,", "and so exclude no rule"], "rule")
    sheet.state(560, y, 190, "2  Writers ask", ["for consent, the greatest", "effective utility first"], "waits")
    sheet.state(814, y, 168, "3  Flags settle", ["core:pressure, then", "core:activity"], "slot")
    for begin, end in ((184, 232), (408, 465), (655, 730)):
        sheet.line(f"M{begin} {y}H{end - 2}")
    sheet.text(436, y - 9, "none left", "tiny")
    sheet.text(692, y - 9, "no consent", "tiny")
    sheet.line("M540 128C540 186 350 186 340 129")
    sheet.text(442, 156, "a rule that starts may cause more", "tiny")
    sheet.line("M814 128C814 232 320 232 310 129")
    sheet.text(610, 224, "a flag has changed: start again", "tiny")
    sheet.text(790, 48, "nothing changed: time may pass", "tiny")
    return sheet.svg()


# --------------------------------------------------------------------------------------------- main


def stale() -> list[str]:
    """Return the names of the pictures that are missing, out of date or no longer drawn."""
    made = pictures()
    kept = {file.name for file in FOLDER.glob("*.svg")}
    return sorted(
        {n for n, text in made.items() if n not in kept or (FOLDER / n).read_text(encoding="utf-8") != text}
        | (kept - made.keys())
    )


def main(arguments: Sequence[str]) -> int:
    """Write the pictures, or check them; return the exit code."""
    parser = argparse.ArgumentParser(description="Draw the pictures of README.md and docs/.")
    parser.add_argument("--check", action="store_true", help="write nothing; exit code 1 if a picture is out of date")
    if parser.parse_args(arguments).check:
        names = stale()
        print("\n".join(f"docs/pictures/{name} is not up to date" for name in names), end="\n" if names else "")
        return 1 if names else 0
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name, text in pictures().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
