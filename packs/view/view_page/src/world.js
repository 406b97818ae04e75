// Objects of the compiled model: shapes by layer, their poses, picking and selection.
import * as T from 'three';

const PLANE = 0, HEIGHTS = 1, SPHERE = 2, CAPSULE = 3, ELLIPSOID = 4, CYLINDER = 5, BOX = 6, MESH = 7;
const DRAWN_COLLISION = 1, VISUAL = 2;
const ONE = new T.Vector3(1, 1, 1);
const FAR_PLANE = 250; // [m] half size of a plane without edges
const STILL = 1e-4; // least change of a position [m] or of a number of a quaternion that is a motion
const FLOOR_SHARE = 0.5, FLOOR_SLOPE = 0.1; // least share of the world's width that a floor has; largest height by its width
const HIGHEST = 1e4; // [m] above all terrain
const GLASS = 0.5; // opacity below which a shape hides nothing

const scratch = { m: new T.Matrix4(), b: new T.Matrix4(), p: new T.Vector3(), q: new T.Quaternion() };

/** Writes the pose at `offset` of an array of x y z, w x y z into a matrix. */
export function readPose(array, offset, matrix) {
  scratch.p.fromArray(array, offset);
  scratch.q.set(array[offset + 4], array[offset + 5], array[offset + 6], array[offset + 3]);
  return matrix.compose(scratch.p, scratch.q, ONE);
}

const DIRECTIONS = [];
for (const x of [-1, 0, 1]) for (const y of [-1, 0, 1]) for (const z of [-1, 0, 1]) if (x || y || z) DIRECTIONS.push([x, y, z]);

/** Returns the vertices of a shape that lie farthest in 26 directions: a turned mesh has no tight box of its own axes. */
function outermostPoints(geometry) {
  if (geometry.userData.outermost) return geometry.userData.outermost;
  const { array } = geometry.attributes.position, found = new Set();
  for (const [x, y, z] of DIRECTIONS) {
    let best = 0, most = -Infinity;
    for (let i = 0; i < array.length; i += 3) {
      const reach = x * array[i] + y * array[i + 1] + z * array[i + 2];
      if (reach > most) { most = reach; best = i; }
    }
    found.add(best);
  }
  return geometry.userData.outermost = [...found].flatMap(i => [array[i], array[i + 1], array[i + 2]]);
}

export class World {
  constructor(stage) {
    this.stage = stage;
    this.root = new T.Group();
    this.visuals = new T.Group();
    this.collisions = new T.Group();
    this.root.add(this.visuals);
    stage.helpers.add(this.collisions);
    this.collisions.visible = false;
    stage.scene.add(this.root);
    stage.onQuality.push(() => this.chooseMaterials());
    this.unit = {
      [SPHERE]: new T.SphereGeometry(1, 32, 20),
      [ELLIPSOID]: new T.SphereGeometry(1, 32, 20),
      [CYLINDER]: new T.CylinderGeometry(1, 1, 2, 40).rotateX(Math.PI / 2),
      [BOX]: new T.BoxGeometry(2, 2, 2),
      [PLANE]: new T.PlaneGeometry(2, 2),
    };
    this.bodies = [];
    this.drawnFloor = null; // level of a floor that only the page draws
  }

  /** Replaces all objects by those of a scene packet. */
  async load(scene) {
    this.scene = scene;
    this.arrays = { ...scene.arrays };
    const { body_pose: poses, moving } = scene.arrays;
    this.bodies = scene.bodies.map((_, i) => readPose(poses, 7 * i, new T.Matrix4()));
    this.moving = moving;
    this.isMoving = new Uint8Array(scene.bodies.length);
    for (const body of moving) this.isMoving[body] = 1;
    const textures = await this.loadTextures(scene);
    for (const texture of this.textures ?? []) texture?.dispose();
    const units = new Set(Object.values(this.unit));
    for (const geometry of this.geometries?.values() ?? []) if (geometry && !units.has(geometry)) geometry.dispose();
    this.textures = textures;
    this.geometries = new Map();
    this.rebuild();
  }

  rebuild() {
    for (const group of [this.visuals, this.collisions]) {
      for (const mesh of [...group.children]) {
        group.remove(mesh);
        for (const material of mesh.userData.materials ?? [mesh.material]) material.dispose();
        mesh.dispose?.();
      }
    }
    this.shapes = [];
    this.groupGeoms();
    this.makeSkins();
    this.chooseMaterials();
    this.place(true);
    this.findFloors();
    this.stage.extent = this.stage.around.extent;
  }

  /** Gives the visuals their materials for full or for fast frames. */
  chooseMaterials() {
    for (const mesh of this.visuals.children) mesh.material = mesh.userData.materials[this.stage.isFull ? 0 : 1];
  }

  // -------------------------------------------------------------- shapes

  groupGeoms() {
    const { scene, arrays: a } = this;
    const undrawn = new Set(scene.undrawn);
    const groups = new Map();
    for (let i = 0; i < a.geom_type.length; i++) {
      if (!a.geom_shown[i]) continue;
      const group = a.geom_group[i], owner = scene.owners[a.geom_owner[i]];
      const isVisual = group === DRAWN_COLLISION || group === VISUAL || undrawn.has(owner[0].split('::', 1)[0]) || undrawn.has(owner[0]);
      if (isVisual) this.addTo(groups, i, true);
      if (group !== VISUAL) this.addTo(groups, i, false);
    }
    for (const { geoms, isVisual, geometry } of groups.values()) this.makeInstances(geoms, isVisual, geometry);
  }

  addTo(groups, i, isVisual) {
    const { arrays: a } = this;
    const alpha = a.geom_rgba[4 * i + 3];
    if (isVisual && alpha <= 0.003) return;
    const [key, geometry] = this.geometryOf(i);
    if (!geometry) return;
    const name = isVisual ? [key, 'v', a.geom_material[i], alpha.toFixed(2)].join() : [key, 'c'].join();
    if (!groups.has(name)) groups.set(name, { geoms: [], isVisual, geometry });
    groups.get(name).geoms.push(i);
  }

  geometryOf(i) {
    const { arrays: a } = this, type = a.geom_type[i], data = a.geom_data[i], size = a.geom_size;
    let key = `${type}`;
    if (type === MESH) key += `:${data}`;
    else if (type === HEIGHTS) key += `:${data}`;
    else if (type === CAPSULE) key += `:${size[3 * i].toFixed(4)},${size[3 * i + 1].toFixed(4)}`;
    const material = this.scene.materials[a.geom_material[i]];
    if (type === PLANE && material?.texture >= 0) key += `:${size[3 * i]},${size[3 * i + 1]}`;
    if (!this.geometries.has(key)) this.geometries.set(key, this.makeGeometry(i, type, data, material));
    return [key, this.geometries.get(key)];
  }

  makeGeometry(i, type, data, material) {
    const { arrays: a } = this, size = a.geom_size.subarray(3 * i, 3 * i + 3);
    if (type === CAPSULE) return new T.CapsuleGeometry(size[0], 2 * size[1], 8, 24).rotateX(Math.PI / 2);
    if (type === HEIGHTS) return this.heightGeometry(data, material);
    if (type === MESH) {
      if (!a[`mesh${data}.position`]) return null;
      const made = new T.BufferGeometry();
      made.setAttribute('position', new T.BufferAttribute(a[`mesh${data}.position`], 3));
      made.setAttribute('normal', new T.BufferAttribute(a[`mesh${data}.normal`], 3));
      if (a[`mesh${data}.uv`]) made.setAttribute('uv', new T.BufferAttribute(a[`mesh${data}.uv`], 2));
      made.setIndex(new T.BufferAttribute(new Uint32Array(a[`mesh${data}.index`]), 1));
      return made;
    }
    if (type === PLANE && material?.texture >= 0) {
      const made = this.unit[PLANE].clone(), uv = made.attributes.uv;
      const x = material.uniform ? (size[0] || FAR_PLANE) : 1, y = material.uniform ? (size[1] || FAR_PLANE) : 1;
      for (let k = 0; k < uv.count; k++) uv.setXY(k, uv.getX(k) * x * material.repeat[0], (1 - uv.getY(k)) * y * material.repeat[1]);
      return made;
    }
    return this.unit[type] ?? null;
  }

  heightGeometry(field, material) {
    const { arrays: a, scene } = this, heights = a[`heights${field}`];
    if (!heights) return null;
    const [rx, ry, top] = a[`heights${field}.size`];
    const [rows, columns] = scene.heightShapes[field];
    const made = new T.PlaneGeometry(2 * rx, 2 * ry, columns - 1, rows - 1), position = made.attributes.position;
    for (let row = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++) {
        position.setZ((rows - 1 - row) * columns + column, top * heights[row * columns + column]);
      }
    }
    const { uv } = made.attributes;
    for (let k = 0; material && k < uv.count; k++) uv.setXY(k, uv.getX(k) * material.repeat[0], uv.getY(k) * material.repeat[1]);
    made.computeVertexNormals();
    return made;
  }

  scaleOf(i) {
    const { arrays: a } = this, [x, y, z] = a.geom_size.subarray(3 * i, 3 * i + 3);
    switch (a.geom_type[i]) {
      case BOX: case ELLIPSOID: return new T.Vector3(x, y, z);
      case CYLINDER: return new T.Vector3(x, x, y);
      case SPHERE: return new T.Vector3(x, x, x);
      case PLANE: return new T.Vector3(x || FAR_PLANE, y || FAR_PLANE, 1);
      default: return ONE.clone();
    }
  }

  makeInstances(geoms, isVisual, geometry) {
    const { arrays: a } = this, first = geoms[0];
    const materials = isVisual ? this.materialsOf(a.geom_material[first], a.geom_rgba[4 * first + 3], !!geometry.attributes.uv)
      : [new T.MeshBasicMaterial({ color: 0xff8a1f, wireframe: true, transparent: true, opacity: 0.55 })];
    const mesh = new T.InstancedMesh(geometry, materials[0], geoms.length);
    mesh.frustumCulled = false;
    const isFloor = a.geom_type[first] === PLANE;
    mesh.castShadow = isVisual && !isFloor && a.geom_rgba[4 * first + 3] > 0.5;
    mesh.receiveShadow = isVisual;
    mesh.userData = { geoms, isFloor, materials };
    if (isFloor) for (const material of materials) Object.assign(material, { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    const colour = new T.Color();
    geoms.forEach((geom, k) => {
      if (isVisual) mesh.setColorAt(k, colour.setRGB(a.geom_rgba[4 * geom], a.geom_rgba[4 * geom + 1], a.geom_rgba[4 * geom + 2], T.SRGBColorSpace));
    });
    const local = geoms.map(geom => {
      const pose = readPose([...a.geom_pos.subarray(3 * geom, 3 * geom + 3), ...a.geom_quat.subarray(4 * geom, 4 * geom + 4)], 0, new T.Matrix4());
      return pose.scale(this.scaleOf(geom));
    });
    (isVisual ? this.visuals : this.collisions).add(mesh);
    this.shapes.push({ mesh, geoms, local, isVisual, isFloor, moves: geoms.some(geom => this.isMoving[a.geom_body[geom]]) });
  }

  /** Returns the materials of a visual for full and for fast frames. */
  materialsOf(index, alpha, hasUv) {
    const found = this.scene.materials[index];
    const options = { color: 0xffffff, transparent: alpha < 0.995, opacity: alpha, depthWrite: alpha > 0.6 };
    const texture = found && this.textures[found.texture];
    if (texture && hasUv) options.map = texture;
    if (found?.emission > 0) {
      options.emissive = new T.Color(0xffffff);
      options.emissiveIntensity = 0.5 * found.emission;
      if (options.map) options.emissiveMap = options.map;
    }
    const fast = new T.MeshLambertMaterial(options), shininess = found ? found.shininess : 0.3, specular = found ? found.specular : 0.3;
    options.roughness = found?.roughness >= 0 ? found.roughness : Math.min(0.95, 0.9 - 0.5 * shininess * specular);
    options.metalness = found?.metallic >= 0 ? found.metallic : 0.02;
    return [new T.MeshStandardMaterial(options), fast];
  }

  async loadTextures(scene) {
    const load = async (texture, i) => {
      const image = await createImageBitmap(new Blob([scene.arrays[`texture${i}`]]));
      if (texture.kind !== '2d') return null;
      const made = new T.Texture(image);
      made.flipY = false;
      made.colorSpace = T.SRGBColorSpace;
      made.wrapS = made.wrapT = T.RepeatWrapping;
      made.anisotropy = this.stage.isSoftware ? 1 : 8;
      made.needsUpdate = true;
      return made;
    };
    return Promise.all(scene.textures.map((texture, i) => load(texture, i).catch(() => null)));
  }

  // -------------------------------------------------------------- skins

  makeSkins() {
    const { scene, arrays: a } = this;
    this.skins = scene.skins.map((skin, i) => {
      const made = new T.BufferGeometry(), rest = a[`skin${i}.position`];
      made.setAttribute('position', new T.BufferAttribute(new Float32Array(rest.length), 3));
      made.setIndex(new T.BufferAttribute(new Uint32Array(a[`skin${i}.index`]), 1));
      if (a[`skin${i}.uv`]) made.setAttribute('uv', new T.BufferAttribute(a[`skin${i}.uv`], 2));
      const materials = this.materialsOf(skin.material, skin.rgba[3], !!a[`skin${i}.uv`]);
      for (const material of materials) material.color.setRGB(...skin.rgba.slice(0, 3), T.SRGBColorSpace);
      const mesh = new T.Mesh(made, materials[0]);
      mesh.userData.materials = materials;
      mesh.frustumCulled = false;
      mesh.castShadow = mesh.receiveShadow = true;
      this.visuals.add(mesh);
      const bones = [...a[`skin${i}.bone_body`]].map((body, bone) => {
        const bind = readPose([...a[`skin${i}.bone_pos`].subarray(3 * bone, 3 * bone + 3), ...a[`skin${i}.bone_quat`].subarray(4 * bone, 4 * bone + 4)], 0, new T.Matrix4());
        return { body, inverse: bind.invert(), count: a[`skin${i}.bone_count`][bone] };
      });
      return { mesh, rest, bones, vertex: a[`skin${i}.vertex`], weight: a[`skin${i}.weight`] };
    });
  }

  bendSkins() {
    const point = new T.Vector3();
    for (const { mesh, rest, bones, vertex, weight } of this.skins) {
      const out = mesh.geometry.attributes.position.array.fill(0);
      let at = 0;
      for (const { body, inverse, count } of bones) {
        scratch.m.multiplyMatrices(this.bodies[body], inverse);
        for (let k = 0; k < count; k++, at++) {
          const v = 3 * vertex[at];
          point.fromArray(rest, v).applyMatrix4(scratch.m).multiplyScalar(weight[at]);
          out[v] += point.x; out[v + 1] += point.y; out[v + 2] += point.z;
        }
      }
      mesh.geometry.attributes.position.needsUpdate = true;
      mesh.geometry.computeVertexNormals();
    }
  }

  // -------------------------------------------------------------- poses

  /** Moves the bodies to the poses of a state packet. */
  setPoses(poses) {
    if (poses.length !== 7 * this.moving.length) return;
    this.moving.forEach((body, i) => readPose(poses, 7 * i, this.bodies[body]));
    this.isOld = true;
    if (this.drawn?.length === poses.length && this.drawn.every((value, i) => Math.abs(value - poses[i]) < STILL)) return;
    this.drawn = poses.slice();
    this.stage.move();
  }

  /** Writes the poses of the bodies into the drawn instances. */
  place(all = false) {
    if (!all && !this.isOld) return;
    this.isOld = false;
    const { geom_body: body } = this.arrays;
    for (const shape of this.shapes) {
      if (!all && (!shape.moves || !shape.mesh.parent.visible)) continue;
      shape.geoms.forEach((geom, k) => shape.mesh.setMatrixAt(k, scratch.m.multiplyMatrices(this.bodies[body[geom]], shape.local[k])));
      shape.mesh.instanceMatrix.needsUpdate = true;
      shape.mesh.boundingSphere = shape.mesh.boundingBox = null;
    }
    if (this.skins.length) this.bendSkins();
  }

  /** Applies changed colours, fixed poses and lights. */
  setAppearance(arrays) {
    if (arrays.geom_rgba.length !== this.arrays.geom_rgba.length) return;
    const isSame = name => this.arrays[name].every((value, i) => value === arrays[name][i]);
    const hasShapes = !['geom_rgba', 'geom_pos', 'geom_quat'].every(isSame); // a lamp on a robot moves all the time
    Object.assign(this.arrays, arrays);
    this.stage.lightArrays = this.arrays;
    this.stage.makeLights();
    if (hasShapes) this.rebuild();
    this.stage.invalidate();
  }

  // -------------------------------------------------------------- boxes, picking

  /** Returns the box of the drawn shapes of the geoms that `accept(geom, isFloor)` takes. */
  boxOf(accept) {
    const box = new T.Box3();
    for (const part of this.boxesBy((geom, isFloor) => (accept(geom, isFloor) ? 0 : null)).values()) box.union(part);
    return box;
  }

  /** Returns the box around the visuals of each model, without floors, by its name. */
  boxesByModel() {
    return this.boxesBy((geom, isFloor) => (isFloor ? null : this.linkOf(geom).split('::', 1)[0]));
  }

  /** Returns the boxes around the visuals that have the same key; geoms whose key is null belong to none. */
  boxesBy(keyOf) {
    const boxes = new Map(), point = new T.Vector3();
    this.place();
    for (const { mesh, geoms, isVisual, isFloor } of this.shapes) {
      if (!isVisual) continue;
      const outermost = outermostPoints(mesh.geometry);
      geoms.forEach((geom, k) => {
        const key = keyOf(geom, isFloor);
        if (key === null) return;
        if (!boxes.has(key)) boxes.set(key, new T.Box3());
        mesh.getMatrixAt(k, scratch.m);
        for (let i = 0; i < outermost.length; i += 3) boxes.get(key).expandByPoint(point.fromArray(outermost, i).applyMatrix4(scratch.m));
      });
    }
    return boxes;
  }

  linkOf(geom) {
    return this.scene.owners[this.arrays.geom_owner[geom]]?.[0] ?? '';
  }

  /** Returns the nearest hit of a ray that `accept(geom, isFloor)` takes: link, geom and point. What is cut off is not hit. */
  pick(raycaster, accept = () => true) {
    this.place();
    for (const { object, instanceId, point } of raycaster.intersectObjects(this.visuals.children.filter(mesh => mesh.userData.geoms), false)) {
      const geom = object.userData.geoms[instanceId], { isFloor } = object.userData;
      if (this.stage.cuts.some(cut => cut.distanceToPoint(point) < 0) || !accept(geom, isFloor)) continue;
      return { geom, link: this.linkOf(geom), owner: this.scene.owners[this.arrays.geom_owner[geom]]?.[1], point, isFloor };
    }
    return null;
  }

  /** Returns how far one sees from a point along a unit vector, at most `reach` [m]. Floors, glass and the model `own` hide nothing. */
  sight(from, along, reach, own) {
    const { geom_rgba: rgba } = this.arrays;
    const hit = this.pick(new T.Raycaster(from, along, 0, reach), (geom, isFloor) => !isFloor && rgba[4 * geom + 3] > GLASS && this.modelOf(geom) !== own);
    return hit ? hit.point.distanceTo(from) : reach;
  }

  modelOf(geom) {
    return this.linkOf(geom).split('::', 1)[0];
  }

  // -------------------------------------------------------------- floors

  /** Finds the levels of floors: horizontal planes and height fields; in a world without them, flat shapes about as wide as the world. */
  findFloors() {
    const { arrays: a } = this, fixed = geom => !this.isMoving[a.geom_body[geom]], up = new T.Vector3(), size = new T.Vector3();
    this.floors = [];
    this.terrains = [];
    for (const { mesh, geoms, isVisual, isFloor } of this.shapes) {
      if (!isVisual) continue;
      if (a.geom_type[geoms[0]] === HEIGHTS) this.terrains.push(mesh);
      if (isFloor) geoms.filter(fixed).forEach(geom => {
        mesh.getMatrixAt(geoms.indexOf(geom), scratch.m);
        if (up.setFromMatrixColumn(scratch.m, 2).normalize().z > 0.99) this.floors.push(scratch.m.elements[14]);
      });
    }
    if (this.floors.length || this.terrains.length) return;
    const boxes = this.boxesBy(geom => geom), all = new T.Box3();
    for (const box of boxes.values()) all.union(box);
    const width = all.getSize(new T.Vector3());
    for (const [geom, box] of boxes) {
      box.getSize(size);
      const narrow = Math.min(size.x, size.y);
      if (fixed(geom) && Math.min(size.x / width.x, size.y / width.y) > FLOOR_SHARE && size.z < FLOOR_SLOPE * narrow) this.floors.push(box.max.z);
    }
  }

  /** Returns the level of the highest floor at a place: of terrain, or of a floor below a level; null without a floor. */
  floorAt({ x, y }, below) {
    const ray = new T.Raycaster(new T.Vector3(x, y, HIGHEST), new T.Vector3(0, 0, -1));
    const levels = [...this.floors, this.drawnFloor ?? Infinity].filter(level => level <= below);
    levels.push(...ray.intersectObjects(this.terrains, false).map(hit => hit.point.z));
    return levels.length ? Math.max(...levels) : null;
  }
}
