"""Platform modules. A platform, such as a console, is a place for an agent: it connects devices to modalities."""
