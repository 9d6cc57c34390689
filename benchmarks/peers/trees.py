"""py-trees, behaviour trees in Python: each input is one tick of a tree.

A tree has no rules, and nothing competes: the order in the tree decides. A sequence of k steps passes the input on over
the blackboard, and the last step answers. The fallback is the second child of a selector. The tree does less than the
other contestants: it does not find out which steps the input concerns.
"""

import itertools
import time

import py_trees
from py_trees.common import Access, Status
from wire import serve

Seconds = float


class Hop(py_trees.behaviour.Behaviour):
    """A step that copies one key of the blackboard to another."""

    def __init__(self, here: str, there: str) -> None:
        super().__init__(there)
        self.here, self.there = here, there
        self.board = self.attach_blackboard_client(there)
        self.board.register_key(here, Access.READ)
        self.board.register_key(there, Access.WRITE)

    def update(self) -> Status:
        self.board.set(self.there, self.board.get(self.here))
        return Status.SUCCESS


class Speak(py_trees.behaviour.Behaviour):
    """The last step, which says the text of a key."""

    def __init__(self, name: str, on: str, said: list[str]) -> None:
        super().__init__(name)
        self.on, self.said = on, said
        self.board = self.attach_blackboard_client(name)
        self.board.register_key(on, Access.READ)

    def update(self) -> Status:
        self.said.append(f"{self.name} {self.board.get(self.on)}")
        return Status.SUCCESS


def answer(k: int, inputs: int) -> list[Seconds]:
    """Measure inputs one after another. The step at the end of a chain of k steps answers each input."""
    said: list[str] = []
    names = ["input", *(f"signal{i}" for i in range(1, k + 1))]
    chain = py_trees.composites.Sequence("chain", memory=False)
    chain.add_children([Hop(here, there) for here, there in itertools.pairwise(names)])
    chain.add_child(Speak("answer", names[-1], said))
    root = py_trees.composites.Selector("root", memory=False, children=[chain, Speak("fallback", "input", said)])
    outside = py_trees.blackboard.Client(name="outside")
    outside.register_key("input", Access.WRITE)
    times = []
    for n in range(inputs):
        said.clear()
        begin = time.perf_counter()
        outside.set("input", f"word {n}")
        root.tick_once()
        times.append(time.perf_counter() - begin)
        assert said == [f"answer word {n}"], said
    return times


if __name__ == "__main__":
    serve(answer)
