// What scripts and tests may ask of the editor: window.toongeo.points()
export function scripted(editor) {
  const pixel = (place) => {
    const box = editor.parts.surface.getBoundingClientRect();
    const [x, y] = editor.view.toScreen(place);
    return [box.left + x, box.top + y];
  };
  return {
    points: () => editor.state.points,
    missing: () => editor.state.missing,
    confidence: () => editor.state.confidence,
    pixel,
    screen: (k) => pixel(editor.state.points[k]),
    scale: () => editor.view.scale,
    select: (points) => editor.select(points, false),
    selection: () => [...editor.selection],
    fits: () => editor.refit.count,
    face: () => editor.refit.face?.middle(),
  };
}
