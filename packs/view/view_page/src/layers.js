// Layers that help to understand the scene: grid, frames, joint axes, inertias, centres of mass, contacts, paths.
import * as T from 'three';
import { element } from './dom.js';
import { readPose } from './world.js';

const AXES = [0xe5484d, 0x46a758, 0x3e7bfa];
const ROBOT = 0x1f8fff, OTHER = 0xd9822b; // colours of the paths of robots, and of people and other models
const CELLS = 60; // of the grid, along a side; they have 1 m in a world
const GRID_HEIGHT = 0.003; // [m] of the grid above the floor
const FLOOR = 250; // [m] radius of the floor of a robot without a world
const MOST_LABELS = 150;
const shortName = name => name.split('::').at(-1);
const m = new T.Matrix4();

/** Names, titles and initial states of the layers, in the order of the panel. */
export const LAYERS = [
  ['visuals', 'Visuals', true], ['collisions', 'Collisions', false], ['lidar', 'Lidar', true], ['path', 'Path driven', true],
  ['frusta', 'Sensor views', false], ['clouds', 'Point clouds', false], ['contacts', 'Contacts', false], ['frames', 'Frames (TF)', false],
  ['joints', 'Joint axes', false], ['inertia', 'Inertias', false], ['mass', 'Centres of mass', false],
  ['grid', 'Grid', true], ['shadows', 'Shadows', true], ['transparent', 'Transparent', false],
];

/** Ends of the twelve edges of a box of size 1. */
const EDGES = [[0, 1, 2], [1, 2, 0], [2, 0, 1]].flatMap(([along, u, v]) => [[-1, -1], [-1, 1], [1, -1], [1, 1]].map(([a, b]) => {
  const from = [0, 0, 0];
  from[u] = a / 2; from[v] = b / 2;
  return [-0.5, 0.5].map(end => { const point = [...from]; point[along] = end; return point; });
}));

/** Line segments with a colour for each vertex, whose arrays grow as needed. */
class Lines {
  constructor(parent, depthTest = false) {
    this.geometry = new T.BufferGeometry();
    const material = new T.LineBasicMaterial({ vertexColors: true, depthTest, transparent: true, fog: false });
    this.object = new T.LineSegments(this.geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 5;
    parent.add(this.object);
    this.clear();
  }

  clear() { this.points = []; this.colours = []; }

  add(from, to, colour) {
    this.points.push(from.x, from.y, from.z, to.x, to.y, to.z);
    const c = scratchColour.set(colour);
    this.colours.push(c.r, c.g, c.b, c.r, c.g, c.b);
  }

  show() {
    this.geometry.dispose();
    this.geometry.setAttribute('position', new T.Float32BufferAttribute(this.points, 3));
    this.geometry.setAttribute('color', new T.Float32BufferAttribute(this.colours, 3));
  }
}
const scratchColour = new T.Color();

export class Layers {
  constructor(app) {
    this.app = app;
    this.on = Object.fromEntries(LAYERS.map(([name, , on]) => [name, on]));
    const { stage } = app;
    this.frames = new Lines(stage.helpers);
    this.joints = new Lines(stage.helpers);
    this.contactLines = new Lines(stage.helpers);
    this.inertia = new Lines(stage.helpers);
    this.mass = this.instances(new T.SphereGeometry(0.018, 16, 12), 0xffc53d, 0.95);
    this.contactPoints = this.instances(new T.SphereGeometry(0.012, 10, 8), 0xff3b8d, 0.95);
    this.makeGrid();
    this.makeFloor();
    this.labels = document.getElementById('labels');
    this.paths = new Map();
    stage.before.push(() => this.update());
    app.stage.after.push(() => this.placeLabels());
    app.on('packet:contacts', packet => { this.contacts = packet; this.drawContacts(); stage.invalidate(); });
  }

  instances(geometry, color, opacity) {
    const material = new T.MeshBasicMaterial({ color, transparent: true, opacity, depthTest: false, fog: false });
    const mesh = new T.InstancedMesh(geometry, material, 1);
    mesh.frustumCulled = false;
    mesh.renderOrder = 4;
    mesh.count = 0;
    this.app.stage.helpers.add(mesh);
    return { mesh, resize: count => {
      if (count > mesh.instanceMatrix.count) {
        mesh.instanceMatrix = new T.InstancedBufferAttribute(new Float32Array(16 * 2 * count), 16);
      }
      mesh.count = count;
    } };
  }

  makeGrid() {
    const lines = new Lines(this.app.stage.helpers, true), grid = lines.object, half = CELLS / 2, from = new T.Vector3(), to = new T.Vector3();
    for (let line = -half; line <= half; line++) {
      for (let cell = -half; cell < half; cell++) { // cell by cell: software renderers leave out lines that end behind the camera
        lines.add(from.set(line, cell, 0), to.set(line, cell + 1, 0), line ? 0x97a0aa : 0x6a7480);
        lines.add(from.set(cell, line, 0), to.set(cell + 1, line, 0), line ? 0x97a0aa : 0x6a7480);
      }
    }
    lines.show();
    Object.assign(grid.material, { opacity: 0.32, depthWrite: false, fog: true });
    grid.renderOrder = 0;
    grid.position.z = GRID_HEIGHT;
    this.grid = grid;
    const axes = new T.Group();
    AXES.forEach((colour, axis) => {
      const end = [0, 0, 0.004]; end[axis] += 0.5;
      axes.add(new T.Line(new T.BufferGeometry().setFromPoints([new T.Vector3(0, 0, 0.004), new T.Vector3(...end)]), new T.LineBasicMaterial({ color: colour })));
    });
    this.origin = axes;
    this.app.stage.helpers.add(axes);
  }

  /** Makes the floor of a robot without a world; it is only drawn, and holds nothing. */
  makeFloor() {
    const material = new T.MeshLambertMaterial({ color: 0xd5dade, polygonOffset: true, polygonOffsetFactor: 2, polygonOffsetUnits: 2 });
    this.floor = new T.Mesh(new T.CircleGeometry(FLOOR, 48), material);
    this.floor.receiveShadow = true;
    this.floor.visible = false;
    this.level = null;
    this.app.stage.helpers.add(this.floor);
  }

  /** Puts floor and grid where a robot without a world stands. */
  placeFloor() {
    const { world, scene } = this.app, box = scene.bare ? world.boxOf(() => true) : null;
    if (box === null || box.isEmpty() || world.floors.length || world.terrains.length) {
      this.level = null;
      this.grid.scale.setScalar(1);
    } else if (this.level === null) { // not again: a robot that falls leaves its floor
      this.level = box.min.z;
      this.grid.scale.setScalar(10 ** Math.round(Math.log10(box.getSize(new T.Vector3()).length() / 2)));
    }
    this.floor.visible = this.level !== null && this.on.grid;
    world.drawnFloor = this.floor.visible ? this.level : null;
    this.floor.position.z = this.level ?? 0;
    this.grid.position.z = this.floor.position.z + GRID_HEIGHT;
  }

  /** Switches a layer. */
  set(name, on) {
    const { stage, world } = this.app;
    this.on[name] = on;
    if (name === 'visuals') world.visuals.visible = on;
    if (name === 'collisions') { world.collisions.visible = on; world.place(true); }
    if (name === 'grid') { this.grid.visible = this.origin.visible = on; if (this.app.scene) this.placeFloor(); }
    if (name === 'shadows') { stage.shadows = on; stage.makeLights(); }
    if (name === 'transparent') this.setTransparent(on);
    if (name === 'contacts') this.app.connection.want('contacts', on ? {} : null);
    for (const [layer, objects] of [['contacts', [this.contactLines.object, this.contactPoints.mesh]], ['frames', [this.frames.object]],
      ['joints', [this.joints.object]], ['inertia', [this.inertia.object]], ['mass', [this.mass.mesh]]]) {
      for (const object of objects) object.visible = this.on[layer];
    }
    for (const { mesh } of this.paths.values()) mesh.visible = this.on.path;
    this.app.emit('layers');
    stage.invalidate();
  }

  setTransparent(on) {
    for (const { mesh, isVisual, isFloor, geoms } of this.app.world.shapes) {
      if (!isVisual || isFloor) continue;
      const alpha = this.app.world.arrays.geom_rgba[4 * geoms[0] + 3] * (on ? 0.4 : 1);
      for (const material of mesh.userData.materials) Object.assign(material, { transparent: alpha < 0.995, opacity: alpha, depthWrite: alpha > 0.6, needsUpdate: true });
    }
  }

  /** Makes everything anew after the scene has changed. */
  load() {
    for (const name of Object.keys(this.on)) if (['transparent', 'collisions', 'visuals'].includes(name)) this.set(name, this.on[name]);
    this.set('contacts', this.on.contacts);
    this.placeFloor();
  }

  update() {
    const { world, scene } = this.app;
    if (!scene) return;
    world.place();
    const size = Math.min(0.25, Math.max(0.06, 0.03 * this.app.stage.extent));
    if (this.on.frames) this.drawFrames(size);
    if (this.on.joints) this.drawJoints(1.2 * size);
    if (this.on.inertia) this.drawInertias();
    if (this.on.mass) this.drawMasses();
  }

  drawFrames(size) {
    this.frames.clear();
    this.named = [];
    const origin = new T.Vector3(), end = new T.Vector3(), local = new T.Matrix4();
    for (const [name, body, offset] of this.app.scene.frames) {
      if (!this.app.world.isMoving[body] && this.app.models.get(name.split('::', 1)[0])?.static) continue;
      m.multiplyMatrices(this.app.world.bodies[body], readPose(offset, 0, local));
      origin.setFromMatrixPosition(m);
      this.named.push([name, origin.clone()]);
      AXES.forEach((colour, axis) => this.frames.add(origin, end.setFromMatrixColumn(m, axis).normalize().multiplyScalar(size).add(origin), colour));
    }
    this.frames.show();
  }

  /** Writes the names of the frames beside them: the nearest first, and none over another. */
  placeLabels() {
    const { stage: { camera, canvas } } = this.app, shown = [], eye = camera.position;
    const named = this.on.frames && this.app.scene ? this.named : [];
    const counts = new Map();
    for (const [name] of named) counts.set(shortName(name), (counts.get(shortName(name)) ?? 0) + 1);
    for (const [name, origin] of [...named].sort((p, q) => p[1].distanceTo(eye) - q[1].distanceTo(eye))) {
      const text = counts.get(shortName(name)) > 1 ? name : shortName(name), point = origin.clone().project(camera);
      if (Math.abs(point.x) > 1 || Math.abs(point.y) > 1 || Math.abs(point.z) > 1) continue;
      const x = (point.x + 1) / 2 * canvas.clientWidth + 5, y = (1 - point.y) / 2 * canvas.clientHeight, width = 6.2 * text.length;
      if (shown.some(other => Math.abs(other.y - y) < 13 && x < other.x + other.width && other.x < x + width)) continue;
      shown.push({ text, name, x, y, width });
      if (shown.length === MOST_LABELS) break;
    }
    while (this.labels.childElementCount > shown.length) this.labels.lastChild.remove();
    while (this.labels.childElementCount < shown.length) this.labels.append(element('span', { class: 'frame' }));
    shown.forEach(({ text, name, x, y }, i) => {
      const label = this.labels.children[i];
      if (label.textContent !== text) label.textContent = text;
      label.dataset.frame = name;
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translateY(-50%)`;
    });
  }

  drawJoints(size) {
    this.joints.clear();
    for (const joint of this.app.scene.joints) {
      for (const [body, place, axis] of joint.axes) {
        const origin = new T.Vector3(...place).applyMatrix4(this.app.world.bodies[body]);
        const direction = new T.Vector3(...axis).transformDirection(this.app.world.bodies[body]);
        this.joints.add(origin.clone().addScaledVector(direction, -size), origin.clone().addScaledVector(direction, size), joint.type === 'prismatic' ? 0x12a594 : 0xf5a524);
      }
    }
    this.joints.show();
  }

  massiveBodies() {
    const { arrays } = this.app.scene;
    return [...this.app.scene.arrays.moving].filter(body => arrays.body_mass[body] > 1e-6);
  }

  drawInertias() {
    const { arrays } = this.app.scene;
    const local = new T.Matrix4(), size = new T.Vector3(), from = new T.Vector3(), to = new T.Vector3();
    this.inertia.clear();
    for (const body of this.massiveBodies()) { // the edges of a box with the same inertia
      const mass = arrays.body_mass[body], [x, y, z] = arrays.body_inertia.subarray(3 * body, 3 * body + 3);
      const edge = value => Math.sqrt(Math.max(6 * value / mass, 1e-8));
      readPose([...arrays.body_ipos.subarray(3 * body, 3 * body + 3), ...arrays.body_iquat.subarray(4 * body, 4 * body + 4)], 0, local);
      local.scale(size.set(edge(y + z - x), edge(x + z - y), edge(x + y - z)));
      m.multiplyMatrices(this.app.world.bodies[body], local);
      for (const [a, b] of EDGES) this.inertia.add(from.fromArray(a).applyMatrix4(m), to.fromArray(b).applyMatrix4(m), 0xb45bd6);
    }
    this.inertia.show();
  }

  drawMasses() {
    const { arrays } = this.app.scene, bodies = this.massiveBodies(), { mesh, resize } = this.mass;
    resize(bodies.length);
    const place = new T.Vector3();
    const most = Math.max(...bodies.map(body => arrays.body_mass[body]), 1e-6);
    bodies.forEach((body, k) => {
      place.fromArray(arrays.body_ipos, 3 * body).applyMatrix4(this.app.world.bodies[body]);
      const scale = 0.5 + 1.5 * Math.cbrt(arrays.body_mass[body] / most);
      mesh.setMatrixAt(k, m.makeScale(scale, scale, scale).setPosition(place));
    });
    mesh.instanceMatrix.needsUpdate = true;
  }

  drawContacts() {
    const { position, force } = this.contacts.arrays, count = position.length / 3, { mesh, resize } = this.contactPoints;
    resize(count);
    this.contactLines.clear();
    const from = new T.Vector3(), to = new T.Vector3(), vector = new T.Vector3();
    for (let k = 0; k < count; k++) {
      from.fromArray(position, 3 * k);
      mesh.setMatrixAt(k, m.makeTranslation(from));
      vector.fromArray(force, 3 * k);
      const newtons = vector.length();
      if (newtons > 1e-4) { // 0.1 m for 1 N, 0.4 m for 100 N
        to.copy(from).addScaledVector(vector, 0.1 * Math.log10(10 * (1 + newtons)) / newtons);
        this.contactLines.add(from, to, 0xff3b8d);
      }
    }
    mesh.instanceMatrix.needsUpdate = true;
    this.contactLines.show();
  }

  // -------------------------------------------------------------- paths

  /** Replaces the driven paths: model -> list of points. */
  setPaths(found) {
    for (const { mesh } of this.paths.values()) { this.app.stage.helpers.remove(mesh); mesh.geometry.dispose(); }
    this.paths.clear();
    for (const [name, points] of Object.entries(found)) this.pathOf(name).points = points;
    for (const name of this.paths.keys()) this.drawPath(name);
  }

  pathOf(name) {
    if (!this.paths.has(name)) {
      const mesh = new T.Mesh(new T.BufferGeometry(), new T.MeshBasicMaterial({ color: this.app.isRobot(name) ? ROBOT : OTHER, side: T.DoubleSide, polygonOffset: true, polygonOffsetFactor: -2, polygonOffsetUnits: -2 }));
      mesh.frustumCulled = false;
      mesh.visible = this.on.path;
      this.app.stage.helpers.add(mesh);
      this.paths.set(name, { points: [], mesh });
    }
    return this.paths.get(name);
  }

  /** Adds the present positions of moving models to their paths. */
  extendPaths(bodyOf) {
    for (const [name, body] of bodyOf) {
      const path = this.pathOf(name), { points } = path, last = points.at(-1);
      const [x, y, z] = this.app.world.bodies[body].elements.slice(12, 15);
      if (last && Math.hypot(x - last[0], y - last[1], z - last[2]) < 0.015) continue;
      points.push([x, y, z]);
      if (points.length > 8000) path.points = points.filter((_, i) => i % 2 === 0);
      if (this.on.path && points.length > 1) this.drawPath(name);
    }
  }

  /** Draws a path as a ribbon on the ground below it. */
  drawPath(name) {
    const { points, mesh } = this.paths.get(name), count = points.length;
    if (count < 2) return;
    const width = Math.min(0.03, Math.max(0.008, 0.0022 * this.app.stage.extent));
    const base = points[0][2] < 0.6 ? 0.012 - points[0][2] : 0; // a ground robot's path lies on the ground
    const corners = new Float32Array(6 * count), index = new Uint32Array(6 * (count - 1));
    for (let i = 0; i < count; i++) {
      const a = points[Math.max(0, i - 1)], b = points[Math.min(count - 1, i + 1)];
      const dx = b[0] - a[0], dy = b[1] - a[1], length = Math.hypot(dx, dy) || 1, [x, y, z] = points[i];
      const sx = -dy / length * width, sy = dx / length * width;
      corners.set([x + sx, y + sy, z + base, x - sx, y - sy, z + base], 6 * i);
      if (i < count - 1) index.set([2 * i, 2 * i + 1, 2 * i + 2, 2 * i + 1, 2 * i + 3, 2 * i + 2], 6 * i);
    }
    mesh.geometry.dispose();
    mesh.geometry = new T.BufferGeometry();
    mesh.geometry.setAttribute('position', new T.BufferAttribute(corners, 3));
    mesh.geometry.setIndex(new T.BufferAttribute(index, 1));
  }
}
