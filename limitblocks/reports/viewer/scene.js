// The scene of the report, as the page carries it: blocks, interfaces and results as typed arrays.

function readScene() {
  const data = JSON.parse(document.getElementById("scene").textContent);
  const { blocks, interfaces } = data;
  const support = new Set(blocks.support);
  const lengths = new Map(data.ties);
  const named = new Map(data.named);
  const withoutArea = new Set(data.without_area);
  const scene = {
    title: data.title,
    live: data.live,
    origin: data.origin, // of all centroids, in global axes
    eye: data.eye,
    chains: data.chains,
    joints: data.joints,
    stateNames: data.states,
    modeNames: data.modes,
    blocks: blocks.name.map((name, k) => ({
      name,
      support: support.has(k),
      weight: blocks.weight[k],
      volume: blocks.volume[k],
      layer: blocks.layer[k],
      material: blocks.material[k],
      groups: blocks.groups[k],
      colour: blocks.colour[k],
      centroid: blocks.centroid.slice(3 * k, 3 * k + 3),
      shape: data.shapes[blocks.shape[k]],
    })),
    interfaces: interfaces.i.map((i, k) => ({
      name: named.get(k) || `${blocks.name[i]}|${blocks.name[interfaces.j[k]]}`,
      i,
      j: interfaces.j[k],
      joint: data.joints[interfaces.joint[k]],
      centroid: interfaces.centroid.slice(3 * k, 3 * k + 3),
      outline: data.outlines[interfaces.outline[k]],
      length: lengths.get(k) || 0, // of a tie
      hasArea: !withoutArea.has(k),
    })),
  };
  scene.results = data.results.map((result) => ({
    ...result,
    steps: result.steps.map((step) => readStep(step, scene.interfaces)),
  }));
  return scene;
}

function readStep(step, interfaces) {
  const numbers = (values) => Float64Array.from(values, (value) => (value === null ? NaN : value));
  const stresses = numbers(step.stress_resultants);
  const { forces, centres } = contactForces(interfaces, stresses);
  return {
    ...step,
    displacements: numbers(step.displacements),
    utilisation: numbers(step.utilisation),
    stresses,
    forces,
    centres,
  };
}

// Force of block i on block j, global axes, and where it acts, (e1, e2) = (-M2, M1) / N off the centroid.
function contactForces(interfaces, stresses) {
  const forces = new Float64Array(3 * interfaces.length);
  const centres = new Float64Array(3 * interfaces.length);
  interfaces.forEach(({ outline: { axes } }, k) => {
    const [V1, V2, N, M1, M2] = stresses.subarray(6 * k, 6 * k + 6);
    for (let a = 0; a < 3; a++) {
      forces[3 * k + a] = -(V1 * axes[a] + V2 * axes[3 + a] + N * axes[6 + a]);
      centres[3 * k + a] = N < 0 ? (-M2 * axes[a] + M1 * axes[3 + a]) / N : NaN;
    }
  });
  return { forces, centres };
}

// Displacement of the point (x, y, z) of a block: translation and rotation about the centroid, small.
function displacement(step, block, centroid, x, y, z, out) {
  const u = step.displacements;
  const at = 6 * block;
  const rx = x - centroid[0];
  const ry = y - centroid[1];
  const rz = z - centroid[2];
  out[0] = u[at] + u[at + 4] * rz - u[at + 5] * ry;
  out[1] = u[at + 1] + u[at + 5] * rx - u[at + 3] * rz;
  out[2] = u[at + 2] + u[at + 3] * ry - u[at + 4] * rx;
}

// Box around the structure, and around where it is drawn at the usual scale.
function boundingBox(scene) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  const out = [0, 0, 0];
  const include = (point, result) => {
    const scale = result ? result.magnification : 0;
    for (let a = 0; a < 3; a++) {
      low[a] = Math.min(low[a], point[a] + scale * out[a]);
      high[a] = Math.max(high[a], point[a] + scale * out[a]);
    }
  };
  scene.blocks.forEach((block, k) => {
    const c = block.centroid;
    for (let v = 0; v < block.shape.vertices.length; v += 3) {
      const point = [0, 1, 2].map((a) => c[a] + block.shape.vertices[v + a]);
      include(point);
      for (const result of scene.results) {
        displacement(result.steps[result.steps.length - 1], k, c, ...point, out);
        include(point, result);
      }
    }
  });
  for (const one of scene.interfaces) {
    if (one.length > 0) for (const { point } of anchors(one)) include(point);
  }
  return { low, high, diagonal: Math.hypot(...high.map((value, k) => value - low[k])) };
}
