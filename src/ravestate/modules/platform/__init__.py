"""Platform modules. A platform, for example the console, connects an agent with its users or with devices."""
