// Tables that sort by a click or a key on a head, and the interfaces of a result as CSV.

function startTables() {
  for (const table of document.querySelectorAll("table.sortable")) {
    [...table.tHead.rows[0].cells].forEach((head, column) => {
      const button = element("button", head.textContent, { type: "button" });
      head.replaceChildren(button);
      button.addEventListener("click", () => sortTable(table, head, column));
    });
  }
}

function sortTable(table, head, column) {
  const falling = head.getAttribute("aria-sort") === "descending";
  const sign = falling ? 1 : -1; // the largest first, then the smallest
  const key = (row) => {
    const cell = row.cells[column];
    return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
  };
  const order = (a, b) => (typeof a === "number" ? a - b : a.localeCompare(b, "en", { numeric: true }));
  const rows = [...table.tBodies[0].rows].map((row) => [key(row), row]);
  rows.sort(([a], [b]) => sign * order(a, b));
  table.tBodies[0].append(...rows.map(([, row]) => row));
  for (const cell of table.tHead.rows[0].cells) cell.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", falling ? "ascending" : "descending");
}

// A name that begins like a formula would be run as one by spreadsheets.
function csvText(text) {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\r\n]/.test(safe) ? `"${safe.replace(/"/g, '""')}"` : safe;
}

const CSV_HEADS =
  "interface,block i,block j,joint,centroid X (m),centroid Y (m),centroid Z (m),state,utilisation,V1 (N),V2 (N),N (N),M1 (N m),M2 (N m),T (N m)," +
  "centre of pressure X (m),centre of pressure Y (m),centre of pressure Z (m),active modes";

function interfacesCsv(scene, step) {
  const number = (value) => (Number.isFinite(value) ? String(Number(value.toPrecision(6))) : "");
  const lines = scene.interfaces.map((one, k) => {
    const centre = [0, 1, 2].map((a) => one.centroid[a] + step.centres[3 * k + a]);
    const at = (point) => globally(scene, point).map((value) => (Number.isFinite(value) ? String(value) : ""));
    const modes = step.modes[k].map((mode) => scene.modeNames[mode]).join("; ");
    return [
      ...[one.name, scene.blocks[one.i].name, scene.blocks[one.j].name, one.joint].map(csvText),
      ...at(one.centroid),
      csvText(scene.stateNames[step.states[k]]),
      ...[step.utilisation[k], ...step.stresses.subarray(6 * k, 6 * k + 6)].map(number),
      ...at(centre),
      csvText(modes),
    ].join(",");
  });
  return `${[CSV_HEADS, ...lines].join("\r\n")}\r\n`;
}

function startCsv(scene) {
  for (const button of document.querySelectorAll("button[data-csv]")) {
    const result = scene.results[Number(button.dataset.csv)];
    button.hidden = false;
    button.addEventListener("click", () => {
      const csv = interfacesCsv(scene, result.steps[result.steps.length - 1]);
      saveBlob(new Blob([csv], { type: "text/csv" }), `interfaces ${result.title.toLowerCase()}.csv`);
    });
  }
}
