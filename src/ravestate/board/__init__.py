"""Raveboard, the web debugger. It shows a context's trace and policy, and explains why a rule did not fire.

`application.routes` serves the board beside the chat page. The board shows running conversations and recorded traces.
Only the command line imports this package.
"""
