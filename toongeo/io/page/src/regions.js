// Where on the face a target is, told by how its name begins; the order is that of the panel.
const REGIONS = [
  ['Mouth', /^mouth/],
  ['Eyes', /^eye(Blink|Wide|Squint|s)/],
  ['Jaw and tongue', /^(jaw|tongue)/],
  ['Brows', /^brow/],
  ['Gaze', /^(eyeLook|look)/],
  ['Nose and cheeks', /^(nose|cheek)/],
  ['Speech', /^viseme/],
];

// Names by region: [[region, [name, ...]], ...], without empty regions.
export function byRegion(names) {
  const groups = new Map([...REGIONS.map(([region]) => [region, []]), ['More', []]]);
  for (const name of names) {
    const found = REGIONS.find(([, pattern]) => pattern.test(name));
    groups.get(found ? found[0] : 'More').push(name);
  }
  return [...groups].filter(([, members]) => members.length);
}

// 'eyeBlinkLeft' -> 'Eye blink left'
export function inWords(name) {
  const words = name.replace(/_/g, ' ').replace(/([a-z])([A-Z0-9])/g, '$1 $2').toLowerCase();
  return words.charAt(0).toUpperCase() + words.slice(1);
}

// The name for the other side, or null.
export function otherSide(name, names) {
  const other = name.endsWith('Left') ? name.slice(0, -4) + 'Right' : name.endsWith('Right') ? name.slice(0, -5) + 'Left' : null;
  if (other === null || !names.includes(other)) return null;
  // What goes to the left has no twin but an opposite.
  return /^(jaw|mouth)(Left|Right)$/.test(name) ? null : other;
}
