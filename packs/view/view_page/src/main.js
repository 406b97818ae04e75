// Page of simkit's live view. `app` connects its parts: they announce events and listen to those of others.
import * as T from 'three';
import { Connection } from './connection.js';
import { Displays } from './displays.js';
import { element, keptChoice, narrow } from './dom.js';
import { Layers } from './layers.js';
import { PANELS } from './panels/index.js';
import { Player, loadRecording } from './player.js';
import { Sensors } from './sensors.js';
import { Stage } from './stage.js';
import { makeToolbar } from './toolbar.js';
import { makeTour } from './tour.js';
import { Views } from './views.js';
import { World } from './world.js';

const listeners = new Map();

/**
 * Events: `scene` (a new scene is loaded), `state`, `packet:KIND`, `select`, `layers`, `view`, `link`.
 * `scene` and `state` are the newest packets, `models` the top-level models by name, `robots` those that can move,
 * `selected` the scoped name of the selected link or model.
 */
const app = {
  scene: null, state: null, models: new Map(), robots: [], selected: null, stats: { states: 0 },
  on(event, call) { listeners.set(event, [...(listeners.get(event) ?? []), call]); },
  emit(event, value) { for (const call of listeners.get(event) ?? []) call(value); },
  select(link) { app.selected = link; app.emit('select', link); app.stage.invalidate(); },
  report(text) { showNotice(text); },
};
app.receive = packet => receive(packet);
window.simkitView = app; // for tests, and for the curious

const ENDED = 'The simulation has ended or cannot be reached. The page connects again when it can; a new run has a new address.';
let noticeTimer, standing = ''; // text that is shown until its cause is gone
function showNotice(text) {
  setNotice(text);
  clearTimeout(noticeTimer);
  noticeTimer = setTimeout(() => setNotice(standing), 6000);
}
function setNotice(text) {
  const notice = document.getElementById('notice');
  if (text) notice.textContent = text; // a hidden notice keeps its text
  notice.hidden = !text;
}
setNotice('');

/** Tells why nothing moves while there is no connection. A hidden page ends its connection itself. */
function showLink(isUp) {
  const before = standing;
  standing = isUp || document.hidden || app.player ? '' : ENDED;
  if (standing !== before) setNotice(standing); // the first connection leaves the notice of the first view
}

const BY_NUMBER = /^(state|appearance|joints)$|^display:/; // packets with numbers of bodies, shapes or joints of the newest scene
const early = new Map(); // the newest of them, while the page loads that scene

function receive(packet) {
  if (packet.kind === 'scene_changed' || packet.kind === 'state') requireScene(packet.revision);
  if (BY_NUMBER.test(packet.kind) && isOld()) {
    early.set(packet.kind, packet);
    return;
  }
  if (packet.kind === 'state') takeState(packet);
  else if (packet.kind === 'appearance') takeAppearance(packet);
  app.emit(`packet:${packet.kind.split(':', 1)[0]}`, packet);
}

function takeState(packet) {
  if (packet.revision !== app.scene.revision) return; // older than the scene
  const isBack = app.state && packet.tick < app.state.tick;
  app.state = packet;
  app.stats.states += 1;
  app.world.setPoses(packet.arrays.poses);
  if (isBack) app.layers.setPaths({});
  app.layers.extendPaths(app.bodyOf);
  app.emit('state', packet);
}

function takeAppearance(packet) {
  if (packet.revision === app.scene.revision) app.world.setAppearance(packet.arrays);
}

let isLoading = false, required = 1;
const isOld = () => (app.scene?.revision ?? 0) < required;

/** Loads the scene if it is older than a revision. A paused simulation announces a revision only once. */
async function requireScene(revision) {
  required = Math.max(required, revision);
  if (isLoading) return;
  isLoading = true;
  for (let tries = 0; isOld() && tries < 20; tries++) {
    if (!await loadScene()) await new Promise(resolve => setTimeout(resolve, 500));
  }
  isLoading = false;
}

/** Loads the scene; returns false, and tells why, if that fails. */
async function loadScene() {
  try {
    const scene = await app.connection.loadScene(), isFirst = !app.scene;
    app.stage.setSurroundings(scene.surroundings, scene.arrays);
    await app.world.load(scene);
    app.scene = scene;
    app.models = new Map(scene.models.map(model => [model.name, model]));
    app.bodyOf = movingModels(scene);
    app.robots = findRobots(scene);
    app.layers.load();
    app.emit('scene', scene);
    document.title = `${scene.world} – simkit`;
    for (const packet of isOld() ? [] : [...early.values()]) {
      early.delete(packet.kind);
      receive(packet);
    }
    if (scene.recording && isFirst) {
      app.player = app.connection.player = new Player(app, await loadRecording(app.connection));
      app.player.show();
      app.emit('recording', app.player);
    }
    if (isFirst) app.views.first();
    app.connection.ask('travel').then(paths => app.layers.setPaths(paths)).catch(() => {});
  } catch (error) {
    showNotice(`the scene cannot be loaded: ${error.message}`);
    return false;
  }
  app.stage.invalidate();
  return true;
}

/** Returns the first moving body of each model that can move. */
function movingModels(scene) {
  const moving = new Set(scene.arrays.moving), found = new Map();
  for (const [name, body] of scene.frames) {
    const model = name.split('::', 1)[0];
    if (moving.has(body) && !found.has(model)) found.set(model, body);
  }
  return found;
}

/** Returns the models with joints or sensors that can move; without any, all models that can move. */
function findRobots(scene) {
  const active = new Set([...scene.joints, ...scene.sensors].map(item => item.name.split('::', 1)[0]));
  const moving = scene.models.filter(model => app.bodyOf.has(model.name));
  const robots = moving.filter(model => active.has(model.name));
  app.isRobot = name => active.has(name);
  app.hasRobots = robots.length > 0;
  return robots.length ? robots : moving;
}

function pickOnClick(canvas) {
  let down = null;
  canvas.addEventListener('pointerdown', event => { down = [event.clientX, event.clientY]; canvas.focus({ preventScroll: true }); });
  canvas.addEventListener('pointerup', event => {
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 4 || !app.scene) return;
    const hit = app.pickAt(event.clientX, event.clientY);
    if (app.clickMode) app.clickMode(hit, event);
    else app.select(hit && !hit.isFloor ? hit.link : null);
  });
}

app.pickAt = (x, y) => {
  const box = app.stage.canvas.getBoundingClientRect(), ray = new T.Raycaster();
  ray.setFromCamera(new T.Vector2(2 * (x - box.left) / box.width - 1, 1 - 2 * (y - box.top) / box.height), app.stage.camera);
  return app.world.pick(ray);
};

/** Returns where the ray of a pointer event meets the level z = 0; null above the horizon. */
app.groundAt = ({ clientX, clientY }) => {
  const box = app.stage.canvas.getBoundingClientRect(), ray = new T.Raycaster();
  ray.setFromCamera(new T.Vector2(2 * (clientX - box.left) / box.width - 1, 1 - 2 * (clientY - box.top) / box.height), app.stage.camera);
  return ray.ray.intersectPlane(new T.Plane(new T.Vector3(0, 0, 1), 0), new T.Vector3());
};

try {
  app.on('link', showLink);
  app.stage = new Stage(document.getElementById('canvas'), new URLSearchParams(location.search).get('quality') ?? keptChoice('quality') ?? 'auto');
  app.world = new World(app.stage);
  app.connection = new Connection(packet => { if (!app.player || packet.recorded) receive(packet); }, showNotice, isUp => app.emit('link', isUp));
  app.layers = new Layers(app);
  app.views = new Views(app);
  app.sensors = new Sensors(app);
  app.displays = new Displays(app);
  app.ask = (name, args) => app.connection.ask(name, args);
  app.send = (name, args) => app.connection.send(name, args);
  makeToolbar(app, document.getElementById('toolbar'));
  for (const [side, make] of PANELS) {
    const made = make(app);
    if (made) document.getElementById(side).append(made);
  }
  const sides = ['left', 'right'].map(side => document.getElementById(side)), fromLeft = [...sides[0].children];
  const arrange = () => sides[narrow.matches ? 1 : 0].append(...fromLeft);
  narrow.addEventListener('change', arrange);
  arrange();
  makeTour(app);
  pickOnClick(app.stage.canvas);
  // A list that was used with the mouse gives the keys back to the page: with its focus, they would change the choice.
  addEventListener('change', ({ target }) => { if (target.matches('select:not(:focus-visible)')) target.blur(); });
  await loadScene();
  app.connection.open();
} catch (error) {
  document.getElementById('view').append(element('p', { class: 'failure' }, error.message));
  throw error;
}
