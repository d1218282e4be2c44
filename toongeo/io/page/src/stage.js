// Camera, lights and canvas; draws only when something has changed.
import { AmbientLight, Color, DirectionalLight, PerspectiveCamera, Scene, SRGBColorSpace, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';

const STEP = Math.PI / 36; // of an arrow key
const ZOOM = 1.08;
const MARGIN = 1.12; // of the head's height: what is seen of the world

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.outputColorSpace = SRGBColorSpace;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(22, 1, 0.01, 20);
    this.lights = [new AmbientLight(0xffffff), new DirectionalLight(0xffffff), new DirectionalLight(0xcfe0ff)];
    this.lights[1].position.set(0.5, 0.8, 1.2);
    this.lights[2].position.set(-1.2, 0.3, 0.4);
    // The lights travel with the viewer, as those of a photographer do.
    this.camera.add(this.lights[1], this.lights[2]);
    this.scene.add(this.lights[0], this.camera);
    this.light('texture');
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enablePan = false;
    this.controls.addEventListener('change', () => this.draw());
    this.ticks = new Set();
    this.waiting = false;
    this.last = 0;
    // Until somebody turns it, the head is shown whole from the front, however the window changes.
    this.isFront = false;
    this.controls.addEventListener('start', () => (this.isFront = false));
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener('keydown', (event) => this.key(event));
  }

  show(avatar) {
    this.scene.add(avatar.scene);
    avatar.bounds.getCenter(this.controls.target);
    this.size = avatar.bounds.getSize(new Vector3());
    this.resize();
    this.front();
  }

  // The texture holds the light of the picture already; clay lives on relief.
  light(look) {
    const [ambient, key, rim] = look === 'texture' ? [2.3, 1.1, 0.25] : [0.55, 2.4, 1.1];
    this.lights.forEach((light, i) => (light.intensity = [ambient, key, rim][i]));
  }

  front() {
    const tall = Math.max(this.size.y, this.size.x / this.camera.aspect) * MARGIN;
    const distance = tall / 2 / Math.tan((this.camera.fov * Math.PI) / 360) + this.size.z / 2;
    this.camera.position.copy(this.controls.target).add(new Vector3(0, 0, distance));
    this.controls.minDistance = distance / 6;
    this.controls.maxDistance = distance * 3;
    this.controls.update();
    this.isFront = true;
    this.draw();
  }

  // Turned about the head by angles in radians, nearer by a factor.
  turn(sideways, up, nearer = 1) {
    this.isFront = false;
    const { target } = this.controls;
    const offset = this.camera.position.clone().sub(target);
    const polar = Math.min(Math.max(Math.acos(offset.y / offset.length()) - up, 0.05), Math.PI - 0.05);
    const azimuth = Math.atan2(offset.x, offset.z) + sideways;
    this.camera.position.copy(target).add(offset.setFromSphericalCoords(offset.length() / nearer, polar, azimuth));
    this.controls.update();
    this.draw();
  }

  key(event) {
    const acts = {
      ArrowLeft: () => this.turn(-STEP, 0),
      ArrowRight: () => this.turn(STEP, 0),
      ArrowUp: () => this.turn(0, STEP),
      ArrowDown: () => this.turn(0, -STEP),
      '+': () => this.turn(0, 0, ZOOM),
      '=': () => this.turn(0, 0, ZOOM),
      '-': () => this.turn(0, 0, 1 / ZOOM),
      0: () => this.front(),
    };
    if (!acts[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    acts[event.key]();
    event.preventDefault();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.isFront) this.front();
    this.draw();
  }

  // Calls back with the seconds since the last frame, as long as it is wanted.
  every(tick, wanted) {
    if (wanted) this.ticks.add(tick);
    else this.ticks.delete(tick);
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame((now) => {
      this.waiting = false;
      const step = Math.min((now - this.last) / 1000, 0.1);
      this.last = now;
      this.ticks.forEach((tick) => tick(step));
      this.renderer.render(this.scene, this.camera);
      if (this.ticks.size) this.draw();
    });
  }

  // The ground of the page behind the head, for films; pictures have none.
  ground(shown) {
    this.scene.background = shown ? new Color(getComputedStyle(document.body).backgroundColor) : null;
    this.draw();
  }

  // A PNG without background, as large as the canvas.
  picture() {
    this.renderer.render(this.scene, this.camera); // the buffer is gone once a frame is shown
    return new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
  }

  // CSS pixels of a point of the scene.
  project(point) {
    const seen = new Vector3(...point).project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return [box.left + ((seen.x + 1) / 2) * box.width, box.top + ((1 - seen.y) / 2) * box.height];
  }
}
