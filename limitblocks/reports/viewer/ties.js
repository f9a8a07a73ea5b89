// Ties as rods from anchor to anchor, each end moved along with its block.

class Ties {
  constructor(scene, size) {
    this.scene = scene;
    this.width = 0.003 * size;
    this.lines = scene.interfaces.flatMap((one, k) => (one.length > 0 ? [{ k, ends: anchors(one) }] : []));
    this.mesh = new THREE.InstancedMesh(rodGeometry(), new THREE.MeshBasicMaterial(), this.lines.length);
    this.mesh.frustumCulled = false;
    this.move(null, 0);
    this.lines.forEach((_, at) => this.mesh.setColorAt(at, new THREE.Color(stateSign("stick").colour)));
  }

  move(step, amplitude) {
    const matrix = new THREE.Matrix4();
    this.lines.forEach(({ ends }, at) => {
      const [from, to] = ends.map(({ block, point }) => this.place(step, amplitude, block, point));
      const along = to.clone().sub(from);
      const length = along.length();
      const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
      matrix.compose(from, turn, new THREE.Vector3(this.width, length, this.width));
      this.mesh.setMatrixAt(at, matrix);
    });
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.boundingSphere = null; // a ray looks there first
  }

  place(step, amplitude, block, point) {
    const out = [0, 0, 0];
    if (step) displacement(step, block, this.scene.blocks[block].centroid, ...point, out);
    return new THREE.Vector3(...point.map((value, a) => value + amplitude * out[a]));
  }

  paint(step, picked, pickedColour) {
    this.lines.forEach(({ k }, at) => {
      const colour = k === picked ? pickedColour : stateSign(this.scene.stateNames[step.states[k]]).colour;
      this.mesh.setColorAt(at, new THREE.Color(colour));
    });
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  // Tie under a ray, with its distance.
  hit(raycaster) {
    const [hit] = raycaster.intersectObject(this.mesh);
    return hit && { interface: this.lines[hit.instanceId].k, distance: hit.distance };
  }
}

// Anchors of a tie: half its length off the centroid along the normal, the first in block i.
function anchors({ i, j, centroid, length, outline: { axes } }) {
  const at = (side) => centroid.map((value, a) => value + side * (length / 2) * axes[6 + a]);
  return [
    { block: i, point: at(-1) },
    { block: j, point: at(1) },
  ];
}
