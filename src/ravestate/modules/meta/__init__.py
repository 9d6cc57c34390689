"""Meta modules: general services for other modules."""
