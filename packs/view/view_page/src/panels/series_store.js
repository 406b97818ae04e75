// Numbers over time for plots: fields of topics, and true values of models. Only what a shown plot needs is asked for.
import * as T from 'three';
import { readPacket } from '../packet.js';
import { readPose } from '../world.js';

export const TRUTH = 'truth';
const MOST = 20000; // samples of a curve; the oldest are dropped

/** Returns the key of a curve. */
const keyOf = (topic, path) => `${topic} ${path}`;

/** Returns true if a curve belongs to a field: `position` has the curves `position.x`, `position.y` and `position.z`. */
const belongs = (path, field) => path === field || path.startsWith(`${field}.`) || path.startsWith(`${field}[`);

/** Returns the packets of a one-file page by topic, and `topics` and `log`; null for a page with a server. */
export function filePackets() {
  if (!window.simkitFile) return null;
  const { series } = window.simkitFile;
  return new Map(Object.entries(series?.byteLength ? readPacket(series).arrays : {}).map(([name, bytes]) => [name, readPacket(bytes.slice().buffer)]));
}

export class SeriesStore {
  constructor(app) {
    this.app = app;
    this.curves = new Map();
    this.fields = new Map(); // topic -> field -> number of plots
    this.places = new Map(); // stream -> source and number of the next sample
    this.errors = new Map();
    this.listeners = [];
    this.isShown = false;
    app.on('packet:series', packet => this.take(packet, packet.kind.slice('series:'.length)));
    app.on('packet:truth', packet => this.take(packet, TRUTH));
    app.on('recording', () => this.want());
    this.file = filePackets();
  }

  /** Asks for a field of a topic, or ends this. */
  use(topic, field, isUsed) {
    const fields = this.fields.get(topic) ?? new Map();
    this.fields.set(topic, fields);
    const count = (fields.get(field) ?? 0) + (isUsed ? 1 : -1);
    if (count > 0) fields.set(field, count); else fields.delete(field);
    if (!isUsed) for (const [key, curve] of this.curves) {
      if (curve.topic === topic && ![...fields.keys()].some(one => belongs(curve.path, one))) this.curves.delete(key);
    }
    this.want(topic);
  }

  show(isShown) {
    this.isShown = isShown;
    this.want();
  }

  want(only = null) {
    for (const [topic, fields] of this.fields) {
      if (only !== null && topic !== only) continue;
      const names = [...fields.keys()];
      if (topic === TRUTH && this.app.player) { this.takeTruth(names); continue; }
      if (this.file) { this.takeFile(topic, names); continue; }
      this.app.connection.want(topic === TRUTH ? TRUTH : `series:${topic}`, this.isShown && names.length ? { fields: names } : null);
    }
  }

  /** Returns the curves of a field that have come. */
  of(topic, field) {
    return [...this.curves.values()].filter(curve => curve.topic === topic && belongs(curve.path, field));
  }

  clear(topic, field) {
    for (const curve of this.of(topic, field)) curve.t = [], curve.s = [], curve.v = [];
  }

  announce() { for (const call of this.listeners) call(); }

  take(packet, topic) {
    const errors = packet.error ? Object.fromEntries([...(this.fields.get(topic)?.keys() ?? [])].map(field => [field, packet.error])) : packet.errors ?? {};
    for (const [field, text] of Object.entries(errors)) this.errors.set(keyOf(topic, field), text);
    const { times, stamps, values } = packet.arrays, count = packet.curves?.length ?? 0;
    const place = this.places.get(topic), first = packet.first ?? 0;
    const from = !packet.recorded && place?.source === packet.source ? Math.max(0, place.next - first) : 0;
    if (!packet.recorded) this.places.set(topic, { source: packet.source, next: first + (times?.length ?? 0) });
    for (let k = 0; k < count; k++) {
      const curve = this.curve(topic, packet.curves[k]);
      if (!curve) continue;
      if (packet.recorded) curve.t = [], curve.s = [], curve.v = [];
      for (let i = from; i < times.length; i++) this.push(curve, packet.begin + times[i], packet.begin + stamps[i], packet.curves[k].base + values[i * count + k]);
    }
    this.announce();
  }

  curve(topic, { path, unit, is_angle: isAngle }) {
    const fields = [...(this.fields.get(topic)?.keys() ?? [])];
    if (!fields.some(field => belongs(path, field))) return null;
    const key = keyOf(topic, path), label = topic === TRUTH ? `${path} (truth)` : `${topic}${path.startsWith('[') ? '' : '.'}${path}`;
    if (!this.curves.has(key)) this.curves.set(key, { key, topic, path, label, unit, isAngle, t: [], s: [], v: [] });
    return this.curves.get(key);
  }

  push(curve, time, stamp, value) {
    const { t, s, v } = curve;
    if (t.length && time < t[t.length - 1] - 1e-9) t.length = s.length = v.length = 0; // after a reset
    t.push(time); s.push(stamp); v.push(value);
    if (t.length > MOST) for (const values of [t, s, v]) values.splice(0, MOST / 10);
  }

  // ---- recordings

  takeFile(topic, fields) {
    const packet = this.file.get(topic) ?? { curves: [], arrays: {} };
    this.take(packet, topic);
    for (const field of fields) {
      if (!packet.curves.some(curve => belongs(curve.path, field))) this.errors.set(keyOf(topic, field), 'this file does not contain the field');
    }
  }

  /** Computes true values from the poses of a recording; velocities are differences of poses. */
  takeTruth(fields) {
    const { recording, times, size } = this.app.player, moving = [...this.app.scene.arrays.moving];
    for (const field of fields) {
      const dot = field.lastIndexOf('.'), name = field.slice(0, dot), value = field.slice(dot + 1), body = this.app.bodyOf.get(name);
      const make = READERS[value];
      if (body === undefined || !make) { this.errors.set(keyOf(TRUTH, field), `there is no ${field}`); continue; }
      const curve = this.curve(TRUTH, { path: field, unit: make.unit, is_angle: make.isAngle });
      if (!curve || curve.t.length) continue;
      const at = 7 * moving.indexOf(body), pose = i => readTruth(recording.arrays.poses, i * size + at);
      for (let i = 0; i < times.length; i++) {
        const a = Math.max(i - 1, 0), b = Math.min(i + 1, times.length - 1);
        this.push(curve, recording.begin + times[i], NaN, make(pose(i), pose(a), pose(b), times[b] - times[a] || 1));
      }
    }
    this.announce();
  }
}

const m = new T.Matrix4(), euler = new T.Euler();
function readTruth(poses, at) {
  readPose(poses, at, m);
  euler.setFromRotationMatrix(m, 'ZYX');
  return { x: poses[at], y: poses[at + 1], z: poses[at + 2], roll: euler.x, pitch: euler.y, yaw: euler.z };
}

const reader = (unit, make, isAngle = false) => Object.assign(make, { unit, isAngle });
const speed = axis => (p, a, b, dt) => (b[axis] - a[axis]) / dt;
const along = (p, a, b, dt, angle) => (Math.cos(angle) * (b.x - a.x) + Math.sin(angle) * (b.y - a.y)) / dt;
export const READERS = {
  x: reader('m', p => p.x), y: reader('m', p => p.y), z: reader('m', p => p.z),
  roll: reader('rad', p => p.roll, true), pitch: reader('rad', p => p.pitch), yaw: reader('rad', p => p.yaw, true),
  vx: reader('m/s', speed('x')), vy: reader('m/s', speed('y')), vz: reader('m/s', speed('z')),
  forward: reader('m/s', (p, a, b, dt) => along(p, a, b, dt, p.yaw)), left: reader('m/s', (p, a, b, dt) => along(p, a, b, dt, p.yaw + Math.PI / 2)),
  yaw_rate: reader('rad/s', (p, a, b, dt) => Math.atan2(Math.sin(b.yaw - a.yaw), Math.cos(b.yaw - a.yaw)) / dt),
};
