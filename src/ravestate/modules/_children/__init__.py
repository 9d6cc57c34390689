"""Separate processes that hold models. A module names one of its own programs as the backend of such a process."""
