"""Small talk, and questions that want to know something."""

import pytest

from ravestate.modules.skill.wildtalk.facts import asks_for_fact

FACTS = """
What is the capital of Peru?
what’s the capital of peru
Who won the world cup in 1990?
So, who wrote Hamlet?
Do you know how tall the Eiffel Tower is?
Can you tell me when the war ended?
Nice. And where is Timbuktu?
How many legs does a spider have?
What is the weather like today?
Which planet is the largest?
And its population?
And of Spain?
Is Scotland a country?
does Peru have a king?
What's 12 times 12?
Was ist die Hauptstadt von Peru?
Weißt du, wie hoch die Zugspitze ist?
"""
TALK = """
Hello!
How are you?
What is your name?
What's up?
Is it nice outside?
Are there any news?
Will it rain today?
Is that a joke?
Is your name Bob?
What is new?
What about some music?
What a nice day!
What?
Who are you?
Who is your best friend?
Where do you come from?
What should I do today?
When I was young, I liked music.
I know who you are.
How is it going?
That is what they say.
I wonder.
Was gibt es Neues bei dir?
Wie geht es dir?
Wie heißt du?
"""


@pytest.mark.parametrize("text", FACTS.strip().splitlines())
def test_what_one_has_to_know(text: str) -> None:
    assert asks_for_fact(text)


@pytest.mark.parametrize("text", [*TALK.strip().splitlines(), "", " ", "?", "so " * 100_000])
def test_what_one_just_says(text: str) -> None:
    assert not asks_for_fact(text)
