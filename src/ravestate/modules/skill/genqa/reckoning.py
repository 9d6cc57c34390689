"""Work out sums, units and dates with simpleeval, pint and dateutil; words such as *that* refer to earlier answers."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date, datetime, time
from functools import cache
from typing import Any

from .lexicon import lexicon, variants_of

LONGEST = 200
"""The maximum number of characters of a sum."""
DIGITS = 30
"""The maximum number of digits of a result."""
_MONEY = "money:"
_TOKEN = re.compile(r"\d[\d,]*(?:\.\d+)?|[^\W\d_]+|[^\w\s]")
_MONTHS = "jan|feb|mar|apr|may|jun|jul|aug|sep|oct|nov|dec"
_DATE = re.compile(
    rf"\b(?:\d{{1,2}}(?:st|nd|rd|th)? (?:of )?(?:{_MONTHS})[a-z]*\.?,?(?: \d{{4}})?|\d{{4}}-\d{{1,2}}-\d{{1,2}}|"
    rf"\d{{1,2}}[./]\d{{1,2}}[./]\d{{4}}|(?:{_MONTHS})[a-z]*\.? \d{{1,2}}(?:st|nd|rd|th)?\b,?(?: \d{{4}})?|"
    rf"(?:{_MONTHS})[a-z]*\.? \d{{4}}|(?<![\d.,])(?:1\d{{3}}|20\d\d)(?![\d,%]))\b"
)


_UNTIL = re.compile(
    r"(?:and |so |okay |ok )?how (?:many (?P<unit>minutes|hours)|much time|long)"
    r"(?: (?:more|is|it|there|are|left|still|do|i|we|have|got|to go))* (?:until|till|til|to|before) "
    r"(?:(?:a )?(?P<part>half|quarter|\d{1,2})(?: minutes?)? (?P<side>past|after|to|before) )?"
    r"(?:(?P<hour>\d{1,2})(?:[:.](?P<minute>[0-5]\d))?(?: ?(?P<half>[ap])\.?m\.?| o'?clock)?|(?P<name>noon|midday|midnight))"
)
_HEADS = r"(?: (?:people|persons|guests|friends|servings|portions|of us))?"
_SCALED = (
    re.compile(
        rf"(?:.*\D)?\bfor (?P<few>\d+){_HEADS}\b(?P<rest>\D*?) (?P<amount>\d[\d.,]*) ?(?P<word>[a-z]+)\b\D*\bfor (?P<many>\d+){_HEADS}"
    ),
    re.compile(
        rf"\D*\b(?P<amount>\d[\d.,]*) ?(?P<word>[a-z]+)\b\D*\bfor (?P<few>\d+){_HEADS}(?:\W| and| but| what| how)\D*\bfor (?P<many>\d+){_HEADS}"
    ),
)
"""Questions that give an amount for some people, and ask for the amount for others: *300 g rice for 4, and for 6?*."""
_DEFAULTS = (datetime(2000, 1, 1), datetime(2004, 3, 3))  # noqa: DTZ001


class Unanswerable(Exception):
    """A sum without a result; the message says why."""


@dataclass(frozen=True, slots=True)
class Quantity:
    """A number with a unit. `unit` is the name in pint, or "" if there is no unit."""

    value: float
    unit: str
    word: str
    """The unit as the text has it."""

    def beside(self, other: Quantity) -> tuple[float, float] | None:
        """Return the values of both quantities in the unit of this quantity; None if they measure different things."""
        if self.unit == other.unit:
            return self.value, other.value
        if not _alike(self.unit, other.unit):
            return None
        return self.value, float(_registry().Quantity(other.value, other.unit).to(self.unit).magnitude)


@dataclass(frozen=True, slots=True)
class Dated:
    """A date."""

    day: date
    exact: bool
    """Whether the day and the month are known."""
    shown: str
    """The date as the text has it."""
    has_year: bool = True

    def __str__(self) -> str:
        return f"{self.day.day} {self.day:%B %Y}" if self.exact else str(self.day.year)


def words_for(name: str) -> frozenset[str]:
    """Return a list of words from ``reckoning.yaml``."""
    return frozenset(str(lexicon("reckoning.yaml")[name]).split())


def reckon(
    text: str, told: Sequence[str], today: date, rates: Mapping[str, float] | None = None, now: time | None = None
) -> str:
    """Return a sentence with the result of a sum, or of a question about units, dates or prices; otherwise empty.

    Args:
        text: The utterance.
        told: The latest answers, oldest first; *that* refers to them.
        today: The date; *how long ago* counts from it.
        rates: Currency → its value. All values are in the same currency.
        now: The time of day; *how long till noon* counts from it, and has no result without it.

    Raises:
        Unanswerable: The sum has no result.

    Example:
        >>> reckon("what is 17 percent of 80", (), date(2026, 1, 1))
        'That is 13.6.'
        >>> reckon("how many days between 3 May and 1 June 2024", (), date(2026, 1, 1))
        'From 3 May 2024 to 1 June 2024 it is 29 days.'
    """
    if len(text) > LONGEST:
        return ""
    two = re.fullmatch(r"(.*\d.*),? and (.+ (?:that|it)\b.*)", text, re.IGNORECASE)
    if two and (first := reckon(two[1].rstrip(","), told, today, rates, now)):  # "7 percent of 1300, and half of that"
        second = reckon(two[2], (*told, first), today, rates)
        return f"{first} {second}" if second else ""
    spoken = _in_digits(text.strip(" ?!."))
    if re.fullmatch(r"\d+ ?/ ?\d+", spoken):  # a rating, or a date
        return ""
    if now and (asked := _UNTIL.fullmatch(spoken)):
        return _until(asked, now)
    return _dates(spoken, told, today) or _sum(spoken, told, rates or {}) or _times(spoken, told)


def scaled(text: str) -> str:
    """Return the amount for more or fewer people; empty if the text does not ask for it.

    Example:
        >>> scaled("300 g rice for 4, and for 6?")
        'That is 450 g.'
    """
    spoken = _in_digits(text.strip(" ?!.")) if len(text) <= LONGEST else ""
    found = next(filter(None, (pattern.fullmatch(spoken) for pattern in _SCALED)), None)
    if found is None or not int(found["few"]) or found["word"] in ("for", "and"):
        return ""
    amount = float(found["amount"].strip(",.").replace(",", "")) * int(found["many"]) / int(found["few"])
    return f"That is {_number(amount)} {found['word']}."


def _times(spoken: str, told: Sequence[str]) -> str:
    """Return the price for several people: *and for 5 people?*, *how much for 2 adults and 3 children?*."""
    counts = re.search(r"\b(?:for|of|do|does) (\d.*)$", spoken)
    several = re.findall(r"(\d+)(?: ([a-z]+))?", counts[1]) if counts and told and len(counts[1].split()) < 7 else []
    prices = [measured(focused(f"how {kind}", told[-1]))[:1] for _, kind in several]
    if not prices or not all(price and price[0].unit.startswith(_MONEY) for price in prices):
        return ""
    total = sum(int(count) * price[0].value for (count, _), price in zip(several, prices, strict=True))
    return f"That is {_number(total)} {prices[0][0].word}."


def measured(text: str, after: str = "") -> list[Quantity]:
    """Return the numbers of a text; numbers with a unit come first.

    Args:
        text: The text.
        after: An earlier text, or an empty one. Its numbers come after the numbers of `text`.
    """
    found: list[Quantity] = []
    spoken = re.sub(r"\bdegrees? (?=[cf])", "", _in_digits(text))
    for phrase, unit in lexicon("reckoning.yaml")["joined"].items():
        spoken = spoken.replace(phrase, unit)
    tokens = [*_TOKEN.findall(spoken), "", "", ""]
    for place, token in enumerate(tokens):
        if token[:1].isdigit():
            number = float(token.replace(",", ""))
            power, word = (2, tokens[place + 2]) if tokens[place + 1] == "square" else (1, tokens[place + 1])
            money = _currencies().get(tokens[place - 1] if place else "") or _currencies().get(word, "")
            unit = money if money and ("cost" in text or word not in _units()) else _units().get(word, "")
            unit = f"{unit}**2" if unit and power > 1 else unit
            found.append(Quantity(int(number) if number == int(number) else number, unit, word if unit else ""))
    found.sort(key=lambda quantity: not quantity.unit)
    return found + (measured(after) if after else [])


def focused(question: str, answer: str) -> str:
    """Return the parts of an answer, the part with most words of the question first. Words such as *the* do not count.

    Example:
        >>> focused("How high is it?", "The bridge is 512 metres long and 63 metres high.")
        '63 metres high. The bridge is 512 metres long'
    """
    words = re.findall(r"[a-z]+", question.lower())
    weights = {form: 3 if word in words[1:2] else 1 for word in reversed(words) for form in variants_of(word)}
    parts = re.split(r"[,;.] | and (?=[^,.]*\d)|\.$", answer)
    worth = {
        part: sum(weights.get(word, 0) for word in set(part.lower().split()) - words_for("plain")) for part in parts
    }
    return ". ".join(sorted(filter(None, parts), key=lambda part: -worth[part]))


def both(one: str, other: str) -> tuple[float, float, str] | None:
    """Return one number of each text in the same unit, and the word for the unit; None if no numbers are comparable."""
    pairs = ((left, left.beside(right)) for left in measured(one) for right in measured(other))
    return next(((*values, left.word) for left, values in pairs if values is not None), None)


def of_both(one: str, other: str, work_out: Callable[[float, float], float]) -> str:
    """Return the result of `work_out` for one number of each text; empty if no two numbers measure the same thing."""
    found = both(one, other)
    return "" if found is None else f"{_number(work_out(*found[:2]))} {found[2]}".strip() + "."


# ------------------------------------------------------------------------------------- sums and units


def _in_digits(text: str) -> str:
    """Return a text in lower case with its numbers in digits."""
    from text_to_num import alpha2digit  # pyright: ignore[reportMissingTypeStubs,reportUnknownVariableType]

    digits = str(alpha2digit(text.lower(), "en", 0.0)).replace(" a 1", " 1")  # pyright: ignore[reportUnknownArgumentType]
    scaled = r"(\d[\d,.]*) (10{3}|10{6}|10{9})\b"  # as in "1.5 million"
    return re.sub(scaled, lambda found: f"{float(found[1].replace(',', '')) * int(found[2]):.15g}", digits)


def _sum(spoken: str, told: Sequence[str], rates: Mapping[str, float]) -> str:
    text, words = f" {spoken} ", lexicon("reckoning.yaml")
    for pattern, instead in words["verbs"].items():
        text = re.sub(rf"(?<= ){pattern}(?= )", instead, text)
    for phrase, sign in (*words["joined"].items(), *words["operators"].items()):
        text = text.replace(f" {phrase} " if phrase[0].isalpha() else phrase, f" {sign} ")
    known = measured(told[-1], "".join(told[-2:-1])) if told else []
    tokens = _TOKEN.findall(re.sub(r"(?<=\d)\s*x\s*(?=\d)", "*", text))
    parts: list[str] = []
    units: list[str] = []
    target = word = power = ""
    for place, token in enumerate(tokens):
        before = next((t for t in reversed(tokens[:place]) if t not in ("square", "cubic", "degrees", "degree")), "")
        leading = before in ("in", "to", "into", "as", "many")
        unit = _unit(token, [*units, *(quantity.unit for quantity in known)])
        if token[0].isdigit():
            if parts and parts[-1][0].isdigit():
                return ""
            parts += ["+"] if parts and parts[-1].startswith("*u") else []  # as in "5 feet 10 inches"
            parts.append(token.replace(",", ""))
        elif token in ("square", "cubic") and place + 1 < len(tokens) and tokens[place + 1] in _units():
            power = "**2" if token == "square" else "**3"
        elif unit and (before[0:1].isdigit() or leading or (len(token) > 1 and token != "second")):
            if before[:1].isdigit() or (before in ("a", "an", "per") and target != unit):
                parts.append(f"{'' if before[:1].isdigit() else '1'}*u{len(units)}")
                units.append(unit + power)
            elif target:
                return ""
            else:
                target, word = unit + power, f"square {token}" if power else token
            power = ""
        elif token in _FUNCTIONS or token in "+-*/%()":
            parts.append(token)
        elif token in words_for("that"):
            parts.append("that")
        elif token not in ".,'?" and token not in words_for("framing"):
            return ""
    signs = any(part in "+-*/%" or part in _FUNCTIONS for part in parts)
    numbers = any(part[0].isdigit() for part in parts)
    if not (target or signs) or not (parts or known):
        return ""
    if "that" in parts and numbers and not signs:
        parts.remove("that")
    elif (not numbers or (known and parts[0] in "+*/-" and not units)) and "that" not in parts:
        parts.insert(0, "that")
    if "that" in parts:
        fitting = [quantity for quantity in known if not target or _alike(quantity.unit, target)]
        if not fitting:
            return ""
        units.append(fitting[0].unit)
        value = f"({fitting[0].value!r}*u{len(units) - 1})"
        parts = [part for place, part in enumerate(parts) if part != "that" or "that" not in parts[:place]]
        parts = [value if part == "that" else part for part in parts]
    result = _result("".join(parts), units, target, word, rates)
    return f"That is {result}." if result else ""


def _result(source: str, units: Sequence[str], target: str, word: str, rates: Mapping[str, float]) -> str:
    """Return the value of an expression in its target unit."""
    money = {unit.removeprefix(_MONEY) for unit in (*units, target) if unit.startswith(_MONEY)}
    if len(money) > 1 and not money <= rates.keys():
        raise Unanswerable("I know no exchange rates, so I can't work that out.")
    goal = target or next((unit for unit in units if unit), "")
    try:
        value = _evaluated(
            re.sub(r"(sqrt|cbrt)(-?\d[\d.]*)", r"\1(\2)", source), [_in_pint(unit, rates) for unit in units]
        )
        if not goal:
            return _number(value)
        if not hasattr(value, "to") or (not target and value.dimensionless):
            value = _registry().Quantity(value).to("")
            if target not in ("", "dozen"):
                return ""
            if not target:
                return _number(value.magnitude)
        unit = _in_pint(goal, rates)
        value = (value / unit).to("") if money else value.to(unit)
        return f"{_number(value.magnitude, rounded=bool(target) and not money)} {lexicon('reckoning.yaml')['shown'].get(word, word) or goal.removeprefix(_MONEY) + 's'}"
    except ZeroDivisionError:
        raise Unanswerable("Nothing can be divided by zero.") from None
    except OverflowError:
        raise Unanswerable("That number is too large for me.") from None
    except ValueError:
        raise Unanswerable("A negative number has no real root.") from None
    except Exception as error:  # simpleeval and pint have many kinds of errors
        if type(error).__name__ != "DimensionalityError":
            return ""
        raise Unanswerable("These measure different things, so I can't turn one into the other.") from None


def _evaluated(source: str, units: Sequence[Any]) -> Any:
    from simpleeval import SimpleEval  # pyright: ignore[reportMissingTypeStubs]

    names = {f"u{place}": unit for place, unit in enumerate(units)}
    if (heat := re.fullmatch(r"\(?(-?[\d.]+)\*(u\d)\)?", source)) and not names[heat[2]]._is_multiplicative:
        return _registry().Quantity(float(heat[1]), names[heat[2]].units)  # 20 degrees, not 20 times one degree
    return SimpleEval(operators=_OPERATORS, functions=_FUNCTIONS, names=names).eval(source)  # pyright: ignore[reportUnknownMemberType,reportUnknownVariableType]


def _power(base: Any, exponent: Any) -> Any:
    if isinstance(base, int | float) and base and abs(exponent) * abs(math.log10(abs(base))) > DIGITS:
        raise OverflowError
    return base**exponent


def _divided(one: Any, other: Any) -> Any:
    return one / other


_FUNCTIONS: dict[str, Callable[..., Any]] = {"sqrt": math.sqrt, "cbrt": math.cbrt, "abs": abs}
_OPERATORS: dict[type, Callable[..., Any]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Pow: _power, ast.Mod: operator.mod,
    ast.Div: _divided, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip


@cache
def _registry() -> Any:
    import pint

    make: Any = pint.UnitRegistry
    registry: Any = make(autoconvert_offset_to_baseunit=True)
    registry.define("money = [money]")
    registry.define("dozen = 12")
    return registry


def _in_pint(unit: str, rates: Mapping[str, float]) -> Any:
    """Return one of a unit, such as one metre, as a quantity of pint."""
    if unit.startswith(_MONEY):
        return rates.get(unit.removeprefix(_MONEY), 1.0) * _registry().money
    return _registry().Quantity(1, unit) if unit else 1


def _alike(one: str, other: str) -> bool:
    if one.startswith(_MONEY) or other.startswith(_MONEY):
        return one.startswith(_MONEY) and other.startswith(_MONEY)
    return bool(one and other) and bool(_registry().Unit(one).is_compatible_with(_registry().Unit(other)))


@cache
def _units() -> dict[str, str]:
    table: dict[str, str] = lexicon("reckoning.yaml")["units"]
    return {word: name for name, words in table.items() for word in (name, *words.split())}


@cache
def _currencies() -> dict[str, str]:
    table: dict[str, str] = lexicon("reckoning.yaml")["currencies"]
    return {word: _MONEY + name for name, words in table.items() for word in (name, *words.split())}


def _unit(word: str, others: Sequence[str]) -> str:
    """Return the unit that a word stands for. Beside another currency, *pounds* are money, not a weight."""
    money = any(unit.startswith(_MONEY) for unit in others)
    return _currencies()[word] if word in _currencies() and (money or word not in _units()) else _units().get(word, "")


def _number(value: Any, *, rounded: bool = False) -> str:
    """Return a number in digits, without needless digits; if `rounded`, as people would say it."""
    if not math.isfinite(value) or abs(value) >= 10**DIGITS:
        raise OverflowError
    if not isinstance(value, int):
        size = abs(value)
        places = 3 if not rounded else 0 if size >= 100 else 1 if size >= 10 else 2
        exact = round(value, 1)
        value = exact if abs(value - exact) < 1e-9 else round(value, places) if size >= 1 else float(f"{value:.3g}")
    return f"{int(value):,}" if value == int(value) else f"{value:,}"


# ---------------------------------------------------------------------------------------------- dates


def dates_in(text: str) -> list[Dated]:
    """Return the dates of a text, in order."""
    from dateutil.parser import ParserError, parse

    found: list[Dated] = []
    for match in _DATE.finditer(text.lower()):
        try:  # the default supplies the parts that the text lacks
            one, other = (parse(match[0], default=default, dayfirst=True) for default in _DEFAULTS)
        except (ParserError, OverflowError, ValueError):
            continue
        exact = one.day == other.day and one.month == other.month
        found.append(Dated(one.date(), exact, match[0], one.year == other.year))
    return found


def _dates(spoken: str, told: Sequence[str], today: date) -> str:
    dates = dates_in(spoken)
    words = set(re.findall(r"[a-z]+", spoken))
    months = {word for word in words if word[:3] in _MONTHS.split("|")}
    if words - months - words_for("framing") - words_for("dating"):
        return ""
    unit = next((name for name in ("day", "week", "month", "year") if words & {name, f"{name}s"}), "")
    weekday = "weekday" in words or ("day" in words and bool(words & {"what", "which"}))
    refers = bool(words & {"that", "this", "them", "was", "did"} or (words & {"it", "old"} and not weekday))
    if not dates and refers and told and not (weekday and "today" in words):
        dates = [day for text in told[-2:] for day in dates_in(text)[:2]][-1 if weekday or "ago" in words else -2 :]
    if "old" in words and "is" in words and len(dates) == 1 and "die" not in told[-1]:
        words.add("ago")
    elif not dates or ("old" in words and len(dates) < 2):
        return ""
    year = next((each.day.year for each in reversed(dates) if each.has_year), today.year)
    dates = [each if each.has_year else replace(each, day=each.day.replace(year=year)) for each in dates]
    if weekday and dates[-1].exact:
        return f"{dates[-1]} {'was' if dates[-1].day < today else 'is'} a {dates[-1].day:%A}."
    shift = next((q for q in measured(_DATE.sub("", spoken)) if q.unit in ("day", "week", "month", "year")), None)
    if shift is not None and len(dates) == 1 and dates[0].exact and words & words_for("shifting"):
        return _moved(dates[0], shift, back=bool(words & {"before", "earlier"}))
    if len(dates) == 1 and words & {"ago", "until", "since", "till"}:
        dates.append(Dated(today, dates[0].exact, ""))
    if len(dates) < 2 or not (unit or words & {"old", "long", "ago", "between", "time"}):
        return ""
    return apart(dates[0], dates[1], unit or ("year" if "old" in words else ""))


def apart(one: Dated, other: Dated, unit: str = "year") -> str:
    """Return the time between two dates in words.

    Args:
        one: A date.
        other: The other date, earlier or later.
        unit: day, week, month or year; if it is empty, day for less than 100 days, and year for more.

    Raises:
        Unanswerable: The unit is smaller than a year, and only the year of a date is known.
    """
    from dateutil.relativedelta import relativedelta

    first, last = sorted((one, other), key=lambda each: each.day)
    exact, days = first.exact and last.exact, (last.day - first.day).days
    unit = unit or ("day" if exact and days < 100 else "year")
    if not exact and unit != "year":
        raise Unanswerable("I only know the years of that, not the days.")
    gone = relativedelta(last.day, first.day)
    years = gone.years if exact else last.day.year - first.day.year
    count = {"day": days, "week": days // 7, "month": gone.years * 12 + gone.months, "year": years}[unit]
    rest = f" and {days % 7} days" if unit == "week" and days % 7 else ""
    return f"From {first} to {last} it is {count:,} {unit}{'' if count == 1 else 's'}{rest}."


def _until(asked: re.Match[str], now: time) -> str:
    """Return the minutes or hours until a time of day. Without *am* or *pm*, take the next time that fits."""
    hour = int(asked["hour"] or (0 if asked["name"] == "midnight" else 12))
    if hour > 24:
        return ""
    if asked["half"]:
        hour = hour % 12 + 12 * (asked["half"] == "p")
    part = int({"half": "30", "quarter": "15", None: "0"}.get(asked["part"], asked["part"]))
    then = 60 * hour + int(asked["minute"] or 0) + part * (1 if asked["side"] in ("past", "after") else -1)
    round_the_clock = 60 * (24 if asked["half"] or asked["name"] or hour not in range(1, 13) else 12)
    left = (then - 60 * now.hour - now.minute) % round_the_clock
    hours, minutes = (0, left) if asked["unit"] == "minutes" else divmod(left, 60)
    counts = {"hour": hours, "minute": minutes}
    parts = [f"{count} {noun}{'' if count == 1 else 's'}" for noun, count in counts.items() if count]
    return f"That is {' and '.join(parts) or 'right now'}."


def _moved(start: Dated, by: Quantity, *, back: bool) -> str:
    from dateutil.relativedelta import relativedelta

    parts: dict[str, Any] = {f"{by.unit}s": int(-by.value if back else by.value)}
    try:
        return f"That is {replace(start, day=start.day + relativedelta(**parts))}."
    except (OverflowError, ValueError):
        raise Unanswerable("That is beyond the calendar.") from None
