"""Readers of ROS 2 topics by Fast DDS, in place of Cyclone DDS's participant and readers.

`EERUF_FAST_DDS` names the program of `fast_dds.cpp`, which receives and decodes the samples.
"""

import json
import queue
import subprocess
import threading
from types import SimpleNamespace


class FastDds:
    """A participant in a process of its own."""

    def __init__(self, program, domain):
        command = [program, str(domain)]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        # Its ports are open.
        assert self.process.stdout.readline() == "ready\n"
        self.readers = {}
        self.thread = threading.Thread(target=self.hear)
        self.thread.start()

    def hear(self):
        for line in self.process.stdout:
            said = json.loads(line, object_hook=lambda fields: SimpleNamespace(**fields))
            reader = self.readers[said.topic]
            if hasattr(said, "writers"):
                reader.writers = said.writers
            else:
                reader.samples.put(said.sample)

    def reader(self, topic, kind, latched):
        """A reader of a topic; one participant has one of each."""
        assert topic not in self.readers
        self.readers[topic] = Reader(kind)
        durability = "latched" if latched else "volatile"
        self.process.stdin.write(f"{topic} {kind.__idl_typename__} {durability}\n")
        self.process.stdin.flush()
        return self.readers[topic]

    def close(self):
        self.process.stdin.close()
        assert self.process.wait(timeout=60) == 0
        self.thread.join()


class Reader:
    """Samples of a topic as objects of its kind, with the methods of Cyclone DDS's reader that the tests use."""

    def __init__(self, kind):
        self.kind = kind
        self.writers = 0
        self.samples = queue.SimpleQueue()

    def get_matched_publications(self):
        return range(self.writers)

    def take(self, N):
        samples = [self.samples.get() for _ in range(min(N, self.samples.qsize()))]
        # A string says why a sample could not be read.
        assert not any(isinstance(sample, str) for sample in samples), samples
        return [self.kind(**vars(sample)) for sample in samples]
