// What can be played on a head: start(), at(seconds since the last call) -> weights or null when it is over, stop().
import { AnimationMixer } from 'three';
import { takeAt } from './take.js';

// The animation of the file, again and again.
export function clipPlayer(avatar) {
  const mixer = new AnimationMixer(avatar.scene);
  const action = mixer.clipAction(avatar.clips[0]);
  return {
    start: () => action.reset().play(),
    at(seconds) {
      mixer.update(seconds);
      return avatar.adopt();
    },
    stop: () => action.stop(),
  };
}

export function takePlayer(take) {
  let began = 0;
  return {
    start: () => (began = performance.now()),
    at() {
      const time = (performance.now() - began) / 1000; // its own speed, however slowly it is drawn
      return time > take.times.at(-1) + 0.1 ? null : takeAt(take, time);
    },
    stop: () => {},
  };
}
