// Viewpoints: first view, all, top, following, and the view of a sensor.
import * as T from 'three';

const DIRECTIONS = [[0.55, 0.62, -0.56], [-0.55, 0.62, -0.56], [0.55, -0.62, -0.56], [-0.55, -0.62, -0.56], [0.4, 0.45, -0.9], [0.1, 0.15, -1]];
const COVERED = 0.5, HEADROOM = 0.05; // least share that is seen of what is not below a roof; [m] between robots and a cut
const FARTHEST = 300, SIZES = 20, DEEPEST = 20; // [m], sizes of everything else, [m]: a model beyond is left out of views
const LARGEST_WHOLE = 12; // [m] up to which the first view shows the whole world
const FLIGHT = 400; // [ms] that the camera takes to a model
const FILL = 0.3; // share of the picture that a model has after that
const GAP = 0.1, CLEARANCE = 0.05; // [m] between the camera and a wall, and a floor
const RISES = [0, 0.25, 0.5, 0.75, 1, 1.25]; // [rad] by which the camera rises where a wall is too near
const HIGHEST = 1.4; // [rad] largest elevation of a camera that rises
const STOREY = 0.5; // [m] by which a floor may be above what the camera looks at

/** Returns true if a link is a link of a model, or of a model within it, or if both names are the same. */
export const isWithin = (link, name) => link === name || link.startsWith(`${name}::`);

export class Views {
  constructor(app) {
    this.app = app;
    this.followed = null; // body that the camera follows
    this.sensor = null; // camera whose view is shown
    this.flight = null; // from where to where the camera flies
    app.stage.before.push(() => this.update());
    app.stage.limit = () => this.limitOrbit();
    app.stage.controls.addEventListener('start', () => { this.flight = null; });
  }

  /** Returns the names of the models that fell out of the world or are far away from all others, as pictures do. */
  strays() {
    const { world, bodyOf } = this.app, boxes = world.boxesByModel(), names = [...boxes.keys()], found = new Set();
    if (names.length < 3) return found;
    const gapTo = (box, other) => new T.Vector3().subVectors(box.min, other.max)
      .max(new T.Vector3().subVectors(other.min, box.max)).max(new T.Vector3()).length();
    const middles = new Map(names.map(name => [name, boxes.get(name).getCenter(new T.Vector3())]));
    const median = axis => [...middles.values()].map(point => point[axis]).sort((p, q) => p - q)[names.length >> 1];
    const middle = new T.Vector3(median('x'), median('y'), median('z'));
    const way = name => { const { x, y, z } = middles.get(name).clone().sub(middle); return Math.max(Math.abs(x), Math.abs(y), Math.abs(z)); };
    const ordered = names.sort((p, q) => way(p) - way(q)), rest = new T.Box3();
    ordered.slice(0, Math.ceil(ordered.length / 2)).forEach(name => rest.union(boxes.get(name)));
    for (const name of ordered) {
      const size = rest.getSize(new T.Vector3()).length();
      if (gapTo(boxes.get(name), rest) > Math.max(FARTHEST, SIZES * size)) found.add(name);
      else if (!bodyOf.has(name) || boxes.get(name).max.z >= rest.min.z - Math.max(DEEPEST, 2 * size)) rest.union(boxes.get(name));
      else found.add(name);
    }
    return found;
  }

  robotBox(strays = this.strays()) {
    const { world, robots } = this.app, names = new Set(robots.map(robot => robot.name).filter(name => !strays.has(name)));
    return world.boxOf(geom => names.has(world.linkOf(geom).split('::', 1)[0]));
  }

  worldBox(strays = this.strays()) {
    const { world } = this.app;
    return world.boxOf((geom, isFloor) => !isFloor && !strays.has(world.linkOf(geom).split('::', 1)[0]));
  }

  /** Shows the robots with what surrounds them: all corners of their boxes are in the picture. */
  first() {
    const { stage } = this.app;
    this.release();
    const strays = this.strays(), all = this.worldBox(strays), robots = this.robotBox(strays);
    let box = all.isEmpty() ? new T.Box3(new T.Vector3(-2, -2, 0), new T.Vector3(2, 2, 1)) : all;
    const isWhole = all.isEmpty() || robots.isEmpty() || all.getSize(new T.Vector3()).length() < LARGEST_WHOLE;
    if (!isWhole && this.app.hasRobots) {
      box = robots.clone();
      const size = box.getSize(new T.Vector3()), margin = Math.max(0.35 * size.length(), 1.2);
      box.min.x -= margin; box.min.y -= margin; box.max.x += margin; box.max.y += margin;
    }
    const notes = strays.size ? [`outside of the view: ${[...strays].slice(0, 3).join(', ')}${strays.size > 3 ? ` and ${strays.size - 3} more` : ''}`] : [];
    let direction = new T.Vector3(...DIRECTIONS[0]);
    if (stage.triangles < 4e5) {
      const points = robots.isEmpty() ? this.roomPoints(strays) : this.robotPoints(robots);
      let seen = this.clearest(box, points, Infinity);
      if (seen.share < COVERED && !all.isEmpty()) { // below a roof
        const ceiling = robots.isEmpty() ? (all.min.z + all.max.z) / 2 : robots.max.z + HEADROOM;
        const opened = this.clearest(box, points, ceiling);
        if (opened.share > seen.share) {
          seen = opened;
          stage.cuts = [new T.Plane(new T.Vector3(0, 0, -1), ceiling)];
          notes.push(`opened above z = ${ceiling.toPrecision(3)} m`);
        }
      }
      if (seen.direction) direction = seen.direction;
    }
    stage.fit(box, direction);
    if (notes.length) this.app.report(notes.join('; '));
  }

  /** Returns the centre and the lower corners of the box of the robots, each with the names of the robots. */
  robotPoints(robots) {
    const { min, max } = robots, own = new Set(this.app.robots.map(robot => robot.name));
    const points = [robots.getCenter(new T.Vector3())];
    for (const x of [min.x, max.x]) for (const y of [min.y, max.y]) points.push(new T.Vector3(x, y, 0.7 * min.z + 0.3 * max.z));
    return points.map(point => ({ point, own }));
  }

  /** Returns the middles of the smaller models of a world without robots, at most 12, each with its name. */
  roomPoints(strays) {
    const boxes = [...this.app.world.boxesByModel()].filter(([name]) => !strays.has(name))
      .map(([name, box]) => ({ point: box.getCenter(new T.Vector3()), own: new Set([name]), size: box.getSize(new T.Vector3()).length() }))
      .sort((p, q) => p.size - q.size);
    const smaller = boxes.slice(0, Math.ceil(boxes.length / 2)), each = Math.ceil(smaller.length / 12);
    return smaller.filter((_, number) => number % each === 0);
  }

  /** Returns the direction from which most points are seen, below a ceiling, and the share that is seen. */
  clearest(box, points, ceiling) {
    const { stage, world } = this.app, ray = new T.Raycaster();
    let best = null, most = -1;
    for (const values of DIRECTIONS) {
      const ahead = new T.Vector3(...values).normalize();
      const eye = box.getCenter(new T.Vector3()).addScaledVector(ahead, -stage.fitDistance(box, ahead, 0.94));
      const seen = points.filter(({ point, own }) => {
        const start = eye.clone();
        if (start.z > ceiling && point.z < ceiling) start.lerp(point, (start.z - ceiling) / (start.z - point.z));
        ray.set(start, point.clone().sub(start).normalize());
        ray.camera = stage.camera;
        const hit = world.pick(ray);
        return !hit || own.has(hit.link.split('::', 1)[0]) || hit.point.distanceTo(start) > point.distanceTo(start);
      }).length;
      if (seen > most) { most = seen; best = ahead; }
      if (seen === points.length) break;
    }
    return { direction: best, share: points.length ? most / points.length : 1 };
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

  /** Follows a body, or nothing with null; walls do not hide it. */
  follow(body) {
    const { stage, world, scene } = this.app;
    this.detach();
    this.followed = body;
    if (body !== null) {
      this.own = scene.frames.find(([, found]) => found === body)[0].split('::', 1)[0];
      world.place();
      const box = world.boxOf(geom => world.modelOf(geom) === this.own), origin = new T.Vector3().setFromMatrixPosition(world.bodies[body]);
      this.last = origin;
      stage.controls.target.copy(origin);
      if (!box.isEmpty()) stage.controls.target.z = Math.max(origin.z, (box.min.z + box.max.z) / 2);
      this.least = Math.max(0.5, 1.2 * (box.isEmpty() ? 0 : box.getSize(new T.Vector3()).length()));
      const offset = stage.camera.position.clone().sub(stage.controls.target), length = Math.min(offset.length(), 3.5);
      offset.normalize();
      offset.z = Math.max(offset.z, 0.35);
      this.wanted = offset.setLength(Math.max(length, this.least));
      this.taken = null;
    }
    this.app.emit('view');
    stage.move();
  }

  /** Returns the offset of the camera nearest to a wanted one at which nothing hides a point: closer, or above if a wall is too near. */
  clearOffset(point, wanted, own, least) {
    const reach = wanted.length(), level = Math.hypot(wanted.x, wanted.y), elevation = Math.atan2(wanted.z, level);
    let best = wanted, most = -1;
    for (const rise of RISES) {
      const angle = rise ? Math.max(elevation, Math.min(elevation + rise, HIGHEST)) : elevation;
      const across = level > 1e-6 ? reach * Math.cos(angle) / level : 0;
      const along = new T.Vector3(wanted.x * across, wanted.y * across, reach * Math.sin(angle)).normalize();
      const seen = this.app.world.sight(point, along, reach + GAP, own) - GAP;
      if (seen > most) { most = seen; best = along.multiplyScalar(Math.max(seen, GAP)); }
      if (seen >= Math.min(least, reach) - 1e-6) break;
    }
    return best;
  }

  /** Moves the camera with the body that it follows. */
  keepFollowing() {
    const { stage: { camera, controls }, world } = this.app;
    const now = new T.Vector3().setFromMatrixPosition(world.bodies[this.followed]), moved = now.clone().sub(this.last);
    this.last = now;
    controls.target.add(moved);
    const offset = camera.position.clone().add(moved).sub(controls.target);
    if (this.taken && offset.distanceTo(this.taken) > 1e-4) this.wanted = offset.multiplyScalar(this.wanted.length() / this.taken.length()); // the user has turned the view
    this.taken = this.clearOffset(controls.target, this.wanted, this.own, this.least);
    camera.position.copy(controls.target).add(this.taken);
    camera.lookAt(controls.target);
  }

  /** Returns the level of the floor at a place; null without a floor, and while a camera of the robot is shown. */
  floorAt(place) {
    const { stage: { controls }, world, scene } = this.app;
    return scene && !this.sensor ? world.floorAt(place, controls.target.z + STOREY) : null;
  }

  /** Ends the orbit just above the floor. */
  limitOrbit() {
    const { camera, controls } = this.app.stage, level = this.floorAt(camera.position);
    const height = level === null ? -1 : (level + CLEARANCE - controls.target.z) / camera.position.distanceTo(controls.target);
    controls.maxPolarAngle = Math.acos(Math.min(Math.max(height, -1), 1));
  }

  /** Lifts the camera and what it looks at above the floor, below which they can be moved. */
  liftAboveFloor() {
    const { camera, controls } = this.app.stage, below = this.floorAt(camera.position), level = this.floorAt(controls.target);
    const lift = Math.max(0, below === null ? 0 : below + CLEARANCE - camera.position.z, level === null ? 0 : level - controls.target.z);
    camera.position.z += lift;
    controls.target.z += lift;
  }

  /** Flies to a model from the present direction, or from one where no wall hides it; a floor alone is already seen. */
  flyTo(name) {
    const { stage, world } = this.app, own = name.split('::', 1)[0];
    const box = world.boxOf((geom, isFloor) => !isFloor && isWithin(world.linkOf(geom), name));
    if (box.isEmpty()) return;
    this.detach();
    const { camera, controls } = stage, point = box.getCenter(new T.Vector3()), offset = camera.position.clone().sub(controls.target);
    offset.setLength(Math.max(stage.fitDistance(box, offset.clone().negate().normalize(), FILL), 0.3));
    offset.copy(this.clearOffset(point, offset, own, 0.6 * offset.length()));
    this.flight = { begin: performance.now(), eye: [camera.position.clone(), point.clone().add(offset)], target: [controls.target.clone(), point] };
    stage.move();
  }

  fly() {
    const { stage } = this.app, { begin, eye, target } = this.flight, x = Math.min(1, (performance.now() - begin) / FLIGHT), f = x * x * (3 - 2 * x);
    stage.camera.position.lerpVectors(...eye, f);
    stage.controls.target.lerpVectors(...target, f);
    stage.camera.lookAt(stage.controls.target);
    if (x === 1) this.flight = null;
    stage.move();
  }

  /** Looks through a camera of the robot. */
  through(sensor) {
    this.detach();
    this.sensor = sensor;
    this.app.stage.cuts = [];
    this.app.stage.controls.enabled = false;
    this.app.emit('view');
    this.app.stage.invalidate();
  }

  /** Ends following, flights and the view of a camera. */
  detach() {
    this.followed = this.sensor = this.flight = null;
    this.app.stage.controls.enabled = true;
    this.app.stage.camera.fov = 45;
    this.app.stage.camera.up.set(0, 0, 1);
    this.app.emit('view');
  }

  release() {
    this.app.stage.cuts = [];
    this.detach();
  }

  update() {
    const { stage } = this.app;
    if (this.followed !== null) this.keepFollowing();
    if (this.flight) this.fly();
    this.liftAboveFloor();
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
