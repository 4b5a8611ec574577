"""Read a log from a web server by fsspec, in little memory: `python tests/python/far_log.py READINGS`.

A table of eight sensors is judged block by block and written as MCAP; the MCAP is read the same way. Prints counts, time
and peak memory as JSON; fails if the peak is more than 200 MB.
"""

import json
import re
import subprocess
import sys
import tempfile
import time
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import eeruf

SENSORS = 8
MOST_MB = 200


class Ranges(SimpleHTTPRequestHandler):
    """A server that gives parts of files, as object stores do."""

    protocol_version = "HTTP/1.1"

    def do_GET(self) -> None:
        if "Range" not in self.headers:
            return super().do_GET()
        path = Path(self.translate_path(self.path))
        first, last = self.headers["Range"].removeprefix("bytes=").split("-")
        length = int(last) - int(first) + 1
        self.send_response(206)
        self.send_header("Content-Range", f"bytes {first}-{last}/{path.stat().st_size}")
        self.send_header("Content-Length", str(length))
        self.end_headers()
        with path.open("rb") as file:
            file.seek(int(first))
            self.wfile.write(file.read(length))
        return None

    def end_headers(self) -> None:
        self.send_header("Accept-Ranges", "bytes")
        super().end_headers()

    def log_message(self, format: str, *args: Any) -> None:
        pass


def write(file: Path, readings: int) -> None:
    """Write echoes that stay for two rows each, in metres with three decimals."""
    with file.open("w") as out:
        out.write("t_us," + ",".join(f"sonar_{sensor}" for sensor in range(SENSORS)) + "\n")
        for row in range(readings // SENSORS):
            cells = ",".join(
                f"{0.3 + 0.001 * ((row // 2 * 37 + 101 * sensor) % 4000):.3f}" for sensor in range(SENSORS)
            )
            out.write(f"{60_000 * row},{cells}\n")


def read(url: str, **judging: Any) -> dict[str, Any]:
    """Read a log, and return counts and time."""
    begun, readings, metres, accepted = time.monotonic(), 0, 0.0, 0
    for block in eeruf.logs.blocks(url, **judging):
        readings += len(block)
        metres += float(block.range_m.sum())
        if isinstance(block, eeruf.typing.Judged):
            accepted += int((block.kind == eeruf.KINDS.index("accepted")).sum())
    seconds = round(time.monotonic() - begun, 1)
    return {"readings": readings, "metres": metres, "accepted": accepted, "damage": block.damage, "seconds": seconds}


def largest_mb() -> float:
    """Return the peak memory of this program; `ru_maxrss` would begin with that of its parent."""
    found = re.search(r"VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text())
    assert found is not None
    return round(int(found[1]) / 1024, 1)


def main(readings: int) -> None:
    """Serve from another process, and read in this one."""
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder) / "log.csv", readings)
        serve = subprocess.Popen([sys.executable, __file__, "serve", folder], stdout=subprocess.PIPE, text=True)
        try:
            assert serve.stdout is not None
            url = f"http://127.0.0.1:{int(serve.stdout.readline())}"
            judge, out = eeruf.logs.Agree(t_delta_us=20), Path(folder) / "judged.mcap"
            found: dict[str, Any] = {
                "table": read(f"{url}/log.csv", judge=judge, out=out),
                "mcap": read(f"{url}/judged.mcap"),
                "largest_mb": largest_mb(),
            }
        finally:
            serve.kill()
            serve.wait()
    print(json.dumps(found))
    if found["largest_mb"] > MOST_MB:
        sys.exit(f"{found['largest_mb']} MB of memory; expected at most {MOST_MB}")


if __name__ == "__main__":
    if sys.argv[1] == "serve":
        server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Ranges, directory=sys.argv[2]))
        print(server.server_port, flush=True)
        server.serve_forever()
    main(int(sys.argv[1]))
