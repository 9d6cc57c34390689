"""The one message that the documentation uses."""


class String:
    """A text."""

    def __init__(self, *, data: str) -> None:
        assert isinstance(data, str)
        self.data = data
