import { loadAvatar } from './avatar.js';
import { canFilm, film } from './film.js';
import { converse } from './frame.js';
import { Idle } from './idle.js';
import { copy, linkTo, linked } from './link.js';
import { listen, paced } from './live.js';
import { buildPanel, byId } from './panel.js';
import { clipPlayer, takePlayer } from './play.js';
import { foldable } from './sheet.js';
import { Stage } from './stage.js';
import { readTake } from './take.js';

const settings = JSON.parse(byId('settings').textContent);
const calm = matchMedia('(prefers-reduced-motion: reduce)');

function tell(text, wrong = false) {
  byId('status').textContent = text;
  byId('status').classList.toggle('wrong', wrong);
}

async function embedded() {
  return (await fetch(`data:application/octet-stream;base64,${byId('glb').textContent.trim()}`)).arrayBuffer();
}

function press(button, on) {
  button.setAttribute('aria-pressed', on);
}

function toggle(button, act) {
  button.addEventListener('click', () => {
    const on = button.getAttribute('aria-pressed') !== 'true';
    press(button, on);
    act(on);
  });
}

function save(blob, suffix) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = `${settings.title.replace(/[^\p{L}\p{N}._-]+/gu, '-').replace(/^[.-]+/, '') || 'avatar'}${suffix}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// Buttons that concern the view alone.
function dressStage(stage, avatar) {
  for (const input of document.querySelectorAll('#looks input')) {
    input.addEventListener('change', () => {
      avatar.wear(input.value);
      stage.light(input.value);
      stage.draw();
    });
  }
  byId('front').addEventListener('click', () => stage.front());
  byId('shot').addEventListener('click', async () => save(await stage.picture(), '.png'));
  const turning = (seconds) => stage.turn(0.7 * seconds, 0);
  toggle(byId('turn'), (on) => stage.every(turning, on));
  if (avatar.hair) {
    byId('hair').hidden = false;
    toggle(byId('hair'), (on) => {
      avatar.hair.visible = on;
      stage.draw();
    });
  }
  byId('film').hidden = !canFilm();
  let end = null;
  toggle(byId('film'), async (on) => {
    stage.ground(on);
    if (on) end = film(stage.canvas);
    else save(await end(), '.webm');
    tell(on ? 'Filming. Press again to save.' : 'The film is saved.');
  });
}

// Blinks, glances and breath, unless somebody minds motion or something else moves the head.
function giveLife(stage, avatar) {
  const idle = new Idle(avatar);
  const tick = (seconds) => idle.tick(seconds);
  let wanted = !calm.matches && !settings.live;
  let held = false;
  function update() {
    press(byId('idle'), wanted);
    const on = wanted && !held;
    if (!on) idle.stop();
    stage.every(tick, on);
  }
  toggle(byId('idle'), (on) => {
    wanted = on;
    update();
  });
  calm.addEventListener('change', () => {
    wanted = !calm.matches && !settings.live;
    update();
  });
  update();
  return (hold) => {
    held = hold;
    update();
  };
}

// Takes that are dropped on the page, or chosen.
function takeTakes(player, avatar) {
  async function play(file) {
    try {
      const take = readTake(await file.text(), avatar.names);
      player.play(takePlayer(take), true);
      tell(`Playing ${file.name}: ${take.frames.length} frames, ${take.times.at(-1).toFixed(1)} s`);
    } catch (error) {
      tell(`${file.name} cannot be played: ${error.message}`, true);
    }
  }
  byId('take').addEventListener('change', (event) => {
    if (event.target.files[0]) play(event.target.files[0]);
    event.target.value = '';
  });
  document.addEventListener('dragover', (event) => event.preventDefault());
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    if (event.dataTransfer.files[0]) play(event.dataTransfer.files[0]);
  });
}

// What plays on the head: the file's animation, or a take.
function buildPlayer(stage, avatar, panel, hold) {
  let playing = null;
  const tick = (seconds) => {
    const weights = playing.at(seconds);
    if (weights) {
      avatar.set(weights);
      panel.show(weights);
    } else stop(); // it is over
  };
  function stop() {
    stage.every(tick, false);
    playing?.stop();
    press(byId('play'), false);
    avatar.set(avatar.rest());
    panel.show(avatar.rest());
    hold(false);
    stage.draw();
  }
  function play(what, now) {
    if (playing) stop();
    playing = what;
    byId('play').hidden = false;
    if (now) start();
  }
  function start() {
    press(byId('play'), true);
    panel.release();
    hold(true);
    avatar.set(avatar.rest());
    playing.start();
    stage.every(tick, true);
  }
  toggle(byId('play'), (on) => (on ? start() : stop()));
  return { play };
}

async function start() {
  foldable();
  const stage = new Stage(byId('view'));
  const avatar = await loadAvatar(await embedded());
  let told = () => {};
  const panel = buildPanel(avatar.names, settings.presets, (weights) => {
    avatar.set(weights);
    stage.draw();
    told(avatar.weights());
  });
  stage.show(avatar);
  await new Promise(requestAnimationFrame);
  document.documentElement.dataset.first = Math.round(performance.now()); // ms from the address to the first frame
  await new Promise((shown) => setTimeout(shown));
  await avatar.finish();

  dressStage(stage, avatar);
  const player = buildPlayer(stage, avatar, panel, giveLife(stage, avatar));
  if (avatar.clips.length) player.play(clipPlayer(avatar), false);
  takeTakes(player, avatar);

  const follow = () => panel.move({ ...avatar.rest(), ...linked(location.hash, avatar.names) });
  if (location.hash) follow();
  window.addEventListener('hashchange', follow);
  // An address with a key of this computer's server, or of a frame, is nobody else's.
  byId('link').hidden = Boolean(settings.live || settings.framed);
  byId('link').addEventListener('click', async () => {
    const address = linkTo(avatar.weights());
    await copy(address).then(() => tell('The link is copied.'), (error) => tell(`${error.message}: ${address}`, true));
  });

  // Weights may come a thousand times a second; sliders and the picture follow as they can.
  let unseen = {};
  const draw = paced(() => {
    panel.show(unseen);
    unseen = {};
    stage.draw();
  });
  const apply = (weights) => {
    avatar.set(weights);
    Object.assign(unseen, weights);
    draw();
  };
  const touched = matchMedia('(pointer: coarse)').matches;
  tell(touched ? 'Drag to turn, pinch to zoom.' : 'Drag to turn, scroll to zoom; drop a take (.csv) to play it.');
  if (settings.live) listen(settings.live, { apply, tell });
  // For scripts: window.toongeo.set({ jawOpen: 0.5 })
  window.toongeo = { names: avatar.names, set: apply, weights: avatar.weights, project: (point) => stage.project(point) };
  if (settings.framed) told = converse(apply);
  document.documentElement.dataset.ready = 'true';
}

start().catch((error) => tell(`The avatar cannot be shown: ${error.message}`, true));
