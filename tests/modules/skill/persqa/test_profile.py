"""The known facts after the user has told the agent something new."""

from ravestate.modules.skill.persqa.profile import learn, merged, told_apart
from ravestate.modules.skill.persqa.topics import Fact


def test_a_new_home_replaces_the_old_one_but_a_new_hobby_is_added() -> None:
    news = learn({"home": ("Ulm",), "hobby": ("chess",)}, [Fact("home", ("Bonn",)), Fact("hobby", ("go", "Chess"))])
    assert news.facts == {"home": ("Bonn",), "hobby": ("chess", "go")}
    assert news.changed == {"home"} and news.new == {"home", "hobby"}


def test_a_fact_that_is_already_known_is_not_new() -> None:
    news = learn({"home": ("Ulm",)}, [Fact("home", ("ulm",))])
    assert not news.new and not news.changed and news.topics == ("home",)


def test_the_name_is_not_among_the_learned_topics() -> None:
    assert learn({}, [Fact("name", ("Ada",))]).topics == ()


def test_a_removed_home_becomes_unknown_but_removed_hobbies_mean_that_there_are_none() -> None:
    news = learn({"home": ("Ulm",), "hobby": ("chess",)}, [Fact("home", (), gone=True), Fact("hobby", (), gone=True)])
    assert news.facts == {"hobby": ()}
    assert news.topics == ("home", "hobby")


def test_one_of_two_friends_can_be_removed() -> None:
    assert learn({"friend": ("Tom", "Anna")}, [Fact("friend", ("tom",), gone=True)]).facts == {"friend": ("Anna",)}


def test_without_a_job_there_is_no_employer() -> None:
    news = learn({"occupation": ("baker",), "employer": ("Siemens",)}, [Fact("occupation", (), gone=True)])
    assert news.facts == {"occupation": (), "employer": ()}
    assert news.topics == ("occupation", "employer")


def test_a_correction_replaces_only_the_wrong_value() -> None:
    assert learn(
        {"hobby": ("chess", "judo")}, [Fact("hobby", ("ludo",)), Fact("hobby", ("judo",), gone=True)]
    ).facts == {"hobby": ("chess", "ludo")}


def test_facts_from_this_conversation_take_precedence_over_memory() -> None:
    remembered = {"home": ("Ulm",), "hobby": ("chess",), "friend": ("Tom",)}
    told = {"hobby": ("Chess", "go"), "home": ("Bonn",), "friend": ()}
    both = merged(remembered, told)
    assert both == {"home": ("Bonn",), "hobby": ("chess", "go"), "friend": ()}
    assert told_apart(both, remembered, ["home", "hobby"]) == {"home": ("Bonn",), "hobby": ("go",)}
