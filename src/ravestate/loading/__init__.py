"""Load agent files, and modules by name, path or file. An agent file lists modules and their settings."""
