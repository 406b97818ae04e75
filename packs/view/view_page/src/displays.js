// Displays: drawings of messages (paths, markers, maps, poses) that the server or a recording sends.
import * as T from 'three';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { readPose } from './world.js';

const ROW = 14; // numbers of a shape: position, quaternion (w, x, y, z), size, RGBA
const FONT = 48; // [px] of the texts' pictures
const CAPITAL = 0.72; // height of a capital letter by the font size
const m = new T.Matrix4(), colour = new T.Color(), size = new T.Vector3();

const UNIT = {
  cube: () => new T.BoxGeometry(1, 1, 1),
  sphere: () => new T.SphereGeometry(0.5, 20, 14),
  cylinder: () => new T.CylinderGeometry(0.5, 0.5, 1, 20).rotateX(Math.PI / 2),
  cone: () => new T.ConeGeometry(0.5, 1, 20).rotateX(Math.PI / 2),
};

const seeThrough = alpha => ({ transparent: alpha < 0.995, opacity: alpha, depthWrite: alpha > 0.995 });

export class Displays {
  constructor(app) {
    this.app = app;
    this.topics = [];
    this.shown = new Map(); // topic -> its group, with its problems
    this.wanted = new Set();
    this.unit = Object.fromEntries(Object.entries(UNIT).map(([name, make]) => [name, make()]));
    app.on('packet:displays', packet => { this.topics = packet.topics; app.emit('displays'); });
    app.on('packet:display', packet => this.show(packet));
    app.stage.before.push(() => this.place());
  }

  /** Switches the display of a topic. */
  set(topic, on) {
    if (on) this.wanted.add(topic);
    else this.wanted.delete(topic);
    if (this.app.player) this.app.player.showDisplays(true);
    else this.app.connection.want(`display:${topic}`, on ? {} : null);
    if (!on) this.remove(topic);
    this.app.emit('displays');
  }

  problems(topic) {
    return this.shown.get(topic)?.problems ?? [];
  }

  handles(topic) {
    return this.shown.get(topic)?.handles ?? [];
  }

  show(packet) {
    const topic = packet.kind.slice('display:'.length);
    if (!this.wanted.has(topic)) return;
    this.remove(topic);
    const root = new T.Group();
    const handles = (packet.groups ?? []).flatMap(group => (group.handles ?? []).map(handle => ({ ...handle, topic, body: group.body, offset: group.pose })));
    this.shown.set(topic, { root, handles, problems: packet.error ? [packet.error] : packet.problems });
    (packet.groups ?? []).forEach((group, number) => root.add(this.makeGroup(packet, group, `g${number}`)));
    this.app.stage.helpers.add(root);
    this.app.emit('displays');
    this.app.stage.invalidate();
  }

  remove(topic) {
    const found = this.shown.get(topic);
    if (!found) return;
    this.shown.delete(topic);
    this.app.stage.helpers.remove(found.root);
    const units = new Set(Object.values(this.unit));
    found.root.traverse(object => {
      if (object.geometry && !units.has(object.geometry)) object.geometry.dispose();
      object.material?.map?.dispose();
      object.material?.dispose();
      if (object.isInstancedMesh) object.dispose();
    });
    this.app.stage.invalidate();
  }

  /** Moves what follows a link. */
  place() {
    for (const { root } of this.shown.values()) {
      for (const group of root.children) {
        const body = this.app.world.bodies[group.userData.body];
        if (!body) continue;
        group.matrix.multiplyMatrices(body, group.userData.offset);
        group.matrixWorldNeedsUpdate = true;
      }
    }
  }

  makeGroup(packet, head, prefix) {
    const { arrays } = packet, made = new T.Group();
    made.matrixAutoUpdate = false;
    made.userData = { body: head.body, offset: readPose(head.pose, 0, new T.Matrix4()) };
    for (const shape of Object.keys(UNIT)) {
      const rows = arrays[`${prefix}.${shape}`];
      if (rows) made.add(...this.makeShapes(this.unit[shape], rows));
    }
    for (const [kind, make] of [['lines', makeLines], ['points', makePoints], ['triangles', makeTriangles]]) {
      head[kind].forEach((width, i) => made.add(make(arrays[`${prefix}.${kind}${i}`], arrays[`${prefix}.${kind}${i}.colours`], width)));
    }
    for (const text of head.texts) made.add(makeText(text));
    for (const [number, row] of head.meshes) made.add(makeMesh(arrays[`mesh${number}.corners`], arrays[`mesh${number}.colours`], row));
    head.grids.forEach((grid, i) => made.add(makeGrid(grid, arrays[`${prefix}.grid${i}`])));
    made.traverse(object => { object.frustumCulled = false; });
    return made;
  }

  /** Returns instances of a shape, one object for each transparency. */
  makeShapes(geometry, rows) {
    const groups = new Map();
    for (let at = 0; at < rows.length; at += ROW) {
      const alpha = rows[at + 13].toFixed(2);
      if (!groups.has(alpha)) groups.set(alpha, []);
      groups.get(alpha).push(at);
    }
    return [...groups].map(([alpha, places]) => {
      const mesh = new T.InstancedMesh(geometry, new T.MeshLambertMaterial({ fog: false, ...seeThrough(+alpha) }), places.length);
      places.forEach((at, k) => {
        mesh.setMatrixAt(k, readPose(rows, at, m).scale(size.set(rows[at + 7], rows[at + 8], rows[at + 9])));
        mesh.setColorAt(k, colour.setRGB(rows[at + 10], rows[at + 11], rows[at + 12], T.SRGBColorSpace));
      });
      return mesh;
    });
  }
}

/** Returns linear colours, with `parts` numbers for each; those of packets are bytes of sRGB and alpha. */
function linear(bytes, parts) {
  const out = new Float32Array(bytes.length / 4 * parts);
  for (let i = 0, at = 0; i < bytes.length; i += 4, at += parts) {
    colour.setRGB(bytes[i] / 255, bytes[i + 1] / 255, bytes[i + 2] / 255, T.SRGBColorSpace);
    out[at] = colour.r; out[at + 1] = colour.g; out[at + 2] = colour.b;
    if (parts === 4) out[at + 3] = bytes[i + 3] / 255;
  }
  return out;
}

function makeLines(ends, bytes, width) {
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(ends);
  geometry.setColors(linear(bytes, 3));
  return new LineSegments2(geometry, new LineMaterial({ linewidth: width || 0.01, worldUnits: true, vertexColors: true, fog: false, ...seeThrough(bytes[3] / 255) }));
}

function coloured(corners, bytes) {
  const geometry = new T.BufferGeometry();
  geometry.setAttribute('position', new T.BufferAttribute(corners, 3));
  geometry.setAttribute('color', new T.BufferAttribute(linear(bytes, 4), 4));
  return geometry;
}

function makePoints(points, bytes, width) {
  const material = new T.PointsMaterial({ size: width / Math.tan(22.5 * Math.PI / 180), vertexColors: true, transparent: true, fog: false });
  return new T.Points(coloured(points, bytes), material);
}

function makeTriangles(corners, bytes) {
  let opaque = true;
  for (let i = 3; i < bytes.length; i += 4) opaque &&= bytes[i] > 253;
  const geometry = coloured(corners, bytes);
  geometry.computeVertexNormals();
  return new T.Mesh(geometry, new T.MeshLambertMaterial({ vertexColors: true, side: T.DoubleSide, transparent: !opaque, depthWrite: opaque, fog: false }));
}

function makeMesh(corners, bytes, row) {
  const mesh = makeTriangles(corners, bytes);
  mesh.matrixAutoUpdate = false;
  readPose(row, 0, mesh.matrix).scale(size.set(row[7], row[8], row[9]));
  mesh.material.color.setRGB(row[10], row[11], row[12], T.SRGBColorSpace);
  if (row[13] < 0.995) Object.assign(mesh.material, seeThrough(row[13]));
  return mesh;
}

function makeText([text, x, y, z, height, r, g, b, alpha]) {
  const canvas = document.createElement('canvas'), context = canvas.getContext('2d'), lines = text.split('\n');
  const font = `${FONT}px system-ui, sans-serif`;
  context.font = font;
  canvas.width = Math.min(2048, Math.ceil(Math.max(...lines.map(line => context.measureText(line).width), 1)) + 8);
  canvas.height = Math.min(2048, Math.ceil(1.2 * FONT * lines.length));
  context.font = font;
  context.textBaseline = 'middle';
  context.textAlign = 'center';
  context.fillStyle = `rgb(${255 * r} ${255 * g} ${255 * b})`;
  lines.forEach((line, i) => context.fillText(line, canvas.width / 2, 1.2 * FONT * (i + 0.5)));
  const map = new T.CanvasTexture(canvas);
  map.colorSpace = T.SRGBColorSpace;
  const sprite = new T.Sprite(new T.SpriteMaterial({ map, transparent: true, opacity: alpha, depthWrite: false, fog: false }));
  const unit = height / (CAPITAL * FONT);
  sprite.position.set(x, y, z);
  sprite.scale.set(canvas.width * unit, canvas.height * unit, 1);
  sprite.renderOrder = 6;
  sprite.raycast = () => {};
  return sprite;
}

/** Returns the colours of RViz for the values 0 to 255 of cells. */
export function gridColours(scheme) {
  const table = new Uint8Array(4 * 256);
  for (let v = 0; v < 256; v++) {
    let rgba;
    if (v === 255) rgba = [112, 137, 134, 255]; // unknown
    else if (v > 127) rgba = [255, Math.round(255 * (v - 128) / 126), 0, 255]; // negative values that have no meaning
    else if (v > 100) rgba = [0, 255, 0, 255]; // values above 100
    else if (scheme !== 'costmap') rgba = [0, 1, 2].map(() => 255 - Math.round(255 * v / 100)).concat(255);
    else if (v === 0) rgba = [0, 0, 0, 0];
    else if (v === 100) rgba = [255, 0, 255, 255]; // lethal
    else if (v === 99) rgba = [0, 255, 255, 255]; // inscribed
    else rgba = [Math.round(255 * v / 100), 0, 255 - Math.round(255 * v / 100), 255];
    table.set(rgba, 4 * v);
  }
  return table;
}

function makeGrid({ rows, columns, resolution, colours, pose }, cells) {
  const table = gridColours(colours), rgba = new Uint8Array(4 * rows * columns);
  for (let i = 0; i < cells.length; i++) rgba.set(table.subarray(4 * cells[i], 4 * cells[i] + 4), 4 * i);
  const map = new T.DataTexture(rgba, columns, rows);
  map.colorSpace = T.SRGBColorSpace;
  map.needsUpdate = true;
  const wide = columns * resolution, tall = rows * resolution;
  const geometry = new T.PlaneGeometry(wide, tall).translate(wide / 2, tall / 2, 0);
  const mesh = new T.Mesh(geometry, new T.MeshBasicMaterial({ map, transparent: true, opacity: 0.7, depthWrite: false, side: T.DoubleSide, fog: false, polygonOffset: true, polygonOffsetFactor: -1, polygonOffsetUnits: -2 }));
  mesh.matrixAutoUpdate = false;
  readPose(pose, 0, mesh.matrix);
  mesh.renderOrder = colours === 'costmap' ? 1 : 0;
  return mesh;
}
