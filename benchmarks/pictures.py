"""The pictures that benchmarks run over, and on which of them constants of the library were chosen.

A figure on a picture that constants were chosen on says how well they suit it; what to expect of others is told only by
pictures that nobody looked at while choosing. Every table over pictures therefore ends in the sentence of `roles`.

Whoever builds something new chooses on `CHOOSING`, looks at `JUDGING` once, for the final figure, and adds a line to
`CHOSEN_ON`. What was built before this rule saw most of the pictures, and says so.
"""

from dataclasses import dataclass
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "examples" / "portraits"
EXAMPLES = (
    "astronaut", "bad_guy", "beethoven", "blonde_girl_threequarter", "blue_girl", "manga_girl", "moustache_man",
)  # fmt: skip
# Of Wu et al. (2018), by the numbers of their files; they do not travel with the project, nor do the portraits.
CARICATURES = ("1", "4", "7", "11", "14", "17", "21", "24", "27", "31", "34", "37", "41", "44", "47")
PORTRAITS = ("einstein", "image_0010", "takeo")

CHOOSING = ("astronaut", "bad_guy", "blue_girl", "manga_girl", "1", "7", "14", "21", "27", "34", "41", "47", "takeo")
JUDGING = tuple(name for name in (*EXAMPLES, *CARICATURES, *PORTRAITS) if name not in CHOOSING)

# By benchmark (a script here, or a table of `toongeo bench`): the pictures on which constants of what it measures were
# chosen, as far as that was written down.
CHOSEN_ON = {
    "alignment": (*EXAMPLES, *CARICATURES),
    "caricature": (*EXAMPLES, *CARICATURES),  # on eight of the caricatures; which ones was not written down
    "caricature_expressions": (*EXAMPLES, *CARICATURES),
    "contacts": (*EXAMPLES, *CARICATURES),
    "crossings": ("bad_guy", "manga_girl", "11", "31", "44"),
    # That a face beside a sure one must be as sure; the rest saw renders only, whose jaws and noses follow annotators'
    # conventions that were read off the points of all pictures once, and that `is_sure` asks for all inner points, too.
    "detection": ("astronaut", "bad_guy"),
    "drift": (),
    "driving": EXAMPLES,
    "editing": EXAMPLES,
    "editor": EXAMPLES,  # the one constant of the placing
    "eos": (*EXAMPLES, *PORTRAITS),  # the weight of the prior; in this comparison eos sets it
    "evidence": (*EXAMPLES, *CARICATURES, *PORTRAITS),  # the bound; the weights saw renders only
    "files": EXAMPLES,
    "films": ("astronaut", "moustache_man"),  # where a frame needs more than one sample a pixel
    "glasses": CHOOSING,
    "looks": CHOOSING,
    # The parser's cuts, on nearly all pictures; the weights of the min-cut, on all. The evidence of the cuts and limits
    # of trust saw CHOOSING, and the limit about clothes caricature 4, too.
    "hair_mask": (*EXAMPLES, *CARICATURES, *PORTRAITS),
    "landmarks": (*EXAMPLES, *PORTRAITS),
    "lips": (*EXAMPLES, *CARICATURES),
    "noise": CHOOSING,  # with seeds below 1000; the bound on what is set by hand saw the clean points of all 25
    "mouths": (*EXAMPLES, *CARICATURES, *PORTRAITS),  # the way to close lips was found on most of them
    "page": EXAMPLES,
    "photometric": (*EXAMPLES, *PORTRAITS),
    "rig": EXAMPLES,
    "snapping": (*EXAMPLES, *CARICATURES),  # the lids' features and candidates; their weights saw renders only
    "stages": EXAMPLES,
    "stylize": ("astronaut", "einstein", "image_0010", "takeo"),
    "table1": (*EXAMPLES, *CARICATURES),
    "table2": (*EXAMPLES, *CARICATURES),
    # Films, mostly of other acting.
    "tracking": ("astronaut", "bad_guy", "blonde_girl_threequarter", "blue_girl", "manga_girl", "moustache_man"),
}


@dataclass(frozen=True)
class Picture:
    """A picture and the file of its landmarks."""

    name: str
    image: Path
    landmarks: Path


def pictures(folders=()) -> list[Picture]:
    """Pictures with landmarks (.pts, .txt) of the same name beside them; of the examples without a folder."""
    found = []
    for folder in [Path(name) for name in folders] or [FOLDER]:
        for points in sorted(path for path in folder.iterdir() if path.suffix in (".pts", ".txt")):
            beside = (points.with_suffix(suffix) for suffix in (".png", ".jpg", ".jpeg"))
            found += [Picture(points.stem, image, points) for image in beside if image.exists()][:1]
    return found


def roles(benchmark: str, names) -> str:
    """Which of the pictures constants were chosen on, and which are only looked at."""
    chosen = [name for name in names if name in CHOSEN_ON[benchmark]]
    seen = [name for name in names if name not in CHOSEN_ON[benchmark]]
    return f"\nConstants were chosen on: {', '.join(chosen) or 'none'}. Only looked at: {', '.join(seen) or 'none'}."
