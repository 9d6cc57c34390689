"""Run a real Bolt server (ArcadeDB): ``python bolt_server.py FOLDER BOLT_PORT HTTP_PORT PASSWORD DATABASE``.

It prints ``ready``. It ends when its standard input ends, so it never outlives the tests.
"""

import os
import sys


def main(folder: str, bolt_port: int, http_port: int, password: str, database: str) -> None:
    from arcadedb_embedded.server import ArcadeDBServer

    server = ArcadeDBServer(
        folder,
        root_password=password,
        config={
            "host": "127.0.0.1",
            "http_port": http_port,
            "server_plugins": "Bolt:com.arcadedb.bolt.BoltProtocolPlugin",
            "bolt_port": bolt_port,
        },
        # The tests are too short for the optimising compiler to pay off.
        jvm_kwargs={"heap_size": "256m", "jvm_args": ["-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC"]},
    )
    server.start()
    server.create_database(database)
    print("ready", flush=True)
    sys.stdin.read()
    os._exit(0)  # the data is no longer needed, and a normal end sometimes waits for connections


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), sys.argv[4], sys.argv[5])
