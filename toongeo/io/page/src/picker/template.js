// What the picker is made of; elements are found by their data-id.
const icon = (path) => `<svg class="icon" viewBox="0 0 20 20" aria-hidden="true"><path d="${path}"/></svg>`;
const ICONS = {
  undo: icon('M7 5L3.5 8.5 7 12M4 8.5h7.5a4 4 0 0 1 0 8H8'),
  redo: icon('M13 5l3.5 3.5L13 12M16 8.5H8.5a4 4 0 0 0 0 8H12'),
  plus: icon('M10 4v12M4 10h12'),
  minus: icon('M4 10h12'),
  help: icon('M7.5 7.5a2.5 2.5 0 1 1 3.7 2.2c-.9.5-1.2.9-1.2 2M10 14.8v.2'),
};

export const TEMPLATE = `
<header class="top">
  <div class="where"><div class="title"><h1 data-id="name">Landmarks</h1><p data-id="count"></p></div></div>
  <div class="acts">
    <button type="button" class="round" data-id="undo" title="Undo (Ctrl+Z)" aria-label="Undo">${ICONS.undo}</button>
    <button type="button" class="round" data-id="redo" title="Redo (Ctrl+Shift+Z)" aria-label="Redo">${ICONS.redo}</button>
    <button type="button" class="round" data-id="help" title="Keys and gestures (?)" aria-label="Keys and gestures">${ICONS.help}</button>
    <select data-id="format" aria-label="File format"></select>
    <button type="button" class="main" data-id="save" title="Save (Ctrl+S)">Save</button>
  </div>
</header>
<main class="picture" data-id="picture" aria-label="Mesh">
  <div class="surface" data-id="surface">
    <canvas data-id="canvas" tabindex="0" role="application" aria-roledescription="landmark picker"
      aria-label="The mesh. Arrow keys turn it, plus and minus zoom, Shift and arrow keys move a crosshair, Enter sets the point beneath it."></canvas>
    <div class="cross" data-id="cross" hidden></div>
  </div>
  <div class="ask" data-id="ask">
    <svg data-id="sketch" viewBox="-0.92 -0.28 1.84 1.72" aria-hidden="true"></svg>
    <div class="asked"><p class="what" data-id="what"></p><p class="quiet" data-id="progress"></p>
    <div class="row"><button type="button" data-id="back" title="Previous point (P)">Back</button><button type="button" data-id="skip" title="Next point (N)">Skip</button><button type="button" data-id="remove" title="The point has no vertex (Delete)">Remove</button></div></div>
  </div>
</main>
<aside class="panel" aria-label="View and points">
  <section aria-label="View">
    <h2>View</h2>
    <div class="row">
      <button type="button" class="round" data-id="out" title="Zoom out (-)" aria-label="Zoom out">${ICONS.minus}</button>
      <button type="button" data-id="front" title="From the front (0)">Reset</button>
      <button type="button" class="round" data-id="in" title="Zoom in (+)" aria-label="Zoom in">${ICONS.plus}</button>
      <label>Up <select data-id="up"><option>+Y</option><option>+Z</option><option>+X</option><option>-Y</option><option>-Z</option><option>-X</option></select></label>
    </div>
    <div class="row both"><label data-id="mirroring"><input type="checkbox" data-id="mirror" checked><span>Propose the other side</span></label></div>
  </section>
  <section aria-label="Point">
    <h2 data-id="chosen"></h2>
    <div class="row"><label>Vertex <input type="number" min="0" step="1" data-id="vertex"></label></div>
  </section>
  <section class="list" data-id="list" aria-label="Points">
    <h2>Points</h2>
    <p class="legend"><span class="placed">picked</span><span class="rather">proposed</span><span class="missing">to pick</span></p>
    <div class="points" data-id="points" role="listbox" aria-label="Landmarks" tabindex="0"></div>
  </section>
</aside>
<p class="status" data-id="status" role="status" aria-live="polite"></p>
<dialog data-id="dialog" aria-label="Question"><div class="words" data-id="words"></div><form method="dialog" class="row" data-id="answers"></form></dialog>
`;

export const HELP = [
  ['Click, tap', 'sets the point that is asked for on the nearest corner of the mesh'],
  ['Drag, one finger', 'turns the mesh'],
  ['Wheel, pinch', 'zooms'],
  ['Shift and drag, two fingers', 'moves the mesh'],
  ['Arrows, + − 0', 'turn, zoom, back to the front'],
  ['Shift and arrows, Enter', 'move a crosshair (with Alt by one pixel), set the point beneath it'],
  ['N, P', 'next and previous point'],
  ['Delete', 'the point has no vertex'],
  ['Ctrl+Z, Ctrl+Shift+Z, Ctrl+S', 'undo, redo, save'],
];
