"""Memory as rules use it: atomic operations on the graph, in the order of the calls."""

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

T = TypeVar("T")


class Memory:
    """The open graph of an agent's knowledge.

    Every operation returns a `Reply` at once: ``await`` it in an async rule, or call ``.result()`` on it in a plain
    function. Operations run one after the other, in the order of the calls, in memory's thread. Once a reply has its
    result, the write is on disk or with the server.

    The reply of each operation may raise:

    - RuleError: an undeclared type, property or relation, or a value of a wrong type;
    - PlatformError: memory failed: a full disk, a server that does not answer, a file in use.
    """

    def __init__(self, worker: StoreWorker, read_types: Callable[[], Types]) -> None:
        """Start to open memory. You may call operations at once; they wait until memory is open.

        Args:
            worker: The thread of the store; `close` releases it.
            read_types: A function that reads the types; called in that thread.
        """
        self._worker = worker
        self._lock = threading.Lock()  # so that no job is queued after the release
        self._closed: Reply[None] | None = None

        def prepared(store: Store) -> Types:
            types = read_types()
            Graph(store, types).prepare()
            return types

        self._prepared = worker.submit(prepared)
        self._opened = Reply(self._prepared, "Memory.open")

    @property
    def place(self) -> str:
        """The place of memory: the file's path or the server's address."""
        return self._worker.place

    @property
    def types(self) -> Types:
        """The declared types of nodes and relations."""
        if not self._prepared.done() or self._prepared.exception() is not None:
            raise RuleError(f"memory ({self.place}) is not open: write await memory.opened() first")
        return self._prepared.result()

    def opened(self) -> Reply[Types]:
        """Wait until memory is open; return its types.

        Raises:
            PlatformError: A package is missing; the file is in use, damaged or of a newer version; or the server
                refuses. The message says what to do. All operations raise it too.
            DeclarationError: A file of types is invalid, or contradicts another.
        """
        return self._opened

    def create(self, type: str, /, **properties: Value) -> Reply[Node]:
        """Create a node with these properties.

        Example:
            ::

                ada = await memory.create("Person", name="Ada", born=date(1815, 12, 10))
        """
        return self._do("create", lambda graph: graph.save(Node(type, properties)))

    def ensure(self, type: str, /, **properties: Value) -> Reply[Node]:
        """Return the oldest node that `find` would return, or create a new one."""
        return self._do("ensure", lambda graph: graph.ensure(type, properties))

    def save(self, node: Node, /, *, of: str | None = None) -> Reply[Node]:
        """Write a node to memory: set its properties, remove those that are None, and keep the others in memory.

        Args:
            node: The node to write.
            of: The type that the node must have; subtypes are allowed.

        Returns:
            The node with all of its properties in memory.
        """
        return self._do("save", lambda graph: graph.save(node, of))

    def find(self, type: str, /, **properties: Value) -> Reply[list[Node]]:
        """Return all nodes of a type or its subtypes with these properties, oldest first. None matches no value."""
        return self._do("find", lambda graph: graph.find(type, properties))

    def get(self, id: str, /) -> Reply[Node | None]:
        """Return the node with this id; None if memory does not have it."""
        return self._do("get", lambda graph: graph.get(id))

    def update(self, node: Node, /, **properties: Value) -> Reply[Node]:
        """Set properties of a node that memory has, and remove those that are None."""
        return self._do("update", lambda graph: graph.update(node, properties))

    def relate(self, node: Node, relation: str, other: Node, /, **properties: Value) -> Reply[None]:
        """Relate two nodes that memory has; if they are related already, set the relation's properties.

        Raises:
            RuleError: Memory does not have one of the nodes. For other causes, see the class.

        Example:
            ::

                await memory.relate(ada, "lives_in", await memory.ensure("City", name="London"))
        """
        return self._do("relate", lambda graph: graph.relate(node, relation, other, properties))

    def unrelate(self, node: Node, relation: str, other: Node, /, *, forget: bool = False) -> Reply[None]:
        """Remove a relation, if there is one.

        Args:
            node: The source of the relation.
            relation: The relation's name.
            other: The target of the relation.
            forget: Whether to forget `other` too, unless another node is related to it. A person or robot with more
                than a name stays as well.
        """
        return self._do("unrelate", lambda graph: graph.unrelate(node, relation, other, forget=forget))

    def related(self, node: Node, relation: str, /, *, back: bool = False) -> Reply[list[Node]]:
        """Return the targets of a relation from `node`, oldest first; with `back`, the sources of a relation to it."""
        return self._do("related", lambda graph: graph.related(node, relation, back=back))

    def relations(self, node: Node, /) -> Reply[list[Relation]]:
        """Return all relations of a node: those from it, then those to it."""
        return self._do("relations", lambda graph: graph.relations(node))

    def merge(self, keep: Node, duplicate: Node, /) -> Reply[Node]:
        """Merge two nodes: `keep` gets the duplicate's relations, and the properties that it lacks.

        Raises:
            RuleError: The types do not fit: `keep` must have the duplicate's type or a subtype. Or memory does not have
                one of the nodes.
        """
        return self._do("merge", lambda graph: graph.merge(keep, duplicate))

    def forget(self, node: Node, /) -> Reply[list[Node]]:
        """Remove a node, its relations, and the nodes that only this node needs. The file keeps none of their bytes.

        A node needs its relations' targets, and their targets in turn. These targets stay if a node that stays is
        related to them. A person or robot with more than a name stays as well.

        Returns:
            The removed nodes, `node` first; an empty list if memory does not have `node`.
        """
        return self._do("forget", lambda graph: graph.forget(node))

    def only_about(self, node: Node, /) -> Reply[list[Node]]:
        """Return the nodes that `forget` would remove, `node` first."""
        return self._do("only_about", lambda graph: graph.only_about(node))

    def together(self, operations: Callable[[Graph], T], /) -> Reply[T]:
        """Run several operations as one: all take effect, or none. In a file, no other operation runs between them.

        Args:
            operations: A function of the graph, called in memory's thread. The graph has the operations of this class.
                There, the operations return plain results, and take properties as mappings. Do not keep the graph.

        Returns:
            The result of the function. If it raises an exception, all of its operations are rolled back.

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
        """Return all nodes and relations as a document for JSON, which `load` reads."""
        return self._do("export", lambda graph: graph.export())

    def load(self, document: Mapping[str, Any], /) -> Reply[int]:
        """Save all nodes and relations of a document from `export`, or none; return the number of nodes."""
        return self._do("load", lambda graph: graph.load(document))

    def undeclared(self) -> Reply[list[str]]:
        """Return the names of the types that have nodes in memory, but that no file of types declares."""
        return self._do("undeclared", lambda graph: graph.undeclared())

    def tidy(self) -> Reply[None]:
        """Move the log of writes into the database: after many writes, this frees main memory."""
        return self._do("tidy", lambda graph: graph.tidy())

    def close(self) -> Reply[None]:
        """Close memory after all earlier operations. Later operations raise RuleError."""
        with self._lock:
            if self._closed is None:
                self._closed = Reply(self._worker.release(), "Memory.close")
            return self._closed

    def __repr__(self) -> str:
        return f"<memory {self.place}>"

    def _do(self, name: str, operation: Callable[[Graph], T]) -> Reply[T]:
        with self._lock:
            if self._closed is not None:
                raise RuleError(f"memory ({self.place}) is closed: {name} comes too late")
            job = self._worker.submit(lambda store: operation(Graph(store, self._prepared.result())))
            return Reply(job, f"Memory.{name}")
