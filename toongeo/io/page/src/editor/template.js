// What the editor is made of. Elements are found by their data-id, so that a notebook may hold several editors.
const icon = (path) => `<svg class="icon" viewBox="0 0 20 20" aria-hidden="true"><path d="${path}"/></svg>`;
const ICONS = {
  previous: icon('M12 4l-6 6 6 6'),
  next: icon('M8 4l6 6-6 6'),
  undo: icon('M7 5L3.5 8.5 7 12M4 8.5h7.5a4 4 0 0 1 0 8H8'),
  redo: icon('M13 5l3.5 3.5L13 12M16 8.5H8.5a4 4 0 0 0 0 8H12'),
  plus: icon('M10 4v12M4 10h12'),
  minus: icon('M4 10h12'),
  all: icon('M4 8V4h4M12 4h4v4M16 12v4h-4M8 16H4v-4'),
  help: icon('M7.5 7.5a2.5 2.5 0 1 1 3.7 2.2c-.9.5-1.2.9-1.2 2M10 14.8v.2'),
};

export const TEMPLATE = `
<header class="top">
  <div class="where">
    <button type="button" class="round" data-id="previous" title="Previous picture (Page Up)" aria-label="Previous picture">${ICONS.previous}</button>
    <div class="title"><h1 data-id="name">Landmarks</h1><p data-id="count"></p></div>
    <button type="button" class="round" data-id="next" title="Next picture (Page Down)" aria-label="Next picture">${ICONS.next}</button>
  </div>
  <div class="acts">
    <button type="button" class="round" data-id="undo" title="Undo (Ctrl+Z)" aria-label="Undo">${ICONS.undo}</button>
    <button type="button" class="round" data-id="redo" title="Redo (Ctrl+Shift+Z)" aria-label="Redo">${ICONS.redo}</button>
    <button type="button" class="round" data-id="help" title="Keys and gestures (?)" aria-label="Keys and gestures">${ICONS.help}</button>
    <select data-id="format" aria-label="File format"></select>
    <button type="button" class="main" data-id="save" title="Save (Ctrl+S)">Save</button>
  </div>
</header>
<main class="picture" data-id="picture" aria-label="Picture">
  <div class="surface" data-id="surface" tabindex="0" role="application" aria-roledescription="landmark editor">
    <canvas data-id="canvas" aria-hidden="true"></canvas>
    <svg data-id="overlay" aria-hidden="true" focusable="false"></svg>
  </div>
  <div class="ask" data-id="ask" hidden>
    <svg data-id="sketch" viewBox="-0.9 -0.85 1.8 1.95" aria-hidden="true"></svg>
    <div><p class="what" data-id="what" role="status"></p><p class="quiet" data-id="progress"></p>
    <div class="row"><button type="button" data-id="skip">Skip</button><button type="button" data-id="cancel">Cancel</button><button type="button" class="main" data-id="done">Done</button></div></div>
  </div>
  <div class="bar" data-id="bar" role="toolbar" aria-label="Tools">
    <button type="button" data-id="box" aria-pressed="false" title="Drag a box around points (or Shift and drag)">Box</button>
    <button type="button" data-id="soft" aria-pressed="false" title="Neighbours follow (S)">Soft</button>
    <button type="button" data-id="both" aria-pressed="false" title="The other side moves alike (B)">Both sides</button>
    <span class="zooms"><button type="button" class="round" data-id="out" title="Zoom out (-)" aria-label="Zoom out">${ICONS.minus}</button>
    <button type="button" class="round" data-id="all" title="Whole picture (0)" aria-label="Show the whole picture">${ICONS.all}</button>
    <button type="button" class="round" data-id="in" title="Zoom in (+)" aria-label="Zoom in">${ICONS.plus}</button></span>
  </div>
</main>
<aside class="panel" aria-label="Face and points">
  <section class="face" aria-label="Fitted face">
    <div class="stage"><canvas data-id="face" tabindex="0" role="img" aria-label="3D view of the fitted face. Arrow keys turn it, plus and minus zoom, 0 shows it as in the picture."></canvas>
      <p class="note" data-id="noface" hidden></p></div>
    <div class="row under">
      <fieldset class="looks"><legend class="hidden">Look</legend>
        <label><input type="radio" name="look" value="clay" checked><span>Clay</span></label>
        <label><input type="radio" name="look" value="picture"><span>Picture</span></label>
      </fieldset>
      <button type="button" data-id="front" title="As in the picture">Reset</button>
      <button type="button" data-id="fitted" aria-pressed="false" title="Mark where the fitted face has its points (F)">Marks</button>
    </div>
    <p class="quiet fitline" data-id="fitline"></p>
  </section>
  <section class="chosen" aria-label="Selection">
    <h2 data-id="chosen">No point selected</h2>
    <div class="row" data-id="places">
      <label>x <input type="number" step="0.1" data-id="x"></label>
      <label>y <input type="number" step="0.1" data-id="y"></label>
      <label class="check"><input type="checkbox" data-id="missing"><span>Missing</span></label>
    </div>
    <div class="row">
      <button type="button" data-id="part" title="Select the whole part (double click)">Whole part</button>
      <button type="button" data-id="mirror" title="Copy to the other side of the face (M)">Mirror</button>
    </div>
    <label class="reach" data-id="reaching" hidden><span>Softness</span><input type="range" min="0.08" max="1" step="0.01" data-id="reach"></label>
  </section>
  <section aria-label="Start again">
    <h2>Start again</h2>
    <div class="row"><button type="button" data-id="detect">Detect</button><button type="button" data-id="clicks">Place by clicks</button></div>
  </section>
  <section aria-label="Points">
    <h2>Points</h2>
    <p class="legend"><span class="placed">placed</span><span class="sure">sure</span><span class="rather">fairly sure</span><span class="unsure">unsure</span><span class="missing">missing</span></p>
    <div class="points" data-id="points" role="listbox" aria-multiselectable="true" aria-label="Landmarks" tabindex="0"></div>
  </section>
</aside>
<p class="status" data-id="status" role="status" aria-live="polite"></p>
<dialog data-id="dialog" aria-label="Question"><div class="words" data-id="words"></div><form method="dialog" class="row" data-id="answers"></form></dialog>
`;

export const HELP = [
  ['Drag a point', 'moves it; drag a line: the whole part'],
  ['Double click', 'selects the part'],
  ['Shift and click, Shift and drag', 'select several, or those in a box'],
  ['Drag the picture, wheel, pinch', 'move and zoom'],
  ['Arrows', 'nudge by 1 px; Shift 10, Alt 0.1'],
  ['Tab, Shift+Tab; N, P', 'leave the picture; next and previous point'],
  ['A, Esc', 'select all, none'],
  ['Delete', 'the point is missing, or there again'],
  ['S, B, M, F', 'soft drag, both sides, mirror, marks of the fitted face'],
  ['+ − 0', 'zoom, whole picture'],
  ['Ctrl+Z, Ctrl+Shift+Z, Ctrl+S', 'undo, redo, save'],
  ['Page Up, Page Down', 'previous and next picture of a folder'],
];
