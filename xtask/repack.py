"""Repacks a wheel, alike in whatever folder it was built: `python repack.py WHEEL`.

The bill of materials that maturin writes names packages by the folder that they were built in; here they are named
from the repository's root.
"""

import base64
import hashlib
import re
import sys
import zipfile
from pathlib import Path

wheel = Path(sys.argv[1])
with zipfile.ZipFile(wheel) as old:
    entries = [(info, old.read(info)) for info in old.infolist()]


def alike(name: str, content: bytes) -> bytes:
    """Name packages from the repository's root."""
    if "/sboms/" not in name:
        return content
    return re.sub(rb'path\+file://[^#"]*?(/crates/[a-z0-9-]+)?(?=#)', rb"path+file:///eeruf\1", content)


contents = {info.filename: alike(info.filename, content) for info, content in entries}
record = next(name for name in contents if name.endswith(".dist-info/RECORD"))
lines = []
for name, content in contents.items():
    if name == record:
        lines.append(f"{name},,")
    else:
        sum_ = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode().rstrip("=")
        lines.append(f"{name},sha256={sum_},{len(content)}")
contents[record] = ("\n".join(lines) + "\n").encode()

packed = wheel.with_suffix(".packed")
with zipfile.ZipFile(packed, "w") as new:
    for info, _ in entries:
        entry = zipfile.ZipInfo(info.filename, info.date_time)
        entry.external_attr = info.external_attr
        new.writestr(entry, contents[info.filename], zipfile.ZIP_DEFLATED, 9)
print(f"{wheel.name}: {wheel.stat().st_size} bytes, repacked {packed.stat().st_size}")
packed.replace(wheel)
