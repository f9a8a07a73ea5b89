// The data card of what is picked. Text goes in as text, never as markup.

function element(tag, text, attributes = {}) {
  const made = document.createElement(tag);
  if (text !== undefined) made.textContent = text;
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

function digits(value) {
  if (!Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  return size >= 1e5 || size < 1e-3 ? value.toExponential(3) : String(Number(value.toPrecision(4)));
}

function inUnits(value, unit) {
  if (!Number.isFinite(value)) return "–";
  return Math.abs(value) >= 1000 ? `${digits(value / 1000)} k${unit}` : `${digits(value)} ${unit}`;
}

// A point of the picture in global axes, to a hundredth of a millimetre.
function globally(scene, point) {
  return point.map((x, a) => Number((x + scene.origin[a]).toFixed(5)));
}

function place(scene, point) {
  return Number.isFinite(point[0]) ? `${globally(scene, point).join(", ")} m` : "–";
}

function blockCard(scene, k, result, step) {
  const block = scene.blocks[k];
  const rows = [["Kind", block.support ? "support" : "free block"]];
  if (block.layer) rows.push(["Layer", block.layer]);
  if (block.material) rows.push(["Material", block.material]);
  if (block.groups) rows.push(["Groups", block.groups]);
  if (block.colour) rows.push(["Colour", block.colour]);
  if (block.weight !== null) rows.push(["Weight", inUnits(block.weight, "N")]);
  rows.push(["Volume", `${digits(block.volume)} m³`]);
  rows.push(["Centroid", place(scene, block.centroid)]);
  if (step) {
    const u = [...step.displacements.subarray(6 * k, 6 * k + 6)];
    rows.push([result.moves, `${u.slice(0, 3).map(digits).join(", ")} m`]);
    rows.push(["Rotation", `${u.slice(3).map(digits).join(", ")} rad`]);
  }
  const links = [];
  scene.interfaces.forEach((one, at) => {
    if (one.i === k || one.j === k) links.push([one.name, { interface: at }]);
  });
  return { kind: "Block", name: block.name, rows, linked: "Interfaces", links };
}

function interfaceCard(scene, k, result, step) {
  const one = scene.interfaces[k];
  const rows = [["Joint", one.joint]];
  if (step) {
    const [V1, V2, N, M1, M2, T] = step.stresses.subarray(6 * k, 6 * k + 6);
    const name = scene.stateNames[step.states[k]];
    const { letters } = stateSign(name);
    rows.push(["State", letters ? `${name} (${letters})` : name]);
    rows.push(["Utilisation", digits(step.utilisation[k])]);
    rows.push(["Active modes", step.modes[k].map((mode) => scene.modeNames[mode]).join(", ") || "none"]);
    rows.push(["N", inUnits(N, "N"), N < 0 ? "compression" : ""]);
    rows.push(["V1", inUnits(V1, "N")], ["V2", inUnits(V2, "N")], ["T", inUnits(T, "N m")]);
    rows.push(["M1", inUnits(M1, "N m")], ["M2", inUnits(M2, "N m")]);
    const centre = [0, 1, 2].map((a) => one.centroid[a] + step.centres[3 * k + a]);
    rows.push(["Centre of pressure", place(scene, centre)]);
  } else {
    rows.push(["Centroid", place(scene, one.centroid)]);
  }
  const links = [one.i, one.j].map((at) => [scene.blocks[at].name, { block: at }]);
  return { kind: "Interface", name: one.name, rows, linked: "Blocks", links };
}

const LINKS_SHOWN = 12;

class Card {
  constructor(holder, pick) {
    this.holder = holder;
    this.pick = pick;
    holder.querySelector(".close").addEventListener("click", () => pick(null));
  }

  show(card) {
    this.holder.hidden = !card;
    if (!card) return;
    const part = (name) => this.holder.querySelector(name);
    part(".kind").textContent = card.kind;
    part(".name").textContent = card.name;
    part("dl").replaceChildren(
      ...card.rows.flatMap(([term, value, note]) => [
        element("dt", term),
        element("dd", note ? `${value} (${note})` : value),
      ]),
    );
    part(".linked").textContent = card.linked;
    const buttons = card.links.slice(0, LINKS_SHOWN).map(([name, picked]) => {
      const button = element("button", name, { type: "button" });
      button.addEventListener("click", () => this.pick(picked));
      return button;
    });
    const more = card.links.length - LINKS_SHOWN;
    if (more > 0) buttons.push(element("span", `and ${more} more`));
    part(".links").replaceChildren(...buttons);
  }
}
