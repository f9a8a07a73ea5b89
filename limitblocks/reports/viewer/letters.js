// Letters on the interfaces that flow, so that a state is read without its colour.

const LETTER_CELL = 64; // pixels of a letter in the atlas
const LETTER_VERTEX = `
  attribute float cell;
  attribute vec3 tint;
  attribute float size;
  uniform float focal;
  uniform float ratio;
  varying float vCell;
  varying vec3 vTint;
  void main() {
    vCell = cell;
    vTint = tint;
    vec4 place = modelViewMatrix * vec4(position, 1.0);
    gl_Position = projectionMatrix * place;
    gl_PointSize = clamp(size * focal / -place.z, 9.0 * ratio, 26.0 * ratio);
  }`;
const LETTER_FRAGMENT = `
  uniform sampler2D atlas;
  uniform float cells;
  varying float vCell;
  varying vec3 vTint;
  void main() {
    vec2 at = gl_PointCoord;
    float edge = 2.0 * distance(at, vec2(0.5));
    if (edge > 1.0) discard;
    float ink = texture2D(atlas, vec2((vCell + at.x) / cells, 1.0 - at.y)).r;
    vec3 colour = mix(vTint, vec3(1.0), max(ink, smoothstep(0.82, 0.9, edge)));
    gl_FragColor = vec4(colour, 1.0);
    #include <colorspace_fragment>
  }`;

class Letters {
  constructor(scene) {
    this.owners = [];
    const canvas = letterAtlas(scene.stateNames);
    const material = new THREE.ShaderMaterial({
      vertexShader: LETTER_VERTEX,
      fragmentShader: LETTER_FRAGMENT,
      depthTest: false,
      transparent: true, // drawn after the blocks
      uniforms: {
        atlas: { value: new THREE.CanvasTexture(canvas) },
        cells: { value: scene.stateNames.length },
        focal: { value: 1 },
        ratio: { value: 1 },
      },
    });
    this.points = new THREE.Points(new THREE.BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 4;
  }

  paint(scene, step, colourOf) {
    this.owners = [];
    step.states.forEach((state, k) => {
      if (scene.interfaces[k].hasArea && stateSign(scene.stateNames[state]).letters) this.owners.push(k);
    });
    const states = this.owners.map((k) => step.states[k]);
    const tints = states.flatMap((state) => colourOf(stateSign(scene.stateNames[state]).colour));
    const sizes = this.owners.map((k) => 0.45 * outlineSize(scene.interfaces[k].outline.corners));
    const { geometry } = this.points;
    geometry.setAttribute("position", dynamic(new Float32Array(3 * this.owners.length)));
    geometry.setAttribute("cell", new THREE.BufferAttribute(Float32Array.from(states), 1));
    geometry.setAttribute("tint", new THREE.BufferAttribute(Float32Array.from(tints), 3));
    geometry.setAttribute("size", new THREE.BufferAttribute(Float32Array.from(sizes), 1));
  }

  move(scene, step, amplitude) {
    const attribute = this.points.geometry.getAttribute("position");
    if (!attribute) return;
    const out = [0, 0, 0];
    this.owners.forEach((k, at) => {
      const one = scene.interfaces[k];
      displacement(step, one.i, scene.blocks[one.i].centroid, ...one.centroid, out);
      for (let a = 0; a < 3; a++) attribute.array[3 * at + a] = one.centroid[a] + amplitude * out[a];
    });
    attribute.needsUpdate = true;
  }
}

function outlineSize(corners) {
  let most = 0;
  for (let c = 0; c < corners.length; c += 3) {
    most = Math.max(most, Math.hypot(corners[c], corners[c + 1], corners[c + 2]));
  }
  return most;
}

function letterAtlas(names) {
  const canvas = document.createElement("canvas");
  canvas.width = LETTER_CELL * names.length;
  canvas.height = LETTER_CELL;
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#000";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.fillStyle = "#fff";
  pen.textAlign = "center";
  pen.textBaseline = "middle";
  names.forEach((name, k) => {
    const { letters } = stateSign(name);
    pen.font = `700 ${letters.length > 1 ? 30 : 40}px system-ui, sans-serif`;
    pen.fillText(letters, (k + 0.5) * LETTER_CELL, LETTER_CELL / 2 + 2);
  });
  return canvas;
}
