"""The programs of the bridge processes. Each runs by itself, on Python 3.8 or newer, and imports nothing from Ravestate."""
