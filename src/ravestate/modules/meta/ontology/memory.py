"""Memory as rules use it: atomic operations on the graph, in the order of the calls."""

from __future__ import annotations

import functools
import threading
from collections.abc import Callable
from typing import Concatenate, ParamSpec, TypeVar

from ravestate.errors import RuleError

from .graph import Graph
from .node import Node, Value
from .reply import Reply
from .store import Store
from .types import Types
from .worker import StoreWorker

P = ParamSpec("P")
T = TypeVar("T")


def _operation(method: Callable[Concatenate[Graph, P], T]) -> Callable[Concatenate[Memory, P], Reply[T]]:
    """Return a method of `Memory` that runs a method of `Graph` in memory's thread."""

    @functools.wraps(method)
    def operation(memory: Memory, *args: P.args, **options: P.kwargs) -> Reply[T]:
        return memory.submit(method.__name__, lambda graph: method(graph, *args, **options))

    return operation


class Memory:
    """The open graph of an agent's knowledge.

    Every operation returns a `Reply` immediately. In an async rule, ``await`` the reply; in a plain function, call its
    method ``result()``. Operations run one at a time, in the order of the calls, in memory's thread. When the reply to
    a write has its result, the data is on the disk or on the server.

    Each reply may raise:

    - RuleError: an undeclared type, property or relation, or a value of a wrong type;
    - PlatformError: memory failed: a full disk, a server that does not answer, a file in use.
    """

    def __init__(self, worker: StoreWorker, read_types: Callable[[], Types]) -> None:
        """Start to open memory. You may call operations immediately; they wait until memory is open.

        Args:
            worker: The thread of the store; `close` releases it.
            read_types: A function that reads the types. Memory calls it in that thread.
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
        """The declared types of nodes and relations.

        Raises:
            RuleError: Memory is not open yet, or could not be opened.
        """
        if not self._prepared.done() or self._prepared.exception() is not None:
            raise RuleError(f"memory ({self.place}) is not open: write await memory.opened() first")
        return self._prepared.result()

    def opened(self) -> Reply[Types]:
        """Wait until memory is open; return its types.

        Raises:
            PlatformError: A package is missing; the file is in use, damaged or of a newer version; or the server refuses
                the connection. The message says what to do. All other operations then raise the same error.
            DeclarationError: A file of types is invalid, or contradicts another file.
        """
        return self._opened

    def create(self, type: str, /, **properties: Value) -> Reply[Node]:
        """Create a node with these properties.

        Example:
            ::

                ada = await memory.create("Person", name="Ada", born=date(1815, 12, 10))
        """
        return self.submit("create", lambda graph: graph.save(Node(type, properties)))

    def ensure(self, type: str, /, **properties: Value) -> Reply[Node]:
        """Return the oldest node that `find` would return. If `find` would return no node, create one."""
        return self.submit("ensure", lambda graph: graph.ensure(type, properties))

    save = _operation(Graph.save)

    def find(self, type: str, /, **properties: Value) -> Reply[list[Node]]:
        """Return all nodes of a type or its subtypes with these properties, oldest first.

        If you pass None for a property, the nodes that have no value for this property match.
        """
        return self.submit("find", lambda graph: graph.find(type, properties))

    get = _operation(Graph.get)

    def update(self, node: Node, /, **properties: Value) -> Reply[Node]:
        """Set properties of a node that memory has, and remove the properties for which you pass None."""
        return self.submit("update", lambda graph: graph.update(node, properties))

    def relate(self, node: Node, relation: str, other: Node, /, **properties: Value) -> Reply[None]:
        """Relate two nodes that memory has; if they are related already, set the relation's properties.

        Raises:
            RuleError: Memory does not have one of the nodes. For other causes, see the class.

        Example:
            ::

                await memory.relate(ada, "lives_in", await memory.ensure("City", name="London"))
        """
        return self.submit("relate", lambda graph: graph.relate(node, relation, other, properties))

    unrelate = _operation(Graph.unrelate)
    related = _operation(Graph.related)
    relations = _operation(Graph.relations)
    merge = _operation(Graph.merge)
    forget = _operation(Graph.forget)
    only_about = _operation(Graph.only_about)
    export = _operation(Graph.export)
    load = _operation(Graph.load)
    undeclared = _operation(Graph.undeclared)
    tidy = _operation(Graph.tidy)
    purge = _operation(Graph.purge)

    def together(self, operations: Callable[[Graph], T], /) -> Reply[T]:
        """Run several operations as one transaction: either all operations take effect, or none.

        If memory is a file, no other operation runs between these operations. On a server, operations of other programs
        may.

        Args:
            operations: A function that takes a `Graph`. Memory calls it in memory's thread. A `Graph` has the operations
                of this class except `create`. They return plain results, and take properties as mappings. Do not use
                the `Graph` after the function has returned.

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
        return self.submit("together", lambda graph: graph.together(operations))

    def close(self) -> Reply[None]:
        """Close memory after all earlier operations. Later operations raise RuleError."""
        with self._lock:
            if self._closed is None:
                self._closed = Reply(self._worker.release(), "Memory.close")
            return self._closed

    def __repr__(self) -> str:
        return f"<memory {self.place}>"

    def submit(self, name: str, operation: Callable[[Graph], T]) -> Reply[T]:
        """Queue an operation for memory's thread; `name` is for messages."""
        with self._lock:
            if self._closed is not None:
                raise RuleError(f"memory ({self.place}) is closed: {name} comes too late")
            job = self._worker.submit(lambda store: operation(Graph(store, self._prepared.result())))
            return Reply(job, f"Memory.{name}")
