"""Memory as rules use it: operations on the graph, each done whole or not at all, in the order of the calls."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from typing import Any, TypeVar

from ravestate.errors import RuleError

from .graph import Graph
from .node import Node, Relation, Value
from .reply import Reply
from .store import Store
from .types import Types
from .worker import StoreWorker

__all__ = ["Memory"]

T = TypeVar("T")


class Memory:
    """A graph of what is known, open for use.

    Every operation returns a `Reply` at once: ``await`` it in an async rule, or call ``.result()`` on it in a plain
    function. Operations happen one after the other, in the order of the calls, in a thread of memory's own. What a
    reply acknowledges is on disk (or with the server), whatever happens next.

    All of them raise, when the reply is looked at:

    - RuleError: a type, property or relation that the types do not have, or a value of a wrong type;
    - PlatformError: memory failed: a full disk, a server that went away, a file in use.
    """

    def __init__(self, worker: StoreWorker, read_types: Callable[[], Types]) -> None:
        """Begin to open memory; operations may be called at once, and wait until it is open.

        Args:
            worker: What holds the graph, and the thread that may touch it; `close` releases it.
            read_types: Says what there may be in it; called in the thread.
        """
        self._worker = worker
        self._lock = threading.Lock()  # nothing is asked of the worker after it was released
        self._closed: Reply[None] | None = None
        self._types: Types | None = None
        self._failure: BaseException | None = None
        self._opened = Reply(worker.submit(lambda store: self._open(store, read_types)), "Memory.open")

    @property
    def place(self) -> str:
        """Where it is: a file's path, or a server's address."""
        return self._worker.place

    @property
    def types(self) -> Types:
        """What there may be in memory.

        Raises:
            RuleError: It is not open yet: ``await memory.opened()`` first.
        """
        if self._types is None:
            raise RuleError(f"memory ({self.place}) is not open: write await memory.opened() before")
        return self._types

    def opened(self) -> Reply[None]:
        """Wait until memory is open.

        Raises:
            PlatformError: It cannot be opened: a package is missing, the file is in use, broken or newer, the server
                refuses. The message says what to do. All operations raise it then.
            DeclarationError: A file of types is none, or contradicts another.
        """
        return self._opened

    def create(self, type: str, /, **properties: Value) -> Reply[Node]:
        """Make a new node.

        Example:
            ::

                ada = await memory.create("Person", name="Ada", born=date(1815, 12, 10))
        """
        return self._do("create", lambda graph: graph.save(Node(type, properties)))

    def ensure(self, type: str, /, **properties: Value) -> Reply[Node]:
        """The oldest node that matches, as by `find`, or a new one where there is none."""
        return self._do("ensure", lambda graph: graph.ensure(type, properties))

    def save(self, node: Node, /, *, of: str | None = None) -> Reply[Node]:
        """Write a node, a new one or one that is known: set the properties that it has, and remove those that are
        None. Others stay.

        Args:
            node: What to write.
            of: A type of which it must be, or of a subtype.

        Returns:
            The node with all that memory has of it.
        """
        return self._do("save", lambda graph: graph.save(node, of))

    def find(self, type: str, /, **properties: Value) -> Reply[list[Node]]:
        """All nodes of a type, subtypes included, with these values, oldest first; None matches what is not set."""
        return self._do("find", lambda graph: graph.find(type, properties))

    def get(self, id: str, /) -> Reply[Node | None]:
        """The node with this id; None if there is none."""
        return self._do("get", lambda graph: graph.get(id))

    def update(self, node: Node, /, **properties: Value) -> Reply[Node]:
        """Set properties of a node that is known, and remove those that are None.

        Raises:
            RuleError: Also when memory does not know the node, or no longer.
        """
        return self._do("update", lambda graph: graph.update(node, properties))

    def relate(self, node: Node, relation: str, other: Node, /, **properties: Value) -> Reply[None]:
        """Relate two nodes that are known; once related, it sets the relation's properties.

        Raises:
            RuleError: Also when memory does not know one of them.

        Example:
            ::

                await memory.relate(ada, "lives_in", await memory.ensure("City", name="London"))
        """
        return self._do("relate", lambda graph: graph.relate(node, relation, other, properties))

    def unrelate(self, node: Node, relation: str, other: Node, /, *, forget: bool = False) -> Reply[None]:
        """End a relation; without one it does nothing.

        Args:
            node: From which it leads.
            relation: Its name.
            other: Where it leads to.
            forget: Also forget `other`, unless something else is related to it, or it is an agent (a person, a robot) of
                which more than the name is known.
        """
        return self._do("unrelate", lambda graph: graph.unrelate(node, relation, other, forget=forget))

    def related(self, node: Node, relation: str, /, *, back: bool = False) -> Reply[list[Node]]:
        """The nodes to which `node` has a relation, oldest first; `back`: those that have it to `node`."""
        return self._do("related", lambda graph: graph.related(node, relation, back=back))

    def relations(self, node: Node, /) -> Reply[list[Relation]]:
        """All relations of a node: those from it, then those to it."""
        return self._do("relations", lambda graph: graph.relations(node))

    def merge(self, keep: Node, duplicate: Node, /) -> Reply[Node]:
        """Make one node of two: relations, and properties that `keep` lacks, move over; `duplicate` goes.

        Raises:
            RuleError: Also when `keep` is not of the duplicate's type or a subtype of it, or one is not known.
        """
        return self._do("merge", lambda graph: graph.merge(keep, duplicate))

    def forget(self, node: Node, /) -> Reply[list[Node]]:
        """Remove a node with everything about it: its relations, and what is known on its account alone.

        The latter are the nodes to which it is related, and those to which these are related, as long as nothing
        that stays is related to them. An agent (a person, a robot) of which more than the name is known stays.

        Returns:
            What was removed, `node` first; nothing if memory does not know it.
        """
        return self._do("forget", lambda graph: graph.forget(node))

    def only_about(self, node: Node, /) -> Reply[list[Node]]:
        """What `forget` would remove, `node` first."""
        return self._do("only_about", lambda graph: graph.only_about(node))

    def together(self, operations: Callable[[Graph], T], /) -> Reply[T]:
        """Several operations as one: all are done or none. In a file nobody else's come between; a server has rules of its own.

        Args:
            operations: Is called with the graph, in memory's thread. The graph has the operations of this class, done at once,
                with properties as mappings; it is not to be used later.

        Returns:
            What `operations` returns. What it raises takes back what it has done.

        Example:
            ::

                def befriend(graph):
                    ada = graph.ensure("Person", {"name": "Ada"})
                    graph.relate(ada, "friend_of", graph.ensure("Person", {"name": "Charles"}), {})
                    return ada

                ada = await memory.together(befriend)
        """
        return self._do("together", lambda graph: graph.together(operations))

    def export(self) -> Reply[dict[str, Any]]:
        """Everything, as a document that JSON can carry; `load` reads it."""
        return self._do("export", lambda graph: graph.export())

    def load(self, document: Mapping[str, Any], /) -> Reply[int]:
        """Save all nodes and relations of a document that `export` made, all or none; the number of nodes.

        Raises:
            RuleError: Also when it is no such document.
        """
        return self._do("load", lambda graph: graph.load(document))

    def undeclared(self) -> Reply[list[str]]:
        """The names of types that are in memory, and in no file of types: their nodes are there, and unseen."""
        return self._do("undeclared", lambda graph: graph.undeclared())

    def tidy(self) -> Reply[None]:
        """After many writes: give back the room in memory that they took. Nothing is known before that is not known after."""
        return self._do("tidy", lambda graph: graph.tidy())

    def close(self) -> Reply[None]:
        """Let go, after all operations before; called again it does nothing. Later operations are refused."""
        with self._lock:
            if self._closed is None:
                self._closed = Reply(self._worker.release(), "Memory.close")
            return self._closed

    def __repr__(self) -> str:
        return f"<memory {self.place}>"

    def _open(self, store: Store, read_types: Callable[[], Types]) -> None:
        """In the thread: look what there may be, and make room for it."""
        try:
            types = read_types()
            Graph(store, types).prepare()
            self._types = types
        except BaseException as error:
            self._failure = error
            raise

    def _do(self, name: str, operation: Callable[[Graph], T]) -> Reply[T]:
        def job(store: Store) -> T:
            if self._failure is not None:
                raise self._failure
            return operation(Graph(store, self.types))

        with self._lock:
            if self._closed is not None:
                raise RuleError(f"memory ({self.place}) is closed: {name} comes too late")
            return Reply(self._worker.submit(job), f"Memory.{name}")
