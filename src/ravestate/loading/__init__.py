"""Agents by name: modules by name, path or file, and the agent files that list them with their settings."""
