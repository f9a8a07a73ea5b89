// Colours of the picture, light and dark, and the sign of each interface state: a colour and letters.

const PALETTES = {
  light: {
    page: "#f4f6f8",
    stone: "#d9d0c1",
    support: "#8d949c",
    moving: "#e0712f",
    edge: "#2b2a28",
    before: "#7b8490",
    arrow: "#1f5fa8",
    thrust: "#c2185b",
    picked: "#ffd400",
    ink: "#1c1f24",
  },
  dark: {
    page: "#1b1f24",
    stone: "#a79f92",
    support: "#5a626b",
    moving: "#ff8a3d",
    edge: "#0b0c0e",
    before: "#76808c",
    arrow: "#6db3ff",
    thrust: "#ff5c9a",
    picked: "#ffe14d",
    ink: "#e6e9ed",
  },
};

// Colours after Okabe and Ito, told apart by colour-blind eyes; letters for those who see none.
const STATES = {
  stick: { colour: "#8f99a5", letters: "" },
  open: { colour: "#56b4e9", letters: "O" },
  slide: { colour: "#0072b2", letters: "S" },
  twist: { colour: "#9a4fb0", letters: "T" },
  "slide-twist": { colour: "#008f68", letters: "ST" },
  hinge: { colour: "#e69f00", letters: "H" },
  yield: { colour: "#a6093d", letters: "Y" },
  slack: { colour: "#b9b4ab", letters: "L" },
  "begins to flow": { colour: "#d55e00", letters: "F" },
  "not evaluated": { colour: "#8f99a5", letters: "" },
};

// A hinge or crushing that also slides or twists: the letters say what else it does.
function stateSign(name) {
  if (STATES[name]) return STATES[name];
  const letters = name.split("-").map((word) => word[0].toUpperCase());
  return { colour: letters[0] === "C" ? "#b3121d" : "#d55e00", letters: letters.join("") };
}
