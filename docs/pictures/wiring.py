"""Draws which pin of a board goes to which module: python docs/pictures/wiring.py [FOLDER]

The pins are those of the table in each example's README. FOLDER is where the pictures go; without it each goes beside its README.
"""

import re
import sys
from pathlib import Path
from xml.sax.saxutils import escape

EXAMPLES = Path(__file__).parents[2] / "examples"
# The title, the width in the picture, and down each column of pins their names, USB above: columns of the left side from the
# outside in, those of the right side from the inside out. A slash is a gap between two connectors.
BOARDS = {
    "pico": (
        "Raspberry Pi Pico",
        150,
        ["GP0 GP1 GND GP2 GP3 GP4 GP5 GND GP6 GP7 GP8 GP9 GND GP10 GP11 GP12 GP13 GND GP14 GP15"],
        ["VBUS VSYS GND 3V3_EN 3V3 VREF GP28 GND GP27 GP26 RUN GP22 GND GP21 GP20 GP19 GP18 GND GP17 GP16"],
    ),
    "uno": (
        "Arduino Uno",
        190,
        ["- IOREF RESET 3V3 5V GND GND VIN / A0 A1 A2 A3 A4 A5"],
        ["SCL SDA AREF GND 13 12 11 10 9 8 / 7 6 5 4 3 2 1 0"],
    ),
    "esp32-c3": (
        "ESP32-C3-DevKitM-1",
        150,
        ["GND GPIO19 GPIO18 GND GPIO4 GPIO5 GPIO6 GPIO7 GND GPIO8 GPIO9 GND RX TX GND"],
        ["GND 5V 5V GND GPIO10 GPIO1 GPIO0 GND RST GND GPIO3 GPIO2 3V3 3V3 GND"],
    ),
    "nucleo-f401": (
        "Nucleo-F401RE",
        330,
        [
            "PC10 PC12 VDD BOOT0 - - PA13 PA14 PA15 GND PB7 PC13 PC14 PC15 PH0 PH1 VBAT PC2 PC3",
            "PC11 PD2 E5V GND - IOREF RESET 3V3 5V GND GND VIN - PA0 PA1 PA4 PB0 PC1 PC0",
        ],
        [
            "PC9 PB8 PB9 AVDD GND PA5 PA6 PA7 PB6 PC7 PA9 PA8 PB10 PB4 PB5 PB3 PA10 PA2 PA3",
            "PC8 PC6 PC5 U5V - PA12 PA11 PB12 - GND PB2 PB1 PB15 PB14 PB13 AGND PC4 - -",
        ],
    ),
    "raspberry-pi": (
        "Raspberry Pi, 40 pins",
        42,
        [
            "3V3 GPIO2 GPIO3 GPIO4 GND GPIO17 GPIO27 GPIO22 3V3 GPIO10 GPIO9 GPIO11 GND ID_SD GPIO5 GPIO6 GPIO13 GPIO19 GPIO26 GND",
        ],
        [
            "5V 5V GND GPIO14 GPIO15 GPIO18 GND GPIO23 GPIO24 GND GPIO25 GPIO8 GPIO7 ID_SC GND GPIO12 GND GPIO16 GPIO20 GPIO21",
        ],
    ),
}
SUPPLY = {"VBUS", "5V"}
TRIG, ECHO, FIVE_VOLTS, GROUND, UNUSED = "#c8553d", "#2a6f97", "#b5179e", "#343a40", "#adb5bd"
PITCH, TOP, LABEL = 22, 70, 128


def pins(board):
    """Return the uses of pins from the table of the README: {"GP0": "Trig 1"}."""
    names_of_board = " ".join(BOARDS[board][2] + BOARDS[board][3]).split()
    used = {}
    for line in (EXAMPLES / board / "README.md").read_text().splitlines():
        row = re.match(r"\| (Trig|Echo)\b[^|]*\|(.*)\|$", line)
        for module, cell in enumerate(row[2].split("|"), 1) if row else ():
            # Of "D2 (PA10)" the name in the rows of pins.
            names = re.findall(r"[A-Z]*\d+", cell.replace("GPIO ", "GPIO"))
            known = [name for name in names if name in names_of_board]
            assert len(known) == 1 and known[0] not in used, f"{board}: {cell.strip()}"
            used[known[0]] = f"{row[1]} {module}"
    assert used, f"{board}: no table of pins"
    return used


def text(x, y, said, anchor="start", colour="#212529", more=""):
    """A text, with its baseline at a point."""
    return f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="{colour}"{more}>{escape(said)}</text>'


def pin(x, y, name, use, side):
    """Draw a pin with its name, and its use outside."""
    if use:
        colour = TRIG if use.startswith("Trig") else ECHO
    else:
        colour = FIVE_VOLTS if name in SUPPLY else GROUND if name == "GND" else UNUSED
    drawn = [f'<rect x="{x - 5}" y="{y - 5}" width="10" height="10" fill="{colour}"/>']
    if name != "-":
        said = f"{name}  {use}" if use else name
        at, anchor = (x - 16, "end") if side == "left" else (x + 16, "start")
        drawn.append(text(at, y + 4, said, anchor, colour, ' font-weight="bold"' if use else ""))
    return drawn


def module(x, y, divided):
    """Draw one module: its four pins, and the divider in its echo line."""
    drawn = [
        text(x, y - 16, "Each module", more=' font-weight="bold"'),
        f'<rect x="{x}" y="{y}" width="96" height="104" rx="6" fill="#e9ecef" stroke="#495057"/>',
        text(x + 10, y + 58, "module", more=' font-style="italic"'),
    ]
    for row, (name, to, colour) in enumerate(
        [
            ("VCC", "5 V", FIVE_VOLTS),
            ("Trig", "its Trig pin", TRIG),
            ("Echo", "its Echo pin", ECHO),
            ("GND", "GND", GROUND),
        ]
    ):
        at = y + 16 + 24 * row
        drawn.append(text(x + 90, at + 4, name, "end"))
        drawn.append(f'<path d="M{x + 96} {at}H{x + 236}" stroke="{colour}" stroke-width="2"/>')
        drawn.append(text(x + 242, at + 4, to, colour=colour))
    if divided:
        echo, ground = y + 64, y + 88
        drawn += [
            f'<rect x="{x + 118}" y="{echo - 7}" width="44" height="14" fill="#fff" stroke="{ECHO}"/>',
            text(x + 140, echo + 4, "1 kΩ", "middle"),
            f'<path d="M{x + 196} {echo}V{echo + 36}H{x + 140}V{ground}" stroke="{ECHO}" stroke-width="2" fill="none"/>',
            f'<rect x="{x + 146}" y="{echo + 29}" width="44" height="14" fill="#fff" stroke="{ECHO}"/>',
            text(x + 168, echo + 40, "2 kΩ", "middle"),
            f'<circle cx="{x + 196}" cy="{echo}" r="3" fill="{ECHO}"/><circle cx="{x + 140}" cy="{ground}" r="3" fill="{GROUND}"/>',
        ]
    return drawn


def picture(board):
    """The whole picture of a board, as SVG."""
    title, width_px, left, right = BOARDS[board]
    used = pins(board)
    first, last = LABEL, LABEL + width_px
    bottom = TOP + PITCH * max(len(column.split()) for column in left + right)
    middle = (first + last) / 2
    drawn = [
        text(middle, 22, title, "middle", more=' font-weight="bold" font-size="15"'),
        f'<rect x="{first}" y="34" width="{width_px}" height="{bottom - 40}" rx="8" fill="#f1f3f5" stroke="#495057"/>',
    ]
    if board != "raspberry-pi":
        drawn.append(f'<rect x="{middle - 22}" y="28" width="44" height="22" rx="3" fill="#ced4da" stroke="#495057"/>')
        drawn.append(text(middle, 43, "USB", "middle"))
    # The outer column of a side is named outside the board, the inner one within.
    columns = list(zip((first + 10, first + 32), ("left", "right"), left))
    columns += list(zip((last - 10, last - 32), ("right", "left"), reversed(right)))
    for x, side, column in columns:
        for row, name in enumerate(column.split()):
            if name != "/":
                drawn += pin(x, TOP + PITCH * row, name, used.get(name), side)
    inset = last + LABEL + 20
    drawn += module(inset, 90, divided=board != "uno")
    count = sum(use.startswith("Trig") for use in used.values())
    notes = [f"{count} modules take up to {15 * count} mA at 5 V."]
    if board != "uno":
        notes.append("Divider: 5 V of Echo become 3.3 V at the pin.")
    notes.append("100 µF between 5 V and GND beside the modules.")
    drawn += [text(inset, 226 + 18 * line, said) for line, said in enumerate(notes)]
    width, height = inset + 320, max(bottom + 14, 290)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
        'font-family="sans-serif" font-size="12" role="img">\n'
        f"<title>{count} HC-SR04 modules on a {title}: which pin goes where</title>\n"
        '<rect width="100%" height="100%" fill="#fff"/>\n' + "\n".join(drawn) + "\n</svg>\n"
    )


for board in BOARDS:
    to = Path(sys.argv[1]) / f"{board}.svg" if len(sys.argv) > 1 else EXAMPLES / board / "wiring.svg"
    to.write_text(picture(board))
