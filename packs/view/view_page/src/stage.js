// Renderer, cameras, lights, sky and the drawing loop. A frame is drawn only if something has changed.
//
// A full frame has all pixels, smooth edges, shadows and shininess; a fast one has none of them, and 3/4 of the pixels along
// each axis. Without a graphics card, a full frame takes about ten times as long, so it is drawn only when nothing moves.
import * as T from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

T.Object3D.DEFAULT_UP.set(0, 0, 1);
const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;
const REST = 300; // [ms] without motion after which a full frame is drawn
const STILL_PERIOD = 1000; // [ms] between two full frames without a graphics card, while nothing moves
const FAST_PIXELS = 0.75; // pixels of a fast frame for each pixel of the page, along an axis
const SAMPLES = 4; // of each pixel of a full frame

/** Choices of the drawing quality, by the value in the address. */
export const QUALITIES = { auto: 'automatic', full: 'full', fast: 'fast' };

export class Stage {
  constructor(canvas, quality) {
    this.canvas = canvas;
    const probe = document.createElement('canvas').getContext('webgl2');
    if (!probe) throw new Error('This browser has no WebGL 2, which the scene needs.');
    const info = probe.getExtension('WEBGL_debug_renderer_info');
    this.renderer = info ? probe.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
    this.isSoftware = SOFTWARE.test(this.renderer);
    probe.getExtension('WEBGL_lose_context')?.loseContext();
    const gl = new T.WebGLRenderer({ canvas, antialias: false }); // full frames have their own samples
    gl.shadowMap.enabled = true;
    gl.shadowMap.type = T.PCFShadowMap;
    this.gl = gl;
    this.quality = Object.hasOwn(QUALITIES, quality) ? quality : 'auto';
    this.isFull = null; // true if the last frame was a full one
    this.onQuality = []; // functions that run when `isFull` changes
    this.movedAt = this.fullAt = -1e6;
    this.makeCopy();
    this.scene = new T.Scene();
    this.camera = new T.PerspectiveCamera(45, 1, 0.02, 500);
    this.camera.position.set(-4, -4, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.2;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.move());
    this.lights = new T.Group();
    this.helpers = new T.Group(); // everything that no sensor sees
    this.scene.add(this.lights, this.helpers);
    this.makeSky();
    this.limit = () => {}; // limits the angle of the orbit before it is used
    this.before = []; // functions that run before a frame
    this.after = []; // functions that run after it
    this.cuts = []; // planes above which nothing is drawn
    this.draws = this.triangles = 0;
    this.extent = 5;
    this.dirty = false;
    this.shadows = true;
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.gl.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.fitted?.at.distanceTo(this.camera.position) < 1e-6) this.fit(...this.fitted.arguments); // nobody has moved the camera
    this.move();
  }

  /** Asks for a new frame of a camera or of models that move. */
  move() {
    this.movedAt = performance.now();
    if (this.waits) { clearTimeout(this.waits); this.waits = null; this.dirty = false; }
    this.invalidate();
  }

  /** Asks for a new frame. */
  invalidate() {
    if (this.dirty) return;
    this.dirty = true;
    const ask = () => { this.waits = null; requestAnimationFrame(() => this.draw()); };
    const wait = this.isSoftware && this.isFull && this.wantsFull() ? this.fullAt + STILL_PERIOD - performance.now() : 0;
    if (wait > 0) this.waits = setTimeout(ask, wait);
    else ask();
  }

  setQuality(quality) {
    this.quality = quality;
    this.move();
  }

  wantsFull() {
    if (this.quality !== 'auto') return this.quality === 'full';
    return !this.isSoftware || performance.now() - this.movedAt >= REST;
  }

  /** Chooses the quality of the next frame; after a fast one, a full one follows when nothing moves any more. */
  chooseQuality() {
    const isFull = this.wantsFull();
    clearTimeout(this.rest);
    if (!isFull && this.quality === 'auto') this.rest = setTimeout(() => this.invalidate(), REST + 10);
    if (isFull) this.fullAt = performance.now();
    if (isFull === this.isFull) return;
    this.isFull = isFull;
    this.gl.setPixelRatio(isFull ? Math.min(devicePixelRatio, 2) : FAST_PIXELS);
    this.showShadows();
    for (const call of this.onQuality) call(isFull);
  }

  /** Makes what copies a full frame from its samples to the page. */
  makeCopy() {
    this.target = new T.WebGLRenderTarget(1, 1, { colorSpace: T.SRGBColorSpace, samples: SAMPLES });
    const material = new T.ShaderMaterial({
      depthTest: false, depthWrite: false, uniforms: { picture: { value: this.target.texture } },
      vertexShader: 'varying vec2 place;void main(){place=uv;gl_Position=vec4(position.xy,0.,1.);}',
      fragmentShader: `uniform sampler2D picture;varying vec2 place;
        void main(){gl_FragColor=texture2D(picture,place);
        #include <colorspace_fragment>
        }`,
    });
    this.copy = new T.Mesh(new T.PlaneGeometry(2, 2), material);
    this.copy.frustumCulled = false;
  }

  draw() {
    this.dirty = false;
    this.chooseQuality();
    this.limit();
    this.controls.update();
    for (const call of this.before) call();
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(0.004, 0.01 * distance);
    this.camera.far = Math.max(300, 12 * distance, 6 * this.extent);
    this.camera.updateProjectionMatrix();
    this.placeSun(distance);
    this.sky.position.copy(this.camera.position);
    this.sky.scale.setScalar(0.9 * this.camera.far);
    this.gl.clippingPlanes = this.cuts; // only here: sensors see what is cut
    if (this.isFull) {
      const { width, height } = this.canvas;
      if (this.target.width !== width || this.target.height !== height) this.target.setSize(width, height);
      this.gl.setRenderTarget(this.target);
    }
    this.gl.render(this.scene, this.camera);
    this.triangles = this.gl.info.render.triangles;
    this.gl.clippingPlanes = [];
    if (this.isFull) {
      this.gl.setRenderTarget(null);
      this.gl.render(this.copy, this.camera);
    }
    this.draws += 1;
    for (const call of this.after) call();
  }

  makeSky() {
    this.skyColours = { top: { value: new T.Color() }, horizon: { value: new T.Color() } };
    const material = new T.ShaderMaterial({
      side: T.BackSide, depthWrite: false, fog: false, uniforms: this.skyColours,
      vertexShader: 'varying vec3 ray;void main(){ray=position;gl_Position=projectionMatrix*modelViewMatrix*vec4(position,1.);}',
      fragmentShader: `uniform vec3 top,horizon;varying vec3 ray;
        void main(){float h=normalize(ray).z;gl_FragColor=vec4(mix(horizon,top,smoothstep(0.,.6,h)),1.);
        #include <colorspace_fragment>
        }`,
    });
    this.sky = new T.Mesh(new T.SphereGeometry(1, 24, 16), material);
    this.sky.frustumCulled = false;
    this.sky.renderOrder = -1;
    this.scene.add(this.sky);
  }

  /** Sets sky, fog and lights of a scene packet. */
  setSurroundings(around, arrays) {
    this.around = around;
    const background = new T.Color().setRGB(...around.background, T.SRGBColorSpace);
    const horizon = background.clone().lerp(new T.Color(0xf2f5f8), 0.45);
    const top = around.sky ? new T.Color(0x5b93d6) : background.clone().lerp(new T.Color(0x6f9fd8), 0.55);
    this.skyColours.top.value.copy(top);
    this.skyColours.horizon.value.copy(horizon);
    const fog = around.fog;
    if (fog && Array.isArray(fog.colour ?? fog.color)) {
      const colour = new T.Color().setRGB(...(fog.colour ?? fog.color).slice(0, 3), T.SRGBColorSpace);
      this.scene.fog = fog.end > 0 ? new T.Fog(colour, fog.start ?? 0, fog.end) : new T.FogExp2(colour, fog.density ?? 0.01);
      this.skyColours.horizon.value.copy(colour);
    } else {
      this.scene.fog = new T.Fog(horizon, Math.max(40, 4 * around.extent), Math.max(220, 14 * around.extent));
    }
    this.lightArrays = arrays;
    this.makeLights();
  }

  makeLights() {
    const { around, lightArrays: arrays, lights } = this;
    for (const light of [...lights.children]) { lights.remove(light); light.dispose?.(); }
    const ambient = Math.max(...around.ambient, 0.12);
    const level = value => Math.min(value, 1.05) ** 1.8; // MuJoCo adds light without gamma; this page adds it with
    const hemisphere = new T.HemisphereLight(0xffffff, 0xcfc8bd, Math.PI * 0.92 * level(ambient));
    lights.add(hemisphere);
    this.sun = null;
    let shadows = 0, count = 0;
    around.lights.forEach((light, i) => {
      if (!arrays.light_active[i] || count >= 12) return;
      const rgb = arrays.light_diffuse.slice(3 * i, 3 * i + 3), most = Math.max(...rgb);
      if (!(most > 0)) return;
      count += 1;
      const colour = new T.Color().setRGB(rgb[0] / most, rgb[1] / most, rgb[2] / most, T.SRGBColorSpace);
      const position = new T.Vector3().fromArray(arrays.light_pos, 3 * i);
      const direction = new T.Vector3().fromArray(arrays.light_dir, 3 * i).normalize();
      const strength = Math.PI * Math.max(0.15, level(ambient + most) - level(ambient));
      let made;
      if (light.kind === 'directional') {
        made = new T.DirectionalLight(colour, strength);
        made.userData.direction = direction;
      } else {
        const [constant, linear, quadratic] = light.attenuation, near = 3;
        const power = strength * near ** 2 / Math.max(0.05, constant + linear * near + quadratic * near * near);
        const decay = linear || quadratic ? 2 : 0;
        made = light.kind === 'spot'
          ? new T.SpotLight(colour, decay ? power : strength, 0, Math.min(light.cutoff * Math.PI / 180, 1.5), 0.4, decay)
          : new T.PointLight(colour, decay ? power : strength, 0, decay);
        made.position.copy(position);
        if (made.target) made.target.position.copy(position).add(direction);
      }
      if (light.shadow && around.shadows && light.kind !== 'point' && shadows < 2) {
        made.userData.hasShadow = true;
        made.shadow.mapSize.set(2048, 2048);
        made.shadow.bias = -0.0003;
        made.shadow.normalBias = 0.012;
        made.shadow.radius = 2.5;
        shadows += 1;
      }
      if (light.kind === 'directional' && !this.sun) this.sun = made;
      lights.add(made);
      if (made.target) lights.add(made.target);
    });
    if (count === 0) { // a model without a world
      this.sun = new T.DirectionalLight(0xffffff, 2.2);
      this.sun.userData.direction = new T.Vector3(0.45, 0.6, -0.9).normalize();
      this.sun.userData.hasShadow = true;
      this.sun.shadow.mapSize.set(2048, 2048);
      this.sun.shadow.normalBias = 0.004;
      lights.add(this.sun, this.sun.target);
    }
    this.showShadows();
    this.invalidate();
  }

  showShadows() {
    for (const light of this.lights.children) light.castShadow = !!light.userData.hasShadow && this.shadows && this.isFull === true;
  }

  /** Moves the area of the sun's shadow to what the camera looks at. */
  placeSun(distance) {
    for (const light of this.lights.children) {
      const direction = light.userData.direction;
      if (!direction) continue;
      const reach = Math.min(Math.max(0.9 * distance, 1.5), 40, 1.5 * this.extent + 2);
      light.target.position.copy(this.controls.target);
      light.position.copy(this.controls.target).addScaledVector(direction, -3 * reach);
      if (light.castShadow) {
        Object.assign(light.shadow.camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1, far: 7 * reach });
        light.shadow.camera.updateProjectionMatrix();
      }
    }
  }

  /** Looks at a box from a direction, so that all its corners are in the picture. */
  fit(box, direction, fill = 0.94) {
    const centre = box.getCenter(new T.Vector3());
    const ahead = direction.clone().normalize();
    const distance = this.fitDistance(box, ahead, fill);
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(ahead, -distance);
    this.controls.update();
    this.fitted = { at: this.camera.position.clone(), arguments: [box, direction, fill] };
    this.invalidate();
  }

  fitDistance(box, ahead, fill) {
    const centre = box.getCenter(new T.Vector3());
    const right = new T.Vector3().crossVectors(ahead, new T.Vector3(0, 0, 1));
    if (right.lengthSq() < 1e-9) right.set(1, 0, 0);
    right.normalize();
    const up = new T.Vector3().crossVectors(right, ahead);
    const tall = Math.tan(this.camera.fov * Math.PI / 360) * fill, wide = tall * this.camera.aspect;
    let distance = 0.2;
    for (let corner = 0; corner < 8; corner++) {
      const p = new T.Vector3(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y, corner & 4 ? box.max.z : box.min.z).sub(centre);
      distance = Math.max(distance, Math.abs(p.dot(right)) / wide - p.dot(ahead), Math.abs(p.dot(up)) / tall - p.dot(ahead));
    }
    return distance;
  }
}
