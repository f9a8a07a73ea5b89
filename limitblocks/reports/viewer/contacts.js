// Interfaces as one coloured mesh with letters, contact forces as arrows, and the thrust line.

const LARGE = 0.9; // share of the forces that are smaller than the one drawn as long as a block

class Contacts {
  constructor(scene, size) {
    this.scene = scene;
    this.size = size;
    const { points, owners } = contactGeometry(scene);
    this.rest = points;
    this.owners = owners;
    this.blocks = owners.map((k) => scene.interfaces[k].i);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", dynamic(points));
    geometry.setAttribute("color", dynamic(points));
    const material = new THREE.MeshBasicMaterial({ vertexColors: true, side: THREE.DoubleSide });
    this.mesh = new THREE.Mesh(geometry, material);
    this.letters = new Letters(scene);
    this.ties = new Ties(scene, size);
    this.arrows = new THREE.InstancedMesh(arrowGeometry(), new THREE.MeshLambertMaterial(), scene.interfaces.length);
    this.thrust = new THREE.InstancedMesh(rodGeometry(), new THREE.MeshBasicMaterial(), thrustCount(scene));
    for (const object of [this.mesh, this.arrows, this.thrust]) object.frustumCulled = false;
    this.thrust.renderOrder = 3;
    this.thrust.material.depthTest = false;
    this.thrust.material.transparent = true; // drawn after the opaque blocks
    this.reference = 1;
  }

  // Follows the blocks; what is not shown stays where it is.
  move(step, amplitude, layers) {
    this.step = step;
    this.largest = this.measure(step).largest;
    this.ties.move(step, amplitude);
    if (layers.interfaces || layers.letters || layers.forces) {
      displace(this.scene, step, amplitude, this.rest, this.blocks, this.mesh.geometry);
    }
    if (layers.letters) this.letters.move(this.scene, step, amplitude);
    if (!layers.forces && !layers.thrust) return;
    this.places = this.scene.interfaces.map((one, k) => this.place(one, k, amplitude));
    if (layers.forces) this.aim();
    if (layers.thrust) this.layThrust();
  }

  // Sizes of the forces of a step: each, the largest, and a large one that many come near.
  measure(step) {
    if (!step.sizes) {
      const each = this.scene.interfaces.map((_, k) => Math.hypot(...this.force(k)));
      const ordered = each.filter((size) => size > 0).sort((x, y) => x - y);
      const largest = ordered.length ? ordered[ordered.length - 1] : 0;
      const large = ordered.length ? ordered[Math.floor(LARGE * (ordered.length - 1))] : 1;
      step.sizes = { each, largest, large };
    }
    return step.sizes;
  }

  // Point of application of an interface's force, moved along with block i.
  place(one, k, amplitude) {
    const centre = [0, 1, 2].map((a) => one.centroid[a] + (this.step.centres[3 * k + a] || 0));
    const out = [0, 0, 0];
    displacement(this.step, one.i, this.scene.blocks[one.i].centroid, ...centre, out);
    return new THREE.Vector3(...centre.map((value, a) => value + amplitude * out[a]));
  }

  // Arrows end where the force acts; their lengths are in proportion to the forces.
  aim() {
    const { each, largest, large } = this.measure(this.step);
    const longest = Math.min((this.reference * largest) / large, 0.25 * this.size);
    const matrix = new THREE.Matrix4();
    let count = 0;
    each.forEach((size, k) => {
      const length = (longest * size) / largest;
      if (!(length > 0.02 * this.reference)) return;
      const direction = new THREE.Vector3(...this.force(k)).multiplyScalar(1 / size);
      if (direction.z > 1e-9) direction.negate(); // handed on downwards
      const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), direction);
      const tail = this.places[k].clone().addScaledVector(direction, -length);
      const width = length ** 0.6 * this.reference ** 0.4; // small forces stay visible
      matrix.compose(tail, turn, new THREE.Vector3(width, length, width));
      this.arrows.setMatrixAt(count, matrix);
      count += 1;
    });
    this.arrows.count = count;
    this.arrows.instanceMatrix.needsUpdate = true;
  }

  force(k) {
    return this.step.forces.subarray(3 * k, 3 * k + 3);
  }

  layThrust() {
    const matrix = new THREE.Matrix4();
    let count = 0;
    for (const chain of this.scene.chains) {
      const ends = chain.map((joint) => this.pressed(joint)).filter((end) => end);
      for (let c = 0; c + 1 < ends.length; c++) {
        const from = ends[c];
        const along = ends[c + 1].clone().sub(from);
        const length = along.length() || 1e-12;
        const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
        const width = 0.003 * this.size;
        matrix.compose(from, turn, new THREE.Vector3(width, length, width));
        this.thrust.setMatrixAt(count, matrix);
        count += 1;
      }
    }
    this.thrust.count = count;
    this.thrust.instanceMatrix.needsUpdate = true;
  }

  // Where the pieces of a joint press together: the mean of their places, by their normal forces.
  pressed(joint) {
    const loaded = joint.filter((k) => Number.isFinite(this.step.centres[3 * k]));
    const normal = (k) => this.step.stresses[6 * k + 2];
    const total = loaded.reduce((sum, k) => sum + normal(k), 0);
    const mean = (sum, k) => sum.addScaledVector(this.places[k], normal(k) / total);
    return total < 0 ? loaded.reduce(mean, new THREE.Vector3()) : null;
  }

  paint(step, colourOf, picked, pickedColour) {
    this.ties.paint(step, picked, pickedColour);
    const attribute = this.mesh.geometry.getAttribute("color");
    const chosen = colourOf(pickedColour);
    const colours = this.scene.stateNames.map((name) => colourOf(stateSign(name).colour));
    this.owners.forEach((k, v) => attribute.array.set(k === picked ? chosen : colours[step.states[k]], 3 * v));
    attribute.needsUpdate = true;
  }

  // Interface under a ray, with its distance.
  hit(raycaster) {
    const [hit] = raycaster.intersectObject(this.mesh);
    const area = hit && { interface: this.owners[3 * hit.faceIndex], distance: hit.distance };
    const tie = this.ties.hit(raycaster);
    return tie && !(area && area.distance < tie.distance) ? tie : area;
  }
}

function contactGeometry(scene) {
  const parts = new Map();
  for (const { outline } of scene.interfaces) if (!parts.has(outline)) parts.set(outline, fan(outline.corners));
  const none = [];
  const values = (one) => (one.hasArea ? parts.get(one.outline) : none);
  return copies(scene.interfaces.map((one, k) => ({ at: one.centroid, values: values(one), k })));
}

// Triangles of a convex polygon.
function fan(corners) {
  const at = (c) => corners.slice(3 * c, 3 * c + 3);
  const points = [];
  for (let c = 1; c + 1 < corners.length / 3; c++) points.push(...at(0), ...at(c), ...at(c + 1));
  return points;
}

function thrustCount(scene) {
  return scene.chains.reduce((sum, chain) => sum + Math.max(chain.length - 1, 0), 0);
}

// Unit arrow from the origin along y, one mesh of shaft and head.
function arrowGeometry() {
  const shaft = new THREE.CylinderGeometry(0.022, 0.022, 0.76, 8, 1, true).translate(0, 0.38, 0);
  const head = new THREE.CylinderGeometry(0, 0.075, 0.24, 12, 1).translate(0, 0.88, 0);
  const geometry = new THREE.BufferGeometry();
  for (const name of ["position", "normal"]) {
    const parts = [shaft, head].map((part) => part.toNonIndexed().getAttribute(name).array);
    geometry.setAttribute(name, new THREE.BufferAttribute(Float32Array.from([...parts[0], ...parts[1]]), 3));
  }
  return geometry;
}

function rodGeometry() {
  return new THREE.CylinderGeometry(1, 1, 1, 8, 1).translate(0, 0.5, 0);
}
