"""Strongly connected components of a graph, without recursion (Tarjan 1972)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Components:
    """The strongly connected components of a graph: the members of each component, and each node's component index.

    If an edge leads from component A to component B, B comes before A.
    """

    members: list[list[int]]
    of: list[int]


def components(edges: Sequence[Sequence[int]]) -> Components:
    """Return the components of the graph in which an edge leads from node `n` to each of ``edges[n]``."""
    members: list[list[int]] = []
    of = [-1] * len(edges)
    number = [-1] * len(edges)  # node → its number in the order of discovery
    low = [0] * len(edges)  # node → the least number of an unfinished node within its reach
    unfinished: list[int] = []
    count = 0
    for root in range(len(edges)):
        if number[root] >= 0:
            continue
        way = [(root, iter(edges[root]))]
        number[root] = low[root] = count
        count += 1
        unfinished.append(root)
        while way:
            node, ahead = way[-1]
            for other in ahead:
                if number[other] < 0:
                    number[other] = low[other] = count
                    count += 1
                    unfinished.append(other)
                    way.append((other, iter(edges[other])))
                    break
                if of[other] < 0:
                    low[node] = min(low[node], number[other])
            else:
                way.pop()
                if way:
                    above = way[-1][0]
                    low[above] = min(low[above], low[node])
                if low[node] == number[node]:
                    component: list[int] = []
                    while not component or component[-1] != node:
                        component.append(unfinished.pop())
                        of[component[-1]] = len(members)
                    members.append(component)
    return Components(members, of)
