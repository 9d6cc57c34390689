"""Laws of sums, units and dates. The quality set ``sums_rows`` measures how many wordings are understood."""

import contextlib
import operator
from collections.abc import Callable
from datetime import date, time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from ravestate.modules.skill.genqa.reckoning import LONGEST, Unanswerable, dates_in, focused, measured, reckon, scaled

TODAY = date(2026, 6, 1)

numbers = st.integers(1, 900)
days = st.dates(date(1800, 1, 1), date(2099, 12, 31))
moments = st.times().map(lambda moment: moment.replace(second=0, microsecond=0))
words = st.sampled_from(
    ["how many", "7", "0", "percent of", "plus", "times", "that", "in feet", "kg", "euros", "until", "noon"]
)


@given(numbers, numbers, st.sampled_from([("plus", operator.add), ("minus", operator.sub), ("times", operator.mul)]))
def test_two_numbers_are_calculated_exactly(
    first: int, second: int, sign: tuple[str, Callable[[int, int], int]]
) -> None:
    word, calculate = sign
    assert reckon(f"what is {first} {word} {second}?", (), TODAY) == f"That is {calculate(first, second):,}."
    assert (
        reckon(f"{first} {word} that", [f"It has {second} steps."], TODAY) == f"That is {calculate(first, second):,}."
    )


@given(numbers, st.sampled_from([("feet", "cm", 30.48), ("hours", "seconds", 3600), ("mph", "km/h", 1.609344)]))
def test_a_unit_is_converted_by_its_factor(number: int, units: tuple[str, str, float]) -> None:
    unit, wanted, factor = units
    for text, told in ((f"{number} {unit} in {wanted}", ()), (f"how much is that in {wanted}?", [f"{number} {unit}."])):
        (result,) = measured(reckon(text, told, TODAY))
        assert result.value == pytest.approx(number * factor, rel=0.005)
        assert result.unit == measured(f"1 {wanted}")[0].unit


@given(days, days)
def test_the_days_between_two_dates_are_counted(one: date, other: date) -> None:
    first, last = (f"{day.day} {day:%B %Y}" for day in (one, other))
    count = abs(other - one).days
    said = reckon(f"how many days between {first} and {last}", (), TODAY)
    assert said.endswith(f" it is {count:,} day{'s' * (count != 1)}.")
    assert reckon(f"what weekday was {first}", (), TODAY) == f"{first} {'was' if one < TODAY else 'is'} a {one:%A}."


@given(moments, moments)
def test_the_time_until_a_time_of_day_is_calculated(now: time, then: time) -> None:
    """Three o'clock can be in the morning or in the afternoon: the next one counts."""
    clock = 12 if 1 <= then.hour <= 12 else 24
    minutes = (60 * (then.hour - now.hour) + then.minute - now.minute) % (60 * clock)
    text = f"how many minutes until {then:%H:%M}?"
    said = f"That is {minutes} minute{'s' * (minutes != 1)}." if minutes else "That is right now."
    assert reckon(text, (), TODAY, now=now) == said
    assert not reckon(text, (), TODAY)


@given(st.integers(1, 900), st.integers(1, 20), st.integers(1, 20))
def test_an_amount_is_scaled_to_another_number_of_people(amount: int, few: int, many: int) -> None:
    (result,) = measured(scaled(f"{amount} g rice for {few}, and for {many}?"))
    assert result.value == pytest.approx(amount * many / few, rel=0.005)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("5 kg in metres", "measure different things"),
        ("10**10**10", "too large"),
        ("9999999 to the power of 99999", "too large"),
        ("7 divided by 0", "zero"),
        ("square root of -4", "no real root"),
        ("100 euros in dollars", "no exchange rates"),
        ("1 january 9999 plus 10 years", ""),
    ],
)
def test_a_sum_without_a_result_is_refused_with_a_reason(text: str, why: str) -> None:
    if why:
        with pytest.raises(Unanswerable, match=why):
            reckon(text, (), TODAY)
    else:
        assert reckon(text, (), TODAY) == ""


@pytest.mark.parametrize("text", ["", "__import__('os').system('ls')", "1 + " * 10_000, "1+" * LONGEST + "1"])
def test_code_and_very_long_texts_are_not_calculated(text: str) -> None:
    assert reckon(text, (), TODAY) == ""


@given(st.text(max_size=40) | st.lists(words, max_size=8).map(" ".join))
def test_any_text_is_calculated_refused_or_left_to_others(text: str) -> None:
    with contextlib.suppress(Unanswerable):
        said = reckon(text, ["It weighs 3 kilograms."], TODAY, now=time(14, 50))
        assert not said or said.endswith(".")
    assert len(scaled(text)) < 100


def test_the_days_between_two_years_are_not_counted_without_exact_dates() -> None:
    with pytest.raises(Unanswerable, match="only know the years"):
        reckon("how many days is that", ["born in 1849", "died in 1903"], TODAY)


def test_money_is_exchanged_at_given_rates() -> None:
    assert reckon("100 euros in dollars", (), TODAY, {"euro": 1.0, "dollar": 0.8}) == "That is 125 dollars."


def test_numbers_with_units_come_before_numbers_without_units() -> None:
    assert [(q.value, q.unit) for q in measured("In 1902 the mountain, 4,210 metres high, cost 9 euros.")] == [
        (4210, "metre"), (9, "money:euro"), (1902, ""),
    ]  # fmt: skip


def test_numbers_of_an_earlier_text_come_last() -> None:
    assert [(q.value, q.unit) for q in measured("It is 3 or 4 metres.", after="It costs 9 euros.")] == [
        (4, "metre"), (3, ""), (9, "money:euro"),
    ]  # fmt: skip


def test_each_date_says_whether_it_is_exact_and_has_a_year() -> None:
    assert [(each.exact, each.has_year, str(each)) for each in dates_in("from 3 May to June 2024, or 1989")] == [
        (True, False, "3 May 2000"), (False, True, "2024"), (False, True, "1989"),
    ]  # fmt: skip


def test_the_question_decides_which_number_of_an_answer_counts() -> None:
    answer = "The bridge is 512 metres long and 63 metres high."
    assert measured(focused("How high is the bridge?", answer))[0].value == 63
    assert measured(focused("How long is the bridge?", answer))[0].value == 512
