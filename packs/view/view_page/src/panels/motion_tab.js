// Motions by name, and trajectories of the joints of a controller.
import { element, fixed } from '../dom.js';
import { makeCallList } from './call_list.js';

const PLAY = 'play_motion2_msgs/action/PlayMotion2', FOLLOW = 'control_msgs/action/FollowJointTrajectory';

export function makeMotionTab(app) {
  const motions = element('div', { class: 'motions' }), controllers = element('div', { class: 'controllers' }), calls = makeCallList(app);
  const none = element('p', { class: 'dim hint', hidden: true }, 'No controller of this world takes motions or trajectories.');
  let isShown = false;

  const loadMotions = async actions => {
    const boxes = [];
    for (const name of Object.keys(actions).filter(one => actions[one] === PLAY)) {
      const found = await app.ask('call', { name: `${name}/list_motions` }).catch(() => null);
      for (const key of found?.values?.motion_keys ?? []) boxes.push(element('button', { 'data-motion': key, title: `${name}: ${key}`, onclick: () => app.send('goal', { name, values: { motion_name: key } }) }, key));
    }
    motions.replaceChildren(...boxes);
    motions.parentElement.hidden = !boxes.length;
  };
  const loadControllers = async ({ actions, services }) => {
    const states = new Map();
    for (const name of Object.keys(services).filter(one => one.endsWith('/list_controllers'))) {
      const found = await app.ask('call', { name }).catch(() => null), space = name.split('/').slice(0, -2).join('/');
      for (const controller of found?.values?.controller ?? []) states.set(`${space}/${controller.name}`, controller);
    }
    const boxes = Object.keys(actions).filter(one => actions[one] === FOLLOW).map((name, i) => makeController(name, states.get(name.slice(0, name.lastIndexOf('/'))), i === 0)).filter(Boolean);
    controllers.replaceChildren(...boxes);
    controllers.parentElement.hidden = !boxes.length;
  };
  const makeController = (action, state, isFirst) => {
    const names = [...new Set((state?.claimed_interfaces ?? []).map(one => one.slice(0, one.lastIndexOf('/'))))];
    if (!names.length) return null; // not active, or not of ros2_control
    const rows = names.map(name => {
      const index = app.scene.joints.findIndex(joint => joint.name.split('::').at(-1) === name), joint = app.scene.joints[index];
      const low = joint?.lower ?? -Math.PI, high = joint?.upper ?? Math.PI, value = element('output', { class: 'dim' });
      const slider = element('input', { type: 'range', min: low, max: high, step: (high - low) / 500, 'aria-label': name, 'data-target': name, oninput: () => { row.isMoved = true; value.textContent = (+slider.value).toFixed(3); } });
      const row = { name, index, slider, value, isMoved: false, element: element('label', {}, element('span', {}, name), value, slider) };
      return row;
    });
    const seconds = element('input', { type: 'number', min: 0.1, step: 0.1, value: 2, title: 'Duration [s]' });
    const scale = element('input', { type: 'range', min: 0.01, max: 1, step: 0.01, value: 1, 'data-scale': action, 'aria-label': 'speed', oninput: () => { percent.textContent = `${Math.round(100 * scale.value)} %`; } });
    const percent = element('output', { class: 'dim' }, '100 %');
    const move = element('button', { 'data-move': action, onclick: () => {
      const time = Math.max(0.05, +seconds.value || 2) / scale.value, point = { positions: rows.map(row => +row.slider.value), time_from_start: { sec: Math.floor(time), nanosec: Math.round((time % 1) * 1e9) } };
      app.send('goal', { name: action, values: { trajectory: { joint_names: names, points: [point] } } });
      for (const row of rows) row.isMoved = false;
    } }, 'Move');
    const box = element('details', { open: isFirst }, element('summary', { title: action }, action.split('/').slice(1, -1).join('/')), element('div', { class: 'joints' }, ...rows.map(row => row.element), element('label', { title: 'Speed scaling: the motion takes its duration, divided by this' }, element('span', {}, 'speed'), percent, scale)), element('div', { class: 'row-left' }, seconds, 's', move));
    box.rows = rows;
    return box;
  };
  const show = () => {
    for (const box of controllers.children) for (const row of box.rows) {
      const position = app.jointPositions[row.index];
      if (row.isMoved || !Number.isFinite(position)) continue;
      row.slider.value = position;
      row.value.textContent = fixed(position, 3);
    }
  };
  app.on('packet:joints', () => { if (isShown) show(); });
  const load = async () => {
    const found = await app.ask('interfaces').catch(() => null);
    if (!found) return;
    await loadMotions(found.actions);
    await loadControllers(found);
    none.hidden = !(motions.parentElement.hidden && controllers.parentElement.hidden);
    calls.parentElement.hidden = !none.hidden;
    show();
  };
  for (const event of ['scene', 'link']) app.on(event, () => { if (isShown) load(); });
  const section = (title, ...children) => element('div', { class: 'side' }, element('h4', {}, title), ...children);
  return {
    element: element('div', { class: 'motion-tab' }, none, section('Motions', motions), section('Trajectories', controllers), section('Goals', calls)),
    show(shown) {
      isShown = shown;
      app.connection.want('calls', shown ? {} : null);
      app.wantJoints('motions', shown);
      if (shown) load();
    },
  };
}
