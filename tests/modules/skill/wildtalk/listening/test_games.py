"""Jokes, songs, stories and games."""

from collections.abc import Callable
from typing import Any

import pytest

from ravestate.modules.skill.wildtalk.listening.material import material


def shows() -> Any:
    """Return the phrases of jokes, songs, stories and games. Loading them takes a second, so not at import."""
    return material().shows


def test_there_are_enough_jokes_stories_riddles_and_songs() -> None:
    assert len(shows()["told"]["joke"]) >= 40
    assert len(shows()["told"]["story"]) >= 8
    assert len(shows()["riddles"]) >= 25
    assert len(shows()["told"]["song"]) >= 5


def test_no_joke_is_repeated_before_all_jokes_have_been_told(talk: Any) -> None:
    told = [talk.say("tell me a joke") for _ in shows()["told"]["joke"]]
    assert sorted(told) == sorted(shows()["told"]["joke"])
    assert talk.say("tell me a joke") in shows()["told"]["joke"]


@pytest.mark.parametrize(("text", "kind"), [("sing a song", "song"), ("tell me a story", "story")])
def test_the_agent_performs_on_request(text: str, kind: str, talk: Any) -> None:
    assert talk.say(text) in shows()["told"][kind]


def asked(text: str) -> Any:
    return next(riddle for riddle in shows()["riddles"] if riddle["ask"] == text)


def test_a_right_guess_solves_a_riddle(talk: Any) -> None:
    riddle = asked(talk.say("a riddle please"))
    assert riddle["answers"][0] in talk.say(f"is it a {riddle['answers'][-1]}?")
    assert asked(talk.say("yes"))["ask"] != riddle["ask"]


def test_a_wrong_guess_gets_a_hint_and_then_the_answer(talk: Any) -> None:
    riddle = asked(talk.say("riddle"))
    assert riddle["hint"] in talk.say("a banana")
    assert riddle["answers"][0] in talk.say("a teapot")
    assert talk.say("no") in shows()["play"]["over"]


def test_a_riddle_can_be_given_up(talk: Any) -> None:
    riddle = asked(talk.say("riddle"))
    assert riddle["answers"][0] in talk.say("I don't know").lower()


def test_in_word_chain_each_word_begins_with_the_last_letter_of_the_previous_word(talk: Any) -> None:
    first = talk.say("word chain").rstrip(".").split()[-1]
    nouns = (
        "arm cat duck earth frog glove horn iron king leg milk neck oven pot rain snail trunk urn wing xylophone yard"
    )
    own = next(noun for noun in nouns.split() if noun[0] == first[-1])
    answer = talk.say(own).rstrip(".!").split()[-1].lower()
    assert answer[0] == own[-1]
    assert talk.state.game is not None
    assert talk.state.game.used[1] == own


def test_the_agent_guesses_an_animal_by_questions(talk: Any) -> None:
    known, questions = shows()["animal"]["known"], shows()["animal"]["questions"]
    answer = talk.say("guess my animal")
    for _ in range(len(questions) + 1):
        asked = next((name for name, text in questions.items() if text in answer), None)
        if asked is None:
            break
        answer = talk.say("yes" if asked in known["a shark"] else "no")
    assert "a shark" in answer
    assert talk.say("yes") in shows()["animal"]["right"]


def test_a_knock_knock_joke_of_the_user_gets_the_right_replies(talk: Any) -> None:
    assert talk.say("Knock, knock!") == "Who's there?"
    assert talk.say("lettuce") == "Lettuce who?"
    assert talk.say("lettuce in, it's cold out here") in shows()["knock"]["laugh"]


@pytest.mark.parametrize("game", ["riddle", "word chain", "guess my animal"])
def test_stop_ends_every_game(game: str, begin: Callable[[int], Any]) -> None:
    talk = begin(2)
    talk.say(game)
    assert talk.state.game is not None
    assert talk.say("stop the game") in shows()["play"]["over"]
    assert talk.state.game is None


def test_two_remarks_about_another_subject_end_a_game(talk: Any) -> None:
    talk.say("riddle")
    talk.say("by the way, do you know what my sister told me about her new job yesterday?")
    talk.say("she starts there on the first of the month, and she is rather nervous about it")
    assert talk.state.game is None


def test_a_single_remark_does_not_end_a_game(talk: Any) -> None:
    first = talk.say("word chain").rstrip(".").split()[-1]
    talk.say("oh, my sister has just come home from the dentist, she looks relieved")
    letter = "The letter" if talk.state.game is None else talk.state.game.word[-1]
    assert first[-1] == letter


@pytest.mark.parametrize("game", ["riddle", "word chain", "guess my animal"])
def test_a_game_explains_its_rules_and_goes_on(game: str, begin: Callable[[int], Any]) -> None:
    talk = begin(0)
    talk.say(game)
    before = talk.state.game
    answer = talk.say("sorry, what are the rules?")
    assert any(one.split("{")[0] in answer for one in shows()[before.kind]["rules"])
    assert talk.state.game == before


def test_the_agent_declines_an_unknown_game_and_offers_the_games_that_it_knows(talk: Any) -> None:
    assert "ludo" in talk.say("can we play ludo together?").lower()
    assert "chain" in talk.say("fine, then word chain").lower()


@pytest.mark.parametrize(
    ("texts", "word"),
    [
        (("tell me a joke about ghosts",), "ghost"),
        (("tell me a joke", "haha, one more, but about bears"), "bear"),
        (("do you know a diplodocus story?",), "dinosaur"),
        (("my niece would like to hear a story about a whale",), "whale"),
    ],
)
def test_a_joke_or_story_is_about_the_subject_that_the_user_names(texts: tuple[str, ...], word: str, talk: Any) -> None:
    answers = [talk.say(text) for text in texts]
    kind = "joke" if "joke" in texts[0] else "story"
    names = (word, *shows()["subjects"].get(word, ()))
    assert answers[-1] in shows()["told"][kind]
    assert any(name in answers[-1].lower() for name in names)


def test_a_request_to_play_a_game_gets_a_choice_of_games(talk: Any) -> None:
    assert talk.say("let us play a game") in shows()["play"]["start"]
    assert "chain" in talk.say("the word game").lower()


def test_the_agent_says_that_it_has_no_story_about_the_subject_and_tells_another(talk: Any) -> None:
    assert "a unicorn" in talk.say("can you tell me a story with a unicorn").split(".")[0]
    assert talk.say("and then?") in [line.text for line in material().plain["after_show"].groups["say"]]


def test_the_agent_tells_a_story_about_a_snail(talk: Any) -> None:
    assert "snail" in talk.say("tell me a story about a snail").split(".")[0].lower()


def test_a_farewell_during_a_game_is_answered_as_a_farewell(talk: Any) -> None:
    talk.say("riddle")
    assert talk.say("goodbye") not in shows()["play"]["over"]


@pytest.mark.parametrize(
    "text",
    [
        "oh dear, that was weak. now please give me a riddle",
        "a riddle is what I asked for! come on",
        "give me a riddle",
    ],
)
def test_a_request_for_a_riddle_beside_other_words_gets_a_riddle(text: str, talk: Any) -> None:
    assert asked(talk.say(text))


def test_a_long_utterance_can_solve_a_riddle(talk: Any) -> None:
    riddle = asked(talk.say("a riddle please"))
    assert riddle["answers"][0] in talk.say(f"oh that must be a {riddle['answers'][0]}, ha, one point for me")


def test_after_the_request_one_more_another_riddle_follows(talk: Any) -> None:
    first = asked(talk.say("a riddle please"))
    assert asked(talk.say("hm, one more"))["ask"] != first["ask"]


def test_the_agent_thinks_of_an_animal_and_answers_questions_about_it(talk: Any) -> None:
    assert talk.say("no, you think of an animal and I guess it") in shows()["holder"]["start"]
    animal = talk.state.game.word
    has_fur = "fur" in shows()["animal"]["known"][animal]
    assert talk.say("does it have fur?") in shows()["holder"]["yes" if has_fur else "no"]
    assert animal in talk.say(f"then it is {animal}")


def test_the_agent_guesses_the_animal_that_the_user_thinks_of(talk: Any) -> None:
    talk.say("now I think of an animal and you have to find it")
    assert talk.state.game.kind == "animal"


@pytest.mark.parametrize(
    "text",
    [
        "they all already have jokes",
        "I have an animal shelter in my street",
        "her doctor tells her a joke before each jab",
        "an old lady asked us to sing for her cat",
        "the article says that machines will tell fairy tales to our kids",
        "my neighbour knows a riddle for each door",
    ],
)
def test_talk_about_performances_starts_none(text: str, talk: Any) -> None:
    talk.say(text)
    assert talk.state.game is None
    assert not talk.state.shown


def test_a_joke_but_no_knock_knock_joke_is_told(talk: Any) -> None:
    assert talk.say("tell me a joke, but no knock knock joke") in shows()["told"]["joke"]


@pytest.mark.parametrize("seed", range(6))
def test_approval_of_a_song_is_no_acceptance_of_an_offer(seed: int, begin: Callable[[int], Any]) -> None:
    talk = begin(seed)
    for _ in range(len(shows()["told"]["song"])):
        talk.say("sing a song")
        heard = talk.state.shown
        talk.say("yes, I will bring my ears along tomorrow")
        assert talk.state.shown == heard
