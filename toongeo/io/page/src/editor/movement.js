// Where points go when some of them are moved: neighbours and the other side may come along.
import { followers } from './follow.js';
import { mirrorMap } from './mirror.js';

// A function from a displacement in px to the new places, a Map from point to [x, y].
export function movement({ points, missing }, selection, { soft, both, reach, settings }) {
  const { mirror: twins, eyes, prior } = settings;
  const held = [...selection];
  const map = both ? mirrorMap(points, missing, twins) : null;
  const alike = map ? held.map((k) => twins[k]).filter((k) => !selection.has(k)) : [];
  const all = [...held, ...alike];
  const others = soft ? points.map((_, k) => k).filter((k) => !all.includes(k)) : [];
  const [right, left] = eyes.map((k) => points[k]);
  const unit = Math.hypot(right[0] - left[0], right[1] - left[1]) || 1;
  const at = (indices) => indices.map((k) => points[k]);
  const follow = others.length ? followers(at(others), at(all), unit, { ...prior, reach }) : () => [];
  return (d) => {
    const steps = [...held.map(() => d), ...alike.map(() => map.move(d))];
    const added = (indices, by) => indices.map((k, i) => [k, [points[k][0] + by[i][0], points[k][1] + by[i][1]].map(rounded)]);
    return new Map([...added(all, steps), ...added(others, follow(steps))]);
  };
}

// To a hundredth of a pixel, which nobody sees and files need not hold more of.
export function rounded(px) {
  return Math.round(100 * px) / 100;
}
