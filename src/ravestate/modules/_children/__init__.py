"""Separate processes that hold models. The program in such a process is the *backend*; a module brings its own."""
