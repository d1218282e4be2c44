"""How soon the page of an avatar shows its first frame, and how large displays in notebooks are.

usage: python benchmarks/page.py [--realtime]
(needs Chromium, and `npm ci --prefix tests/web`; --realtime lets the browser go before all else on a busy machine, with
`chrt`, as root)

The first row is a page that draws nothing: what Chromium takes by itself to open a page with WebGL, before any other.

first frame, s: from the address to the first frame, by the page's own clock, in Chromium without a graphics card. CPU
s until then, of the page's process and of the one that stands in for the graphics card: these do not depend on how
busy the machine is.
"""

import os

for variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[variable] = "1"

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from statistics import median

from pictures import FOLDER, roles

from toongeo import make_avatar, read_image, read_landmarks

ROOT = Path(__file__).parents[1]
NAMES = ("moustache_man", "blue_girl")
RUNS = 3
NOTHING = """<!doctype html><canvas id="view" width="560" height="620"></canvas><script>
document.querySelector("canvas").getContext("webgl2", { antialias: true }).clear(16384);
const told = () => { document.documentElement.dataset.first = performance.now(); };
requestAnimationFrame(() => requestAnimationFrame(told));
</script>"""
STEPS = [
    {"wait": "document.documentElement.dataset.first"},
    {"cpu": True},
    {"run": "Number(document.documentElement.dataset.first) / 1000"},
]


def first_frame(page: Path, folder: Path) -> tuple[float, float, float]:
    """Seconds to the first frame, and CPU seconds of the page and of the renderer in software."""
    (folder / "steps.json").write_text(json.dumps(STEPS))
    command = ["node", ROOT / "tests" / "web" / "browse.mjs", page.as_uri(), folder / "steps.json", folder]
    first = ["chrt", "-r", "5"] if "--realtime" in sys.argv else []
    done = subprocess.run([*first, *command], check=True, capture_output=True, text=True)
    spent, seconds = json.loads(done.stdout)["results"]
    return seconds, spent["renderer"], spent["GPU"]


def timed(page: Path, folder: Path) -> str:
    """Medians of some runs."""
    runs = [first_frame(page, folder) for _ in range(RUNS)]
    return " | ".join(f"{median(column):.2f}" for column in zip(*runs, strict=True))


def main() -> None:
    print("| picture | page MB | first frame s | CPU s, page | CPU s, software GPU | picture cell kB | show() MB |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "nothing.html").write_text(NOTHING)
        print(f"| nothing | 0 | {timed(folder / 'nothing.html', folder)} | - | - |")
        for each in NAMES:
            picture = FOLDER / f"{each}.png"
            avatar = make_avatar(read_image(picture), read_landmarks(picture.with_suffix(".pts")))
            page = folder / "face.html"
            avatar.save(page)
            times = timed(page, folder)
            cell, shown = len(avatar._repr_png_()) / 1e3, len(avatar.show()._repr_html_()) / 1e6
            print(f"| {each} | {page.stat().st_size / 1e6:.1f} | {times} | {cell:.0f} | {shown:.1f} |")
    print(roles("page", NAMES))


if __name__ == "__main__":
    main()
