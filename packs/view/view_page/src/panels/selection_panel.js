// Pose of the selected link or model, and its outline in the scene.
import * as T from 'three';
import { element, fixed, panel } from '../dom.js';
import { isWithin } from '../views.js';

export function makeSelectionPanel(app) {
  const text = element('div', { class: 'selection' }), follow = element('button', { onclick: () => app.views.follow(body) }, 'Follow');
  const box = panel('selection', 'Selected', text, follow);
  const outline = new T.Box3Helper(new T.Box3(), 0xffd23e);
  Object.assign(outline.material, { depthTest: false, transparent: true, fog: false }); // drawn after everything that would cover it
  outline.renderOrder = 6;
  outline.visible = false;
  app.stage.helpers.add(outline);
  let body = null;

  const show = () => {
    box.hidden = app.selected === null;
    outline.visible = app.selected !== null;
    if (app.selected === null) return;
    const frame = app.scene.frames.find(([name]) => isWithin(name, app.selected)); // of a model, its first link
    body = frame ? frame[1] : app.scene.bodies.indexOf(app.selected);
    follow.hidden = !(body > 0);
    const lines = [app.selected];
    if (frame && frame[0] !== app.selected) lines.push(`pose of ${frame[0].slice(app.selected.length + 2)}`);
    if (body > 0) {
      const pose = app.world.bodies[body], place = new T.Vector3().setFromMatrixPosition(pose);
      const turn = new T.Euler().setFromRotationMatrix(pose, 'ZYX'), degrees = value => fixed(value * 180 / Math.PI, 1);
      lines.push(`x ${fixed(place.x, 3)}  y ${fixed(place.y, 3)}  z ${fixed(place.z, 3)} m`);
      lines.push(`roll ${degrees(turn.x)}  pitch ${degrees(turn.y)}  yaw ${degrees(turn.z)}°`);
    } else lines.push('static');
    text.replaceChildren(...lines.map(line => element('div', {}, line)));
  };
  app.on('select', show);
  app.on('state', () => { if (app.selected !== null) show(); });
  app.stage.before.push(() => {
    if (app.selected !== null) outline.box.copy(app.world.boxOf(geom => isWithin(app.world.linkOf(geom), app.selected)));
  });
  box.hidden = true;
  return box;
}
