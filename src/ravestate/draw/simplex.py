"""Layer assignment with short edges: the network simplex of Gansner, Koutsofios, North and Vo (1993).

An arc is tight if it has its minimum length. A spanning tree of tight arcs fixes all ranks (layers). If one arc of the
tree is removed, the tree falls into two sides. The arc's cut value is the sum of (weight out - weight in) over the
vertices on the side of the arc's tail. An arc with a negative cut value should be longer, so it leaves the tree. The
tightest arc that crosses between the two sides in the other direction takes its place. This is one *exchange*.
"""

from __future__ import annotations

from collections.abc import Sequence

from ravestate.draw.acyclic import topological

Arc = tuple[int, int, int, int]
"""An arc: its tail, its head, its weight, and its minimum length in layers."""

_WORK = 2_000_000  # the maximum number of exchanges times vertices


def network_simplex(count: int, arcs: Sequence[Arc]) -> list[int]:
    """Return the layer, from 0, of each vertex of an acyclic, connected graph with `count` vertices.

    Each arc spans at least its minimum length, and the sum of weight x span is minimal. The number of exchanges is
    bounded, so in large graphs the sum may be slightly above the minimum.

    Raises:
        ValueError: The graph has a cycle, or is not connected.
    """
    if count == 0:
        return []
    surplus = [0] * count  # vertex → the weight of its outgoing arcs minus the weight of its incoming arcs
    for u, v, weight, _ in arcs:
        surplus[u] += weight
        surplus[v] -= weight
    rank = _longest_paths(count, arcs)
    tree = _tight_tree(rank, arcs)
    for _ in range(min(50 + 4 * count, _WORK // count)):
        leaving, side = _worst_cut(arcs, tree, surplus)
        if not side:
            break
        # The arc gets longer if its tail moves to an earlier layer, or if its head moves to a later layer.
        back = arcs[leaving][0] in side
        slack, entering = min(
            (rank[v] - rank[u] - length, i)
            for i, (u, v, _, length) in enumerate(arcs)
            if (u in side) != back and (v in side) == back
        )
        for v in side:
            rank[v] += -slack if back else slack
        tree[tree.index(leaving)] = entering
    return _balanced(rank, arcs, surplus)


def _longest_paths(count: int, arcs: Sequence[Arc]) -> list[int]:
    after: list[list[tuple[int, int]]] = [[] for _ in range(count)]
    for u, v, _, length in arcs:
        after[u].append((v, length))
    rank = [0] * count
    order = topological([[v for v, _ in ahead] for ahead in after])
    for u in order:
        for v, length in after[u]:
            rank[v] = max(rank[v], rank[u] + length)
    if len(order) < count:
        raise ValueError("the graph has a cycle")
    return rank


def _tight_tree(rank: list[int], arcs: Sequence[Arc]) -> list[int]:
    """Return a spanning tree of tight arcs. For each new arc, the tree shifts in `rank` until the arc is tight."""
    tree: list[int] = []
    inside = {0}
    while len(inside) < len(rank):
        crossing = [i for i, (u, v, _, _) in enumerate(arcs) if (u in inside) != (v in inside)]
        if not crossing:
            raise ValueError("the graph is not connected: lay out its components one by one")
        slack, i = min((rank[arcs[i][1]] - rank[arcs[i][0]] - arcs[i][3], i) for i in crossing)
        shift = slack if arcs[i][0] in inside else -slack
        for v in inside if shift else ():
            rank[v] += shift
        tree.append(i)
        inside.update(arcs[i][:2])
    return tree


def _worst_cut(arcs: Sequence[Arc], tree: Sequence[int], surplus: Sequence[int]) -> tuple[int, set[int]]:
    """Return the tree arc with the least cut value, and one of its sides. If no value is negative, the side is empty."""
    near: list[list[int]] = [[] for _ in surplus]
    for arc in tree:
        for end in arcs[arc][:2]:
            near[end].append(arc)
    order: list[tuple[int, int]] = []  # in preorder: a vertex, and its tree arc towards the root
    ahead = [(0, -1)]
    while ahead:
        v, above = ahead.pop()
        order.append((v, above))
        ahead += [(sum(arcs[arc][:2]) - v, arc) for arc in near[v] if arc != above]
    total, size = list(surplus), [1] * len(surplus)  # the sums over each vertex's subtree
    worst = (0, 0)
    for place in range(len(order) - 1, 0, -1):
        v, above = order[place]
        worst = min(worst, (total[v] if arcs[above][0] == v else -total[v], place))
        parent = sum(arcs[above][:2]) - v
        total[parent] += total[v]
        size[parent] += size[v]
    if worst[0] == 0:
        return -1, set()
    top, leaving = order[worst[1]]
    return leaving, {v for v, _ in order[worst[1] : worst[1] + size[top]]}


def _balanced(rank: list[int], arcs: Sequence[Arc], surplus: Sequence[int]) -> list[int]:
    """Shift the ranks so that they begin at 0, and return them.

    If several ranks cost the same, a vertex takes the rank with the fewest vertices.
    """
    least = min(rank)
    rank = [r - least for r in rank]
    size = [rank.count(r) for r in range(max(rank) + 1)]
    for v in range(len(rank)):
        if surplus[v]:
            continue
        first = max((rank[u] + length for u, w, _, length in arcs if w == v), default=0)
        last = min((rank[w] - length for u, w, _, length in arcs if u == v), default=len(size) - 1)
        best = min(range(first, last + 1), key=lambda r: (size[r] - (r == rank[v]), abs(r - rank[v]), r))
        size[rank[v]] -= 1
        size[best] += 1
        rank[v] = best
    return rank
