"""The programs of the model processes. Each runs by itself and imports nothing from Ravestate."""
