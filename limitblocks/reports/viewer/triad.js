// The global axes and the live load's direction, in a corner of the picture.

const SVG = "http://www.w3.org/2000/svg";

class Triad {
  constructor(holder, live) {
    const drawing = document.createElementNS(SVG, "svg");
    drawing.setAttribute("viewBox", "-78 -66 156 132");
    holder.append(drawing);
    this.rods = [
      ["X", [1, 0, 0], "x"],
      ["Y", [0, 1, 0], "y"],
      ["Z", [0, 0, 1], "z"],
      ...(live ? [["live", live, "live"]] : []),
    ].map(([label, vector, kind]) => ({ vector: new THREE.Vector3(...vector), ...rod(drawing, label, kind) }));
  }

  turn(camera) {
    const flat = this.rods.map(({ vector }) => vector.clone().transformDirection(camera.matrixWorldInverse));
    this.rods.forEach(({ line, text, group }, k) => {
      const reach = 34;
      const below = text.textContent === "live" ? 18 : 4; // it may lie along an axis
      line.setAttribute("x2", reach * flat[k].x);
      line.setAttribute("y2", -reach * flat[k].y);
      text.setAttribute("x", 1.32 * reach * flat[k].x);
      text.setAttribute("y", -1.32 * reach * flat[k].y + below);
      group.setAttribute("opacity", flat[k].z < -0.3 ? 0.55 : 1);
    });
  }
}

function rod(holder, label, kind) {
  const group = document.createElementNS(SVG, "g");
  const line = document.createElementNS(SVG, "line");
  const text = document.createElementNS(SVG, "text");
  group.setAttribute("class", `rod-${kind}`);
  text.textContent = label;
  group.append(line, text);
  holder.append(group);
  return { group, line, text };
}
