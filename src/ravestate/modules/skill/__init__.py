"""Skill modules: the abilities of an agent. They know modalities and meta modules, never a platform."""
