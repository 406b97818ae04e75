// Bar at the top: run control, time, viewpoints, and the state of the connection.
import { element, isPageKey } from './dom.js';
import { isCamera } from './sensors.js';

const SPEEDS = [['0.1', 0.1], ['0.25', 0.25], ['0.5', 0.5], ['1', 1], ['2', 2], ['5', 5], ['no limit', null]];

export function makeToolbar(app, bar) {
  const button = (id, text, title, onclick) => element('button', { id, title, 'aria-label': title, onclick }, text);
  const play = button('play', '❚❚', 'Pause or resume (space)', () => togglePause(app));
  const count = element('input', { id: 'count', type: 'number', min: 1, value: 1, title: 'Steps' });
  const step = button('step', '▶❘', 'Make steps and pause (n)', () => makeSteps(app, +count.value || 1));
  const reset = button('reset', '⟲', 'Reset to the start', () => app.send('reset'));
  const speed = element('select', { id: 'speed', title: 'Highest real-time factor', onchange: () => app.send('pace', { value: SPEEDS[speed.selectedIndex][1] }) },
    ...SPEEDS.map(([text]) => element('option', {}, text === 'no limit' ? text : `${text} ×`)));
  const view = element('select', { id: 'viewpoint', title: 'Viewpoint', onchange: () => chooseView(app, view) });
  const time = element('span', { id: 'time' }), rtf = element('span', { id: 'rtf' });
  const link = element('span', { id: 'link', class: 'off' }, '● connecting'), drawn = element('span'), more = element('span', { class: 'more' }), frames = element('span', { id: 'frames' }, drawn, more);
  const world = element('strong', { id: 'world' }), seed = element('span', { id: 'seed', class: 'dim', title: 'Seed of all random streams' });
  bar.append(world, seed, element('span', { class: 'group' }, play, step, count, reset), speed, time, rtf,
    element('span', { class: 'space' }), view, button('tour-start', '?', 'Tour of the page', () => app.tour.start()), frames, link);

  app.on('scene', scene => {
    world.textContent = scene.world;
    seed.textContent = `seed ${scene.seed}`;
    const cameras = scene.sensors.filter(isCamera);
    const options = [['', 'View …'], ['first', 'Robots'], ['all', 'Everything'], ['top', 'From above'], ...app.robots.slice(0, 40).map(robot => [`follow:${robot.name}`, `Follow ${robot.name}`]),
      ...cameras.slice(0, 40).map(sensor => [`through:${sensor.name}`, `Through ${sensor.name.split('::').at(-1)}`])];
    view.replaceChildren(...options.map(([value, text]) => element('option', { value }, text)));
  });
  app.on('state', state => {
    play.textContent = state.paused ? '▶' : '❚❚';
    time.textContent = `${state.time.toFixed(state.paused ? 3 : 2)} s`;
    rtf.textContent = state.paused ? 'paused' : `${state.rtf.toFixed(2)} × real time`;
    const index = SPEEDS.findIndex(([, value]) => value === state.pace);
    if (document.activeElement !== speed && index >= 0) speed.selectedIndex = index;
  });
  app.on('link', isUp => {
    if (app.player) return;
    link.textContent = isUp ? '● live' : '● ended';
    link.className = isUp ? 'on' : 'off';
    if (!isUp) rtf.textContent = 'no connection';
  });
  app.on('recording', player => {
    link.textContent = `● recording ${player.recording.name}`;
    link.className = 'on';
  });
  let draws = 0, states = 0, bytes = 0;
  setInterval(() => {
    if (document.hidden || !app.connection) return;
    const count = app.stage.draws - draws;
    drawn.textContent = count || !app.player ? `${count} frames/s` : ''; // a recording that stands draws nothing
    more.textContent = (app.player ? '' : ` · ${app.stats.states - states} states/s · ${((app.connection.bytes - bytes) / 1024).toFixed(0)} KB/s`) + (app.stage.isSoftware ? ' · software' : '');
    frames.title = frames.textContent;
    [draws, states, bytes] = [app.stage.draws, app.stats.states, app.connection.bytes];
  }, 1000);
  addEventListener('keydown', event => {
    if (!isPageKey(event)) return;
    if (event.key === ' ') { event.preventDefault(); togglePause(app); }
    else if (event.key === 'n') makeSteps(app, 1);
    else if (event.key === 'f') toggleFollow(app);
    else if (event.key === 'h') app.views.first();
  });
}

function togglePause(app) {
  app.send('pause', { value: !app.state?.paused });
}

async function makeSteps(app, count) {
  if (!app.state?.paused) await app.send('pause', { value: true });
  app.send('step', { count });
}

function toggleFollow(app) {
  if (app.views.followed !== null) { app.views.follow(null); return; }
  const model = app.selected?.split('::', 1)[0] ?? app.robots[0]?.name;
  app.views.follow(app.bodyOf.get(model) ?? null);
}

function chooseView(app, menu) {
  const [kind, ...rest] = menu.value.split(':'), name = rest.join(':');
  if (kind === 'follow') app.views.follow(app.bodyOf.get(name) ?? null);
  else if (kind === 'through') app.views.through(app.scene.sensors.find(sensor => sensor.name === name));
  else if (kind) app.views[kind]();
  menu.selectedIndex = 0;
  menu.blur();
}
