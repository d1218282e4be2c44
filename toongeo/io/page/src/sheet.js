// The panel as a sheet that folds; on an upright phone it begins folded, and presets stay in reach.
import { byId } from './panel.js';

const UPRIGHT = matchMedia('(max-width: 760px) and (orientation: portrait)');

export function foldable() {
  const fold = (open) => {
    document.body.classList.toggle('folded', !open);
    byId('sheet').setAttribute('aria-expanded', open);
  };
  fold(!UPRIGHT.matches);
  byId('sheet').addEventListener('click', () => fold(document.body.classList.contains('folded')));
  byId('panel').addEventListener('keydown', (event) => {
    if (event.key !== 'Escape' || !byId('sheet').checkVisibility()) return;
    fold(false);
    byId('sheet').focus();
  });
  // A wide window has no handle to unfold it.
  new ResizeObserver(() => !byId('sheet').checkVisibility() && fold(true)).observe(document.body);
}
