// Outline of what is picked; for an interface also its local axes s1, s2 and n.

class Marker {
  constructor(scene, bodies) {
    this.scene = scene;
    this.bodies = bodies;
    this.lines = lineSet(new Float32Array(0));
    this.lines.material.depthTest = false;
    this.lines.material.transparent = true;
    this.lines.renderOrder = 5;
    this.lines.frustumCulled = false;
  }

  mark(picked, step, amplitude) {
    this.lines.visible = Boolean(picked);
    if (!picked) return;
    const block = "block" in picked ? picked.block : this.scene.interfaces[picked.interface].i;
    const points = "block" in picked ? this.edgesOf(block) : this.outlineOf(picked.interface);
    const moved = Float32Array.from(points);
    const out = [0, 0, 0];
    for (let at = 0; step && at < moved.length; at += 3) {
      displacement(step, block, this.scene.blocks[block].centroid, points[at], points[at + 1], points[at + 2], out);
      for (let a = 0; a < 3; a++) moved[at + a] += amplitude * out[a];
    }
    this.lines.geometry.setAttribute("position", new THREE.BufferAttribute(moved, 3));
  }

  edgesOf(block) {
    const points = [];
    this.bodies.lineOwners.forEach((owner, k) => {
      if (owner === block) points.push(...this.bodies.lineRest.subarray(3 * k, 3 * k + 3));
    });
    return points;
  }

  outlineOf(k) {
    const { centroid, outline } = this.scene.interfaces[k];
    const { corners, axes } = outline;
    const count = corners.length / 3;
    const at = (c) => [0, 1, 2].map((a) => centroid[a] + corners[3 * (c % count) + a]);
    const points = [];
    for (let c = 0; c < count; c++) points.push(...at(c), ...at(c + 1));
    const size = 0.8 * outlineSize(corners);
    for (let row = 0; row < 3; row++) {
      points.push(...centroid, ...centroid.map((value, a) => value + size * axes[3 * row + a]));
    }
    return points;
  }
}
