"""Each written word gets a time, even if written words and spoken words do not correspond one to one."""

from ravestate.modules.platform.voiceio.alignment import by_phonemes, by_places, places_of


def test_the_time_of_a_word_without_an_event_is_between_those_of_its_neighbours() -> None:
    text = "there was a robot"
    words = by_places(text, [(0, 1.0), (12, 1.6)], 2.0)
    assert [text[word.begin : word.end] for word in words] == ["there", "was", "a", "robot"]
    times = [word.time for word in words]
    assert times[0] == 1.0 and times[3] == 1.6
    assert times == sorted(times) and 1.0 < times[1] < times[2] < 1.6


def test_one_spoken_word_can_consist_of_several_written_words() -> None:
    # The voice reports "there was" as one word of seven phonemes.
    words = by_phonemes("time there was a robot", [(0.0, 3), (0.4, 7), (0.9, 1), (1.0, 6)], 1.5)
    assert [round(word.time, 2) for word in words][:2] == [0.0, 0.4]
    assert [round(word.time, 2) for word in words][3:] == [0.9, 1.0]
    assert 0.4 < words[2].time < 0.9


def test_one_written_number_can_be_several_spoken_words() -> None:
    spoken = [(0.0, 2), (0.2, 3), (0.5, 6), (0.9, 4), (1.3, 5)]
    words = by_phonemes("in 1859 maybe", [*spoken[:4], (1.3, 5)], 2.0)
    assert [word.time for word in words] == [0.0, 0.2, 1.3]


def test_punctuation_marks_do_not_count_as_words() -> None:
    assert places_of("well — yes !") == [(0, 4), (7, 10)]
    assert by_phonemes("…", [], 1.0) == ()


def test_without_events_the_words_are_spread_over_the_sound() -> None:
    words = by_phonemes("one two three four", [], 2.0)
    assert [word.time for word in words] == sorted(word.time for word in words)
    assert words[-1].time < 2.0
