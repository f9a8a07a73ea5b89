// Plays a mechanism to and fro, or a load path step by step.

const PERIOD = 3000; // ms, to and fro
const STEP_TIME = 700; // ms a step of a load path
const STILL_TIME = 1000; // ms a position where no smooth movement is wanted

class Player {
  constructor(button, act) {
    this.button = button;
    this.act = act;
    button.addEventListener("click", () => this.toggle());
  }

  toggle() {
    if (this.timer) this.stop();
    else this.start();
  }

  start() {
    const calm = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
    const begun = performance.now();
    const steps = this.act.steps();
    const frame = () => {
      const time = performance.now() - begun;
      if (steps > 1) this.act.step(Math.floor(time / STEP_TIME) % steps);
      else if (calm) this.act.amplitude([0, 0.5, 1, 0.5][Math.floor(time / STILL_TIME) % 4]);
      else this.act.amplitude(0.5 - 0.5 * Math.cos((2 * Math.PI * time) / PERIOD));
    };
    this.timer = setInterval(() => requestAnimationFrame(frame), steps > 1 || calm ? 100 : 33);
    this.label("Pause", "true");
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.label("Play", "false");
  }

  label(text, pressed) {
    this.button.textContent = text;
    this.button.setAttribute("aria-pressed", pressed);
  }
}
