"""Meta modules: what helps other modules, whatever they are about."""
