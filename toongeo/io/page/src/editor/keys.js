// Keys of the picture, and those that count everywhere.
const NUDGE = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const ZOOM = 1.25;

export function listenKeys(root, surface, editor, view) {
  const everywhere = {
    z: (event) => editor.step(event.shiftKey ? 1 : -1),
    y: () => editor.step(1),
    s: () => editor.save(),
  };
  const onPicture = {
    n: () => editor.walk(1),
    p: () => editor.walk(-1),
    a: () => editor.select(editor.all, false),
    Escape: () => (editor.isPlacing ? editor.endPlacing(false) : editor.select([], false)),
    Enter: () => editor.isPlacing && editor.endPlacing(true),
    Delete: () => editor.edits.toggleMissing(),
    Backspace: () => editor.edits.toggleMissing(),
    s: () => editor.toggle('soft'),
    b: () => editor.toggle('both'),
    f: () => editor.toggle('fitted'),
    m: () => editor.edits.mirror(),
    '+': () => view.zoom(ZOOM),
    '=': () => view.zoom(ZOOM),
    '-': () => view.zoom(1 / ZOOM),
    0: () => view.fit(),
    '?': () => editor.help(),
    PageUp: () => editor.go(-1),
    PageDown: () => editor.go(1),
  };

  root.addEventListener('keydown', (event) => {
    const act = (event.ctrlKey || event.metaKey) && !event.altKey ? everywhere[event.key.toLowerCase()] : null;
    if (!act || (event.target.matches?.('input[type=number]') && event.key.toLowerCase() !== 's')) return;
    event.preventDefault();
    act(event);
  });

  surface.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey) return;
    if (event.key === ' ') {
      editor.isPanning = true;
      event.preventDefault();
    }
    const step = NUDGE[event.key];
    if (step) {
      const px = event.shiftKey ? 10 : event.altKey ? 0.1 : 1;
      editor.edits.nudge(step.map((value) => value * px));
      event.preventDefault();
      return;
    }
    const act = onPicture[event.key] ?? onPicture[event.key.toLowerCase()];
    if (!act || event.altKey) return;
    event.preventDefault();
    act();
  });
  surface.addEventListener('keyup', (event) => {
    if (event.key === ' ') editor.isPanning = false;
  });
  surface.addEventListener('blur', () => {
    editor.isPanning = false;
  });
}
