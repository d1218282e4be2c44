// The mesh with its landmarks in three dimensions.
import {
  Box3, BufferAttribute, BufferGeometry, CanvasTexture, Color, DoubleSide, Group, Mesh, MeshStandardMaterial, Points,
  PointsMaterial, Raycaster, SRGBColorSpace, Vector2, Vector3,
} from 'three';
import { Stage } from '../stage.js';

const TALL = 0.25; // m: as what the longest side of the mesh is shown
const CLAY = new Color(0xcfc3b7);
const TOWARDS = 0.01; // of the distance to the viewer: so far points stand before the mesh, or it would hide half of each
const SIZES = { point: 9, current: 17, hover: 8 }; // CSS px
const MOST_HOVERED = 250_000; // triangles: beyond, looking for the one under the pointer takes longer than a frame
// The axis of the file that points up, as turns about x and z.
const UPRIGHT = { '+Y': [0, 0], '-Y': [0, 2], '+Z': [-1, 0], '-Z': [1, 0], '+X': [0, 1], '-X': [0, -1] };

export class Head {
  constructor(canvas) {
    this.stage = new Stage(canvas);
    this.stage.light('clay');
    this.stage.controls.enablePan = true;
    this.stage.controls.addEventListener('change', () => this.raise());
    this.ray = new Raycaster();
    this.group = new Group();
    this.marks = {};
  }

  show({ vertices, faces, colours }) {
    const geometry = new BufferGeometry();
    const place = Float32Array.from(vertices, (value) => TALL * value);
    geometry.setAttribute('position', new BufferAttribute(place, 3));
    geometry.setIndex(new BufferAttribute(faces, 1));
    geometry.setAttribute('color', new BufferAttribute(shades(colours, vertices.length), 3));
    geometry.computeVertexNormals();
    const material = new MeshStandardMaterial({ vertexColors: true, roughness: 0.75, side: DoubleSide });
    this.mesh = new Mesh(geometry, material);
    this.canHover = faces.length / 3 <= MOST_HOVERED;
    this.group.add(this.mesh);
    for (const [name, size] of Object.entries(SIZES)) this.group.add((this.marks[name] = marks(size)));
    this.upright('+Y');
  }

  upright(axis) {
    const [about, aside] = UPRIGHT[axis];
    this.group.rotation.set((about * Math.PI) / 2, 0, (aside * Math.PI) / 2);
    this.group.updateMatrixWorld(true);
    this.stage.show({ scene: this.group, bounds: new Box3().setFromObject(this.mesh) });
    this.raise();
  }

  // Index of the vertex nearest to a place in CSS pixels of the canvas, on the side that is seen; null beside the mesh.
  hit(x, y) {
    const { clientWidth: width, clientHeight: height } = this.stage.canvas;
    this.stage.camera.updateMatrixWorld();
    this.ray.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.stage.camera);
    const [first] = this.ray.intersectObject(this.mesh, false);
    if (!first) return null;
    const away = (vertex) => Math.hypot(...this.screen(vertex).map((value, axis) => value - [x, y][axis]));
    return [first.face.a, first.face.b, first.face.c].reduce((best, vertex) => (away(vertex) < away(best) ? vertex : best));
  }

  // Where a vertex is seen, in CSS pixels of the canvas.
  screen(vertex) {
    const box = this.stage.canvas.getBoundingClientRect();
    const [x, y] = this.stage.project(this.at(vertex));
    return [x - box.left, y - box.top];
  }

  at(vertex) {
    return new Vector3().fromBufferAttribute(this.mesh.geometry.attributes.position, vertex).applyMatrix4(this.mesh.matrixWorld);
  }

  // `shown`: name of the marks -> [[vertex, colour], ...]
  mark(shown) {
    this.shown = { ...this.shown, ...shown };
    this.raise();
    this.stage.draw();
  }

  // Marks stand a little nearer to the viewer than their vertices, on the line to them.
  raise() {
    const eye = this.group.worldToLocal(this.stage.camera.position.clone());
    const place = new Vector3();
    for (const [name, entries] of Object.entries(this.shown ?? {})) {
      const { geometry } = this.marks[name];
      entries.forEach(([vertex, colour], k) => {
        place.fromBufferAttribute(this.mesh.geometry.attributes.position, vertex).lerp(eye, TOWARDS);
        geometry.attributes.position.setXYZ(k, place.x, place.y, place.z);
        geometry.attributes.color.setXYZ(k, colour.r, colour.g, colour.b);
      });
      geometry.setDrawRange(0, entries.length);
      geometry.attributes.position.needsUpdate = geometry.attributes.color.needsUpdate = true;
    }
  }
}

function shades(colours, length) {
  const shade = new Float32Array(length);
  const colour = new Color();
  for (let i = 0; i < length; i += 3) {
    if (colours) colour.setRGB(colours[i] / 255, colours[i + 1] / 255, colours[i + 2] / 255, SRGBColorSpace);
    else colour.copy(CLAY);
    colour.toArray(shade, i);
  }
  return shade;
}

function marks(size) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(new Float32Array(3 * 68), 3));
  geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * 68), 3));
  geometry.setDrawRange(0, 0);
  const material = new PointsMaterial({ size: size * Math.min(devicePixelRatio, 2), sizeAttenuation: false, vertexColors: true, map: disc(), alphaTest: 0.4, transparent: true });
  const points = new Points(geometry, material);
  points.frustumCulled = false; // its bounds change with its points
  return points;
}

// A disc with a white rim.
function disc() {
  const canvas = Object.assign(document.createElement('canvas'), { width: 64, height: 64 });
  const context = canvas.getContext('2d');
  const draw = (radius, style) => {
    context.beginPath();
    context.arc(32, 32, radius, 0, 2 * Math.PI);
    context.fillStyle = style;
    context.fill();
  };
  draw(31, '#333');
  draw(28, '#fff');
  return new CanvasTexture(canvas);
}
