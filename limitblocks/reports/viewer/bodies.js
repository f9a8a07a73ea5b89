// All blocks as one mesh, their edges as one set of lines: drawn in two calls however many there are.

class Bodies {
  constructor(scene) {
    this.scene = scene;
    const { points, owners, normals, lines, lineOwners } = bodyGeometry(scene);
    this.owners = owners;
    this.rest = points;
    this.lineOwners = lineOwners;
    this.lineRest = lines;
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", dynamic(points));
    geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
    geometry.setAttribute("color", dynamic(points));
    this.material = new THREE.MeshLambertMaterial({
      vertexColors: true,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.edges = lineSet(lines);
    this.before = lineSet(movingLines(scene, lines, lineOwners, null));
    this.before.material.transparent = true;
    this.before.material.opacity = 0.7;
    for (const object of [this.mesh, this.edges, this.before]) object.frustumCulled = false;
    this.edges.renderOrder = 1;
  }

  // Places the blocks at amplitude times the displacements of a step.
  move(step, amplitude) {
    displace(this.scene, step, amplitude, this.rest, this.owners, this.mesh.geometry);
    displace(this.scene, step, amplitude, this.lineRest, this.lineOwners, this.edges.geometry);
  }

  // Lines of the blocks that move in a step, where they were before.
  showBefore(step) {
    const lines = movingLines(this.scene, this.lineRest, this.lineOwners, step);
    this.before.geometry.setAttribute("position", new THREE.BufferAttribute(lines, 3));
  }

  paint(colours) {
    const attribute = this.mesh.geometry.getAttribute("color");
    this.owners.forEach((block, k) => attribute.array.set(colours[block], 3 * k));
    attribute.needsUpdate = true;
  }

  translucent(on, opacity) {
    this.material.transparent = on;
    this.material.depthWrite = !on;
    this.material.opacity = on ? opacity : 1;
    this.material.needsUpdate = true;
    this.edges.material.transparent = on;
    this.edges.material.opacity = on ? Math.min(0.3, 0.3 * Math.sqrt(300 / this.scene.blocks.length)) : 1;
    this.edges.material.needsUpdate = true;
  }

  // Block under a ray, with its distance.
  hit(raycaster) {
    const [hit] = raycaster.intersectObject(this.mesh);
    return hit && { block: this.owners[3 * hit.faceIndex], distance: hit.distance };
  }

  // Largest displacement of each block in a step, over the largest of all.
  travel(step) {
    if (step.travel) return step.travel;
    const out = [0, 0, 0];
    const sizes = this.scene.blocks.map((block, k) => {
      let most = 0;
      const { vertices } = block.shape;
      const c = block.centroid;
      for (let v = 0; v < vertices.length; v += 3) {
        displacement(step, k, c, c[0] + vertices[v], c[1] + vertices[v + 1], c[2] + vertices[v + 2], out);
        most = Math.max(most, Math.hypot(...out));
      }
      return most;
    });
    const largest = sizes.reduce((a, b) => Math.max(a, b), 0);
    step.travel = sizes.map((size) => (largest > 0 ? size / largest : 0));
    return step.travel;
  }
}

function dynamic(values) {
  const attribute = new THREE.BufferAttribute(new Float32Array(values), 3);
  attribute.setUsage(THREE.DynamicDrawUsage);
  return attribute;
}

function lineSet(points) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", dynamic(points));
  return new THREE.LineSegments(geometry, new THREE.LineBasicMaterial());
}

function displace(scene, step, amplitude, rest, owners, geometry) {
  const attribute = geometry.getAttribute("position");
  const moved = attribute.array;
  const out = [0, 0, 0];
  for (let k = 0; k < owners.length; k++) {
    const at = 3 * k;
    const block = owners[k];
    displacement(step, block, scene.blocks[block].centroid, rest[at], rest[at + 1], rest[at + 2], out);
    for (let a = 0; a < 3; a++) moved[at + a] = rest[at + a] + amplitude * out[a];
  }
  attribute.needsUpdate = true;
  geometry.boundingSphere = null;
}

// Triangles with a normal a face, and the edges, each once: of each shape, then copied to its blocks.
function bodyGeometry(scene) {
  const parts = new Map();
  for (const { shape } of scene.blocks) if (!parts.has(shape)) parts.set(shape, shapeGeometry(shape));
  const of = (key) => scene.blocks.map((block, k) => ({ at: block.centroid, values: parts.get(block.shape)[key], k }));
  const bodies = copies(of("points"));
  const edges = copies(of("lines"));
  const normals = copies(of("normals").map((copy) => ({ ...copy, at: [0, 0, 0] })));
  return {
    points: bodies.points,
    normals: normals.points,
    owners: bodies.owners,
    lines: edges.points,
    lineOwners: edges.owners,
  };
}

// Points of all copies, each moved to its place, and whose they are.
function copies(list) {
  const count = list.reduce((sum, { values }) => sum + values.length, 0);
  const points = new Float32Array(count);
  const owners = new Uint32Array(count / 3);
  let next = 0;
  for (const { at, values, k } of list) {
    owners.fill(k, next / 3, (next + values.length) / 3);
    for (let v = 0; v < values.length; v++) points[next + v] = at[v % 3] + values[v];
    next += values.length;
  }
  return { points, owners };
}

function shapeGeometry({ vertices, faces }) {
  const points = [];
  const normals = [];
  const lines = [];
  const at = (v) => vertices.slice(3 * v, 3 * v + 3);
  for (const face of faces) {
    const corners = face.map(at);
    const normal = faceNormal(corners);
    for (let c = 1; c + 1 < corners.length; c++) {
      points.push(...corners[0], ...corners[c], ...corners[c + 1]);
      normals.push(...normal, ...normal, ...normal);
    }
    face.forEach((from, c) => {
      const to = face[(c + 1) % face.length];
      if (from < to) lines.push(...at(from), ...at(to));
    });
  }
  return { points, normals, lines };
}

// Newell's normal of a plane polygon, of length 1.
function faceNormal(corners) {
  const n = [0, 0, 0];
  corners.forEach((p, k) => {
    const q = corners[(k + 1) % corners.length];
    for (let a = 0; a < 3; a++) {
      const b = (a + 1) % 3;
      const c = (a + 2) % 3;
      n[a] += (p[b] - q[b]) * (p[c] + q[c]);
    }
  });
  const size = Math.hypot(...n) || 1;
  return n.map((value) => value / size);
}

function movingLines(scene, lines, owners, step) {
  if (!step) return new Float32Array(0);
  const limit = 1e-3 * step.displacements.reduce((a, b) => Math.max(a, Math.abs(b)), 0);
  const moves = scene.blocks.map((_, k) =>
    step.displacements.subarray(6 * k, 6 * k + 6).some((value) => Math.abs(value) > limit),
  );
  const kept = [];
  owners.forEach((block, k) => {
    if (moves[block]) kept.push(lines[3 * k], lines[3 * k + 1], lines[3 * k + 2]);
  });
  return Float32Array.from(kept);
}
