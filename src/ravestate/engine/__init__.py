"""The automaton: events and times in, effects out. Pure: no clock, thread, lock, random number or hash order.

``engine.py`` owns the four verbs; ``activation.py`` the life of an activation; ``consent.py`` who may run;
``horizon.py`` what may still come.
"""
