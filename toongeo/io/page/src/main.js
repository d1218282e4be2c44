import { AnimationMixer } from 'three';
import { loadAvatar } from './avatar.js';
import { listen, paced } from './live.js';
import { buildPanel, byId } from './panel.js';
import { Stage } from './stage.js';

const settings = JSON.parse(byId('settings').textContent);

function tell(text, wrong = false) {
  byId('status').textContent = text;
  byId('status').classList.toggle('wrong', wrong);
}

function embedded() {
  return Uint8Array.from(atob(byId('glb').textContent.trim()), (letter) => letter.charCodeAt(0)).buffer;
}

function toggle(button, act) {
  button.addEventListener('click', () => {
    const on = button.getAttribute('aria-pressed') !== 'true';
    button.setAttribute('aria-pressed', on);
    act(on);
  });
}

async function save(stage) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(await stage.picture());
  link.download = `${settings.title.replace(/[^\p{L}\p{N}._-]+/gu, '-').replace(/^[.-]+/, '') || 'avatar'}.png`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

async function start() {
  const stage = new Stage(byId('view'));
  const avatar = await loadAvatar(embedded());
  const set = (weights) => {
    avatar.set(weights);
    stage.draw();
  };
  const panel = buildPanel(avatar.names, settings.presets, set);
  stage.show(avatar);

  for (const input of document.querySelectorAll('#looks input')) {
    input.addEventListener('change', () => {
      avatar.wear(input.value);
      stage.light(input.value);
      stage.draw();
    });
  }
  byId('front').addEventListener('click', () => stage.front());
  byId('shot').addEventListener('click', () => save(stage));
  const turning = (seconds) => stage.turn(0.7 * seconds, 0);
  toggle(byId('turn'), (on) => stage.every(turning, on));

  if (avatar.hair) {
    byId('hair').hidden = false;
    toggle(byId('hair'), (on) => {
      avatar.hair.visible = on;
      stage.draw();
    });
  }
  if (avatar.clips.length) {
    const mixer = new AnimationMixer(avatar.scene);
    const action = mixer.clipAction(avatar.clips[0]);
    const playing = (seconds) => {
      mixer.update(seconds);
      panel.show(avatar.weights());
    };
    byId('play').hidden = false;
    toggle(byId('play'), (on) => {
      if (on) action.reset().play();
      else action.stop();
      set(Object.fromEntries(avatar.names.map((name) => [name, 0])));
      stage.every(playing, on);
      panel.show(avatar.weights());
    });
  }

  // Weights may come a thousand times a second; sliders and the picture follow as they can.
  let unseen = {};
  const follow = paced(() => {
    panel.show(unseen);
    unseen = {};
    stage.draw();
  });
  const apply = (weights) => {
    avatar.set(weights);
    Object.assign(unseen, weights);
    follow();
  };
  tell(`${avatar.names.length} expressions. Drag to turn, scroll to zoom.`);
  if (settings.live) listen(settings.live, { apply, tell });
  // For scripts: window.toongeo.set({ jawOpen: 0.5 })
  window.toongeo = { names: avatar.names, set: apply, weights: avatar.weights, project: (point) => stage.project(point) };
  document.documentElement.dataset.ready = 'true';
}

start().catch((error) => tell(`The avatar cannot be shown: ${error.message}`, true));
