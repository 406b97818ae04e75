// Pictures of cameras: drawn by the browser from the sensor's pose, or the sensor's own, which costs the run time.
import * as T from 'three';
import { checkbox, element, panel } from '../dom.js';
import { isCamera } from '../sensors.js';

const WIDTH = 290;
const POINT_HEAD = 'control_msgs/action/PointHead';

export function makeCameraPanel(app) {
  const choice = element('select', { id: 'camera', title: 'Camera', onchange: () => change() });
  const canvas = element('canvas', { id: 'picture', width: WIDTH, height: 180, onclick: event => look(event) }), context = canvas.getContext('2d');
  const note = element('div', { class: 'dim' });
  const own = checkbox('own-picture', 'as the sensor sees it', false, () => change());
  const box = panel('camera-panel', 'Camera', choice, canvas, note, own);
  const camera = new T.PerspectiveCamera(60, 1.6, 0.02, 300);
  let target = null, pixels = null, cameras = [], drawnAt = -1e4, stream = null, late = null;

  // ---- a click turns the head with the camera
  let hasHead = false;
  const findHead = () => app.ask('interfaces').then(({ actions }) => {
    hasHead = Object.values(actions).includes(POINT_HEAD);
    canvas.style.cursor = hasHead ? 'crosshair' : '';
    canvas.title = hasHead ? 'Click: the head looks there' : '';
  }).catch(() => {});
  const look = event => {
    if (!hasHead || !sensor()) return;
    const area = canvas.getBoundingClientRect();
    app.ask('look', { camera: sensor().name, x: (event.clientX - area.left) / area.width, y: (event.clientY - area.top) / area.height })
      .then(({ action }) => { note.textContent = action; }).catch(error => app.report(error.message));
  };

  const sensor = () => cameras[choice.selectedIndex];
  const isOwn = () => !own.hidden && own.querySelector('input').checked;
  const change = () => {
    if (stream) app.connection.want(stream, null);
    stream = null;
    if (!sensor()) return;
    canvas.height = Math.round(WIDTH * Math.min(1.2, sensor().camera.height / sensor().camera.width));
    target?.dispose();
    target = new T.WebGLRenderTarget(canvas.width, canvas.height, { colorSpace: T.SRGBColorSpace, samples: app.stage.isSoftware ? 0 : 4 });
    pixels = new Uint8Array(4 * canvas.width * canvas.height);
    note.textContent = isOwn() ? sensor().topic : 'drawn by the browser';
    if (isOwn() && box.open) app.connection.want(stream = `image:${sensor().name}`, {});
    drawnAt = -1e4;
    app.stage.invalidate();
  };
  const draw = () => {
    const now = performance.now();
    if (!sensor() || isOwn() || !box.open || box.hidden) return;
    const wait = drawnAt + (app.stage.isSoftware ? 700 : 80) - now;
    if (wait > 0) { // the last picture must be that of the last state
      late ??= setTimeout(() => { late = null; draw(); }, wait);
      return;
    }
    drawnAt = now;
    const { stage } = app, { gl, scene, helpers, sky } = stage;
    app.views.aim(camera, sensor(), canvas.width / canvas.height);
    camera.near = Math.max(0.01, sensor().camera.near || 0.02);
    camera.updateProjectionMatrix();
    helpers.visible = false; // sensors do not see drawings
    sky.position.copy(camera.position);
    gl.setRenderTarget(target);
    gl.render(scene, camera);
    gl.readRenderTargetPixels(target, 0, 0, canvas.width, canvas.height, pixels);
    gl.setRenderTarget(null);
    helpers.visible = true;
    const image = context.createImageData(canvas.width, canvas.height), row = 4 * canvas.width;
    for (let y = 0; y < canvas.height; y++) image.data.set(pixels.subarray((canvas.height - 1 - y) * row, (canvas.height - y) * row), y * row);
    for (let i = 3; i < image.data.length; i += 4) image.data[i] = 255;
    context.putImageData(image, 0, 0);
  };
  app.on('packet:image', async packet => {
    if (packet.kind !== stream) return;
    note.textContent = packet.error ?? sensor().topic;
    if (packet.error) { context.clearRect(0, 0, canvas.width, canvas.height); return; }
    const image = await createImageBitmap(new Blob([packet.arrays.jpeg], { type: 'image/jpeg' }));
    context.drawImage(image, 0, 0, canvas.width, canvas.height);
  });
  app.on('scene', scene => {
    const before = sensor()?.name;
    cameras = scene.sensors.filter(isCamera);
    box.hidden = cameras.length === 0;
    choice.hidden = cameras.length < 2;
    own.hidden = !!scene.recording; // a recording has no sensor that could be asked
    choice.replaceChildren(...cameras.map(found => element('option', {}, found.name)));
    choice.selectedIndex = Math.max(0, cameras.findIndex(found => found.name === before));
    if (!scene.recording) findHead();
    change();
  });
  app.on('link', isUp => { if (isUp && !app.player) findHead(); });
  box.addEventListener('toggle', change);
  app.stage.after.push(draw);
  box.hidden = true;
  return box;
}
