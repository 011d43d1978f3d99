// Figures and scenes are drawn when the reader comes near them, one a frame.
const byFinger = matchMedia("(pointer: coarse)").matches;
const modeBar = byFinger ? false : "hover";
const config = { responsive: true, displaylogo: false, plotlyServerURL: "", displayModeBar: modeBar,
  modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d"] };
const narrow = () => window.innerWidth < 600;

function drawPlot(box, Plotly) {
  if (box.dataset.drawn) return null;
  box.dataset.drawn = "0";
  const spec = JSON.parse(dataOf(box.id).textContent);
  box.dataset.height = spec.layout.height;
  delete spec.layout.height;
  if (narrow()) {
    spec.layout.font = { ...spec.layout.font, size: 11 };
    spec.layout.margin = { ...spec.layout.margin, l: 52, r: spec.layout.yaxis2 ? 68 : 8 };
  }
  if (byFinger) spec.layout.dragmode = false;
  spec.layout.showlegend = false;
  if (spec.layout.margin) spec.layout.margin.t = 12;
  addLegend(box, Plotly, spec.data, (holder) => box.before(holder));
  return Plotly.newPlot(box, spec.data, spec.layout, config).then(() => {
    box.dataset.drawn = "1";
    if (!performance.getEntriesByName("first-figure").length) performance.mark("first-figure");
  });
}

const waiting = [];
let busy = false;
async function work() {
  if (busy) return;
  busy = true;
  while (waiting.length) {
    const box = waiting.shift();
    try {
      await (box.classList.contains("scene") ? drawScene(box) : drawPlot(box, await withPlotly()));
    } catch (error) {
      box.dataset.failed = String(error);
      console.error(`${box.id} was not drawn: ${error}`);
    }
    await frame();
  }
  busy = false;
}
const near = new IntersectionObserver((entries) => {
  for (const entry of entries.filter((e) => e.isIntersecting)) {
    near.unobserve(entry.target);
    waiting.push(entry.target);
  }
  work();
}, { rootMargin: "500px 0px" });
// The first screen's figure is on its way before the rest of the page is read.
withPlotly();
document.querySelectorAll(".plot").forEach((box) => near.observe(box));
document.addEventListener("DOMContentLoaded", () =>
  document.querySelectorAll("main > section:not(#verdict) :is(.plot, .scene)").forEach((box) => near.observe(box)));
