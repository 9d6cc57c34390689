"""Platform modules: where an agent lives, such as a console; each connects devices to modalities."""
