"""The sentences that helped to develop the detection of the end of a turn. The measurement uses other sentences.

`python -m benchmarks.peers.development [MODEL]` measures them.
"""

from __future__ import annotations

import sys

COMPLETE = (
    "Where is the nearest post office?", "I have never been so happy.", "Our neighbours have three children.",
    "Could I have the bill, please?", "It takes about twenty minutes.", "Who wrote this poem?",
    "I cannot find my glasses.", "Dinner is ready.", "She speaks four languages.", "Is it far from here?",
    "Open the window, please.", "I would rather stay here.", "We met at a party in March.", "The soup is too hot.",
    "What do you do for a living?", "He plays football every Sunday.", "In the kitchen.", "Because I was ill.",
    "Not today, thank you.", "About three hours.", "Two of them.", "Yes, I would like that.",
    "No, I have not seen it.", "That is what I meant.", "Tell me more.", "I do not know him.", "Where are you from?",
    "How does it work?", "Can we start again?", "You are right.", "It was not my fault.", "The bus was late again.",
    "I am a nurse.", "My son is seven years old.", "Did you sleep well?", "Nothing special.", "I prefer tea.",
    "The meeting is on Friday.", "There was too much noise.", "Please wait for me.",
)  # fmt: skip
"""Sentences that are complete."""

OPEN = (
    ("My brother and his", "wife live in Spain."), ("I am afraid that", "we are late."),
    ("The shop on the corner of the", "street is closed."), ("Could you bring me the", "newspaper?"),
    ("In the summer we often", "go swimming."), ("I was going to", "call you."),
    ("You should talk to your", "teacher."), ("The only thing that I", "need is sleep."),
    ("We were sitting in the", "garden."), ("He promised that he would", "write soon."),
    ("It depends on", "the weather."), ("There are many people who", "like it."),
    ("As soon as I", "know more I will tell you."), ("My grandmother used to make", "bread."),
    ("I cannot decide between the red one and the", "blue one."), ("Have you heard about the", "accident?"),
    ("The book that you gave me is", "wonderful."), ("On the way home from", "work I saw a fox."),
    ("Please send it to", "my office."), ("She has been living in", "Rome."), ("I wonder why", "he left."),
    ("What happens if I", "press this button?"), ("They have decided to", "move."),
    ("I need some help with my", "computer."), ("The price of the", "ticket is too high."),
    ("I would be glad if", "you came."), ("Her new flat has a", "balcony."),
    ("Can you remember the name of the", "hotel?"), ("We always have dinner at", "seven."),
    ("This is one of the", "best films."), ("I went to the doctor because", "my back hurts."),
    ("First you have to", "wash the apples."), ("He looked at me and", "smiled."),
    ("The man with the", "hat is my uncle."), ("If I were", "you I would go."),
    ("Every morning I", "run five miles."), ("Tomorrow my parents and I are", "going away."),
    ("It would be better to", "wait."), ("I am thinking of", "buying a car."),
    ("There is something I have to", "tell you."),
)  # fmt: skip
"""Beginnings of sentences, each with its continuation after a pause."""


def main(model: str = "tiny.en") -> None:
    """Print the shares of false cuts and of missed ends in these sentences."""
    from benchmarks.questions.voice import ends_of_turns

    cuts, missed, count = ends_of_turns(model, len(COMPLETE), OPEN, COMPLETE)
    print(f"{model}: {cuts:.1%} false cuts of {count} pauses, {missed:.1%} missed ends of {count} sentences")


if __name__ == "__main__":
    main(*sys.argv[1:])
