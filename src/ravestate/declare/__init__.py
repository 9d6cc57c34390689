"""The declarations of a designer: module, signal, slot, condition, rule, settings. They are plain values.

Comments cite the laws of the automaton by number, such as law L9: see ``docs/explanation/processing-model.md``.
"""
