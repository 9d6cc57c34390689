"""The rule that shares what is known of the user with modules that do not need this one."""

from __future__ import annotations

import ravestate as rs
from ravestate.modules import interloc

from .names import facts, module, who
from .topics import NAME


@module.rule(
    when=facts.changed.max_age(None).detached() | who.changed.max_age(None).detached(),
    reads=(facts, who),
    writes=interloc.facts,
    background=True,
)
async def publish(ctx: rs.RuleContext) -> None:
    """Copy the facts about the user, and their name, to `interloc.facts`."""
    person = ctx[who]
    known = {topic: tuple(values) for topic, values in ctx[facts].items() if values}
    if person is not None and person.get(NAME):
        known[NAME] = (str(person[NAME]),)
    shared = ctx[interloc.facts]
    for topic in [topic for topic in shared if topic not in known]:
        shared.remove(topic)
    for topic, values in known.items():
        if shared.get(topic) != values:
            shared.add(topic, values)
