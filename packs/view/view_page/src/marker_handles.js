// Interactive markers: a gizmo at one of them, whose feedback goes to the program that serves the marker.
import * as T from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { element } from './dom.js';
import { readPose } from './world.js';

const PERIOD = 60; // [ms] between two poses of a marker that is dragged
const AXES = ['showX', 'showY', 'showZ'];

export class MarkerHandles {
  constructor(app) {
    this.app = app;
    this.proxy = new T.Object3D();
    this.gizmo = new TransformControls(app.stage.camera, app.stage.canvas);
    this.gizmo.setSize(0.7);
    this.edited = null; // topic and name of the marker with the gizmo
    this.timer = null;
    app.stage.helpers.add(this.proxy, this.gizmo.getHelper());
    this.gizmo.addEventListener('change', () => app.stage.invalidate());
    this.gizmo.addEventListener('objectChange', () => { this.timer ??= setTimeout(() => this.send('pose_update'), PERIOD); });
    this.gizmo.addEventListener('dragging-changed', ({ value }) => {
      app.stage.controls.enabled = !value && app.views.sensor === null;
      if (value) this.send('mouse_down');
      else { clearTimeout(this.timer); this.send('pose_update'); this.send('mouse_up'); }
    });
    app.on('displays', () => this.follow());
  }

  /** Returns the elements of a marker in the list of topics. */
  row(handle) {
    const button = (mode, text) => element('button', { 'data-marker': `${mode} ${handle.name}`, onclick: () => this.edit(handle, mode) }, text);
    const tools = element('div', { class: 'row' });
    if (handle.move.includes(true)) tools.append(button('translate', 'Move'));
    if (handle.turn.includes(true)) tools.append(button('rotate', 'Turn'));
    if (handle.button) tools.append(element('button', { 'data-marker': `click ${handle.name}`, onclick: () => this.event(handle, 'button_click') }, 'Click'));
    if (handle.menu.length) {
      const parents = new Set(handle.menu.map(([, parent]) => parent)), titles = new Map(handle.menu.map(([id, parent, title]) => [id, [parent, title]]));
      const full = id => { const [parent, title] = titles.get(id); return titles.has(parent) ? `${full(parent)} › ${title}` : title; };
      const entries = handle.menu.filter(([id]) => !parents.has(id)).map(([id]) => element('option', { value: id }, full(id)));
      const menu = element('select', { 'data-marker': `menu ${handle.name}`, onchange: () => { this.event(handle, 'menu_select', +menu.value); menu.selectedIndex = 0; } }, element('option', { value: '' }, 'Menu …'), ...entries);
      tools.append(menu);
    }
    return element('div', { class: 'marker' }, element('div', { class: 'dim' }, handle.description), tools);
  }

  newest(handle) {
    return this.app.displays.handles(handle.topic).find(one => one.name === handle.name) ?? null;
  }

  /** Sets a matrix to the pose of a marker in the world. */
  place(handle, matrix) {
    readPose(handle.pose, 0, matrix).premultiply(readPose(handle.offset, 0, new T.Matrix4()));
    const body = this.app.world.bodies[handle.body];
    return body ? matrix.premultiply(body) : matrix;
  }

  edit(handle, mode) {
    const again = this.edited?.name === handle.name && this.edited.topic === handle.topic && this.gizmo.mode === mode;
    this.end();
    if (again) return;
    this.app.modelEditor?.end();
    this.edited = { topic: handle.topic, name: handle.name };
    const allowed = mode === 'translate' ? handle.move : handle.turn;
    AXES.forEach((name, i) => { this.gizmo[name] = allowed[i]; });
    this.gizmo.setMode(mode);
    this.gizmo.setSpace(handle.space);
    this.follow();
    this.gizmo.attach(this.proxy);
    this.app.clickMode = hit => { if (!this.gizmo.axis) { this.end(); this.app.select(hit && !hit.isFloor ? hit.link : null); } };
    this.app.stage.invalidate();
  }

  /** Puts the gizmo where the program has put the marker. */
  follow() {
    if (!this.edited || this.gizmo.dragging) return;
    const handle = this.newest(this.edited);
    if (!handle) { this.end(); return; }
    this.place(handle, this.proxy.matrix).decompose(this.proxy.position, this.proxy.quaternion, this.proxy.scale);
  }

  end() {
    if (this.edited) this.app.clickMode = null;
    this.edited = null;
    this.gizmo.detach();
    this.app.stage.invalidate();
  }

  send(event) {
    this.timer = null;
    if (!this.edited) return;
    const { x, y, z, w } = this.proxy.quaternion;
    this.app.send('marker', { ...this.edited, event, pose: [...this.proxy.position.toArray(), w, x, y, z] });
  }

  event(handle, event, entry = 0) {
    const found = this.newest(handle), at = new T.Vector3(), turn = new T.Quaternion();
    if (!found) return;
    this.place(found, new T.Matrix4()).decompose(at, turn, new T.Vector3());
    this.app.send('marker', { topic: found.topic, name: found.name, event, entry, pose: [...at.toArray(), turn.w, turn.x, turn.y, turn.z] });
  }
}
