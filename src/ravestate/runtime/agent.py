"""An agent, independent of any conversation; each conversation gets its own context."""

from __future__ import annotations

from collections.abc import Mapping
from types import ModuleType
from typing import Any

from ravestate.declare.module import Module
from ravestate.policy.policy import Policy
from ravestate.runtime.context import Context
from ravestate.settings import Settings


class Agent:
    """A policy and its settings, read and checked once, and shared by all contexts of the agent.

    Args:
        modules: See `Context`.
        options: See `Context`.

    Raises:
        DeclarationErrors: The modules or the settings have faults.
    """

    def __init__(self, *modules: Module | ModuleType | Policy, **options: Any) -> None:
        first = Context(*modules, **options)
        self.policy: Policy = first.policy
        self.settings: Mapping[str, Settings] = first.settings
        self._options: dict[str, Any] = {**options, "settings": self.settings}

    def context(self, **options: Any) -> Context:
        """Return a new context, which can be started once.

        Args:
            options: See `Context`, except ``settings``; they override the agent's own.
        """
        merged: Any = self._options | options
        return Context(self.policy, **merged)
