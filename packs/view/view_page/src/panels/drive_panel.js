// Driving: pad for mouse and touch, keys as `--teleop` has them, goals and initial poses by a click on the ground.
import * as T from 'three';
import { element, isPageKey, panel } from '../dom.js';

const KEYS = { w: 'w', x: 'x', a: 'a', d: 'd', s: 's', j: 'j', l: 'l', q: 'q', z: 'z', ArrowUp: 'up', ArrowDown: 'down', ArrowLeft: 'left', ArrowRight: 'right' };
const RESEND = 200; // [ms] while the pad is held, so that the time-out of the commands does not stop the robot

export function makeDrivePanel(app) {
  const choice = element('select', { id: 'target', title: 'Robot', onchange: () => show() });
  const knob = element('div', { class: 'knob' }), pad = element('div', { id: 'pad', class: 'pad', title: 'Drag to drive' }, knob);
  const speeds = element('div', { id: 'speeds', class: 'dim' });
  const stop = element('button', { id: 'stop', onclick: () => key('s') }, 'Stop (s)');
  const go = element('button', { id: 'go', title: 'Click on the ground, drag for the direction', onclick: () => aim('goal', go) }, 'Go there');
  const here = element('button', { id: 'here', title: 'Click on the ground, drag for the direction', onclick: () => aim('initial', here) }, 'I am here');
  const answer = element('div', { id: 'pose-answer', class: 'dim' });
  const help = element('div', { class: 'dim keys' }, 'w a s d x or arrows: drive');
  const driving = element('div', { class: 'driving' }, choice, pad, speeds, stop);
  const box = panel('drive', 'Drive', driving, help, element('div', { class: 'row' }, go, here), answer);
  let targets = [], commands = {}, timer = null, wanted = [0, 0];

  const target = () => targets[choice.selectedIndex];
  /** Shows the present command, which also comes from a navigator, another page, or the end of a time-out. */
  const showCommand = () => {
    if (!target()) return;
    const [[ahead, left, turn], since, missing] = commands[target().topic] ?? [[0, 0, 0], null, ''];
    const parts = [`${ahead.toFixed(2)} m/s`, ...(target().sideways ? [`${left.toFixed(2)} m/s left`] : []), `${turn.toFixed(2)} rad/s`];
    const age = since === null || !(ahead || left || turn) ? 0 : (app.state?.time ?? since) - since;
    speeds.textContent = parts.join('  ') + (missing ? `, stopped: ${missing}` : age > 1 ? `, sent ${age.toFixed(0)} s ago` : '');
    speeds.title = `Command on ${target().topic}`;
  };
  const want = () => app.connection.want('driving', box.open && !box.hidden ? {} : null);
  const show = () => {
    driving.hidden = help.hidden = targets.length === 0;
    choice.hidden = targets.length < 2;
    box.hidden = targets.length === 0;
    showCommand();
    want();
  };
  const key = name => { if (target()) app.send('key', { topic: target().topic, key: name }); };
  const drive = () => {
    if (!target()) return;
    const most = (bounds, value, other) => value * Math.abs((value > 0 ? bounds[1] : bounds[0]) ?? other);
    app.send('drive', { topic: target().topic, ahead: most(target().linear, wanted[0], 1), turn: most(target().angular, wanted[1], 1.5) });
  };

  const movePad = event => {
    const area = pad.getBoundingClientRect();
    let x = 2 * (event.clientX - area.left) / area.width - 1, y = 2 * (event.clientY - area.top) / area.height - 1;
    const length = Math.hypot(x, y);
    if (length > 1) { x /= length; y /= length; }
    knob.style.translate = `${36 * x}px ${36 * y}px`;
    wanted = [-y, -x];
  };
  const endPad = () => {
    if (timer === null) return;
    clearInterval(timer);
    timer = null;
    knob.style.translate = '0 0';
    key('s');
  };
  pad.addEventListener('pointerdown', event => {
    pad.setPointerCapture(event.pointerId);
    movePad(event);
    drive();
    timer ??= setInterval(drive, RESEND);
  });
  pad.addEventListener('pointermove', event => { if (timer !== null) { movePad(event); } });
  for (const end of ['pointerup', 'pointercancel', 'lostpointercapture']) pad.addEventListener(end, endPad);
  addEventListener('blur', endPad);
  addEventListener('keydown', event => {
    if (!isPageKey(event)) return;
    const name = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
    if (name && targets.length) { event.preventDefault(); key(name); }
  });

  // ---- goals
  const arrow = new T.ArrowHelper(new T.Vector3(1, 0, 0), new T.Vector3(), 0.5, 0x30d158, 0.18, 0.12);
  arrow.visible = false;
  app.stage.helpers.add(arrow);
  let aiming = null;
  const aim = (kind, button) => {
    const isOff = app.aiming === kind;
    endAim();
    if (isOff) return;
    aiming = app.aiming = kind;
    button.classList.add('on');
    app.stage.controls.enabled = false;
    app.stage.canvas.style.cursor = 'crosshair';
    answer.textContent = 'click on the ground and drag for the direction';
    answer.className = 'dim';
  };
  const endAim = () => {
    aiming = app.aiming = null;
    go.classList.remove('on');
    here.classList.remove('on');
    app.stage.controls.enabled = app.views.sensor === null;
    app.stage.canvas.style.cursor = '';
    answer.textContent = '';
  };
  addEventListener('keydown', event => { if (event.key === 'Escape' && aiming) endAim(); });
  const ground = event => {
    const hit = app.pickAt(event.clientX, event.clientY);
    if (hit) return hit.point;
    const area = app.stage.canvas.getBoundingClientRect(), ray = new T.Raycaster();
    ray.setFromCamera(new T.Vector2(2 * (event.clientX - area.left) / area.width - 1, 1 - 2 * (event.clientY - area.top) / area.height), app.stage.camera);
    return ray.ray.intersectPlane(new T.Plane(new T.Vector3(0, 0, 1), 0), new T.Vector3());
  };
  let from = null;
  const canvas = app.stage.canvas;
  canvas.addEventListener('pointerdown', event => {
    from = aiming ? ground(event) : null;
    if (!from) return;
    canvas.setPointerCapture(event.pointerId);
    arrow.position.copy(from).setZ(from.z + 0.05);
    arrow.setColor(aiming === 'goal' ? 0x30d158 : 0x58a6ff);
    arrow.visible = true;
    app.stage.invalidate();
  });
  const yawTo = event => {
    const to = ground(event);
    return to && to.distanceTo(from) > 0.1 ? Math.atan2(to.y - from.y, to.x - from.x) : 0;
  };
  canvas.addEventListener('pointermove', event => {
    if (!from) return;
    const yaw = yawTo(event);
    arrow.setDirection(new T.Vector3(Math.cos(yaw), Math.sin(yaw), 0));
    app.stage.invalidate();
  });
  canvas.addEventListener('pointerup', event => {
    if (!from || !aiming) return;
    event.stopImmediatePropagation(); // the click selects nothing
    app.ask('pose', { kind: aiming, x: from.x, y: from.y, yaw: yawTo(event) }).then(tell, error => app.report(error.message));
    from = null;
    endAim();
  });

  /** Says what has become of a pose: nothing, if no program receives it. */
  const tell = ({ topic, missing }) => {
    answer.textContent = missing || `published on ${topic}${app.state.paused ? '; the world is paused' : ''}`;
    answer.className = missing ? 'problem' : 'dim';
    if (missing) app.report(missing);
  };

  let newest = 0;
  app.on('state', ({ tick }) => {
    if (tick < newest) { // a reset: the goal belongs to the time before it
      arrow.visible = false;
      answer.textContent = '';
      app.stage.invalidate();
    }
    newest = tick;
  });
  app.on('scene', () => app.ask('targets').then(found => fill(found)).catch(() => {}));
  app.on('link', isUp => { if (isUp) app.ask('targets').then(found => fill(found)).catch(() => {}); });
  const fill = found => {
    const chosen = target()?.topic;
    targets = found;
    choice.replaceChildren(...found.map(one => element('option', {}, one.model || one.topic)));
    choice.selectedIndex = Math.max(0, found.findIndex(one => one.topic === chosen));
    show();
  };
  app.on('packet:driving', packet => { commands = packet.commands; showCommand(); });
  app.on('state', showCommand);
  box.addEventListener('toggle', want);
  box.hidden = true;
  return box;
}
