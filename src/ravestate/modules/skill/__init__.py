"""Skill modules: what an agent can do; they know modalities and meta modules, never a platform."""
