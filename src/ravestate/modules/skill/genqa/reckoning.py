"""Sums, units and dates, worked out by simpleeval, pint and dateutil; words such as *that* refer to the thread."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from datetime import date, datetime, timedelta
from functools import cache
from importlib.resources import files
from typing import Any

from ravestate.yaml_text import load_yaml

LONGEST = 200
"""Characters of a sum."""
DIGITS = 30
"""The maximum number of digits of a result."""
_TOKEN = re.compile(r"\d[\d,]*(?:\.\d+)?|[^\W\d_]+|[^\w\s]")
_CURRENCY = "currency:"
_SHOWN = {"kmh": "km/h", "mps": "m/s"}


class Unanswerable(Exception):
    """A sum without a result; the message says why."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with its unit, in pint's name; empty for none."""

    value: float
    unit: str
    shown: str
    """As written."""

    def beside(self, other: Quantity) -> tuple[float, float] | None:
        """Return both values in the same unit; None if they measure different things."""
        if not self.unit and not other.unit:
            return self.value, other.value
        if not self.unit or not other.unit or not _alike(self.unit, other.unit):
            return None
        if self.unit == other.unit:
            return self.value, other.value
        registry = _registry()
        return self.value, float(registry.Quantity(other.value, other.unit).to(self.unit).magnitude)


@dataclass(frozen=True, slots=True)
class Dated:
    """A date; without a day and a month only the year counts."""

    day: date
    exact: bool
    has_year: bool = True
    shown: str = ""


@cache
def vocabulary() -> dict[str, Any]:
    """Return the file ``reckoning.yaml``."""
    return load_yaml((files(__package__ or "") / "reckoning.yaml").read_text(encoding="utf-8"), "reckoning.yaml")


@cache
def _units() -> dict[str, str]:
    found: dict[str, str] = {}
    for name, words in vocabulary()["units"].items():
        found.update(dict.fromkeys((*str(words).split(), name), name))
    return found


@cache
def _currencies() -> dict[str, str]:
    found: dict[str, str] = {}
    for name, words in vocabulary()["currencies"].items():
        found.update(dict.fromkeys((*str(words).split(), name), _CURRENCY + name))
    return found


def reckon(text: str, told: Sequence[str], today: date, rates: Mapping[str, float] | None = None) -> str:
    """Return the result of a sum in words; empty if the text is none.

    Args:
        text: The utterance.
        told: The latest answers, oldest first, for *that*.
        today: The date, for *how long ago*.
        rates: The value of one unit of each currency, in any common unit.

    Raises:
        Unanswerable: It is a sum without a result.

    Example:
        >>> reckon("what is 17 percent of 80", (), date(2026, 1, 1))
        '17 percent of 80 is 13.6.'
        >>> reckon("how many days between 3 May and 1 June 2024", (), date(2026, 1, 1))
        'From 3 May 2024 to 1 June 2024 it is 29 days.'
    """
    if len(text) > LONGEST:
        return ""
    spoken = _in_digits(text.strip(" ?!.").lower())
    return _dates(spoken, told, today) or _sum(spoken, told, rates or {})


def _in_digits(text: str) -> str:
    from text_to_num import alpha2digit

    digits: str = alpha2digit(text, "en", 0.0).replace(" a 1", " 1")
    return re.sub(
        r"(\d[\d,.]*) (10{3}|10{6}|10{9})\b",
        lambda found: f"{float(found[1].replace(',', '')) * int(found[2]):.15g}",
        digits,
    )


# ------------------------------------------------------------------------------------- sums and units


def _sum(spoken: str, told: Sequence[str], rates: Mapping[str, float]) -> str:
    text = f" {spoken} "
    for pattern, sum_ in vocabulary()["verbs"].items():
        text = re.sub(rf"(?<= ){pattern}(?= )", sum_, text)
    for phrase, word in vocabulary()["joined"].items():
        text = text.replace(f" {phrase} ", f" {word} ").replace(f"{phrase} ", f"{word} ")
    for phrase, sign in vocabulary()["operators"].items():
        letters = phrase[0].isalpha()
        text = text.replace(f" {phrase} " if letters else phrase, f" {sign} ")
    tokens = _TOKEN.findall(re.sub(r"(?<=\d)\s*x\s*(?=\d)", "*", text))
    parts: list[str] = []
    units: list[str] = []
    target, target_word, shown, that, squared = "", "", list[str](), False, ""
    for place, token in enumerate(tokens):
        before = tokens[place - 1] if place else ""
        after = tokens[place + 1] if place + 1 < len(tokens) else ""
        unit = _unit(token, [*units, *(q.unit for q in _quantities(told))])
        if token[0].isdigit():
            parts.append(token.replace(",", ""))
        elif token in ("square", "cubic") and after in _units():
            squared = token
        elif unit and (
            (len(token) > 1 and token != "second") or before[:1].isdigit() or before in ("in", "to", "into")
        ):
            word, unit = (
                (f"{squared} {token}", f"{unit}**{2 if squared == 'square' else 3}") if squared else (token, unit)
            )
            number = tokens[place - 2] if squared and place > 1 else before
            squared = ""
            if number in ("degrees", "degree") and place > 1:
                number = tokens[place - 2]
            if not number[:1].isdigit() and before in ("in", "to", "into") and target == "":
                target, target_word = unit, word
            elif number[:1].isdigit() or (
                number in ("a", "an", "one", "per")
                and place > 1
                and tokens[place - 2] in ("in", "is", "are", "of", "to")
            ):
                parts.append(f"*u{len(units)}" if number[:1].isdigit() else f"1*u{len(units)}")
                units.append(unit)
            elif target:
                return ""
            else:
                target, target_word = unit, word
        elif token in _FUNCTIONS or not token[0].isalnum():
            if token not in "+-*/%().,'?" and token not in _FUNCTIONS:
                return ""
            if token not in ".,'?":
                parts.append(token)
        elif token in str(vocabulary()["that"]).split():
            that = True
            parts.append("that")
        elif token not in str(vocabulary()["framing"]).split():
            return ""
        shown.append(token)
    numbers = [part for part in parts if part[:1].isdigit()]
    signs = [part for part in parts if part in "+-*/%" or part in _FUNCTIONS]
    if not (target or signs or len(units) > 1) or not (numbers or that or told):
        return ""
    if not target and not signs:
        return ""
    return _worked_out(spoken, parts, units, target, target_word, told, rates, that=that, signs=bool(signs))


def _worked_out(
    spoken: str,
    parts: list[str],
    units: list[str],
    target: str,
    word: str,
    told: Sequence[str],
    rates: Mapping[str, float],
    *,
    that: bool,
    signs: bool,
) -> str:
    """Evaluate the parts; *that* is the last quantity told that fits."""
    known = _quantities(told)
    numbers = any(part[:1].isdigit() for part in parts)
    needs_that = (
        (that and (signs or not numbers)) or not numbers or (bool(known) and signs and parts[0] in "+*/-" and not units)
    )
    if not needs_that:
        parts = [part for part in parts if part != "that"]
    elif not known:
        return ""
    elif not that:
        parts = ["that", *parts]
    chosen = (
        next((q for q in known if not target or _alike(q.unit, target)), known[0] if known else None)
        if needs_that
        else None
    )
    if needs_that and chosen is not None:
        parts = [part for place, part in enumerate(parts) if part != "that" or place == parts.index("that")]
        units = [*units, chosen.unit]
        value = f"({chosen.value!r}*u{len(units) - 1})" if chosen.unit else f"({chosen.value!r})"
        parts = [value if part == "that" else part for part in parts]
    used = [unit for unit in (*units, target) if unit.startswith(_CURRENCY)]
    if used and (len(set(used)) > 1 or len({*units, target} - {""}) > 1):
        if any(unit[len(_CURRENCY) :] not in rates for unit in used):
            raise Unanswerable("I know no exchange rates, so I can't work that out.")
    source = "".join(parts)
    source = re.sub(r"(sqrt|cbrt)(-?\d[\d.]*|\([^()]*\))", r"\1(\2)", source)
    source = re.sub(r"(?<=u\d)(?=\d)", "+", source)  # 5 feet 3 inches
    result = _evaluated(source, units, rates)
    shown = _said(spoken, chosen, target, word, signs=signs)
    if not any(units):
        return f"{shown} is {_number(result)}." if not target else ""
    try:
        goal = target or next(unit for unit in units if unit)
        value = result.to(_registry_unit(goal, rates)).magnitude if hasattr(result, "to") else result
    except Exception as error:
        if type(error).__name__ == "DimensionalityError":
            raise Unanswerable(
                f"{_plain(units[-1]).capitalize()} and {_plain(target)} measure different things: I can't convert one into the other."
            ) from None
        raise
    return f"{shown} is {_number(value)} {_SHOWN.get(word, word) or _plain(goal)}."


def _said(spoken: str, that: Quantity | None, target: str, word: str, *, signs: bool) -> str:
    """Return the sum as the user said it, without the frame."""
    text = spoken
    if that is not None:
        if not signs:
            return that.shown
        found = _THAT.search(text)
        text = _THAT.sub(that.shown, text, count=1) if found else f"{that.shown} {text}"
    if target:
        text = re.sub(rf"(?:how (?:many|much) |\b(?:in|to|into|as) ){re.escape(word)}\b", " ", text)
    words = text.split()
    framing = frozenset(str(vocabulary()["framing"]).split()) - {"a", "an", "the"}
    while words and words[0] in framing:
        words = words[1:]
    while words and words[-1] in framing:
        words = words[:-1]
    text = " ".join(words)
    return text[:1].upper() + text[1:]


_THAT = re.compile(r"\b(?:that|it|this|them)\b")


def _evaluated(source: str, units: Sequence[str], rates: Mapping[str, float]) -> Any:
    from simpleeval import InvalidExpression, SimpleEval

    names = {f"u{place}": _registry_unit(unit, rates) * 1 if unit else 1 for place, unit in enumerate(units)}
    if any(unit.startswith("deg") for unit in units):
        number = re.search(r"-?\d[\d.]*", source)
        return _registry().Quantity(float(number[0]) if number else 0.0, next(u for u in units if u))
    evaluator = SimpleEval(operators=_OPERATORS, functions=_FUNCTIONS, names=names)
    try:
        return evaluator.eval(source)
    except ZeroDivisionError:
        raise Unanswerable("Nothing can be divided by zero.") from None
    except OverflowError:
        raise Unanswerable("That number is too large for me.") from None
    except (InvalidExpression, SyntaxError, TypeError, ValueError) as error:
        if type(error).__name__ == "DimensionalityError":
            raise Unanswerable("These measure different things, so they can't be added.") from None
        if isinstance(error, ValueError) and "root" in str(error):
            raise Unanswerable("A negative number has no real square root.") from None
        raise Unanswerable("") from None


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int | float) and base and abs(exponent) * max(abs(math.log10(abs(base))), 0.01) > DIGITS:
        raise OverflowError
    return base**exponent


def _root(value: float) -> float:
    if value < 0:
        raise ValueError("root of a negative number")
    return math.sqrt(value)


_FUNCTIONS: dict[str, Callable[..., Any]] = {"sqrt": _root, "cbrt": math.cbrt, "abs": abs}
_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: _power,
    ast.Mod: operator.mod, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip


@cache
def _registry() -> Any:
    import pint

    return pint.UnitRegistry(autoconvert_offset_to_baseunit=True)


def _registry_unit(unit: str, rates: Mapping[str, float]) -> Any:
    if unit.startswith(_CURRENCY):
        name = unit[len(_CURRENCY) :]
        registry = _registry()
        if "money" not in registry:
            registry.define("money = [money]")
        return registry.Unit("money") * rates.get(name, 1.0) if rates else registry.Unit("money")
    return _registry().Unit(unit)


def _alike(one: str, other: str) -> bool:
    if one.startswith(_CURRENCY) or other.startswith(_CURRENCY):
        return one.startswith(_CURRENCY) == other.startswith(_CURRENCY)
    return bool(one) and _registry().Unit(one).is_compatible_with(_registry().Unit(other))


def _unit(word: str, others: Sequence[str]) -> str:
    """Return the unit of a word; *pounds* are money beside money."""
    if word in _currencies() and (word not in _units() or any(unit.startswith(_CURRENCY) for unit in others)):
        return _currencies()[word]
    return _units().get(word, "")


def _plain(unit: str) -> str:
    return unit.replace(_CURRENCY, "").replace("**2", " squared").replace("degC", "degrees Celsius").replace(
        "degF", "degrees Fahrenheit"
    ) + ("" if unit.startswith("deg") or unit.endswith("2") else "s")


def _number(value: Any) -> str:
    """Return a number in digits, rounded to what matters."""
    if isinstance(value, int):
        if abs(value) >= 10**DIGITS:
            raise Unanswerable("That number is too large for me.")
        return f"{value:,}"
    if not math.isfinite(value) or abs(value) >= 10**DIGITS:
        raise Unanswerable("That number is too large for me.")
    rounded = round(value, 3) if abs(value) >= 1 else float(f"{value:.3g}")
    return f"{int(rounded):,}" if rounded == int(rounded) else f"{rounded:,}"


def _quantities(told: Sequence[str]) -> list[Quantity]:
    """Return the numbers of the latest answers, the last answer first; those with a unit before those without."""
    found: list[Quantity] = []
    for text in reversed(told[-2:]):
        tokens = _TOKEN.findall(_in_digits(text.lower()))
        here: list[Quantity] = []
        for place, token in enumerate(tokens):
            if not token[0].isdigit():
                continue
            after = [*tokens[place + 1 : place + 3], "", ""]
            square = after[0] == "square"
            unit = _unit(after[1] if square else after[0], [_currencies().get(tokens[place - 1], "")] if place else [])
            unit = (
                unit or (_currencies().get(tokens[place - 1], "") if place else "") or _currencies().get(after[0], "")
            )
            if after[0] in ("pounds", "pound") and "cost" in tokens:
                unit = _currencies()["pounds"]
            unit = f"{unit}**2" if square and unit else unit
            value = float(token.replace(",", ""))
            number = int(value) if value == int(value) else value
            here.append(
                Quantity(
                    number,
                    unit,
                    f"{token} {after[0]} {after[1]}" if square else f"{token} {after[0] if unit else ''}".strip(),
                )
            )
        found += sorted(here, key=lambda quantity: not quantity.unit)
    return found


def measured(text: str) -> list[Quantity]:
    """Return the numbers of a text; those with a unit before those without."""
    return _quantities((text,))


def difference(one: str, other: str, *, dates: bool = False) -> str:
    """Return how far the numbers, or dates, of two texts are apart."""
    if dates:
        return _between(*sorted((dates_in(one)[0], dates_in(other)[-1]), key=lambda each: each.day), "year")
    return _of_both(one, other, lambda first, second: abs(first - second))


def together(one: str, other: str) -> str:
    """Return the sum of the numbers of two texts."""
    return _of_both(one, other, operator.add)


def _of_both(one: str, other: str, work_out: Callable[[float, float], float]) -> str:
    for left in measured(one):
        for right in measured(other):
            if (values := left.beside(right)) is not None:
                return f"{_number(round(work_out(*values), 6))} {left.shown.partition(' ')[2]}".strip() + "."
    return ""


# ---------------------------------------------------------------------------------------------- dates


_MONTHS = tuple(["jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec"])


def dates_in(text: str) -> list[Dated]:
    """Return the dates of a text, in order."""
    return list(_found_dates(_in_digits(text.lower()) if text else ""))


def _found_dates(text: str) -> Iterator[Dated]:
    from dateutil.parser import ParserError, parse

    tokens = [token.strip(".?!()\"';:") for token in text.replace(",", " ").split()]
    place = 0
    while place < len(tokens):
        for size in (5, 4, 3, 2, 1):
            span = tokens[place : place + size]
            if len(span) < size or not _may_be_date(span):
                continue
            try:
                one, other = (
                    parse(" ".join(span), default=datetime(year, month, day), dayfirst=True)
                    for year, month, day in ((2000, 1, 1), (2004, 3, 3))
                )
            except (ParserError, OverflowError, ValueError):
                continue
            yield Dated(
                one.date(), one.day == other.day and one.month == other.month, one.year == other.year, " ".join(span)
            )
            place += size - 1
            break
        place += 1


def _may_be_date(span: Sequence[str]) -> bool:
    """Return whether words have the parts of a date: a month with a day or a year, or a year alone."""
    month = any(word.isalpha() and word[:3] in _MONTHS and len(word) < 10 for word in span)
    numbers = [word for word in span if word[:1].isdigit()]
    filler = [word for word in span if not word[:1].isdigit() and word[:3] not in _MONTHS]
    if any(word not in ("of", "the") for word in filler) or span[0] in ("of",) or span[-1] in ("of", "the"):
        return False
    if month:
        return bool(numbers) and len(numbers) <= 2 and all(len(re.sub(r"\D", "", n)) <= 4 for n in numbers)
    if len(span) != 1 or not numbers:
        return False
    return (
        re.fullmatch(r"\d{1,4}[-/.]\d{1,2}[-/.]\d{1,4}", span[0]) is not None
        or re.fullmatch(r"1\d{3}|20\d\d", span[0]) is not None
    )


def _dates(spoken: str, told: Sequence[str], today: date) -> str:
    words = set(re.findall(r"[a-z]+", spoken))
    dates = dates_in(spoken)
    refers = bool(words & {"that", "it", "this", "them"})
    unit = next((name for name in ("day", "week", "month", "year") if words & {name, f"{name}s"}), "")
    weekday = "weekday" in words or ("day" in words and ("what" in words or "which" in words) and "days" not in words)
    quantity = next((q for q in _quantities((spoken,)) if q.unit in ("day", "week", "month", "year")), None)
    age = "old" in words and not dates
    known = {*str(vocabulary()["framing"]).split(), *str(vocabulary()["dating"]).split()}
    if any(word not in known and word[:3] not in _MONTHS for word in words):
        return ""
    present = weekday and not words & {"that", "was"}  # "what day is it?"
    if not dates and (refers or age or "ago" in words) and told and "today" not in words and not present:
        dates = [day for text in told[-2:] for day in dates_in(text)[:2]]
        if age and len(dates) < 2:
            return ""
        dates = dates[-2:] if not weekday else dates[-1:]
    if not dates:
        return ""
    if len(dates) > 1:
        year = next((each.day.year for each in reversed(dates) if each.has_year), today.year)
        dates = [each if each.has_year else Dated(each.day.replace(year=year), each.exact) for each in dates]
    elif not dates[0].has_year:
        dates = [Dated(dates[0].day.replace(year=today.year), dates[0].exact)]
    if weekday and dates[-1].exact:
        return f"{_day(dates[-1])} {'was' if dates[-1].day < today else 'is'} a {dates[-1].day:%A}."
    if (
        quantity is not None
        and len(dates) == 1
        and words & {"after", "before", "from", "later", "earlier"}
        and dates[0].exact
    ):
        return _moved(dates[0], quantity, back=bool(words & {"before", "earlier"}))
    if len(dates) == 1 and (words & {"ago", "until", "since", "till"} or (refers and "ago" in words)):
        dates = [dates[0], Dated(today, dates[0].exact)]
    if len(dates) < 2 or not (unit or age or words & {"long", "ago", "between", "time"}):
        return ""
    return _between(*sorted(dates[:2], key=lambda each: each.day), unit or ("year" if age else ""))


def _between(first: Dated, last: Dated, unit: str) -> str:
    from dateutil.relativedelta import relativedelta

    apart = relativedelta(last.day, first.day)
    days = (last.day - first.day).days
    unit = unit or ("day" if first.exact and last.exact and days < 100 else "year")
    if not (first.exact and last.exact) and unit != "year":
        raise Unanswerable("I only know the years of that, not the days.")
    count = {"day": days, "week": days // 7, "month": apart.years * 12 + apart.months, "year": apart.years}[unit]
    if unit == "year" and not (first.exact and last.exact):
        count = last.day.year - first.day.year
    rest = f" and {days % 7} days" if unit == "week" and days % 7 else ""
    return f"From {_day(first)} to {_day(last)} it is {count:,} {unit}{'' if count == 1 else 's'}{rest}."


def _moved(start: Dated, quantity: Quantity, *, back: bool) -> str:
    from dateutil.relativedelta import relativedelta

    count = int(-quantity.value if back else quantity.value)
    try:
        end = start.day + (
            timedelta(days=count * (7 if quantity.unit == "week" else 1))
            if quantity.unit in ("day", "week")
            else relativedelta(**{f"{quantity.unit}s": count})
        )  # type: ignore[arg-type]
    except (OverflowError, ValueError):
        raise Unanswerable("That is beyond the calendar.") from None
    return f"That is {_day(Dated(end, exact=True))}."


def _day(each: Dated) -> str:
    return f"{each.day.day} {each.day:%B %Y}" if each.exact else str(each.day.year)
