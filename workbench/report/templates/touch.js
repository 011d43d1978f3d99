// Fingers on a scene: down or up scrolls the page, sideways turns the scene, a tap lets it turn and zoom freely.
function turned(view, angle) {
  const { eye } = view._fullLayout.scene.camera, c = Math.cos(angle), s = Math.sin(angle);
  return window.Plotly.relayout(view, { "scene.camera.eye": { x: c * eye.x - s * eye.y, y: s * eye.x + c * eye.y, z: eye.z } });
}
function fingersOn(stage, view) {
  let last = null;
  const free = () => stage.classList.contains("free");
  const held = (kind, act) => stage.addEventListener(kind, (event) => {
    if (free()) return;
    event.stopPropagation();
    act(event);
  }, { capture: true, passive: true });
  held("touchstart", (event) => { last = event.touches.length === 1 ? event.touches[0].clientX : null; });
  held("touchmove", (event) => {
    if (last === null || event.touches.length > 1) return;
    const x = event.touches[0].clientX;
    turned(view, (Math.PI * (last - x)) / stage.clientWidth);
    last = x;
  });
  held("touchend", () => { last = null; });
  stage.addEventListener("click", (event) => { if (event.pointerType === "touch") stage.classList.add("free"); });
  document.addEventListener("pointerdown", (event) => { if (!stage.contains(event.target)) stage.classList.remove("free"); });
}
