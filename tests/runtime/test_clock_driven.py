"""A context's clock that a simulation drives. See also test_clock.py."""

import asyncio

import ravestate as rs


def test_a_driven_clock_moves_only_as_it_is_told_and_rules_follow_it() -> None:
    demo = rs.Module("demo")
    tick = demo.signal("tick", payload=float)
    go = demo.signal("go")
    late: list[float] = []
    slept: list[float] = []

    @demo.rule(when=tick.max_age(None))
    async def drive(ctx: rs.RuleContext) -> None:
        ctx.drive_clock(ctx.payload(tick))

    @demo.rule(when=go.min_age(2.0))
    async def after_two_seconds(ctx: rs.RuleContext) -> None:
        late.append(ctx.now)

    @demo.rule(when=go)
    async def sleep(ctx: rs.RuleContext) -> None:
        await ctx.sleep(5.0)
        slept.append(ctx.now)

    async def main() -> None:
        async with rs.Context(demo) as context:

            async def at(time: float) -> None:
                context.emit(tick, time)
                for _ in range(20):
                    await asyncio.sleep(0)

            await at(10.0)
            assert context.now == 10.0
            context.emit(go)
            await at(11.9)
            assert (context.now, late, slept) == (11.9, [], [])
            await at(12.5)
            assert (late, slept) == ([12.5], [])
            await at(12.0)  # the past changes nothing
            assert context.now == 12.5
            context.pause()
            await at(15.5)
            assert (context.now, slept) == (12.5, [])
            context.resume()
            for _ in range(20):
                await asyncio.sleep(0)
            assert context.now == 15.5
            assert slept == [15.5]

    asyncio.run(main())
