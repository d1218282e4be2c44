"""Sound files as numbers."""

import numpy as np
import pytest
import scipy.io.wavfile

from toongeo.io import pyav_adapter, read_sound

TONE = 0.5 * np.sin(2 * np.pi * 440 * np.arange(4000) / 8000)


@pytest.mark.parametrize(
    ("kind", "step"),
    [("int16", 2**-15), ("int32", 2**-31), ("uint8", 2**-7), ("float32", 1e-7), ("float64", 0)],
)
@pytest.mark.parametrize("channels", [1, 2])
def test_every_kind_of_wave(tmp_path, kind, step, channels):
    dtype = np.dtype(kind)
    stored = TONE
    if dtype.kind in "iu":
        half = 2.0 ** (8 * dtype.itemsize - 1)
        stored = np.clip(
            np.rint(TONE * half) + (half if dtype.kind == "u" else 0), *(np.iinfo(dtype).min, np.iinfo(dtype).max)
        )
    stored = stored.astype(dtype)
    scipy.io.wavfile.write(tmp_path / "a.wav", 8000, stored if channels == 1 else np.column_stack([stored, stored]))
    samples, rate = read_sound(tmp_path / "a.wav")
    assert rate == 8000 and samples.shape == (4000,)
    np.testing.assert_allclose(samples, TONE, atol=2 * step + 1e-12)


def test_other_files_need_pyav(tmp_path, monkeypatch):
    (tmp_path / "a.mp3").write_bytes(b"ID3 no sound")
    monkeypatch.setattr(pyav_adapter, "has_pyav", lambda: False)
    with pytest.raises(
        ImportError, match=r'a sound that is no .wav, as a.mp3, needs the extra video: pip install "av>=14"'
    ):
        read_sound(tmp_path / "a.mp3")
    assert not pyav_adapter.has_sound(tmp_path / "a.mp3")


def test_what_is_no_sound(tmp_path):
    scipy.io.wavfile.write(tmp_path / "a.wav", 8000, np.zeros(0, np.int16))
    with pytest.raises(ValueError, match="a.wav: expected a sound, got an empty one"):
        read_sound(tmp_path / "a.wav")
    (tmp_path / "b.wav").write_bytes((tmp_path / "a.wav").read_bytes()[:20])
    with pytest.raises(ValueError, match="b.wav: expected a sound, got a damaged .wav"):
        read_sound(tmp_path / "b.wav")
    with pytest.raises(OSError, match=r"none.wav"):
        read_sound(tmp_path / "none.wav")
    pytest.importorskip("av")
    (tmp_path / "a.mp3").write_bytes(b"ID3 no sound")
    with pytest.raises(ValueError, match="a.mp3: expected a sound, got a file that cannot be decoded"):
        read_sound(tmp_path / "a.mp3")
    assert not pyav_adapter.has_sound(tmp_path / "a.mp3")
