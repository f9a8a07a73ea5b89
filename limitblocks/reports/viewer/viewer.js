// The picture with its controls: one state, shown anew where it changes.

const MODES = {
  structure: { layers: ["blocks", "edges"], amplitude: 0 },
  mechanism: { layers: ["blocks", "edges", "before"], amplitude: 1 },
  forces: { layers: ["blocks", "edges", "glass", "forces", "thrust"], amplitude: 0 },
  states: { layers: ["blocks", "edges", "glass", "interfaces", "letters"], amplitude: 0 },
};

class Viewer {
  constructor(root, scene, resultAt) {
    this.root = root;
    this.scene = scene;
    const box = boundingBox(scene);
    this.bodies = new Bodies(scene);
    this.contacts = new Contacts(scene, box.diagonal);
    this.marker = new Marker(scene, this.bodies);
    this.stage = new Stage(root.querySelector("canvas"), box, (scene.results[resultAt] || scene).eye);
    const { mesh, edges, before } = this.bodies;
    const { arrows, thrust, letters } = this.contacts;
    this.objects = {
      blocks: [mesh],
      edges: [edges],
      before: [before],
      interfaces: [this.contacts.mesh],
      letters: [letters.points],
      forces: [arrows],
      thrust: [thrust],
    };
    this.stage.scene.add(...Object.values(this.objects).flat(), this.contacts.ties.mesh, this.marker.lines);
    this.triad = new Triad(root.querySelector(".triad"), scene.live);
    this.stage.afterDraw.push(() => this.triad.turn(this.stage.camera));
    this.card = new Card(root.querySelector(".card"), (picked) => this.pick(picked));
    this.arrowLength = arrowLength(scene);
    this.resultAt = resultAt;
    this.stepAt = this.result ? this.result.steps.length - 1 : 0;
    this.scale = 1;
    this.arrowScale = 1;
    this.picked = null;
    this.layers = {};
  }

  get result() {
    return this.scene.results[this.resultAt];
  }

  get step() {
    return this.result && this.result.steps[this.stepAt];
  }

  get drawnAmplitude() {
    return this.result ? this.amplitude * this.scale * this.result.magnification : 0;
  }

  setMode(mode) {
    this.mode = mode;
    this.amplitude = MODES[mode].amplitude;
    this.layers = Object.fromEntries(
      ["blocks", "edges", "glass", "interfaces", "letters", "forces", "thrust", "before"].map((layer) => [
        layer,
        MODES[mode].layers.includes(layer),
      ]),
    );
    this.refresh();
  }

  setResult(at) {
    this.resultAt = at;
    this.stage.eye = this.result.eye;
    this.stepAt = this.result.steps.length - 1;
    this.refresh();
  }

  setStep(at) {
    this.stepAt = at;
    this.refresh();
  }

  // Everything that depends on the result, the mode or the theme.
  refresh() {
    const { step } = this;
    if (step) {
      this.bodies.showBefore(step);
      this.contacts.letters.paint(this.scene, step, linear);
    }
    this.move();
    this.paint();
    this.showCard();
  }

  paint() {
    const palette = PALETTES[theme()];
    this.stage.background(new THREE.Color(palette.page));
    this.bodies.edges.material.color.set(palette.edge);
    this.bodies.before.material.color.set(palette.before);
    this.contacts.arrows.material.color.set(palette.arrow);
    this.contacts.thrust.material.color.set(palette.thrust);
    this.marker.lines.material.color.set(palette.ink);
    this.bodies.paint(blockColours(this, palette));
    if (this.step) this.contacts.paint(this.step, linear, this.picked && this.picked.interface, palette.picked);
    this.bodies.translucent(this.layers.glass, theme() === "dark" ? 0.16 : 0.22);
    for (const [layer, objects] of Object.entries(this.objects)) {
      for (const object of objects) {
        object.visible = Boolean(this.layers[layer] && (this.step || !NEEDS_RESULT.has(layer)));
      }
    }
    if (this.onChange) this.onChange();
  }

  move() {
    if (this.step) {
      this.contacts.reference = this.arrowLength * this.arrowScale;
      this.bodies.move(this.step, this.drawnAmplitude);
      this.contacts.move(this.step, this.drawnAmplitude, this.layers);
    }
    const optics = this.stage.optics();
    const { uniforms } = this.contacts.letters.points.material;
    uniforms.focal.value = optics.focal;
    uniforms.ratio.value = optics.ratio;
    this.marker.mark(this.picked, this.step, this.drawnAmplitude);
    this.stage.draw();
  }

  pick(picked) {
    this.picked = picked;
    this.paint();
    this.move();
    this.showCard();
  }

  showCard() {
    const { picked, scene, result, step } = this;
    if (!picked) return this.card.show(null);
    if ("block" in picked) return this.card.show(blockCard(scene, picked.block, result, step));
    return this.card.show(interfaceCard(scene, picked.interface, result, step));
  }

  // What is under the pointer: an interface where they are shown, otherwise a block.
  under(event) {
    const ray = this.stage.ray(event);
    const contacts = this.layers.interfaces || this.layers.forces || this.layers.letters;
    const body = this.layers.blocks ? this.bodies.hit(ray) : null;
    const contact = contacts ? this.contacts.hit(ray) : null;
    if (contact && (!body || this.layers.glass || contact.distance <= body.distance)) {
      return { interface: contact.interface };
    }
    return body ? { block: body.block } : null;
  }

  find(text) {
    const wanted = text.trim().toLowerCase();
    if (!wanted) return null;
    const names = [
      ...this.scene.blocks.map(({ name }, block) => [name.toLowerCase(), { block }]),
      ...this.scene.interfaces.map(({ name }, at) => [name.toLowerCase(), { interface: at }]),
    ];
    const tests = [(name) => name === wanted, (name) => name.startsWith(wanted), (name) => name.includes(wanted)];
    for (const test of tests) {
      const found = names.find(([name]) => test(name));
      if (found) return found[1];
    }
    return null;
  }

  // The next or the previous of what is picked: blocks or interfaces, in the order of the model.
  pickNext(by) {
    const kind = this.picked && "interface" in this.picked ? "interface" : "block";
    const count = kind === "block" ? this.scene.blocks.length : this.scene.interfaces.length;
    const at = this.picked ? this.picked[kind] + by : 0;
    this.pick({ [kind]: (at + count) % count });
  }
}

const NEEDS_RESULT = new Set(["before", "forces", "thrust", "letters"]);

function linear(colour) {
  return new THREE.Color(colour).toArray();
}

// Stones differ a little, so that courses can be read; what moves is tinted by how far.
function blockColours(viewer, palette) {
  const [stone, support, moving, chosen] = ["stone", "support", "moving", "picked"].map(
    (key) => new THREE.Color(palette[key]),
  );
  const travel = viewer.step && viewer.mode === "mechanism" ? viewer.bodies.travel(viewer.step) : null;
  return viewer.scene.blocks.map((block, k) => {
    if (viewer.picked && viewer.picked.block === k) return chosen.toArray();
    if (block.support) return support.toArray();
    const shade = 0.93 + 0.14 * ((Math.imul(k + 1, 2654435761) >>> 16) / 65536);
    const colour = stone.clone().multiplyScalar(shade);
    if (travel && travel[k] > 1e-3) colour.lerp(moving, 0.25 + 0.75 * travel[k]);
    return colour.toArray();
  });
}

// Length drawn for a large force, but not the largest: about a block.
function arrowLength(scene) {
  const free = scene.blocks.filter((block) => !block.support);
  return free.reduce((sum, block) => sum + Math.cbrt(block.volume), 0) / Math.max(free.length, 1);
}
