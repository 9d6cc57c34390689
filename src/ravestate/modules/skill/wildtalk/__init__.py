"""Generative small talk: when nothing more specific has an answer, a language model has one."""
