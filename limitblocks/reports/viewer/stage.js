// Camera, light and drawing: renders when something changed, never otherwise.

const VIEWS = {
  front: [0, -1, 0],
  side: [1, 0, 0],
  top: [0, -1e-4, 1],
};
const FIELD_OF_VIEW = 20; // degrees

class Stage {
  constructor(canvas, box, eye) {
    this.canvas = canvas;
    this.box = box;
    this.eye = eye;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(FIELD_OF_VIEW, 1, box.diagonal / 200, box.diagonal * 30);
    this.camera.up.set(0, 0, 1);
    this.sky = new THREE.HemisphereLight("#ffffff", "#a39c93", 1.9);
    this.sky.position.set(0, 0, 1);
    this.lamp = new THREE.DirectionalLight("#fffaf2", 2.2);
    this.camera.add(this.lamp);
    this.lamp.position.set(-0.6, 0.9, 1);
    this.lamp.target = this.camera;
    this.lamp.target.position.set(0, 0, 0);
    this.scene.add(this.sky, this.camera);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false; // no movement that the user does not make
    this.controls.zoomToCursor = true;
    this.controls.minDistance = box.diagonal / 50;
    this.controls.maxDistance = box.diagonal * 8;
    this.controls.addEventListener("change", () => this.draw());
    this.afterDraw = [];
    new ResizeObserver(() => this.resize()).observe(canvas);
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (!clientWidth || !clientHeight) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    if (this.view) this.look(this.view);
    else this.drawNow();
  }

  // Looks at the whole structure from a named view.
  look(name) {
    this.view = name;
    const { low, high } = this.box;
    const towards = new THREE.Vector3(...(name === "iso" ? this.eye : VIEWS[name])).normalize();
    const right = new THREE.Vector3(0, 0, 1).cross(towards).normalize();
    const up = towards.clone().cross(right);
    const middle = new THREE.Vector3(...low.map((value, k) => (value + high[k]) / 2));
    const tall = Math.tan((FIELD_OF_VIEW * Math.PI) / 360) * 0.92;
    const wide = tall * this.camera.aspect;
    const corners = boxCorners(this.box).map((corner) => corner.sub(middle));
    const distance = fit(corners, middle, { towards, right, up, wide, tall });
    this.controls.target.copy(middle);
    this.camera.position.copy(middle).addScaledVector(towards, distance);
    this.controls.update();
    this.draw();
  }

  // Turns by angles, in radians, as the arrow keys do.
  turn(across, up) {
    this.view = null;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const flat = Math.hypot(offset.x, offset.y);
    const distance = offset.length();
    const azimuth = Math.atan2(offset.y, offset.x) + across;
    const height = Math.min(Math.max(Math.atan2(offset.z, flat) + up, -1.57), 1.57);
    offset.set(Math.cos(azimuth) * Math.cos(height), Math.sin(azimuth) * Math.cos(height), Math.sin(height));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, distance);
    this.controls.update();
  }

  // Moves the picture by shares of its height.
  shift(across, up) {
    this.view = null;
    const distance = this.camera.position.distanceTo(this.controls.target);
    const size = 2 * distance * Math.tan((FIELD_OF_VIEW * Math.PI) / 360);
    const move = new THREE.Vector3(-across * size, -up * size, 0).applyQuaternion(this.camera.quaternion);
    this.camera.position.add(move);
    this.controls.target.add(move);
    this.controls.update();
  }

  zoom(factor) {
    this.view = null;
    const offset = this.camera.position.clone().sub(this.controls.target).divideScalar(factor);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
  }

  background(colour) {
    this.renderer.setClearColor(colour);
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => this.drawNow());
  }

  drawNow() {
    this.waiting = false;
    this.renderer.render(this.scene, this.camera);
    this.afterDraw.forEach((then) => then());
  }

  // Pixels per metre at a distance of one metre, and pixels of the screen per pixel of the page.
  optics() {
    const focal = this.canvas.height / (2 * Math.tan((FIELD_OF_VIEW * Math.PI) / 360));
    return { focal, ratio: this.renderer.getPixelRatio() };
  }

  ray(event) {
    const area = this.canvas.getBoundingClientRect();
    const x = ((event.clientX - area.left) / area.width) * 2 - 1;
    const y = 1 - ((event.clientY - area.top) / area.height) * 2;
    this.camera.updateMatrixWorld(); // it may have moved since the last frame
    const raycaster = new THREE.Raycaster();
    raycaster.setFromCamera(new THREE.Vector2(x, y), this.camera);
    return raycaster;
  }

  savePicture(name) {
    this.drawNow(); // what was drawn before is gone by now
    this.canvas.toBlob((blob) => saveBlob(blob, name));
  }
}

function boxCorners({ low, high }) {
  return [...Array(8).keys()].map(
    (corner) => new THREE.Vector3(...low.map((value, k) => ((corner >> k) & 1 ? high[k] : value))),
  );
}

// Least distance at which all corners are seen; moves `middle` so that they fill the picture evenly.
function fit(corners, middle, { towards, right, up, wide, tall }) {
  let distance = 0;
  for (let round = 0; round < 4; round++) {
    distance = 0;
    for (const at of corners) {
      const reach = Math.max(Math.abs(at.dot(right)) / wide, Math.abs(at.dot(up)) / tall);
      distance = Math.max(distance, reach + at.dot(towards));
    }
    for (const axis of [right, up]) {
      const slopes = corners.map((at) => at.dot(axis) / (distance - at.dot(towards)));
      const shift = axis.clone().multiplyScalar(((Math.max(...slopes) + Math.min(...slopes)) / 2) * distance);
      middle.add(shift);
      corners.forEach((at) => at.sub(shift));
    }
  }
  return distance * 1.03;
}

function saveBlob(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
