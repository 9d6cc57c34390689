"""The stand-in for a missing language model."""

import asyncio

from ravestate.modules.skill.wildtalk.backend import Message
from ravestate.modules.skill.wildtalk.listening import TO_A_QUESTION, TO_A_REMARK, ListeningBackend


def reply(*messages: Message, seed: int = 0) -> str:
    async def main() -> str:
        return "".join([piece async for piece in ListeningBackend().stream(messages, seed=seed)])

    return asyncio.run(main())


def test_questions_and_remarks_have_phrases_of_their_own() -> None:
    assert reply(Message("user", "Is it late? ")) in TO_A_QUESTION
    assert reply(Message("user", "It is late.")) in TO_A_REMARK


def test_it_does_not_repeat_itself() -> None:
    messages = [Message("user", "It is late.")]
    for seed in range(20):
        phrase = reply(*messages, seed=seed)
        assert phrase != messages[-2].text if len(messages) > 1 else phrase
        messages += [Message("assistant", phrase), Message("user", "It is late.")]
