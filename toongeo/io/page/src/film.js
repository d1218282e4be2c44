// A film of what is seen, as WebM.
const KINDS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];
const FPS = 30;

export const canFilm = () => kind() !== undefined && Boolean(HTMLCanvasElement.prototype.captureStream);

function kind() {
  return globalThis.MediaRecorder && KINDS.find((each) => MediaRecorder.isTypeSupported(each));
}

const HEAD = 500; // bytes of a film without frames
const PART = 250; // ms

// Begins; the function that it returns ends the film and gives it, with a frame at least, however slow the computer is.
export function film(canvas) {
  const stream = canvas.captureStream(FPS);
  const recorder = new MediaRecorder(stream, { mimeType: kind(), videoBitsPerSecond: 6e6 });
  const parts = [];
  const begun = new Promise((resolve) => {
    recorder.addEventListener('dataavailable', (event) => {
      parts.push(event.data);
      if (event.data.size > HEAD) resolve();
    });
  });
  recorder.start(PART);
  return () => begun.then(() => new Promise((resolve) => {
    recorder.addEventListener('stop', () => {
      stream.getTracks().forEach((track) => track.stop());
      resolve(new Blob(parts, { type: 'video/webm' }));
    });
    recorder.stop();
  }));
}
