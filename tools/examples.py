"""An extension of Griffe, the reader of docstrings for the reference: it makes examples appear as code."""

import re
from typing import Any

from griffe import Extension, Object


class Examples(Extension):
    """Makes `Example:` the section `Examples:`, and removes the `::` before indented code. It changes no source
    file."""

    def on_instance(self, *, obj: Object, **_: Any) -> None:
        if obj.docstring is not None:
            text = re.sub(r"(?m)^Example:$", "Examples:", obj.docstring.value)
            obj.docstring.value = re.sub(r"(?m)^ *::$", "", text)
