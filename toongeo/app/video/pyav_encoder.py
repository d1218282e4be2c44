"""Videos with sound, by PyAV."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from toongeo.app.video.sound import Sound
from toongeo.io import load_pyav

__all__ = ["PyavEncoder"]

# By suffix: codecs of picture and sound, and options of the first. Constant quality at which drawings show no blocks;
# presets that take a few ms a picture of 512 px.
_CODECS: dict[str, tuple[str, str, dict[str, str]]] = {
    ".mp4": ("libx264", "aac", {"crf": "18", "preset": "veryfast"}),
    ".webm": ("libvpx", "libopus", {"crf": "8", "b": "4M", "deadline": "realtime", "cpu-used": "4"}),
}
_SOUND_RATE = 48000  # Hz, of sound that is encoded anew: one that Opus knows
_FINEST = 1001 * 240  # denominator of frame rates, of which 30000/1001 is one


class PyavEncoder:
    """Writes pictures of one size (height, width), and a sound.

    A sound in the codec of the file is passed through, any other is encoded anew.

    Raises
    ------
    OSError
        If the file cannot be written or the sound cannot be read.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: float, sound: Sound | None = None) -> None:
        av = load_pyav("a video with sound")
        codec, self._sound_codec, options = _CODECS[path.suffix]
        self._av, self._sound, self._count = av, sound, 0
        self._rate = Fraction(fps).limit_denominator(_FINEST)
        # The index of an .mp4 stands first, so that a browser starts before it has the whole file.
        self._file: Any = av.open(str(path), "w", options={"movflags": "faststart"} if path.suffix == ".mp4" else {})
        self._video = self._file.add_stream(codec, rate=self._rate, options=options)
        self._video.height, self._video.width = size
        self._video.pix_fmt = "yuv420p"
        try:
            self._heard: Any = None if sound is None else av.open(str(sound.path))
        except av.FFmpegError as error:
            self._file.close()
            raise OSError(f"{sound.path if sound else ''} cannot be read as a sound ({error})") from error
        self._out: Any = self._add_sound() if self._heard is not None else None

    def add(self, frame: np.ndarray) -> None:
        """The next picture (H, W, 3) uint8 RGB."""
        picture = self._av.VideoFrame.from_ndarray(np.ascontiguousarray(frame), format="rgb24")
        picture.pts, picture.time_base = self._count, 1 / self._rate
        self._count += 1
        self._file.mux(self._video.encode(picture))

    def finish(self) -> None:
        """Add the sound, as long as the pictures last, and complete the file."""
        if not self._count:
            raise OSError("0 of 0 frames are in the file")
        self._file.mux(self._video.encode())
        if self._heard is not None:
            try:
                for packet in self._packets():
                    self._file.mux(packet)
            except self._av.FFmpegError as error:
                raise OSError(f"the sound cannot be read ({error})") from error
        self._file.close()

    def close(self) -> None:
        """Release the files, complete or not."""
        if self._heard is not None:
            self._heard.close()
        self._file.close()

    def _add_sound(self) -> Any:
        assert self._heard is not None and self._sound is not None
        if not self._heard.streams.audio:
            self._heard.close()
            self._file.close()
            raise OSError(f"{self._sound.path} has no sound")
        source = self._heard.streams.audio[0]
        self._passed = source.codec_context.name == self._sound_codec.removeprefix("lib")
        if self._passed:
            return self._file.add_stream_from_template(source)
        return self._file.add_stream(self._sound_codec, rate=_SOUND_RATE, layout="stereo")

    def _packets(self) -> Iterator[Any]:
        assert self._heard is not None and self._sound is not None
        source, start = self._heard.streams.audio[0], self._sound.start
        seconds = float(self._count / self._rate)
        end = start + (seconds if self._sound.seconds is None else min(seconds, self._sound.seconds))
        if self._passed:
            for packet in self._heard.demux(source):
                if packet.dts is not None and start <= float(packet.pts * packet.time_base) < end:
                    shift = round(start / packet.time_base)
                    packet.pts, packet.dts, packet.stream = packet.pts - shift, packet.dts - shift, self._out
                    yield packet
            return
        # Whole samples of the stretch, at one rate and in one layout.
        plain = self._av.AudioResampler(format="fltp", layout="stereo", rate=_SOUND_RATE)
        first, last, at = round(start * _SOUND_RATE), round(end * _SOUND_RATE), 0
        for decoded in (*self._heard.decode(source), None):
            for piece in plain.resample(decoded):
                samples = piece.to_ndarray()[:, max(first - at, 0) : max(last - at, 0)]
                if samples.shape[1]:
                    cut = self._av.AudioFrame.from_ndarray(np.ascontiguousarray(samples), "fltp", "stereo")
                    cut.sample_rate, cut.pts = _SOUND_RATE, max(at - first, 0)
                    yield from self._out.encode(cut)
                at += piece.samples
        yield from self._out.encode(None)
