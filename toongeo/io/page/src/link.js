// Weights in the fragment of the page's address, which no server sees: #w=jawOpen:0.5,eyeBlinkLeft:1
export function linkTo(weights) {
  const moved = Object.entries(weights).filter(([, weight]) => Math.abs(weight) > 0.004);
  const text = moved.map(([name, weight]) => `${encodeURIComponent(name)}:${Number(weight.toFixed(2))}`).join(',');
  return `${location.href.split('#')[0]}#w=${text}`;
}

// The weights of an address, without what the avatar has not.
export function linked(fragment, names) {
  const text = /^#w=(.*)$/.exec(fragment)?.[1];
  if (!text) return {};
  const pairs = text.split(',').map((pair) => {
    const [name, weight] = pair.split(':');
    try {
      return [decodeURIComponent(name), Number(weight)];
    } catch {
      return ['', NaN];
    }
  });
  return Object.fromEntries(pairs.filter(([name, weight]) => names.includes(name) && weight >= -1 && weight <= 2));
}

// Pages from files and old browsers have no clipboard of their own.
export async function copy(text) {
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    const field = Object.assign(document.createElement('textarea'), { value: text });
    document.body.append(field);
    field.select();
    const copied = document.execCommand('copy');
    field.remove();
    if (!copied) throw new Error('the browser does not let the page copy');
  }
}
