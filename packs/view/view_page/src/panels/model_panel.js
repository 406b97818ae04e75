// Models: spawn one by a click on the ground, move and turn the selected one by a gizmo, delete it.
import * as T from 'three';
import { TransformControls } from 'three/examples/jsm/controls/TransformControls.js';
import { element, panel } from '../dom.js';
import { readPose } from '../world.js';

const PERIOD = 60; // [ms] between two poses of a model that is dragged

export function makeModelPanel(app) {
  const choice = element('select', { id: 'spawn-model', title: 'Model to spawn' });
  const place = element('button', { id: 'spawn', title: 'Click on the ground where the model shall stand', onclick: () => aim(!app.clickMode) }, 'Place');
  const name = element('div', { class: 'dim', id: 'edited' });
  const button = (id, text, title, onclick) => element('button', { id, title, onclick }, text);
  const tools = element('div', { class: 'row' }, button('move-model', 'Move', 'Move the selected model along the arrows', () => edit('translate')),
    button('turn-model', 'Turn', 'Turn the selected model by the rings', () => edit('rotate')),
    button('delete-model', 'Delete', 'Remove the selected model from the world', () => remove()));
  const box = panel('models', 'Models', element('div', { class: 'row' }, choice, place), name, tools);
  const proxy = new T.Object3D(), gizmo = new TransformControls(app.stage.camera, app.stage.canvas), helper = gizmo.getHelper();
  app.stage.helpers.add(proxy, helper);
  gizmo.setSize(0.8);
  let sources = {}, edited = null, timer = null, spawned = null;

  const model = () => app.selected?.split('::', 1)[0] ?? null;
  const show = () => {
    const isPlacing = app.clickMode === spawnAt;
    name.textContent = isPlacing ? 'click on the ground' : model() ?? 'select a model to move, turn or delete it';
    for (const tool of tools.children) tool.disabled = model() === null;
    tools.children[0].classList.toggle('on', edited !== null && gizmo.mode === 'translate');
    tools.children[1].classList.toggle('on', edited !== null && gizmo.mode === 'rotate');
    place.classList.toggle('on', isPlacing);
  };

  // ---- spawn
  const aim = on => {
    end();
    app.clickMode = on ? spawnAt : null;
    app.stage.canvas.style.cursor = on ? 'crosshair' : '';
    show();
  };
  const spawnAt = async (hit, event) => {
    const point = hit?.point ?? app.groundAt(event);
    if (!point) return;
    aim(false);
    const source = sources[choice.value];
    let free = choice.value, number = 1;
    while (app.models.has(free)) free = `${choice.value}_${number++}`;
    try {
      spawned = await app.ask('spawn', { source, name: free, x: point.x, y: point.y });
      selectSpawned();
    } catch (error) { app.report(error.message); }
  };

  const selectSpawned = () => {
    if (!app.models.has(spawned)) return; // its scene comes later
    app.select(app.models.get(spawned).links[0] ?? spawned);
    spawned = null;
  };

  // ---- move and turn
  const edit = async mode => {
    const wanted = model(), again = edited === wanted && gizmo.mode === mode;
    end();
    if (again || wanted === null) return;
    try {
      readPose(await app.ask('model_pose', { name: wanted }), 0, proxy.matrix);
    } catch (error) { app.report(error.message); return; }
    proxy.matrix.decompose(proxy.position, proxy.quaternion, proxy.scale);
    app.markerHandles?.end();
    edited = wanted;
    gizmo.setMode(mode);
    gizmo.attach(proxy);
    app.clickMode = hit => { if (!gizmo.axis) { end(); app.select(hit && !hit.isFloor ? hit.link : null); } };
    show();
    app.stage.invalidate();
  };
  const end = () => {
    edited = null;
    app.clickMode = null;
    gizmo.detach();
    show();
    app.stage.invalidate();
  };
  const send = () => {
    timer = null;
    const { x, y, z, w } = proxy.quaternion;
    if (edited) app.send('move', { name: edited, position: proxy.position.toArray(), quaternion: [w, x, y, z] });
  };
  gizmo.addEventListener('objectChange', () => { timer ??= setTimeout(send, PERIOD); });
  gizmo.addEventListener('change', () => app.stage.invalidate());
  gizmo.addEventListener('dragging-changed', ({ value }) => {
    app.stage.controls.enabled = !value && app.views.sensor === null;
    if (!value) { clearTimeout(timer); send(); }
  });

  const remove = () => {
    const gone = model();
    end();
    app.send('remove', { name: gone }).then(() => app.select(null));
  };

  addEventListener('keydown', event => { if (event.key === 'Escape' && app.clickMode) aim(false); });
  app.on('select', () => { if (edited !== null && edited !== model()) end(); show(); });
  app.on('scene', scene => {
    box.hidden = !!scene.recording;
    if (box.hidden) return;
    if (app.selected && !app.models.has(model())) app.select(null);
    selectSpawned();
    show();
  });
  app.on('link', isUp => {
    if (!isUp || app.player) return;
    app.ask('spawnable').then(found => {
      sources = found;
      choice.replaceChildren(...Object.keys(found).map(key => element('option', {}, key)));
    }).catch(() => {});
  });
  app.modelEditor = { gizmo, proxy, end, get edited() { return edited; } };
  box.hidden = true;
  show();
  return box;
}
