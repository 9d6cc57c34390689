"""The game understands which move the user's words mean, even if its files do not have these sentences."""

from __future__ import annotations

import pytest

from ravestate.modules.meta.nlp.analysis import analyse
from ravestate.modules.meta.nlp.pipeline import pipeline
from ravestate.modules.skill.charades.game import moves_of
from ravestate.modules.skill.charades.understanding import understand

pytestmark = pytest.mark.usefixtures("reader")

FLOOR = 0.95
"""The minimum share of these sentences that the game must understand."""

ROWS = """
off      | let's play charades                 | wanted
off      | can you guess what I'm doing?       | wanted
off      | let's play something                | play
off      | do you want to play a game with me? | play
off      | let's play a round                  | play
off      | I'm so bored today                  | play
off      | let's play word chain               | -
off      | can we play chess?                  | -
off      | I am ready                          | -
off      | yes                                 | -
offered  | yes please                          | yes
offered  | sure, why not                       | yes
offered  | no thanks                           | no
offered  | not now                             | no
offered  | I'd rather not                      | no
offered  | how does that game work?            | rules
offered  | can you tell me the rules?          | rules
offered  | what is the weather like in Rome?   | -
offered  | who is the president of France?     | -
choosing | I'm ready now                       | ready
choosing | okay, ready                         | ready
choosing | ok                                  | yes
choosing | I have something in mind            | ready
choosing | you can begin                       | ready
choosing | not ready yet                       | wait
choosing | wait a sec                          | wait
choosing | give me a little more time          | wait
choosing | what do I have to do now?           | rules
choosing | no, you go first                    | swap
choosing | please give me a riddle             | swap
choosing | how many people live in Berlin?     | -
choosing | please stop the game                | stop
counting | ready                               | -
counting | I am ready                          | -
watching | okay                                | -
counting | stop!                               | stop
counting | wait wait                           | wait
counting | I want to stop playing              | stop
watching | hold on a moment                    | wait
watching | stop                                | stop
guessed  | yes!                                | yes
guessed  | yes, that's right                   | yes
guessed  | correct                             | yes
guessed  | exactly                             | yes
guessed  | you got it                          | yes
guessed  | no                                  | no
guessed  | nope                                | no
guessed  | no, that's wrong                    | no
guessed  | wrong                               | no
guessed  | not at all                          | no
guessed  | maybe                               | unclear
guessed  | sort of                             | unclear
guessed  | hmm                                 | unclear
guessed  | almost                              | unclear
guessed  | no, it was juggling                 | no juggling
guessed  | no, I was rowing                    | no rowing
guessed  | what is the capital of Peru?        | -
guessed  | do you like music?                  | -
guessed  | my brother arrives in an hour       | -
guessed  | what's the score?                   | score
guessed  | can you say that again?             | repeat
guessed  | let's stop here                     | stop
guessed  | bye                                 | farewell
asked    | juggling                            | named juggling
asked    | it was juggling                     | named juggling
asked    | I was riding a horse                | named riding a horse
asked    | it was swimming                     | named swimming
asked    | I was playing the guitar            | named playing the guitar
asked    | I was brushing my teeth             | named brushing teeth
asked    | a helicopter                        | named a helicopter
asked    | it's a secret                       | secret
asked    | I won't tell you                    | secret
asked    | never mind                          | secret
asked    | where is the station?               | -
asked    | stop it please                      | stop
unseen   | okay                                | yes
unseen   | no                                  | no
unseen   | I'm ready                           | ready
between  | yes, another one                    | yes
between  | sure                                | yes
between  | no, thank you                       | no
between  | now it's your turn                  | swap
between  | you show me one                     | swap
between  | how many points do I have now?      | score
between  | goodbye                             | farewell
between  | how old are you?                    | -
riddle   | is it swimming?                     | named swimming
riddle   | swimming                            | named swimming
riddle   | are you playing the guitar?         | named playing the guitar
riddle   | a guitar                            | named playing the guitar
riddle   | you are brushing your teeth         | named brushing teeth
riddle   | making a phone call                 | named phoning
riddle   | is it jogging?                      | named running
riddle   | are you ironing?                    | named ironing
riddle   | is it fishing                       | named fishing
riddle   | I don't know                        | gives_up
riddle   | no idea                             | gives_up
riddle   | I give up                           | gives_up
riddle   | can I have a hint?                  | hint
riddle   | please help me                      | hint
riddle   | who wrote Faust?                    | -
riddle   | stop                                | stop
"""


def test_a_sentence_is_understood_as_the_right_move() -> None:
    wrong: list[str] = []
    rows = [[part.strip() for part in row.split("|")] for row in ROWS.strip().splitlines()]
    for step, text, wanted in rows:
        move = understand(analyse(text, pipeline("")), moves_of(step))  # type: ignore[arg-type]
        got = "-" if move is None else f"{move.kind} {move.name}".strip()
        if got != wanted:
            wrong.append(f"{step}: {text!r} is {got!r}, not {wanted!r}")
    assert len(wrong) <= (1 - FLOOR) * len(rows), "\n".join(wrong)
