"""Load modules by name, path or file, and agent files. An agent file lists modules with their settings."""
