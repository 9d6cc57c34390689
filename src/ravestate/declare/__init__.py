"""What a designer writes: module, signal, slot, condition, rule, settings. Values; no behaviour."""
