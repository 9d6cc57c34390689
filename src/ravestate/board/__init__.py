"""Raveboard, the web debugger: a context's trace, its policy, and the answer to why a rule did not fire.

`routes` serves it beside the chat page, `replay` serves a recorded trace without an agent. Nothing here is imported by
the rest of the library but the command line.
"""
