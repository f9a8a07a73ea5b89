// What the colours and signs of the picture mean.

function legendRows(scene, view) {
  const { layers, step, contacts } = view;
  const rows = [];
  if (layers.blocks && !layers.glass) {
    rows.push({ swatch: "stone", text: "free block" }, { swatch: "support", text: "support" });
    if (step && view.mode === "mechanism") rows.push({ swatch: "ramp", text: "moves: little to most" });
  }
  if (step && layers.before) rows.push({ swatch: "before", text: "before moving" });
  if (step && layers.forces) {
    rows.push({ swatch: "arrow", text: `contact force, drawn downwards; largest ${inUnits(contacts.largest, "N")}` });
  }
  if (step && layers.thrust && scene.chains.length) rows.push({ swatch: "thrust", text: "line of thrust" });
  if (step && !layers.interfaces) rows.push(...tieRows(scene, step));
  if (step && layers.interfaces) rows.push(...stateRows(scene, step));
  return rows;
}

function stateRows(scene, step) {
  const counts = scene.stateNames.map(() => 0);
  for (const state of step.states) counts[state] += 1;
  return scene.stateNames
    .map((name, k) => ({ state: stateSign(name), text: `${name} (${counts[k]})`, count: counts[k] }))
    .filter((row) => row.count > 0);
}

// Ties are always seen; where the states of all interfaces are not told, theirs are.
function tieRows(scene, step) {
  const states = new Set(step.states.filter((_, k) => scene.interfaces[k].length > 0));
  return [...states].map((state) => {
    const name = scene.stateNames[state];
    return { state: { colour: stateSign(name).colour, letters: "" }, text: `tie: ${name}` };
  });
}

function showLegend(holder, rows) {
  holder.replaceChildren(
    ...rows.map(({ swatch, state, text }) => {
      const item = element("li", text);
      const sign = element("span", state ? state.letters : "", { "aria-hidden": "true", class: swatch || "state" });
      if (state) sign.style.backgroundColor = state.colour;
      item.prepend(sign);
      return item;
    }),
  );
}
