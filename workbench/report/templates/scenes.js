// Scenes that turn: numbers in steps become Plotly's triangles.
const numbers = (q) => {
  const steps = new Uint16Array(byteString(q.data).buffer);
  return Float32Array.from(steps, (s) => q.low + q.step * s);
};
const triangles = (text) => {
  const quads = new Uint32Array(byteString(text).buffer), n = quads.length / 4;
  const [i, j, k] = [0, 0, 0].map(() => new Uint32Array(2 * n));
  for (let q = 0; q < n; q++) {
    const [a, b, c, d] = quads.subarray(4 * q, 4 * q + 4);
    i.set([a, a], 2 * q); j.set([b, c], 2 * q); k.set([c, d], 2 * q);
  }
  return { i, j, k };
};
const lighting = { ambient: 0.55, diffuse: 0.55, specular: 0.06, roughness: 0.9, fresnel: 0.05 };
const axis = { visible: false, showspikes: false };
// Extents of all traces, so large that the scene fills its box.
function proportions(traces, zoom) {
  const extent = (key) => {
    let low = Infinity, high = -Infinity;
    for (const trace of traces) for (const v of trace[key]) { if (v < low) low = v; if (v > high) high = v; }
    return high - low;
  };
  const sizes = ["x", "y", "z"].map(extent), scale = zoom / Math.max(...sizes);
  return { x: sizes[0] * scale, y: sizes[1] * scale, z: sizes[2] * scale };
}
const sceneLayout = (eye, aspectratio) => ({
  margin: { l: 0, r: 0, t: 0, b: 0 }, paper_bgcolor: "rgba(0,0,0,0)", showlegend: false,
  scene: {
    aspectmode: "manual", aspectratio, dragmode: "orbit", xaxis: axis, yaxis: axis, zaxis: axis,
    camera: { eye: { x: eye[0], y: eye[1], z: eye[2] }, up: { x: 0, y: 0, z: 1 }, projection: { type: "orthographic" } },
  },
});
const sceneConfig = { responsive: true, displaylogo: false,
  modeBarButtonsToRemove: ["orbitRotation", "tableRotation", "resetCameraLastSave3d"] };

const pieceTraces = (content) => content.pieces.map((piece, q) => {
  const [x, y, z] = piece.points.map(numbers);
  return { type: "mesh3d", name: piece.name, showlegend: content.pieces.findIndex((other) => other.name === piece.name) === q,
    legendgroup: piece.name, color: piece.colour, x, y, z, ...triangles(piece.quads),
    lighting, flatshading: true, hovertemplate: piece.name + "<extra></extra>" };
});

// The wheel turned so that the ground lies below; `share` of the displacement and of the stress.
function posed(content, pose, share) {
  const [x, y, z] = content.points.map(numbers), [u, v, w] = pose.displacement.map(numbers);
  const s = numbers(pose.stress), c = Math.cos(pose.orientation), d = Math.sin(pose.orientation);
  const n = x.length, m = content.mirrored ? 2 * n : n;
  const out = { x: new Float32Array(m), y: new Float32Array(m), z: new Float32Array(m), intensity: new Float32Array(m) };
  for (let p = 0; p < n; p++) {
    const a = x[p] + share * u[p], e = z[p] + share * w[p];
    out.x[p] = c * a + d * e; out.y[p] = y[p] + share * v[p]; out.z[p] = c * e - d * a; out.intensity[p] = share * s[p];
    if (content.mirrored) {
      out.x[n + p] = out.x[p]; out.y[n + p] = -out.y[p]; out.z[n + p] = out.z[p]; out.intensity[n + p] = out.intensity[p];
    }
  }
  return out;
}
function stressTraces(content, pose, share) {
  const one = triangles(content.quads), n = content.mirrored ? numbers(content.points[0]).length : 0;
  const both = (t) => content.mirrored ? Uint32Array.from({ length: 2 * t.length }, (_, q) =>
    q < t.length ? t[q] : t[q - t.length] + n) : t;
  const shape = posed(content, pose, share), floor = shape.z.reduce((a, b) => Math.min(a, b), 0) - 0.001;
  const r = 1.25 * shape.x.reduce((a, b) => Math.max(a, b), 0), w = 1.9 * shape.y.reduce((a, b) => Math.max(a, b), 0);
  const bar = { title: { text: "von Mises [MPa]", side: "right", font: { size: 12 } }, thickness: 12, len: 0.75, x: 1, tickfont: { size: 11 }, xanchor: "right" };
  return [
    { type: "mesh3d", ...shape, i: both(one.i), j: both(one.j), k: both(one.k), cmin: 0, cmax: content.limit,
      colorscale: content.scale, colorbar: bar, lighting, flatshading: false,
      hovertemplate: "%{intensity:.0f} MPa<extra></extra>" },
    { type: "mesh3d", x: [-r, r, r, -r], y: [-w, -w, w, w], z: Array(4).fill(floor), i: [0, 0], j: [1, 2], k: [2, 3],
      color: "#c9c4bb", lighting, hoverinfo: "skip" },
  ];
}

function stressControls(holder, content, show) {
  const state = { pose: content.poses[0], share: 1 };
  const buttons = content.poses.map((pose) => {
    const button = document.createElement("button");
    button.type = "button"; button.textContent = pose.label;
    button.addEventListener("click", () => { state.pose = pose; update(); });
    holder.append(button);
    return button;
  });
  const label = document.createElement("label");
  label.innerHTML = 'undeformed <input type="range" min="0" max="100" value="100" aria-label="deformation"> solved';
  label.querySelector("input").addEventListener("input", (event) => { state.share = event.target.value / 100; update(); });
  holder.append(label);
  const update = () => {
    buttons.forEach((b, q) => b.classList.toggle("on", content.poses[q] === state.pose));
    show(state.pose, state.share);
  };
  buttons[0].classList.add("on");
}

async function drawScene(box) {
  const stage = box.querySelector(".stage");
  const [Plotly, text] = await Promise.all([withPlotly(), unpack(dataOf(box.id).textContent)]);
  const content = JSON.parse(text), view = document.createElement("div");
  view.className = "view";
  stage.append(view);
  const wheel = Boolean(content.poses);
  const traces = wheel ? stressTraces(content, content.poses[0], 1) : pieceTraces(content);
  const zoom = content.zoom * Math.min(1, 0.3 + 0.45 * stage.clientWidth / stage.clientHeight);
  await Plotly.newPlot(view, traces, sceneLayout(content.eye, proportions(traces, zoom)),
    { ...sceneConfig, displayModeBar: modeBar });
  if (!wheel) addLegend(view, Plotly, traces, (holder) => box.querySelector(".controls").append(holder));
  if (wheel) {
    stressControls(box.querySelector(".controls"), content, (pose, share) => {
      const [shape, ground] = stressTraces(content, pose, share);
      Plotly.restyle(view, { x: [shape.x, ground.x], y: [shape.y, ground.y], z: [shape.z, ground.z],
        intensity: [shape.intensity, undefined] }, [0, 1]);
    });
  }
  fingersOn(stage, view);
  box.dataset.drawn = "1";
}
