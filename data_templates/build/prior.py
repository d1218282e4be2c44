"""What a fit assumes before it sees a picture, from ICT-FaceKit subjects: `face_statistics` and `mean_mode`.

usage: python data_templates/build/prior.py --ict ict_facekit_light.npz [-o data_templates/prior.npz]
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from face_statistics import prior_statistics
from mean_mode import mean_mode
from threadpoolctl import threadpool_limits

from toongeo.model.artist_model import artist_model
from toongeo.model.loaders.load_ict_facekit import load_ict_facekit

N_SUBJECTS = 120


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--ict", required=True, help="ict_facekit_light.npz")
    parser.add_argument("-o", default=Path(__file__).parents[1] / "prior.npz", type=Path)
    parser.add_argument("--subjects", default=N_SUBJECTS, type=int)
    arguments = parser.parse_args()
    scans = load_ict_facekit(arguments.ict)
    with threadpool_limits(1):
        statistics = prior_statistics(artist_model(), scans, arguments.subjects)
        arrays = {name: array.astype(np.float32) for name, array in statistics.items()}
        more = mean_mode(arrays["axes"].astype(float), arrays["mean"].astype(float), scans)
    # Modes of the cage are kept in so few digits that refining them is exact: see `recombined`.
    arrays |= {name: array.astype(np.float16 if name == "mean_mode" else np.float32) for name, array in more.items()}
    np.savez_compressed(arguments.o, **arrays)


if __name__ == "__main__":
    main()
