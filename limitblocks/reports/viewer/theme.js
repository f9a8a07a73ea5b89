// Light or dark: as the system says, until the reader chooses.

const themeListeners = [];

function theme() {
  const chosen = document.documentElement.dataset.theme;
  if (chosen) return chosen;
  return window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

function startTheme() {
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    themeListeners.forEach((listener) => listener());
  });
  const button = document.getElementById("theme");
  if (!button) return; // the viewer alone
  const say = () => button.setAttribute("aria-pressed", String(theme() === "dark"));
  button.hidden = false;
  button.addEventListener("click", () => {
    document.documentElement.dataset.theme = theme() === "dark" ? "light" : "dark";
    themeListeners.forEach((listener) => listener());
  });
  themeListeners.push(say);
  say();
}
