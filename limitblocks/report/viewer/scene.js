// The scene of the report, as the page carries it: blocks, interfaces and results as typed arrays.

function readScene() {
  const data = JSON.parse(document.getElementById("scene").textContent);
  const { blocks, interfaces } = data;
  const support = new Set(blocks.support);
  return {
    title: data.title,
    live: data.live,
    chains: data.chains,
    joints: data.joints,
    stateNames: data.states,
    modeNames: data.modes,
    results: data.results.map((result) => ({ ...result, steps: result.steps.map(readStep) })),
    blocks: blocks.name.map((name, k) => ({
      name,
      support: support.has(k),
      weight: blocks.weight[k],
      volume: blocks.volume[k],
      centroid: blocks.centroid.slice(3 * k, 3 * k + 3),
      shape: data.shapes[blocks.shape[k]],
    })),
    interfaces: interfaces.i.map((i, k) => ({
      name: `${blocks.name[i]}|${blocks.name[interfaces.j[k]]}`,
      i,
      j: interfaces.j[k],
      joint: data.joints[interfaces.joint[k]],
      centroid: interfaces.centroid.slice(3 * k, 3 * k + 3),
      outline: data.outlines[interfaces.outline[k]],
    })),
  };
}

function readStep(step) {
  const numbers = (values) => Float64Array.from(values, (value) => (value === null ? NaN : value));
  return {
    ...step,
    displacements: numbers(step.displacements),
    stresses: numbers(step.stress_resultants),
    forces: numbers(step.forces),
    centres: numbers(step.centres),
    utilisation: numbers(step.utilisation),
  };
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

function boundingBox(scene) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const block of scene.blocks) {
    for (let k = 0; k < block.shape.vertices.length; k++) {
      const value = block.centroid[k % 3] + block.shape.vertices[k];
      low[k % 3] = Math.min(low[k % 3], value);
      high[k % 3] = Math.max(high[k % 3], value);
    }
  }
  return { low, high, diagonal: Math.hypot(...high.map((value, k) => value - low[k])) };
}
