"""An extension of Griffe, which reads docstrings for the reference: what is meant as code is shown as code."""

import re
from typing import Any

from griffe import Extension, Object


class Examples(Extension):
    """Makes `Example:` the section `Examples:`, and takes out the `::` before indented code. The source stays."""

    def on_instance(self, *, obj: Object, **_: Any) -> None:
        if obj.docstring is not None:
            text = re.sub(r"(?m)^Example:$", "Examples:", obj.docstring.value)
            obj.docstring.value = re.sub(r"(?m)^ *::$", "", text)
