"""Idle life by itself: a minute of it, frame by frame."""

import json
import shutil
import subprocess

import numpy as np
import pytest

from tests.conftest import ROOT

IDLE = ROOT / "toongeo" / "io" / "page" / "src" / "idle.js"
NAMES = [
    f"eye{part}{side}" for part in ("Blink", "LookIn", "LookOut", "LookUp", "LookDown") for side in ("Left", "Right")
]
MINUTE = f"""
import {{ Idle }} from {json.dumps(IDLE.as_uri())};
let seed = 1;
Math.random = () => (seed = (seed * 16807) % 2147483647) / 2147483647; // the same minute each time
const frames = [];
let now = {{}};
const scene = {{ rotation: {{ x: 0 }}, position: {{ y: 0 }} }};
const idle = new Idle({{ names: {json.dumps(NAMES)}, scene, add: (weights) => (now = weights) }});
for (let k = 0; k < 3600; k++) {{
  idle.tick(1 / 60);
  frames.push([{json.dumps(NAMES)}.map((name) => now[name] ?? 0), scene.position.y]);
}}
idle.stop();
console.log(JSON.stringify([frames, now, scene]));
"""


def test_a_minute_of_life():
    node = shutil.which("node")
    if node is None:
        pytest.skip("needs node")
    command = [node, "--input-type=module", "-e", MINUTE]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=60)
    frames, after, scene = json.loads(done.stdout)
    weights = dict(zip(NAMES, np.array([frame for frame, _ in frames]).T, strict=True))
    assert after == {} and scene == {"rotation": {"x": 0}, "position": {"y": 0}}  # nothing is left when it stops
    blink = weights["eyeBlinkLeft"]
    np.testing.assert_array_equal(blink, weights["eyeBlinkRight"])
    shut = np.flatnonzero((blink[1:] > 0.7) & (blink[:-1] <= 0.7))
    assert 8 <= len(shut) <= 30 and (blink == 0).mean() > 0.85 and blink.max() <= 1  # people blink 8 to 30 times
    assert np.diff(shut).min() > 60  # and not twice at once
    looks = {name: values for name, values in weights.items() if "Look" in name}
    assert all(0 < values.max() < 0.2 and values.min() == 0 for values in looks.values())
    # Both eyes look at one thing: where the left looks out, the right looks in.
    np.testing.assert_array_equal(looks["eyeLookOutLeft"], looks["eyeLookInRight"])
    np.testing.assert_array_equal(looks["eyeLookUpLeft"], looks["eyeLookUpRight"])
    assert not (looks["eyeLookOutLeft"] * looks["eyeLookOutRight"]).any()
    # They dart: most of the time they rest.
    assert (np.diff(looks["eyeLookOutLeft"]) == 0).mean() > 0.8
    breath = np.array([height for _, height in frames])
    assert 0 < np.abs(breath).max() < 0.001 and 24 <= (np.diff(np.sign(breath)) != 0).sum() <= 32
