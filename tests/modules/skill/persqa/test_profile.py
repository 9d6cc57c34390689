"""The facts after the user has told something."""

from ravestate.modules.skill.persqa.profile import learn, merged, told_apart
from ravestate.modules.skill.persqa.topics import Fact


def test_one_home_replaces_another_and_hobbies_add_up() -> None:
    news = learn({"home": ("Ulm",), "hobby": ("chess",)}, [Fact("home", ("Bonn",)), Fact("hobby", ("go", "Chess"))])
    assert news.facts == {"home": ("Bonn",), "hobby": ("chess", "go")}
    assert news.changed == {"home"} and news.new == {"home", "hobby"}


def test_known_facts_are_not_new() -> None:
    news = learn({"home": ("Ulm",)}, [Fact("home", ("ulm",))])
    assert not news.new and not news.changed and news.topics == ("home",)


def test_the_name_is_none_of_it() -> None:
    assert learn({}, [Fact("name", ("Ada",))]).topics == ()


def test_a_home_that_is_gone_may_be_asked_for_again_but_no_hobby_is_none() -> None:
    news = learn({"home": ("Ulm",), "hobby": ("chess",)}, [Fact("home", (), gone=True), Fact("hobby", (), gone=True)])
    assert news.facts == {"hobby": ()}
    assert news.topics == ("home", "hobby")


def test_one_of_two_friends_is_gone() -> None:
    assert learn({"friend": ("Tom", "Anna")}, [Fact("friend", ("tom",), gone=True)]).facts == {"friend": ("Anna",)}


def test_without_a_job_there_is_no_employer() -> None:
    news = learn({"occupation": ("baker",), "employer": ("Siemens",)}, [Fact("occupation", (), gone=True)])
    assert news.facts == {"occupation": (), "employer": ()}
    assert news.topics == ("occupation", "employer")


def test_a_correction_takes_the_wrong_value_out() -> None:
    assert learn({"hobby": ("chess", "judo")}, [Fact("hobby", ("ludo",))], ("judo",)).facts == {
        "hobby": ("chess", "ludo")
    }


def test_this_talk_goes_before_memory() -> None:
    remembered = {"home": ("Ulm",), "hobby": ("chess",), "friend": ("Tom",)}
    told = {"hobby": ("Chess", "go"), "home": ("Bonn",), "friend": ()}
    both = merged(remembered, told)
    assert both == {"home": ("Bonn",), "hobby": ("chess", "go"), "friend": ()}
    assert told_apart(both, remembered, ["home", "hobby"]) == {"home": ("Bonn",), "hobby": ("go",)}
