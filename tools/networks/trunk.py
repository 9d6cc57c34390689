"""The part of the network that all heads share: upper layers of the sentence model, which the training may change."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from rows import WIDTH

from ravestate.language.encoder import BUNDLED
from ravestate.language.model import folder_of
from ravestate.language.network import EARLIER, SAID

HEADS, ALL = 12, 12
"""The number of heads of a layer, and of layers of the sentence model."""
PIECES = {
    "query": "attention.self.query", "key": "attention.self.key", "value": "attention.self.value",
    "joined": "attention.output.dense", "joined_norm": "attention.output.LayerNorm", "wide": "intermediate.dense",
    "narrow": "output.dense", "norm": "output.LayerNorm",
}  # fmt: skip
"""A part of a layer here, and its name in the model."""


FIRST, PLACE = 6, 1
"""The index of the first layer that the network has for itself. It reads the vectors of the layer before, which is number
PLACE of those that the sentence model returns."""
DROPOUT, HEAD_DROPOUT = 0.1, 0.2
"""The dropout within the layers, and the dropout before a head."""


@dataclass
class Read:
    """The output of the trunk for some texts: the input of a head."""

    tokens: Any
    """The vectors of the tokens: shape (n, tokens, WIDTH)."""
    inside: Any
    """Whether a token belongs to the text itself, not to the texts before it: shape (n, tokens)."""
    vectors: Any
    """The vectors that the trunk has read: shape (n, tokens, layers * WIDTH)."""
    marks: Any
    asked: Any


def trunk(torch: Any) -> Any:
    """Return a new trunk. It reads vectors, marks, the fact that was asked for, and padding, and returns a `Read`."""
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
            self.drop = nn.Dropout(DROPOUT)

        def forward(self, tokens: Any, bias: Any) -> Any:
            shape = *tokens.shape[:2], HEADS, WIDTH // HEADS
            query, key, value = (
                part(tokens).view(shape).transpose(1, 2) for part in (self.query, self.key, self.value)
            )
            heed = (query @ key.transpose(2, 3) / (WIDTH // HEADS) ** 0.5 + bias).softmax(-1)
            joined = (heed @ value).transpose(1, 2).reshape(tokens.shape)
            tokens = self.joined_norm(tokens + self.drop(self.joined(joined)))
            return self.norm(tokens + self.drop(self.narrow(nn.functional.gelu(self.wide(tokens)))))

    class Trunk(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.layers = nn.ModuleList([Layer(number) for number in range(FIRST, ALL)])
            self.mark = nn.Embedding(1 + SAID, WIDTH)
            nn.init.normal_(self.mark.weight, 0, 0.02)

        def forward(self, vectors: Any, marks: Any, asked: Any, padding: Any = None) -> Read:
            tokens = vectors[..., PLACE * WIDTH : (PLACE + 1) * WIDTH] + self.mark(marks)
            bias = 0.0 if padding is None else (padding * -1e4)[:, None, None, :]
            with torch.autocast("cpu", torch.bfloat16, enabled=self.training):
                for layer in self.layers:
                    tokens = layer(tokens, bias)
            inside = marks < EARLIER
            return Read(tokens.float(), inside if padding is None else inside & ~padding, vectors, marks, asked)

    return Trunk()


def pool(torch: Any) -> Any:
    """Return a new network that makes one vector of a text, of 3 * WIDTH numbers: the vector of its first token, a
    weighted mean of all, and the mean."""
    nn = torch.nn

    class Pool(nn.Module):  # type: ignore[misc, name-defined]
        def __init__(self) -> None:
            super().__init__()
            self.weight, self.drop = nn.Linear(WIDTH, 1), nn.Dropout(HEAD_DROPOUT)

        def forward(self, read: Read) -> Any:
            inside = read.inside.float()
            first = read.tokens[torch.arange(len(inside)), inside.argmax(1)]
            weights = self.weight(read.tokens)[..., 0].masked_fill(~read.inside, -1e9).softmax(1)
            mean = (read.tokens * inside[..., None]).sum(1) / inside.sum(1, keepdim=True)
            return self.drop(torch.cat([first, (read.tokens * weights[..., None]).sum(1), mean], 1))

    return Pool()


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
