// Buttons, sliders and keys of the viewer.

class Panel {
  constructor(root, viewer) {
    this.root = root;
    this.viewer = viewer;
    this.motion = root.querySelector("[name=motion]");
    this.stepSlider = root.querySelector("[name=step]");
    this.player = new Player(root.querySelector("[name=play]"), {
      steps: () => (viewer.result ? viewer.result.steps.length : 1),
      step: (at) => this.goTo(at),
      amplitude: (value) => this.setMotion(value),
    });
    this.wireChoices();
    this.wireSliders();
    this.wireButtons();
    this.wireCanvas();
    viewer.onChange = () => this.refresh();
  }

  wireChoices() {
    const { root, viewer } = this;
    for (const input of root.querySelectorAll("[name=mode]")) {
      input.addEventListener("change", () => this.setMode(input.value));
    }
    for (const input of root.querySelectorAll("[name=layer]")) {
      input.addEventListener("change", () => {
        viewer.layers[input.value] = input.checked;
        viewer.move();
        viewer.paint();
      });
    }
    root.querySelector("[name=result]").addEventListener("change", (event) => {
      this.player.stop();
      viewer.setResult(Number(event.target.value));
    });
  }

  setMode(mode) {
    this.player.stop();
    this.viewer.setMode(mode);
  }

  wireSliders() {
    const { root, viewer } = this;
    this.motion.addEventListener("input", () => {
      this.player.stop();
      this.setMotion(this.motion.value / 100);
    });
    this.stepSlider.addEventListener("input", () => {
      this.player.stop();
      this.goTo(Number(this.stepSlider.value));
    });
    root.querySelector("[name=scale]").addEventListener("input", (event) => {
      viewer.scale = 2 ** Number(event.target.value);
      viewer.move();
    });
    root.querySelector("[name=arrows]").addEventListener("input", (event) => {
      viewer.arrowScale = 2 ** Number(event.target.value);
      viewer.move();
    });
  }

  setMotion(value) {
    this.viewer.amplitude = value;
    this.motion.value = Math.round(100 * value);
    this.motion.setAttribute("aria-valuetext", `${this.motion.value} %`);
    this.viewer.move();
  }

  goTo(step) {
    if (step !== this.viewer.stepAt) this.viewer.setStep(step);
  }

  wireButtons() {
    const { root, viewer } = this;
    for (const button of root.querySelectorAll("[data-view]")) {
      button.addEventListener("click", () => viewer.stage.look(button.dataset.view));
    }
    root.querySelector("[name=png]").addEventListener("click", () => viewer.stage.savePicture("structure.png"));
    root.querySelector("[name=full]").addEventListener("click", () => {
      if (document.fullscreenElement) document.exitFullscreen();
      else root.requestFullscreen();
    });
    root.querySelector("form").addEventListener("submit", (event) => {
      event.preventDefault();
      const field = root.querySelector("[name=find]");
      const found = viewer.find(field.value);
      field.setCustomValidity(found ? "" : "No block or interface has this in its name.");
      if (found) viewer.pick(found);
      else field.reportValidity();
    });
    root.querySelector("[name=find]").addEventListener("input", (event) => event.target.setCustomValidity(""));
  }

  wireCanvas() {
    const { canvas } = this.viewer.stage;
    let pressed = null;
    canvas.addEventListener("pointerdown", (event) => {
      pressed = [event.clientX, event.clientY];
      this.viewer.stage.view = null;
    });
    canvas.addEventListener("wheel", () => (this.viewer.stage.view = null), { passive: true });
    canvas.addEventListener("pointerup", (event) => {
      const still = pressed && Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) < 5;
      pressed = null;
      if (still && event.button === 0) this.viewer.pick(this.viewer.under(event));
    });
    canvas.addEventListener("keydown", (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      const act = this.keys()[(event.shiftKey && event.key.startsWith("Arrow") ? "Shift+" : "") + event.key];
      if (!act) return;
      event.preventDefault();
      act();
    });
  }

  keys() {
    const { viewer, player } = this;
    const { stage } = viewer;
    return {
      ArrowLeft: () => stage.turn(-0.1, 0),
      ArrowRight: () => stage.turn(0.1, 0),
      ArrowUp: () => stage.turn(0, 0.1),
      ArrowDown: () => stage.turn(0, -0.1),
      "Shift+ArrowLeft": () => stage.shift(-0.05, 0),
      "Shift+ArrowRight": () => stage.shift(0.05, 0),
      "Shift+ArrowUp": () => stage.shift(0, 0.05),
      "Shift+ArrowDown": () => stage.shift(0, -0.05),
      "+": () => stage.zoom(1.2),
      "=": () => stage.zoom(1.2),
      "-": () => stage.zoom(1 / 1.2),
      1: () => stage.look("front"),
      2: () => stage.look("side"),
      3: () => stage.look("top"),
      0: () => stage.look("iso"),
      n: () => viewer.pickNext(1),
      p: () => viewer.pickNext(-1),
      " ": () => viewer.result && player.toggle(),
      Escape: () => viewer.pick(null),
    };
  }

  // Shows in the controls what the viewer shows.
  refresh() {
    const { root, viewer } = this;
    for (const input of root.querySelectorAll("[name=mode]")) input.checked = input.value === viewer.mode;
    for (const input of root.querySelectorAll("[name=layer]")) input.checked = viewer.layers[input.value];
    const many = Boolean(viewer.result) && viewer.result.steps.length > 1;
    root.querySelector(".steps").hidden = !many;
    if (many) {
      this.stepSlider.max = viewer.result.steps.length - 1;
      this.stepSlider.value = viewer.stepAt;
      this.stepSlider.setAttribute("aria-valuetext", viewer.step.label);
    }
    root.querySelector(".label").textContent = viewer.step ? `${viewer.result.title}, ${viewer.step.label}` : "";
    this.motion.value = Math.round(100 * viewer.amplitude);
    root.querySelector(".arrow-size").hidden = !viewer.layers.forces;
    showLegend(root.querySelector(".legend"), legendRows(viewer.scene, viewer));
  }
}
