// Viewpoints: first view, all, top, following, and the view of a sensor.
import * as T from 'three';

const DIRECTIONS = [[0.55, 0.62, -0.56], [-0.55, 0.62, -0.56], [0.55, -0.62, -0.56], [-0.55, -0.62, -0.56], [0.4, 0.45, -0.9], [0.1, 0.15, -1]];
const LARGEST_WHOLE = 12; // [m] up to which the first view shows the whole world

export class Views {
  constructor(app) {
    this.app = app;
    this.followed = null; // body that the camera follows
    this.sensor = null; // camera whose view is shown
    app.stage.before.push(() => this.update());
  }

  robotBox() {
    const { world, robots } = this.app, names = new Set(robots.map(robot => robot.name));
    return world.boxOf(geom => names.has(world.linkOf(geom).split('::', 1)[0]));
  }

  worldBox() {
    return this.app.world.boxOf((geom, isFloor) => !isFloor);
  }

  /** Shows the robots with what surrounds them: all corners of their boxes are in the picture. */
  first() {
    const { stage, world } = this.app;
    this.release();
    const all = this.worldBox(), robots = this.robotBox();
    let box = all.isEmpty() ? new T.Box3(new T.Vector3(-2, -2, 0), new T.Vector3(2, 2, 1)) : all;
    const isWhole = all.isEmpty() || robots.isEmpty() || all.getSize(new T.Vector3()).length() < LARGEST_WHOLE;
    if (!isWhole && this.app.hasRobots) {
      box = robots.clone();
      const size = box.getSize(new T.Vector3()), margin = Math.max(0.35 * size.length(), 1.2);
      box.min.x -= margin; box.min.y -= margin; box.max.x += margin; box.max.y += margin;
    }
    let direction = new T.Vector3(...DIRECTIONS[0]);
    if (!robots.isEmpty() && stage.gl.info.render.triangles < 4e5) {
      direction = this.clearest(box, robots);
    }
    stage.fit(box, direction);
  }

  /** Returns the direction from which most of the robots is seen: centre and lower corners of their box. */
  clearest(box, robots) {
    const { stage, world } = this.app, ray = new T.Raycaster(), names = new Set(this.app.robots.map(robot => robot.name));
    const { min, max } = robots, points = [robots.getCenter(new T.Vector3())];
    for (const x of [min.x, max.x]) for (const y of [min.y, max.y]) points.push(new T.Vector3(x, y, 0.7 * min.z + 0.3 * max.z));
    let best = null, most = -1;
    for (const values of DIRECTIONS) {
      const ahead = new T.Vector3(...values).normalize();
      const eye = box.getCenter(new T.Vector3()).addScaledVector(ahead, -stage.fitDistance(box, ahead, 0.94));
      const seen = points.filter(point => {
        ray.set(eye, point.clone().sub(eye).normalize());
        ray.camera = stage.camera;
        const hit = world.pick(ray);
        return !hit || names.has(hit.link.split('::', 1)[0]) || hit.point.distanceTo(eye) > point.distanceTo(eye);
      }).length;
      if (seen > most) { most = seen; best = ahead; }
      if (seen === points.length) break;
    }
    return best;
  }

  all() {
    this.release();
    const box = this.worldBox();
    if (!box.isEmpty()) this.app.stage.fit(box, this.app.stage.controls.target.clone().sub(this.app.stage.camera.position));
  }

  top() {
    this.release();
    const box = this.worldBox();
    if (!box.isEmpty()) this.app.stage.fit(box, new T.Vector3(0, 0.001, -1));
  }

  /** Follows a body, or nothing with null. */
  follow(body) {
    this.sensor = null;
    this.app.stage.controls.enabled = true;
    this.followed = body;
    this.last = body === null ? null : new T.Vector3().setFromMatrixPosition(this.app.world.bodies[body]);
    if (body !== null) {
      const { stage, world } = this.app, distance = Math.min(stage.camera.position.distanceTo(this.last), 3.5);
      const direction = stage.camera.position.clone().sub(this.last).normalize();
      direction.z = Math.max(direction.z, 0.35);
      stage.controls.target.copy(this.last);
      stage.camera.position.copy(this.last).addScaledVector(direction.normalize(), distance);
      world.place();
    }
    this.app.emit('view');
    this.app.stage.invalidate();
  }

  /** Looks through a camera of the robot. */
  through(sensor) {
    this.followed = null;
    this.sensor = sensor;
    this.app.stage.controls.enabled = false;
    this.app.emit('view');
    this.app.stage.invalidate();
  }

  release() {
    this.followed = this.sensor = null;
    this.app.stage.controls.enabled = true;
    this.app.stage.camera.fov = 45;
    this.app.stage.camera.up.set(0, 0, 1);
    this.app.emit('view');
  }

  update() {
    const { stage, world, sensors } = this.app;
    if (this.followed !== null && this.last) {
      const now = new T.Vector3().setFromMatrixPosition(world.bodies[this.followed]);
      const moved = now.clone().sub(this.last);
      stage.camera.position.add(moved);
      stage.controls.target.add(moved);
      this.last = now;
    }
    if (this.sensor) {
      this.aim(stage.camera, this.sensor, stage.camera.aspect);
      stage.controls.target.copy(stage.camera.position).add(new T.Vector3(0, 0, -1).applyQuaternion(stage.camera.quaternion));
    } else {
      stage.camera.up.set(0, 0, 1);
    }
  }

  /** Gives a camera the pose and the field of view of a sensor. */
  aim(camera, sensor, aspect) {
    const pose = this.app.sensors.poseOf(sensor);
    const x = new T.Vector3(), y = new T.Vector3(), z = new T.Vector3();
    pose.extractBasis(x, y, z);
    camera.position.setFromMatrixPosition(pose);
    const basis = new T.Matrix4().makeBasis(y.clone().negate(), z, x.clone().negate()); // looks along the sensor's x
    camera.quaternion.setFromRotationMatrix(basis);
    const { width, height, hfov } = sensor.camera, wide = Math.tan(Math.min(hfov, 2.6) / 2);
    camera.fov = 2 * Math.atan(Math.max(wide * height / width, wide / aspect * (aspect < width / height ? 1 : 0))) * 180 / Math.PI;
    camera.updateProjectionMatrix();
  }
}
