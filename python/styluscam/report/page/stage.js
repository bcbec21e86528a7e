// The 3-D view: camera, lights, and drawing only when something has changed.

const VIEWS = { slant: [-0.38, -0.72, 0.62], top: [0, -1e-4, 1], front: [0, -1, 0], right: [1, 0, 0], below: [-0.38, -0.72, -0.5] };
const FLIGHT_MS = 350;

class Stage {
  /** `box`: lower and upper corner of what is to be seen, mm. */
  constructor(canvas, box) {
    this.canvas = canvas;
    this.origin = box[0].map((low, k) => (low + box[1][k]) / 2);
    this.size = Math.hypot(...box[0].map((low, k) => box[1][k] - low)) || 1;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(32, 1, this.size / 500, this.size * 20);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.redraw());
    const sky = new THREE.HemisphereLight(0xffffff, 0x7c8894, 2.3);
    sky.position.set(0, 0, 1);
    this.scene.add(sky);
    const lamp = new THREE.DirectionalLight(0xffffff, 1.3);
    lamp.position.set(-0.5, 0.7, 0.6);
    this.camera.add(lamp);
    this.scene.add(this.camera);
    this.look("slant");
    new ResizeObserver(() => this.fit()).observe(canvas);
    this.fit();
  }

  /** A place in mm as the scene has it: near zero, where single precision is finest. */
  place([x, y, z]) {
    return new THREE.Vector3(x - this.origin[0], y - this.origin[1], z - this.origin[2]);
  }

  look(name) {
    this.controls.target.set(0, 0, 0);
    this.camera.position.set(...VIEWS[name]).normalize().multiplyScalar(this.distance());
    this.controls.update();
    this.redraw();
  }

  /** From where the whole is seen, in narrow windows too. */
  distance() {
    const half = Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, this.camera.aspect || 1);
    return (0.48 * this.size) / Math.max(half, 0.1);
  }

  /** Brings a place to the middle, from the side from which one looks already. */
  flyTo(position) {
    const target = this.place(position);
    const from = { target: this.controls.target.clone(), eye: this.camera.position.clone() };
    const towards = from.eye.clone().sub(from.target).normalize();
    const eye = target.clone().addScaledVector(towards, 0.3 * this.distance());
    const start = performance.now();
    const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    const step = (now) => {
      const share = still ? 1 : Math.min(1, Math.max(0, (now - start) / FLIGHT_MS));
      const eased = share * share * (3 - 2 * share);
      this.controls.target.lerpVectors(from.target, target, eased);
      this.camera.position.lerpVectors(from.eye, eye, eased);
      this.controls.update();
      this.redraw();
      if (share < 1) requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }

  fit() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    const first = !this.fitted;
    this.fitted = true;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (first) this.look("slant");
    this.draw();
  }

  redraw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => this.draw());
  }

  draw() {
    this.asked = false;
    this.renderer.render(this.scene, this.camera);
  }
}
