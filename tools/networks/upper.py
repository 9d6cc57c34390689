"""The upper layers of the bundled sentence model, as a network that a training may change."""

from __future__ import annotations

from typing import Any

from shared import WIDTH

from ravestate.language.encoder import BUNDLED
from ravestate.language.model import folder_of

HEADS, ALL = 12, 12
"""The number of heads of a layer, and of layers of the sentence model."""
PIECES = {
    "query": "attention.self.query", "key": "attention.self.key", "value": "attention.self.value",
    "joined": "attention.output.dense", "joined_norm": "attention.output.LayerNorm", "wide": "intermediate.dense",
    "narrow": "output.dense", "norm": "output.LayerNorm",
}  # fmt: skip
"""A part of a layer here, and its name in the model."""


def upper_layers(torch: Any, first: int, dropout: float = 0.1) -> Any:
    """Return the layers of the sentence model from number `first` on, of twelve, with their weights.

    The network reads the vectors after layer ``first - 1``, shape (n, tokens, WIDTH), and the padding, shape (n, tokens).
    It returns the vectors after the last layer. `padding` is True for tokens that do not exist; None: there are none.
    """
    nn, weights = torch.nn, _weights(torch)

    class Layer(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self, number: int) -> None:
            super().__init__()
            for name, place in PIECES.items():
                weight = weights[f"encoder.layer.{number}.{place}.weight"]
                normed = weight.dim() == 1
                part = nn.LayerNorm(WIDTH, eps=1e-12) if normed else nn.Linear(*reversed(weight.shape))
                part.weight.data, part.bias.data = weight, weights[f"encoder.layer.{number}.{place}.bias"]
                setattr(self, name, part)
            self.drop = nn.Dropout(dropout)

        def forward(self, tokens: Any, bias: Any) -> Any:
            shape = *tokens.shape[:2], HEADS, WIDTH // HEADS
            query, key, value = (
                part(tokens).view(shape).transpose(1, 2) for part in (self.query, self.key, self.value)
            )
            heed = (query @ key.transpose(2, 3) / (WIDTH // HEADS) ** 0.5 + bias).softmax(-1)
            joined = (heed @ value).transpose(1, 2).reshape(tokens.shape)
            tokens = self.joined_norm(tokens + self.drop(self.joined(joined)))
            return self.norm(tokens + self.drop(self.narrow(nn.functional.gelu(self.wide(tokens)))))

    class Upper(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.layers = nn.ModuleList([Layer(number) for number in range(first, ALL)])

        def forward(self, tokens: Any, padding: Any = None) -> Any:
            bias = 0.0 if padding is None else (padding * -1e4)[:, None, None, :]
            for layer in self.layers:
                tokens = layer(tokens, bias)
            return tokens

    return Upper()


def _weights(torch: Any) -> dict[str, Any]:
    """Return the weights of the bundled model by their names. Its 8-bit matrices become floats."""
    import onnx
    from onnx import numpy_helper

    graph = onnx.load(str(folder_of(None, BUNDLED) / "model.onnx")).graph
    values = {one.name: numpy_helper.to_array(one) for one in graph.initializer}
    found = {name: torch.from_numpy(value.copy()) for name, value in values.items() if name.startswith("encoder")}
    for node in graph.node:
        if node.op_type == "MatMulInteger":
            name = node.input[1].removesuffix("_quantized")
            matrix = values[f"{name}_quantized"].astype("float32") - values[f"{name}_zero_point"].astype("float32")
            place = node.name.strip("/").removesuffix("/MatMul_quant").replace("/", ".")
            found[f"{place}.weight"] = torch.from_numpy((matrix * values[f"{name}_scale"]).T.copy())
    return found
