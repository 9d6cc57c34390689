"""Intents to phrases: what is meant is worded from files of phrases."""
