// The fitted face beside the picture, which follows the points as fast as answers come.
import { newest } from './backend.js';
import { Face, unpacked } from './face.js';
import { known } from './landmarks.js';

const FEWEST = 6; // points that a fit asks for

export class Refit {
  constructor(parts, backend, shown) {
    this.parts = parts;
    this.backend = backend;
    this.shown = shown;
    this.count = 0;
    this.landmarks = null;
    this.run = newest((task) => this.fit(task));
    try {
      this.face = new Face(parts.face);
    } catch {
      this.tell('The 3D view needs WebGL, which this browser does not give.');
    }
  }

  async load() {
    const { faces, colours } = await this.backend.ask('mesh');
    this.face?.topology(unpacked(faces, Uint32Array), unpacked(colours, Uint8Array));
    this.isLoaded = true;
  }

  picture(bitmap, width, height) {
    this.landmarks = null;
    this.face?.wearable(bitmap, width, height);
  }

  async fit({ picture, state, isFinal }) {
    if (!this.isLoaded || known(state).filter(Boolean).length < FEWEST) return;
    try {
      const answer = await this.backend.ask('fit', { picture, points: known(state) });
      this.landmarks = answer.landmarks;
      this.count += 1;
      this.face?.show(unpacked(answer.vertices, Float32Array), answer.landmarks, isFinal);
      const off = answer.error === null ? '' : `Off by ${answer.error.toFixed(1)} % of the width across the eyes. `;
      this.parts.fitline.textContent = off + answer.warnings.map((text) => `${text[0].toUpperCase()}${text.slice(1)}.`).join(' ');
      this.parts.fitline.classList.toggle('wrong', answer.warnings.length > 0);
    } catch (error) {
      this.landmarks = null;
      this.parts.fitline.textContent = error.message;
      this.parts.fitline.classList.add('wrong');
    }
    this.shown();
  }

  tell(text) {
    this.parts.noface.hidden = false;
    this.parts.noface.textContent = text;
  }
}
