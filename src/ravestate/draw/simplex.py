"""Layer assignment with short edges: the network simplex of Gansner, Koutsofios, North and Vo (1993).

A spanning tree of tight arcs fixes all ranks. A tree arc with a negative cut value should be longer: it leaves the
tree, and the tightest arc that crosses the cut in the other direction takes its place. The cut value of a tree arc is
the sum of (weight out - weight in) over the vertices on the side of its tail. Arcs within that side cancel out.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence

from ravestate.draw.acyclic import topological

Arc = tuple[int, int, int, int]
"""An arc: its tail, its head, its weight, and its minimum length in layers."""

_SAMPLE = 30  # candidates for the leaving arc to compare before one is chosen
_WORK = 2_000_000  # the maximum of exchanges x vertices


def network_simplex(count: int, arcs: Sequence[Arc]) -> list[int]:
    """Return the layer, from 0, of each vertex of an acyclic, connected graph with `count` vertices.

    Each arc spans at least its length, and the sum of weight x span is minimal. The number of exchanges is bounded: in
    large graphs the sum may be slightly above the minimum.

    Raises:
        ValueError: The graph has a cycle, or is not connected.
    """
    if count == 0:
        return []
    simplex = _Simplex(count, arcs)
    simplex.exchange_all(limit=min(50 + 4 * count, _WORK // count))
    return simplex.balance()


class _Simplex:
    def __init__(self, count: int, arcs: Sequence[Arc]) -> None:
        self.count = count
        self.arcs = arcs
        self.incident: list[list[int]] = [[] for _ in range(count)]
        self.surplus = [0] * count  # vertex → weight out - weight in
        for i, (u, v, weight, _) in enumerate(arcs):
            self.incident[u].append(i)
            self.incident[v].append(i)
            self.surplus[u] += weight
            self.surplus[v] -= weight
        self.rank = _longest_paths(count, arcs)
        self.tree_arcs: list[list[int]] = [[] for _ in range(count)]  # vertex → its tree arcs
        self.parent = [-1] * count  # vertex → its tree arc towards the root
        self.low = [0] * count  # vertex → the least postorder number in its subtree
        self.number = [0] * count
        self.vertex = [0] * count  # postorder number → vertex
        self.total = [0] * count  # vertex → the surplus of its subtree
        self.tree: list[int] = []
        self.tight_tree()
        self.number_subtree(0, 0)

    def slack(self, arc: int) -> int:
        u, v, _, length = self.arcs[arc]
        return self.rank[v] - self.rank[u] - length

    def tight_tree(self) -> None:
        """Find a spanning tree of tight arcs: for each new arc, shift the whole tree until the arc is tight."""
        moved = 0  # the shift of the tree so far; ranks in the tree are stored without it
        inside = [False] * self.count
        ahead: list[tuple[int, int]] = []  # (slack + moved, arc) for arcs out of the tree
        behind: list[tuple[int, int]] = []  # (slack - moved, arc) for arcs into the tree

        def join(v: int) -> None:
            inside[v] = True
            for arc in self.incident[v]:
                u, w, _, _ = self.arcs[arc]
                if u == v and not inside[w]:
                    heapq.heappush(ahead, (self.slack(arc), arc))
                elif w == v and not inside[u]:
                    heapq.heappush(behind, (self.slack(arc), arc))

        join(0)
        while len(self.tree) < self.count - 1:
            while ahead and inside[self.arcs[ahead[0][1]][1]]:
                heapq.heappop(ahead)
            while behind and inside[self.arcs[behind[0][1]][0]]:
                heapq.heappop(behind)
            if not ahead and not behind:
                raise ValueError("the graph is not connected: lay out its components one by one")
            forward = ahead[0][0] - moved if ahead else None
            backward = behind[0][0] + moved if behind else None
            if backward is None or (forward is not None and forward <= backward):
                key, arc = heapq.heappop(ahead)
                moved += key - moved
                new = self.arcs[arc][1]
            else:
                key, arc = heapq.heappop(behind)
                moved -= key + moved
                new = self.arcs[arc][0]
            self.tree.append(arc)
            self.tree_arcs[self.arcs[arc][0]].append(arc)
            self.tree_arcs[self.arcs[arc][1]].append(arc)
            self.rank[new] -= moved
            join(new)

    def number_subtree(self, root: int, start: int) -> None:
        """Number the subtree of `root` in postorder from `start`, and sum up its surplus."""
        self.low[root] = start
        counter = start
        path = [(root, iter(self.tree_arcs[root]))]
        self.total[root] = self.surplus[root]
        while path:
            v, rest = path[-1]
            for arc in rest:
                if arc == self.parent[v]:
                    continue
                u, w, _, _ = self.arcs[arc]
                child = w if u == v else u
                self.parent[child] = arc
                self.low[child] = counter
                self.total[child] = self.surplus[child]
                path.append((child, iter(self.tree_arcs[child])))
                break
            else:
                path.pop()
                self.number[v] = counter
                self.vertex[counter] = v
                counter += 1
                if path:
                    self.total[path[-1][0]] += self.total[v]

    def child(self, arc: int) -> int:
        u, v, _, _ = self.arcs[arc]
        return u if self.parent[u] == arc else v

    def cut_value(self, arc: int) -> int:
        child = self.child(arc)
        return self.total[child] if child == self.arcs[arc][0] else -self.total[child]

    def exchange_all(self, limit: int) -> None:
        at = 0
        for _ in range(limit):
            best, found, worst = -1, 0, 0
            for step in range(len(self.tree)):
                place = (at + step) % len(self.tree)
                value = self.cut_value(self.tree[place])
                if value < 0:
                    found += 1
                    if value < worst:
                        best, worst = place, value
                    if found == _SAMPLE:
                        break
            if best < 0 or not self.exchange(best):
                return
            at = best

    def exchange(self, place: int) -> bool:
        leaving = self.tree[place]
        child = self.child(leaving)
        tail_side = child == self.arcs[leaving][0]
        low, high = self.low[child], self.number[child]
        entering, least = -1, 0
        for number in range(low, high + 1):
            v = self.vertex[number]
            for arc in self.incident[v]:
                u, w, _, _ = self.arcs[arc]
                if (w if tail_side else u) != v or low <= self.number[u if tail_side else w] <= high:
                    continue
                slack = self.slack(arc)
                if entering < 0 or slack < least:
                    entering, least = arc, slack
        if entering < 0:
            return False
        move = -least if tail_side else least
        for number in range(low, high + 1):
            self.rank[self.vertex[number]] += move
        for arc, keep in ((leaving, False), (entering, True)):
            for end in self.arcs[arc][:2]:
                if keep:
                    self.tree_arcs[end].append(arc)
                else:
                    self.tree_arcs[end].remove(arc)
        self.tree[place] = entering
        top = child  # the lowest common ancestor of both arcs
        u, v, _, _ = self.arcs[entering]
        while not (
            self.low[top] <= self.number[u] <= self.number[top] and self.low[top] <= self.number[v] <= self.number[top]
        ):
            a, b, _, _ = self.arcs[self.parent[top]]
            top = b if a == top else a
        self.number_subtree(top, self.low[top])
        return True

    def balance(self) -> list[int]:
        """Return the ranks after each vertex with several equally good ranks moved to the smallest of these layers."""
        least = min(self.rank)
        rank = [r - least for r in self.rank]
        size = [0] * (max(rank) + 1)
        for r in rank:
            size[r] += 1
        for v in range(self.count):
            if self.surplus[v] or not self.incident[v]:
                continue
            first, last = 0, len(size) - 1
            for arc in self.incident[v]:
                u, w, _, length = self.arcs[arc]
                if w == v:
                    first = max(first, rank[u] + length)
                else:
                    last = min(last, rank[w] - length)
            best = min(range(first, last + 1), key=lambda r: (size[r] - (r == rank[v]), abs(r - rank[v]), r))
            size[rank[v]] -= 1
            size[best] += 1
            rank[v] = best
        return rank


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
