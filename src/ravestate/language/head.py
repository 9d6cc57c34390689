"""A head of the network: the outputs of the network for one purpose."""

from __future__ import annotations

from .network import Network, network


class Head:
    """The base of the classes that read one head of the network. Thread-safe."""

    def __init__(self, name: str, source: Network | None = None) -> None:
        """Choose a head of the network; load nothing yet.

        Args:
            name: The head's name.
            source: The network; by default, the bundled network.
        """
        self._name = name
        self._network = source or network()

    @property
    def loaded(self) -> bool:
        """Whether the network is ready."""
        return self._network.loaded

    def load(self) -> None:
        """Load the network, once. This raises the same errors as `Network.load`."""
        self._network.load()

    @property
    def labels(self) -> list[str]:
        """The labels of the head; none before `load`."""
        return self._network.labels(self._name)
