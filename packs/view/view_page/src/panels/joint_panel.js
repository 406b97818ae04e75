// Joints with their positions. Sliders move the joints while the world stands still, as joint_state_publisher_gui does.
import { element, panel } from '../dom.js';

const MOST = 80;

export function makeJointPanel(app) {
  const list = element('div', { class: 'joints' });
  const box = panel('joints', 'Joints', list);
  let rows = [];
  const degrees = joint => joint.type !== 'prismatic';
  const format = (joint, value) => degrees(joint) ? `${(value * 180 / Math.PI).toFixed(1)}°` : `${value.toFixed(3)} m`;
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
  app.on('scene', scene => {
    const robots = new Set(app.robots.map(robot => robot.name));
    rows = scene.joints.map((joint, i) => [joint, i]).filter(([joint]) => robots.has(joint.name.split('::', 1)[0])).slice(0, MOST).map(([joint, i]) => make(joint, i));
    list.replaceChildren(...rows.map(({ row }) => row));
    box.hidden = rows.length === 0 || scene.recording;
    want();
  });
  app.on('packet:joints', ({ arrays: { position } }) => {
    for (const { joint, index, slider, value } of rows) {
      if (Number.isNaN(position[index])) continue;
      value.textContent = format(joint, position[index]);
      if (document.activeElement !== slider || !slider.matches(':active')) slider.value = position[index];
    }
  });
  app.on('state', state => { for (const { slider } of rows) slider.disabled = !state.paused; });
  box.addEventListener('toggle', want);
  box.hidden = true;
  return box;
}
