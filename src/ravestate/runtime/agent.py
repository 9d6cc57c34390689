"""An agent that may hold many conversations. Each conversation gets its own context."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module
from ravestate.policy.policy import Policy
from ravestate.runtime.context import Context
from ravestate.settings import Settings


class Agent:
    """A policy and its settings, which are checked once and shared by all contexts of the agent.

    The arguments and the exceptions are those of `Context`.
    """

    def __init__(self, *modules: Module | ModuleType | Policy, **options: Any) -> None:
        first = Context(*modules, **options)
        self.policy: Policy = first.policy
        self.settings: Mapping[str, Settings] = first.settings
        self._options: dict[str, Any] = {**options, "settings": self.settings}

    def context(self, **options: Any) -> Context:
        """Return a new context of this agent. A context can start only once. `options` override the agent's options."""
        merged: Any = self._options | options
        return Context(self.policy, **merged)
