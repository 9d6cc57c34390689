"""Processes beside the agent that hold models. Modules name a program of theirs as the backend."""
