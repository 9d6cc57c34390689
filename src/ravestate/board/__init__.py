"""Raveboard, the web debugger: the trace and policy of a context, and why a rule did not fire.

`application.routes` serves it beside the chat page, for running conversations and recorded traces. Only the command line
imports this package.
"""
