"""Sums, units and dates are calculated safely, or refused with a reason."""

from datetime import date, time

import pytest

from ravestate.modules.skill.genqa.reckoning import LONGEST, Unanswerable, dates_in, focused, measured, reckon, scaled

TODAY = date(2026, 6, 1)


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("what is 17 percent of 80", "13.6"),
        ("seventeen percent of eighty", "13.6"),
        ("12 times 12", "144"),
        ("what is 2 plus 2 times 3?", "8"),
        ("(3+4)*2", "14"),
        ("square root of 144", "12"),
        ("what is 1.5 million divided by 3", "500,000"),
        ("add 17 and 25", "42"),
        ("-5 plus 3", "-2"),
        ("5 feet in cm", "152.4 cm"),
        ("how many cm are 5 feet", "152.4 cm"),
        ("5 feet 10 inches in cm", "177.8 cm"),
        ("how many seconds are in an hour", "3,600 seconds"),
        ("what is 20 degrees celsius in fahrenheit", "68 fahrenheit"),
        ("60 mph in km/h", "96.6 km/h"),
        ("how much is 240 a month in a year?", "2,880"),
        ("322 in dozens", "26.8 dozens"),
        ("Turn 25 kN into kilograms-force", "2,549 kilograms-force"),
        ("what is 2.5 bar in psi", "36.3 psi"),
        ("how many pascals are in 3 millibars", "300 pascals"),
        ("150 hp in kilowatts", "112 kilowatts"),
        ("7 percent of 1300, and half of that", "91. That is 45.5"),
        ("what date is 90 days after 1 March 2024", "30 May 2024"),
    ],
)
def test_a_sum_gets_its_result(text: str, result: str) -> None:
    assert reckon(text, (), TODAY) == f"That is {result}."


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("how many days between 3 May and 1 June 2024", "From 3 May 2024 to 1 June 2024 it is 29 days."),
        ("how many years are between 1914 and 1918", "From 1914 to 1918 it is 4 years."),
        ("what weekday was 9 November 1989", "9 November 1989 was a Thursday."),
        ("how long ago was 1989", "From 1989 to 2026 it is 37 years."),
        ("how many days until 24 june", "From 1 June 2026 to 24 June 2026 it is 23 days."),
    ],
)
def test_questions_about_dates_and_days_get_their_result(text: str, result: str) -> None:
    assert reckon(text, (), TODAY) == result


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("how many minutes till half past three", "40 minutes"),
        ("how many minutes until a quarter to four?", "55 minutes"),
        ("how long is it until 18:30", "3 hours and 40 minutes"),
        ("how long till 5 pm", "2 hours and 10 minutes"),
        ("how long do we have till noon", "21 hours and 10 minutes"),
        ("how many minutes to twenty past two", "690 minutes"),
        ("how long until ten to three", "right now"),
    ],
)
def test_the_time_until_a_time_of_day_is_calculated(text: str, result: str) -> None:
    assert reckon(text, (), TODAY, now=time(14, 50)) == f"That is {result}."
    assert not reckon(text, (), TODAY)


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


@pytest.mark.parametrize(
    "text",
    [
        "what is the capital of Peru", "how many people live in Peru", "I am 5 feet tall", "call me at 555 1234",
        "what is 5 plus apples", "__import__('os').system('ls')", "what happened in 1989", "1989", "what is 7", "",
        "how many legs do 5 spiders have", "18 plus that", "what day is it", "1 + " * 10_000, "we won 3 - 1", "2/10", "what is 12 plus 3 and 4",
        "how many days of rain were there between May 2020 and June 2021",
    ],
)  # fmt: skip
def test_other_texts_are_not_taken_for_sums(text: str) -> None:
    assert reckon(text, (), TODAY) == ""


@pytest.mark.parametrize(
    ("text", "told", "result"),
    [
        ("18 plus that", ["144."], "That is 162."),
        ("how much is that in feet", ["Mount Kesh is 4,210 metres high."], "That is 13,812 feet."),
        ("in pounds?", ["The lamp weighs 3 kilograms."], "That is 6.61 pounds."),
        ("what weekday was that", ["She sank on 14 June 1891."], "14 June 1891 was a Sunday."),
        ("how many years is that", ["born on 12 March 1856", "died on 2 October 1929"],
         "From 12 March 1856 to 2 October 1929 it is 73 years."),
        ("how old was he", ["born in 1849", "died in 1903"], "From 1849 to 1903 it is 54 years."),
        ("what is that", ["The Elve is 412 kilometres long."], ""),
        ("and for 5 people?", ["A ticket costs 6 euros."], "That is 30 euros."),
        ("how much for 2 adults and 3 children?", ["It is 6 euros for adults and 3 euros for children."], "That is 21 euros."),
        ("what's that in mph?", ["It runs at 50 kilometres per hour."], "That is 31.1 mph."),
        ("how old is it?", ["It was opened in 1874."], "From 1874 to 2026 it is 152 years."),
        ("in what year?", ["The lamp weighs 3 kilograms."], ""),
    ],
)  # fmt: skip
def test_a_pronoun_stands_for_a_number_or_a_date_in_the_last_answers(text: str, told: list[str], result: str) -> None:
    assert reckon(text, told, TODAY) == result


def test_the_days_between_two_years_are_not_counted_without_exact_dates() -> None:
    with pytest.raises(Unanswerable, match="only know the years"):
        reckon("how many days is that", ["born in 1849", "died in 1903"], TODAY)


def test_money_is_exchanged_at_given_rates() -> None:
    assert reckon("100 euros in dollars", (), TODAY, {"euro": 1.0, "dollar": 0.8}) == "That is 125 dollars."


def test_numbers_with_units_come_before_numbers_without_units() -> None:
    assert [(q.value, q.unit) for q in measured("In 1902 the mountain, 4,210 metres high, cost 9 euros.")] == [
        (4210, "metre"), (9, "money:euro"), (1902, ""),
    ]  # fmt: skip


def test_each_date_says_whether_it_is_exact_and_has_a_year() -> None:
    assert [(each.exact, each.has_year, str(each)) for each in dates_in("from 3 May to June 2024, or 1989")] == [
        (True, False, "3 May 2000"), (False, True, "2024"), (False, True, "1989"),
    ]  # fmt: skip


def test_the_question_decides_which_number_of_an_answer_counts() -> None:
    answer = "The bridge is 512 metres long and 63 metres high."
    assert measured(focused("How high is the bridge?", answer))[0].value == 63
    assert measured(focused("How long is the bridge?", answer))[0].value == 512


def test_a_very_long_text_is_not_taken_for_a_sum() -> None:
    assert reckon("1+" * LONGEST + "1", (), TODAY) == ""


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("the stew for 3 takes 450 g beans, and I cook for 8", "That is 1,200 g."),
        ("90 ml oil for 6, what for 4?", "That is 60 ml."),
        ("5 eggs for 2 people, how many for 6 people", "That is 15 eggs."),
        ("the room was 80 euros for 2 and we stayed for 3 nights", ""),
        ("for 4", ""),
        ("300 g for 0, and for 5", ""),
    ],
)
def test_an_amount_is_scaled_to_another_number_of_people(text: str, result: str) -> None:
    assert scaled(text) == result
