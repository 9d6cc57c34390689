"""The asyncio shell around the engine: the only place with a loop, a thread or a clock."""

from ravestate.compiled import prefer

prefer(__path__)
