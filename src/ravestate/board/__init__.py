"""Raveboard, the web debugger: a context's trace, its policy, and the answer to why a rule did not fire.

`application.routes` serves it beside the chat page: conversations that go on, and traces that were recorded. Nothing here
is imported by the rest of the library but the command line.
"""
