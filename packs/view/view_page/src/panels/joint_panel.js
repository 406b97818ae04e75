// Joints with their positions, in groups. Sliders move the joints of a paused world, as joint_state_publisher_gui does.
import { element, fixed, panel } from '../dom.js';

const MOST = 80;

export function makeJointPanel(app) {
  const list = element('div', { class: 'joints' });
  const box = panel('joints', 'Joints', list);
  let rows = [];
  app.jointPositions = []; // newest positions; a paused world sends them once, also for panels that open later
  const degrees = joint => joint.type !== 'prismatic';
  const format = (joint, value) => degrees(joint) ? `${fixed(value * 180 / Math.PI, 1)}°` : `${fixed(value, 3)} m`;
  const make = (joint, index) => {
    const range = joint.type === 'continuous' || joint.lower === null || joint.upper === null ? [-Math.PI, Math.PI] : [joint.lower, joint.upper];
    const value = element('output', { class: 'dim' });
    const slider = element('input', { type: 'range', min: range[0], max: range[1], step: (range[1] - range[0]) / 500, 'aria-label': joint.name, 'data-joint': joint.name,
      oninput: () => app.send('joint', { name: joint.name, value: +slider.value }) });
    slider.hidden = joint.axes.length !== 1 || range[0] >= range[1];
    return { joint, index, slider, value, row: element('label', { title: joint.name }, element('span', {}, joint.name.split('::').at(-1)), value, slider) };
  };
  const others = new Set(); // other panels that show positions
  const want = () => app.connection.want('joints', (rows.length && box.open && !box.hidden) || others.size ? {} : null);
  app.wantJoints = (name, isWanted) => {
    if (isWanted) others.add(name); else others.delete(name);
    want();
  };
  /** Shows the newest positions, unless they belong to another scene, which is then loaded soon. */
  const show = () => {
    const newest = app.jointPositions;
    if (newest.length !== app.scene?.joints.length) return;
    for (const { joint, index, slider, value } of rows) {
      value.textContent = format(joint, newest[index]);
      if (document.activeElement !== slider || !slider.matches(':active')) slider.value = newest[index];
    }
  };
  app.on('scene', scene => {
    const robots = new Set(app.robots.map(robot => robot.name));
    const groups = scene.jointGroups.filter(([, numbers]) => robots.has(scene.joints[numbers[0]].name.split('::', 1)[0]));
    rows = [];
    list.replaceChildren(...groups.flatMap(([heading, numbers]) => {
      const made = numbers.slice(0, MOST - rows.length).map(number => make(scene.joints[number], number));
      rows.push(...made);
      return made.length ? [...(groups.length > 1 ? [element('h4', {}, heading)] : []), ...made.map(({ row }) => row)] : [];
    }));
    const more = groups.flatMap(([, numbers]) => numbers).length - rows.length;
    if (more) list.append(element('p', { class: 'dim' }, `and ${more} more`));
    box.hidden = rows.length === 0 || scene.recording;
    if (app.state) enable(app.state);
    show(); // a paused world sends no further positions
    want();
  });
  app.on('packet:joints', ({ arrays }) => { app.jointPositions = arrays.position; show(); });
  const enable = state => { for (const { slider } of rows) slider.disabled = !state.paused; };
  app.on('state', enable);
  box.addEventListener('toggle', want);
  box.hidden = true;
  return box;
}
