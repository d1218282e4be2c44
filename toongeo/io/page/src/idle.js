// A little life: blinks, glances and breath, on top of whatever expression is shown.
const CLOSE = 0.07; // s, from open to shut; people take 0.1 s
const OPEN = 0.16; // s, and back
const BLINKS = [2.2, 6]; // s between blinks
const GLANCES = [0.7, 2.6]; // s between glances
const DART = 0.05; // s of a saccade
const FAR = 0.16; // of the range of an eye
const BREATH = 4.2; // s of a breath at rest
const NOD = 0.006; // rad
const RISE = 0.0006; // m

const within = ([low, high]) => low + (high - low) * Math.random();

export class Idle {
  constructor(avatar) {
    this.avatar = avatar;
    this.time = 0;
    this.blink = within(BLINKS);
    this.glance = within(GLANCES);
    this.from = [0, 0];
    this.to = [0, 0];
    this.moved = 0;
  }

  // One frame; the seconds since the last.
  tick(seconds) {
    this.time += seconds;
    const { names, scene } = this.avatar;
    const shut = this.shut();
    const [x, y] = this.gaze();
    const weights = {};
    const add = (name, weight) => names.includes(name) && weight && (weights[name] = weight);
    for (const side of ['Left', 'Right']) {
      add(`eyeBlink${side}`, shut);
      add(`eyeLookUp${side}`, Math.max(y, 0));
      add(`eyeLookDown${side}`, Math.max(-y, 0));
      // The left of the head is at the viewer's right.
      add(`eyeLookOut${side}`, Math.max(side === 'Left' ? x : -x, 0));
      add(`eyeLookIn${side}`, Math.max(side === 'Left' ? -x : x, 0));
    }
    this.avatar.add(weights);
    const breath = Math.sin((2 * Math.PI * this.time) / BREATH);
    scene.rotation.x = NOD * breath;
    scene.position.y = RISE * breath;
  }

  stop() {
    this.avatar.add({});
    this.avatar.scene.rotation.x = 0;
    this.avatar.scene.position.y = 0;
  }

  // How far the lids are closed.
  shut() {
    const since = this.time - this.blink;
    if (since > CLOSE + OPEN) this.blink = this.time + within(BLINKS);
    if (since < 0 || since > CLOSE + OPEN) return 0;
    return since < CLOSE ? since / CLOSE : 1 - (since - CLOSE) / OPEN;
  }

  // Where the eyes look, -1..1 to the right of the picture and up.
  gaze() {
    if (this.time > this.glance) {
      this.from = this.to;
      this.to = Math.random() < 0.4 ? [0, 0] : [FAR * (2 * Math.random() - 1), 0.5 * FAR * (2 * Math.random() - 1)];
      this.moved = this.time;
      this.glance = this.time + within(GLANCES);
    }
    const share = Math.min((this.time - this.moved) / DART, 1);
    return this.from.map((start, i) => start + share * (this.to[i] - start));
  }
}
