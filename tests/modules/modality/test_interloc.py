"""The signals of `interloc` have the key and the name of each user who comes or goes."""

import ravestate as rs
from ravestate.modules import interloc
from ravestate.testing import simulate

host = rs.Module("host", requires=[interloc])
seen = host.slot("seen", ())


@host.rule(when=interloc.users.added, writes=seen)
async def came(ctx: rs.RuleContext) -> None:
    key, name = ctx.payload(interloc.users.added)
    ctx[seen] = (*ctx[seen], ("came", key, name))


@host.rule(when=interloc.users.removed, writes=seen)
async def went(ctx: rs.RuleContext) -> None:
    key, name = ctx.payload(interloc.users.removed)
    ctx[seen] = (*ctx[seen], ("went", key, name))


def test_the_signals_added_and_removed_name_users_who_come_and_go() -> None:
    with simulate(host) as sim:
        sim.put(interloc.users, {"a": "Ada"})
        sim.put(interloc.users, {"b": None})
        assert sim.read(seen) == (("came", "a", "Ada"), ("went", "a", "Ada"), ("came", "b", None))
