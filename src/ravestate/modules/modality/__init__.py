"""Modality modules: interfaces for kinds of input and output, independent of any platform."""
