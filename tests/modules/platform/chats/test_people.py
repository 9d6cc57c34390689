"""The agent recognises people by their accounts, even after a restart, and does not confuse people of the same name."""

import asyncio
from pathlib import Path

from modules.platform.chats.messenger import Post, letter, letters
from ravestate.modules import persqa
from ravestate.modules.platform.chats import Person, Room
from ravestate.runtime.agent import Agent

ADA, OTHER = Person("1", "Ada"), Person("2", "Ada")


def test_a_stranger_with_the_same_name_learns_nothing_about_the_first_person(tmp_path: Path) -> None:
    async def talk(*said: tuple[Person, str]) -> list[str]:
        settings = {"ontology": {"path": tmp_path / "memory.lbug"}, "letters": {"path": tmp_path / "letters.db"}}
        post = Post()
        async with asyncio.timeout(120), Room(Agent(persqa, letters, settings=settings), "letters", post, "me") as room:
            for person, text in said:
                count = len(post.sent)
                room.receive([letter(text, chat=person.id, person=person)])
                await post.said(count + 1)
        return [each.text for each in post.sent]

    first = asyncio.run(talk((ADA, "I live in Hannover."), (OTHER, "Where do I live?"), (ADA, "Where do I live?")))
    assert "Hannover" not in first[1]
    assert "Hannover" in first[2]
    later = asyncio.run(talk((OTHER, "Where do I live?"), (ADA, "Where do I live?")))
    assert "Hannover" not in later[0]
    assert "Hannover" in later[1]
