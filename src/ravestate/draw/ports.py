"""Port placement: on each side of a vertex, ports are in the order of the vertices to which their lines lead."""

from __future__ import annotations

from ravestate.draw.layered import LayeredGraph, places

_PITCH = 10.0  # pixels between ports of one side, where there is room
_MARGIN = 10.0  # pixels from the first and last port to the corner, which is sometimes round
_LEAST = 3.0  # minimum pixels between ports; with less room they coincide, but entering and leaving lines stay apart


def place_ports(graph: LayeredGraph) -> None:
    """Set the offset of each port in place. The layers of `graph` must be in their final order."""
    place = places(graph.order)
    leads: list[list[int]] = [[] for _ in graph.ports]
    for low, high in graph.segments:
        leads[low].append(place[graph.ports[high].vertex])
        leads[high].append(place[graph.ports[low].vertex])
    sides: dict[tuple[int, bool], list[int]] = {}
    for number, port in enumerate(graph.ports):
        sides.setdefault((port.vertex, port.right), []).append(number)
    for (vertex, _), numbers in sides.items():
        if len(numbers) == 1 or graph.kind[vertex] != "node":
            continue
        numbers.sort(key=lambda number: (sum(leads[number]) / len(leads[number]), number))
        pitch = min(_PITCH, (graph.height[vertex] - 2 * _MARGIN) / (len(numbers) - 1))
        if pitch >= _LEAST:
            for i, number in enumerate(numbers):
                graph.ports[number].offset = round(pitch * (i - (len(numbers) - 1) / 2), 2)
        elif len({graph.ports[number].enters for number in numbers}) > 1:
            first = graph.ports[numbers[0]].enters
            for number in numbers:
                graph.ports[number].offset = -_LEAST if graph.ports[number].enters == first else _LEAST
