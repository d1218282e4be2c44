// A take of weights from a CSV file: Live Link Face's, or any with a row of names that the avatar has.
const RATES = [24, 25, 30, 50, 60, 120];
const PERCENT = 2; // weights above it are in percent
const TIMES = { timecode: 1, time: 1, seconds: 1, time_ms: 1e-3, frame: null };

// { times: [s], frames: [{ name: weight }] }; throws what is wrong in a sentence.
export function readTake(text, names) {
  const lines = text.replace(/^\uFEFF/, '').split(/\r?\n/).filter((line) => line.trim());
  const mark = [';', '\t', ','].find((letter) => lines[0]?.includes(letter)) ?? ',';
  const cells = lines.map((line) => line.split(mark).map((cell) => cell.trim().replace(/^"|"$/g, '')));
  const head = cells[0] ?? [];
  const columns = head.map((name) => targetsOf(name, names));
  if (!columns.some((targets) => targets.length)) throw new Error('no column is named like an expression of this head');
  if (cells.length < 2) throw new Error('it has no frames');
  const number = (cell) => (cell === undefined || cell === '' ? NaN : Number(mark === ';' ? cell.replace(',', '.') : cell));
  const held = {};
  const frames = cells.slice(1).map((row) => {
    columns.forEach((targets, i) => {
      const weight = number(row[i]); // what is missing is held
      if (Number.isFinite(weight)) targets.forEach((name) => (held[name] = weight));
    });
    return { ...held };
  });
  const most = frames.reduce((found, frame) => Math.max(found, ...Object.values(frame)), 0);
  if (most > PERCENT) frames.forEach((frame) => Object.keys(frame).forEach((name) => (frame[name] /= 100)));
  return { times: timesOf(head, cells.slice(1), number), frames };
}

// Weights at a time, between frames in proportion.
export function takeAt({ times, frames }, time) {
  const after = times.findIndex((t) => t > time);
  if (after <= 0) return frames[after === 0 ? 0 : frames.length - 1];
  const [a, b] = [frames[after - 1], frames[after]];
  const share = (time - times[after - 1]) / (times[after] - times[after - 1]);
  return Object.fromEntries(Object.keys(b).map((name) => [name, (a[name] ?? b[name]) * (1 - share) + b[name] * share]));
}

// 'JawOpen' is jawOpen; a name of both halves (browInnerUp) moves both.
function targetsOf(name, names) {
  const own = name.charAt(0).toLowerCase() + name.slice(1);
  for (const wanted of [[name], [own], [`${own}Left`, `${own}Right`]]) {
    if (wanted.every((each) => names.includes(each))) return wanted;
  }
  return [];
}

function timesOf(head, rows, number) {
  const at = head.findIndex((name) => Object.hasOwn(TIMES, name.toLowerCase()));
  const unit = at < 0 ? null : TIMES[head[at].toLowerCase()];
  const cells = rows.map((row) => row[at] ?? '');
  let times = rows.map((_, k) => k / 60);
  if (unit !== null && cells.every((cell) => cell.includes(':'))) times = timecodes(cells);
  else if (unit !== null) times = cells.map((cell) => unit * number(cell));
  times = times.map((time) => time - times[0]);
  if (times.some((time, k) => !(k === 0 || time > times[k - 1]))) throw new Error('its times do not grow from line to line');
  return times;
}

// 'hh:mm:ss:ff.fff': the last part counts frames, at the least of the usual rates that has as many.
function timecodes(cells) {
  const parts = cells.map((cell) => cell.split(/[:;]/).map(Number));
  const most = Math.max(...parts.map((part) => part[3] ?? 0));
  const rate = RATES.find((each) => each > most) ?? 120;
  return parts.map(([hours, minutes, seconds, frame = 0]) => 3600 * hours + 60 * minutes + seconds + frame / rate);
}
