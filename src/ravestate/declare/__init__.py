"""The declarations of a designer: module, signal, slot, condition, rule, settings. They are plain values."""
