// Player of a recording: it makes the packets that a running simulation would send.
import * as T from 'three';
import { element } from './dom.js';
import { readPacket } from './packet.js';
import { readPose } from './world.js';

const STEP = 0.005; // [s]: the first scan of a world comes one step after its start

export class Player {
  constructor(app, recording) {
    this.app = app;
    this.recording = recording;
    const { times } = recording.arrays;
    this.times = times;
    this.length = times[times.length - 1];
    this.size = recording.arrays.poses.length / times.length;
    this.time = 0;
    this.pace = 1;
    this.isPlaying = false;
    this.bar = element('input', { type: 'range', id: 'seek', min: 0, max: this.length, step: 0.01, value: 0, 'aria-label': 'Time', oninput: () => this.seek(+this.bar.value) });
    document.getElementById('view').append(this.bar);
  }

  /** Answers the requests that a recording can answer. */
  async ask(name, { value, count } = {}) {
    if (name === 'pause') this.setPlaying(!value);
    else if (name === 'step') { this.setPlaying(false); this.seek(this.time + count / 15); }
    else if (name === 'reset') this.seek(0);
    else if (name === 'pace') { this.pace = value ?? 5; this.show(); }
    else if (name === 'travel') return this.paths(this.time);
    else throw new Error('a recording cannot do this');
    return null;
  }

  setPlaying(isPlaying) {
    this.isPlaying = isPlaying && this.length > 0;
    if (this.isPlaying && this.time >= this.length) this.time = 0;
    this.last = performance.now();
    if (this.isPlaying) requestAnimationFrame(() => this.advance());
    this.show();
  }

  advance() {
    if (!this.isPlaying) return;
    const now = performance.now();
    this.time += this.pace * Math.min(now - this.last, 250) / 1000;
    this.last = now;
    if (this.time >= this.length) { this.time = this.length; this.isPlaying = false; }
    this.show();
    if (this.isPlaying) requestAnimationFrame(() => this.advance());
  }

  seek(time) {
    this.time = Math.min(Math.max(time, 0), this.length);
    this.show();
    this.app.layers.setPaths(this.paths(this.time));
    this.app.stage.invalidate();
  }

  /** Announces the state and the scans of the present time. */
  show() {
    const { times, size, recording } = this, n = times.length;
    const at = Math.min(this.time * (n - 1) / (this.length || 1), n - 1), i = Math.floor(at), k = Math.min(i + 1, n - 1);
    const a = recording.arrays.poses.subarray(i * size, i * size + size), b = recording.arrays.poses.subarray(k * size, k * size + size);
    const poses = new Float32Array(size), f = at - i;
    for (let j = 0; j < size; j += 7) {
      const sign = a[j + 3] * b[j + 3] + a[j + 4] * b[j + 4] + a[j + 5] * b[j + 5] + a[j + 6] * b[j + 6] < 0 ? -1 : 1;
      for (let c = 0; c < 3; c++) poses[j + c] = a[j + c] + f * (b[j + c] - a[j + c]);
      for (let c = 3; c < 7; c++) poses[j + c] = a[j + c] + f * (sign * b[j + c] - a[j + c]);
    }
    this.bar.value = this.time;
    const time = recording.begin + this.time;
    this.app.receive({ kind: 'state', revision: this.app.scene.revision, time, tick: Math.round(1000 * this.time), paused: !this.isPlaying, pace: this.pace, rtf: this.pace, contacts: 0, arrays: { poses } });
    this.showScans();
    this.showDisplays();
  }

  /** Returns topic and type of each display. */
  displayTopics() {
    return (this.recording.displays ?? []).map(({ topic, type }) => [topic, type]);
  }

  /** Announces the drawings of the wanted topics at the present time: those that changed, or all. */
  showDisplays(all = false) {
    this.drawn ??= new Map();
    (this.recording.displays ?? []).forEach(({ topic, times, ends }, number) => {
      if (!this.app.displays.wanted.has(topic)) { this.drawn.delete(topic); return; }
      const i = times.findLastIndex(time => time <= this.time + 1e-6);
      if (!all && this.drawn.get(topic) === i) return;
      this.drawn.set(topic, i);
      const data = this.recording.arrays[`display${number}`];
      const packet = i < 0 ? { kind: `display:${topic}`, problems: [], groups: [], arrays: {} } : readPacket(data.slice(i ? ends[i - 1] : 0, ends[i]).buffer);
      this.app.receive(packet);
    });
  }

  showScans() {
    const m = new T.Matrix4(), point = new T.Vector3(), lidars = [], points = [], origins = [];
    this.recording.lidars.forEach((lidar, number) => {
      const { [`lidar${number}.times`]: times, [`lidar${number}.poses`]: poses, [`lidar${number}.ranges`]: ranges } = this.recording.arrays;
      let i = times.findLastIndex(time => time <= this.time + STEP);
      if (i < 0) return;
      readPose(poses, 7 * i, m);
      origins.push(poses[7 * i], poses[7 * i + 1], poses[7 * i + 2]);
      for (let ray = 0; ray < lidar.count; ray++) {
        const range = ranges[i * lidar.count + ray] / 1000, angle = lidar.low + ray * lidar.step;
        if (range > 0) points.push(...point.set(range * Math.cos(angle), range * Math.sin(angle), 0).applyMatrix4(m));
        else points.push(NaN, NaN, NaN);
      }
      lidars.push([lidar.topic, lidar.count]);
    });
    this.app.receive({ kind: 'lidar', lidars, arrays: { points: Float32Array.from(points), origins: Float32Array.from(origins) } });
  }

  /** Returns the paths of the moving models up to a time. */
  paths(end) {
    const found = {}, moving = [...this.app.scene.arrays.moving];
    for (const [name, body] of this.app.bodyOf) {
      const place = 7 * moving.indexOf(body), path = [];
      for (let i = 0; i < this.times.length && this.times[i] <= end; i++) {
        const at = i * this.size + place, p = [...this.recording.arrays.poses.subarray(at, at + 3)], last = path.at(-1);
        if (!last || Math.hypot(p[0] - last[0], p[1] - last[1], p[2] - last[2]) > 0.015) path.push(p);
      }
      found[name] = path;
    }
    return found;
  }
}

/** Returns the recording of a scene: of this file, or of the server. */
export async function loadRecording(connection) {
  if (window.simkitFile) return readPacket(window.simkitFile.recording);
  return readPacket(await (await connection.fetch('recording')).arrayBuffer());
}
