"""Processes beside the agent that hold models. Each module names one of its own programs as the backend."""
