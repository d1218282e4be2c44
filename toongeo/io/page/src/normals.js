// Targets move vertices; without targets for the normals a smile would be shaded like a face at rest.
import { BufferAttribute, Vector3 } from 'three';

const LONG = 12; // ms that a page may be deaf

export async function bendNormals(geometry) {
  const targets = geometry.morphAttributes.position;
  if (!targets || geometry.morphAttributes.normal || !geometry.morphTargetsRelative || !geometry.index) return;
  const twin = firstTwins(geometry.attributes.position);
  const rest = points(geometry.attributes.position);
  const index = geometry.index.array;
  const base = normals(rest, index, twin);
  const all = [];
  let began = performance.now();
  for (const target of targets) {
    const moved = points(target);
    for (let i = 0; i < moved.length; i++) moved[i] += rest[i];
    const bent = normals(moved, index, twin);
    for (let i = 0; i < bent.length; i++) bent[i] -= base[i];
    all.push(new BufferAttribute(bent, 3));
    if (performance.now() - began < LONG) continue;
    await new Promise((resume) => setTimeout(resume));
    began = performance.now();
  }
  geometry.morphAttributes.normal = all;
  geometry.dispose(); // it may have been drawn without them
}

// Coordinates as plain floats, whatever the accessor stores.
function points(attribute) {
  const values = new Float32Array(3 * attribute.count);
  for (let i = 0; i < attribute.count; i++) {
    values[3 * i] = attribute.getX(i);
    values[3 * i + 1] = attribute.getY(i);
    values[3 * i + 2] = attribute.getZ(i);
  }
  return values;
}

// A vertex on a seam of the texture is there several times; its normal is one.
function firstTwins(position) {
  const seen = new Map();
  return Uint32Array.from({ length: position.count }, (_, i) => {
    const key = `${position.getX(i)} ${position.getY(i)} ${position.getZ(i)}`;
    if (!seen.has(key)) seen.set(key, i);
    return seen.get(key);
  });
}

function normals(xyz, index, twin) {
  const sums = new Float32Array(xyz.length);
  const [a, b, c] = [new Vector3(), new Vector3(), new Vector3()];
  for (let f = 0; f < index.length; f += 3) {
    a.fromArray(xyz, 3 * index[f]);
    b.fromArray(xyz, 3 * index[f + 1]).sub(a);
    c.fromArray(xyz, 3 * index[f + 2]).sub(a);
    b.cross(c); // as long as twice the area: large faces count for more
    for (let k = 0; k < 3; k++) {
      const at = 3 * twin[index[f + k]];
      sums[at] += b.x;
      sums[at + 1] += b.y;
      sums[at + 2] += b.z;
    }
  }
  const unit = new Float32Array(xyz.length);
  for (let i = 0; i < twin.length; i++) {
    a.fromArray(sums, 3 * twin[i]);
    if (a.lengthSq() > 0) a.normalize();
    a.toArray(unit, 3 * i);
  }
  return unit;
}
