"""`Talk` is the state of the conversation. It changes with each utterance of the agent and of the user."""

from ravestate.modules.skill.persqa.talk import Question, Talk


def asked(topic: str = "home") -> Talk:
    return Talk().asking(topic, 10.0).speaking()


def test_the_agents_first_utterance_after_asking_counts_as_the_question() -> None:
    assert asked().question == Question("home", 10.0, heard=True)
    assert asked().tries == {"home": 1}


def test_the_agents_next_utterance_marks_its_question_as_spoken_over() -> None:
    question = asked().speaking().question
    assert question is not None and question.spoken_over and not question.fresh


def test_the_agents_reply_to_the_user_does_not_mark_its_question_as_spoken_over() -> None:
    question = asked().listening(20.0, leave=False).speaking().question
    assert question is not None and not question.spoken_over and question.turns == 1


def test_a_question_stays_open_for_a_limited_time_and_less_than_two_utterances_of_the_user() -> None:
    talk = asked()
    assert talk.pending(100.0, within=90.0) is not None
    assert talk.pending(100.1, within=90.0) is None
    once = talk.listening(20.0, leave=False)
    assert once.pending(20.0, within=90.0) is not None
    assert once.listening(20.0, leave=False).pending(20.0, within=90.0) is None


def test_after_a_goodbye_the_question_is_over_and_the_agent_is_quiet_until_the_user_speaks() -> None:
    left = asked().listening(20.0, leave=True)
    assert left.question is None and left.quiet
    assert not left.listening(20.0, leave=False).quiet


def test_ignored_questions_are_counted_until_the_user_speaks() -> None:
    talk = asked().waiting().asking("name", 50.0).waiting()
    assert talk.ignored == 2 and talk.question is None
    assert talk.listening(20.0, leave=False).ignored == 0


def test_a_fact_can_be_corrected_in_the_next_two_utterances() -> None:
    talk = asked().learning(["home"], "home", ("Ulm",))
    assert talk.question is None and talk.told == {"home"}
    for _ in range(2):
        talk = talk.listening(20.0, leave=False)
        assert talk.correctable == "home"
    assert talk.listening(20.0, leave=False).correctable == ""


def test_learning_another_fact_leaves_the_question_open() -> None:
    talk = asked().learning(["hobby"], "hobby", ("chess",))
    assert talk.question is not None and talk.question.topic == "home"


def test_closed_topics_stay_closed() -> None:
    assert asked().closing("home").asking("name", 1.0).closing("name").closed == {"home", "name"}
