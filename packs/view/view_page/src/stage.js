// Renderer, cameras, lights, sky and the drawing loop. A frame is drawn only if something has changed.
import * as T from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';

T.Object3D.DEFAULT_UP.set(0, 0, 1);
const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

export class Stage {
  constructor(canvas, quality) {
    this.canvas = canvas;
    const probe = document.createElement('canvas').getContext('webgl2');
    if (!probe) throw new Error('This browser has no WebGL 2, which the scene needs.');
    const info = probe.getExtension('WEBGL_debug_renderer_info');
    this.renderer = info ? probe.getParameter(info.UNMASKED_RENDERER_WEBGL) : '';
    this.isSoftware = SOFTWARE.test(this.renderer);
    this.lite = quality === 'lite' || (quality !== 'full' && this.isSoftware);
    probe.getExtension('WEBGL_lose_context')?.loseContext();
    const gl = new T.WebGLRenderer({ canvas, antialias: !this.lite });
    gl.setPixelRatio(this.lite ? 0.75 : Math.min(devicePixelRatio, 2));
    gl.shadowMap.enabled = !this.lite;
    gl.shadowMap.type = T.PCFShadowMap;
    this.gl = gl;
    this.scene = new T.Scene();
    this.camera = new T.PerspectiveCamera(45, 1, 0.02, 500);
    this.camera.position.set(-4, -4, 3);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.2;
    this.controls.zoomToCursor = true;
    this.controls.addEventListener('change', () => this.invalidate());
    this.lights = new T.Group();
    this.helpers = new T.Group(); // everything that no sensor sees
    this.scene.add(this.lights, this.helpers);
    this.makeSky();
    this.before = []; // functions that run before a frame
    this.after = []; // functions that run after it
    this.cuts = []; // planes above which nothing is drawn
    this.draws = 0;
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
    this.invalidate();
  }

  /** Asks for a new frame. */
  invalidate() {
    if (this.dirty) return;
    this.dirty = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.dirty = false;
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
    this.gl.render(this.scene, this.camera);
    this.gl.clippingPlanes = [];
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
      if (light.shadow && around.shadows && this.shadows && !this.lite && light.kind !== 'point' && shadows < 2) {
        made.castShadow = true;
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
      this.sun.castShadow = !this.lite && this.shadows;
      lights.add(this.sun, this.sun.target);
    }
    this.invalidate();
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
