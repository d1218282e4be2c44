// The points of a picture, and what was done to them. A state is never changed: each step makes a new one.
const MOST_STEPS = 500;

// `confidence` is null for points that a person placed, 0 for those that are guessed from others.
export function state(points, missing = null, confidence = null) {
  return {
    points: points.map(([x, y]) => [x, y]),
    missing: missing ? [...missing] : points.map(() => false),
    confidence: confidence ? [...confidence] : points.map(() => null),
  };
}

// A state in which some points lie elsewhere. Those that a person placed nobody doubts; others only came along.
export function moved(from, places, placed) {
  const next = state(from.points, from.missing, from.confidence);
  for (const [k, place] of places) next.points[k] = place;
  for (const k of placed) next.confidence[k] = null;
  return next;
}

export function known(from) {
  return from.points.map((point, k) => (from.missing[k] ? null : point));
}

export class History {
  constructor(first) {
    this.steps = [first];
    this.at = 0;
    this.saved = 0;
  }

  get state() {
    return this.steps[this.at];
  }

  get isSaved() {
    return this.at === this.saved;
  }

  // A further nudge of the same points (same `kind`) replaces the last, so that one undo takes all of it back.
  add(next, kind = null) {
    const again = kind !== null && kind === this.kind && this.at === this.steps.length - 1 && this.at > 0 && !this.isSaved;
    this.steps.length = again ? this.at : this.at + 1;
    if (this.saved >= this.steps.length) this.saved = -1;
    this.steps.push(next);
    if (this.steps.length > MOST_STEPS) {
      this.steps.shift();
      this.saved -= 1;
    }
    this.at = this.steps.length - 1;
    this.kind = kind;
  }

  go(step) {
    const to = this.at + step;
    if (to < 0 || to >= this.steps.length) return false;
    this.at = to;
    this.kind = null;
    return true;
  }

  markSaved() {
    this.saved = this.at;
    this.kind = null;
  }
}
