// Starts what the page can do; without scripts or WebGL its tables and the static picture remain.

function startViewer(scene) {
  const root = document.getElementById("viewer");
  root.hidden = false; // the canvas needs its size
  let viewer;
  try {
    viewer = new Viewer(root, scene, Number(root.querySelector("[name=result]").value));
  } catch (error) {
    root.hidden = true;
    document.getElementById("no-webgl").hidden = false;
    return;
  }
  document.documentElement.classList.add("with-viewer");
  const panel = new Panel(root, viewer);
  viewer.setMode(viewer.result ? "mechanism" : "structure");
  viewer.stage.look("iso");
  viewer.stage.resize();
  viewer.move();
  new ResizeObserver(() => viewer.move()).observe(viewer.stage.canvas);
  themeListeners.push(() => viewer.refresh());
  root.dataset.ready = "true";
  return panel;
}

startTheme();
startTables();
const pageScene = readScene();
startCsv(pageScene);
startViewer(pageScene);
