"""The declarations of a designer: module, signal, slot, condition, rule, settings. Values without behaviour."""
