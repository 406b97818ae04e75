// Sensors in the scene: fans and points of lidars, cones of sonars, point clouds, and the views of cameras.
import * as T from 'three';
import { readPose } from './world.js';

const MOST_CLOUDS = 4;
const MOST_FANS = 8; // scans that are drawn at once; with more lidars, those of the selected robot
const CAMERAS = /camera|depth|rgbd/;
const m = new T.Matrix4(), local = new T.Matrix4();

function dynamic(material, Kind = T.Mesh) {
  const object = new Kind(new T.BufferGeometry(), material);
  object.frustumCulled = false;
  return object;
}

export const isCamera = sensor => CAMERAS.test(sensor.kind) && !!sensor.camera;

export class Sensors {
  constructor(app) {
    this.app = app;
    const { helpers } = app.stage;
    this.points = dynamic(new T.PointsMaterial({ color: 0xff2d1f, size: 3, sizeAttenuation: false, fog: false }), T.Points);
    this.fan = dynamic(new T.MeshBasicMaterial({ color: 0x3a7bff, transparent: true, opacity: 0.16, side: T.DoubleSide, depthWrite: false, fog: false }));
    this.frusta = dynamic(new T.LineBasicMaterial({ color: 0xf5a524, transparent: true, opacity: 0.9, fog: false }), T.LineSegments);
    this.cones = dynamic(new T.MeshBasicMaterial({ color: 0x12a594, transparent: true, opacity: 0.3, side: T.DoubleSide, depthWrite: false, fog: false }));
    this.fan.renderOrder = this.cones.renderOrder = 2;
    this.points.renderOrder = 3;
    helpers.add(this.points, this.fan, this.frusta, this.cones);
    this.clouds = new Map();
    this.ranges = {};
    app.on('packet:lidar', packet => this.drawLidars(packet));
    app.on('packet:ranges', packet => { this.ranges = packet.ranges; app.stage.invalidate(); });
    app.on('packet:cloud', packet => this.drawCloud(packet));
    app.on('layers', () => this.want());
    app.on('select', () => this.want());
    app.on('scene', () => this.load());
    app.stage.before.push(() => this.update());
  }

  load() {
    const { sensors } = this.app.scene;
    this.lidars = sensors.filter(sensor => sensor.lidar);
    this.sonars = sensors.filter(sensor => sensor.sonar);
    this.cameras = sensors.filter(isCamera);
    this.want();
  }

  /** Asks for the streams of the shown layers. */
  want() {
    if (!this.lidars) return;
    const { layers, connection, selected, robots } = this.app;
    let shown = this.lidars;
    if (shown.length > MOST_FANS) {
      const robot = (selected ?? robots[0]?.name ?? '').split('::', 1)[0];
      shown = shown.filter(sensor => sensor.name.startsWith(`${robot}::`)).slice(0, MOST_FANS);
    }
    this.fan.visible = this.points.visible = layers.on.lidar;
    this.cones.visible = layers.on.frusta || layers.on.lidar;
    this.frusta.visible = layers.on.frusta;
    connection.want('lidar', layers.on.lidar && shown.length ? shown.map(sensor => sensor.name) : null);
    connection.want('ranges', this.cones.visible && this.sonars.length ? this.sonars.map(sensor => sensor.name) : null);
    const topics = layers.on.clouds ? this.app.scene.clouds.slice(0, MOST_CLOUDS) : [];
    for (const topic of topics) connection.want(`cloud:${topic}`, {});
    for (const [topic, object] of this.clouds) {
      if (!topics.includes(topic)) { this.app.stage.helpers.remove(object); this.clouds.delete(topic); }
    }
    for (const stream of Object.keys(connection.wants)) {
      if (stream.startsWith('cloud:') && !topics.includes(stream.slice(6))) connection.want(stream, null);
    }
  }

  drawLidars({ lidars, arrays: { points, origins } }) {
    const hits = [], corners = [], index = [];
    let begin = 0;
    lidars.forEach(([name, count], which) => {
      const sensor = this.lidars?.find(found => found.name === name)?.lidar;
      const isFlat = !sensor || sensor.v_samples === 1; // a recording has scans by topic
      const origin = corners.length / 3;
      if (isFlat) corners.push(...origins.slice(3 * which, 3 * which + 3));
      let last = -2;
      for (let i = begin; i < begin + count; i++) {
        const x = points[3 * i], y = points[3 * i + 1], z = points[3 * i + 2];
        if (Number.isNaN(x)) continue;
        hits.push(x, y, z);
        if (!isFlat) continue;
        corners.push(x, y, z);
        if (last === i - 1) index.push(origin, corners.length / 3 - 2, corners.length / 3 - 1);
        last = i;
      }
      begin += count;
    });
    for (const [object, values] of [[this.points, hits], [this.fan, corners]]) {
      object.geometry.dispose();
      object.geometry = new T.BufferGeometry();
      object.geometry.setAttribute('position', new T.Float32BufferAttribute(values, 3));
    }
    this.fan.geometry.setIndex(index);
    this.app.stage.invalidate();
  }

  drawCloud({ kind, error, arrays: { points, colours } }) {
    if (error) {
      this.app.report(`${kind.slice(6)}: ${error}`);
      return;
    }
    const topic = kind.slice(6);
    if (!this.clouds.has(topic)) {
      const object = dynamic(new T.PointsMaterial({ size: 2.5, sizeAttenuation: false, vertexColors: true, fog: false }), T.Points);
      this.app.stage.helpers.add(object);
      this.clouds.set(topic, object);
    }
    const object = this.clouds.get(topic), rgb = new Float32Array(points.length), colour = new T.Color();
    for (let i = 0; i < points.length; i += 3) {
      if (colours) colour.setRGB(colours[i] / 255, colours[i + 1] / 255, colours[i + 2] / 255, T.SRGBColorSpace);
      else colour.setHSL(0.66 - 0.66 * Math.min(Math.max(points[i + 2] / 2, 0), 1), 0.9, 0.5); // by height
      rgb.set([colour.r, colour.g, colour.b], i);
    }
    object.geometry.dispose();
    object.geometry = new T.BufferGeometry();
    object.geometry.setAttribute('position', new T.BufferAttribute(points.slice(), 3));
    object.geometry.setAttribute('color', new T.BufferAttribute(rgb, 3));
    this.app.stage.invalidate();
  }

  /** Returns the pose of a sensor in the world. */
  poseOf(sensor, out = new T.Matrix4()) {
    return out.multiplyMatrices(this.app.world.bodies[sensor.body], readPose(sensor.pose, 0, local));
  }

  update() {
    if (!this.app.scene || !this.lidars) return;
    if (this.frusta.visible) this.drawFrusta();
    if (this.cones.visible && this.sonars.length) this.drawCones();
  }

  drawFrusta() {
    const values = [], corner = new T.Vector3(), origin = new T.Vector3();
    for (const sensor of this.cameras) {
      const { width, height, hfov, far } = sensor.camera, reach = Math.min(far || 1, 0.6);
      const half = Math.tan(Math.min(hfov, 2.6) / 2) * reach, tall = half * height / width;
      this.poseOf(sensor, m);
      origin.setFromMatrixPosition(m);
      const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) => corner.set(reach, a * half, b * tall).applyMatrix4(m).toArray());
      corners.forEach((here, i) => values.push(...origin, ...here, ...here, ...corners[(i + 1) % 4]));
    }
    this.frusta.geometry.dispose();
    this.frusta.geometry = new T.BufferGeometry();
    this.frusta.geometry.setAttribute('position', new T.Float32BufferAttribute(values, 3));
  }

  drawCones() {
    const values = [], point = new T.Vector3(), apex = new T.Vector3(), sides = 24;
    for (const sensor of this.sonars) {
      const { field_of_view: angle, axis, range_max: most } = sensor.sonar;
      const range = this.ranges[sensor.name] > 0 ? this.ranges[sensor.name] : most;
      const ahead = new T.Vector3(...axis), side = new T.Vector3(0, 1, 0).cross(ahead);
      if (side.lengthSq() < 1e-6) side.set(1, 0, 0);
      side.normalize();
      const up = ahead.clone().cross(side), radius = Math.tan(Math.min(angle / 2, 1.4)) * range;
      this.poseOf(sensor, m);
      apex.setFromMatrixPosition(m);
      const ring = k => {
        const turn = 2 * Math.PI * k / sides;
        return point.copy(ahead).multiplyScalar(range).addScaledVector(side, radius * Math.cos(turn)).addScaledVector(up, radius * Math.sin(turn)).applyMatrix4(m).toArray();
      };
      for (let k = 0; k < sides; k++) values.push(...apex, ...ring(k), ...ring(k + 1));
    }
    this.cones.geometry.dispose();
    this.cones.geometry = new T.BufferGeometry();
    this.cones.geometry.setAttribute('position', new T.Float32BufferAttribute(values, 3));
  }
}
