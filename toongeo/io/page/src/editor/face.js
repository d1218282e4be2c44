// The fitted face, in the pose that the picture shows it in.
import { Box3, BufferAttribute, BufferGeometry, DoubleSide, Mesh, MeshBasicMaterial, MeshStandardMaterial, SRGBColorSpace, Texture, Vector3, Color } from 'three';
import { Stage } from '../stage.js';

const TALL = 0.14; // m, of the landmarks
const CLAY = new Color(0xcfc3b7);
const [FOREHEAD, CHIN] = [0.5, 0.1]; // of the height of the landmarks: what is shown above and below them
const PAINT = 0.6; // share of the template's own colours in the clay: brows, lips and irises are seen

export class Face {
  constructor(canvas) {
    this.stage = new Stage(canvas);
    this.stage.light('clay');
    this.clay = new MeshStandardMaterial({ vertexColors: true, roughness: 0.75, side: DoubleSide });
    this.painted = new MeshBasicMaterial({ side: DoubleSide });
    this.isShown = false;
  }

  topology(faces, colours) {
    this.geometry = new BufferGeometry();
    this.geometry.setIndex(new BufferAttribute(faces, 1));
    const shade = new Float32Array(colours.length);
    const colour = new Color();
    for (let i = 0; i < colours.length; i += 3) {
      colour.setRGB(colours[i] / 255, colours[i + 1] / 255, colours[i + 2] / 255, SRGBColorSpace);
      CLAY.clone().lerp(colour, PAINT).toArray(shade, i);
    }
    this.geometry.setAttribute('color', new BufferAttribute(shade, 3));
    this.mesh = new Mesh(this.geometry, this.clay);
    this.mesh.frustumCulled = false;
  }

  // The picture, which can be laid onto the face.
  wearable(bitmap, width, height) {
    this.painted.map?.dispose();
    this.painted.map = new Texture(bitmap);
    this.painted.map.colorSpace = SRGBColorSpace;
    this.painted.map.flipY = false;
    this.painted.map.needsUpdate = true;
    this.painted.needsUpdate = true;
    this.size = [width, height];
    this.isShown = false;
  }

  wear(look) {
    if (this.mesh) this.mesh.material = look === 'picture' ? this.painted : this.clay;
    this.stage.draw();
  }

  // Vertices in px: x right, y down, z towards the viewer. While points move (not final), what moves is seen to move; then
  // the face takes its place in the middle.
  show(vertices, landmarks, isFinal) {
    if (!this.isShown || isFinal) this.frame(landmarks);
    const place = this.attribute('position', vertices.length, 3);
    const uv = this.attribute('uv', (2 * vertices.length) / 3, 2);
    const { scale, centre } = this;
    for (let i = 0; i < uv.length / 2; i++) {
      const [x, y, z] = vertices.subarray(3 * i, 3 * i + 3);
      place.set([scale * (x - centre[0]), scale * (centre[1] - y), scale * z], 3 * i);
      uv[2 * i] = (x + 0.5) / this.size[0];
      uv[2 * i + 1] = (y + 0.5) / this.size[1];
    }
    this.geometry.computeVertexNormals();
    if (!this.isShown) this.stage.show({ scene: this.mesh, bounds: this.bounds });
    this.isShown = true;
    this.stage.draw();
  }

  // What is shown of a picture's face: the landmarks and the forehead above them, as large as a head in metres.
  frame(landmarks) {
    const low = [0, 1].map((axis) => Math.min(...landmarks.map((point) => point[axis])));
    const high = [0, 1].map((axis) => Math.max(...landmarks.map((point) => point[axis])));
    this.centre = [0, 1].map((axis) => (low[axis] + high[axis]) / 2);
    this.scale = TALL / Math.max(high[1] - low[1], 1);
    const wide = (this.scale * (high[0] - low[0])) / 2;
    this.bounds = new Box3(new Vector3(-wide, (-0.5 - CHIN) * TALL, -2 * wide), new Vector3(wide, (0.5 + FOREHEAD) * TALL, 0));
  }

  // The array of an attribute, which is made once and then sent anew to the graphics card.
  attribute(name, length, width) {
    const known = this.geometry.attributes[name];
    if (!known) this.geometry.setAttribute(name, new BufferAttribute(new Float32Array(length), width));
    const { attributes } = this.geometry;
    attributes[name].needsUpdate = true;
    return attributes[name].array;
  }

  front() {
    this.stage.front();
  }

  // Where vertices are, for tests: the mean of their coordinates.
  middle() {
    const middle = new Vector3();
    const place = this.geometry?.attributes.position;
    if (place) for (let i = 0; i < place.count; i++) middle.add(new Vector3().fromBufferAttribute(place, i));
    return place ? middle.divideScalar(place.count).toArray() : null;
  }
}

export function unpacked(text, Kind) {
  return new Kind(Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)).buffer);
}
